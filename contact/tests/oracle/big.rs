//! A number of 220 bits, by `dashu-float`: none of our own arithmetic.

use core::ops::{Add, Div, Mul, Neg, Sub};

use dashu_float::FBig;
use dashu_float::round::mode::HalfEven;

#[path = "vectors.rs"]
mod vectors;
pub(crate) use vectors::*;

type Inner = FBig<HalfEven, 2>;

#[derive(Clone, Debug, PartialEq, PartialOrd)]
pub(crate) struct Big(Inner);

impl Big {
    pub(crate) fn new(x: f64) -> Self {
        Self(Inner::try_from(x).unwrap().with_precision(220).value())
    }

    pub(crate) fn sqrt(&self) -> Self {
        if self.0 == Inner::ZERO { self.clone() } else { Self(self.0.sqrt()) }
    }

    pub(crate) fn powf(&self, exponent: &Self) -> Self {
        if self.0 == Inner::ZERO { self.clone() } else { Self(self.0.powf(&exponent.0)) }
    }

    pub(crate) fn abs(&self) -> Self {
        if self.0 < Inner::ZERO { -self.clone() } else { self.clone() }
    }

    pub(crate) fn to_f64(&self) -> f64 {
        self.0.to_f64().value()
    }

    pub(crate) fn is_positive(&self) -> bool {
        self.0 > Inner::ZERO
    }
}

macro_rules! operator {
    ($trait:ident, $method:ident) => {
        impl $trait for Big {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                Self($trait::$method(self.0, other.0))
            }
        }
        impl<'a> $trait<&'a Big> for &Big {
            type Output = Big;
            fn $method(self, other: &'a Big) -> Big {
                Big($trait::$method(&self.0, &other.0))
            }
        }
    };
}

operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);

impl Neg for Big {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}
