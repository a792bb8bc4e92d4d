//! What an exponential decay leaves of a step.

use crate::Real;

/// `e^{−q}` and its mean over the step, `(1 − e^{−q})/q`, for `q = step/time constant`.
///
/// Both are exact to rounding for every `q ≥ 0`, subnormal and infinite included; they lie between 0 and 1. A `q` that
/// is negative or NaN counts as 0: nothing decays.
#[inline]
#[must_use]
pub fn decay<T: Real>(q: T) -> (T, T) {
    if !(q > T::zero()) {
        return (T::one(), T::one());
    }
    let left = (-q).exponential();
    let gone = -(-q).exponential_less_one();
    // Of a subnormal number the quotient is what rounding makes of 1.
    (left, (gone / q).min(T::one()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_between_its_bounds<T: Real>() {
        let tolerance = T::EPSILON * T::literal(4.0);
        for exponent in -35..35 {
            let q = T::literal(10.0_f64.powi(exponent));
            let (left, mean) = decay(q);
            assert!(T::zero() <= left && left <= T::one() && T::zero() <= mean && mean <= T::one(), "{q}");
            // The integral of the decay is what is gone: two ways to one number.
            assert!((q * mean + left - T::one()).abs() <= tolerance * (T::one() + q), "{q}");
            // By its series, where that converges at once.
            if q < T::literal(2e-5) {
                let series = T::one() - q / T::literal(2.0) + q * q / T::literal(6.0);
                assert!((mean - series).abs() <= tolerance, "{q}");
            }
        }
        for q in [T::zero(), -T::one(), T::literal(f64::NAN), T::LEAST_NORMAL * T::EPSILON] {
            assert_eq!(decay(q), (T::one(), T::one()));
        }
        assert_eq!(decay(T::literal(f64::INFINITY)), (T::zero(), T::zero()));
    }

    #[test]
    fn a_decay_and_its_mean_are_exact_at_every_step() {
        is_between_its_bounds::<f32>();
        is_between_its_bounds::<f64>();
    }
}
