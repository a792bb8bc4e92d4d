//! Drawings in millimetres, whose colours are classes of the book's style sheet, so that they follow its theme.

use core::fmt::Write;

use nalgebra::Vector2;

/// A point of a drawing \[mm\], y up.
pub(super) type Point = Vector2<f64>;

/// A drawing that is begun.
pub(super) struct Svg {
    low: Point,
    high: Point,
    /// Pixels per millimetre.
    scale: f64,
    body: String,
}

impl Svg {
    /// From corner to corner.
    pub(super) fn new(low: [f64; 2], high: [f64; 2], scale: f64) -> Self {
        Self { low: low.into(), high: high.into(), scale, body: String::new() }
    }

    fn place(&self, point: Point) -> Point {
        Point::new((point.x - self.low.x) * self.scale, (self.high.y - point.y) * self.scale)
    }

    // Writing to a String cannot fail.
    pub(super) fn line(&mut self, class: &str, from: Point, to: Point) {
        let (a, b) = (self.place(from), self.place(to));
        let _ = writeln!(
            self.body,
            "<line class=\"{class}\" x1=\"{:.1}\" y1=\"{:.1}\" x2=\"{:.1}\" y2=\"{:.1}\"/>",
            a.x, a.y, b.x, b.y
        );
    }

    /// A line with a head at `to`.
    pub(super) fn arrow(&mut self, class: &str, from: Point, to: Point) {
        let along = to - from;
        let length = along.norm();
        if !(length > 0.0) {
            return;
        }
        let (along, head) = (along / length, 9.0 / self.scale);
        let across = Point::new(-along.y, along.x);
        self.line(class, from, to - along * (0.7 * head));
        let corners =
            [to, to - along * head + across * (0.4 * head), to - along * head - across * (0.4 * head)];
        self.polygon(&format!("{class} head"), &corners);
    }

    pub(super) fn polygon(&mut self, class: &str, corners: &[Point]) {
        let points: Vec<String> = corners
            .iter()
            .map(|corner| self.place(*corner))
            .map(|at| format!("{:.1},{:.1}", at.x, at.y))
            .collect();
        let _ = writeln!(self.body, "<polygon class=\"{class}\" points=\"{}\"/>", points.join(" "));
    }

    pub(super) fn curve(&mut self, class: &str, corners: &[Point]) {
        let points: Vec<String> = corners
            .iter()
            .map(|corner| self.place(*corner))
            .map(|at| format!("{:.1},{:.1}", at.x, at.y))
            .collect();
        let _ = writeln!(self.body, "<polyline class=\"{class}\" points=\"{}\"/>", points.join(" "));
    }

    pub(super) fn circle(&mut self, class: &str, centre: Point, radius: f64) {
        let at = self.place(centre);
        let _ = writeln!(
            self.body,
            "<circle class=\"{class}\" cx=\"{:.1}\" cy=\"{:.1}\" r=\"{:.1}\"/>",
            at.x,
            at.y,
            radius * self.scale
        );
    }

    /// A dot of a size that does not depend on the scale.
    pub(super) fn dot(&mut self, class: &str, at: Point) {
        self.circle(class, at, 4.5 / self.scale);
    }

    /// Text; `anchor` is `start`, `middle` or `end`.
    pub(super) fn text(&mut self, class: &str, at: Point, anchor: &str, text: &str) {
        let at = self.place(at);
        let text = text.replace('&', "&amp;").replace('<', "&lt;");
        let _ = writeln!(
            self.body,
            "<text class=\"{class}\" x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"{anchor}\">{text}</text>",
            at.x, at.y
        );
    }

    /// The drawing with what stands below it; `said` is for readers who do not see it.
    pub(super) fn figure(&self, said: &str, caption: &str) -> String {
        let size = (self.high - self.low) * self.scale;
        format!(
            "<figure class=\"drawing\">\n<svg viewBox=\"0 0 {:.0} {:.0}\" style=\"max-width: {:.0}px\" role=\"img\" \
             aria-label=\"{said}\">\n{}</svg>\n<figcaption>{caption}</figcaption>\n</figure>\n",
            size.x, size.y, size.x, self.body
        )
    }
}
