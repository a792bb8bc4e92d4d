//! Numbers side by side, on which each operation is one instruction or a few.

use core::array::from_fn;
use core::ops::{Add, Mul, Sub};

use fingertip_wrench::Real;

/// `N` numbers. The compiler turns what is done lane by lane to whole arrays into vector
/// instructions, which it does not reliably do to a loop over the lanes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(16))]
pub(super) struct Lanes<T, const N: usize>(pub(super) [T; N]);

impl<T: Real, const N: usize> Lanes<T, N> {
    #[inline(always)]
    pub(super) fn splat(x: T) -> Self {
        Self([x; N])
    }

    #[inline(always)]
    fn zip<U>(&self, other: &Self, f: impl Fn(T, T) -> U) -> [U; N] {
        from_fn(|k| f(self.0[k], other.0[k]))
    }

    /// The greater of both, or the second if one is NaN.
    #[inline(always)]
    pub(super) fn greater(self, other: Self) -> Self {
        Self(self.zip(&other, |a, b| if a > b { a } else { b }))
    }

    /// The smaller of both, or the second if one is NaN.
    #[inline(always)]
    pub(super) fn smaller(self, other: Self) -> Self {
        Self(self.zip(&other, |a, b| if a < b { a } else { b }))
    }
}

macro_rules! operator {
    ($trait:ident, $method:ident, $op:tt) => {
        impl<T: Real, const N: usize> $trait for Lanes<T, N> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.zip(&other, |a, b| a $op b))
            }
        }
        impl<T: Real, const N: usize> $trait<T> for Lanes<T, N> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: T) -> Self {
                self $op Self::splat(other)
            }
        }
    };
}

operator!(Add, add, +);
operator!(Sub, sub, -);
operator!(Mul, mul, *);
