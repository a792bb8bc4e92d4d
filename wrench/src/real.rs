//! The scalar that every crate of the workspace is generic over.

use nalgebra::RealField;

/// A real number: the one bound that all crates use.
///
/// It adds to nalgebra's [`RealField`] what numerical code needs and that trait lacks: the
/// rounding unit and the range as constants, literals, exact scaling by a power of two, and a
/// square root that becomes the hardware instruction on a microcontroller.
///
/// `f32` and `f64` are its full citizens. It is not sealed: dual numbers (to check Jacobians) or
/// double-double numbers (to make references) may implement it. Only the three constants and
/// [`literal`](Real::literal) and [`to_f64`](Real::to_f64) are required.
pub trait Real: RealField + Copy {
    /// Distance from 1 to the next larger number (`2^-52` for `f64`, `2^-23` for `f32`).
    const EPSILON: Self;
    /// Smallest positive normal number.
    const LEAST_NORMAL: Self;
    /// Largest finite number.
    const GREATEST: Self;

    /// The number nearest to `value`.
    fn literal(value: f64) -> Self;

    /// The `f64` nearest to this number, for printing and reports.
    fn to_f64(self) -> f64;

    /// Square root; NaN for a negative number.
    ///
    /// On Arm targets with a floating-point unit and without the standard library, `f32` uses the
    /// `vsqrt` instruction instead of the software routine that nalgebra would call.
    #[inline]
    fn root(self) -> Self {
        self.sqrt()
    }

    /// A factor `k` that brings `self·k` near 1, without rounding error where the type is binary.
    ///
    /// For `f32` and `f64`, `k` is the power of two with `1 ≤ |self|·k < 2` for every normal
    /// number below a quarter of the range, and both `k` and `1/k` are normal numbers for *every*
    /// input, zero, subnormal, infinite and NaN included. Multiplying by it is exact unless the
    /// product under- or overflows. The default divides, which rounds once.
    #[inline]
    fn normalising_factor(self) -> Self {
        let magnitude = self.abs();
        if magnitude > Self::LEAST_NORMAL && magnitude < Self::GREATEST {
            Self::one() / magnitude
        } else {
            Self::one()
        }
    }

    /// `true` unless NaN or infinite.
    #[inline]
    fn is_number(self) -> bool {
        nalgebra::ComplexField::is_finite(&self)
    }
}

macro_rules! real {
    ($float:ident, $bits:ident, $mantissa_bits:literal, $exponent_mask:literal, $root:path) => {
        impl Real for $float {
            const EPSILON: Self = $float::EPSILON;
            const LEAST_NORMAL: Self = $float::MIN_POSITIVE;
            const GREATEST: Self = $float::MAX;

            #[inline]
            #[allow(clippy::cast_possible_truncation)]
            fn literal(value: f64) -> Self {
                value as $float
            }

            #[inline]
            fn to_f64(self) -> f64 {
                f64::from(self)
            }

            #[inline]
            fn root(self) -> Self {
                $root(self)
            }

            #[inline]
            fn normalising_factor(self) -> Self {
                let exponent = (self.to_bits() >> $mantissa_bits) & $exponent_mask;
                // A biased exponent of 0 (zero, subnormal) counts as 1, and the topmost two as the
                // largest whose reciprocal is still normal.
                let clamped = exponent.clamp(1, $exponent_mask - 2);
                $float::from_bits((($exponent_mask - 1) - clamped) << $mantissa_bits)
            }

            #[inline]
            fn is_number(self) -> bool {
                self.is_finite()
            }
        }
    };
}

real!(f32, u32, 23, 0xff, crate::hardware_sqrt::sqrt_f32);
real!(f64, u64, 52, 0x7ff, nalgebra::ComplexField::sqrt);

#[cfg(test)]
mod tests {
    use super::Real;
    use proptest::prelude::*;

    fn check_normalising_factor<T: Real>(value: T) {
        let factor = value.normalising_factor();
        assert!(factor >= T::LEAST_NORMAL && T::one() / factor >= T::LEAST_NORMAL);
        let quarter = T::GREATEST / T::literal(4.0);
        if value.abs() >= T::LEAST_NORMAL && value.abs() < quarter {
            let scaled = value.abs() * factor;
            assert!(scaled >= T::one() && scaled < T::literal(2.0));
            assert_eq!(value * factor / factor, value);
        }
    }

    proptest! {
        #[test]
        fn normalising_factor_is_exact_for_any_bits(wide in any::<u64>(), narrow in any::<u32>()) {
            check_normalising_factor(f64::from_bits(wide));
            check_normalising_factor(f32::from_bits(narrow));
        }

        #[test]
        fn root_is_correctly_rounded(x in 0.0_f32..) {
            prop_assert_eq!(Real::root(x), x.sqrt());
        }
    }

    #[test]
    fn normalising_factor_at_the_extremes() {
        for value in [0.0, f64::MIN_POSITIVE, 5e-324, 1.0, f64::MAX, f64::INFINITY, f64::NAN] {
            check_normalising_factor(value);
            check_normalising_factor(value as f32);
        }
    }
}
