//! A shape of which only a region may touch.

use fingertip_wrench::{Line, Real, stored};
use nalgebra::{Matrix2, Matrix3, Vector3};

use crate::{
    ActiveSurface, BadShape, ClosestApproach, Corner, Crossing, Extent, Level, Shortcuts, SmoothSurface,
    Topology,
};

/// A part of space. Closures `Fn(&Vector3<T>) -> bool` are regions too.
///
/// ```
/// use fingertip_surfaces::{ActiveSurface, Region, Sphere, Trimmed};
/// use fingertip_wrench::Line;
/// use nalgebra::Vector3;
///
/// /// Within a cone around the z axis.
/// struct Around {
///     greatest_slope: f64,
/// }
/// impl Region<f64> for Around {
///     fn includes(&self, point: &Vector3<f64>) -> bool {
///         point.xy().norm() <= self.greatest_slope * point.z
///     }
/// }
///
/// let pad = Trimmed::new(Sphere::centred(0.013)?, Around { greatest_slope: 1.0 });
/// let line = Line { point: Vector3::new(0.0, 0.0, 0.05), direction: -Vector3::z() };
/// let mut active = Vec::new();
/// pad.crossings(&line, |crossing| active.push(crossing.active));
/// assert_eq!(active, [true, false]); // the top, and the bottom
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is no region of a surface of `{T}`",
    note = "a closure that answers for a point is one, and a `HalfSpace`; a type of your own implements `Region::includes`"
)]
pub trait Region<T: Real> {
    /// `true` if the point belongs to it.
    fn includes(&self, point: &Vector3<T>) -> bool;
}

impl<T: Real, F: Fn(&Vector3<T>) -> bool> Region<T> for F {
    #[inline]
    fn includes(&self, point: &Vector3<T>) -> bool {
        self(point)
    }
}

/// All points on one side of a plane.
///
/// ```
/// use fingertip_surfaces::{HalfSpace, Region};
/// use nalgebra::Vector3;
///
/// // All that is more than 5 mm up.
/// let above = HalfSpace::new(Vector3::new(0.0, 0.0, 0.005), Vector3::z())?;
/// assert!(above.includes(&Vector3::new(0.1, 0.1, 0.006)));
/// assert!(!above.includes(&Vector3::new(0.0, 0.0, 0.004)));
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfSpace<T: Real> {
    point: Vector3<T>,
    inward: Vector3<T>,
}

impl<T: Real> HalfSpace<T> {
    /// From a point of the plane \[m\] and the direction, of any length, from there into the
    /// region.
    ///
    /// # Errors
    /// [`BadShape`] unless the point is finite and the direction has a direction.
    pub fn new(point: Vector3<T>, inward: Vector3<T>) -> Result<Self, BadShape> {
        Ok(Self {
            point: BadShape::check_point("half-space", "point", point)?,
            inward: BadShape::check_direction("half-space", "inward direction", inward)?,
        })
    }
}

impl<T: Real> Region<T> for HalfSpace<T> {
    #[inline]
    fn includes(&self, point: &Vector3<T>) -> bool {
        (point - self.point).dot(&self.inward) >= T::zero()
    }
}

impl<T: Real, S: SmoothSurface<T>, R: Region<T>> SmoothSurface<T> for Trimmed<S, R> {
    #[inline]
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        self.inner().level(point)
    }

    fn extent(&self) -> Extent<T> {
        self.inner().extent()
    }

    fn topology(&self) -> Topology {
        self.inner().topology()
    }

    fn shape_operator(&self, point: &Vector3<T>) -> Matrix3<T> {
        self.inner().shape_operator(point)
    }

    fn bend(&self, point: &Vector3<T>, normal: &Vector3<T>, tangents: [&Vector3<T>; 2]) -> Matrix2<T> {
        self.inner().bend(point, normal, tangents)
    }

    fn corner(&self, point: &Vector3<T>, normal: &Vector3<T>) -> Option<Corner<T>> {
        self.inner().corner(point, normal)
    }
}

stored! {
    HalfSpace<T>, [T: Real],
    |region| {
        point_m: Vector3<T> = region.point,
        inward: Vector3<T> = region.inward,
    },
    HalfSpace::new(point_m, inward)
}

/// A shape that is active only within a region: what lies outside is still part of the shape, and
/// a force that presses there is reported as pressing outside the active region.
///
/// ```
/// use fingertip_surfaces::{HalfSpace, Sphere, Trimmed};
/// use nalgebra::Vector3;
///
/// let above = HalfSpace::new(Vector3::<f64>::zeros(), Vector3::z())?;
/// let dome = Trimmed::new(Sphere::centred(0.013)?, above);
/// // Or, with any condition:
/// let band = Trimmed::new(Sphere::centred(0.013)?, |p: &Vector3<f64>| p.z.abs() < 0.004);
/// # let _ = (dome, band);
/// // A line across the ball 5 mm up meets the dome, but not the band.
/// use fingertip_surfaces::ActiveSurface;
/// use fingertip_wrench::Line;
/// let line = Line { point: Vector3::new(-0.05, 0.0, 0.005), direction: Vector3::x() };
/// dome.crossings(&line, |crossing| assert!(crossing.active));
/// band.crossings(&line, |crossing| assert!(!crossing.active));
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Trimmed<S, R> {
    surface: S,
    region: R,
}

impl<S, R> Trimmed<S, R> {
    /// `surface`, active within `region` only.
    #[inline]
    #[must_use]
    pub const fn new(surface: S, region: R) -> Self {
        Self { surface, region }
    }

    /// The whole shape.
    #[inline]
    #[must_use]
    pub const fn inner(&self) -> &S {
        &self.surface
    }

    /// Where it is active.
    #[inline]
    #[must_use]
    pub const fn region(&self) -> &R {
        &self.region
    }
}

impl<T: Real, S: ActiveSurface<T>, R: Region<T>> ActiveSurface<T> for Trimmed<S, R> {
    #[inline]
    fn crossings(&self, line: &Line<T>, mut visit: impl FnMut(Crossing<T>)) {
        self.surface.crossings(line, |c| {
            visit(Crossing { active: c.active && self.region.includes(&c.point), ..c });
        });
    }

    fn closest_approach(&self, line: &Line<T>) -> Option<ClosestApproach<T>> {
        let found = self.surface.closest_approach(line)?;
        Some(ClosestApproach { active: found.active && self.region.includes(&found.point), ..found })
    }

    #[inline]
    fn normal(&self, point: &Vector3<T>) -> Vector3<T> {
        self.surface.normal(point)
    }

    #[inline(always)]
    fn shortcuts(&self) -> impl Shortcuts<T> {
        self.surface.shortcuts().within(|entry| self.region.includes(&entry.point))
    }

    #[inline]
    fn contains(&self, point: &Vector3<T>) -> bool {
        self.surface.contains(point)
    }
}
