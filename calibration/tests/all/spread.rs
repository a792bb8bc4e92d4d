//! What fits say of their own errors, against the spread of thousands of them.

use fingertip_test_support::Worst;

/// Errors of every trial, and the mean variances that the fits state, parameter by parameter.
pub(crate) struct Spread {
    errors: Vec<Vec<f64>>,
    stated: Vec<f64>,
}

/// A ratio of 1 that is found to be so far off, and how far it may be by chance (a standard error).
struct Ratio {
    off: f64,
    doubt: f64,
}

impl Spread {
    /// Each trial gives the errors and the variances that the fit states.
    pub(crate) fn over(trials: usize, mut trial: impl FnMut() -> (Vec<f64>, Vec<f64>)) -> Self {
        let mut spread = Self { errors: Vec::with_capacity(trials), stated: Vec::new() };
        for _ in 0..trials {
            let (errors, variances) = trial();
            assert_eq!(errors.len(), variances.len());
            spread.stated.resize(errors.len(), 0.0);
            for (sum, variance) in spread.stated.iter_mut().zip(&variances) {
                *sum += variance / trials as f64;
            }
            spread.errors.push(errors);
        }
        spread
    }

    /// Mean square over what is stated, less one, of these parameters together.
    fn ratio(&self, parameters: core::ops::Range<usize>) -> Ratio {
        let count = self.errors.len() as f64;
        let share = |errors: &[f64]| {
            let sum: f64 = parameters.clone().map(|i| errors[i] * errors[i] / self.stated[i]).sum();
            sum / parameters.len() as f64
        };
        let mean = self.errors.iter().map(|errors| share(errors)).sum::<f64>() / count;
        let spread = self.errors.iter().map(|errors| (share(errors) - mean).powi(2)).sum::<f64>() / count;
        Ratio { off: mean - 1.0, doubt: (spread / count).sqrt() }
    }

    /// Every parameter within 5 %. So many trials must have been made that 5 % are three standard errors and
    /// more of each, in which a wrong factor cannot hide.
    pub(crate) fn agrees(&self, what: &str) {
        self.agrees_within(what, 0.05);
    }

    /// Every parameter as near as said, in the mean square.
    pub(crate) fn agrees_within(&self, what: &str, bound: f64) {
        let ratios: Vec<Ratio> = (0..self.stated.len()).map(|i| self.ratio(i..i + 1)).collect();
        let (mut worst, mut doubt) = (Worst::new(), Worst::new());
        for ratio in &ratios {
            worst.see(ratio.off);
            doubt.see(ratio.doubt);
        }
        let (worst, doubt) = (worst.get(), doubt.get());
        let mean = self.ratio(0..self.stated.len()).off;
        println!(
            "{what}: worst {:.2} %, mean {:+.2} %, standard error {:.2} %",
            100.0 * worst,
            100.0 * mean,
            100.0 * doubt
        );
        assert!(worst < bound, "{what}: {:.3?}", ratios.iter().map(|ratio| ratio.off).collect::<Vec<_>>());
        assert!(3.0 * doubt < 0.05, "{what}: {} trials are too few: {doubt}", self.errors.len());
    }

    /// All parameters together within 5 %, for fits that take too long to be made so often that each could
    /// be told so well; each to 5 % and five standard errors of its own.
    pub(crate) fn agrees_in_the_mean(&self, what: &str) {
        let Ratio { off, doubt } = self.ratio(0..self.stated.len());
        println!("{what}: mean {:+.2} %, standard error {:.2} %", 100.0 * off, 100.0 * doubt);
        assert!(off.abs() < 0.05, "{what}: {off}");
        assert!(3.0 * doubt < 0.05, "{what}: {} trials are too few: {doubt}", self.errors.len());
        for i in 0..self.stated.len() {
            let one = self.ratio(i..i + 1);
            assert!(one.off.abs() < 0.05 + 5.0 * one.doubt, "{what}, {i}: {}", one.off);
        }
    }
}
