//! Heightfields against a bilinear interpolation written down again, and lines followed in small steps.

use fingertip_surfaces::*;
use fingertip_wrench::Line;
use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

const CORNER: [f64; 2] = [-0.7, 0.4];
const SPACING: [f64; 2] = [0.5, 0.3];
const COLUMNS: usize = 6;
const ROWS: usize = 5;

fn heights(roughness: f64) -> Vec<f64> {
    let mut random = Pcg64Mcg::seed_from_u64(21);
    (0..COLUMNS * ROWS).map(|_| roughness * random.random_range(-1.0..1.0)).collect()
}

fn field(heights: &[f64]) -> Heightfield<f64> {
    Heightfield::new(CORNER, SPACING, COLUMNS, heights.to_vec()).unwrap()
}

/// The height over the grid by its four neighbours; `None` beside the grid, but for rounding.
fn height(heights: &[f64], x: f64, y: f64) -> Option<f64> {
    let (u, v) = ((x - CORNER[0]) / SPACING[0], (y - CORNER[1]) / SPACING[1]);
    if !(-1e-12..=(COLUMNS - 1) as f64 + 1e-12).contains(&u)
        || !(-1e-12..=(ROWS - 1) as f64 + 1e-12).contains(&v)
    {
        return None;
    }
    let (i, j) = ((u as usize).min(COLUMNS - 2), (v as usize).min(ROWS - 2));
    let (s, t) = (u - i as f64, v - j as f64);
    let at = |i: usize, j: usize| heights[j * COLUMNS + i];
    Some(
        at(i, j) * (1.0 - s) * (1.0 - t)
            + at(i + 1, j) * s * (1.0 - t)
            + at(i, j + 1) * (1.0 - s) * t
            + at(i + 1, j + 1) * s * t,
    )
}

fn within(random: &mut Pcg64Mcg) -> Vector3<f64> {
    Vector3::new(
        random.random_range(-0.7..1.8),
        random.random_range(0.4..1.6),
        random.random_range(-0.3..0.3),
    )
}

/// How far the line is above the surface, where there is one.
fn above(heights: &[f64], line: &Line<f64>, along: f64) -> Option<f64> {
    let p = line.at(along);
    height(heights, p.x, p.y).map(|h| p.z - h)
}

/// Every change of sign in steps of a thousandth is a crossing, and there are no others but pairs closer
/// than a step.
#[test]
fn crossings_are_where_the_line_passes_the_height() {
    let mut random = Pcg64Mcg::seed_from_u64(22);
    let heights = heights(0.3);
    let surface = field(&heights);
    let (mut seen, mut several) = (0, 0);
    for _ in 0..1500 {
        let (a, b) = (within(&mut random), within(&mut random));
        let line =
            Line { point: a + (a - b) * random.random_range(-2.0..2.0), direction: (b - a).normalize() };
        let mut found = Vec::new();
        surface.crossings(&line, |c| found.push(c));
        found.sort_by(|a, b| a.along.total_cmp(&b.along));
        for crossing in &found {
            assert!(above(&heights, &line, crossing.along).is_none_or(|h| h.abs() < 1e-13), "{crossing:?}");
            assert!((crossing.point - line.at(crossing.along)).norm() < 1e-13 && crossing.active);
            assert!((crossing.normal - surface.normal(&crossing.point)).norm() < 1e-7);
        }
        let middle = line.direction.dot(&(Vector3::new(0.5, 1.0, 0.0) - line.point));
        let steps: Vec<f64> = (-3000..3000).map(|k| middle + f64::from(k) * 1e-3).collect();
        let mut expected = 0;
        for pair in steps.windows(2) {
            let [from, to] = [pair[0], pair[1]].map(|t| above(&heights, &line, t));
            let (Some(from), Some(to)) = (from, to) else { continue };
            let here = found.iter().filter(|c| c.along >= pair[0] && c.along < pair[1]).count();
            let changes = usize::from((from > 0.0) != (to > 0.0));
            assert_eq!(here % 2, changes, "{line:?} {pair:?} {found:?}");
            expected += changes;
        }
        seen += expected;
        several += usize::from(expected > 1);
    }
    assert!(seen > 1000 && several > 200, "{seen} {several}");
}

#[test]
fn the_inside_is_below() {
    let mut random = Pcg64Mcg::seed_from_u64(23);
    let heights = heights(0.3);
    let surface = field(&heights);
    for _ in 0..5000 {
        let p = Vector3::from_fn(|_, _| random.random_range(-1.0..2.0));
        let expected = height(&heights, p.x, p.y).is_some_and(|h| p.z < h);
        assert_eq!(surface.contains(&p), expected, "{p}");
    }
    // The borders of the grid, and beside them.
    for (x, y, inside) in [(-0.7, 0.4, true), (1.8, 1.6, true), (-0.71, 1.0, false), (1.81, 1.0, false)] {
        assert_eq!(surface.contains(&Vector3::new(x, y, -1.0)), inside, "{x} {y}");
    }
    assert!(
        !surface.contains(&Vector3::new(0.0, 0.39, -1.0))
            && !surface.contains(&Vector3::new(0.0, 1.61, -1.0))
    );
    assert!(!surface.contains(&Vector3::new(f64::NAN, 1.0, -1.0)));
}

/// Level function, normal and curvature, by differences of the height within a cell.
#[test]
fn derivatives_within_a_cell() {
    let mut random = Pcg64Mcg::seed_from_u64(24);
    let heights = heights(0.3);
    let surface = field(&heights);
    for _ in 0..1000 {
        let place = |low: f64, step: f64, random: &mut Pcg64Mcg| {
            low + step * (f64::from(random.random_range(0..4_u8)) + random.random_range(0.1..0.9))
        };
        let (x, y) = (place(-0.7, 0.5, &mut random), place(0.4, 0.3, &mut random));
        let h = |dx: f64, dy: f64| height(&heights, x + dx, y + dy).unwrap();
        // Bilinear: differences of any step are exact but for rounding.
        let step = 0.01;
        let by_x = (h(step, 0.0) - h(-step, 0.0)) / (2.0 * step);
        let by_y = (h(0.0, step) - h(0.0, -step)) / (2.0 * step);
        let twist = (h(step, step) - h(-step, step) - h(step, -step) + h(-step, -step)) / (4.0 * step * step);
        let point = Vector3::new(x, y, h(0.0, 0.0) + 0.2);
        let level = surface.level(&point);
        assert!((level.value - 0.2).abs() < 1e-14);
        assert!((level.gradient - Vector3::new(-by_x, -by_y, 1.0)).norm() < 1e-12);
        assert!(
            (level.hessian[(0, 1)] + twist).abs() < 1e-10 && level.hessian[(0, 1)] == level.hessian[(1, 0)]
        );
        assert_eq!(level.hessian.iter().filter(|x| **x != 0.0).count(), 2);
        assert!((surface.normal(&point) - level.gradient.normalize()).norm() < 1e-14);
    }
    let extent = surface.extent();
    let (low, high) = heights.iter().fold((1.0_f64, -1.0_f64), |(a, b), h| (a.min(*h), b.max(*h)));
    assert!((extent.centre - Vector3::new(0.55, 1.0, (low + high) / 2.0)).norm() < 1e-15);
    let half = Vector3::new(1.25, 0.6, (high - low) / 2.0);
    assert!((extent.radius - half.norm()).abs() < 1e-15);
    assert_eq!(surface.size(), [COLUMNS, ROWS]);
}

/// The least distance of a line from one cell: a grid of places, ever finer about the best of them.
fn least_in_cell(heights: &[f64], line: &Line<f64>, cell: [usize; 2]) -> f64 {
    let [x, y] = [0, 1].map(|k| CORNER[k] + SPACING[k] * cell[k] as f64);
    let distance = |s: f64, t: f64| {
        // A hair within, so that no neighbour answers.
        let [x, y] = [x + SPACING[0] * s.clamp(1e-9, 1.0 - 1e-9), y + SPACING[1] * t.clamp(1e-9, 1.0 - 1e-9)];
        let away = Vector3::new(x, y, height(heights, x, y).unwrap()) - line.point;
        (away - line.direction * away.dot(&line.direction)).norm()
    };
    let (mut best, mut at, mut reach) = (f64::INFINITY, [0.5, 0.5], 0.5);
    for _ in 0..24 {
        let middle = at;
        for i in -10..=10 {
            for j in -10..=10 {
                let [s, t] = [middle[0] + reach * 0.1 * f64::from(i), middle[1] + reach * 0.1 * f64::from(j)];
                let found = distance(s.clamp(0.0, 1.0), t.clamp(0.0, 1.0));
                if found < best {
                    (best, at) = (found, [s.clamp(0.0, 1.0), t.clamp(0.0, 1.0)]);
                }
            }
        }
        reach *= 0.3;
    }
    best
}

/// Over places within cells, of a line that passes close by: it is nearest there or somewhere nearer.
#[test]
fn nothing_is_nearer_than_the_closest_approach() {
    let mut random = Pcg64Mcg::seed_from_u64(25);
    let heights = heights(0.3);
    let surface = field(&heights);
    let (mut missed, mut attained) = (0, 0);
    for _ in 0..600 {
        let cell = [random.random_range(0..COLUMNS - 1), random.random_range(0..ROWS - 1)];
        let [x, y] =
            [0, 1].map(|k| CORNER[k] + SPACING[k] * (cell[k] as f64 + random.random_range(0.2..0.8)));
        let place = Vector3::new(x, y, height(&heights, x, y).unwrap());
        let normal = surface.normal(&place);
        let direction = normal.cross(&Vector3::from_fn(|_, _| random.random_range(-1.0..1.0))).normalize();
        let line = Line { point: place + normal * random.random_range(0.0..0.05), direction };
        let mut meets = false;
        surface.crossings(&line, |_| meets = true);
        if meets {
            continue;
        }
        missed += 1;
        let found = surface.closest_approach(&line).unwrap();
        let away = found.point - line.point;
        let distance = (away - direction * away.dot(&direction)).norm();
        assert!((distance - found.gap).abs() < 1e-14, "{line:?} {found:?}");
        // On the border of the grid it may lie beside it by rounding.
        let [x, y] = [found.point.x.clamp(CORNER[0], 1.8), found.point.y.clamp(CORNER[1], 1.6)];
        assert!((found.point.xy() - nalgebra::Vector2::new(x, y)).norm() < 1e-14, "{line:?} {found:?}");
        let on = height(&heights, x, y).unwrap();
        assert!((on - found.point.z).abs() < 1e-13, "{line:?} {found:?}");
        let least = least_in_cell(&heights, &line, cell);
        assert!(found.gap <= least + 1e-8, "{line:?} {found:?} {least}");
        attained += usize::from(found.gap > least - 1e-8);
    }
    println!("{missed} lines miss, {attained} are nearest to the cell they were made for");
    assert!(missed > 50 && attained > 30, "{missed} {attained}");
}

#[test]
fn grids_that_are_none() {
    let new =
        |corner, spacing, columns, count: usize| Heightfield::new(corner, spacing, columns, vec![0.0; count]);
    assert!(new(CORNER, SPACING, 2, 4).is_ok());
    for (columns, count) in [(0, 0), (0, 4), (1, 4), (2, 2), (2, 5), (4, 4), (5, 4), (usize::MAX, 4)] {
        assert!(new(CORNER, SPACING, columns, count).is_err(), "{columns} {count}");
    }
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(new(CORNER, [bad, 1.0], 2, 4).is_err() && new(CORNER, [1.0, bad], 2, 4).is_err(), "{bad}");
    }
    for bad in [f64::NAN, f64::INFINITY] {
        assert!(new([bad, 0.0], SPACING, 2, 4).is_err() && new([0.0, bad], SPACING, 2, 4).is_err());
        assert!(Heightfield::new(CORNER, SPACING, 2, vec![0.0, 0.0, 0.0, bad]).is_err());
    }
}

/// The border belongs to the grid, for lines that run along an axis, too.
#[test]
fn lines_along_the_border_cross_it() {
    let heights = heights(0.1);
    let surface = field(&heights);
    let (right, back) = (CORNER[0] + SPACING[0] * 5.0, CORNER[1] + SPACING[1] * 4.0);
    for [x, y] in [[CORNER[0], 0.7], [right, 0.7], [0.1, CORNER[1]], [0.1, back]] {
        let line = Line { point: Vector3::new(x, y, 2.0), direction: -Vector3::z() };
        let mut found = Vec::new();
        surface.crossings(&line, |crossing| found.push(crossing.point));
        let expected = height(&heights, x, y).unwrap();
        assert!(found.iter().any(|point| (point.z - expected).abs() < 1e-12), "{x} {y}: {found:?}");
    }
}
