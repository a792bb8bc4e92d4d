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

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::Random;

    /// The numbers that the algorithm's authors give for this seed.
    #[test]
    fn the_stream_is_that_of_splitmix() {
        let mut random = Random::new(1_234_567);
        for expected in [
            6_457_827_717_110_365_317,
            3_203_168_211_198_807_973,
            9_817_491_932_198_370_423,
            4_593_380_528_125_082_431,
            16_408_922_859_458_223_821,
        ] {
            assert_eq!(random.bits(), expected);
        }
    }

    /// The moments of uniform distributions, to five of their own deviations.
    #[test]
    fn numbers_fill_their_range_evenly() {
        let mut random = Random::new(5);
        let count = 100_000;
        let (mut sum, mut squares, mut balls, mut ways) = (0.0, 0.0, 0.0, Vector3::zeros());
        for _ in 0..count {
            let x: f64 = random.symmetric();
            assert!((-1.0..1.0).contains(&x));
            sum += x;
            squares += x * x;
            let inside: Vector3<f64> = random.in_ball();
            assert!(inside.norm() <= 1.0);
            balls += inside.norm_squared();
            let direction: Vector3<f64> = random.direction();
            assert!((direction.norm() - 1.0).abs() < 1e-15);
            ways += direction.component_mul(&direction);
        }
        let within = |sum: f64, mean: f64, deviation: f64| {
            let n = f64::from(count);
            (sum / n - mean).abs() < 5.0 * deviation / n.sqrt()
        };
        assert!(
            within(sum, 0.0, 3.0_f64.sqrt().recip()) && within(squares, 1.0 / 3.0, 0.3),
            "{sum} {squares}"
        );
        // Of |v|² = u^(2/3): 3/5, and 3/7 − 9/25 is the variance.
        assert!(within(balls, 0.6, 0.263), "{balls}");
        assert!(ways.iter().all(|way| within(*way, 1.0 / 3.0, 0.3)), "{ways}");
    }

    /// Lines pass the centre within 1.2 radii along each of two directions, start within three radii of there,
    /// and go to those limits.
    #[test]
    fn lines_go_by_a_ball() {
        let mut random = Random::new(6);
        let centre = Vector3::new(5.0, -7.0, 3.0);
        let (mut farthest, mut longest) = (0.0_f64, 0.0_f64);
        for _ in 0..2000 {
            let line = random.line(&centre, 2.0);
            let away: Vector3<f64> = line.point - centre;
            let slide = away.dot(&line.direction);
            let offset = (away - line.direction * slide).norm();
            assert!((line.direction.norm() - 1.0).abs() < 1e-15);
            assert!(slide.abs() <= 6.0 && offset <= 2.4 * 2.0_f64.sqrt(), "{slide} {offset}");
            (farthest, longest) = (farthest.max(offset), longest.max(slide.abs()));
        }
        assert!(farthest > 3.0 && longest > 5.9, "{farthest} {longest}");
    }
}
