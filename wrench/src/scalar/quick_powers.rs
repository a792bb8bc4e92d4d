//! Logarithms and powers of two to some eight digits, for the steps of a search but the last.

/// `log₂ x` of a positive `x`, and `2^y`, with series that are as short as eight digits allow.
///
/// `x = 2^k m` with `½ ≤ m² < 2` has `log₂ x = k + (2/ln 2) artanh((m − 1)/(m + 1))`; the whole part of `y` goes to the
/// exponent, and the rest, half of one at most, to the series of `e^x`. Sums and products alone: every computer has the
/// same bits. What comes of a number that is not positive, or of NaN, is a number of no meaning.
macro_rules! quick_powers {
    ($logarithm:ident, $power:ident, $float:ident, $mantissa_bits:literal, $largest:literal) => {
        #[inline]
        pub(super) fn $logarithm(x: $float) -> $float {
            // Of √½, from which on mantissas count.
            let bits = x.to_bits();
            let least = core::$float::consts::FRAC_1_SQRT_2.to_bits();
            let exponent = bits.wrapping_sub(least).cast_signed() >> $mantissa_bits;
            let mantissa = $float::from_bits(bits.wrapping_sub(exponent.cast_unsigned() << $mantissa_bits));
            let s = (mantissa - 1.0) / (mantissa + 1.0);
            let z = s * s;
            let artanh = s * (1.0 + z * (1.0 / 3.0 + z * (1.0 / 5.0 + z * (1.0 / 7.0 + z * (1.0 / 9.0)))));
            exponent as $float + 2.0 * core::$float::consts::LOG2_E * artanh
        }

        #[inline]
        pub(super) fn $power(y: $float) -> $float {
            // To this a number below a quarter of it is added without its part behind the point.
            const WHOLE: $float = 1.5 * (1_u64 << $mantissa_bits) as $float;
            let y = y.clamp(-$largest, $largest);
            let shifted = y + WHOLE;
            let x = (y - (shifted - WHOLE)) * core::$float::consts::LN_2;
            let square = x * x;
            let high = (1.0 / 24.0 + x * (1.0 / 120.0)) + square * (1.0 / 720.0 + x * (1.0 / 5040.0));
            let series = (1.0 + x) + square * ((0.5 + x * (1.0 / 6.0)) + square * high);
            $float::from_bits(series.to_bits().wrapping_add(shifted.to_bits() << $mantissa_bits))
        }
    };
}

quick_powers!(logarithm_f32, power_f32, f32, 23, 120.0);
quick_powers!(logarithm_f64, power_f64, f64, 52, 1000.0);

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::{logarithm_f32, logarithm_f64, power_f32, power_f64};

    /// In units of what a number has of digits: those of its own, and of 1.
    fn off(found: f64, exact: f64) -> f64 {
        (found - exact).abs() / (1.0 + exact.abs())
    }

    proptest! {
        #[test]
        fn they_have_eight_digits(x in 1e-30_f64..4.0, y in -100.0_f64..100.0) {
            let single = x as f32;
            prop_assert!(off(logarithm_f64(x), libm::log2(x)) < 3e-9);
            prop_assert!(off(f64::from(logarithm_f32(single)), libm::log2(f64::from(single))) < 2e-7);
            prop_assert!((power_f64(y) / libm::exp2(y) - 1.0).abs() < 8e-9);
            let single = y as f32;
            prop_assert!((f64::from(power_f32(single)) / libm::exp2(f64::from(single)) - 1.0).abs() < 4e-7);
        }

        /// Nothing that comes in makes them panic, and what is out of range stays a number.
        #[test]
        fn whatever_comes_in_a_number_comes_out(bits in any::<u64>(), y in -1e30_f64..1e30) {
            prop_assert!(logarithm_f64(f64::from_bits(bits)).is_finite() && power_f64(y).is_finite());
            prop_assert!(logarithm_f32(f32::from_bits(bits as u32)).is_finite());
            prop_assert!(power_f32(y as f32).is_finite());
        }
    }

    #[test]
    fn ends_of_the_range() {
        assert_eq!(
            (logarithm_f64(1.0), logarithm_f32(1.0), power_f64(0.0), power_f32(0.0)),
            (0.0, 0.0, 1.0, 1.0)
        );
        assert_eq!(
            (logarithm_f64(0.25), logarithm_f32(8.0), power_f64(-3.0), power_f32(5.0)),
            (-2.0, 3.0, 0.125, 32.0)
        );
        for least in [0.0, f64::from_bits(1), f64::MIN_POSITIVE] {
            assert!(logarithm_f64(least) <= -1022.0);
        }
        for least in [0.0, f32::from_bits(1), f32::MIN_POSITIVE] {
            assert!(logarithm_f32(least) <= -126.0);
        }
        assert!(power_f64(-1e6) < 1e-300 && power_f32(-1e6) < 1e-36);
        assert!(power_f64(1e6) > 1e300 && power_f32(1e6) > 1e36);
    }
}
