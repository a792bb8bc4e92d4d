//! The threshold that is passed as seldom as was asked, learnt from what happens while nothing slips.

use fingertip_wrench::Real;

use crate::BadParameter;

/// Samples of a block.
const BLOCK: u16 = 256;
/// Blocks that count.
const MEMORY: u8 = 128;
/// Blocks before there is a threshold.
const FIRST: u8 = 3;
/// The least threshold: between two blocks without any noise it must not come down to nothing.
const LEAST: f64 = 4.0;
/// Over how many thresholds a maximum counts for no more.
const GREATEST: f64 = 1.25;
/// By how much the run is taken for longer than was asked, since deviations are estimates, and no tail is quite
/// exponential.
const CAUTION: f64 = core::f64::consts::SQRT_2;
/// Least run length, in samples, that blocks of that many can tell.
const LEAST_RUN: f64 = 4.0 * BLOCK as f64;

/// Learns the law of the greatest value that a statistic reaches in a block of 256 samples, and says which value
/// it passes once in a run of so many samples.
///
/// Whatever the noise, the tail of a cumulative sum falls off exponentially, so the maxima of blocks follow the law
/// of Gumbel (1958): of mean `m` and deviation `s` they pass `m + s (√6/π)(ln(N/256) − γ)` once in `N` samples
/// (`docs/theory/friction.md#noise-that-is-not-white`); `N` is taken for √2 times what was asked. Few blocks tell the deviation badly: for `n` of them the
/// distance is widened by `1 + 3/n`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct BlockMaxima<T> {
    /// Greatest of this block, and its samples so far.
    greatest: T,
    samples: u16,
    /// Blocks, up to [`MEMORY`].
    blocks: u8,
    mean: T,
    variance: T,
    /// `(√6/π)(ln(√2 N/256) − γ)`.
    reach: T,
    /// Infinite until there is one.
    threshold: T,
}

impl<T: Real> BlockMaxima<T> {
    /// From the samples between false alarms.
    ///
    /// # Errors
    /// [`BadParameter`] unless that is finite and at least four blocks.
    pub(super) fn new(run_length: f64) -> Result<Self, BadParameter> {
        if !(run_length >= LEAST_RUN && run_length.is_finite()) {
            return Err(BadParameter {
                parameter: "run between false alarms",
                requirement: "finite, and at least 1024 samples",
            });
        }
        let per_block = libm::log(CAUTION * run_length / f64::from(BLOCK));
        let reach = libm::sqrt(6.0) / core::f64::consts::PI * (per_block - EULER);
        Ok(Self {
            greatest: T::zero(),
            samples: 0,
            blocks: 0,
            mean: T::zero(),
            variance: T::zero(),
            reach: T::literal(reach),
            threshold: T::GREATEST,
        })
    }

    /// Takes the greatest value of a sample.
    #[inline]
    pub(super) fn see(&mut self, value: T) {
        if value > self.greatest {
            self.greatest = value;
        }
    }

    /// Counts a sample.
    #[inline]
    pub(super) fn count(&mut self) {
        self.samples += 1;
        if self.samples >= BLOCK {
            self.close();
        }
    }

    #[inline(never)]
    fn close(&mut self) {
        let greatest = self.greatest.min(self.threshold * T::literal(GREATEST));
        (self.greatest, self.samples) = (T::zero(), 0);
        self.blocks = (self.blocks + 1).min(MEMORY);
        let n = T::literal(f64::from(self.blocks));
        let off = greatest - self.mean;
        self.mean += off / n;
        self.variance += (off * off * (T::one() - T::one() / n) - self.variance) / n;
        if self.blocks >= FIRST {
            let widened = self.reach * (T::one() + T::literal(3.0) / n);
            let threshold = self.mean + self.variance.root() * widened;
            self.threshold = threshold.max(T::literal(LEAST));
        }
    }

    /// Forgets all blocks.
    pub(super) fn reset(&mut self) {
        (self.greatest, self.samples, self.blocks) = (T::zero(), 0, 0);
        (self.mean, self.variance, self.threshold) = (T::zero(), T::zero(), T::GREATEST);
    }

    /// What is passed as seldom as was asked; the greatest number while too little is known.
    #[inline]
    pub(super) const fn threshold(&self) -> T {
        self.threshold
    }

    /// Whether there is a threshold.
    pub(super) const fn is_known(&self) -> bool {
        self.blocks >= FIRST
    }
}

/// Euler's constant.
const EULER: f64 = 0.577_215_664_901_532_9;

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    use super::BlockMaxima;

    /// Values of an exponential law of any scale and place: of a million blocks so many pass.
    #[test]
    fn a_threshold_is_passed_as_often_as_was_asked() {
        let mut rng = Pcg64Mcg::seed_from_u64(1);
        for (place, scale) in [(5.0, 1.0), (40.0, 0.3), (6.0, 10.0)] {
            let mut maxima = BlockMaxima::<f64>::new(256.0 * 400.0).unwrap();
            let (mut passed, mut blocks) = (0.0, 0.0);
            for block in 0..300_000 {
                // The greatest of 256 exponential values.
                let greatest = place - scale * (1.0 - rng.random::<f64>().powf(1.0 / 256.0)).ln();
                if block > 200 {
                    blocks += 1.0;
                    passed += f64::from(u8::from(greatest > maxima.threshold()));
                }
                maxima.see(greatest);
                (0..256).for_each(|_| maxima.count());
            }
            let found = blocks / passed;
            println!("once in {found:.0} blocks, asked 400");
            assert!((400.0..800.0).contains(&found), "{found}");
        }
    }

    /// Mean and deviation against the plain formulas, the distance against Gumbel's own inverse.
    #[test]
    fn threshold_is_that_of_gumbels_law() {
        let run = 60_000.0;
        let mut maxima = BlockMaxima::<f64>::new(run).unwrap();
        let values = [6.0, 9.0, 7.5, 8.0, 12.0, 7.0];
        for (index, value) in values.iter().enumerate() {
            assert_eq!(maxima.is_known(), index >= 3);
            for sample in 0..256 {
                maxima.see(if sample == 100 { *value } else { 1.0 });
                maxima.count();
            }
        }
        let mean = values.iter().sum::<f64>() / 6.0;
        let variance = values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / 6.0;
        let scale = variance.sqrt() * 6.0_f64.sqrt() / core::f64::consts::PI;
        let mode = mean - 0.577_215_664_901_532_9 * scale;
        // Once in `run` samples: P(maximum ≤ x) = exp(−exp(−(x − mode)/scale)), for small rates.
        let plain = mode + scale * (run * 2.0_f64.sqrt() / 256.0).ln();
        let wanted = mean + (plain - mean) * 1.5;
        assert!((maxima.threshold() / wanted - 1.0).abs() < 1e-12, "{} {wanted}", maxima.threshold());
    }

    #[test]
    fn outliers_and_silence_are_bounded() {
        let mut maxima = BlockMaxima::<f32>::new(1e5).unwrap();
        assert_eq!(maxima.threshold(), f32::MAX);
        let mut block = |value: f32| {
            maxima.see(value);
            (0..256).for_each(|_| maxima.count());
            maxima.threshold()
        };
        for _ in 0..200 {
            block(0.0);
        }
        assert_eq!(block(0.0), 4.0);
        // One block at five counts for no more than 5: 1.25 times the threshold.
        let mut other = maxima;
        other.see(1e30);
        maxima.see(5.0);
        for _ in 0..256 {
            maxima.count();
            other.count();
        }
        assert_eq!(other, maxima);
        other.see(f32::NAN);
        assert_eq!(other, maxima);
    }

    #[test]
    fn bad_run_lengths_are_refused() {
        for bad in [0.0, -1.0, 1023.9, f64::NAN, f64::INFINITY] {
            assert!(BlockMaxima::<f64>::new(bad).is_err(), "{bad}");
        }
        assert!(BlockMaxima::<f32>::new(1024.0).is_ok());
    }
}
