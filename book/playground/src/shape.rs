//! The shapes of the playground, and how they are drawn.

use fingertip::surfaces::{
    ActiveSurface, BadShape, CappedCylinder, Capsule, Crossing, Ellipsoid, Frustum, RoundedBox, Sphere,
    Superquadric,
};
use fingertip::wrench::Line;
use nalgebra::Vector3;

/// Places of a ring of the net.
pub(crate) const COLUMNS: usize = 40;
/// Rings of the net between its ends.
pub(crate) const ROWS: usize = 28;

/// The shapes. By themselves, since a `DynSurface` would bring meshes, formulas and the rest into the page.
pub(crate) enum Shape {
    Sphere(Sphere<f64>),
    Ellipsoid(Ellipsoid<f64>),
    Capsule(Capsule<f64>),
    CappedCylinder(CappedCylinder<f64>),
    Frustum(Frustum<f64>),
    RoundedBox(RoundedBox<f64>),
    Superquadric(Superquadric<f64>),
}

/// Does the same with whichever shape it is.
macro_rules! with {
    ($shape:expr, $surface:ident => $does:expr) => {
        match $shape {
            crate::shape::Shape::Sphere($surface) => $does,
            crate::shape::Shape::Ellipsoid($surface) => $does,
            crate::shape::Shape::Capsule($surface) => $does,
            crate::shape::Shape::CappedCylinder($surface) => $does,
            crate::shape::Shape::Frustum($surface) => $does,
            crate::shape::Shape::RoundedBox($surface) => $does,
            crate::shape::Shape::Superquadric($surface) => $does,
        }
    };
}
pub(crate) use with;

/// A shape by its number; `None` beyond the last.
pub(crate) fn shape(number: u32) -> Option<Result<Shape, BadShape>> {
    let (origin, up) = (Vector3::zeros(), Vector3::z());
    Some(match number {
        0 => Sphere::centred(13e-3).map(Shape::Sphere),
        1 => Ellipsoid::new(Vector3::new(8e-3, 10e-3, 14e-3)).map(Shape::Ellipsoid),
        2 => Capsule::new(origin, up, 8e-3, 8e-3).map(Shape::Capsule),
        3 => CappedCylinder::new(origin, up, 9e-3, 12e-3).map(Shape::CappedCylinder),
        4 => Frustum::new(up * -12e-3, up, 12e-3, 5e-3, 24e-3).map(Shape::Frustum),
        5 => RoundedBox::new(Vector3::new(9e-3, 11e-3, 13e-3), 4e-3).map(Shape::RoundedBox),
        6 => Superquadric::new(Vector3::new(9e-3, 10e-3, 13e-3), [0.6, 0.7]).map(Shape::Superquadric),
        _ => return None,
    })
}

/// Its name in `benches/instructions.txt`, behind `point_on_` and `soft_on_`.
pub(crate) fn counted(number: u32) -> Option<&'static str> {
    Some(match number {
        0 => "sphere",
        1 => "ellipsoid",
        2 => "capsule",
        3 => "capped_cylinder",
        4 => "frustum",
        5 => "rounded_box",
        6 => "superquadric",
        _ => return None,
    })
}

/// Where a line first enters a surface.
pub(crate) fn first(shape: &Shape, from: &Vector3<f64>, along: &Vector3<f64>) -> Option<Crossing<f64>> {
    let direction = along.try_normalize(0.0)?;
    let mut found: Option<Crossing<f64>> = None;
    let line = Line { point: *from, direction };
    with!(shape, surface => surface.crossings(&line, |crossing| {
        if crossing.along > 0.0 && found.is_none_or(|other| crossing.along < other.along) {
            found = Some(crossing);
        }
    }));
    found
}

/// Points of the surface by their directions from its middle, ring by ring.
pub(crate) fn net(shape: &Shape) -> Vec<f64> {
    let mut points = Vec::with_capacity((ROWS + 1) * COLUMNS * 3);
    for row in 0..=ROWS {
        // Not quite at the ends, where a ring would be a point.
        let polar = core::f64::consts::PI * (row as f64 / ROWS as f64).clamp(1e-3, 1.0 - 1e-3);
        for column in 0..COLUMNS {
            let around = core::f64::consts::TAU * column as f64 / COLUMNS as f64;
            let outward = Vector3::new(polar.sin() * around.cos(), polar.sin() * around.sin(), polar.cos());
            // From within outward there is one crossing, since all shapes here are convex.
            let point = first(shape, &Vector3::zeros(), &outward)
                .map_or(outward * f64::NAN, |crossing| crossing.point);
            points.extend_from_slice(point.as_slice());
        }
    }
    points
}
