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

    /// The drawing when it is done; `said` is for readers who do not see it, `caption` stands below it.
    pub(super) fn drawing(&self, said: &'static str, caption: &'static str) -> Drawing {
        Drawing { size: (self.high - self.low) * self.scale, body: self.body.clone(), said, caption }
    }
}

/// Letters on a phone are this part of the drawing's width, so that they are read there: some 11 of 350 pixels.
const ON_PHONE: f64 = 0.031;

/// A drawing that is done.
pub(super) struct Drawing {
    /// In pixels.
    size: Point,
    body: String,
    said: &'static str,
    caption: &'static str,
}

/// What the style sheet of the book says of a drawing, for one that stands by itself, on paper of its own: who shows it may have
/// any theme.
const STYLE: &str = "\
svg { --force: #d55e00; --contact: #0072b2; --normal: #009e73; --far: #b0307a; --body: #8884; --paper: #fff; color: #222; }
@media (prefers-color-scheme: dark) { svg { --force: #ff9a4d; --contact: #6cc4ff; --normal: #43d6a5; --far: #ff8fc7; \
     --body: #aaa4; --paper: #1c1f24; color: #ddd; } }
.paper { fill: var(--paper); }
";

impl Drawing {
    /// As a part of a page of the book, whose theme it follows.
    pub(super) fn figure(&self) -> String {
        let Self { size, body, said, caption } = self;
        format!(
            "<figure class=\"drawing\">\n<svg viewBox=\"0 0 {:.0} {:.0}\" style=\"max-width: {:.0}px; --on-phone: {:.0}px\" \
             role=\"img\" aria-label=\"{said}\">\n{body}</svg>\n<figcaption>{caption}</figcaption>\n</figure>\n",
            size.x,
            size.y,
            size.x,
            ON_PHONE * size.x
        )
    }

    /// As an image of its own; `sheet` is the style sheet of the book.
    pub(super) fn image(&self, sheet: &str) -> String {
        let Self { size, body, said, .. } = self;
        let rules: String = sheet
            .lines()
            .filter(|line| line.starts_with("figure.drawing ") && !line.contains("figcaption"))
            .filter(|line| !line.starts_with("figure.drawing svg"))
            .map(|line| line.replace("figure.drawing ", "") + "\n")
            .collect();
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0} {1:.0}\" width=\"{0:.0}\" height=\"{1:.0}\" \
             role=\"img\" aria-label=\"{said}\">\n<style>\n{STYLE}{rules}</style>\n<rect class=\"paper\" width=\"100%\" \
             height=\"100%\" rx=\"6\"/>\n{body}</svg>\n",
            size.x, size.y
        )
    }
}
