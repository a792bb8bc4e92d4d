//! Dimensions: how long something is, between arrows.

use super::letters::width;
use super::{Anchor, Pen, Sheet};

/// Length and half the width of an arrow's head \[mm\].
const HEAD: [f64; 2] = [2.0, 0.35];
/// Letters \[mm\].
const LETTERS: f64 = 2.5;
/// How far the lines that lead to a dimension go beyond it \[mm\].
const BEYOND: f64 = 1.0;

impl Sheet {
    /// How far two places are apart to the right, on a line at this height, with what it is called.
    pub(crate) fn across(&mut self, left: [f64; 2], right: [f64; 2], height: f64, label: &str) {
        let beyond = if height < left[1] { -BEYOND } else { BEYOND };
        for [x, y] in [left, right] {
            self.line(Pen::Thin, [x, y], [x, height + beyond]);
        }
        let (from, to) = (left[0], right[0]);
        self.arrows([from, height], [to, height]);
        let wide = width(label, LETTERS);
        // Beside it where there is no room between the arrows.
        if wide < (to - from).abs() - 1.0 {
            self.text([0.5 * (from + to), height - 0.8], LETTERS, Anchor::Middle, label);
        } else {
            let x = from.max(to) + HEAD[0] + 1.0;
            self.text([x, height + 0.9], LETTERS, Anchor::Start, label);
        }
    }

    /// How far two places are apart downwards, on a line at this place.
    pub(crate) fn down(&mut self, upper: [f64; 2], lower: [f64; 2], place: f64, label: &str) {
        let beyond = if place < upper[0] { -BEYOND } else { BEYOND };
        for [x, y] in [upper, lower] {
            self.line(Pen::Thin, [x, y], [place + beyond, y]);
        }
        self.arrows([place, upper[1]], [place, lower[1]]);
        let middle = 0.5 * (upper[1] + lower[1]) + 0.9;
        let (at, anchor) =
            if beyond < 0.0 { (place - 1.2, Anchor::End) } else { (place + 1.2, Anchor::Start) };
        self.text([at, middle], LETTERS, anchor, label);
    }

    /// A line with a head at either end: outside, pointing inwards, where there is no room inside.
    fn arrows(&mut self, from: [f64; 2], to: [f64; 2]) {
        let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
        let length = dx.hypot(dy);
        if length > 0.0 {
            let along = [dx / length, dy / length];
            let inside = length > 3.0 * HEAD[0];
            let out = if inside { 0.0 } else { HEAD[0] + 1.5 };
            let end = |[x, y]: [f64; 2], far: f64| [x + far * along[0], y + far * along[1]];
            self.line(Pen::Thin, end(from, -out), end(to, out));
            let turn = if inside { 1.0 } else { -1.0 };
            self.head(from, along.map(|part| part * turn));
            self.head(to, along.map(|part| -part * turn));
        }
    }

    /// The head of an arrow with its tip at a place; `along` leads from the tip to its foot.
    fn head(&mut self, [x, y]: [f64; 2], [along, up]: [f64; 2]) {
        let [long, half] = HEAD;
        let foot = [x + long * along, y + long * up];
        let side = |s: f64| [foot[0] - s * half * up, foot[1] + s * half * along];
        self.filled([[x, y], side(1.0), side(-1.0)]);
    }
}
