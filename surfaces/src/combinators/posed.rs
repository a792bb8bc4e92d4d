//! A shape, moved.

use fingertip_wrench::{Line, Real, RigidTransform};
use nalgebra::{Matrix2, Matrix3, Vector3};

use crate::numeric::twofold::{Twofold, difference, dot_with};
use crate::{
    ActiveSurface, ClosestApproach, Corner, Crossing, Distance, Entry, Extent, ForceLine, Level, Shortcuts,
    SignedDistance, SmoothSurface, Topology,
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
        let found = self.surface.closest_approach(&self.line_in_shape(line))?;
        let pose = &self.sensor_from_shape;
        Some(ClosestApproach {
            point: pose.transform_point(&found.point),
            normal: pose.rotate(&found.normal),
            ..found
        })
    }

    #[inline]
    fn normal(&self, point: &Vector3<T>) -> Vector3<T> {
        self.sensor_from_shape.rotate(&self.surface.normal(&self.in_shape(point)))
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
        let inside = self.posed.in_shape(point);
        let pose = self.posed.sensor_from_shape();
        let away = difference(point, &pose.origin());
        let left = |k: usize| {
            let axis = pose.rotation().column(k).into_owned();
            dot_with(away, &axis).minus(Twofold::new(inside[k])).value()
        };
        let left = Vector3::new(left(0), left(1), left(2));
        let surface = &self.posed.surface;
        surface.shortcuts().surface_residual(&inside) + surface.normal(&inside).dot(&left)
    }

    fn entry_in_double(&self, line: &Line<f64>, near: &Vector3<f64>) -> Option<[Vector3<f64>; 2]> {
        self.moved.entry_in_double(line, near)
    }
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
