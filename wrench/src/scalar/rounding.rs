//! Counting rounding errors.

use crate::Real;

/// `γ_k = k u/(1 − k u)` with `u = ε/2`: the bound on `k` relative rounding errors in a row
/// (Higham 2002, lemma 3.1).
pub(crate) fn relative_rounding<T: Real>(k: usize) -> T {
    // At most a few hundred: exact.
    let relative = T::EPSILON * T::literal(0.5) * T::literal(k as f64);
    relative / (T::one() - relative)
}
