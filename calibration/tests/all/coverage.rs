//! What intervals are worth: how often they hold the truth.

use fingertip_calibration::fit::Fit;
use fingertip_calibration::nalgebra::DMatrix;
use statrs::distribution::{Binomial, DiscreteCDF as _};

/// How many trials the long versions make, of which 93 to 97 % must hold the truth, parameter by parameter.
pub(crate) const LONG: usize = 2_000;

/// Of so few the shares may be off by chance, too: four standard errors.
pub(crate) const SHORT: usize = 300;

/// Counts how often intervals of 95 % hold the truth, parameter by parameter.
pub(crate) struct Coverage {
    trials: usize,
    held: Vec<usize>,
}

impl Coverage {
    /// Each trial gives the errors and the half widths of the intervals, or `None` where nothing is stated.
    pub(crate) fn over(trials: usize, mut trial: impl FnMut() -> Option<(Vec<f64>, Vec<f64>)>) -> Self {
        let mut coverage = Self { trials: 0, held: Vec::new() };
        for _ in 0..trials {
            let Some((errors, widths)) = trial() else { continue };
            assert_eq!(errors.len(), widths.len());
            coverage.trials += 1;
            coverage.held.resize(errors.len(), 0);
            for (held, (error, width)) in coverage.held.iter_mut().zip(errors.iter().zip(&widths)) {
                *held += usize::from(error.abs() <= *width);
            }
        }
        coverage
    }

    /// How many trials stated intervals.
    pub(crate) const fn stated(&self) -> usize {
        self.trials
    }

    /// All shares are between 93 and 97 %, or as near to 95 % as chance lets them be. Intervals that are too wide never miss
    /// the truth, which chance lets happen as good as never.
    pub(crate) fn holds(&self, what: &str) {
        let most = (100.0 - self.fewest_misses()).max(97.0);
        self.share_lies_in(what, 95.0 - self.allowed()..=most);
    }

    fn allowed(&self) -> f64 {
        (400.0 * (0.95 * 0.05 / self.trials as f64).sqrt()).max(2.0)
    }

    /// So few of a hundred miss, or fewer, with the probability that four standard errors have: by the binomial
    /// distribution itself, which so near to its end is no normal one.
    fn fewest_misses(&self) -> f64 {
        let trials = self.trials as u64;
        let misses = Binomial::new(0.05, trials).unwrap();
        let fewest = (0..trials).find(|count| misses.cdf(*count) >= 3e-5).unwrap_or(trials);
        100.0 * fewest as f64 / self.trials as f64
    }

    fn share_lies_in(&self, what: &str, range: core::ops::RangeInclusive<f64>) {
        let count = self.trials as f64;
        let shares: Vec<f64> = self.held.iter().map(|held| 100.0 * *held as f64 / count).collect();
        let least = shares.iter().copied().fold(f64::INFINITY, f64::min);
        let most = shares.iter().copied().fold(0.0, f64::max);
        println!("{what}: 95 % intervals hold {least:.1} to {most:.1} % of {} trials", self.trials);
        let near = |share: &f64| range.contains(share);
        assert!(!shares.is_empty() && shares.iter().all(near), "{what}: {shares:.1?} %");
    }
}

/// Errors of all coefficients of a fit, and the half widths of their intervals of 95 %.
pub(crate) fn judged(fit: &Fit, truth: &DMatrix<f64>) -> Option<(Vec<f64>, Vec<f64>)> {
    let errors = &fit.coefficients - truth;
    Some((errors.as_slice().to_vec(), fit.half_widths(0.95).as_slice().to_vec()))
}
