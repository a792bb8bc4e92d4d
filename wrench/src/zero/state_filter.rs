//! A low-pass filter that also tells the derivative of what it gives.

use nalgebra::SVector;

use crate::Real;
use crate::numeric::decay;

/// A state-variable filter of second order on `N` channels: `1/(1 + τs)²`, and the exact derivative of what it gives.
///
/// Two first-order parts in a row, `τ ẏ₁ = u − y₁`, `τ ẏ₂ = y₁ − y₂`; the derivative of the output is `(y₁ − y₂)/τ`, so that
/// nothing is ever differenced (Young 1981; Garnier & Wang 2008, ch. 1). Between two samples the input is taken as a
/// straight line, for which a step is exact by `e^{−h/τ}`: it is stable at any time step, of whatever length, zero included.
/// An equation that is linear in its parameters holds between filtered sides as well, if all are filtered alike.
///
/// What changes slowly comes late by [`delay`](Self::delay), twice the time constant. The first sample is taken as if it had
/// been there for ever. A sample that is not finite is passed over, and its time counts for the next.
/// Formulas: `docs/theory/wrench.md#inertial-loads`.
///
/// ```
/// use fingertip_wrench::StateFilter;
/// use nalgebra::SVector;
///
/// let mut filter = StateFilter::<f64, 1>::new(0.01)?;
/// // A ramp of 3 per second: the derivative is right, the value late by 0.02 s.
/// let mut last = None;
/// for k in 0..1000 {
///     last = filter.follow(&SVector::<f64, 1>::new(3.0 * 1e-3 * f64::from(k)), 1e-3);
/// }
/// let (value, derivative) = last.unwrap();
/// assert!((derivative.x - 3.0).abs() < 1e-12 && (value.x - 3.0 * (0.999 - 0.02)).abs() < 1e-12);
/// # Ok::<(), fingertip_wrench::BadInertialUnit>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StateFilter<T: Real, const N: usize> {
    time_constant: T,
    held: Option<Held<T, N>>,
    /// Time of samples that were passed over \[s\].
    missed: T,
}

/// The last input, and what the two parts hold, counted from it: that keeps digits where values are large.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Held<T: Real, const N: usize> {
    input: SVector<T, N>,
    first: SVector<T, N>,
    second: SVector<T, N>,
}

impl<T: Real, const N: usize> StateFilter<T, N> {
    /// With a time constant \[s\]: half the power is gone at `0.102/τ` hertz.
    ///
    /// # Errors
    /// [`BadInertialUnit::TimeConstant`](crate::BadInertialUnit::TimeConstant) unless it is positive and finite.
    pub fn new(time_constant: T) -> Result<Self, super::BadInertialUnit> {
        // Its reciprocal must be a number, too.
        if time_constant >= T::LEAST_NORMAL && time_constant.is_number() {
            Ok(Self { time_constant, held: None, missed: T::zero() })
        } else {
            Err(super::BadInertialUnit::TimeConstant)
        }
    }

    /// The time constant \[s\].
    #[inline]
    #[must_use]
    pub const fn time_constant(&self) -> T {
        self.time_constant
    }

    /// By how much what changes slowly comes late \[s\].
    #[inline]
    #[must_use]
    pub fn delay(&self) -> T {
        self.time_constant + self.time_constant
    }

    /// The next sample, `time_step` seconds after the one before (one that is not positive counts as 0): value and
    /// derivative of what the filter gives. `None` for a sample that is not finite, or one so large that the derivative is
    /// no number; the latter begins anew.
    #[inline]
    pub fn follow(&mut self, input: &SVector<T, N>, time_step: T) -> Option<(SVector<T, N>, SVector<T, N>)> {
        let step = self.missed + if time_step > T::zero() { time_step } else { T::zero() };
        if !input.iter().all(|x| x.is_number()) {
            self.missed = step;
            return None;
        }
        self.missed = T::zero();
        let held =
            self.held.unwrap_or(Held { input: *input, first: SVector::zeros(), second: SVector::zeros() });
        let q = step / self.time_constant;
        let (left, mean) = decay(q);
        // Where nothing is left, infinity times nothing would be NaN.
        let passed = if left > T::zero() { q * left } else { T::zero() };
        let rise = input - held.input;
        let first = held.first * left - rise * mean;
        let second = held.first * passed + held.second * left - rise * (mean + mean - left);
        let derivative = (first - second) / self.time_constant;
        let value = input + second;
        if !(derivative.iter().chain(value.iter()).all(|x| x.is_number())) {
            self.held = None;
            return None;
        }
        self.held = Some(Held { input: *input, first, second });
        Some((value, derivative))
    }

    /// The next sample is the first.
    pub fn start_anew(&mut self) {
        (self.held, self.missed) = (None, T::zero());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::BadInertialUnit;

    /// A sine of known response: `1/(1 + iωτ)²` once it has settled, and `iω` times that for the derivative.
    fn a_sine_comes_out_as_its_response_says<T: Real>(tolerance: f64) {
        let (tau, step, omega) = (0.01, 2e-4, 60.0_f64);
        let mut filter = StateFilter::<T, 1>::new(T::literal(tau)).unwrap();
        let (gain, lag) = (1.0 / (1.0 + (omega * tau).powi(2)), 2.0 * (omega * tau).atan());
        for k in 0..4000 {
            let time = step * f64::from(k);
            let input = SVector::<T, 1>::new(T::literal((omega * time).sin()));
            let (value, derivative) = filter.follow(&input, T::literal(step)).unwrap();
            if time > 20.0 * tau {
                let phase = omega * time - lag;
                assert!((value.x.to_f64() - gain * phase.sin()).abs() < tolerance, "{time}");
                assert!((derivative.x.to_f64() / omega - gain * phase.cos()).abs() < tolerance, "{time}");
            }
        }
    }

    #[test]
    fn a_sine_comes_out_as_its_response_says_in_both_precisions() {
        // What is left is the straight line between samples, (ωh)²/12.
        a_sine_comes_out_as_its_response_says::<f32>(1e-4);
        a_sine_comes_out_as_its_response_says::<f64>(2e-5);
    }

    /// A straight line sampled anyhow is followed as if it had been sampled in one step: steps are exact.
    #[test]
    fn steps_of_any_length_make_one() {
        let line = |time: f64| SVector::<f64, 1>::new(2.0 - 7.0 * time);
        let run = |times: &[f64]| {
            let mut filter = StateFilter::<f64, 1>::new(0.02).unwrap();
            filter.follow(&line(0.0), 1.0);
            let (mut before, mut last) = (0.0, None);
            for time in times {
                last = filter.follow(&line(*time), time - before);
                before = *time;
            }
            last.unwrap()
        };
        let (value, slope) = run(&[0.1]);
        for times in [&[0.0, 0.1][..], &[0.01, 0.013, 0.013, 0.05, 0.1], &[1e-12, 0.099_999, 0.1]] {
            let (other, other_slope) = run(times);
            assert!((value - other).amax() < 1e-13 && (slope - other_slope).amax() < 1e-11, "{times:?}");
        }
    }

    #[test]
    fn no_time_step_and_no_number_spoils_it() {
        let mut filter = StateFilter::<f32, 2>::new(1e-3).unwrap();
        let one = SVector::<f32, 2>::repeat(1.0);
        for step in [0.0, -1.0, f32::NAN, f32::INFINITY, f32::MAX, 1e-45, 1e-3] {
            let (value, slope) = filter.follow(&one, step).unwrap();
            assert!((value - one).amax() < 1e-6 && slope.amax() < 1e-2, "{step}");
        }
        let mut bad = one;
        bad.y = f32::NAN;
        assert_eq!(filter.follow(&bad, 1e-3), None);
        assert_eq!(filter.follow(&(one * 2.0), f32::INFINITY).unwrap().0, one * 2.0);
        // Too large to be subtracted: it says so and goes on.
        let huge = SVector::<f32, 2>::repeat(f32::MAX);
        assert!(filter.follow(&-huge, 1e-3).is_none() || filter.follow(&huge, 1e-3).is_none());
        filter.start_anew();
        assert_eq!(filter.follow(&one, 1e-3).unwrap().0, one);
        for tau in [0.0, -1.0, f32::NAN, f32::INFINITY, 1e-45] {
            assert_eq!(StateFilter::<f32, 1>::new(tau), Err(BadInertialUnit::TimeConstant));
        }
        assert!(StateFilter::<f32, 1>::new(f32::MIN_POSITIVE).is_ok());
    }

    /// A sample that was no number is bridged by a straight line.
    #[test]
    fn the_time_of_a_missing_sample_counts() {
        let ramp = |k: u32| SVector::<f64, 1>::new(f64::from(k));
        let mut whole = StateFilter::<f64, 1>::new(3.0).unwrap();
        let mut holed = whole;
        for k in 0..20 {
            let given = whole.follow(&ramp(k), 1.0);
            let missing = k == 7 || k == 8;
            let input = if missing { SVector::<f64, 1>::new(f64::NAN) } else { ramp(k) };
            let other = holed.follow(&input, 1.0);
            assert_eq!(other.is_none(), missing);
            if let Some((value, slope)) = other {
                let (expected, expected_slope) = given.unwrap();
                assert!((value - expected).amax() < 1e-12 && (slope - expected_slope).amax() < 1e-12);
            }
        }
    }
}
