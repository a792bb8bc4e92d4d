//! Intervals.

use core::ops::{Add, Mul, Neg};

use fingertip_wrench::Real;

/// All numbers from `low` to `high`. Bounds are rounded to nearest, not outward: whoever relies on them leaves room
/// for that.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Range<T: Real> {
    pub(crate) low: T,
    pub(crate) high: T,
}

impl<T: Real> Range<T> {
    pub(crate) fn at(value: T) -> Self {
        Self { low: value, high: value }
    }

    /// From one number to another; every number if one of them is none.
    pub(crate) fn between(a: T, b: T) -> Self {
        if a <= b {
            Self { low: a, high: b }
        } else if b < a {
            Self { low: b, high: a }
        } else {
            let infinity = T::GREATEST * T::GREATEST;
            Self { low: -infinity, high: infinity }
        }
    }

    pub(crate) fn middle(self) -> T {
        if self.low == self.high { self.low } else { (self.low + self.high) * T::literal(0.5) }
    }

    pub(crate) fn hull(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// All numbers that are the larger of one of each.
    pub(crate) fn larger(self, other: Self) -> Self {
        Self { low: self.low.max(other.low), high: self.high.max(other.high) }
    }

    fn contains_zero(self) -> bool {
        !(self.low > T::zero() || self.high < T::zero())
    }

    /// Divided by a number.
    pub(crate) fn over(self, divisor: T) -> Self {
        Self::between(self.low / divisor, self.high / divisor)
    }

    pub(crate) fn reciprocal(self) -> Self {
        if self.contains_zero() {
            // Not a number: everything.
            return Self::between(T::zero() / T::zero(), T::zero());
        }
        Self::between(T::one() / self.low, T::one() / self.high)
    }

    pub(crate) fn whole_power(self, exponent: i32) -> Self {
        if exponent < 0 {
            return self.whole_power(-exponent).reciprocal();
        }
        let ends = Self::between(self.low.whole_power(exponent), self.high.whole_power(exponent));
        if exponent > 0 && exponent % 2 == 0 { self.turned_at_zero(ends) } else { ends }
    }

    /// The power to two, by one product for each end.
    pub(crate) fn square(self) -> Self {
        self.turned_at_zero(Self::between(self.low * self.low, self.high * self.high))
    }

    /// Of an even function that is least at zero, and zero there: from its values at both ends, those in between too.
    fn turned_at_zero(self, ends: Self) -> Self {
        if self.contains_zero() { Self { low: ends.low.min(T::zero()), ..ends } } else { ends }
    }

    /// Those that are neither above one nor below minus one.
    pub(crate) fn within_one(self) -> Self {
        let clip = |x: T| x.max(-T::one()).min(T::one());
        Self { low: clip(self.low), high: clip(self.high) }
    }

    pub(crate) fn sqrt(self) -> Self {
        Self::between(self.low.sqrt(), self.high.sqrt())
    }

    pub(crate) fn cosine(self) -> Self {
        let quarter = Self::at(T::frac_pi_2());
        (self + quarter).sine()
    }

    pub(crate) fn sine(self) -> Self {
        let ends = Self::between(self.low.sine(), self.high.sine());
        if self.low == self.high {
            return ends;
        }
        // So that rounding of an angle hides no turning point.
        let hair = (self.low.abs() + self.high.abs()) * T::EPSILON * T::literal(4.0);
        let [low, high] = [self.low - hair, self.high + hair];
        // Whether one of the angles `first + 2πk` lies within.
        let passes = |first: T| {
            let turns = |angle: T| (angle - first) / T::two_pi();
            !(turns(low).ceil() > turns(high).floor())
        };
        Self {
            low: if passes(-T::frac_pi_2()) { -T::one() } else { ends.low },
            high: if passes(T::frac_pi_2()) { T::one() } else { ends.high },
        }
    }
}

impl<T: Real> Neg for Range<T> {
    type Output = Self;

    fn neg(self) -> Self {
        Self { low: -self.high, high: -self.low }
    }
}

impl<T: Real> Add for Range<T> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self::between(self.low + other.low, self.high + other.high)
    }
}

impl<T: Real> Mul for Range<T> {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let of = |end: T| Self::between(end * other.low, end * other.high);
        let low = of(self.low);
        // Most are of one number: of formulas at points.
        if self.low == self.high { low } else { low.hull(of(self.high)) }
    }
}
