//! Powers of numbers of twice the digits.

use core::f64::consts::LN_2;

use fingertip_wrench::Real;
use nalgebra::ComplexField;

use super::twofold::Twofold;

type Double = Twofold<f64>;

/// What rounding took from `ln 2`.
const LN_2_REST: f64 = 2.319_046_813_846_299_6e-17;

/// Halvings of the exponent, and terms of the series that follow the first: `(ln 2/32)^14/14!` is less than a unit in
/// the last place of twice the digits.
const HALVINGS: i32 = 4;
const TERMS: u32 = 13;

/// Beyond these powers of two a result is zero, or not finite, for what powers of lengths' ratios need.
const LARGEST: f64 = 1000.0;

impl Double {
    /// `e^x`; zero below 2⁻¹⁰⁰⁰.
    ///
    /// `x = k ln 2 + 16 r`, and `e^r − 1` by its series from the last term to the first, which squared four times gives
    /// `e^{16 r} − 1`: without the one, lest it takes the digits.
    pub(crate) fn exponential(self) -> Self {
        let whole = ComplexField::round(self.value() / LN_2);
        if whole.abs() > LARGEST {
            return Self::new(if whole > 0.0 { f64::INFINITY } else { 0.0 });
        }
        let turns = Self::difference(LN_2, -LN_2_REST).times(Self::new(whole));
        let mut small = self.minus(turns);
        for _ in 0..HALVINGS {
            small = small.times(Self::new(0.5));
        }
        let one = Self::new(1.0);
        let mut series = one;
        for k in (2..=TERMS).rev() {
            series = one.plus(series.times(small).over(f64::from(k)));
        }
        let mut less_one = series.times(small);
        for _ in 0..HALVINGS {
            less_one = less_one.plus(less_one).plus(less_one.squared());
        }
        less_one.plus(one).times(Self::new(power_of_two(whole)))
    }

    /// The natural logarithm of a positive number: that of its first digits, `y`, and `2 artanh z`, with
    /// `z = (x − e^y)/(x + e^y)`, of which the cube is nothing.
    pub(crate) fn logarithm(self) -> Self {
        let first = Real::logarithm(self.value());
        let there = Self::new(first).exponential();
        let rest = self.minus(there).divided_by(self.plus(there));
        Self::new(first).plus(rest.plus(rest))
    }

    /// `x^p` of a number that is not negative, for a positive `p`.
    pub fn power(self, power: Self) -> Self {
        if self.value() > 0.0 { self.logarithm().times(power).exponential() } else { Self::new(0.0) }
    }
}

/// `2^k`, `k` being a whole number of a size below [`LARGEST`].
fn power_of_two(k: f64) -> f64 {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 23 and 2023")]
    let exponent = (k + 1023.0) as u64;
    f64::from_bits(exponent << 52)
}

#[cfg(test)]
mod tests {
    use dashu_float::FBig;
    use dashu_float::round::mode::HalfEven;
    use proptest::prelude::*;

    use super::Double;

    type Exact = FBig<HalfEven, 2>;

    fn exact(x: f64) -> Exact {
        Exact::try_from(x).unwrap().with_precision(300).value()
    }

    /// What is left of a value of 300 bits when a number of twice the digits is taken off, relative to it.
    fn off(found: Double, truth: &Exact) -> f64 {
        let first = found.value();
        let second = found.minus(Double::new(first)).value();
        let rest = truth - exact(first) - exact(second);
        (rest / truth).to_f64().value().abs()
    }

    proptest! {
        #[test]
        fn powers_have_thirty_digits(x in 1e-6_f64..1.0, rest in -1e-17_f64..1e-17, p in 0.02_f64..40.0) {
            let base = Double::difference(x, -x * rest);
            let truth = (exact(x) + exact(x * rest)).powf(&exact(p));
            prop_assert!(off(base.power(Double::new(p)), &truth) < 3e-29);
        }

        #[test]
        fn exponentials_and_logarithms_have_thirty_digits(x in -40.0_f64..40.0, y in 1e-9_f64..1e9) {
            prop_assert!(off(Double::new(x).exponential(), &exact(x).exp()) < 1e-30);
            let truth = exact(y).ln();
            // Of a number near 1 the logarithm is known as well as the number.
            let near_one = (y - 1.0).abs() < 1e-3;
            prop_assert!(near_one || off(Double::new(y).logarithm(), &truth) < 1e-28);
        }
    }

    #[test]
    fn ends_of_the_range() {
        let p = Double::new(1.5);
        assert_eq!(Double::new(0.0).power(p).value(), 0.0);
        assert_eq!(Double::new(1.0).power(p).value(), 1.0);
        assert_eq!(Double::new(1e-300).power(Double::new(40.0)).value(), 0.0);
        assert!((Double::new(1e-200).power(p).value() / 1e-300 - 1.0).abs() < 1e-12);
        assert!(Double::new(f64::MIN_POSITIVE * 1e-10).power(Double::new(0.5)).value() > 0.0);
        assert!(!(Double::new(f64::NAN).power(p).value() > 0.0));
        assert_eq!(Double::new(-1.0).power(p).value(), 0.0);
        // Beyond a thousand powers of two.
        for x in [1001.0 * core::f64::consts::LN_2, 1e5, 1e300] {
            assert_eq!(Double::new(-x).exponential().value(), 0.0, "{x}");
            assert_eq!(Double::new(x).exponential().value(), f64::INFINITY, "{x}");
        }
    }
}
