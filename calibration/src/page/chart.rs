//! A chart with two axes.

use super::{Anchor, Axis, Placed, Svg, text_width};

/// Drawing units: the width of a phone's column, so that letters keep their size there.
const WIDTH: f64 = 340.0;
const HEIGHT: f64 = 235.0;
const LEFT: f64 = 44.0;
const RIGHT: f64 = 10.0;
const TOP: f64 = 24.0;
const BOTTOM: f64 = 36.0;
const PLOT: (f64, f64) = (WIDTH - LEFT - RIGHT, HEIGHT - TOP - BOTTOM);

/// How many shapes a curve that goes all the way across has on it.
const SHAPES: usize = 6;
/// Curves have their shapes at places of their own, of which there are so many.
const CLASSES: [u8; 8] = *b"abcdefgh";

/// A chart with two axes: the axes first, then whatever is drawn on them. Points can be read under the pointer.
///
/// ```
/// use fingertip_calibration::page::{Axis, Chart};
///
/// let mut chart = Chart::new("Force over time", Axis::linear("time / s", 0.0, 2.0), Axis::rounded("force / N", 0.0, 9.0));
/// chart.curve("a", &[vec![(0.0, 1.0), (1.0, 8.0)], vec![(1.5, 4.0), (2.0, 5.0)]]);
/// chart.dots("b", &[(1.2, 3.0)]);
/// assert!(chart.finish().contains("data-x=\"time / s;0;2.00000\""));
/// ```
#[derive(Clone, Debug)]
pub struct Chart {
    svg: Svg,
    x: Axis,
    y: Axis,
}

impl Chart {
    /// An empty chart with grid and labels; `title` is what a screen reader says.
    #[must_use]
    pub fn new(title: &str, x: Axis, y: Axis) -> Self {
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

    pub(crate) fn place(&self, (x, y): (f64, f64)) -> (f64, f64) {
        (LEFT + PLOT.0 * self.x.place(x), TOP + PLOT.1 * (1.0 - self.y.place(y)))
    }

    /// A curve, broken between its pieces. It is known by its colour, its dashes, and the [shapes](Svg::shapes) on it; one
    /// that is `thick` or `wide` by that.
    pub fn curve<P: Copy + Into<(f64, f64)>>(&mut self, class: &str, pieces: &[Vec<P>]) {
        let placed: Vec<Vec<(f64, f64)>> = pieces
            .iter()
            .map(|piece| piece.iter().map(|point| self.place((*point).into())).collect())
            .collect();
        self.svg.curve(class, placed.iter().map(Vec::as_slice));
        if !class.contains(' ') {
            let shapes = placed.iter().flat_map(|piece| spread(class, piece)).collect::<Vec<_>>();
            self.svg.shapes(class, shapes.into_iter());
        }
    }

    /// Separate points.
    pub fn dots(&mut self, class: &str, points: &[(f64, f64)]) {
        let placed: Vec<_> = points.iter().map(|point| self.place(*point)).collect();
        self.svg.dots(class, placed.into_iter());
    }

    /// Separate points, as squares that are not filled.
    pub fn squares(&mut self, class: &str, points: &[(f64, f64)]) {
        let placed: Vec<_> = points.iter().map(|point| self.place(*point)).collect();
        self.svg.squares(class, placed.into_iter());
    }

    /// Names beside points, each where it has room: towards the middle if that is one, clear of the `others` if any place
    /// is, and nowhere if names stand everywhere. Those that come first have the choice.
    pub fn names(&mut self, named: &[(String, (f64, f64))], others: &[(f64, f64)]) {
        let dots: Vec<(f64, f64)> = others.iter().map(|dot| self.place(*dot)).collect();
        let mut placed = Placed::default();
        for (name, point) in named {
            let at = self.place(*point);
            let Some(beside) = Beside::find(name, at, &dots, &mut placed) else { continue };
            let anchor = if beside.to_the_right { Anchor::Start } else { Anchor::End };
            let across = if beside.to_the_right { Beside::GAP } else { -Beside::GAP };
            // The middle of small letters is a third of their size above the line that they stand on.
            self.svg.label("halo", (at.0 + across, at.1 + beside.down + 0.33 * NAME), anchor, name);
        }
    }

    /// The places of points in the drawing, for those who thin them.
    #[must_use]
    pub fn places(&self, points: &[(f64, f64)]) -> Vec<(f64, f64)> {
        points.iter().map(|point| self.place(*point)).collect()
    }

    /// A line across, at a value of the y axis.
    pub fn level(&mut self, class: &str, value: f64) {
        let y = self.place((self.x.low, value)).1;
        self.svg.line(class, (LEFT, y), (LEFT + PLOT.0, y));
    }

    /// Lines upright, at values of the x axis.
    pub fn marks(&mut self, class: &str, values: impl Iterator<Item = f64>) {
        for value in values {
            let x = self.place((value, self.y.low)).0;
            self.svg.line(class, (x, TOP), (x, TOP + PLOT.1));
        }
    }

    /// The drawing as it stands in a page.
    #[must_use]
    pub fn finish(mut self) -> String {
        self.svg.end_clip();
        self.svg.finish()
    }
}

/// Points of a piece of a curve that have a shape: about as far apart in each curve, and elsewhere in each.
fn spread(class: &str, piece: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let index = CLASSES.iter().position(|known| class.bytes().next() == Some(*known));
    let Some(index) = index else { return Vec::new() };
    let step = PLOT.0 / SHAPES as f64;
    let first = LEFT + step * (index as f64 + 0.5) / CLASSES.len() as f64;
    // Which place was reached last, counted from the first.
    let reached = |x: f64| ((x - first) / step).floor();
    let passes = |[a, b]: &[(f64, f64); 2]| (reached(b.0) > reached(a.0)).then_some(*b);
    piece.array_windows().filter_map(passes).collect()
}

/// Letters of names beside points.
const NAME: f64 = 11.5;

/// Where a name stands beside its dot.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Beside {
    to_the_right: bool,
    /// How far below the dot the middle of the name is.
    down: f64,
}

impl Beside {
    /// From the dot to the name.
    const GAP: f64 = 7.0;
    /// Half of the side of a dot, and some room.
    const DOT: f64 = 4.0;

    /// The first place that has room, towards the middle of the plot if that is one, and clear of all dots if any is;
    /// `None` if names stand everywhere.
    fn find(name: &str, at: (f64, f64), dots: &[(f64, f64)], placed: &mut Placed) -> Option<Self> {
        let inward = at.0 < LEFT + 0.5 * PLOT.0;
        let all = [0.0, -NAME, NAME]
            .into_iter()
            .flat_map(|down| [inward, !inward].map(|to_the_right| Self { to_the_right, down }));
        let room: Vec<(Self, [f64; 4])> = all
            .map(|beside| (beside, beside.taken(name, at)))
            .filter(|(_, [left, right, top, bottom])| {
                *left >= LEFT && *right <= LEFT + PLOT.0 && *top >= TOP && *bottom <= TOP + PLOT.1
            })
            .filter(|(_, taken)| placed.is_free(*taken))
            .collect();
        let is_clear = |(_, [left, right, top, bottom]): &&(Self, [f64; 4])| {
            let covers = |(x, y): &(f64, f64)| {
                left - Self::DOT < *x
                    && *x < right + Self::DOT
                    && top - Self::DOT < *y
                    && *y < bottom + Self::DOT
            };
            !dots.iter().any(|dot| *dot != at && covers(dot))
        };
        let (beside, taken) = room.iter().find(is_clear).or_else(|| room.first())?;
        placed.take(*taken).then_some(*beside)
    }

    /// The box of a name here: left, right, top, bottom.
    fn taken(self, name: &str, (x, y): (f64, f64)) -> [f64; 4] {
        let long = text_width(name, NAME);
        let left = if self.to_the_right { x + Self::GAP } else { x - Self::GAP - long };
        [left, left + long, y + self.down - 0.5 * NAME, y + self.down + 0.5 * NAME]
    }
}

#[cfg(test)]
mod tests {
    use fingertip_test_support::read_back::{Ruler, assert_readable, paths, points, rulers, size};

    use super::{Axis, Beside, CLASSES, Chart, LEFT, NAME, PLOT, Placed, TOP, text_width};

    fn close(ruler: Ruler, place: f64, value: f64) -> bool {
        (ruler.at(place) - value).abs() <= ruler.error()
    }

    #[test]
    fn what_is_drawn_can_be_read_off_the_axes() {
        let curve: Vec<Vec<(f64, f64)>> = (0..3)
            .map(|piece| {
                let time = |i: i32| f64::from(10 * piece + i);
                (0..=2 * piece).map(|i| (time(i), (0.3 * time(i)).sin())).collect()
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
            assert!(close(across, x, point.0) && close(up, y, point.1), "{point:?}");
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

    /// Every class has shapes of its own, on its curve, at places where no other has them; what is known by its width has
    /// none.
    #[test]
    fn curves_are_told_apart_by_their_shapes() {
        let level = |value: f64| vec![(0..=1000).map(|i| (f64::from(i) * 0.01, value)).collect::<Vec<_>>()];
        let mut chart = Chart::new("", Axis::linear("", 0.0, 10.0), Axis::linear("", 0.0, 9.0));
        for (class, value) in CLASSES
            .map(|class| (class as char).to_string())
            .iter()
            .map(String::as_str)
            .zip((1..).map(f64::from))
            .chain([("a wide", 8.5)])
        {
            chart.curve(class, &level(value));
        }
        let svg = chart.finish();
        let shapes: Vec<&str> =
            svg.split("class=\"shapes ").skip(1).map(|shape| shape.split('/').next().unwrap()).collect();
        assert_eq!(shapes.len(), 8);
        let mut places = Vec::new();
        let mut kinds = Vec::new();
        for (shape, value) in shapes.iter().zip(1..) {
            for piece in shape.split('M').skip(1) {
                let (at, kind) = piece.split_once('m').unwrap();
                let (x, y) = at.split_once(' ').unwrap();
                let expected = TOP + PLOT.1 * (1.0 - f64::from(value) / 9.0);
                assert!((y.parse::<f64>().unwrap() - expected).abs() < 0.06);
                places.push(x.parse::<f64>().unwrap());
                kinds.push((value, kind.trim_end_matches('"').to_owned()));
            }
        }
        assert_eq!(places.len(), 48);
        places.sort_by(f64::total_cmp);
        assert!(places.array_windows().all(|[a, b]| b - a > 5.0), "{places:?}");
        kinds.sort();
        kinds.dedup();
        assert_eq!(kinds.len(), 8, "{kinds:?}");
    }

    const MIDDLE: f64 = LEFT + 0.5 * PLOT.0;

    fn found(at: (f64, f64), dots: &[(f64, f64)], placed: &mut Placed) -> Option<(bool, f64)> {
        Beside::find("a name", at, dots, placed).map(|beside| (beside.to_the_right, beside.down))
    }

    /// Names stand towards the middle, and turn where a dot, another name or the edge is in their way.
    #[test]
    fn names_keep_clear_of_dots_names_and_edges() {
        let new = Placed::default;
        let (left, right) = ((MIDDLE - 70.0, 100.0), (MIDDLE + 70.0, 100.0));
        // The dot itself is in nobody's way.
        assert_eq!(found(left, &[left], &mut new()), Some((true, 0.0)));
        assert_eq!(found(right, &[right], &mut new()), Some((false, 0.0)));
        let beside = |right: f64, down: f64| (left.0 + right, 100.0 + down);
        let long = text_width("a name", NAME);
        for at in [beside(20.0, 4.0), beside(7.0 + long + 3.0, 0.0), beside(4.0, 0.0), beside(20.0, -9.0)] {
            assert_eq!(found(left, &[left, at], &mut new()), Some((false, 0.0)), "{at:?}");
        }
        for at in [beside(7.0 + long + 5.0, 0.0), beside(2.0, 0.0), beside(20.0, 10.0), beside(20.0, -10.0)] {
            assert_eq!(found(left, &[left, at], &mut new()), Some((true, 0.0)), "{at:?}");
        }
        // Of both sides: above, then below.
        let mut dots = vec![beside(20.0, 5.0), beside(-20.0, 5.0)];
        assert_eq!(found(left, &dots, &mut new()), Some((true, -NAME)));
        dots.extend([beside(20.0, -18.0), beside(-20.0, -18.0)]);
        dots.remove(0);
        assert_eq!(found(left, &[beside(20.0, -9.0), beside(-20.0, -9.0)], &mut new()), Some((true, NAME)));
        // Dots everywhere: over some of them rather than not at all.
        let everywhere: Vec<_> =
            (0..400).map(|i| beside(f64::from(i % 20 - 10) * 7.0, f64::from(i / 20 - 10) * 7.0)).collect();
        assert_eq!(found(left, &everywhere, &mut new()), Some((true, 0.0)));
        // Names in the way of names, until there is no room.
        let mut placed = new();
        let places: Vec<_> = (0..7).map_while(|_| found(left, &[], &mut placed)).collect();
        let all = [0.0, -NAME, NAME].map(|down| [(true, down), (false, down)]);
        assert_eq!(places, all.as_flattened());
        // At the edges.
        assert_eq!(found((LEFT + 4.0, TOP + 2.0), &[], &mut new()), Some((true, NAME)));
        let corner = (LEFT + PLOT.0 - 4.0, TOP + PLOT.1 - 2.0);
        assert_eq!(found(corner, &[], &mut new()), Some((false, -NAME)));
    }
}
