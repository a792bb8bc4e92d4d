//! Lines to try a shape with.

use fingertip_wrench::{Line, Real};
use nalgebra::{Rotation3, Unit, Vector3};

use crate::numeric::vectors::{any_perpendicular, unit_or};

/// A reproducible stream of numbers (SplitMix64).
pub(super) struct Random(u64);

impl Random {
    pub(super) const fn new(seed: u64) -> Self {
        Self(seed)
    }

    pub(super) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Between −1 and 1.
    #[allow(clippy::cast_precision_loss)]
    pub(super) fn symmetric<T: Real>(&mut self) -> T {
        T::literal((self.bits() >> 11) as f64 * (2.0 / 9_007_199_254_740_992.0) - 1.0)
    }

    /// Within the unit ball.
    pub(super) fn in_ball<T: Real>(&mut self) -> Vector3<T> {
        for _ in 0..100 {
            let v = Vector3::new(self.symmetric(), self.symmetric(), self.symmetric());
            if v.norm_squared() <= T::one() {
                return v;
            }
        }
        Vector3::zeros()
    }

    pub(super) fn direction<T: Real>(&mut self) -> Vector3<T> {
        let v = self.in_ball();
        let unit = unit_or(&v, Vector3::z);
        unit_or(&unit, Vector3::z)
    }

    pub(super) fn rotation<T: Real>(&mut self) -> Rotation3<T> {
        let axis = Unit::new_unchecked(self.direction());
        Rotation3::from_axis_angle(&axis, self.symmetric::<T>() * T::pi())
    }

    /// A line near a ball, counted from a point within three radii of it.
    pub(super) fn line<T: Real>(&mut self, centre: &Vector3<T>, radius: T) -> Line<T> {
        let direction = self.direction();
        let across = any_perpendicular(&direction);
        let other = direction.cross(&across);
        let reach = radius * T::literal(1.2);
        let offset = across * (self.symmetric::<T>() * reach) + other * (self.symmetric::<T>() * reach);
        let slide = direction * (self.symmetric::<T>() * radius * T::literal(3.0));
        Line { point: centre + offset + slide, direction }
    }
}
