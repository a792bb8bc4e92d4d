//! Readings that go on changing under a load that does not: creep, and the hysteresis that comes of it.

use nalgebra::SVector;
use thiserror::Error;

use crate::Real;
use crate::numeric::decay;

/// Takes creep off the signals of `N` gauges: what `K` standard linear solids (Zener 1948) in backing, glue and body of the
/// sensor add to a load as time goes by, and give back when it is gone.
///
/// Under a load that stays, the signal of a gauge goes on rising by some thousandths or hundredths, exponentially in time;
/// the same makes its curve over a load cycle a loop. What the load alone would give is the signal less a share of each of
/// `K` averages of the signal over the past, which forget exponentially:
/// `s = y − Σ bₖ wₖ`, `τₖ ẇₖ = y − wₖ` (`docs/theory/wrench.md#creep`). Between two samples the signal is taken as a straight
/// line, for which a step is exact by `e^{−h/τ}`: it is stable at any time step, of whatever length.
///
/// It begins settled, without load. Signals are readings whose zero has been taken off. Loops that do not depend on how quickly
/// a load cycle is passed through (friction in joints, magnetism) are none of its kind, and stay.
///
/// ```
/// use fingertip_wrench::CreepCompensation;
/// use nalgebra::{SVector, Vector2};
///
/// // Within some 30 s, the first gauge creeps by a share of 0.02/0.98, the second not.
/// let mut creep = CreepCompensation::<f64, 2, 1>::new([30.0], [Vector2::new(0.02, 0.0)])?;
/// let at_once = creep.follow(&Vector2::new(0.98, 1.0), 0.0).unwrap();
/// assert!((at_once - Vector2::new(0.98, 1.0)).amax() < 1e-15);
/// let mut last = at_once;
/// for _ in 0..600 {
///     last = creep.follow(&Vector2::new(1.0, 1.0), 1.0).unwrap();
/// }
/// // The load was the same all the time.
/// assert!((last - at_once).amax() < 1e-6);
/// # Ok::<(), fingertip_wrench::BadCreep>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CreepCompensation<T: Real, const N: usize, const K: usize> {
    times: [T; K],
    shares: [SVector<T, N>; K],
    /// What all averages would leave of a signal that stays for ever.
    left: SVector<T, N>,
    /// Whether any signals were taken.
    has_begun: bool,
    /// The last signal, and by how much each average is above it.
    last: SVector<T, N>,
    above: [SVector<T, N>; K],
    /// Time of samples that were passed over \[s\].
    missed: T,
}

/// Why numbers are not those of a creep that can be taken off.
///
/// ```
/// use fingertip_wrench::{BadCreep, CreepCompensation};
/// use nalgebra::Vector2;
///
/// // Both averages together take all of the second gauge's signal.
/// let shares = [Vector2::new(0.01, 0.5), Vector2::new(0.01, 0.5)];
/// let refused = CreepCompensation::<f64, 2, 2>::new([1.0, 30.0], shares).unwrap_err();
/// assert_eq!(refused, BadCreep::NothingLeft);
/// let told = "the shares of creep of a gauge are 1 or more in all: nothing is left of a load that stays";
/// assert_eq!(refused.to_string(), told);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum BadCreep {
    /// A time is not positive and finite.
    #[error("a time of creep is not a positive, finite number of seconds")]
    Time,
    /// A share is not finite.
    #[error("a share of creep is not finite")]
    Share,
    /// The shares of a gauge take all of its signal, or more.
    #[error("the shares of creep of a gauge are 1 or more in all: nothing is left of a load that stays")]
    NothingLeft,
}

impl<T: Real, const N: usize, const K: usize> CreepCompensation<T, N, K> {
    /// From the times \[s\] and, for each, the share that it takes off the signal of each gauge. A share below 0 adds.
    ///
    /// # Errors
    /// [`BadCreep`].
    pub fn new(times: [T; K], shares: [SVector<T, N>; K]) -> Result<Self, BadCreep> {
        // Its reciprocal must be a number, too.
        if !times.iter().all(|time| *time >= T::LEAST_NORMAL && time.is_number()) {
            return Err(BadCreep::Time);
        }
        if !shares.iter().flatten().all(|share| share.is_number()) {
            return Err(BadCreep::Share);
        }
        let left = shares.iter().fold(SVector::repeat(T::one()), |left, share| left - share);
        if !left.iter().all(|left| *left > T::zero() && left.is_number()) {
            return Err(BadCreep::NothingLeft);
        }
        let zero = SVector::zeros();
        Ok(Self { times, shares, left, has_begun: false, last: zero, above: [zero; K], missed: T::zero() })
    }

    /// The times \[s\].
    #[must_use]
    pub const fn times(&self) -> &[T; K] {
        &self.times
    }

    /// For each time, the share that it takes off the signal of each gauge.
    #[must_use]
    pub const fn shares(&self) -> &[SVector<T, N>; K] {
        &self.shares
    }

    /// The next signals, `time_step` seconds after the ones before (one that is not positive counts as 0; of the first ones
    /// it does not matter): without creep.
    /// `None` for signals that are not finite, which are passed over while their time counts for the next, or so large that
    /// what is left is no number, behind which it is settled without load.
    #[inline]
    pub fn follow(&mut self, signals: &SVector<T, N>, time_step: T) -> Option<SVector<T, N>> {
        let counts = self.has_begun && time_step > T::zero();
        let step = self.missed + if counts { time_step } else { T::zero() };
        if !signals.iter().all(|signal| signal.is_number()) {
            self.missed = step;
            return None;
        }
        self.missed = T::zero();
        let rise = signals - self.last;
        let mut without = signals.component_mul(&self.left);
        for ((time, share), above) in self.times.iter().zip(&self.shares).zip(&mut self.above) {
            let (left, mean) = decay(step / *time);
            *above = *above * left - rise * mean;
            without -= above.component_mul(share);
        }
        (self.last, self.has_begun) = (*signals, true);
        let is_sound = |vector: &SVector<T, N>| vector.iter().all(|x| x.is_number());
        if is_sound(&without) && self.above.iter().all(is_sound) {
            return Some(without);
        }
        self.start_anew();
        None
    }

    /// The sensor is settled, without load: as behind a new zero.
    pub fn start_anew(&mut self) {
        (self.last, self.above) = (SVector::zeros(), [SVector::zeros(); K]);
        (self.missed, self.has_begun) = (T::zero(), false);
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector1;

    use super::*;

    /// The creep of standard linear solids by another way: `y = s + Σ aⱼ zⱼ`, `θⱼ żⱼ = s − zⱼ`, by Runge and Kutta's rule in
    /// small steps. One solid of share `a` and time `θ` is taken off with `τ = θ/(1 + a)` and `b = a/(1 + a)`.
    fn of_one_solid(load: impl Fn(f64) -> f64, share: f64, time: f64, step: f64, count: usize) -> Vec<f64> {
        let fine = 64;
        let h = step / f64::from(fine);
        let mut state = 0.0;
        let mut signals = vec![load(0.0)];
        for k in 1..count {
            for i in 0..fine {
                let t = step * (k - 1) as f64 + h * f64::from(i);
                let rate = |t: f64, z: f64| (load(t) - z) / time;
                let first = rate(t, state);
                let second = rate(t + 0.5 * h, state + 0.5 * h * first);
                let third = rate(t + 0.5 * h, state + 0.5 * h * second);
                let fourth = rate(t + h, state + h * third);
                state += h / 6.0 * (first + 2.0 * second + 2.0 * third + fourth);
            }
            signals.push(load(step * k as f64) + share * state);
        }
        signals
    }

    fn load(time: f64) -> f64 {
        // Starts at zero, rises, holds, falls below, and swings.
        (time / 3.0).min(1.0) - 1.5 * ((time - 20.0) / 4.0).clamp(0.0, 1.0) + 0.3 * (0.7 * time).sin()
    }

    #[test]
    fn the_load_is_found_behind_the_creep() {
        let (share, time, step) = (0.08, 9.0, 0.02);
        let signals = of_one_solid(load, share, time, step, 3000);
        // The average over the past of `y` that `s + a z` makes: the pole of `s/y` is at `−(1 + a)/θ`.
        let tau = time / (1.0 + share);
        let mut creep = CreepCompensation::new([tau], [Vector1::new(share / (1.0 + share))]).unwrap();
        for (k, signal) in signals.iter().enumerate() {
            let found = creep.follow(&Vector1::new(*signal), step).unwrap().x;
            let expected = load(step * k as f64);
            // What is left is the straight line between samples.
            assert!((found - expected).abs() < 2e-6, "{k}: {found} for {expected}");
        }
    }

    #[test]
    fn steps_of_any_length_make_one() {
        let line = |time: f64| Vector1::new(0.3 * time);
        let of = || CreepCompensation::new([2.0, 50.0], [Vector1::new(0.05), Vector1::new(-0.01)]).unwrap();
        let mut at_once = of();
        at_once.follow(&line(0.0), 7.0);
        let expected = at_once.follow(&line(10.0), 10.0).unwrap();
        for times in [&[0.0, 10.0][..], &[1.0, 1.0, 4.0, 9.9, 10.0], &[1e-300, 1e-9, 10.0]] {
            let (mut creep, mut before, mut last) = (of(), 0.0, None);
            creep.follow(&line(0.0), f64::NAN);
            for time in times {
                last = creep.follow(&line(*time), time - before);
                before = *time;
            }
            assert!((last.unwrap() - expected).amax() < 1e-13, "{times:?}");
        }
    }

    #[test]
    fn what_stays_long_enough_leaves_its_share_and_nothing_stays_behind() {
        let shares = [SVector::<f32, 2>::new(0.03, 0.0), SVector::<f32, 2>::new(0.01, 0.02)];
        let mut creep = CreepCompensation::new([1.0_f32, 20.0], shares).unwrap();
        let one = SVector::<f32, 2>::repeat(1.0);
        let settled = (0..200).filter_map(|_| creep.follow(&one, 5.0)).last().unwrap();
        assert!((settled - SVector::<f32, 2>::new(0.96, 0.98)).amax() < 1e-6);
        // At once behind a load there is what it left; after a while nothing.
        let first = creep.follow(&SVector::zeros(), 0.0).unwrap();
        assert!((first - SVector::<f32, 2>::new(-0.04, -0.02)).amax() < 1e-6);
        let last = creep.follow(&SVector::zeros(), f32::INFINITY).unwrap();
        assert_eq!(last, SVector::<f32, 2>::zeros());
    }

    #[test]
    fn no_time_step_and_no_number_spoils_it() {
        let of = || CreepCompensation::new([1e-3_f64], [Vector1::new(0.1)]).unwrap();
        let mut creep = of();
        for step in [0.0, -1.0, f64::NAN, 5e-324, 1e-3, 1e300, f64::INFINITY] {
            let found = creep.follow(&Vector1::new(2.0), step).unwrap().x;
            assert!((1.8..=2.0).contains(&found), "{step}: {found}");
        }
        // The time of what is passed over counts.
        let (mut whole, mut holed) = (of(), of());
        for k in 0..20 {
            let signal = Vector1::new(f64::from(k));
            let expected = whole.follow(&signal, 1e-4);
            let missing = k == 7 || k == 8;
            let found = holed.follow(&if missing { Vector1::new(f64::NAN) } else { signal }, 1e-4);
            assert_eq!(found.is_none(), missing);
            if let (Some(found), Some(expected)) = (found, expected) {
                assert!((found - expected).amax() < 1e-12);
            }
        }
        // Too large to be subtracted: it says so and begins anew.
        let huge = Vector1::new(f64::MAX);
        assert!(creep.follow(&huge, 1.0).is_none() || creep.follow(&-huge, 0.0).is_none());
        assert_eq!(creep.follow(&Vector1::zeros(), 1.0), Some(Vector1::zeros()));
    }

    #[test]
    fn what_is_no_creep_is_refused() {
        let new = |time: f64, share: f64| CreepCompensation::new([time], [Vector1::new(share)]).map(|_| ());
        for time in [0.0, -1.0, f64::NAN, f64::INFINITY, 5e-324] {
            assert_eq!(new(time, 0.1), Err(BadCreep::Time));
        }
        assert_eq!(new(f64::MIN_POSITIVE, 0.1), Ok(()));
        assert_eq!(new(1.0, f64::NAN), Err(BadCreep::Share));
        assert_eq!(new(1.0, f64::INFINITY), Err(BadCreep::Share));
        assert_eq!(new(1.0, 1.0), Err(BadCreep::NothingLeft));
        assert_eq!(new(1.0, -f64::MAX), Ok(()));
        assert_eq!(new(1.0, 0.999), Ok(()));
        let two = [Vector1::new(0.6), Vector1::new(0.4)];
        assert_eq!(CreepCompensation::new([1.0, 2.0], two).map(|_| ()), Err(BadCreep::NothingLeft));
    }
}
