//! Matrices without negative entries.

use nalgebra::Matrix6;

use crate::Real;

/// `(I − G)⁻¹ = (I + G)(I + G²)(I + G⁴)…` of a matrix without negative entries; `None` unless its
/// powers vanish. Nothing is subtracted, so nothing cancels.
pub(crate) fn neumann<T: Real>(matrix: &Matrix6<T>) -> Option<Matrix6<T>> {
    /// Powers up to 2^12: spectral radii up to about 0.99.
    const DOUBLINGS: usize = 12;
    let identity = Matrix6::identity();
    let mut power = *matrix;
    let mut sum = identity + power;
    for _ in 0..DOUBLINGS {
        power *= power;
        if !power.iter().all(|x| x.is_number()) {
            return None;
        }
        sum *= identity + power;
        if power.amax() <= T::EPSILON * T::EPSILON {
            return Some(sum);
        }
    }
    None
}
