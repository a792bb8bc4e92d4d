//! The few pieces of SVG that the drawings of pages are made of.
//!
//! Colours are classes, which the page's style sheet fills in for light and for dark: a drawing
//! names none. (plotters, which could draw the charts, writes fixed colours and sizes, which do
//! not follow the reader's colour scheme.)

use core::fmt::Write;

use super::{Axis, text_width, thinned};

/// A growing drawing of a fixed size in its own units. Its classes are those of the style sheet of [`Page`](super::Page):
/// `a` to `e` are colours, `grid`, `axis`, `level` and `mark` lines, `tick` and `name` texts.
///
/// ```
/// use fingertip_calibration::page::{Anchor, Svg};
///
/// let mut svg = Svg::new(100.0, 50.0, "A line");
/// svg.line("axis", (0.0, 25.0), (100.0, 25.0));
/// svg.label("tick", (50.0, 40.0), Anchor::Middle, "0");
/// assert!(svg.finish().ends_with(">0</text></svg>"));
/// ```
#[derive(Clone, Debug)]
pub struct Svg {
    text: String,
    width: f64,
}

/// Letters of the class `tick`.
pub const TICK_SIZE: f64 = 11.0;

/// Where a text is attached, on pages and on [sheets](crate::sheet).
///
/// ```
/// use fingertip_calibration::page::{Anchor, Svg};
///
/// let mut svg = Svg::new(200.0, 100.0, "a label at the right edge");
/// svg.label("name", (200.0, 50.0), Anchor::End, "F < 5 N");
/// let drawing = svg.finish();
/// assert!(drawing.contains(r#"text-anchor="end""#) && drawing.contains("F &lt; 5 N"));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// At its beginning.
    Start,
    /// In its middle.
    Middle,
    /// At its end.
    End,
}

impl Svg {
    /// `title` is what a screen reader says.
    #[must_use]
    pub fn new(width: f64, height: f64, title: &str) -> Self {
        let mut svg = Self { text: String::new(), width };
        svg.push(format_args!(
            "<svg viewBox=\"0 0 {width:.0} {height:.0}\" role=\"img\" xmlns=\"http://www.w3.org/2000/svg\"><title>{}</title>",
            escape(title)
        ));
        svg
    }

    fn push(&mut self, piece: core::fmt::Arguments<'_>) {
        // Writing to a String cannot fail.
        let _ = self.text.write_fmt(piece);
    }

    /// A straight line.
    pub fn line(&mut self, class: &str, from: (f64, f64), to: (f64, f64)) {
        let ((x1, y1), (x2, y2)) = (from, to);
        self.push(format_args!("<path class=\"{class}\" d=\"M{x1:.1} {y1:.1}L{x2:.1} {y2:.1}\"/>"));
    }

    /// A rectangle from its upper left corner; a size below zero counts as zero.
    pub fn rectangle(&mut self, class: &str, corner: (f64, f64), size: (f64, f64)) {
        self.push(format_args!(
            "<rect class=\"{class}\" x=\"{:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"{:.1}\"/>",
            corner.0,
            corner.1,
            size.0.max(0.0),
            size.1.max(0.0)
        ));
    }

    /// A circle.
    pub fn circle(&mut self, class: &str, centre: (f64, f64), radius: f64) {
        self.push(format_args!(
            "<circle class=\"{class}\" cx=\"{:.1}\" cy=\"{:.1}\" r=\"{radius:.1}\"/>",
            centre.0, centre.1
        ));
    }

    /// A text.
    pub fn label(&mut self, class: &str, at: (f64, f64), anchor: Anchor, text: &str) {
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        self.push(format_args!(
            "<text class=\"{class}\" x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"{anchor}\">{}</text>",
            at.0,
            at.1,
            escape(text)
        ));
    }

    /// Labels of an axis that runs across, on the line `y`, each under its place; where there is no room for all, every
    /// second, third and so on. None leaves the drawing.
    pub fn ticks_across(&mut self, y: f64, ticks: &[(f64, String)]) {
        let half = |text: &str| 0.5 * text_width(text, TICK_SIZE);
        let inside =
            |x: f64, half: f64| if 2.0 * half < self.width { x.clamp(half, self.width - half) } else { x };
        let middles: Vec<f64> = ticks.iter().map(|(x, text)| inside(*x, half(text))).collect();
        let spans: Vec<_> =
            middles.iter().zip(ticks).map(|(x, (_, text))| (x - half(text), x + half(text))).collect();
        for ((_, text), x) in ticks.iter().zip(middles).step_by(thinned(&spans, TICK_SIZE)) {
            self.label("tick", (x, y), Anchor::Middle, text);
        }
    }

    /// The same of an axis that runs upwards, left of the line `x`.
    pub fn ticks_up(&mut self, x: f64, ticks: &[(f64, String)]) {
        // A digit is two thirds as high as its letters' size.
        let spans: Vec<_> = ticks.iter().map(|(y, _)| (y - 0.33 * TICK_SIZE, y + 0.33 * TICK_SIZE)).collect();
        for (y, text) in ticks.iter().step_by(thinned(&spans, TICK_SIZE)) {
            self.label("tick", (x, y + 3.5), Anchor::End, text);
        }
    }

    /// Lines through the points of every piece; a piece of one point becomes a dot.
    pub fn curve<'a>(&mut self, class: &str, pieces: impl Iterator<Item = &'a [(f64, f64)]>) {
        self.push(format_args!("<path class=\"curve {class}\" d=\""));
        for piece in pieces {
            for (i, (x, y)) in piece.iter().enumerate() {
                let command = if i == 0 { "M" } else { "L" };
                self.push(format_args!("{command}{x:.1} {y:.1}"));
            }
            if piece.len() == 1 {
                self.text.push_str("h0");
            }
        }
        self.text.push_str("\"/>");
    }

    /// Dots of one colour: strokes without length, whose round caps are what is seen.
    pub fn dots(&mut self, class: &str, places: impl Iterator<Item = (f64, f64)>) {
        let mut places = places.peekable();
        if places.peek().is_none() {
            return;
        }
        self.push(format_args!("<path class=\"dots {class}\" d=\""));
        for (x, y) in places {
            self.push(format_args!("M{x:.1} {y:.1}h0"));
        }
        self.text.push_str("\"/>");
    }

    /// Squares that are not filled, about these places, of one colour.
    pub fn squares(&mut self, class: &str, places: impl Iterator<Item = (f64, f64)>) {
        let mut places = places.peekable();
        if places.peek().is_none() {
            return;
        }
        self.push(format_args!("<path class=\"squares {class}\" d=\""));
        for (x, y) in places {
            self.push(format_args!("M{x:.1} {y:.1}m-3-3h6v6h-6z"));
        }
        self.text.push_str("\"/>");
    }

    /// Small shapes about these places, by which the curve of a class is known without its colour: `b` has squares, `c`
    /// triangles, `d` diamonds, `e` and `f` crosses, `g` triangles that stand on a corner, `h` two that meet, others dots.
    pub fn shapes(&mut self, class: &str, places: impl Iterator<Item = (f64, f64)>) {
        let mut places = places.peekable();
        if places.peek().is_none() {
            return;
        }
        let shape = match class.bytes().next() {
            Some(b'b') => "m-2.6-2.6h5.2v5.2h-5.2z",
            Some(b'c') => "m0-3.6 3.4 5.8h-6.8z",
            Some(b'd') => "m0-3.8 3.8 3.8-3.8 3.8-3.8-3.8z",
            Some(b'e') => "m-2.8-2.8 5.6 5.6m0-5.6-5.6 5.6",
            Some(b'f') => "m-3.6 0h7.2m-3.6-3.6v7.2",
            Some(b'g') => "m0 3.6 3.4-5.8h-6.8z",
            Some(b'h') => "m-3-3 6 6v-6l-6 6z",
            _ => "m-2.8 0a2.8 2.8 0 1 0 5.6 0a2.8 2.8 0 1 0-5.6 0z",
        };
        self.push(format_args!("<path class=\"shapes {class}\" d=\""));
        for (x, y) in places {
            self.push(format_args!("M{x:.1} {y:.1}{shape}"));
        }
        self.text.push_str("\"/>");
    }

    /// A closed shape.
    pub fn polygon(&mut self, class: &str, corners: impl Iterator<Item = (f64, f64)>) {
        self.push(format_args!("<path class=\"{class}\" d=\""));
        for (place, (x, y)) in corners.enumerate() {
            let command = if place == 0 { "M" } else { "L" };
            self.push(format_args!("{command}{x:.1} {y:.1}"));
        }
        self.text.push_str("Z\"/>");
    }

    /// What is drawn until [`end_clip`](Self::end_clip) is cut at a frame.
    pub fn begin_clip(&mut self, corner: (f64, f64), size: (f64, f64)) {
        self.begin_inner(corner, size, "");
    }

    /// As [`begin_clip`](Self::begin_clip), and the page can read points along these axes, which end with the frame.
    pub fn begin_plot(&mut self, corner: (f64, f64), size: (f64, f64), x: &Axis, y: &Axis) {
        let axes = format!(" data-x=\"{}\" data-y=\"{}\"", escape(&x.in_words()), escape(&y.in_words()));
        self.begin_inner(corner, size, &axes);
    }

    /// An equal-area map about a centre, of a sphere whose radius is drawn so long; nothing is cut.
    pub fn begin_turn(&mut self, centre: (f64, f64), reach: f64, radius: f64) {
        let corner = (centre.0 - reach, centre.1 - reach);
        let turn = format!(" overflow=\"visible\" data-turn=\"{radius:.3}\"");
        self.begin_inner(corner, (2.0 * reach, 2.0 * reach), &turn);
    }

    fn begin_inner(&mut self, corner: (f64, f64), size: (f64, f64), more: &str) {
        self.push(format_args!(
            "<svg x=\"{:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"{:.1}\" viewBox=\"{:.1} {:.1} {:.1} {:.1}\"{more}>",
            corner.0, corner.1, size.0, size.1, corner.0, corner.1, size.0, size.1
        ));
    }

    /// Ends what was begun last.
    pub fn end_clip(&mut self) {
        self.text.push_str("</svg>");
    }

    /// The drawing as it stands in a page.
    #[must_use]
    pub fn finish(mut self) -> String {
        self.text.push_str("</svg>");
        self.text
    }
}

/// Text that may stand in HTML.
fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use fingertip_test_support::read_back::{assert_readable, texts};

    use super::{Anchor, Axis, Svg};

    /// Where there is room every label stands under its place; where there is not, fewer stand, and none is cut off.
    #[test]
    fn labels_of_an_axis_are_thinned_until_they_have_room() {
        let shown = |step: f64, text: &str| {
            let mut svg = Svg::new(300.0, 100.0, "");
            let ticks: Vec<_> = (0..10).map(|i| (20.0 + step * f64::from(i), text.to_owned())).collect();
            svg.ticks_across(90.0, &ticks);
            let svg = svg.finish();
            assert_readable(&svg);
            texts(&svg).into_iter().map(|text| text.at.0).collect::<Vec<_>>()
        };
        assert_eq!(shown(30.0, "12").len(), 10);
        assert_eq!(shown(30.0, "12")[..3], [20.0, 50.0, 80.0]);
        assert_eq!(shown(30.0, "123456"), [20.0, 80.0, 140.0, 200.0, 260.0]);
        assert_eq!(shown(3.0, "123456").len(), 1);
        // Nine letters are longer than what is left of it.
        assert_eq!(shown(3.0, "123456789")[0], 27.2);
        let mut svg = Svg::new(300.0, 100.0, "");
        let ticks: Vec<_> = (0..10).map(|i| (20.0 + 6.0 * f64::from(i), "1".to_owned())).collect();
        svg.ticks_up(39.0, &ticks);
        let svg = svg.finish();
        assert_readable(&svg);
        assert_eq!(
            texts(&svg).iter().map(|text| text.at.1).collect::<Vec<_>>(),
            [23.5, 35.5, 47.5, 59.5, 71.5]
        );
    }

    #[test]
    fn every_piece_is_written_as_it_is_drawn() {
        let mut svg = Svg::new(10.0, 20.0, "a < b");
        svg.line("l", (1.0, 2.0), (3.04, 4.06));
        svg.rectangle("r", (1.0, 2.0), (-1.0, 3.0));
        svg.rectangle("r", (1.0, 2.0), (4.0, -3.0));
        svg.circle("c", (1.0, 2.0), 3.0);
        svg.label("t", (5.0, 6.0), Anchor::Middle, "x & y");
        svg.curve("k", [&[(0.0, 1.0), (2.0, 3.0)][..], &[(4.0, 5.0)]].into_iter());
        svg.dots("d", [(1.0, 2.0), (3.0, 4.0)].into_iter());
        svg.dots("none", core::iter::empty());
        svg.squares("s", [(1.0, 2.0), (3.0, 4.0)].into_iter());
        svg.squares("none", core::iter::empty());
        svg.shapes("d", [(1.0, 2.0)].into_iter());
        svg.shapes("none", core::iter::empty());
        svg.polygon("p", [(1.0, 2.0), (3.0, 4.0), (0.0, 0.06)].into_iter());
        svg.begin_clip((1.0, 2.0), (3.0, 4.0));
        svg.end_clip();
        let (time, force) = (Axis::linear("t & u / s", -0.125, 2e6), Axis::log("f / N", 1e-3, 10.0));
        svg.begin_plot((1.0, 2.0), (3.0, 4.0), &time, &force);
        svg.end_clip();
        svg.begin_turn((5.0, 6.0), 2.0, 0.5);
        svg.end_clip();
        let expected = "<svg viewBox=\"0 0 10 20\" role=\"img\" xmlns=\"http://www.w3.org/2000/svg\">\
            <title>a &lt; b</title><path class=\"l\" d=\"M1.0 2.0L3.0 4.1\"/>\
            <rect class=\"r\" x=\"1.0\" y=\"2.0\" width=\"0.0\" height=\"3.0\"/>\
            <rect class=\"r\" x=\"1.0\" y=\"2.0\" width=\"4.0\" height=\"0.0\"/>\
            <circle class=\"c\" cx=\"1.0\" cy=\"2.0\" r=\"3.0\"/>\
            <text class=\"t\" x=\"5.0\" y=\"6.0\" text-anchor=\"middle\">x &amp; y</text>\
            <path class=\"curve k\" d=\"M0.0 1.0L2.0 3.0M4.0 5.0h0\"/>\
            <path class=\"dots d\" d=\"M1.0 2.0h0M3.0 4.0h0\"/>\
            <path class=\"squares s\" d=\"M1.0 2.0m-3-3h6v6h-6zM3.0 4.0m-3-3h6v6h-6z\"/>\
            <path class=\"shapes d\" d=\"M1.0 2.0m0-3.8 3.8 3.8-3.8 3.8-3.8-3.8z\"/>\
            <path class=\"p\" d=\"M1.0 2.0L3.0 4.0L0.0 0.1Z\"/>\
            <svg x=\"1.0\" y=\"2.0\" width=\"3.0\" height=\"4.0\" viewBox=\"1.0 2.0 3.0 4.0\"></svg>\
            <svg x=\"1.0\" y=\"2.0\" width=\"3.0\" height=\"4.0\" viewBox=\"1.0 2.0 3.0 4.0\" \
            data-x=\"t &amp; u / 10⁶ s;-0.000000125000;2.00000\" data-y=\"f / N;0.00100000;10.0000;log\"></svg>\
            <svg x=\"3.0\" y=\"4.0\" width=\"4.0\" height=\"4.0\" viewBox=\"3.0 4.0 4.0 4.0\" \
            overflow=\"visible\" data-turn=\"0.500\"></svg></svg>";
        assert_eq!(svg.finish(), expected);
    }
}
