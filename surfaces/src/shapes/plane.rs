//! The unbounded plane.

use fingertip_wrench::{Line, Real, stored};
use nalgebra::{Matrix3, Vector3};

use crate::numeric::twofold::{difference, dot_with};
use crate::numeric::vectors::{foot, is_finite};
use crate::{
    ActiveSurface, BadShape, ClosestApproach, Crossing, Entry, Extent, ForceLine, Level, Shortcuts,
    SmoothSurface, Topology,
};

/// A plane; the fingertip is on the side away from the normal.
///
/// ```
/// use fingertip_surfaces::{ActiveSurface, Plane};
/// use nalgebra::Vector3;
///
/// // A flat fingertip that ends 30 mm over the sensor.
/// let end = Plane::new(Vector3::new(0.0, 0.0, 0.03), Vector3::z())?;
/// assert!((end.height(&Vector3::new(0.1, 0.2, 0.031)) - 0.001_f64).abs() < 1e-15);
/// assert!(end.contains(&Vector3::zeros()));
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
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

    /// The outward unit normal.
    #[inline]
    #[must_use]
    pub const fn outward(&self) -> Vector3<T> {
        self.normal
    }

    /// Signed distance of a point from the plane \[m\], positive outside.
    #[inline]
    #[must_use]
    pub fn height(&self, point: &Vector3<T>) -> T {
        (point - self.point).dot(&self.normal)
    }
}

impl<T: Real> Plane<T> {
    /// The closest approach to a part of the plane around its point: at the point of the line over
    /// which that part is nearest.
    pub(super) fn closest_to_part(
        &self,
        line: &Line<T>,
        is_active: impl FnOnce(&Vector3<T>) -> bool,
    ) -> Option<ClosestApproach<T>> {
        let (offset, _) = foot(line, &self.point);
        let nearest = Line { point: self.point + offset, direction: line.direction };
        let approach = self.closest_approach(&nearest)?;
        Some(ClosestApproach { active: is_active(&approach.point), ..approach })
    }
}

impl<T: Real> ActiveSurface<T> for Plane<T> {
    #[inline]
    fn crossings(&self, line: &Line<T>, mut visit: impl FnMut(Crossing<T>)) {
        let along = (self.point - line.point).dot(&self.normal) / line.direction.dot(&self.normal);
        let point = line.at(along);
        // A parallel line, or one so nearly parallel that it meets the plane beyond the range of
        // the type, does not cross it.
        if is_finite(&point) {
            visit(Crossing { along, point, normal: self.normal, active: true });
        }
    }

    fn closest_approach(&self, line: &Line<T>) -> Option<ClosestApproach<T>> {
        let height = self.height(&line.point);
        let below = line.point - self.normal * height;
        Some(ClosestApproach {
            gap: height.abs().min(T::GREATEST),
            point: if is_finite(&below) { below } else { self.point },
            normal: self.normal,
            active: true,
        })
    }

    #[inline]
    fn normal(&self, _point: &Vector3<T>) -> Vector3<T> {
        self.normal
    }

    #[inline]
    fn contains(&self, point: &Vector3<T>) -> bool {
        self.height(point) < T::zero()
    }

    #[inline(always)]
    fn shortcuts(&self) -> impl Shortcuts<T> {
        self
    }
}

impl<T: Real> Shortcuts<T> for Plane<T> {
    #[inline]
    fn sole_entry(&self, push: &ForceLine<T>) -> Option<Entry<T>> {
        let slope = push.force().dot(&self.normal);
        if !(slope < T::zero()) {
            return None;
        }
        // From the plane's point to the foot of the line, and along the force back to the plane.
        let inverse = T::one() / push.squared();
        let foot = push.force().cross(&push.torque_about(&self.point)) * inverse;
        let across = foot - push.force() * (foot.dot(&self.normal) / slope);
        let point = self.point + across;
        is_finite(&point).then(|| Entry {
            point,
            normal: self.normal,
            incidence_squared: slope * slope * inverse,
            parts: None,
            active: true,
        })
    }

    fn surface_residual(&self, point: &Vector3<T>) -> T {
        dot_with(difference(point, &self.point), &self.normal).value()
    }
}

/// The extent of an unbounded plane is a ball of one metre around its point.
impl<T: Real> SmoothSurface<T> for Plane<T> {
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        let normal = self.normal(point);
        Level { value: normal.dot(&(point - self.point())), gradient: normal, hessian: Matrix3::zeros() }
    }

    fn extent(&self) -> Extent<T> {
        Extent { centre: self.point(), radius: T::one() }
    }

    fn topology(&self) -> Topology {
        Topology::Convex
    }
}

stored! {
    Plane<T>, [T: Real],
    |plane| {
        #[serde(default = "Vector3::zeros")] point_m: Vector3<T> = plane.point,
        #[serde(default = "Vector3::z")] normal: Vector3<T> = plane.normal,
    },
    Plane::new(point_m, normal)
}
