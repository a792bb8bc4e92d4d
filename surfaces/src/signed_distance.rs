//! Shapes that know how far a point is from them.

use fingertip_wrench::Real;
use nalgebra::Vector3;

use crate::ActiveSurface;

/// How far a point is from a surface, and in which direction the distance grows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distance<T: Real> {
    /// Distance to the closest point of the surface \[m\], negative inside.
    pub distance: T,
    /// Gradient of the distance: the outward unit normal at that closest point.
    pub normal: Vector3<T>,
}

/// A surface that knows the exact distance of any point, as its parallel surface needs
/// ([`Offset`](crate::Offset)).
pub trait SignedDistance<T: Real>: ActiveSurface<T> {
    /// `true` if the inside is convex: its parallel surfaces are then met by a line twice at most,
    /// and found much faster.
    const CONVEX: bool = false;

    /// Distance of a point to the closest point of the surface, negative inside.
    fn signed_distance(&self, point: &Vector3<T>) -> Distance<T>;

    /// Centre and radius \[m\] of a ball around the whole surface.
    fn bounds(&self) -> (Vector3<T>, T);
}
