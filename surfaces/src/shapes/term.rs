//! What the formula of an implicit surface is written with.

use core::ops::{Add, Div, Mul, Neg, Sub};

use fingertip_wrench::Real;
use nalgebra::Vector3;

use crate::numeric::range::Range;

/// A term of a formula in x, y and z. It knows which values it takes over a box, or at a point, and how steep it
/// is there along each axis: interval arithmetic with derivatives, carried forward (Moore, Kearfott & Cloud 2009,
/// *Introduction to Interval Analysis*).
///
/// ```
/// use fingertip_surfaces::Term;
///
/// /// A ball with a flat: the common part of two bodies is the larger of their formulas.
/// fn flattened([x, y, z]: [Term<f64>; 3]) -> Term<f64> {
///     let ball = Term::length([x, y, z]) - 0.013;
///     ball.max(z - 0.010)
/// }
///
/// let [low, high] = flattened(Term::at([0.0, 0.0, 0.011])).range();
/// assert!(low == high && (low - 0.001).abs() < 1e-15);
/// let [low, high] = flattened(Term::over([[0.0, 0.002], [0.0, 0.002], [0.009, 0.011]])).range();
/// assert!(low < 0.0 && 0.0 < high);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Term<T: Real> {
    value: Range<T>,
    slopes: [Range<T>; 3],
}

impl<T: Real> Term<T> {
    /// A number that does not depend on the place.
    #[must_use]
    pub fn constant(value: T) -> Self {
        Self { value: Range::at(value), slopes: [Range::at(T::zero()); 3] }
    }

    /// x, y and z at a point \[m\].
    #[must_use]
    pub fn at(point: [T; 3]) -> [Self; 3] {
        Self::over(point.map(|x| [x, x]))
    }

    /// x, y and z over a box, given by its least and greatest coordinates \[m\].
    #[must_use]
    pub fn over(bounds: [[T; 2]; 3]) -> [Self; 3] {
        let slopes = |axis: usize| [0, 1, 2].map(|k| Range::at(if k == axis { T::one() } else { T::zero() }));
        let [x, y, z] = bounds.map(|[low, high]| Range::between(low, high));
        [(x, 0), (y, 1), (z, 2)].map(|(value, axis)| Self { value, slopes: slopes(axis) })
    }

    /// The least and the greatest value: no value lies outside, but some within may not be taken.
    #[must_use]
    pub fn range(&self) -> [T; 2] {
        [self.value.low, self.value.high]
    }

    /// A function of this term that is not among those below, from the range of the function and that of its
    /// derivative over [`range`](Self::range).
    #[must_use]
    pub fn through(self, value: [T; 2], derivative: [T; 2]) -> Self {
        let [value, derivative] = [value, derivative].map(|[low, high]| Range::between(low, high));
        self.chain(value, derivative)
    }

    fn chain(self, value: Range<T>, derivative: Range<T>) -> Self {
        Self { value, slopes: self.slopes.map(|slope| slope * derivative) }
    }

    /// Its square, which is not negative; tighter than the product with itself.
    #[must_use]
    pub fn square(self) -> Self {
        self.chain(self.value.square(), self.value + self.value)
    }

    /// A whole power.
    #[must_use]
    pub fn powi(self, exponent: i32) -> Self {
        if exponent == 0 {
            return Self::constant(T::one());
        }
        let factor = T::literal(f64::from(exponent));
        self.chain(self.value.whole_power(exponent), self.value.whole_power(exponent - 1) * Range::at(factor))
    }

    /// The length of a vector: the root of the sum of squares, whose slope is known where it is zero, too.
    #[must_use]
    pub fn length<const N: usize>(vector: [Self; N]) -> Self {
        let mut sum = Self::constant(T::zero());
        for component in vector {
            sum = sum + component.square();
        }
        let value = sum.value.sqrt();
        let mut slopes = [Range::at(T::zero()); 3];
        for component in vector {
            // Of a unit vector.
            let share = (component.value * value.reciprocal()).within_one();
            for (slope, of_component) in slopes.iter_mut().zip(component.slopes) {
                *slope = *slope + share * of_component;
            }
        }
        Self { value, slopes }
    }

    /// Square root. Over a box where the term may be zero or negative its slope has no bound: see
    /// [`length`](Self::length).
    #[must_use]
    pub fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, (root + root).reciprocal())
    }

    /// Magnitude.
    #[must_use]
    pub fn abs(self) -> Self {
        Self::length([self])
    }

    /// The exponential.
    #[must_use]
    pub fn exp(self) -> Self {
        let value = Range::between(self.value.low.exponential(), self.value.high.exponential());
        self.chain(value, value)
    }

    /// Sine of an angle \[rad\].
    #[must_use]
    pub fn sin(self) -> Self {
        self.chain(self.value.sine(), self.value.cosine())
    }

    /// Cosine of an angle \[rad\].
    #[must_use]
    pub fn cos(self) -> Self {
        self.chain(self.value.cosine(), -self.value.sine())
    }

    /// The larger of two: of formulas that are negative inside, the common part of both bodies.
    #[must_use]
    pub fn max(self, other: Self) -> Self {
        if self.value.low >= other.value.high {
            return self;
        }
        if other.value.low > self.value.high {
            return other;
        }
        let [a, b, c] = self.slopes;
        let [x, y, z] = other.slopes;
        Self { value: self.value.larger(other.value), slopes: [a.hull(x), b.hull(y), c.hull(z)] }
    }

    /// The smaller of two: of formulas that are negative inside, the union of both bodies.
    #[must_use]
    pub fn min(self, other: Self) -> Self {
        -(-self).max(-other)
    }

    /// The value at a point, or the middle of the range.
    pub(crate) fn value(&self) -> T {
        self.value.middle()
    }

    /// The gradient at a point, or the middle of its range.
    pub(crate) fn gradient(&self) -> Vector3<T> {
        Vector3::from(self.slopes.map(|slope| slope.middle()))
    }

    /// For each axis, how steep the term may be.
    pub(crate) fn steepest(&self) -> Vector3<T> {
        Vector3::from(self.slopes.map(|slope| slope.low.abs().max(slope.high.abs())))
    }
}

impl<T: Real> Neg for Term<T> {
    type Output = Self;

    fn neg(self) -> Self {
        Self { value: -self.value, slopes: self.slopes.map(Neg::neg) }
    }
}

impl<T: Real> Add for Term<T> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let [a, b, c] = self.slopes;
        let [x, y, z] = other.slopes;
        Self { value: self.value + other.value, slopes: [a + x, b + y, c + z] }
    }
}

impl<T: Real> Sub for Term<T> {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl<T: Real> Mul for Term<T> {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let (u, v) = (self.value, other.value);
        let [a, b, c] = self.slopes;
        let [x, y, z] = other.slopes;
        Self { value: u * v, slopes: [a * v + x * u, b * v + y * u, c * v + z * u] }
    }
}

impl<T: Real> Div for Term<T> {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        self * other.powi(-1)
    }
}

macro_rules! with_a_number {
    ($($operator:ident, $method:ident, |$term:ident, $number:ident| $answer:expr;)+) => {
        $(impl<T: Real> $operator<T> for Term<T> {
            type Output = Self;

            fn $method(self, $number: T) -> Self {
                let $term = self;
                $answer
            }
        })+
    };
}

with_a_number! {
    Add, add, |term, number| Self { value: term.value + Range::at(number), ..term };
    Sub, sub, |term, number| Self { value: term.value + Range::at(-number), ..term };
    Mul, mul, |term, number| term.chain(term.value * Range::at(number), Range::at(number));
    Div, div, |term, number| Self {
        value: term.value.over(number),
        slopes: term.slopes.map(|slope| slope.over(number)),
    };
}

macro_rules! number_first {
    ($($number:ident: $($operator:ident, $method:ident);+.)+) => {
        $($(impl $operator<Term<$number>> for $number {
            type Output = Term<$number>;

            fn $method(self, term: Term<$number>) -> Term<$number> {
                Term::constant(self).$method(term)
            }
        })+)+
    };
}

number_first! {
    f32: Add, add; Sub, sub; Mul, mul; Div, div.
    f64: Add, add; Sub, sub; Mul, mul; Div, div.
}
