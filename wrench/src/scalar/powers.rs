//! Logarithms and powers of two by short series: to some eight digits, for the steps of a search but the last, and to those
//! of double precision, for the last.

use core::ops::{Add, Mul};

/// `log₂ x` of a positive `x`, and `2^y`, with series that are as short as the digits allow.
///
/// `x = 2^k m` with `½ ≤ m² < 2` has `log₂ x = k + (2/ln 2) artanh((m − 1)/(m + 1))`; the whole part of `y` goes to the
/// exponent, and the rest, half of one at most, to the series of `2^x`. Sums and products alone, in as few as wait for one
/// another: every computer has the same bits. What comes of a number that is not positive, or of NaN, is a number of no
/// meaning.
macro_rules! powers {
    ($logarithm:ident by $odd_terms:literal, $of_square:path, $power:ident by $terms:literal, $of_rest:path,
     $float:ident, $mantissa_bits:literal, $largest:literal) => {
        #[inline]
        pub(super) fn $logarithm(x: $float) -> $float {
            const ARTANH: [$float; $odd_terms] = {
                let (mut terms, mut k) = ([1.0; $odd_terms], 1);
                while k < $odd_terms {
                    terms[k] = 1.0 / (2 * k + 1) as $float;
                    k += 1;
                }
                terms
            };
            // Of √½, from which on mantissas count.
            let bits = x.to_bits();
            let least = core::$float::consts::FRAC_1_SQRT_2.to_bits();
            let exponent = bits.wrapping_sub(least).cast_signed() >> $mantissa_bits;
            let mantissa = $float::from_bits(bits.wrapping_sub(exponent.cast_unsigned() << $mantissa_bits));
            let s = (mantissa - 1.0) / (mantissa + 1.0);
            exponent as $float + s * (2.0 * core::$float::consts::LOG2_E) * $of_square(ARTANH, s * s)
        }

        #[inline]
        pub(super) fn $power(y: $float) -> $float {
            // To this a number below a quarter of it is added without its part behind the point.
            const WHOLE: $float = 1.5 * (1_u64 << $mantissa_bits) as $float;
            // Powers of ln 2 over factorials.
            const EXPONENTIAL: [$float; $terms] = {
                let (mut terms, mut k) = ([1.0; $terms], 1);
                while k < $terms {
                    terms[k] = terms[k - 1] * core::$float::consts::LN_2 / k as $float;
                    k += 1;
                }
                terms
            };
            const LARGEST: $float = $float::from_bits($float::to_bits(1.0) + ($largest << $mantissa_bits));
            const SMALLEST: $float = $float::from_bits($float::to_bits(1.0) - ($largest << $mantissa_bits));
            let shifted = y + WHOLE;
            let series = $of_rest(EXPONENTIAL, y - (shifted - WHOLE));
            let power = $float::from_bits(series.to_bits().wrapping_add(shifted.to_bits() << $mantissa_bits));
            // Behind the series, which need not wait for it. False for a NaN, too.
            if y.abs() < $largest as $float {
                power
            } else if y > 0.0 {
                LARGEST
            } else {
                SMALLEST
            }
        }
    };
}

powers!(quick_logarithm_f32 by 5, of_five, quick_power_f32 by 8, of_eight, f32, 23, 120);
powers!(quick_logarithm_f64 by 5, of_five, quick_power_f64 by 8, of_eight, f64, 52, 1000);
powers!(fine_logarithm_f64 by 11, of_eleven, fine_power_f64 by 14, of_fourteen, f64, 52, 1000);

/// A number of the series.
trait Term: Copy + Add<Output = Self> + Mul<Output = Self> {}

impl<T: Copy + Add<Output = T> + Mul<Output = T>> Term for T {}

/// The polynomial with these coefficients, pairs of terms first, then pairs of these.
#[inline(always)]
fn of_five<T: Term>([a, b, c, d, e]: [T; 5], x: T) -> T {
    let square = x * x;
    (a + x * b) + square * ((c + x * d) + square * e)
}

#[inline(always)]
fn of_eight<T: Term>([a, b, c, d, e, f, g, h]: [T; 8], x: T) -> T {
    let square = x * x;
    let (low, high) = ((a + x * b) + square * (c + x * d), (e + x * f) + square * (g + x * h));
    low + square * square * high
}

#[inline(always)]
fn of_eleven<T: Term>([a, b, c, d, e, f, g, h, i, j, k]: [T; 11], x: T) -> T {
    let square = x * x;
    let fourth = square * square;
    of_eight([a, b, c, d, e, f, g, h], x) + fourth * fourth * ((i + x * j) + square * k)
}

#[inline(always)]
fn of_fourteen<T: Term>([a, b, c, d, e, f, g, h, i, j, k, l, m, n]: [T; 14], x: T) -> T {
    let square = x * x;
    let fourth = square * square;
    let high = (i + x * j) + square * (k + x * l) + fourth * (m + x * n);
    of_eight([a, b, c, d, e, f, g, h], x) + fourth * fourth * high
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::{
        fine_logarithm_f64, fine_power_f64, quick_logarithm_f32, quick_logarithm_f64, quick_power_f32,
        quick_power_f64,
    };

    /// In units of what a number has of digits: those of its own, and of 1.
    fn off(found: f64, exact: f64) -> f64 {
        (found - exact).abs() / (1.0 + exact.abs())
    }

    proptest! {
        #[test]
        fn they_have_eight_digits(x in 1e-30_f64..4.0, y in -100.0_f64..100.0) {
            let single = x as f32;
            prop_assert!(off(quick_logarithm_f64(x), libm::log2(x)) < 3e-9);
            prop_assert!(off(f64::from(quick_logarithm_f32(single)), libm::log2(f64::from(single))) < 2e-7);
            prop_assert!((quick_power_f64(y) / libm::exp2(y) - 1.0).abs() < 8e-9);
            let single = y as f32;
            prop_assert!((f64::from(quick_power_f32(single)) / libm::exp2(f64::from(single)) - 1.0).abs() < 4e-7);
        }

        #[test]
        fn fine_ones_have_those_of_the_type(x in 1e-30_f64..4.0, y in -100.0_f64..100.0) {
            prop_assert!(off(fine_logarithm_f64(x), libm::log2(x)) < 4e-16);
            prop_assert!((fine_power_f64(y) / libm::exp2(y) - 1.0).abs() < 8e-16);
        }

        /// Nothing that comes in makes them panic, and what is out of range stays a number.
        #[test]
        fn whatever_comes_in_a_number_comes_out(bits in any::<u64>(), y in -1e30_f64..1e30) {
            prop_assert!(quick_logarithm_f64(f64::from_bits(bits)).is_finite() && quick_power_f64(y).is_finite());
            prop_assert!(fine_logarithm_f64(f64::from_bits(bits)).is_finite() && fine_power_f64(y).is_finite());
            prop_assert!(quick_logarithm_f32(f32::from_bits(bits as u32)).is_finite());
            prop_assert!(quick_power_f32(y as f32).is_finite());
        }
    }

    #[test]
    fn ends_of_the_range() {
        assert_eq!(
            (quick_logarithm_f64(1.0), quick_logarithm_f32(1.0), quick_power_f64(0.0), quick_power_f32(0.0)),
            (0.0, 0.0, 1.0, 1.0)
        );
        assert_eq!(
            (
                quick_logarithm_f64(0.25),
                quick_logarithm_f32(8.0),
                quick_power_f64(-3.0),
                quick_power_f32(5.0)
            ),
            (-2.0, 3.0, 0.125, 32.0)
        );
        for least in [0.0, f64::from_bits(1), f64::MIN_POSITIVE] {
            assert!(quick_logarithm_f64(least) <= -1022.0 && fine_logarithm_f64(least) <= -1022.0);
        }
        for least in [0.0, f32::from_bits(1), f32::MIN_POSITIVE] {
            assert!(quick_logarithm_f32(least) <= -126.0);
        }
        assert!(quick_power_f64(-1e6) < 1e-300 && quick_power_f32(-1e6) < 1e-36);
        assert_eq!(
            (fine_logarithm_f64(1.0), fine_power_f64(0.0), fine_logarithm_f64(0.25)),
            (0.0, 1.0, -2.0)
        );
        assert!(
            fine_power_f64(-1e6) < 1e-300 && fine_power_f64(1e6) > 1e300 && fine_power_f64(f64::NAN) < 1e-300
        );
        assert!(quick_power_f64(1e6) > 1e300 && quick_power_f32(1e6) > 1e36);
    }
}
