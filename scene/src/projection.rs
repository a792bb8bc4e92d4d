//! A surface drawn flat.

use nalgebra::Vector3;

/// Which map it is, with what is drawn beside the points. Lengths in millimetres.
///
/// ```
/// # const BALL: &str = "version = 2\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"sphere\"\nradius_m = 0.013\n";
/// use fingertip_scene::{MapKind, Scene};
///
/// assert_eq!(Scene::from_text(BALL)?.projection().kind(), MapKind::Polar { rim: None });
/// let cylinder = BALL.replace("sphere", "cylinder");
/// assert_eq!(
///     Scene::from_text(&cylinder)?.projection().kind(),
///     MapKind::Unrolled { radius: 13.0, half_length: None }
/// );
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MapKind {
    /// Plane: true to scale.
    Flat,
    /// Sphere, and shapes without a map of their own by the direction of the point from a centre:
    /// Lambert's azimuthal equal-area projection around the pole: a polar angle θ is drawn
    /// at the distance `2 sin(θ/2)`. `rim` is the polar angle \[rad\] of the active region's edge.
    Polar {
        /// Polar angle \[rad\] of the edge of the active region, if it has one.
        rim: Option<f64>,
    },
    /// Cylinder unrolled: the arc from the zero direction across, the height along the axis up;
    /// true to scale and area. `half_length` of the active part.
    Unrolled {
        /// Of the cylinder \[mm\].
        radius: f64,
        /// Of the active part \[mm\], if it ends.
        half_length: Option<f64>,
    },
}

/// Takes points of a surface, in the sensor frame, to a flat map.
///
/// ```
/// # const BALL: &str = "version = 2\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"sphere\"\nradius_m = 0.013\n";
/// use fingertip_scene::Scene;
/// use nalgebra::Vector3;
///
/// let scene = Scene::from_text(BALL)?;
/// let map = scene.projection();
/// assert_eq!(map.project(&Vector3::new(0.0, 0.0, 0.013)), (0.0, 0.0)); // the pole is in the middle
/// let (x, y) = map.project(&Vector3::new(0.013, 0.0, 0.0));
/// // An equal-area map draws the equator at 2 sin 45°.
/// assert!((x.hypot(y) - 2.0_f64.sqrt()).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Projection {
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
    pub fn plane(point: Vector3<f64>, normal: Vector3<f64>, frame: &[Vector3<f64>; 3]) -> Self {
        let [x, y, z] = *frame;
        Self::new(MapKind::Flat, point, normal, across(&normal, &[x, y, z]), frame)
    }

    /// Seen from outside along the pole.
    pub fn sphere(
        centre: Vector3<f64>,
        pole: Vector3<f64>,
        rim: Option<f64>,
        frame: &[Vector3<f64>; 3],
    ) -> Self {
        Self::new(MapKind::Polar { rim }, centre, pole, across(&pole, frame), frame)
    }

    /// Angle zero is the frame's z axis, or x if the cylinder lies along z.
    pub fn cylinder(
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
    pub fn names(&self) -> [&'static str; 2] {
        self.names
    }

    /// Which map it is.
    pub fn kind(&self) -> MapKind {
        self.kind
    }

    /// What the map is seen around: a point of a plane, the centre of a sphere, a point of a cylinder's axis.
    pub fn centre(&self) -> Vector3<f64> {
        self.centre
    }

    /// Unit vectors to the right, up, and towards the viewer in the middle of the map.
    pub fn directions(&self) -> [Vector3<f64>; 3] {
        [self.right, self.up, self.out]
    }

    /// Where a point of the surface is drawn: millimetres (plane, cylinder) or `2 sin(θ/2)` from
    /// the pole (sphere).
    pub fn project(&self, point: &Vector3<f64>) -> (f64, f64) {
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

    use nalgebra::{Rotation3, Vector3};
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    use super::{MapKind, Projection};

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

    fn turned(random: &mut Pcg64Mcg) -> Rotation3<f64> {
        Rotation3::from_scaled_axis(Vector3::from_fn(|_, _| random.random_range(-2.0..2.0)))
    }

    /// Where two short steps on a surface lead on its map, against the steps themselves: maps keep lengths (in the
    /// middle) and show the surface from outside, so that what turns left there turns left on the map.
    fn check_at(map: &Projection, at: Vector3<f64>, out: Vector3<f64>, unit: f64, random: &mut Pcg64Mcg) {
        let mut step = || {
            let any = Vector3::from_fn(|_, _| random.random_range(-1.0..1.0));
            (any - out * out.dot(&any)) * 1e-7
        };
        let (a, b) = (step(), step());
        let to = |point: Vector3<f64>| {
            let ((u, v), (u0, v0)) = (map.project(&point), map.project(&at));
            ((u - u0) / unit, (v - v0) / unit)
        };
        let ((ua, va), (ub, vb)) = (to(at + a), to(at + b));
        let (lengths, inner, turn) =
            ((ua * ua + va * va, a.norm_squared()), ua * ub + va * vb, ua * vb - va * ub);
        assert!((lengths.0 / lengths.1 - 1.0).abs() < 1e-5, "{lengths:?}");
        assert!((inner - a.dot(&b)).abs() < 1e-5 * a.norm() * b.norm());
        assert!((turn - out.dot(&a.cross(&b))).abs() < 1e-5 * a.norm() * b.norm());
    }

    #[test]
    fn maps_show_the_surface_from_outside_in_every_pose() {
        let random = &mut Pcg64Mcg::seed_from_u64(7);
        for _ in 0..200 {
            let turn = turned(random);
            let frame = axes().map(|axis| turn * axis);
            let centre = Vector3::from_fn(|_, _| random.random_range(-0.1..0.1));
            let out = turned(random) * Vector3::x();
            check_at(&Projection::plane(centre, out, &frame), centre, out, 1e3, random);
            let sphere = Projection::sphere(centre, out, None, &frame);
            check_at(&sphere, centre + out * 0.02, out, 1.0 / 0.02, random);
            // A cylinder along an axis of its frame keeps lengths everywhere.
            let cylinder = Projection::cylinder(centre, frame[1], 0.02, None, &frame);
            for map in [sphere, cylinder] {
                let [right, up, towards] = map.directions();
                assert!((right.cross(&up) - towards).norm() < 1e-12 && map.centre() == centre);
                assert!((right.norm() - 1.0).abs() < 1e-12 && right.dot(&up).abs() < 1e-12);
            }
            let angle = random.random_range(-3.0..3.0_f64);
            let radial = frame[2] * angle.cos() + frame[0] * angle.sin();
            check_at(&cylinder, centre + radial * 0.02 + frame[1] * 0.03, radial, 1e3, random);
            let (u, v) = cylinder.project(&(centre + radial * 0.02 + frame[1] * 0.03));
            assert!((u - 20.0 * angle).abs() < 1e-6 && (v - 30.0).abs() < 1e-6, "{u} {v}");
        }
    }

    #[test]
    fn directions_are_named_by_the_axes_they_lie_along() {
        let zero = Vector3::zeros();
        let names = |map: Projection| map.names();
        assert_eq!(names(Projection::sphere(zero, Vector3::z(), None, &axes())), ["x", "y"]);
        assert_eq!(names(Projection::sphere(zero, Vector3::y(), None, &axes())), ["x", "−z"]);
        assert_eq!(names(Projection::sphere(zero, -Vector3::x(), None, &axes())), ["y", "−z"]);
        assert_eq!(names(Projection::cylinder(zero, Vector3::y(), 1.0, None, &axes())), ["x", "y"]);
        assert_eq!(names(Projection::cylinder(zero, Vector3::z(), 1.0, None, &axes())), ["y", "z"]);
        assert_eq!(names(Projection::cylinder(zero, Vector3::x(), 1.0, None, &axes())), ["−y", "x"]);
        // A hair beside an axis is not along it.
        let beside = Vector3::new(1e-4, 0.0, 1.0).normalize();
        assert_eq!(names(Projection::plane(zero, beside, &axes())), ["right", "y"]);
        // A direction that leans towards x by less than 30° from its plane still has x to the right.
        let near = Vector3::new(0.85, 0.0, 0.53).normalize();
        assert_eq!(names(Projection::sphere(zero, near, None, &axes())), ["right", "y"]);
        let nearer = Vector3::new(0.88, 0.0, 0.475).normalize();
        assert_eq!(names(Projection::sphere(zero, nearer, None, &axes())), ["y", "up"]);
    }

    #[test]
    fn the_pole_is_the_middle_and_its_antipode_the_edge() {
        let map = Projection::sphere(Vector3::zeros(), Vector3::x(), Some(1.0), &axes());
        assert_eq!(map.project(&Vector3::x()), (0.0, 0.0));
        assert_eq!(map.project(&-Vector3::x()), (2.0, 0.0));
        assert_eq!(map.project(&Vector3::zeros()), (0.0, 0.0));
        assert_eq!(map.kind(), MapKind::Polar { rim: Some(1.0) });
        let map = Projection::cylinder(Vector3::zeros(), Vector3::y(), 0.04, Some(0.011), &axes());
        assert_eq!(map.kind(), MapKind::Unrolled { radius: 40.0, half_length: Some(11.0) });
    }
}
