//! Covariances in a plane.

use fingertip_surfaces::numeric::vectors::{larger, smaller};
use fingertip_wrench::Real;
use nalgebra::{Matrix2, Vector2};

/// A symmetric matrix of a plane, by its three numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Symmetric<T> {
    pub(super) xx: T,
    pub(super) xy: T,
    pub(super) yy: T,
}

impl<T: Real> Symmetric<T> {
    #[inline(always)]
    pub(super) const fn new([xx, xy, yy]: [T; 3]) -> Self {
        Self { xx, xy, yy }
    }

    #[inline(always)]
    pub(super) fn scaled(&self, by: T) -> Self {
        Self { xx: self.xx * by, xy: self.xy * by, yy: self.yy * by }
    }

    #[inline(always)]
    pub(super) fn matrix(&self) -> Matrix2<T> {
        Matrix2::new(self.xx, self.xy, self.xy, self.yy)
    }

    #[inline(always)]
    pub(super) fn times(&self, v: &Vector2<T>) -> Vector2<T> {
        Vector2::new(self.xx * v.x + self.xy * v.y, self.xy * v.x + self.yy * v.y)
    }

    /// `C M Cᵀ` for the rotation `C = [c, −s; s, c]`: as the axes see it from which the first axis of this one is at
    /// `(c, s)`.
    #[inline(always)]
    pub(super) fn turned(&self, first: &Vector2<T>) -> Self {
        let (c, s) = (first.x, first.y);
        let (cosine, sine, both) = (c * c, s * s, c * s);
        let twice = (both + both) * self.xy;
        Self {
            xx: cosine * self.xx + sine * self.yy - twice,
            xy: both * (self.xx - self.yy) + (cosine - sine) * self.xy,
            yy: sine * self.xx + cosine * self.yy + twice,
        }
    }

    #[inline(always)]
    pub(super) fn trace(&self) -> T {
        self.xx + self.yy
    }

    #[inline(always)]
    pub(super) fn sum(&self) -> T {
        self.xx + self.xy + self.yy
    }

    /// Whether variances are positive, and no direction has a negative one.
    #[inline(always)]
    pub(super) fn is_covariance(&self) -> bool {
        self.xx > T::zero() && self.yy > T::zero() && self.xy * self.xy <= self.xx * self.yy
    }

    /// [`is_covariance`](Self::is_covariance) with variance in every direction, for less.
    #[inline(always)]
    pub(super) fn is_definite(&self) -> bool {
        self.xx > T::zero() && self.xy * self.xy < self.xx * self.yy
    }

    /// Such that its variances are no less than this, and no direction has a negative one: where noise in one direction
    /// is beyond compare with that in the other, rounding may leave neither.
    #[inline(always)]
    pub(super) fn at_least(self, [x, y]: [T; 2]) -> Self {
        let (xx, yy) = (larger(self.xx, x), larger(self.yy, y));
        let most = xx.root() * yy.root();
        Self { xx, xy: larger(-most, smaller(self.xy, most)), yy }
    }
}

#[cfg(test)]
mod tests {
    use super::Symmetric;
    use nalgebra::{Matrix2, Rotation2, Vector2};
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn turns_as_a_matrix_does(xx in 0.1..2.0, xy in -1.0..1.0, yy in 0.1..2.0, angle in -4.0..4.0_f64) {
            let m = Matrix2::new(xx, xy, xy, yy);
            let c = Rotation2::<f64>::new(angle);
            let expected = c.matrix() * m * c.matrix().transpose();
            let turned = Symmetric { xx, xy, yy }.turned(&Vector2::new(angle.cos(), angle.sin()));
            prop_assert!((turned.matrix() - expected).norm() < 1e-14);
            prop_assert!((turned.trace() - (xx + yy)).abs() < 1e-14);
        }

        #[test]
        fn mended_ones_have_no_negative_direction(xx in -1.0..1.0, xy in -1.0..1.0, yy in -1.0..1.0) {
            let mended = Symmetric::<f64> { xx, xy, yy }.at_least([0.01, 0.02]);
            prop_assert!(mended.xx >= 0.01 && mended.yy >= 0.02);
            prop_assert!(mended.matrix().symmetric_eigenvalues().min() > -1e-15);
            prop_assert!(mended.is_covariance() || mended.xy * mended.xy < mended.xx * mended.yy * (1.0 + 1e-15));
            let given = Symmetric { xx, xy, yy };
            prop_assert_eq!(given.is_covariance(), given.matrix().symmetric_eigenvalues().min() >= 0.0);
            if xx >= 0.01 && yy >= 0.02 && given.is_covariance() {
                prop_assert_eq!(mended, given);
            }
        }
    }

    /// A measurement without noise leaves nothing along it: then rounding has the last word, and it is to be mended.
    #[test]
    fn without_variance_along_an_axis_it_is_none() {
        assert!(!Symmetric { xx: 0.0, xy: 0.0, yy: 1.0 }.is_covariance());
        assert!(!Symmetric { xx: 1.0, xy: 0.0, yy: 0.0 }.is_covariance());
        assert!(!Symmetric { xx: 0.0, xy: 0.0, yy: 1.0 }.is_definite());
        assert!(!Symmetric { xx: 1.0, xy: 0.0, yy: 0.0 }.is_definite());
    }
}
