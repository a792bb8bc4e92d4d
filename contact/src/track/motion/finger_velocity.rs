//! The velocity of the finger against the object.

use fingertip_surfaces::numeric::vectors::is_finite;
use fingertip_wrench::Real;
use nalgebra::{Matrix2, Vector3};

/// How the finger moves against the object that it touches, in the sensor frame: of an object at rest, how the finger
/// moves (`docs/theory/contact.md#rolling-and-sliding`).
///
/// ```
/// use fingertip_contact::FingerVelocity;
/// use nalgebra::{Matrix2, Vector3};
///
/// // A ball of 13 mm that rolls on a table below it, which is flat, at 1 rad/s.
/// let (point, normal) = (Vector3::new(0.0, 0.0, -0.013), -Vector3::z());
/// let rolls = FingerVelocity { linear: Vector3::x() * 0.013, angular: Vector3::y() };
/// assert!(rolls.sliding(&point, &normal).norm() < 1e-15);
/// let of_ball = Matrix2::identity() / 0.013;
/// let tangents = [Vector3::x(), -Vector3::y()];
/// let over = rolls.rolling(&normal, &tangents, &of_ball, &Matrix2::zeros());
/// // The contact runs over the ball at the speed at which the ball gets on.
/// assert!((over.ok_or("it does not touch")? - Vector3::x() * 0.013).norm() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FingerVelocity<T: Real> {
    /// Of the origin of the sensor frame \[m/s\].
    pub linear: Vector3<T>,
    /// Angular velocity \[rad/s\].
    pub angular: Vector3<T>,
}

impl<T: Real> FingerVelocity<T> {
    /// How fast the finger's surface slides over the object at a contact \[m/s\], in the tangent plane: zero where it
    /// sticks or rolls. `v + ω × c`, without its part along the normal.
    #[must_use]
    pub fn sliding(&self, point: &Vector3<T>, normal: &Vector3<T>) -> Vector3<T> {
        let velocity = self.linear + self.angular.cross(point);
        velocity - normal * velocity.dot(normal)
    }

    /// How fast the contact runs over the fingertip \[m/s\] if it rolls without sliding, given the curvatures of finger and
    /// object along the tangents \[1/m\], each positive where it is convex: `ċ` of `(K_f + K_o) ċ = n × ω`.
    ///
    /// `None` where they fit into each other, so that no single point touches, or numbers are out of range.
    #[must_use]
    pub fn rolling(
        &self,
        normal: &Vector3<T>,
        tangents: &[Vector3<T>; 2],
        finger: &Matrix2<T>,
        object: &Matrix2<T>,
    ) -> Option<Vector3<T>> {
        let [e1, e2] = tangents;
        let turning = normal.cross(&self.angular);
        let together = finger + object;
        let inverse = together.try_inverse()?;
        let convex = together.m11 > T::zero() && together.determinant() > T::zero();
        let along = inverse * nalgebra::Vector2::new(e1.dot(&turning), e2.dot(&turning));
        let velocity = e1 * along.x + e2 * along.y;
        (convex && is_finite(&velocity)).then_some(velocity)
    }
}
