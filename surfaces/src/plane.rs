//! The unbounded plane.

use fingertip_wrench::{Line, Real};
use nalgebra::Vector3;

use crate::{ActiveSurface, BadShape, ClosestApproach, Crossing};

/// A plane; the fingertip is on the side away from the normal.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(
        try_from = "Parts<T>",
        into = "Parts<T>",
        bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>")
    )
)]
pub struct Plane<T: Real> {
    point: Vector3<T>,
    normal: Vector3<T>,
}

impl<T: Real> Plane<T> {
    /// Through a point of the sensor frame \[m\], with an outward normal of any length.
    ///
    /// # Errors
    /// [`BadShape`] unless the point is finite and the normal has a direction.
    pub fn new(point: Vector3<T>, normal: Vector3<T>) -> Result<Self, BadShape> {
        Ok(Self {
            point: BadShape::check_point("plane", "point", point)?,
            normal: BadShape::check_direction("plane", "normal", normal)?,
        })
    }

    /// A point of the plane \[m\].
    #[inline]
    #[must_use]
    pub const fn point(&self) -> Vector3<T> {
        self.point
    }
}

impl<T: Real> ActiveSurface<T> for Plane<T> {
    #[inline]
    fn crossings(&self, line: &Line<T>, mut visit: impl FnMut(Crossing<T>)) {
        let along = (self.point - line.point).dot(&self.normal) / line.direction.dot(&self.normal);
        let point = line.at(along);
        // A parallel line, or one so nearly parallel that it meets the plane beyond the range of
        // the type, does not cross it.
        if (point.x + point.y + point.z).is_number() {
            visit(Crossing { along, point, normal: self.normal, active: true });
        }
    }

    fn closest_approach(&self, line: &Line<T>) -> ClosestApproach<T> {
        let height = (line.point - self.point).dot(&self.normal);
        ClosestApproach {
            gap: height.abs(),
            point: line.point - self.normal * height,
            normal: self.normal,
            active: true,
        }
    }

    #[inline]
    fn normal(&self, _point: &Vector3<T>) -> Vector3<T> {
        self.normal
    }
}

/// How a plane is written in a file; reading one validates it again.
#[cfg(feature = "serde")]
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>"))]
struct Parts<T: Real> {
    point: Vector3<T>,
    normal: Vector3<T>,
}

#[cfg(feature = "serde")]
impl<T: Real> From<Plane<T>> for Parts<T> {
    fn from(plane: Plane<T>) -> Self {
        Self { point: plane.point, normal: plane.normal }
    }
}

#[cfg(feature = "serde")]
impl<T: Real> TryFrom<Parts<T>> for Plane<T> {
    type Error = BadShape;
    fn try_from(parts: Parts<T>) -> Result<Self, BadShape> {
        Self::new(parts.point, parts.normal)
    }
}
