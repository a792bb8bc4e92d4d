//! A net of points over a surface, for drawing it.

use core::f64::consts::{PI, TAU};

use fingertip::surfaces::{ActiveSurface, Crossing, DynSurface, SmoothSurface};
use fingertip::wrench::Line;
use fingertip_scene::{MapKind, Projection};
use nalgebra::Vector3;

/// Points around the pole, and steps from pole to pole.
pub(super) const COLUMNS: usize = 36;
pub(super) const ROWS: usize = 18;
/// Halvings of the angle in which a rim is looked for.
const HALVINGS: usize = 14;
/// Steps of a ray to the surface of a formula, and halvings of the last one.
const STEPS: usize = 64;
const MARCH_HALVINGS: usize = 40;
/// Shapes without an end say that they reach so far \[m\].
const ENDLESS: f64 = 0.9;
/// What is shown of a shape without an end where nothing touched \[m\].
const LEAST_REACH: f64 = 0.01;
/// Endless shapes are shown so much farther than their contacts reach.
const ROOM: f64 = 1.5;

type Point = Vector3<f64>;

/// Points where rays from outside towards a centre enter the active part of a surface.
#[derive(Clone, Debug)]
pub(super) struct Net {
    /// Row after row, from the pole to its antipode; `None` where a ray enters nowhere.
    pub(super) points: Vec<Option<Point>>,
    /// Contacts beyond are not shown.
    pub(super) shown: Ball,
}

/// Four corners of a facet, counter-clockwise seen from outside.
pub(super) type Facet = [Point; 4];

/// A ball: what lies in it is shown.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ball {
    centre: Point,
    radius: f64,
}

impl Ball {
    pub(super) fn holds(&self, point: &Point) -> bool {
        (point - self.centre).norm() <= self.radius
    }
}

/// Where most contacts are: all but one in a hundred, from their median.
fn contacts_ball(contacts: &[Point]) -> Option<Ball> {
    let middle = |values: &mut dyn Iterator<Item = f64>, share: f64| {
        let mut sorted: Vec<f64> = values.filter(|value| value.is_finite()).collect();
        sorted.sort_by(f64::total_cmp);
        sorted.get((share * sorted.len().saturating_sub(1) as f64).round() as usize).copied()
    };
    let median = |axis: usize| middle(&mut contacts.iter().filter_map(|point| point.get(axis).copied()), 0.5);
    let centre = Vector3::new(median(0)?, median(1)?, median(2)?);
    let radius = middle(&mut contacts.iter().map(|point| (point - centre).norm()), 0.99)?;
    Some(Ball { centre, radius })
}

/// Rays of one net.
struct Rays<'a> {
    surface: &'a DynSurface<f64>,
    shown: Ball,
    centre: Point,
    /// Two directions across, and the pole.
    frame: [Point; 3],
}

impl Rays<'_> {
    /// Where the ray at an angle from the pole and one about it first enters, before it comes to the centre.
    fn enter(&self, polar: f64, azimuth: f64) -> Option<Point> {
        let [a, b, pole] = self.frame;
        let ((sin, cos), (sine, cosine)) = (polar.sin_cos(), azimuth.sin_cos());
        let outward = (a * cosine + b * sine) * sin + pole * cos;
        if let DynSurface::Formula(formula) = self.surface {
            return self.march(formula.as_ref(), &outward);
        }
        let line = Line { point: self.centre, direction: -outward };
        let mut first: Option<Crossing<f64>> = None;
        self.surface.crossings(&line, |crossing| {
            let enters = crossing.active && crossing.along < 0.0 && crossing.normal.dot(&outward) > 0.0;
            let sooner = first.is_none_or(|first| crossing.along < first.along);
            if enters && sooner && self.shown.holds(&crossing.point) {
                first = Some(crossing);
            }
        });
        first.map(|crossing| crossing.point)
    }

    /// As [`enter`](Self::enter), in steps and by halving: a formula of one's own takes long to find every crossing of,
    /// and a picture wants one, as exact as it is drawn.
    fn march(&self, surface: &impl ActiveSurface<f64>, outward: &Point) -> Option<Point> {
        let reach = self.shown.radius + (self.centre - self.shown.centre).norm();
        let at = |distance: f64| self.centre + outward * distance;
        let is_inside = |distance: f64| surface.contains(&at(distance));
        let step = reach / STEPS as f64;
        let inside = (0..STEPS).rev().map(|k| step * k as f64).find(|distance| is_inside(*distance))?;
        let (mut low, mut high) = (inside, inside + step);
        for _ in 0..MARCH_HALVINGS {
            let middle = 0.5 * (low + high);
            *(if is_inside(middle) { &mut low } else { &mut high }) = middle;
        }
        Some(at(0.5 * (low + high))).filter(|point| self.shown.holds(point))
    }

    fn net(&self, rows: usize, columns: usize) -> Vec<Option<Point>> {
        let angles =
            |row: usize, column: usize| (PI * row as f64 / rows as f64, TAU * column as f64 / columns as f64);
        let met: Vec<Option<Point>> = (0..=rows)
            .flat_map(|row| (0..columns).map(move |column| (row, column)))
            .map(|(row, column)| angles(row, column))
            .map(|(polar, azimuth)| self.enter(polar, azimuth))
            .collect();
        let is_met = |row: usize, column: usize| {
            row <= rows && matches!(met.get(row * columns + column % columns), Some(Some(_)))
        };
        let mut points = met.clone();
        for (place, point) in points.iter_mut().enumerate().filter(|(_, point)| point.is_none()) {
            let (row, column) = (place / columns, place % columns);
            // A ray beside one that enters is moved to the rim between them.
            let beside = [
                (row.wrapping_sub(1), column),
                (row + 1, column),
                (row, column + columns - 1),
                (row, column + 1),
            ];
            if let Some((to_row, to_column)) = beside.into_iter().find(|(row, column)| is_met(*row, *column))
            {
                // One column to the left is not all the way round to the right.
                let turns = if to_column > column + 1 { TAU } else { 0.0 };
                let (inside, outside) = (angles(to_row, to_column), angles(row, column));
                *point = self.rim((inside.0, inside.1 - turns), outside);
            }
        }
        points
    }

    /// The last point that is met on the way between two pairs of angles.
    fn rim(&self, inside: (f64, f64), outside: (f64, f64)) -> Option<Point> {
        let (mut near, mut far, mut last) = (0.0, 1.0, None);
        for _ in 0..HALVINGS {
            let share = 0.5 * (near + far);
            let between = |from: f64, to: f64| from + share * (to - from);
            match self.enter(between(inside.0, outside.0), between(inside.1, outside.1)) {
                Some(point) => (near, last) = (share, Some(point)),
                None => far = share,
            }
        }
        last
    }

    /// How much of the surface is seen well from this centre. A facet that is seen at a flat angle is likely to lead
    /// from one part of the surface to another.
    fn area(&self) -> f64 {
        let (rows, columns) = (6, 12);
        let seen_well = |facet: &Facet| {
            let (along, area) = (across(facet), across(facet).norm());
            let middle = facet.iter().sum::<Point>() * 0.25 - self.centre;
            if along.dot(&middle) > 0.3 * area * middle.norm() { area } else { 0.0 }
        };
        facets(&self.net(rows, columns), columns).map(|facet| seen_well(&facet)).sum()
    }
}

/// Twice the area of a facet along its outward normal.
pub(super) fn across(facet: &Facet) -> Point {
    let [a, b, c, d] = facet;
    (c - a).cross(&(d - b))
}

/// The facets of a net with so many columns: those whose four corners are there.
pub(super) fn facets(points: &[Option<Point>], columns: usize) -> impl Iterator<Item = Facet> {
    let at = move |row: usize, column: usize| points.get(row * columns + column % columns).copied().flatten();
    (0..points.len() / columns).flat_map(move |row| (0..columns).map(move |column| (row, column))).filter_map(
        move |(row, column)| {
            Some([at(row, column)?, at(row + 1, column)?, at(row + 1, column + 1)?, at(row, column + 1)?])
        },
    )
}

impl Net {
    /// Of a surface, and of one without an end that part on which these contacts lie.
    pub(super) fn of(surface: &DynSurface<f64>, projection: &Projection, contacts: &[Point]) -> Self {
        let extent = surface.extent();
        let touched = contacts_ball(contacts);
        let endless = !(extent.radius < ENDLESS);
        let shown = if endless {
            let ball = touched.unwrap_or(Ball { centre: projection.centre(), radius: 0.0 });
            Ball { radius: (ROOM * ball.radius).max(LEAST_REACH), ..ball }
        } else {
            Ball { centre: extent.centre, radius: 1.001 * extent.radius }
        };
        let [right, up, out] = projection.directions();
        let frame = match projection.kind() {
            // Rows run around the axis.
            MapKind::Unrolled { .. } => [out, right, up],
            MapKind::Flat | MapKind::Polar { .. } => [right, up, out],
        };
        let middle = touched.map_or(projection.centre(), |ball| ball.centre);
        let inwards = surface.normal(&middle) * -shown.radius;
        // A flat surface is seen from below, the tip of a cone from within.
        let around = [right, up, out].map(|axis| axis * (0.6 * shown.radius));
        let around = around.iter().flat_map(|step| [middle + step, middle - step]);
        let rays = |centre| Rays { surface, shown, centre, frame };
        let all: Vec<(Rays<'_>, f64)> = [projection.centre(), extent.centre, middle + inwards]
            .into_iter()
            .chain(around)
            .map(|centre| (rays(centre), rays(centre).area()))
            .collect();
        let most = all.iter().map(|(_, area)| *area).fold(0.0, f64::max);
        let good = all.iter().find(|(_, area)| *area >= 0.5 * most);
        let points = good.map_or_else(Vec::new, |(rays, _)| rays.net(ROWS, COLUMNS));
        Self { points, shown }
    }

    /// Whether the surface has a rim, so that its inside can be seen.
    pub(super) fn is_open(&self) -> bool {
        facets(&self.points, COLUMNS).count() < ROWS * COLUMNS
    }
}

#[cfg(test)]
mod tests {
    use fingertip::surfaces::{DynSurface, Sphere, SphericalCap};
    use nalgebra::Vector3;

    use super::{Ball, COLUMNS, PI, ROWS, Rays, TAU};

    /// A cap beside the poles of a net, wherever its columns begin: its rim is met on the way to the cell beside it.
    #[test]
    fn the_rim_is_met_beside_the_cell_that_it_crosses() {
        let half_angle = 23_f64.to_radians();
        let zero = Vector3::zeros();
        for degrees in (0..360).step_by(7) {
            let (sin, cos) = f64::from(degrees).to_radians().sin_cos();
            let pole = Vector3::new(cos, sin, 0.1).normalize();
            let ball = Sphere::new(zero, 0.01).unwrap();
            let surface = DynSurface::Sphere(SphericalCap::new(ball, pole, half_angle.cos()).unwrap());
            let shown = Ball { centre: zero, radius: 0.02 };
            let frame = [Vector3::x(), Vector3::y(), Vector3::z()];
            let rays = Rays { surface: &surface, shown, centre: zero, frame };
            let (mut rim, mut inner) = (0, 0);
            for (place, point) in rays.net(ROWS, COLUMNS).into_iter().enumerate() {
                let Some(point) = point else { continue };
                let (row, column) = ((place / COLUMNS) as f64, (place % COLUMNS) as f64);
                let away = (ROWS as f64 * point.angle(&Vector3::z()) / PI - row).abs();
                let turned = COLUMNS as f64 * point.y.atan2(point.x) / TAU - column;
                let aside = (turned - COLUMNS as f64 * (turned / COLUMNS as f64).round()).abs();
                assert!(
                    away < 1.0 && aside < 1.0 && away.min(aside) < 1e-6,
                    "{degrees}: {row} {column} {point:?}"
                );
                if away.max(aside) > 1e-6 {
                    assert!(
                        (point.angle(&pole) - half_angle).abs() < 1e-4,
                        "{degrees}: {row} {column} {point:?}"
                    );
                    rim += 1;
                } else {
                    inner += 1;
                }
            }
            // The cap is 4.6 rows and columns wide.
            assert!((12..=18).contains(&inner) && (12..=20).contains(&rim), "{degrees}: {inner} {rim}");
        }
    }
}
