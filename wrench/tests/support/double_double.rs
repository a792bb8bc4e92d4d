//! Numbers of about 32 digits: pairs of `f64` (Dekker 1971; Hida, Li & Bailey 2001), with the
//! hardware's fused multiply-add, so that nothing is shared with the code under test.

use core::ops::{Add, Div, Mul, Neg, Sub};

use nalgebra::{Matrix6, Vector6};

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DoubleDouble {
    high: f64,
    low: f64,
}

impl DoubleDouble {
    pub const ZERO: Self = Self { high: 0.0, low: 0.0 };

    pub fn to_f64(self) -> f64 {
        self.high + self.low
    }

    fn renormalised(high: f64, low: f64) -> Self {
        let sum = high + low;
        Self { high: sum, low: low - (sum - high) }
    }
}

impl From<f64> for DoubleDouble {
    fn from(high: f64) -> Self {
        Self { high, low: 0.0 }
    }
}

impl Add for DoubleDouble {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let exact = |a: f64, b: f64| {
            let sum = a + b;
            let part = sum - a;
            (sum, (a - (sum - part)) + (b - part))
        };
        let (high, error) = exact(self.high, other.high);
        let (low, low_error) = exact(self.low, other.low);
        let first = Self::renormalised(high, error + low);
        Self::renormalised(first.high, first.low + low_error)
    }
}

impl Neg for DoubleDouble {
    type Output = Self;
    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl Sub for DoubleDouble {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for DoubleDouble {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let high = self.high * other.high;
        let error = self.high.mul_add(other.high, -high);
        Self::renormalised(high, error + (self.high * other.low + self.low * other.high))
    }
}

impl Div for DoubleDouble {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let first = self.high / other.high;
        let rest = self - other * first.into();
        let second = rest.high / other.high;
        let rest = rest - other * second.into();
        Self::renormalised(first, second) + (rest.high / other.high).into()
    }
}

/// `matrix⁻¹ · right` to about 32 digits less those of the condition number.
pub fn solve(matrix: &Matrix6<f64>, right: &Vector6<f64>) -> [DoubleDouble; 6] {
    let mut a = [[DoubleDouble::ZERO; 7]; 6];
    for i in 0..6 {
        for j in 0..6 {
            a[i][j] = matrix[(i, j)].into();
        }
        a[i][6] = right[i].into();
    }
    for k in 0..6 {
        let pivot = (k..6).max_by(|i, j| a[*i][k].high.abs().total_cmp(&a[*j][k].high.abs())).unwrap_or(k);
        a.swap(k, pivot);
        for i in k + 1..6 {
            let factor = a[i][k] / a[k][k];
            for j in k..7 {
                a[i][j] = a[i][j] - factor * a[k][j];
            }
        }
    }
    let mut x = [DoubleDouble::ZERO; 6];
    for i in (0..6).rev() {
        let sum = (i + 1..6).fold(a[i][6], |sum, j| sum - a[i][j] * x[j]);
        x[i] = sum / a[i][i];
    }
    x
}

/// `right − matrix · x`.
pub fn residual(matrix: &Matrix6<f64>, right: &Vector6<f64>, x: &Vector6<f64>) -> Vector6<f64> {
    Vector6::from_fn(|i, _| {
        let start = DoubleDouble::from(right[i]);
        (0..6).fold(start, |sum, j| sum - DoubleDouble::from(matrix[(i, j)]) * x[j].into()).to_f64()
    })
}

/// `found − exact`, of numbers that agree in most digits.
pub fn difference(found: &Vector6<f64>, exact: &[DoubleDouble; 6]) -> Vector6<f64> {
    Vector6::from_fn(|i, _| (DoubleDouble::from(found[i]) - exact[i]).to_f64())
}
