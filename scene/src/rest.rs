//! A rest: what a sensor reads without load, and whether it rested.

use core::fmt;

use fingertip::wrench::{NotAtRest, Real, RestTest, Tare, TareError, Wrench};
use nalgebra::{SVector, Vector3, Vector6};

/// The fraction of good rests that are called into question. Small, since the noise of converters
/// is not quite independent from reading to reading.
const FALSE_ALARM_RATE: f64 = 1e-4;

/// What made a rest doubtful, and how large it was.
///
/// ```
/// use fingertip_scene::Doubt;
///
/// let doubt = Doubt { seen: "gauge 3 drifts".to_owned(), force_range: 0.1234 };
/// let told = "gauge 3 drifts, and the force ranged over 0.123 N, so far the tare may be off";
/// assert_eq!(doubt.to_string(), told);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Doubt {
    /// What was seen.
    pub seen: String,
    /// Length of the box in which the forces at rest lie \[N\]: so far the tare may be off.
    pub force_range: f64,
}

impl fmt::Display for Doubt {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Three digits.
        let range = self.force_range;
        let places = if range > 0.0 { (2.0 - range.log10().floor()).clamp(0.0, 9.0) as usize } else { 0 };
        write!(out, "{}, and the force ranged over {range:.places$} N, so far the tare may be off", self.seen)
    }
}

/// Watches the readings at rest of `N` channels: gives their mean, and says why it may have been no rest.
///
/// ```
/// use fingertip::wrench::Wrench;
/// use fingertip_scene::RestWatch;
/// use nalgebra::SVector;
///
/// let mut watch = RestWatch::<f64, 6>::default();
/// for sample in 0..500_u32 {
///     // Noise, and 1 N on the third channel.
///     let mut noise = SVector::<f64, 6>::from_fn(|k, _| {
///         f64::from((sample * 6 + k as u32 + 1).wrapping_mul(2_654_435_769) >> 16) / 65_536e3
///     });
///     noise.z += 1.0;
///     watch.add(&noise, &noise, &Wrench::from_components(&noise));
/// }
/// let zero = watch.tare()?;
/// assert!((zero.zero().z - 1.0).abs() < 2e-3);
/// assert!(watch.noise().ok_or("many readings")?.amax() < 1e-3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct RestWatch<T: Real, const N: usize> {
    /// Nothing only if the rate above were none.
    test: Option<RestTest<T, N>>,
    least: Vector3<T>,
    greatest: Vector3<T>,
    /// Of the wrenches: how many, their mean, and the sums of the squares of what is off it (Welford).
    count: u32,
    mean: Vector6<T>,
    squares: Vector6<T>,
}

impl<T: Real, const N: usize> Default for RestWatch<T, N> {
    fn default() -> Self {
        Self {
            test: RestTest::new(FALSE_ALARM_RATE).ok().map(RestTest::finding_resolution),
            least: Vector3::repeat(T::GREATEST),
            greatest: Vector3::repeat(-T::GREATEST),
            count: 0,
            mean: Vector6::zeros(),
            squares: Vector6::zeros(),
        }
    }
}

impl<T: Real, const N: usize> RestWatch<T, N> {
    /// Takes a reading as recorded, the same with known drift taken off, and the wrench that it
    /// stands for, up to a constant; `false` for a reading that is not finite, which is passed over.
    pub fn add(&mut self, raw: &SVector<T, N>, reading: &SVector<T, N>, wrench: &Wrench<T>) -> bool {
        if !reading.iter().all(|x| x.is_number()) {
            return false;
        }
        if let Some(test) = &mut self.test {
            test.add_compensated(raw, reading);
        }
        self.least = self.least.inf(&wrench.force());
        self.greatest = self.greatest.sup(&wrench.force());
        self.count = self.count.saturating_add(1);
        let off = wrench.components() - self.mean;
        self.mean += off / T::literal(f64::from(self.count));
        self.squares += off.component_mul(&(wrench.components() - self.mean));
        true
    }

    /// Standard deviation of each component of the wrench \[N, N·m\]; `None` for fewer than two readings, or some so large
    /// that it cannot be said.
    pub fn noise(&self) -> Option<Vector6<T>> {
        let others = self.count.checked_sub(1).filter(|others| *others > 0)?;
        let noise = (self.squares / T::literal(f64::from(others))).map(|square| square.max(T::zero()).root());
        noise.iter().all(|deviation| deviation.is_number()).then_some(noise)
    }

    /// The mean of the readings.
    ///
    /// # Errors
    /// [`TareError`] if there were too few.
    pub fn tare(&self) -> Result<Tare<T, N>, TareError> {
        self.test.map_or(Err(TareError::TooFewSamples { samples: 0 }), |test| test.tare())
    }

    /// Why it may not have been a rest; `name` names a channel.
    pub fn doubt(&self, name: impl Fn(usize) -> String) -> Option<Doubt> {
        let seen = match self.test?.finish().err()? {
            NotAtRest::TooFewSamples { samples, needed } => {
                format!("{samples} samples are too few to tell a rest, which takes {needed}")
            }
            NotAtRest::Drifts { gauge, over_noise } => {
                format!("{} moved by {over_noise:.1} times its spread from start to end", name(gauge))
            }
            NotAtRest::Unsteady { gauge } => format!("{} wandered slowly", name(gauge)),
            NotAtRest::Outlier { gauge, over_noise } => {
                format!("{} was once {over_noise:.0} times its spread away from its mean", name(gauge))
            }
            other => other.to_string(),
        };
        let range = (self.greatest - self.least).map(Real::to_f64).norm();
        Some(Doubt { seen, force_range: if range.is_finite() { range } else { 0.0 } })
    }
}

#[cfg(test)]
mod tests {
    use fingertip::wrench::Wrench;
    use nalgebra::{Vector3, Vector6};
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    use super::{Doubt, RestWatch};

    /// A rest in steps of `step`, with noise of `noise`, moving by `drift` in all.
    fn watched(step: f64, noise: f64, drift: f64, seed: u64) -> RestWatch<f64, 6> {
        let mut random = Pcg64Mcg::seed_from_u64(seed);
        let mut watch = RestWatch::default();
        for i in 0..500 {
            let reading = Vector6::from_fn(|channel, _| {
                // Twelve uniform numbers are nearly a normal one.
                let normal = (0..12).map(|_| random.random::<f64>()).sum::<f64>() - 6.0;
                let moved = if channel == 2 { drift * f64::from(i) / 499.0 } else { 0.0 };
                ((normal * noise + moved + 0.3) / step).round() * step
            });
            watch.add(
                &reading,
                &reading,
                &Wrench::on_fingertip(reading.fixed_rows::<3>(0).into(), Vector3::zeros()),
            );
        }
        watch
    }

    #[test]
    fn steps_of_a_converter_are_rest_and_a_drift_is_not() {
        for seed in 0..40 {
            for (step, noise) in [(1e-9, 0.01), (0.01, 0.01), (0.01, 0.003), (0.05, 0.001)] {
                let quiet = watched(step, noise, 0.0, seed);
                assert_eq!(quiet.doubt(|i| i.to_string()), None, "step {step}, noise {noise}, seed {seed}");
            }
            let doubt = watched(0.001, 0.01, 2.0, seed).doubt(|i| format!("channel {i}")).unwrap();
            assert!(doubt.seen.starts_with("channel 2 moved"), "{doubt}");
            assert!((1.9..2.2).contains(&doubt.force_range), "{doubt}");
        }
    }

    fn add(watch: &mut RestWatch<f64, 6>, reading: Vector6<f64>) {
        let wrench = Wrench::on_fingertip(reading.fixed_rows::<3>(0).into(), Vector3::zeros());
        watch.add(&reading, &reading, &wrench);
    }

    /// 400 readings with a noise of about one, of which channel 3 is changed by `more`.
    fn doubt(more: impl Fn(usize) -> f64) -> Option<Doubt> {
        let mut random = Pcg64Mcg::seed_from_u64(2);
        let mut watch = RestWatch::default();
        for i in 0..400 {
            let mut reading =
                Vector6::from_fn(|_, _| (0..12).map(|_| random.random::<f64>()).sum::<f64>() - 6.0);
            reading[3] += more(i);
            add(&mut watch, reading);
        }
        watch.doubt(|channel| format!("channel {channel}"))
    }

    #[test]
    fn every_doubt_names_its_channel_and_says_how_large_it_is() {
        assert_eq!(doubt(|_| 5.0), None);
        let seen = |more: &dyn Fn(usize) -> f64| doubt(more).unwrap().seen;
        let outlier = seen(&|i| if i == 100 { 60.0 } else { 0.0 });
        assert!(outlier.starts_with("channel 3 was once "), "{outlier}");
        let wander = seen(&|i| if (i / 100) % 2 == 0 { 1.5 } else { -1.5 });
        assert!(wander.starts_with("channel 3 "), "{wander}");
        let few = {
            let mut watch = RestWatch::default();
            (0..3).for_each(|i| add(&mut watch, Vector6::repeat(f64::from(i))));
            watch.doubt(|channel| channel.to_string()).unwrap()
        };
        assert!(few.seen.starts_with("3 samples are too few to tell a rest"), "{few}");
        // Each of three forces ranges from 0 to 2: the diagonal of the box.
        assert!((few.force_range - 12.0_f64.sqrt()).abs() < 1e-12, "{few}");
        assert_eq!(
            few.to_string(),
            format!("{}, and the force ranged over 3.46 N, so far the tare may be off", few.seen)
        );
        // Forces that are not finite tell no range.
        let mut watch = RestWatch::default();
        let wrench = |force: f64| Wrench::on_fingertip(Vector3::repeat(force), Vector3::zeros());
        [0.0, f64::INFINITY]
            .iter()
            .for_each(|force| assert!(watch.add(&Vector6::zeros(), &Vector6::zeros(), &wrench(*force))));
        assert!(!watch.add(&Vector6::zeros(), &Vector6::repeat(f64::NAN), &wrench(1.0)));
        let doubt = watch.doubt(|channel| channel.to_string()).unwrap();
        assert_eq!(doubt.force_range, 0.0);
        assert!(doubt.to_string().contains("the force ranged over 0 N"), "{doubt}");
    }

    /// Against the mean and the sum of squares, one after the other.
    #[test]
    fn the_noise_of_the_wrench_is_its_deviation() {
        let mut random = Pcg64Mcg::seed_from_u64(9);
        let mut watch = RestWatch::default();
        let wrenches: Vec<Vector6<f64>> = (0..200)
            .map(|_| Vector6::from_fn(|axis, _| 1e3 + random.random_range(-1.0..1.0) * (axis + 1) as f64))
            .collect();
        for (count, wrench) in wrenches.iter().enumerate() {
            assert_eq!(watch.noise().is_some(), count > 1);
            watch.add(wrench, wrench, &Wrench::from_components(wrench));
        }
        let noise = watch.noise().unwrap();
        for axis in 0..6 {
            let mean = wrenches.iter().map(|wrench| wrench[axis]).sum::<f64>() / 200.0;
            let squares: f64 = wrenches.iter().map(|wrench| (wrench[axis] - mean).powi(2)).sum();
            assert!((noise[axis] / (squares / 199.0).sqrt() - 1.0).abs() < 1e-9, "{noise}");
        }
        // What overflows is not said.
        let huge = Vector6::repeat(f64::MAX);
        watch.add(&huge, &huge, &Wrench::from_components(&huge));
        assert_eq!(watch.noise(), None);
    }
}
