//! A shape, moved.

use fingertip_wrench::{Line, Real, RigidTransform};
use nalgebra::{Matrix2, Matrix3, Vector3};

use crate::numeric::moved::{direction_inside, direction_outside, point_inside, point_outside};
use crate::numeric::twofold::{Twofold, difference, dot_with};
use crate::{
    ActiveSurface, ClosestApproach, Corner, Crossing, Distance, Entry, Extent, ForceLine, Level,
    LineInDouble, Shortcuts, SignedDistance, SmoothSurface, Topology,
};

/// A shape somewhere else in the sensor frame, turned.
///
/// ```
/// use fingertip_surfaces::{Ellipsoid, Posed};
/// use fingertip_wrench::RigidTransform;
/// use nalgebra::Vector3;
///
/// // An ellipsoid 40 mm out along the sensor's z axis, turned by a right angle about it.
/// let sensor_from_shape = RigidTransform::from_axis_angle(
///     Vector3::new(0.0, 0.0, core::f64::consts::FRAC_PI_2),
///     Vector3::new(0.0, 0.0, 0.04),
/// )?;
/// let tip = Posed::new(Ellipsoid::new(Vector3::new(0.008, 0.010, 0.015))?, sensor_from_shape);
/// # let _ = tip;
/// // What was its y axis lies along −x now.
/// use fingertip_surfaces::ActiveSurface;
/// assert!(tip.contains(&Vector3::new(-0.0099, 0.0, 0.04)));
/// assert!(!tip.contains(&Vector3::new(0.0, 0.0099, 0.04)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Posed<T: Real, S> {
    surface: S,
    sensor_from_shape: RigidTransform<T>,
}

impl<T: Real, S> Posed<T, S> {
    /// `surface`, whose frame `sensor_from_shape` takes to the sensor frame.
    #[inline]
    #[must_use]
    pub const fn new(surface: S, sensor_from_shape: RigidTransform<T>) -> Self {
        Self { surface, sensor_from_shape }
    }

    /// The shape in its own frame.
    #[inline]
    #[must_use]
    pub const fn inner(&self) -> &S {
        &self.surface
    }

    /// From the shape's frame to the sensor frame.
    #[inline]
    #[must_use]
    pub const fn sensor_from_shape(&self) -> &RigidTransform<T> {
        &self.sensor_from_shape
    }

    #[inline]
    fn turned_back(&self, v: &Vector3<T>) -> Vector3<T> {
        self.sensor_from_shape.rotation().tr_mul(v)
    }

    #[inline]
    fn in_shape(&self, point: &Vector3<T>) -> Vector3<T> {
        self.turned_back(&(point - self.sensor_from_shape.origin()))
    }

    #[inline]
    fn line_in_shape(&self, line: &Line<T>) -> Line<T> {
        Line { point: self.in_shape(&line.point), direction: self.turned_back(&line.direction) }
    }

    /// The same, where few samples go.
    fn coldly_in_shape(&self, line: &Line<T>) -> Line<T> {
        let pose = &self.sensor_from_shape;
        Line { point: point_inside(pose, &line.point), direction: direction_inside(pose, &line.direction) }
    }

    fn placed(&self, found: ClosestApproach<T>) -> ClosestApproach<T> {
        let pose = &self.sensor_from_shape;
        let (point, normal) = (point_outside(pose, &found.point), direction_outside(pose, &found.normal));
        ClosestApproach { point, normal, ..found }
    }
}

impl<T: Real, S: ActiveSurface<T>> Posed<T, S> {
    /// The normal of the shape in its own frame, out of line: few samples ask, and from several places.
    #[inline(never)]
    fn normal_inside(&self, inside: &Vector3<T>) -> Vector3<T> {
        self.surface.normal(inside)
    }
}

impl<T: Real, S: ActiveSurface<T>> ActiveSurface<T> for Posed<T, S> {
    #[inline]
    fn crossings(&self, line: &Line<T>, mut visit: impl FnMut(Crossing<T>)) {
        let pose = &self.sensor_from_shape;
        self.surface.crossings(&self.line_in_shape(line), |c| {
            visit(Crossing { point: pose.transform_point(&c.point), normal: pose.rotate(&c.normal), ..c });
        });
    }

    fn closest_approach(&self, line: &Line<T>) -> Option<ClosestApproach<T>> {
        self.surface.closest_approach(&self.coldly_in_shape(line)).map(|found| self.placed(found))
    }

    #[inline(always)]
    fn entry_or_closest(&self, line: &Line<T>) -> (bool, Option<ClosestApproach<T>>) {
        let (enters, found) = self.surface.entry_or_closest(&self.coldly_in_shape(line));
        (enters, found.map(|found| self.placed(found)))
    }

    #[inline(always)]
    fn entered_and_left(&self, line: &Line<T>) -> (bool, Option<Vector3<T>>) {
        let (entered, left) = self.surface.entered_and_left(&self.coldly_in_shape(line));
        (entered, left.map(|point| point_outside(&self.sensor_from_shape, &point)))
    }

    #[inline]
    fn normal(&self, point: &Vector3<T>) -> Vector3<T> {
        let pose = &self.sensor_from_shape;
        direction_outside(pose, &self.normal_inside(&point_inside(pose, point)))
    }

    #[inline(always)]
    fn shortcuts(&self) -> impl Shortcuts<T> {
        InPlace { posed: self, moved: self.surface.shortcuts().posed(&self.sensor_from_shape) }
    }

    #[inline]
    fn contains(&self, point: &Vector3<T>) -> bool {
        self.surface.contains(&self.in_shape(point))
    }
}

/// The shortcuts of a shape in another place, which know what moving a point has rounded off.
struct InPlace<'a, T: Real, S, M> {
    posed: &'a Posed<T, S>,
    moved: M,
}

impl<T: Real, S: ActiveSurface<T>, M: Shortcuts<T>> Shortcuts<T> for InPlace<'_, T, S, M> {
    const CLOSED_CONVEX: bool = M::CLOSED_CONVEX;

    #[inline(always)]
    fn sole_entry(&self, push: &ForceLine<T>) -> Option<Entry<T>> {
        self.moved.sole_entry(push)
    }

    /// That of the point in the frame of the shape, and what rounding took of it on the way there, along the
    /// normal.
    fn surface_residual(&self, point: &Vector3<T>) -> T {
        let pose = self.posed.sensor_from_shape();
        let inside = point_inside(pose, point);
        let away = difference(point, &pose.origin());
        let [x, y, z] = pose.rotation().data.0;
        let left = Vector3::new(
            left_along(&away, x, inside.x),
            left_along(&away, y, inside.y),
            left_along(&away, z, inside.z),
        );
        let residual = self.posed.surface.shortcuts().surface_residual(&inside);
        residual + self.posed.normal_inside(&inside).dot(&left)
    }

    fn entry_in_double(&self, line: &Line<f64>, near: &Vector3<f64>) -> Option<LineInDouble> {
        self.moved.entry_in_double(line, near)
    }

    #[inline(always)]
    fn is_moved(&self) -> bool {
        true
    }
}

/// What is left of a coordinate of a vector along an axis.
#[inline(never)]
fn left_along<T: Real>(vector: &[Twofold<T>; 3], axis: [T; 3], coordinate: T) -> T {
    dot_with(*vector, &Vector3::from(axis)).minus(Twofold::new(coordinate)).value()
}

impl<T: Real, S: SignedDistance<T>> SignedDistance<T> for Posed<T, S> {
    const CONVEX: bool = S::CONVEX;

    fn signed_distance(&self, point: &Vector3<T>) -> Distance<T> {
        let found = self.surface.signed_distance(&self.in_shape(point));
        Distance { normal: self.sensor_from_shape.rotate(&found.normal), ..found }
    }

    fn bounds(&self) -> (Vector3<T>, T) {
        let (centre, radius) = self.surface.bounds();
        (self.sensor_from_shape.transform_point(&centre), radius)
    }
}

/// In files, the pose is the shape's origin in the sensor frame and the rotation vector.
impl<T: Real, S: SmoothSurface<T>> SmoothSurface<T> for Posed<T, S> {
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        let pose = self.sensor_from_shape();
        let rotation = pose.rotation();
        let level = self.inner().level(&rotation.tr_mul(&(point - pose.origin())));
        Level {
            value: level.value,
            gradient: rotation * level.gradient,
            hessian: rotation * level.hessian * rotation.transpose(),
        }
    }

    fn extent(&self) -> Extent<T> {
        let extent = self.inner().extent();
        Extent { centre: self.sensor_from_shape().transform_point(&extent.centre), ..extent }
    }

    fn topology(&self) -> Topology {
        self.inner().topology()
    }

    fn shape_operator(&self, point: &Vector3<T>) -> Matrix3<T> {
        let pose = self.sensor_from_shape();
        let rotation = pose.rotation();
        rotation
            * self.inner().shape_operator(&rotation.tr_mul(&(point - pose.origin())))
            * rotation.transpose()
    }

    fn bend(&self, point: &Vector3<T>, normal: &Vector3<T>, [e1, e2]: [&Vector3<T>; 2]) -> Matrix2<T> {
        let pose = self.sensor_from_shape();
        let inside = |v: &Vector3<T>| pose.rotation().tr_mul(v);
        self.inner().bend(&inside(&(point - pose.origin())), &inside(normal), [&inside(e1), &inside(e2)])
    }

    fn corner(&self, point: &Vector3<T>, normal: &Vector3<T>) -> Option<Corner<T>> {
        let pose = self.sensor_from_shape();
        let rotation = pose.rotation();
        let inside = rotation.tr_mul(&(point - pose.origin()));
        self.inner().corner(&inside, &rotation.tr_mul(normal)).map(|corner| match corner {
            Corner::Edge { direction, bend } => Corner::Edge { direction: rotation * direction, bend },
            Corner::Tip => Corner::Tip,
        })
    }
}

#[cfg(feature = "serde")]
mod files {
    use fingertip_wrench::{Real, RigidTransform};
    use nalgebra::{Rotation3, UnitQuaternion, Vector3};
    use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

    use super::Posed;
    use crate::numeric::vectors::{from_degrees, to_degrees};

    #[derive(Serialize)]
    struct Written<'a, T: Real, S> {
        translation_m: Vector3<T>,
        rotation_deg: Vector3<T>,
        surface: &'a S,
    }

    #[derive(Deserialize)]
    #[serde(deny_unknown_fields, bound(deserialize = "T: Deserialize<'de>, S: Deserialize<'de>"))]
    struct Read<T: Real, S> {
        #[serde(default = "Vector3::zeros")]
        translation_m: Vector3<T>,
        #[serde(default = "Vector3::zeros")]
        rotation_deg: Vector3<T>,
        surface: S,
    }

    impl<T: Real + Serialize, S: Serialize> Serialize for Posed<T, S> {
        fn serialize<W: Serializer>(&self, serializer: W) -> Result<W::Ok, W::Error> {
            let rotation = Rotation3::from_matrix_unchecked(self.sensor_from_shape.rotation());
            Written {
                translation_m: self.sensor_from_shape.origin(),
                rotation_deg: UnitQuaternion::from_rotation_matrix(&rotation).scaled_axis().map(to_degrees),
                surface: &self.surface,
            }
            .serialize(serializer)
        }
    }

    impl<'de, T: Real + Deserialize<'de>, S: Deserialize<'de>> Deserialize<'de> for Posed<T, S> {
        fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
            let Read { translation_m, rotation_deg, surface } = Read::<T, S>::deserialize(deserializer)?;
            let pose = RigidTransform::from_axis_angle(rotation_deg.map(from_degrees), translation_m)
                .map_err(Error::custom)?;
            Ok(Self::new(surface, pose))
        }
    }
}

#[cfg(test)]
mod tests {
    use fingertip_wrench::{Line, RigidTransform};
    use nalgebra::Vector3;
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    use super::Posed;
    use crate::{ActiveSurface, Capsule, Cone, Crossing, Paraboloid};

    /// What a pose answers at once is what its own crossings say.
    fn told_as_by_crossings(
        surface: &impl ActiveSurface<f64>,
        line: &Line<f64>,
        is_closed: bool,
    ) -> [bool; 2] {
        let mut all: Vec<Crossing<f64>> = Vec::new();
        surface.crossings(line, |crossing| all.push(crossing));
        let along = |crossing: &Crossing<f64>| crossing.normal.dot(&line.direction);
        // Where a line is tangent rounding decides.
        if all.iter().any(|crossing| along(crossing).abs() < 1e-9) {
            return [false; 2];
        }
        let (entered, left) = surface.entered_and_left(line);
        assert_eq!(entered, all.iter().any(|crossing| crossing.active && along(crossing) < 0.0), "{line:?}");
        let last = all.iter().rfind(|crossing| along(crossing) >= 0.0).map(|crossing| crossing.point);
        assert_eq!(left.is_some(), last.is_some(), "{line:?}");
        let off = left.zip(last).map_or(0.0, |(left, last)| (left - last).amax());
        assert!(off <= 1e-12 * last.map_or(1.0, |last| 1.0 + last.amax()), "{line:?}");
        if is_closed {
            let (enters, found) = surface.entry_or_closest(line);
            let closest = all.first().map_or_else(
                || surface.closest_approach(line).map(|closest| (closest.gap, closest.point, closest.normal)),
                |first| Some((0.0, first.point, first.normal)),
            );
            let (found, closest) = (found.unwrap(), closest.unwrap());
            assert_eq!(enters, !all.is_empty());
            assert_eq!(found.gap, closest.0);
            assert!((found.point - closest.1).amax() < 1e-12 && (found.normal - closest.2).amax() < 1e-12);
        }
        [entered, left.is_some()]
    }

    #[test]
    fn a_pose_answers_at_once_what_its_crossings_say() {
        let mut random = Pcg64Mcg::seed_from_u64(31);
        let mut seen = [0; 3];
        for _ in 0..2000 {
            let mut any = || Vector3::from_fn(|_, _| random.random_range(-1.0_f64..1.0));
            let pose: RigidTransform<f64> = RigidTransform::from_axis_angle(any() * 3.0, any()).unwrap();
            let line = Line { point: any() * 2.0, direction: any().normalize() };
            let capsule = Capsule::new(Vector3::zeros(), any(), 0.5, 0.7).unwrap();
            let cone = Cone::new(any(), any(), 0.4).unwrap().with_depth(1.5).unwrap();
            let dome = Paraboloid::new([0.5, 0.8]).unwrap().with_depth(0.6).unwrap();
            let [entered, left] = told_as_by_crossings(&Posed::new(capsule, pose), &line, true);
            told_as_by_crossings(&Posed::new(cone, pose), &line, false);
            told_as_by_crossings(&Posed::new(&dome, pose), &line, false);
            for (count, is_so) in seen.iter_mut().zip([entered, left, !entered && !left]) {
                *count += u32::from(is_so);
            }
        }
        assert!(seen.iter().all(|count| *count > 200), "{seen:?}");
    }
}
