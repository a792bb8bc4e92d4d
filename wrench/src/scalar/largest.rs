//! The size of a vector.

use nalgebra::Vector3;

use crate::Real;

/// The largest magnitude of a component. It passes over a NaN in the first two, which costs nothing: what
/// is scaled by it stays NaN.
#[inline]
pub(crate) fn largest<T: Real>(v: &Vector3<T>) -> T {
    let larger = |a: T, b: T| if a > b { a } else { b };
    larger(larger(v.x.abs(), v.y.abs()), v.z.abs())
}
