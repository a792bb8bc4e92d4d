//! Counting rounding errors.

use crate::Real;

/// `γ_k = k u/(1 − k u)` with `u = ε/2`: the bound on `k` relative rounding errors in a row
/// (Higham 2002, lemma 3.1).
pub(crate) fn relative_rounding<T: Real>(k: usize) -> T {
    // At most a few hundred: exact.
    let relative = T::EPSILON * T::literal(0.5) * T::literal(k as f64);
    relative / (T::one() - relative)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// With `u` a power of two, `k u/(1 − k u)` is `k` over what `k` leaves of its reciprocal.
    #[test]
    fn roundings_in_a_row_add_up_to_a_little_more() {
        for k in [0, 1, 7, 100, 400_u16] {
            let (count, wide) = (usize::from(k), f64::from(k));
            let wanted = wide / (2.0_f64.powi(24) - wide);
            let found = f64::from(relative_rounding::<f32>(count));
            assert!((found - wanted).abs() <= 2.0 * f64::from(f32::EPSILON) * wanted, "{k}");
            let wanted = wide / (2.0_f64.powi(53) - wide);
            assert!((relative_rounding::<f64>(count) - wanted).abs() <= 2.0 * f64::EPSILON * wanted, "{k}");
        }
    }
}
