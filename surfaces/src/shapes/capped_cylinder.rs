//! The circular cylinder, closed at its ends.

use fingertip_wrench::{Line, Real, stored};
use nalgebra::{Matrix2, Matrix3, Vector3};

use super::axis::Axis;
use crate::numeric::vectors::wide;
use crate::shortcuts::{LineInDouble, entry_near};
use crate::{
    ActiveSurface, BadShape, ClosestApproach, Corner, Crossing, Distance, Entry, Extent, ForceLine, Frustum,
    Level, Shortcuts, SignedDistance, SmoothSurface, Topology,
};

/// A circular cylinder with flat ends, all of it active: a [`Frustum`] with equal radii.
///
/// ```
/// use fingertip_surfaces::{CappedCylinder, SignedDistance};
/// use nalgebra::Vector3;
///
/// // Along z, 6 mm in radius, from −20 mm to 20 mm.
/// let tip = CappedCylinder::new(Vector3::zeros(), Vector3::z(), 0.006, 0.02)?;
/// let over_the_end = tip.signed_distance(&Vector3::new(0.003, 0.0, 0.021));
/// assert!((over_the_end.distance - 0.001_f64).abs() < 1e-15);
/// assert_eq!(over_the_end.normal, Vector3::z());
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CappedCylinder<T: Real> {
    solid: Frustum<T>,
    centre: Vector3<T>,
    half_length: T,
}

impl<T: Real> CappedCylinder<T> {
    /// Around its centre \[m\], along an axis of any length, with a radius \[m\] and half its
    /// length \[m\].
    ///
    /// # Errors
    /// [`BadShape`] unless the centre is finite, the axis has a direction, and radius and half
    /// length are positive finite lengths.
    pub fn new(centre: Vector3<T>, axis: Vector3<T>, radius: T, half_length: T) -> Result<Self, BadShape> {
        let shape = "capped cylinder";
        let axis = BadShape::check_direction(shape, "axis", axis)?;
        let half_length = BadShape::check_length(shape, "half length", half_length)?;
        let radius = BadShape::check_length(shape, "radius", radius)?;
        let base = centre - axis * half_length;
        let solid = Frustum::new(base, axis, radius, radius, half_length + half_length)
            .map_err(|bad| BadShape { shape, ..bad })?;
        Ok(Self { solid, centre, half_length })
    }

    /// As the frustum that it is.
    #[inline]
    #[doc(hidden)]
    pub const fn solid(&self) -> &Frustum<T> {
        &self.solid
    }

    /// The same in double precision.
    #[doc(hidden)]
    #[must_use]
    pub fn in_double(&self) -> Option<CappedCylinder<f64>> {
        let [radius, half] = [self.radius(), self.half_length].map(Real::to_f64);
        CappedCylinder::new(wide(&self.centre), wide(&self.axis()), radius, half).ok()
    }

    /// The middle \[m\].
    #[inline]
    #[must_use]
    pub const fn centre(&self) -> Vector3<T> {
        self.centre
    }

    /// Unit vector along the axis.
    #[inline]
    #[must_use]
    pub const fn axis(&self) -> Vector3<T> {
        self.solid.axis()
    }

    /// Radius \[m\].
    #[inline]
    #[must_use]
    pub const fn radius(&self) -> T {
        self.solid.base_radius()
    }

    /// Half the length \[m\].
    #[inline]
    #[must_use]
    pub const fn half_length(&self) -> T {
        self.half_length
    }
}

impl<T: Real> ActiveSurface<T> for CappedCylinder<T> {
    #[inline]
    fn crossings(&self, line: &Line<T>, visit: impl FnMut(Crossing<T>)) {
        self.solid.crossings(line, visit);
    }

    fn closest_approach(&self, line: &Line<T>) -> Option<ClosestApproach<T>> {
        self.solid.closest_approach(line)
    }

    fn normal(&self, point: &Vector3<T>) -> Vector3<T> {
        self.solid.normal(point)
    }

    fn contains(&self, point: &Vector3<T>) -> bool {
        self.solid.contains(point)
    }

    #[inline(always)]
    fn shortcuts(&self) -> impl Shortcuts<T> {
        self
    }
}

/// About the centre, which is stated: the base is rounded, and a line that grazes the side enters it farther along by that over
/// the cosine of incidence.
impl<T: Real> Shortcuts<T> for CappedCylinder<T> {
    const CLOSED_CONVEX: bool = true;

    #[inline(always)]
    fn sole_entry(&self, push: &ForceLine<T>) -> Option<Entry<T>> {
        self.solid.sole_entry(push)
    }

    fn surface_residual(&self, point: &Vector3<T>) -> T {
        let axis = Axis::new(self.centre, self.axis());
        let side = axis.outside_by(point, self.radius());
        axis.outside_side_or_end(point, side, [-self.half_length, self.half_length])
    }

    /// As on a frustum.
    fn entry_in_double(&self, line: &Line<f64>, near: &Vector3<f64>) -> Option<LineInDouble> {
        entry_near(&self.in_double()?, line, near)
    }
}

impl<T: Real> SignedDistance<T> for CappedCylinder<T> {
    const CONVEX: bool = true;

    fn signed_distance(&self, point: &Vector3<T>) -> Distance<T> {
        self.solid.signed_distance(point)
    }

    fn bounds(&self) -> (Vector3<T>, T) {
        self.solid.bounds()
    }
}

/// The level function is that of the side; the flat ends are not part of it, but of the curvature.
impl<T: Real> SmoothSurface<T> for CappedCylinder<T> {
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        self.solid().level(point)
    }

    fn extent(&self) -> Extent<T> {
        self.solid().extent()
    }

    fn topology(&self) -> Topology {
        Topology::Convex
    }

    fn shape_operator(&self, point: &Vector3<T>) -> Matrix3<T> {
        self.solid().shape_operator(point)
    }

    fn bend(&self, point: &Vector3<T>, normal: &Vector3<T>, tangents: [&Vector3<T>; 2]) -> Matrix2<T> {
        self.solid().bend(point, normal, tangents)
    }

    fn corner(&self, point: &Vector3<T>, normal: &Vector3<T>) -> Option<Corner<T>> {
        self.solid().corner(point, normal)
    }
}

stored! {
    CappedCylinder<T>, [T: Real],
    |cylinder| {
        #[serde(default = "Vector3::zeros")]
        centre_m: Vector3<T> = cylinder.centre,
        #[serde(default = "Vector3::z")] axis: Vector3<T> = cylinder.axis(),
        radius_m: T = cylinder.radius(),
        half_length_m: T = cylinder.half_length,
    },
    CappedCylinder::new(centre_m, axis, radius_m, half_length_m)
}
