//! Shapes that know how far a point is from them.

use fingertip_wrench::Real;
use nalgebra::Vector3;

use crate::ActiveSurface;

/// How far a point is from a surface, and in which direction the distance grows.
///
/// ```
/// use fingertip_surfaces::{SignedDistance, Sphere};
/// use nalgebra::Vector3;
///
/// // A point 3 mm under the surface of a ball: its nearest place is straight out.
/// let under = Sphere::centred(0.013)?.signed_distance(&Vector3::new(0.0, 0.01, 0.0));
/// assert!((under.distance + 0.003_f64).abs() < 1e-15);
/// assert_eq!(under.normal, Vector3::y());
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distance<T: Real> {
    /// Distance to the closest point of the surface \[m\], negative inside.
    pub distance: T,
    /// Gradient of the distance: the outward unit normal at that closest point.
    pub normal: Vector3<T>,
}

/// A surface that knows the exact distance of any point, as its parallel surface needs
/// ([`Offset`](crate::Offset)).
///
/// ```
/// use fingertip_surfaces::{BadShape, RoundedBox, SignedDistance, Sphere};
/// use nalgebra::Vector3;
///
/// /// The place of a surface that is nearest to a point.
/// fn nearest(surface: &impl SignedDistance<f64>, point: &Vector3<f64>) -> Vector3<f64> {
///     let found = surface.signed_distance(point);
///     point - found.normal * found.distance
/// }
///
/// let above = Vector3::new(0.0, 0.0, 0.02);
/// assert_eq!(nearest(&Sphere::centred(0.013)?, &above).z, 0.013);
/// assert!((nearest(&RoundedBox::new(Vector3::repeat(0.01), 0.001)?, &above).z - 0.01).abs() < 1e-15);
/// # Ok::<(), BadShape>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` does not know how far points of `{T}` are from it",
    note = "an `Offset` needs that; a shape of your own implements it beside `ActiveSurface`"
)]
pub trait SignedDistance<T: Real>: ActiveSurface<T> {
    /// `true` if the inside is convex: its parallel surfaces are then met by a line twice at most,
    /// and found much faster.
    const CONVEX: bool = false;

    /// Distance of a point to the closest point of the surface, negative inside.
    fn signed_distance(&self, point: &Vector3<T>) -> Distance<T>;

    /// Centre and radius \[m\] of a ball around the whole surface.
    fn bounds(&self) -> (Vector3<T>, T);
}
