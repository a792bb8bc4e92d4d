//! A function of two variables as a map with contour lines.

use fingertip_calibration::page::{Anchor, Axis, Svg};

use crate::table::short;

const WIDTH: f64 = 520.0;
const HEIGHT: f64 = 340.0;
const LEFT: f64 = 48.0;
const TOP: f64 = 24.0;
const PLOT: (f64, f64) = (WIDTH - LEFT - 14.0, HEIGHT - TOP - 42.0);
/// Each contour over the least value; no more than there are colours.
const LEVELS: [f64; 7] = [1.02, 1.1, 1.3, 1.7, 2.5, 5.0, 15.0];

/// A grid of values; what is not finite has no contour.
pub(crate) struct Contours<'a> {
    pub(crate) title: &'a str,
    pub(crate) x: Axis,
    pub(crate) y: Axis,
    pub(crate) xs: &'a [f64],
    pub(crate) ys: &'a [f64],
    /// `values[row][column]`.
    pub(crate) values: &'a [Vec<f64>],
    /// Places to mark, the best first.
    pub(crate) marks: &'a [(f64, f64)],
}

type Segment = [(f64, f64); 2];

/// Draws it; also the levels and the classes of their colours, for the key.
pub(crate) fn draw(contours: &Contours<'_>) -> (String, Vec<(&'static str, String)>) {
    let Contours { title, x, y, xs, ys, values, marks } = contours;
    let mut svg = Svg::new(WIDTH, HEIGHT, title);
    let bottom = TOP + PLOT.1;
    let rows = y.placed_ticks(6, |value| bottom - PLOT.1 * y.place(value));
    for (at, _) in &rows {
        svg.line("grid", (LEFT, *at), (LEFT + PLOT.0, *at));
    }
    svg.ticks_up(LEFT - 5.0, &rows);
    let columns = x.placed_ticks(7, |value| LEFT + PLOT.0 * x.place(value));
    for (at, _) in &columns {
        svg.line("grid", (*at, TOP), (*at, bottom));
    }
    svg.ticks_across(bottom + 15.0, &columns);
    svg.label("name", (2.0, 12.0), Anchor::Start, &y.title());
    svg.label("name", (LEFT + PLOT.0, bottom + 32.0), Anchor::End, &x.title());

    let least = values.iter().flatten().copied().fold(f64::INFINITY, f64::min);
    let place = |(a, b): (f64, f64)| (LEFT + PLOT.0 * x.place(a), bottom - PLOT.1 * y.place(b));
    let classes = ["q0", "q1", "q2", "q3", "q4", "q5", "q6"];
    let mut keys = Vec::new();
    svg.begin_plot((LEFT, TOP), PLOT, x, y);
    for (level, class) in LEVELS.iter().zip(classes) {
        let lines = segments(xs, ys, values, level * least);
        if lines.is_empty() {
            continue;
        }
        let placed: Vec<Segment> = lines.into_iter().map(|[a, b]| [place(a), place(b)]).collect();
        svg.curve(class, placed.iter().map(<[_; 2]>::as_slice));
        keys.push((class, short(level * least)));
    }
    svg.end_clip();
    for (rank, mark) in marks.iter().enumerate() {
        let (mark_x, mark_y) = place(*mark);
        let size = if rank == 0 { 6.0 } else { 4.0 };
        let class = if rank == 0 { "curve wide d" } else { "curve wide e" };
        svg.line(class, (mark_x - size, mark_y), (mark_x + size, mark_y));
        svg.line(class, (mark_x, mark_y - size), (mark_x, mark_y + size));
    }
    (svg.finish(), keys)
}

/// Where bilinear pieces cross a level (marching squares; a saddle is split by its middle).
fn segments(xs: &[f64], ys: &[f64], values: &[Vec<f64>], level: f64) -> Vec<Segment> {
    let mut found = Vec::new();
    for (ys, rows) in ys.windows(2).zip(values.windows(2)) {
        let cells = rows[0].windows(2).zip(rows[1].windows(2));
        for (xs, (below, above)) in xs.windows(2).zip(cells) {
            // Around the cell, from the lower left corner.
            let corners = [
                ((xs[0], ys[0]), below[0]),
                ((xs[1], ys[0]), below[1]),
                ((xs[1], ys[1]), above[1]),
                ((xs[0], ys[1]), above[0]),
            ];
            if corners.iter().any(|(_, value)| !value.is_finite()) {
                continue;
            }
            let mut crossings = Vec::with_capacity(4);
            for side in 0..4 {
                let ((a, low), (b, high)) = (corners[side], corners[(side + 1) % 4]);
                if (low < level) != (high < level) {
                    let part = (level - low) / (high - low);
                    crossings.push((a.0 + part * (b.0 - a.0), a.1 + part * (b.1 - a.1)));
                }
            }
            match crossings[..] {
                [a, b] => found.push([a, b]),
                [a, b, c, d] => {
                    let middle = corners.iter().map(|(_, value)| value).sum::<f64>() / 4.0;
                    if (middle < level) == (corners[0].1 < level) {
                        found.extend([[a, b], [c, d]]);
                    } else {
                        found.extend([[d, a], [b, c]]);
                    }
                }
                _ => {}
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::{Axis, Contours, LEVELS, draw, segments};
    use fingertip_test_support::read_back::{assert_readable, paths, rulers};

    #[test]
    fn contour_of_a_cone_is_a_circle() {
        let grid: Vec<f64> = (0..=80).map(|i| f64::from(i) / 40.0 - 1.0).collect();
        let values: Vec<Vec<f64>> = grid.iter().map(|y| grid.iter().map(|x| x.hypot(*y)).collect()).collect();
        let found = segments(&grid, &grid, &values, 0.6);
        let length: f64 = found.iter().map(|[a, b]| (a.0 - b.0).hypot(a.1 - b.1)).sum();
        assert!((length / (core::f64::consts::TAU * 0.6) - 1.0).abs() < 2e-3, "{length}");
        assert!(found.iter().flatten().all(|(x, y)| (x.hypot(*y) - 0.6).abs() < 1e-3));
    }

    #[test]
    fn saddles_and_holes_are_no_trouble() {
        let (xs, ys) = ([0.0, 1.0], [0.0, 1.0]);
        assert_eq!(segments(&xs, &ys, &[vec![0.0, 1.0], vec![1.0, 0.0]], 0.5).len(), 2);
        assert!(segments(&xs, &ys, &[vec![0.0, f64::INFINITY], vec![1.0, 0.0]], 0.5).is_empty());
    }

    #[test]
    fn contours_of_an_inclined_plane_are_straight() {
        // x/3 + y = 1 over the rectangle from (0, 0) to (3, 2), in cells of different sizes: from (0, 1) to (3, 0).
        let (xs, ys) = ([0.0, 0.5, 2.0, 3.0], [0.0, 0.3, 1.5, 2.0]);
        let values: Vec<Vec<f64>> =
            ys.iter().map(|y| xs.iter().map(|x| 10.0 + x / 3.0 + y).collect()).collect();
        let found = segments(&xs, &ys, &values, 11.0);
        let length: f64 = found.iter().map(|[a, b]| (a.0 - b.0).hypot(a.1 - b.1)).sum();
        assert!((length - 10.0_f64.sqrt()).abs() < 1e-12, "{length}");
        assert!(found.iter().flatten().all(|(x, y)| (x / 3.0 + y - 1.0).abs() < 1e-12), "{found:?}");
        assert!(segments(&xs, &ys, &values, 9.9).is_empty() && segments(&xs, &ys, &values, 13.1).is_empty());
    }

    #[test]
    fn a_saddle_is_split_by_its_middle() {
        let near = |found: &[[(f64, f64); 2]], expected: [[(f64, f64); 2]; 2]| {
            let same = |a: &[(f64, f64); 2], b: &[(f64, f64); 2]| {
                let close = |p: (f64, f64), q: (f64, f64)| (p.0 - q.0).hypot(p.1 - q.1) < 1e-12;
                close(a[0], b[0]) && close(a[1], b[1]) || close(a[0], b[1]) && close(a[1], b[0])
            };
            assert_eq!(found.len(), 2);
            assert!(
                expected.iter().all(|segment| found.iter().any(|other| same(segment, other))),
                "{found:?}"
            );
        };
        // The middle is 0.5. A level below it cuts the low corners off, one above it the high ones.
        let (xs, ys) = ([0.0, 1.0], [0.0, 1.0]);
        let low_first = [vec![0.0, 1.0], vec![1.0, 0.0]];
        near(&segments(&xs, &ys, &low_first, 0.4), [[(0.4, 0.0), (0.0, 0.4)], [(1.0, 0.6), (0.6, 1.0)]]);
        near(&segments(&xs, &ys, &low_first, 0.6), [[(0.6, 0.0), (1.0, 0.4)], [(0.4, 1.0), (0.0, 0.6)]]);
        let high_first = [vec![1.0, 0.0], vec![0.0, 1.0]];
        near(&segments(&xs, &ys, &high_first, 0.4), [[(0.6, 0.0), (1.0, 0.4)], [(0.4, 1.0), (0.0, 0.6)]]);
        near(&segments(&xs, &ys, &high_first, 0.6), [[(0.4, 0.0), (0.0, 0.4)], [(1.0, 0.6), (0.6, 1.0)]]);
    }

    #[test]
    fn the_drawing_read_by_its_axes_has_the_contours_where_they_are() {
        // 5 (1 + r) about (30, 2), on axes that are not alike: each level is an ellipse.
        let xs: Vec<f64> = (0..=60).map(f64::from).collect();
        let ys: Vec<f64> = (0..=60).map(|i| f64::from(i) / 15.0).collect();
        let radius = |x: f64, y: f64| ((x - 30.0) / 15.0).hypot(y - 2.0);
        let values: Vec<Vec<f64>> =
            ys.iter().map(|y| xs.iter().map(|x| 5.0 * (1.0 + radius(*x, *y))).collect()).collect();
        let (svg, keys) = draw(&Contours {
            title: "test",
            x: Axis::linear("Q / °", 0.0, 60.0),
            y: Axis::linear("d / mm", 0.0, 4.0),
            xs: &xs,
            ys: &ys,
            values: &values,
            marks: &[(30.0, 2.0), (15.0, 1.0)],
        });
        assert_readable(&svg);
        let (across, up) = rulers(&svg);
        let all = paths(&svg);
        // The levels over the least value, 5, as far as they are reached: r = level − 1 up to 2·√2.
        let reached: Vec<f64> = LEVELS.into_iter().filter(|level| *level < 1.0 + 8.0_f64.sqrt()).collect();
        assert_eq!(keys.len(), reached.len());
        for ((class, name), level) in keys.iter().zip(&reached) {
            assert!((name.parse::<f64>().unwrap() / (5.0 * level) - 1.0).abs() < 1e-9, "{name}");
            let path = all.iter().find(|path| path.class == format!("curve {class}")).unwrap();
            let mut seen = 0;
            for (x, y) in path.pieces.concat() {
                let found = 1.0 + radius(across.at(x), up.at(y));
                // The cone is bilinear only within cells of 1/15, the places are rounded.
                assert!((found - level).abs() < 0.02, "{class}: {found} for {level}");
                seen += 1;
            }
            assert!(seen >= 8, "{class}");
        }
        // Crosses: the best is larger and of another class.
        let crosses = |class: &str, size: f64, at: (f64, f64)| {
            let lines: Vec<_> =
                all.iter().filter(|path| path.class == class).map(|path| &path.pieces[0]).collect();
            let [level, upright] = lines[..] else { panic!("{} lines", lines.len()) };
            let middle = |line: &[(f64, f64)]| (0.5 * (line[0].0 + line[1].0), 0.5 * (line[0].1 + line[1].1));
            for line in [level, upright] {
                let (x, y) = middle(line);
                assert!((across.at(x) - at.0).abs() < across.error() && (up.at(y) - at.1).abs() < up.error());
            }
            assert!((level[1].0 - level[0].0 - 2.0 * size).abs() < 0.11 && level[0].1 == level[1].1);
            assert!((upright[1].1 - upright[0].1 - 2.0 * size).abs() < 0.11 && upright[0].0 == upright[1].0);
        };
        crosses("curve wide d", 6.0, (30.0, 2.0));
        crosses("curve wide e", 4.0, (15.0, 1.0));
    }
}
