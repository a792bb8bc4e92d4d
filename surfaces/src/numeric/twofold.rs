//! Numbers of twice the digits, for what cancels.

use fingertip_wrench::Real;
use nalgebra::Vector3;

/// The unevaluated sum of a number and what rounding took from it (Dekker 1971; Joldes, Muller &
/// Popescu 2017): a relative error of about `4·ε²`, without a wider type.
///
/// Not in line: it is for the few places where most digits cancel, which are not on the fast path,
/// and a microcontroller should hold it once.
#[derive(Clone, Copy, Debug)]
pub struct Twofold<T> {
    high: T,
    low: T,
}

impl<T: Real> Twofold<T> {
    #[inline]
    pub fn new(x: T) -> Self {
        Self { high: x, low: T::zero() }
    }

    /// `a − b`, exactly.
    #[inline]
    pub fn difference(a: T, b: T) -> Self {
        let (high, low) = a.two_sum(-b);
        Self { high, low }
    }

    #[inline(never)]
    pub fn plus(self, other: Self) -> Self {
        let (sum, error) = self.high.two_sum(other.high);
        let (high, low) = sum.two_sum(error + (self.low + other.low));
        Self { high, low }
    }

    #[inline(never)]
    pub fn times(self, other: Self) -> Self {
        let (product, error) = self.high.two_product(other.high);
        let (high, low) = product.two_sum(error + (self.high * other.low + self.low * other.high));
        Self { high, low }
    }

    /// The quotient by a number that is not twofold.
    #[inline(never)]
    pub fn over(self, divisor: T) -> Self {
        let quotient = self.high / divisor;
        let (product, error) = quotient.two_product(divisor);
        let (high, low) = quotient.two_sum(((self.high - product) - error + self.low) / divisor);
        Self { high, low }
    }

    /// The quotient by a twofold number.
    pub fn divided_by(self, divisor: Self) -> Self {
        let quotient = self.over(divisor.high);
        // 1/(h + l) = 1/h − l/h², but for the square of what rounding took.
        quotient.minus(quotient.times(Self::new(divisor.low / divisor.high)))
    }

    /// The square root; zero of what is not positive.
    pub fn root(self) -> Self {
        let root = self.value().root();
        if !(root > T::zero()) {
            return Self::new(T::zero());
        }
        let rest = self.minus(Self::new(root).squared()).value() / (root + root);
        Self::difference(root, -rest)
    }

    #[inline]
    pub fn minus(self, other: Self) -> Self {
        self.plus(Self { high: -other.high, low: -other.low })
    }

    #[inline]
    pub fn squared(self) -> Self {
        self.times(self)
    }

    /// Rounded to one number.
    #[inline]
    pub fn value(self) -> T {
        self.high + self.low
    }
}

/// Arithmetic with more digits than a result needs: double precision for what is single, twice that for
/// what is double.
pub trait Wide: Copy {
    /// Whether it has more than those of double precision.
    const BEYOND_DOUBLE: bool;

    fn exactly(x: f64) -> Self;
    fn plus(self, other: Self) -> Self;
    fn minus(self, other: Self) -> Self;
    fn times(self, other: Self) -> Self;
    fn over(self, other: Self) -> Self;
    fn root(self) -> Self;
    /// Of a number that is not negative, for a positive power.
    fn power(self, power: Self) -> Self;
    fn rounded(self) -> f64;
}

impl Wide for f64 {
    const BEYOND_DOUBLE: bool = false;

    #[inline]
    fn exactly(x: f64) -> Self {
        x
    }

    #[inline]
    fn plus(self, other: Self) -> Self {
        self + other
    }

    #[inline]
    fn minus(self, other: Self) -> Self {
        self - other
    }

    #[inline]
    fn times(self, other: Self) -> Self {
        self * other
    }

    #[inline]
    fn over(self, other: Self) -> Self {
        self / other
    }

    #[inline]
    fn root(self) -> Self {
        Real::root(self)
    }

    #[inline]
    fn power(self, power: Self) -> Self {
        Real::power(self, power)
    }

    #[inline]
    fn rounded(self) -> f64 {
        self
    }
}

impl Wide for Twofold<f64> {
    const BEYOND_DOUBLE: bool = true;

    fn exactly(x: f64) -> Self {
        Self::new(x)
    }

    fn plus(self, other: Self) -> Self {
        Self::plus(self, other)
    }

    fn minus(self, other: Self) -> Self {
        Self::minus(self, other)
    }

    fn times(self, other: Self) -> Self {
        Self::times(self, other)
    }

    fn over(self, other: Self) -> Self {
        self.divided_by(other)
    }

    fn root(self) -> Self {
        Self::root(self)
    }

    fn power(self, power: Self) -> Self {
        Self::power(self, power)
    }

    fn rounded(self) -> f64 {
        self.value()
    }
}

/// The same numbers.
#[inline]
pub fn exactly<T: Real>(v: &Vector3<T>) -> [Twofold<T>; 3] {
    [Twofold::new(v.x), Twofold::new(v.y), Twofold::new(v.z)]
}

/// `a − b`, exactly.
#[inline]
pub fn difference<T: Real>(a: &Vector3<T>, b: &Vector3<T>) -> [Twofold<T>; 3] {
    [Twofold::difference(a.x, b.x), Twofold::difference(a.y, b.y), Twofold::difference(a.z, b.z)]
}

/// Scalar product.
#[inline(never)]
pub fn dot<T: Real>([a, b, c]: [Twofold<T>; 3], [x, y, z]: [Twofold<T>; 3]) -> Twofold<T> {
    a.times(x).plus(b.times(y)).plus(c.times(z))
}

/// Scalar product with a vector of ordinary numbers.
#[inline]
pub fn dot_with<T: Real>(a: [Twofold<T>; 3], b: &Vector3<T>) -> Twofold<T> {
    dot(a, exactly(b))
}

/// How far the end of a vector is outside the ball of this radius about its start, to first order:
/// `(|v|² − r²)/2r`.
pub fn outside_ball<T: Real>([x, y, z]: [Twofold<T>; 3], radius: T) -> T {
    // Not by `dot`, which a microcontroller with a sphere would hold for this alone.
    let squared = x.squared().plus(y.squared()).plus(z.squared());
    squared.minus(Twofold::new(radius).squared()).value() / (radius + radius)
}

#[cfg(test)]
mod tests {
    use super::{Twofold, difference, dot};
    use nalgebra::Vector3;
    use proptest::prelude::*;

    proptest! {
        /// Against double precision, which holds what two single ones hold but for four bits.
        #[test]
        fn agrees_with_double_precision(
            a in -8.0_f32..8.0, b in -8.0_f32..8.0, c in 0.5_f32..8.0, d in -8.0_f32..8.0
        ) {
            let wide = |t: Twofold<f32>| f64::from(t.high) + f64::from(t.low);
            let [a64, b64, c64, d64] = [a, b, c, d].map(f64::from);
            let allowed = 16.0 * f64::from(f32::EPSILON).powi(2) * 64.0;
            let sum = Twofold::difference(a, b).plus(Twofold::new(d));
            prop_assert!((wide(sum) - (a64 - b64 + d64)).abs() <= allowed);
            let product = Twofold::difference(a, b).times(Twofold::difference(c, d));
            prop_assert!((wide(product) - (a64 - b64) * (c64 - d64)).abs() <= allowed);
            let quotient = Twofold::difference(a, b).over(c);
            prop_assert!((wide(quotient) - (a64 - b64) / c64).abs() <= allowed);
            let quotient = Twofold::new(a).divided_by(Twofold::difference(c, -9.0));
            prop_assert!((wide(quotient) - a64 / (c64 + 9.0)).abs() <= allowed);
            let v = difference(&Vector3::new(a, b, c), &Vector3::new(d, a, b));
            let exact = (a64 - d64).powi(2) + (b64 - a64).powi(2) + (c64 - b64).powi(2);
            prop_assert!((wide(dot(v, v)) - exact).abs() <= allowed * 8.0);
        }
    }
}
