//! A number of two doubles, some 31 digits: a hundred times faster than [`dashu_float`], against which it is
//! tested here, and none of our own arithmetic (Dekker 1971; Hida, Li & Bailey 2001).

use core::cmp::Ordering;
use core::ops::{Add, Div, Mul, Neg, Sub};
use std::sync::LazyLock;

#[path = "vectors.rs"]
mod vectors;
pub(crate) use vectors::*;

/// Steps of the table of the exponential function, to one.
const STEPS: f64 = 32.0;

/// Terms of a series that need twice the digits: what follows is less than 1e-17 of the sum.
const TERMS: usize = 7;

/// The reciprocals of 1 to 7.
static INVERSES: LazyLock<[Big; TERMS]> =
    LazyLock::new(|| core::array::from_fn(|k| Big::new(1.0) / Big::new((k + 1) as f64)));

/// `exp(k/32)` of k from 0 to 12: as far as half the logarithm of two.
static EXPONENTIALS: LazyLock<[Big; 13]> = LazyLock::new(|| {
    let half_step = Big::new(1.0) + Big::new(0.5 / STEPS).exp_less_one();
    let mut next = Big::new(1.0);
    core::array::from_fn(|_| {
        let power = next;
        next = power * half_step * half_step;
        power
    })
});

/// The unevaluated sum of two doubles, the second at most half a unit in the last place of the first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Big {
    high: f64,
    low: f64,
}

fn two_sum(a: f64, b: f64) -> Big {
    let high = a + b;
    let rest = high - a;
    Big { high, low: (a - (high - rest)) + (b - rest) }
}

/// Of numbers of which the first is the larger.
fn quick_sum(a: f64, b: f64) -> Big {
    let high = a + b;
    Big { high, low: b - (high - a) }
}

/// Veltkamp's halves of a number.
fn halves(a: f64) -> (f64, f64) {
    let t = 134_217_729.0 * a;
    let high = t - (t - a);
    (high, a - high)
}

fn two_product(a: f64, b: f64) -> Big {
    let high = a * b;
    let ((a1, a2), (b1, b2)) = (halves(a), halves(b));
    Big { high, low: ((a1 * b1 - high) + a1 * b2 + a2 * b1) + a2 * b2 }
}

impl Big {
    pub(crate) const ZERO: Self = Self { high: 0.0, low: 0.0 };

    pub(crate) fn new(x: f64) -> Self {
        Self { high: x, low: 0.0 }
    }

    pub(crate) fn sqrt(&self) -> Self {
        if self.high <= 0.0 {
            return Self::ZERO;
        }
        let root = Self::new(self.high.sqrt());
        let rest = *self - root * root;
        root + rest * Self::new(0.5 / root.high)
    }

    pub(crate) fn powf(&self, exponent: &Self) -> Self {
        if self.high <= 0.0 { Self::ZERO } else { (self.ln() * *exponent).exp() }
    }

    /// By a step of Halley's method from the logarithm of a double, whose error it takes to the third power.
    fn ln(self) -> Self {
        let y = Self::new(self.high.ln());
        let there = y.exp();
        y + Self::new(2.0) * (self - there) / (self + there)
    }

    /// By a table, a Taylor series of what is left, and a power of two.
    fn exp(self) -> Self {
        const LN_2: Big = Big { high: core::f64::consts::LN_2, low: 2.319_046_813_846_299_6e-17 };
        let whole = (self.high / core::f64::consts::LN_2).round();
        let left = self - LN_2 * Self::new(whole);
        let steps = (left.high * STEPS).round();
        let tabled = EXPONENTIALS[steps.abs().min(12.0) as usize];
        let tabled = if steps < 0.0 { Self::new(1.0) / tabled } else { tabled };
        let sum = tabled + tabled * (left - Self::new(steps / STEPS)).exp_less_one();
        let scale = whole.exp2();
        Self { high: sum.high * scale, low: sum.low * scale }
    }

    /// `exp(x) − 1` up to a 64th, by its Taylor series.
    fn exp_less_one(self) -> Self {
        // Of the terms behind the seventh a double has digits enough.
        let tail = (TERMS + 1..=TERMS + 7).rev().fold(0.0, |sum, k| self.high * (1.0 + sum) / k as f64);
        INVERSES.iter().rev().fold(Self::new(tail), |sum, inverse| self * *inverse * (Self::new(1.0) + sum))
    }

    pub(crate) fn abs(&self) -> Self {
        if self.high < 0.0 { -*self } else { *self }
    }

    pub(crate) fn to_f64(self) -> f64 {
        self.high + self.low
    }

    pub(crate) fn is_positive(&self) -> bool {
        self.high > 0.0
    }
}

impl Add for Big {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let (sum, rest) = (two_sum(self.high, other.high), two_sum(self.low, other.low));
        let sum = quick_sum(sum.high, sum.low + rest.high);
        quick_sum(sum.high, sum.low + rest.low)
    }
}

impl Neg for Big {
    type Output = Self;
    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl Sub for Big {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Big {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let product = two_product(self.high, other.high);
        quick_sum(product.high, product.low + (self.high * other.low + self.low * other.high))
    }
}

impl Div for Big {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let first = self.high / other.high;
        let rest = self - other * Self::new(first);
        let second = rest.high / other.high;
        let third = (rest - other * Self::new(second)).high / other.high;
        quick_sum(first, second) + Self::new(third)
    }
}

macro_rules! by_reference {
    ($trait:ident, $method:ident) => {
        impl $trait<&Big> for &Big {
            type Output = Big;
            fn $method(self, other: &Big) -> Big {
                $trait::$method(*self, *other)
            }
        }
    };
}

by_reference!(Add, add);
by_reference!(Sub, sub);
by_reference!(Mul, mul);
by_reference!(Div, div);

impl PartialOrd for Big {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        match self.high.partial_cmp(&other.high) {
            Some(Ordering::Equal) => self.low.partial_cmp(&other.low),
            order => order,
        }
    }
}

#[cfg(test)]
mod tests {
    use dashu_float::FBig;
    use dashu_float::round::mode::HalfEven;
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    use super::Big;

    type Exact = FBig<HalfEven, 2>;

    fn exact(x: Big) -> Exact {
        let part = |x: f64| Exact::try_from(x).unwrap().with_precision(300).value();
        part(x.high) + part(x.low)
    }

    /// Every operation to 30 digits.
    #[test]
    fn two_doubles_agree_with_300_bits() {
        let mut random = Pcg64Mcg::seed_from_u64(31);
        for _ in 0..4000 {
            let mut any = || {
                let high = random.random_range(-3.0..3.0_f64).exp2() * random.random_range(0.5..1.0);
                Big::new(high) + Big::new(high * random.random_range(-1e-17..1e-17))
            };
            let (a, b) = (any(), any());
            let (x, y) = (exact(a), exact(b));
            for (name, ours, theirs) in [
                ("sum", a + b, &x + &y),
                ("difference", a - b, &x - &y),
                ("product", a * b, &x * &y),
                ("quotient", a / b, &x / &y),
                ("root", a.sqrt(), x.sqrt()),
                ("power", a.powf(&b), x.powf(&y)),
            ] {
                let off = (exact(ours) - &theirs).to_f64().value().abs();
                let size = x.to_f64().value().max(theirs.to_f64().value().abs());
                assert!(off <= 1e-30 * size, "{name} {a:?} {b:?}: {off:e}");
            }
        }
    }
}
