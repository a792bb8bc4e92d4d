//! A surface drawn flat.

use nalgebra::Vector3;

/// Which map it is, with what is drawn beside the points. Lengths in millimetres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum MapKind {
    /// Plane: true to scale.
    Flat,
    /// Sphere, and shapes without a map of their own by the direction of the point from a centre:
    /// Lambert's azimuthal equal-area projection around the pole: a polar angle θ is drawn
    /// at the distance `2 sin(θ/2)`. `rim` is the polar angle \[rad\] of the active region's edge.
    Polar { rim: Option<f64> },
    /// Cylinder unrolled: the arc from the zero direction across, the height along the axis up;
    /// true to scale and area. `half_length` of the active part.
    Unrolled { radius: f64, half_length: Option<f64> },
}

/// Takes points of a surface, in the sensor frame, to a flat map.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Projection {
    kind: MapKind,
    centre: Vector3<f64>,
    /// Columns: to the right on the map, up on the map, towards the viewer.
    right: Vector3<f64>,
    up: Vector3<f64>,
    out: Vector3<f64>,
    names: [&'static str; 2],
}

const MILLIMETRES: f64 = 1e3;

impl Projection {
    /// Seen against the outward unit normal. `frame` holds the axes of the surface's own frame, as
    /// for the other shapes: its x axis is drawn to the right unless the normal lies along it.
    pub(crate) fn plane(point: Vector3<f64>, normal: Vector3<f64>, frame: &[Vector3<f64>; 3]) -> Self {
        let [x, y, z] = *frame;
        Self::new(MapKind::Flat, point, normal, across(&normal, &[x, y, z]), frame)
    }

    /// Seen from outside along the pole.
    pub(crate) fn sphere(
        centre: Vector3<f64>,
        pole: Vector3<f64>,
        rim: Option<f64>,
        frame: &[Vector3<f64>; 3],
    ) -> Self {
        Self::new(MapKind::Polar { rim }, centre, pole, across(&pole, frame), frame)
    }

    /// Angle zero is the frame's z axis, or x if the cylinder lies along z.
    pub(crate) fn cylinder(
        centre: Vector3<f64>,
        axis: Vector3<f64>,
        radius: f64,
        half_length: Option<f64>,
        frame: &[Vector3<f64>; 3],
    ) -> Self {
        let [x, y, z] = *frame;
        let out = across(&axis, &[z, x, y]);
        let kind = MapKind::Unrolled {
            radius: radius * MILLIMETRES,
            half_length: half_length.map(|half| half * MILLIMETRES),
        };
        Self::new(kind, centre, out, axis.cross(&out), frame)
    }

    fn new(
        kind: MapKind,
        centre: Vector3<f64>,
        out: Vector3<f64>,
        right: Vector3<f64>,
        frame: &[Vector3<f64>; 3],
    ) -> Self {
        let up = out.cross(&right);
        let names = [name(&right, frame).unwrap_or("right"), name(&up, frame).unwrap_or("up")];
        Self { kind, centre, right, up, out, names }
    }

    /// What the directions to the right and up are called: axes of the surface's frame, if they
    /// lie along one.
    pub(crate) fn names(&self) -> [&'static str; 2] {
        self.names
    }

    pub(crate) fn kind(&self) -> MapKind {
        self.kind
    }

    /// Where a point of the surface is drawn: millimetres (plane, cylinder) or `2 sin(θ/2)` from
    /// the pole (sphere).
    pub(crate) fn project(&self, point: &Vector3<f64>) -> (f64, f64) {
        let from_centre = point - self.centre;
        let (x, y, z) = (from_centre.dot(&self.right), from_centre.dot(&self.up), from_centre.dot(&self.out));
        match self.kind {
            MapKind::Flat => (x * MILLIMETRES, y * MILLIMETRES),
            MapKind::Unrolled { radius, .. } => (x.atan2(z) * radius, y * MILLIMETRES),
            MapKind::Polar { .. } => {
                let sideways = x.hypot(y);
                if !(sideways > 0.0) {
                    // The pole; or its antipode, which is the whole edge of the map.
                    return (if z < 0.0 { 2.0 } else { 0.0 }, 0.0);
                }
                // 2 sin(θ/2) from the half-angle of atan2, which is accurate at both poles.
                let distance = 2.0 * (0.5 * sideways.atan2(z)).sin();
                (distance * x / sideways, distance * y / sideways)
            }
        }
    }
}

/// The axis of a frame that a unit vector lies along.
fn name(direction: &Vector3<f64>, frame: &[Vector3<f64>; 3]) -> Option<&'static str> {
    let names = [("x", "−x"), ("y", "−y"), ("z", "−z")];
    frame.iter().zip(names).find_map(|(axis, (along, against))| {
        let cosine = axis.dot(direction);
        if cosine > 1.0 - 1e-9 {
            Some(along)
        } else if cosine < 1e-9 - 1.0 {
            Some(against)
        } else {
            None
        }
    })
}

/// The first of some directions that is well away from a unit vector, made perpendicular to it.
fn across(direction: &Vector3<f64>, candidates: &[Vector3<f64>; 3]) -> Vector3<f64> {
    let best = candidates
        .iter()
        .map(|candidate| candidate - direction * candidate.dot(direction))
        .find(|rest| rest.norm() > 0.5)
        .unwrap_or_else(Vector3::x);
    best.try_normalize(0.0).unwrap_or_else(Vector3::x)
}

#[cfg(test)]
mod tests {
    use core::f64::consts::PI;

    use nalgebra::Vector3;

    use super::Projection;

    fn axes() -> [Vector3<f64>; 3] {
        [Vector3::x(), Vector3::y(), Vector3::z()]
    }

    #[test]
    fn the_sphere_map_keeps_areas() {
        // A cap up to the polar angle θ has the share (1 − cos θ)/2 of the sphere, and its disk
        // the share (2 sin(θ/2))²/4 of the map: equal for every θ.
        let map = Projection::sphere(Vector3::new(1.0, 2.0, 3.0), Vector3::x(), None, &axes());
        for theta in [0.0_f64, 1e-9, 0.3, 1.0, 2.0, 3.0, PI] {
            for azimuth in [0.1_f64, 2.0, 5.0] {
                let normal =
                    Vector3::new(theta.cos(), theta.sin() * azimuth.cos(), theta.sin() * azimuth.sin());
                let (u, v) = map.project(&(Vector3::new(1.0, 2.0, 3.0) + normal * 0.5));
                assert!(((u * u + v * v) / 4.0 - (1.0 - theta.cos()) / 2.0).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn the_cylinder_unrolls_to_arc_and_height() {
        let map = Projection::cylinder(Vector3::zeros(), Vector3::y(), 0.04, Some(0.011), &axes());
        for angle in [-3.0_f64, -1.0, 0.0, 0.5, 3.0] {
            let (u, v) = map.project(&Vector3::new(0.04 * angle.sin(), 0.005, 0.04 * angle.cos()));
            assert!((u - 40.0 * angle).abs() < 1e-12, "{angle}");
            assert!((v - 5.0).abs() < 1e-12);
        }
    }

    #[test]
    fn the_plane_is_seen_from_outside() {
        let map = Projection::plane(Vector3::zeros(), Vector3::z(), &axes());
        assert_eq!(map.project(&Vector3::new(0.001, 0.002, 0.0)), (1.0, 2.0));
        assert_eq!(map.names(), ["x", "y"]);
        let below = Projection::plane(Vector3::zeros(), -Vector3::z(), &axes());
        assert_eq!(below.names(), ["x", "−y"]);
        let slanted = Vector3::new(1.0, 1.0, 1.0).normalize();
        assert_eq!(Projection::plane(Vector3::zeros(), slanted, &axes()).names(), ["right", "up"]);
        let side = Projection::sphere(Vector3::zeros(), Vector3::x(), None, &axes());
        assert_eq!(side.names(), ["y", "z"]);
    }
}
