//! The six components as bars about a middle line.

use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::style::{Color, Stylize};
use ratatui::text::{Line, Span};
use ratatui::widgets::{Block, Paragraph};

use super::state::State;
use crate::table::number;

/// Six bars in a frame, and a line below.
pub(super) const HEIGHT: u16 = 9;
/// Columns of a name and a number.
const NUMBERS: usize = 15;

pub(super) fn draw(frame: &mut Frame<'_>, area: Rect, state: &State) {
    let components = state.wrench.map(|wrench| wrench.components());
    let [force_scale, torque_scale] = state.greatest.map(rounded_up);
    let width = usize::from(area.width.saturating_sub(2)).saturating_sub(NUMBERS);
    let mut lines: Vec<Line<'_>> = Vec::new();
    for (axis, name) in ["fx", "fy", "fz", "tx", "ty", "tz"].into_iter().enumerate() {
        let value = components.as_ref().and_then(|components| components.get(axis)).copied();
        let (scale, unit, colour) = if axis < 3 {
            (force_scale, "N", Color::LightBlue)
        } else {
            (torque_scale * 1e3, "mNm", Color::LightMagenta)
        };
        let value = if axis < 3 { value } else { value.map(|torque| torque * 1e3) };
        let text = value.map_or_else(|| "–".to_owned(), number);
        let mut spans = vec![Span::raw(format!("{name}{text:>9} {unit:<3}"))];
        spans.extend(bar(value.unwrap_or(0.0) / scale, width, colour));
        lines.push(Line::from(spans));
    }
    let total = state.wrench.map_or(0.0, |wrench| wrench.force().norm());
    lines.push(Line::from(format!("|f|{:>8} N   {}", number(total), state.status())));
    if state.projection.is_none() {
        lines.push(Line::from("Contact and slip need a scene: --scene FILE").fg(Color::DarkGray));
    }
    let title = format!("Load, bars to ±{} N, ±{} mNm", number(force_scale), number(torque_scale * 1e3));
    frame.render_widget(Paragraph::new(lines).block(Block::bordered().title(title)), area);
}

/// The next of 1, 2, 5, 10, 20 …
fn rounded_up(value: f64) -> f64 {
    let decade = 10_f64.powf(value.log10().floor());
    let found = [1.0, 2.0, 5.0, 10.0].into_iter().map(|step| step * decade).find(|step| *step >= value);
    found.filter(|step| *step > 0.0 && step.is_finite()).unwrap_or(f64::MAX)
}

/// A share from −1 to 1 of half the width, to the left or right of the middle.
fn bar<'a>(share: f64, width: usize, colour: Color) -> Vec<Span<'a>> {
    let half = width.saturating_sub(1) / 2;
    if half == 0 {
        return Vec::new();
    }
    let share = if share.is_finite() { share.clamp(-1.0, 1.0) } else { 0.0 };
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most the width")]
    let filled = (share.abs() * half as f64).round() as usize;
    let full = "█".repeat(filled);
    let (left, right) = if share < 0.0 {
        (format!("{}{full}", " ".repeat(half - filled)), " ".repeat(half))
    } else {
        (" ".repeat(half), format!("{full}{}", " ".repeat(half - filled)))
    };
    vec![Span::raw(left).fg(colour), Span::raw("│").fg(Color::DarkGray), Span::raw(right).fg(colour)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_are_round_and_bars_stay_in_their_half() {
        assert_eq!([0.9, 1.0, 1.1, 4.0, 30.0].map(rounded_up), [1.0, 1.0, 2.0, 5.0, 50.0]);
        for value in [0.0, f64::MIN_POSITIVE, 1e308, f64::NAN, f64::INFINITY] {
            assert!(rounded_up(value) > 0.0);
        }
        for (share, expected) in
            [(0.0, "     │     "), (1.0, "     │█████"), (-0.4, "   ██│     "), (9.0, "     │█████")]
        {
            let text: String = bar(share, 11, Color::Red).iter().map(|span| span.content.clone()).collect();
            assert_eq!(text, expected);
        }
        assert!(bar(1.0, 2, Color::Red).is_empty());
        assert_eq!(bar(f64::NAN, 11, Color::Red).len(), 3);
    }

    #[test]
    fn the_scale_is_the_next_round_number() {
        for decade in -9..9_i32 {
            let size = 10_f64.powi(decade);
            for (value, expected) in
                [(1.01, 2.0), (1.99, 2.0), (2.01, 5.0), (4.99, 5.0), (5.01, 10.0), (9.99, 10.0)]
            {
                let found = rounded_up(value * size);
                assert!((found / (expected * size) - 1.0).abs() < 1e-12, "{value}e{decade}: {found}");
            }
        }
        // What has no next round number is at the end of the scale.
        assert_eq!([0.0, f64::NAN, f64::INFINITY].map(rounded_up), [f64::MAX; 3]);
    }

    #[test]
    fn both_halves_of_a_bar_are_equally_long() {
        for width in 0..20_usize {
            for share in [-2.0, -1.0, -0.5, 0.0, 0.3, 1.0, f64::NAN] {
                let lengths: Vec<usize> =
                    bar(share, width, Color::Red).iter().map(|span| span.content.chars().count()).collect();
                let half = (width.max(1) - 1) / 2;
                let expected = if half == 0 { Vec::new() } else { vec![half, 1, half] };
                assert_eq!(lengths, expected, "{share} in {width}");
            }
        }
    }
}
