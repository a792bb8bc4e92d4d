//! Readings of before, to bring two streams to the same time.

use nalgebra::SVector;

use crate::{BadInertialUnit, Real};

/// Gives `N` channels as they were a fixed time ago, by a straight line between two samples.
///
/// It remembers `LENGTH` samples. Where these do not reach back so far, or nothing was yet, it gives the oldest;
/// [`reaches`](Self::reaches) says whether they do at a rate. A sample costs as many steps as the delay holds samples.
///
/// ```
/// use fingertip_wrench::DelayLine;
/// use nalgebra::SVector;
///
/// let mut line = DelayLine::<f64, 1, 8>::new(2.5e-3)?;
/// assert!(line.reaches(1000.0) && !line.reaches(5000.0));
/// let given = (0..8).map(|k| line.follow(&SVector::<f64, 1>::new(f64::from(k)), 1e-3)).last();
/// assert!((given.unwrap().x - 4.5).abs() < 1e-12);
/// # Ok::<(), fingertip_wrench::BadInertialUnit>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct DelayLine<T: Real, const N: usize, const LENGTH: usize> {
    delay: T,
    /// A ring: samples, and the time between each and the one before it \[s\].
    samples: [(SVector<T, N>, T); LENGTH],
    newest: usize,
    count: usize,
}

impl<T: Real, const N: usize, const LENGTH: usize> DelayLine<T, N, LENGTH> {
    /// With the delay \[s\].
    ///
    /// # Errors
    /// [`BadInertialUnit::Delay`] if it is negative or not finite.
    pub fn new(delay: T) -> Result<Self, BadInertialUnit> {
        if !(delay >= T::zero() && delay.is_number()) {
            return Err(BadInertialUnit::Delay);
        }
        let samples = [(SVector::zeros(), T::zero()); LENGTH];
        Ok(Self { delay, samples, newest: 0, count: 0 })
    }

    /// Whether the samples that are remembered reach back over the delay at a rate \[Hz\].
    #[must_use]
    pub fn reaches(&self, sample_rate: T) -> bool {
        self.delay * sample_rate <= T::literal(LENGTH as f64) - T::literal(2.0)
    }

    /// The next sample, `time_step` seconds after the one before (one that is not positive counts as 0); given is what was
    /// there a delay ago. What is not finite is remembered as it is: the caller leaves it out.
    #[inline]
    pub fn follow(&mut self, sample: &SVector<T, N>, time_step: T) -> SVector<T, N> {
        let step = if time_step > T::zero() { time_step } else { T::zero() };
        self.newest = if self.newest + 1 < LENGTH { self.newest + 1 } else { 0 };
        let Some(place) = self.samples.get_mut(self.newest) else { return *sample };
        *place = (*sample, step);
        self.count = (self.count + 1).min(LENGTH);
        let (mut age, mut at) = (T::zero(), self.newest);
        let (mut later, mut since) = (*sample, step);
        for _ in 1..self.count {
            at = if at > 0 { at - 1 } else { LENGTH - 1 };
            let Some((earlier, before)) = self.samples.get(at) else { return later };
            if age + since >= self.delay {
                // A step of no time is passed over, or ends here.
                let share = if since > T::zero() { (self.delay - age) / since } else { T::zero() };
                return later + (earlier - later) * share;
            }
            age += since;
            (later, since) = (*earlier, *before);
        }
        later
    }

    /// The next sample is the first.
    pub fn start_anew(&mut self) {
        self.count = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A straight line in time comes out as it was, whatever the steps; and at first its beginning does.
    fn a_line_comes_late<T: Real>() {
        let steps = [0.5, 0.0, 1.0, 0.25, 2.0, 1.0, 0.125, 0.0, 0.0, 1.5, 1.0, 1.0, 0.75];
        for delay in [0.0, 0.3, 1.0, 2.6] {
            let mut line = DelayLine::<T, 1, 12>::new(T::literal(delay)).unwrap();
            let mut time = 0.0;
            for (k, step) in steps.into_iter().enumerate() {
                time += if k > 0 { step } else { 0.0 };
                let given = line.follow(&SVector::<T, 1>::new(T::literal(time)), T::literal(step));
                let expected = (time - delay).max(0.0);
                assert!((given.x.to_f64() - expected).abs() < 1e-5, "{delay} {time}: {given}");
            }
            line.start_anew();
            let one = SVector::<T, 1>::new(T::one());
            assert_eq!(line.follow(&one, T::one()), one);
        }
    }

    #[test]
    fn a_line_comes_late_in_both_precisions() {
        a_line_comes_late::<f32>();
        a_line_comes_late::<f64>();
    }

    #[test]
    fn a_line_that_is_too_short_gives_its_oldest() {
        let mut line = DelayLine::<f64, 1, 4>::new(100.0).unwrap();
        let given: [f64; 6] = core::array::from_fn(|k| line.follow(&SVector::<f64, 1>::new(k as f64), 1.0).x);
        assert_eq!(given, [0.0, 0.0, 0.0, 0.0, 1.0, 2.0]);
        assert!(!line.reaches(1.0));
        let short = DelayLine::<f64, 1, 4>::new(0.01).unwrap();
        assert!(short.reaches(200.0) && !short.reaches(201.0));
        let one = SVector::<f64, 1>::new(7.0);
        assert_eq!(DelayLine::<f64, 1, 0>::new(1.0).unwrap().follow(&one, 1.0), one);
        for step in [f64::NAN, f64::INFINITY, -1.0, 1e308, 1e308] {
            assert!(line.follow(&one, step).x.is_finite());
        }
        for bad in [-1.0, f64::NAN, f64::INFINITY] {
            assert_eq!(DelayLine::<f64, 1, 4>::new(bad), Err(BadInertialUnit::Delay));
        }
    }
}
