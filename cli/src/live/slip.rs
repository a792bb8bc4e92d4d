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
    let Some(coefficient) = state.coefficient else {
        frame.render_widget(Paragraph::new(format!("ratio {}", number(ratio))), gauge);
        return;
    };
    let share = (ratio / coefficient).clamp(0.0, 1.0);
    let colour = match share {
        share if share >= 1.0 => Color::Red,
        share if share > 0.8 => Color::Yellow,
        _ => Color::Green,
    };
    let label = format!("ratio {} of µ {}", number(ratio), crate::table::short(coefficient));
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
