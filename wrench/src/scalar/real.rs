//! The scalar that every crate of the workspace is generic over.

use nalgebra::RealField;

/// A real number: the one bound that all crates use.
///
/// It adds to nalgebra's [`RealField`] what numerical code needs and that trait lacks: the
/// rounding unit and the range as constants, literals, exact scaling by a power of two, a
/// square root that becomes the hardware instruction on a microcontroller, and elementary functions
/// of which every digit is the same with and without the standard library.
///
/// # Elementary functions
///
/// nalgebra's `powf`, `exp`, `sin` and their like are those of the C library with the feature `std` and those of
/// `libm` without; they differ in last digits, so a feature would change results. [`power`](Real::power),
/// [`exponential`](Real::exponential), [`sine`](Real::sine) and their like are `libm`'s for `f32` and `f64` always, on
/// every computer. The crates that need no standard library use these alone, and a test reads their sources for it.
/// A type that overrides none has nalgebra's.
///
/// `f32` and `f64` are its full citizens. It is not sealed: dual numbers (to check Jacobians) or
/// double-double numbers (to make references) may implement it. Only the first three constants and
/// [`literal`](Real::literal) and [`to_f64`](Real::to_f64) are required.
///
/// ```
/// use fingertip_wrench::Real;
///
/// /// The strain of a gauge at 45° in a state of pure shear.
/// fn diagonal<T: Real>(shear: T) -> T {
///     shear * T::literal(0.5)
/// }
///
/// assert_eq!(diagonal(3e-6_f64), 1.5e-6);
/// assert_eq!(diagonal(3e-6_f32), 1.5e-6);
/// // A power, the same to the last bit with and without the standard library.
/// assert_eq!(2.0_f64.power(0.5).to_bits(), 0x3ff6_a09e_667f_3bcd);
/// // A product and what its rounding lost: (1 + ε)² = 1 + 2ε + ε².
/// let near = 1.0 + f64::EPSILON;
/// assert_eq!(near.two_product(near), (1.0 + 2.0 * f64::EPSILON, f64::EPSILON * f64::EPSILON));
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is no scalar of fingertip",
    note = "take `f32` or `f64`: a number with a point, as in `1.0`"
)]
pub trait Real: RealField + Copy {
    /// Distance from 1 to the next larger number (`2^-52` for `f64`, `2^-23` for `f32`).
    const EPSILON: Self;
    /// Smallest positive normal number.
    const LEAST_NORMAL: Self;
    /// Largest finite number.
    const GREATEST: Self;
    /// Whether a number carries more than its value, as a dual number does its derivative: an iteration that ends when
    /// the value has settled then goes on.
    const CARRIES_MORE: bool = false;

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

    /// The number to a power; NaN for a negative number and a power that is not whole.
    #[inline]
    fn power(self, exponent: Self) -> Self {
        self.powf(exponent)
    }

    /// The logarithm to the base 2 of a positive number to some eight digits, or what digits the type has, several times as
    /// fast: for the steps of a search but the last. Of other numbers a number of no meaning.
    #[doc(hidden)]
    #[inline]
    fn quick_logarithm(self) -> Self {
        self.log2()
    }

    /// 2 to this power, as [`quick_logarithm`](Self::quick_logarithm).
    #[doc(hidden)]
    #[inline]
    fn quick_power_of_two(self) -> Self {
        self.exp2()
    }

    /// [`quick_logarithm`](Self::quick_logarithm) to the digits of double precision.
    #[doc(hidden)]
    #[inline]
    fn fine_logarithm(self) -> Self {
        self.log2()
    }

    /// [`quick_power_of_two`](Self::quick_power_of_two) to the digits of double precision.
    #[doc(hidden)]
    #[inline]
    fn fine_power_of_two(self) -> Self {
        self.exp2()
    }

    /// `e` to this power.
    #[inline]
    fn exponential(self) -> Self {
        self.exp()
    }

    /// `e^x − 1`, with all its digits where `x` is small.
    #[inline]
    fn exponential_less_one(self) -> Self {
        self.exp_m1()
    }

    /// The natural logarithm; NaN of a negative number.
    #[inline]
    fn logarithm(self) -> Self {
        self.ln()
    }

    /// The cube root, which has the sign of the number.
    #[inline]
    fn cube_root(self) -> Self {
        self.cbrt()
    }

    /// The sine of an angle \[rad\].
    #[inline]
    fn sine(self) -> Self {
        self.sin()
    }

    /// The cosine of an angle \[rad\].
    #[inline]
    fn cosine(self) -> Self {
        self.cos()
    }

    /// The tangent of an angle \[rad\].
    #[inline]
    fn tangent(self) -> Self {
        self.tan()
    }

    /// The angle \[rad\] with this tangent, within a quarter turn.
    #[inline]
    fn arctangent(self) -> Self {
        self.atan()
    }

    /// The angle \[rad\] of the point `(x, self)` from the first axis, within half a turn.
    #[inline]
    fn arctangent2(self, x: Self) -> Self {
        self.atan2(x)
    }

    /// The angle \[rad\] with this cosine, up to half a turn; NaN beyond ±1.
    #[inline]
    fn arccosine(self) -> Self {
        self.acos()
    }

    /// The sine and the cosine of an angle \[rad\].
    #[inline]
    fn sine_and_cosine(self) -> (Self, Self) {
        (self.sine(), self.cosine())
    }

    /// The number to a whole power, by squaring: each product is rounded, and a negative power is the reciprocal.
    #[inline]
    fn whole_power(self, exponent: i32) -> Self {
        let (mut left, mut square, mut product) = (exponent.unsigned_abs(), self, Self::one());
        while left > 0 {
            if left & 1 == 1 {
                product *= square;
            }
            left >>= 1;
            if left > 0 {
                square *= square;
            }
        }
        if exponent < 0 { Self::one() / product } else { product }
    }

    /// A factor `k` that brings `self·k` near 1, without rounding error where the type is binary.
    ///
    /// For `f32` and `f64`, `k` is the power of two with `1 ≤ |self|·k < 2` for every normal
    /// number below a quarter of the range, and both `k` and `1/k` are normal numbers for *every*
    /// input, zero, subnormal, infinite and NaN included. Multiplying by it is exact unless the
    /// product under- or overflows. The default divides, which rounds once.
    #[inline]
    fn normalising_factor(self) -> Self {
        reciprocal_in_range(self)
    }

    /// `true` unless NaN or infinite.
    #[inline]
    fn is_number(self) -> bool {
        nalgebra::ComplexField::is_finite(&self)
    }

    /// Veltkamp's constant `2^⌈p/2⌉ + 1` for a binary type of `p` bits: it splits a number into
    /// two halves whose products are exact.
    #[inline]
    fn splitter() -> Self {
        splitter_by_epsilon()
    }

    /// The product and its rounding error, `self·other = product + error` exactly (Dekker 1971
    /// with Veltkamp's splitting; 17 operations and no fused multiply-add, which microcontrollers
    /// do in software).
    ///
    /// Exact unless a factor is within `2^⌈p/2⌉` of the largest number (then the error is NaN) or
    /// the error underflows: scale first.
    #[inline]
    fn two_product(self, other: Self) -> (Self, Self) {
        let split = |x: Self| {
            let wide = Self::splitter() * x;
            let high = wide - (wide - x);
            (high, x - high)
        };
        let product = self * other;
        let (a_high, a_low) = split(self);
        let (b_high, b_low) = split(other);
        let error = a_low * b_low - (((product - a_high * b_high) - a_low * b_high) - a_high * b_low);
        (product, error)
    }

    /// The sum and its rounding error, `self + other = sum + error` exactly (Knuth; Møller).
    #[inline]
    fn two_sum(self, other: Self) -> (Self, Self) {
        let sum = self + other;
        let part = sum - self;
        (sum, (self - (sum - part)) + (other - part))
    }
}

/// The default of [`Real::normalising_factor`].
fn reciprocal_in_range<T: Real>(x: T) -> T {
    let magnitude = x.abs();
    if magnitude > T::LEAST_NORMAL && magnitude < T::GREATEST { T::one() / magnitude } else { T::one() }
}

/// The default of [`Real::splitter`], for types whose normalising factor is a power of two.
fn splitter_by_epsilon<T: Real>() -> T {
    // 1/ε is 2^(p−1), and the power of two at or below its root is 2^⌊(p−1)/2⌋.
    let half = (T::one() / T::EPSILON).sqrt().normalising_factor();
    T::literal(2.0) / half + T::one()
}

macro_rules! real {
    ($float:ident, $mantissa_bits:literal, $exponent_mask:literal, $splitter:literal, $root:path, $quick_logarithm:path, $quick_power:path, $fine_logarithm:path, $fine_power:path, $($name:ident($($other:ident)?) = $function:ident),*) => {
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
            fn quick_logarithm(self) -> Self {
                $quick_logarithm(self)
            }

            #[inline]
            fn quick_power_of_two(self) -> Self {
                $quick_power(self)
            }

            #[inline]
            fn fine_logarithm(self) -> Self {
                $fine_logarithm(self)
            }

            #[inline]
            fn fine_power_of_two(self) -> Self {
                $fine_power(self)
            }

            $(
                #[inline]
                fn $name(self $(, $other: Self)?) -> Self {
                    libm::$function(self $(, $other)?)
                }
            )*

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

            #[inline]
            fn splitter() -> Self {
                $splitter
            }
        }
    };
}

real!(
    f32,
    23,
    0xff,
    4_097.0,
    crate::scalar::hardware_sqrt::sqrt_f32,
    crate::scalar::powers::quick_logarithm_f32,
    crate::scalar::powers::quick_power_f32,
    libm::log2f,
    libm::exp2f,
    power(exponent) = powf,
    exponential() = expf,
    exponential_less_one() = expm1f,
    logarithm() = logf,
    cube_root() = cbrtf,
    sine() = sinf,
    cosine() = cosf,
    tangent() = tanf,
    arctangent() = atanf,
    arctangent2(x) = atan2f,
    arccosine() = acosf
);
real!(
    f64,
    52,
    0x7ff,
    134_217_729.0,
    nalgebra::ComplexField::sqrt,
    crate::scalar::powers::quick_logarithm_f64,
    crate::scalar::powers::quick_power_f64,
    crate::scalar::powers::fine_logarithm_f64,
    crate::scalar::powers::fine_power_f64,
    power(exponent) = pow,
    exponential() = exp,
    exponential_less_one() = expm1,
    logarithm() = log,
    cube_root() = cbrt,
    sine() = sin,
    cosine() = cos,
    tangent() = tan,
    arctangent() = atan,
    arctangent2(x) = atan2,
    arccosine() = acos
);

#[cfg(test)]
mod tests {
    use super::{Real, reciprocal_in_range, splitter_by_epsilon};
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

    #[test]
    fn splitter_is_two_to_half_the_bits_plus_one() {
        assert_eq!(<f32 as Real>::splitter(), splitter_by_epsilon());
        assert_eq!(<f64 as Real>::splitter(), splitter_by_epsilon());
    }

    /// What a type gets that has no powers of two to offer.
    #[test]
    fn the_default_factor_is_the_reciprocal_of_what_has_one() {
        for x in [1.0, -4.0, 0.125, -3e300, 1e-300_f64] {
            assert_eq!(reciprocal_in_range(x), 1.0 / x.abs());
        }
        for x in [0.0, f64::MIN_POSITIVE, -5e-324, f64::MAX, -f64::INFINITY, f64::NAN] {
            assert_eq!(reciprocal_in_range(x), 1.0);
        }
    }

    proptest! {
        #[test]
        fn product_of_narrow_numbers_is_exact_in_two_parts(a in -1e15_f32..1e15, b in -1e15_f32..1e15) {
            let (product, error) = a.two_product(b);
            prop_assert_eq!(f64::from(product) + f64::from(error), f64::from(a) * f64::from(b));
            let (sum, error) = a.two_sum(b);
            prop_assert_eq!(f64::from(sum) + f64::from(error), f64::from(a) + f64::from(b));
        }

        #[test]
        fn product_of_wide_numbers_is_exact_in_two_parts(a in any::<i64>(), b in any::<i64>()) {
            // 53-bit integers, whose products an i128 holds.
            let (a, b) = (a >> 11, b >> 11);
            let (product, error) = (a as f64).two_product(b as f64);
            prop_assert_eq!(product as i128 + error as i128, i128::from(a) * i128::from(b));
        }

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
