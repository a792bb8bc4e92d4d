//! The plane, bounded by a circle.

use fingertip_wrench::{Line, Real, stored};
use nalgebra::Vector3;

use crate::numeric::vectors::length;
use crate::{
    ActiveSurface, BadShape, ClosestApproach, Crossing, Extent, Level, Plane, Shortcuts, SmoothSurface,
    Topology,
};

/// A plane of which only a disk is active.
///
/// ```
/// use fingertip_surfaces::{ActiveSurface, Disk};
/// use fingertip_wrench::Line;
/// use nalgebra::Vector3;
///
/// // A flat end of 5 mm radius, 30 mm up.
/// let tip = Disk::new(Vector3::new(0.0, 0.0, 0.03), Vector3::z(), 0.005)?;
/// for (x, active) in [(0.004, true), (0.006, false)] {
///     let line = Line { point: Vector3::new(x, 0.0, 0.05), direction: -Vector3::z() };
///     tip.crossings(&line, |crossing| assert_eq!((crossing.point.z, crossing.active), (0.03, active)));
/// }
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disk<T: Real> {
    plane: Plane<T>,
    radius: T,
}

impl<T: Real> Disk<T> {
    /// Around a centre \[m\], across an outward normal of any length, with a radius \[m\].
    ///
    /// # Errors
    /// [`BadShape`] unless the centre is finite, the normal has a direction and the radius is a
    /// positive finite length.
    pub fn new(centre: Vector3<T>, normal: Vector3<T>, radius: T) -> Result<Self, BadShape> {
        let plane = Plane::new(centre, normal).map_err(|bad| BadShape { shape: "disk", ..bad })?;
        Ok(Self { plane, radius: BadShape::check_length("disk", "radius", radius)? })
    }

    /// The plane in which the disk lies; its point is the centre.
    #[inline]
    #[must_use]
    pub const fn plane(&self) -> &Plane<T> {
        &self.plane
    }

    /// Radius \[m\].
    #[inline]
    #[must_use]
    pub const fn radius(&self) -> T {
        self.radius
    }

    #[inline]
    fn is_active(&self, point: &Vector3<T>) -> bool {
        length(&(point - self.plane.point())) <= self.radius
    }
}

impl<T: Real> ActiveSurface<T> for Disk<T> {
    #[inline]
    fn crossings(&self, line: &Line<T>, mut visit: impl FnMut(Crossing<T>)) {
        self.plane.crossings(line, |c| visit(Crossing { active: self.is_active(&c.point), ..c }));
    }

    fn closest_approach(&self, line: &Line<T>) -> Option<ClosestApproach<T>> {
        self.plane.closest_to_part(line, |point| self.is_active(point))
    }

    #[inline]
    fn normal(&self, point: &Vector3<T>) -> Vector3<T> {
        self.plane.normal(point)
    }

    #[inline]
    fn contains(&self, point: &Vector3<T>) -> bool {
        self.plane.contains(point)
    }

    #[inline(always)]
    fn shortcuts(&self) -> impl Shortcuts<T> {
        self
    }
}

impl<T: Real> Shortcuts<T> for Disk<T> {
    fn surface_residual(&self, point: &Vector3<T>) -> T {
        self.plane.surface_residual(point)
    }
}

impl<T: Real> SmoothSurface<T> for Disk<T> {
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        self.plane().level(point)
    }

    fn extent(&self) -> Extent<T> {
        Extent { centre: self.plane().point(), radius: self.radius() }
    }

    fn topology(&self) -> Topology {
        Topology::Convex
    }
}

stored! {
    Disk<T>, [T: Real],
    |disk| {
        #[serde(default = "Vector3::zeros")] centre_m: Vector3<T> = disk.plane.point(),
        #[serde(default = "Vector3::z")] normal: Vector3<T> = disk.plane.outward(),
        radius_m: T = disk.radius,
    },
    Disk::new(centre_m, normal, radius_m)
}
