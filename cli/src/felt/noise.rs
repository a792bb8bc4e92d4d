//! The noise of a sensor, measured while it is used.

use fingertip::contact::WrenchNoise;
use fingertip::wrench::Wrench;
use nalgebra::Vector6;

/// Estimates the standard deviation of independent noise from second differences, which take off whatever
/// changes steadily: of white noise with deviation σ, `x₀ − 2x₁ + x₂` has the variance 6σ². A running mean
/// over some hundred samples follows a sensor that changes; sudden loads make it too large, never too small.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct NoiseWatch {
    before: [Option<Vector6<f64>>; 2],
    variance: Vector6<f64>,
    samples: u32,
}

impl NoiseWatch {
    /// Samples that the running mean looks back over.
    const MEMORY: f64 = 500.0;
    /// Fewer give no estimate.
    const LEAST: u32 = 20;

    /// Takes the next wrench.
    pub(crate) fn add(&mut self, wrench: &Wrench<f64>) {
        let now = wrench.components();
        if !wrench.is_finite() {
            self.before = [None, None];
            return;
        }
        if let [Some(older), Some(old)] = self.before {
            let second = older - old * 2.0 + now;
            let square = second.component_mul(&second) / 6.0;
            self.samples = self.samples.saturating_add(1);
            let weight = 1.0 / f64::from(self.samples).min(Self::MEMORY);
            self.variance += (square - self.variance) * weight;
        }
        self.before = [self.before[1], Some(now)];
    }

    /// The noise, once enough was seen.
    pub(crate) fn wrench_noise(&self) -> Option<WrenchNoise<f64>> {
        let known = self.samples >= Self::LEAST && self.variance.iter().all(|variance| variance.is_finite());
        known.then(|| WrenchNoise { floor: self.variance.map(f64::sqrt), relative: 0.0 })
    }
}

#[cfg(test)]
mod tests {
    use fingertip::wrench::Wrench;
    use nalgebra::Vector6;
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};
    use rand_pcg::Pcg64Mcg;

    use super::NoiseWatch;

    #[test]
    fn noise_is_found_under_a_load_that_moves() {
        let mut random = Pcg64Mcg::seed_from_u64(5);
        let mut watch = NoiseWatch::default();
        assert!(watch.wrench_noise().is_none());
        for sample in 0..20_000 {
            let load = 3.0 * (f64::from(sample) * 1e-3).sin();
            let noisy = Vector6::from_fn(|axis, _| {
                let normal: f64 = StandardNormal.sample(&mut random);
                load + normal * if axis < 3 { 0.02 } else { 0.001 }
            });
            watch.add(&Wrench::from_components(&noisy));
        }
        // The mean over 1000 samples in effect, whose second differences are not independent: 5 % or so.
        let floor = watch.wrench_noise().unwrap().floor;
        for axis in 0..6 {
            let expected = if axis < 3 { 0.02 } else { 0.001 };
            assert!((floor[axis] / expected - 1.0).abs() < 0.2, "{floor}");
        }
    }

    /// A wrench of six components that alternate between ±`size`, ± twice it, and so on.
    fn alternating(sample: u32, size: f64) -> Wrench<f64> {
        let sign = if sample.is_multiple_of(2) { 1.0 } else { -1.0 };
        Wrench::from_components(&Vector6::from_fn(|axis, _| sign * size * (axis + 1) as f64))
    }

    #[test]
    fn second_differences_are_averaged_as_is_said() {
        // Second differences of ±a, alternating, are ±4a: the variance is 16a²/6 from the first on.
        let mut watch = NoiseWatch::default();
        for sample in 0..22 {
            assert!(watch.wrench_noise().is_none(), "{sample}");
            watch.add(&alternating(sample, 0.5));
        }
        let check = |watch: &NoiseWatch, deviation: f64| {
            let noise = watch.wrench_noise().unwrap();
            assert_eq!(noise.relative, 0.0);
            for axis in 0..6 {
                let expected = deviation * (axis + 1) as f64;
                assert!(
                    (noise.floor[axis] / expected - 1.0).abs() < 1e-12,
                    "{} for {expected}",
                    noise.floor[axis]
                );
            }
        };
        check(&watch, 4.0 * 0.5 / 6.0_f64.sqrt());
        // A reading that is none is left out, and no difference is taken across it.
        watch.add(&Wrench::from_components(&Vector6::repeat(f64::NAN)));
        (0..800).for_each(|sample| watch.add(&alternating(sample, 0.5)));
        check(&watch, 4.0 * 0.5 / 6.0_f64.sqrt());
        // Behind 500 samples the mean forgets: each new square has the weight 1/500. Behind +a, −a come +a/2, −a/2:
        // the two differences across the change are 3.5a and 2.5a, the others 4a/2.
        let (a, mut expected) = (0.5, 16.0 * 0.25 / 6.0);
        let mut blend = |difference: f64| expected += (difference * difference / 6.0 - expected) / 500.0;
        blend(3.5 * a);
        blend(2.5 * a);
        (2..300).for_each(|_| blend(2.0 * a));
        (0..300).for_each(|sample| watch.add(&alternating(sample, 0.25)));
        check(&watch, expected.sqrt());
    }
}
