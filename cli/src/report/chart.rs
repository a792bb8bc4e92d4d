//! A chart with two axes.

use super::axis::Axis;
use super::svg::{Anchor, Svg};
use crate::observe::Point;

/// Drawing units: the width of a phone's column, so that letters keep their size there.
const WIDTH: f64 = 340.0;
const HEIGHT: f64 = 235.0;
const LEFT: f64 = 44.0;
const RIGHT: f64 = 10.0;
const TOP: f64 = 24.0;
const BOTTOM: f64 = 36.0;
const PLOT: (f64, f64) = (WIDTH - LEFT - RIGHT, HEIGHT - TOP - BOTTOM);

/// Axes first, then whatever is drawn on them.
#[derive(Clone, Debug)]
pub(crate) struct Chart {
    svg: Svg,
    x: Axis,
    y: Axis,
}

impl Chart {
    /// An empty chart with grid and labels.
    pub(crate) fn new(title: &str, x: Axis, y: Axis) -> Self {
        let mut chart = Self { svg: Svg::new(WIDTH, HEIGHT, title), x, y };
        chart.draw_axes();
        chart.svg.begin_plot((LEFT, TOP), PLOT, &chart.x, &chart.y);
        chart
    }

    fn draw_axes(&mut self) {
        let (bottom, right) = (TOP + PLOT.1, LEFT + PLOT.0);
        let up: Vec<_> = self.y.placed_ticks(5, |value| self.place((self.x.low, value)).1);
        for (y, _) in &up {
            self.svg.line("grid", (LEFT, *y), (right, *y));
        }
        self.svg.ticks_up(LEFT - 5.0, &up);
        let across: Vec<_> = self.x.placed_ticks(6, |value| self.place((value, self.y.low)).0);
        for (x, _) in &across {
            self.svg.line("axis", (*x, bottom), (*x, bottom + 4.0));
        }
        self.svg.ticks_across(bottom + 15.0, &across);
        self.svg.line("axis", (LEFT, bottom), (right, bottom));
        self.svg.label("name", (2.0, 12.0), Anchor::Start, &self.y.title());
        self.svg.label("name", (right, bottom + 31.0), Anchor::End, &self.x.title());
    }

    fn place(&self, (x, y): (f64, f64)) -> (f64, f64) {
        (LEFT + PLOT.0 * self.x.place(x), TOP + PLOT.1 * (1.0 - self.y.place(y)))
    }

    /// A curve, broken between its pieces.
    pub(crate) fn curve(&mut self, class: &str, pieces: &[Vec<Point>]) {
        let placed: Vec<Vec<(f64, f64)>> = pieces
            .iter()
            .map(|piece| piece.iter().map(|point| self.place((point.time, point.value))).collect())
            .collect();
        self.svg.curve(class, placed.iter().map(Vec::as_slice));
    }

    /// Separate points.
    pub(crate) fn dots(&mut self, class: &str, points: &[(f64, f64)]) {
        let placed: Vec<_> = points.iter().map(|point| self.place(*point)).collect();
        self.svg.dots(class, placed.into_iter());
    }

    /// A line across, at a value of the y axis.
    pub(crate) fn level(&mut self, class: &str, value: f64) {
        let y = self.place((self.x.low, value)).1;
        self.svg.line(class, (LEFT, y), (LEFT + PLOT.0, y));
    }

    /// Lines upright, at values of the x axis.
    pub(crate) fn marks(&mut self, class: &str, values: impl Iterator<Item = f64>) {
        for value in values {
            let x = self.place((value, self.y.low)).0;
            self.svg.line(class, (x, TOP), (x, TOP + PLOT.1));
        }
    }

    pub(crate) fn finish(mut self) -> String {
        self.svg.end_clip();
        self.svg.finish()
    }
}

#[cfg(test)]
mod tests {
    use super::super::read_back::{Ruler, assert_readable, paths, points, rulers, size};
    use super::{Axis, Chart, Point};

    fn close(ruler: Ruler, place: f64, value: f64) -> bool {
        (ruler.at(place) - value).abs() <= ruler.error()
    }

    #[test]
    fn what_is_drawn_can_be_read_off_the_axes() {
        let curve: Vec<Vec<Point>> = (0..3)
            .map(|piece| {
                let time = |i: i32| f64::from(10 * piece + i);
                (0..=2 * piece).map(|i| Point { time: time(i), value: (0.3 * time(i)).sin() }).collect()
            })
            .collect();
        let dots = [(1.0, -0.7), (12.5, 0.3)];
        let x = Axis::linear("time / s", 0.0, 25.0);
        let y = Axis::rounded("force / N", -0.9, 0.9);
        let mut chart = Chart::new("test", x, y);
        chart.curve("a", &curve);
        chart.dots("b", &dots);
        chart.level("level", 0.25);
        chart.marks("mark", [3.0, 17.0].into_iter());
        let svg = chart.finish();
        assert_readable(&svg);
        let (across, up) = rulers(&svg);
        let all = paths(&svg);
        let drawn = &all.iter().find(|path| path.class == "curve a").unwrap().pieces;
        assert_eq!(drawn.iter().map(Vec::len).collect::<Vec<_>>(), [1, 3, 5]);
        for ((x, y), point) in drawn.concat().into_iter().zip(curve.concat()) {
            assert!(close(across, x, point.time) && close(up, y, point.value), "{point:?}");
        }
        let drawn = points(&svg, "dots b");
        assert_eq!(drawn.len(), 2);
        for ((x, y), dot) in drawn.into_iter().zip(dots) {
            assert!(close(across, x, dot.0) && close(up, y, dot.1), "{dot:?}");
        }
        // A level goes from edge to edge, a mark from top to bottom of the frame that all is cut at.
        let frame = svg.split_once("<svg x=\"").unwrap().1;
        let numbers: Vec<f64> = frame.split('"').step_by(2).take(4).map(|n| n.parse().unwrap()).collect();
        let [left, top, width, height] = numbers[..] else { panic!("{numbers:?}") };
        assert!(close(across, left, 0.0) && close(across, left + width, 25.0), "{numbers:?}");
        assert!(close(up, top, 1.0) && close(up, top + height, -1.0), "{numbers:?}");
        let level = points(&svg, "level");
        assert!(level.iter().all(|(_, y)| close(up, *y, 0.25)), "{level:?}");
        assert_eq!(level.iter().map(|(x, _)| *x).collect::<Vec<_>>(), [left, left + width]);
        let marks = points(&svg, "mark");
        for (index, time) in [3.0, 3.0, 17.0, 17.0].into_iter().enumerate() {
            assert!(close(across, marks[index].0, time), "{marks:?}");
        }
        assert_eq!(marks.iter().map(|(_, y)| *y).collect::<Vec<_>>(), [top, top + height, top, top + height]);
        // The axis runs along the lower edge, its marks hang from it.
        let axis: Vec<_> =
            all.iter().filter(|path| path.class == "axis").map(|path| &path.pieces[0]).collect();
        let (marks, line) = axis.split_at(axis.len() - 1);
        assert_eq!(*line[0], [(left, top + height), (left + width, top + height)]);
        for mark in marks {
            assert!(mark[0].1 == top + height && mark[1] == (mark[0].0, top + height + 4.0), "{mark:?}");
        }
        let (wide, high) = size(&svg);
        assert!(left > 0.0 && top > 0.0 && left + width < wide && top + height < high);
    }
}
