//! A frame around a direction.

use nalgebra::Vector3;

use crate::Real;

/// Two unit vectors that span the plane across `normal`, right-handed with it without a root or a branch
/// (Duff et al. 2017, after Frisvad 2012).
#[inline]
#[must_use]
pub fn tangents<T: Real>(normal: &Vector3<T>) -> (Vector3<T>, Vector3<T>) {
    let sign = if normal.z >= T::zero() { T::one() } else { -T::one() };
    let a = -T::one() / (sign + normal.z);
    let b = normal.x * normal.y * a;
    (
        Vector3::new(T::one() + sign * normal.x * normal.x * a, sign * b, -sign * normal.x),
        Vector3::new(b, sign + normal.y * normal.y * a, -normal.y),
    )
}
