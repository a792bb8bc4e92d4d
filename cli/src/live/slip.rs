//! How close the contact is to slipping.

use fingertip::friction::SlipVerdict;
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::{Color, Style};
use ratatui::text::{Line, Span};
use ratatui::widgets::{Block, LineGauge, Paragraph};

use super::state::State;
use crate::table::{count, number};

/// The light, the forces and the gauge, in a frame.
pub(super) const HEIGHT: u16 = 5;

pub(super) fn draw(frame: &mut Frame<'_>, area: Rect, state: &State) {
    if area.height < 3 || area.width < 8 {
        return;
    }
    let block = Block::bordered().title("Slip");
    let [light, forces, gauge] = Layout::vertical([Constraint::Length(1); 3]).areas(block.inner(area));
    frame.render_widget(block, area);
    let (word, colour) = match state.verdict() {
        Some(SlipVerdict::Slipping) => ("SLIPPING", Color::Red),
        Some(SlipVerdict::Warning) => ("warning", Color::Yellow),
        Some(SlipVerdict::Holding) => ("holding", Color::Green),
        Some(SlipVerdict::NotPressing) => ("not pressing", Color::Gray),
        None if state.watches_slip => ("no verdict", Color::Gray),
        None => ("no [slip] in the scene", Color::Gray),
    };
    let line = Line::from(vec![
        Span::styled(format!(" ■ {word} "), Style::new().fg(Color::Black).bg(colour).bold()),
        Span::raw(format!("  slips: {}", count(state.slips))),
    ]);
    frame.render_widget(Paragraph::new(line), light);
    let Some(force) = state.touch.as_ref().and_then(|touch| touch.force) else { return };
    let margin = state.touch.as_ref().and_then(|touch| touch.grip.flatten());
    let mut text = format!("fn {}, ft {}", number(force.normal), number(force.tangential_magnitude()));
    if let Some(margin) = margin {
        text.push_str(&format!(", margin {}", number(margin.newtons)));
    }
    text.push_str(" N");
    frame.render_widget(Paragraph::new(text), forces);
    let Some(ratio) = force.friction_ratio().filter(|ratio| ratio.is_finite()) else { return };
    // By the limit of the scene: a spin torque uses it up, too, and a patch that grows holds more.
    let Some(share) = margin.map(|margin| margin.utilisation.clamp(0.0, 1.0)) else {
        frame.render_widget(Paragraph::new(format!("ratio {}", number(ratio))), gauge);
        return;
    };
    let colour = match share {
        share if share >= 1.0 => Color::Red,
        share if share > 0.8 => Color::Yellow,
        _ => Color::Green,
    };
    // Of a limit of the ratio alone, the coefficient says more than the share.
    let is_used = |coefficient: &f64| (ratio / coefficient - share).abs() < 0.005 || share >= 1.0;
    let label = match state.coefficient.filter(is_used) {
        Some(coefficient) => format!("ratio {} of µ {}", number(ratio), crate::table::short(coefficient)),
        None => format!("ratio {}, limit used {:.0} %", number(ratio), 100.0 * share),
    };
    let gauge_line = LineGauge::default()
        .ratio(if share.is_finite() { share } else { 0.0 })
        .label(label)
        // So that it can be read without colours.
        .filled_symbol("█")
        .unfilled_symbol("░")
        .filled_style(Style::new().fg(colour))
        .unfilled_style(Style::new().fg(Color::DarkGray));
    frame.render_widget(gauge_line, gauge);
}

#[cfg(test)]
mod tests {
    use fingertip::contact::{NoContact, Resolution};
    use fingertip::friction::{SlipMargin, SlipVerdict};
    use fingertip::wrench::{ContactForce, Wrench};
    use nalgebra::Vector3;
    use ratatui::Terminal;
    use ratatui::backend::TestBackend;
    use ratatui::style::Color;
    use std::time::Instant;

    use super::super::state::State;
    use super::draw;
    use crate::observe::SceneTouch;

    const WIDTH: u16 = 60;

    /// The lines of the picture, and the colours of the light and of the filled part of the gauge.
    fn shown(state: &State) -> (Vec<String>, Color, Option<Color>) {
        let mut terminal = Terminal::new(TestBackend::new(WIDTH, 5)).unwrap();
        terminal.draw(|frame| draw(frame, frame.area(), state)).unwrap();
        let buffer = terminal.backend().buffer();
        let row = |row: u16| (1..WIDTH - 1).map(|column| buffer[(column, row)].symbol()).collect::<String>();
        let filled = (0..WIDTH).find(|column| buffer[(*column, 3)].symbol() == "█");
        let lines = (1..4).map(|line| row(line).trim_end().to_owned()).collect();
        (lines, buffer[(2, 1)].bg, filled.map(|column| buffer[(column, 3)].fg))
    }

    /// A contact with 2 N across it, so that it is pressed with 2 N over the ratio.
    fn touched(ratio: f64, verdict: Option<SlipVerdict>) -> State {
        let mut state = State::new(String::new());
        (state.coefficient, state.watches_slip) = (Some(0.5), true);
        let touch = SceneTouch {
            wrench: Wrench::zero(),
            resolution: Resolution::NoContact(NoContact::NotFinite),
            force: Some(ContactForce::new(2.0 / ratio, Vector3::new(0.0, 2.0, 0.0), 0.0)),
            grip: Some(Some(SlipMargin { newtons: 0.25, utilisation: ratio / 0.5 })),
            slip: verdict,
            tracked: (),
        };
        state.sample(0.0, &Wrench::zero(), Some(touch), Instant::now());
        state
    }

    #[test]
    fn where_there_is_no_room_nothing_is_drawn() {
        let state = touched(0.1, Some(SlipVerdict::Holding));
        for (width, height, drawn) in
            [(8, 3, true), (7, 3, false), (8, 2, false), (7, 5, false), (60, 2, false), (60, 3, true)]
        {
            let mut terminal = Terminal::new(TestBackend::new(width, height)).unwrap();
            terminal.draw(|frame| draw(frame, frame.area(), &state)).unwrap();
            let empty = terminal.backend().buffer().content().iter().all(|cell| cell.symbol() == " ");
            assert_eq!(!empty, drawn, "{width} × {height}");
        }
    }

    #[test]
    fn the_light_has_the_colour_of_the_verdict() {
        for (verdict, word, colour) in [
            (Some(SlipVerdict::Slipping), "SLIPPING", Color::Red),
            (Some(SlipVerdict::Warning), "warning", Color::Yellow),
            (Some(SlipVerdict::Holding), "holding", Color::Green),
            (Some(SlipVerdict::NotPressing), "not pressing", Color::Gray),
            (None, "no verdict", Color::Gray),
        ] {
            let (lines, found, _) = shown(&touched(0.1, verdict));
            assert!(lines[0].starts_with(&format!(" ■ {word} ")) && found == colour, "{lines:?} {found:?}");
        }
        let mut state = touched(0.1, None);
        state.watches_slip = false;
        assert!(shown(&state).0[0].starts_with(" ■ no [slip] in the scene "));
    }

    #[test]
    fn the_gauge_is_filled_as_far_as_friction_is_used() {
        for (share, colour) in [
            (0.5, Color::Green),
            (0.79, Color::Green),
            (0.81, Color::Yellow),
            (0.99, Color::Yellow),
            (1.0, Color::Red),
            (3.0, Color::Red),
        ] {
            let (lines, _, found) = shown(&touched(share * 0.5, None));
            assert_eq!(found, Some(colour), "{share}: {lines:?}");
            let (full, left) = (lines[2].matches('█').count(), lines[2].matches('░').count());
            let expected = f64::min(share, 1.0) * (full + left) as f64;
            assert!((full as f64 - expected).abs() <= 1.0, "{share}: {lines:?}");
        }
        let (lines, ..) = shown(&touched(0.4, None));
        assert_eq!(lines[1], "fn 5.00, ft 2.00, margin 0.250 N");
        assert!(lines[2].starts_with("ratio 0.400 of µ 0.5 █"), "{lines:?}");
        // A spin torque uses the limit up, too: what counts is the margin, not the ratio.
        let mut state = touched(0.1, None);
        state.touch = state.touch.map(|touch| SceneTouch {
            grip: Some(Some(SlipMargin { newtons: 0.25, utilisation: 0.9 })),
            ..touch
        });
        let (lines, _, found) = shown(&state);
        assert!(lines[2].starts_with("ratio 0.100, limit used 90 % █"), "{lines:?}");
        assert_eq!(found, Some(Color::Yellow));
        // Without friction there is a ratio, and without a contact force nothing.
        state.touch = state.touch.map(|touch| SceneTouch { grip: None, ..touch });
        assert_eq!(shown(&state).0[2], "ratio 0.100");
        state.touch = None;
        assert_eq!(shown(&state).0[1..], ["", ""]);
        // What presses with nothing has no ratio.
        assert_eq!(shown(&touched(f64::INFINITY, None)).0[2], "");
    }
}
