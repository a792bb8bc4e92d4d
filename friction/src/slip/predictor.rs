//! What the innovations still foretell of each other.

use fingertip_wrench::Real;

/// How many samples foretell the next: at 2 kHz, the fastest that is taken, four fifths of a period of 50 Hz and its
/// harmonics. Eight or sixteen leave so much of these that they fall further than they rise, or the other way round, as their
/// phases have it.
pub(super) const ORDER: usize = 32;
/// The step of the normalised rule: the share of a prediction's error that is mended at once.
const STEP: f64 = 0.05;
/// Samples over which the deviation of the errors is taken.
const MEMORY: f64 = 256.0;
/// The least variance of an error, in stated ones: a correlation of 0.97 has it.
const LEAST_VARIANCE: f64 = 1.0 / 16.0;
/// Where a sample is cut off, in stated deviations. Its square is far within the range of an `f32`.
const GREATEST: f64 = 1e6;

/// Foretells each sample from the last [`ORDER`], with weights that it learns, and gives the error of that in its own
/// deviations: of a correlated or humming sequence one without memory and of unit variance.
///
/// The weights follow the normalised least-mean-square rule, `w ← w + μ e x/(c + |x|²)` (Nagumo & Noda 1967;
/// `docs/theory/friction.md#noise-that-is-not-white`), in which an error counts for three of its deviations at most, so
/// that a slip teaches nothing. Nor do samples that are not finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Predictor<T> {
    weights: [T; ORDER],
    /// The newest first.
    last: [T; ORDER],
    /// Of the errors, in stated variances.
    variance: T,
    /// One over the samples over which the variance is taken.
    rate: T,
}

impl<T: Real> Predictor<T> {
    pub(super) fn new() -> Self {
        Self {
            weights: [T::zero(); ORDER],
            last: [T::zero(); ORDER],
            variance: T::one(),
            rate: T::literal(1.0 / 16.0),
        }
    }

    /// Takes a sample, in stated deviations; returns by how many deviations of the errors it lies off what was foretold.
    /// `None` for a sample that is not a number, which changes nothing.
    #[inline]
    pub(super) fn take(&mut self, sample: T) -> Option<T> {
        if !sample.is_number() {
            return None;
        }
        let greatest = T::literal(GREATEST);
        let sample = sample.max(-greatest).min(greatest);
        // Room for what is far below the stated noise.
        let mut power = T::literal(0.1 * ORDER as f64);
        let mut foretold = T::zero();
        for (weight, x) in self.weights.iter().zip(&self.last) {
            foretold += *weight * *x;
            power += *x * *x;
        }
        let error = sample - foretold;
        let variance = self.variance.max(T::literal(LEAST_VARIANCE));
        let deviation = variance.root();
        let bound = deviation * T::literal(3.0);
        let gain = T::literal(STEP) * error.max(-bound).min(bound) / power;
        for (weight, x) in self.weights.iter_mut().zip(&self.last) {
            *weight += gain * *x;
        }
        self.last.copy_within(..ORDER - 1, 1);
        self.last[0] = sample;
        if self.rate > T::literal(1.0 / MEMORY) {
            self.rate /= T::one() + self.rate;
        }
        self.variance += ((error * error).min(bound * bound) - self.variance) * self.rate;
        Some(error / deviation)
    }

    /// Forgets the samples, and keeps what they taught.
    pub(super) fn restart(&mut self) {
        self.last = [T::zero(); ORDER];
    }
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};
    use rand_pcg::Pcg64Mcg;

    use super::Predictor;

    fn draws(seed: u64) -> impl FnMut() -> f64 {
        let mut rng = Pcg64Mcg::seed_from_u64(seed);
        move || StandardNormal.sample(&mut rng)
    }

    /// Mean square of the errors, the correlation of neighbours, and the mean of the first weight, when learnt.
    fn errors(mut next: impl FnMut() -> f64) -> (f64, f64, f64, Predictor<f64>) {
        let mut predictor = Predictor::<f64>::new();
        let (mut squares, mut products, mut last, mut weight) = (0.0, 0.0, 0.0, 0.0);
        for index in 0..60_000 {
            let variance = predictor.variance.max(super::LEAST_VARIANCE);
            let error = predictor.take(next()).unwrap() * variance.sqrt();
            if index >= 20_000 {
                squares += error * error;
                products += error * last;
                weight += predictor.weights[0] / 40_000.0;
            }
            last = error;
        }
        (squares / 40_000.0, products / squares, weight, predictor)
    }

    /// The error of the best linear prediction: for white noise the noise itself, for an autoregression of first order
    /// what drives it. The rule's own restlessness adds μ/(2 − μ) of it, 2.6 %.
    #[test]
    fn errors_are_those_of_the_best_prediction() {
        for (share, seed) in [(0.0, 1), (0.5, 2), (0.9, 3), (0.95, 4), (-0.7, 5)] {
            let mut draw = draws(seed);
            let mut x = 0.0_f64;
            let (square, correlation, weight, _) = errors(|| {
                x = share * x + (1.0_f64 - share * share).sqrt() * draw();
                x
            });
            let best = 1.0 - share * share;
            println!("AR {share}: {square:.4} of {best:.4}, neighbours {correlation:.3}, weight {weight:.3}");
            assert!((0.98..1.10).contains(&(square / best)), "{share}: {square} {best}");
            assert!(correlation.abs() < 0.05, "{share}: {correlation}");
            // The further 31 have some of it for a long time.
            assert!((weight - share).abs() < 0.08, "{share}: {weight}");
        }
    }

    /// A hum is foretold: of ten deviations hardly more than the noise is left.
    #[test]
    fn hum_is_foretold() {
        let mut draw = draws(6);
        let mut time = 0.0_f64;
        let (square, ..) = errors(|| {
            time += 1e-3;
            14.0 * (time * core::f64::consts::TAU * 50.0).sin() + draw()
        });
        println!("hum of variance 98: {square:.2} left");
        assert!(square < 1.5, "{square}");
    }

    /// After a jump of a thousand deviations the weights are what they were, nearly.
    #[test]
    fn a_jump_teaches_little() {
        let mut draw = draws(7);
        let (.., mut predictor) = errors(&mut draw);
        let before = predictor;
        let found = predictor.take(1000.0).unwrap();
        assert!((found / (1000.0 / before.variance.sqrt()) - 1.0).abs() < 1e-2);
        let moved = before.weights.iter().zip(&predictor.weights).map(|(a, b)| (a - b).abs());
        assert!(moved.fold(0.0, f64::max) < 0.1, "{predictor:?}");
        assert!(predictor.variance < before.variance * 1.04);
        predictor.restart();
        assert_eq!(predictor.last, [0.0; super::ORDER]);
        assert_ne!(predictor.weights, [0.0; super::ORDER]);
    }

    #[test]
    fn bears_what_is_no_number_and_what_is_huge() {
        let mut predictor = Predictor::<f32>::new();
        let before = predictor;
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            assert_eq!(predictor.take(bad), None);
            assert_eq!(predictor, before);
        }
        let mut draw = draws(8);
        for index in 0..20_000_u32 {
            let x = match index % 7 {
                0 => f32::MAX,
                1 => f32::MIN,
                2 => f32::MIN_POSITIVE,
                _ => draw() as f32,
            };
            assert!(predictor.take(x).unwrap().is_finite(), "{index}");
        }
        for _ in 0..20_000 {
            assert!(predictor.take(draw() as f32).unwrap().is_finite());
        }
        // What it learnt of that is forgotten again.
        assert!((0.7..1.3).contains(&predictor.variance), "{predictor:?}");
    }

    /// Silence is not taken for less than the least variance.
    #[test]
    fn silence_has_a_least_deviation() {
        let mut predictor = Predictor::<f64>::new();
        for _ in 0..5000 {
            assert_eq!(predictor.take(0.0), Some(0.0));
        }
        assert_eq!(predictor.take(0.5), Some(2.0));
    }
}
