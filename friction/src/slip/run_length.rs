//! How long a change detector runs between false alarms, and the threshold for a wanted rate.

use fingertip_wrench::numeric::normal::normal_distribution;

use crate::BadParameter;

/// Siegmund's correction for the overshoot over both boundaries: `2 · 0.583`.
const OVERSHOOT: f64 = 1.166;

/// What to add to Siegmund's threshold, by allowance: the exact threshold of the Nyström solver at
/// an average run length of 1e5, minus the approximation.
const CORRECTION: [(f64, f64); 7] = [
    (0.125, 0.001_2),
    (0.25, 0.002_5),
    (0.5, 0.007_7),
    (0.75, 0.016_2),
    (1.0, 0.028_0),
    (1.25, 0.042_3),
    (1.5, 0.058_1),
];

/// Average run length of a one-sided cumulative sum by Siegmund's approximation (1985):
/// `(e^{−2Δb} + 2Δb − 1)/(2Δ²)`, `Δ = mean − k`, `b = h + 1.166`.
#[must_use]
pub fn siegmund_run_length(allowance: f64, threshold: f64, mean: f64) -> f64 {
    let drift = mean - allowance;
    let width = threshold + OVERSHOOT;
    let x = 2.0 * drift * width;
    if x.abs() < 1e-6 { width * width } else { (libm::expm1(-x) + x) / (2.0 * drift * drift) }
}

/// The threshold of a one-sided cumulative sum of standardised independent samples for an average
/// run length between false alarms, from Siegmund's formula and a table of its error; good to 0.05 %
/// for run lengths from 1e5, or from 1e3 with an allowance up to 1, and to 0.7 % for run lengths from
/// 1e3 with allowances up to 1.5. Needs no standard library.
///
/// # Errors
/// [`BadParameter`] unless the allowance is in that range and the run length at least 10.
pub fn cusum_threshold(allowance: f64, run_length: f64) -> Result<f64, BadParameter> {
    let (first, last) = (CORRECTION[0].0, CORRECTION[CORRECTION.len() - 1].0);
    if !(first..=last).contains(&allowance) {
        return Err(BadParameter { parameter: "allowance", requirement: "between 0.125 and 1.5" });
    }
    if !(run_length >= 10.0 && run_length.is_finite()) {
        return Err(BadParameter { parameter: "average run length", requirement: "at least 10 and finite" });
    }
    // e^x − x − 1 = 2k²·ARL, by Newton from above: the left side is convex.
    let target = 2.0 * allowance * allowance * run_length;
    let mut x = libm::log(target + 2.0) + 1.0;
    for _ in 0..60 {
        let step = (libm::expm1(x) - x - target) / libm::expm1(x);
        if !(step.abs() > 1e-14 * x) {
            break;
        }
        x -= step;
    }
    let mut correction = CORRECTION[0].1;
    for pair in CORRECTION.windows(2) {
        if let [(low, at_low), (high, at_high)] = *pair
            && allowance >= low
        {
            let share = ((allowance - low) / (high - low)).min(1.0);
            correction = at_low + share * (at_high - at_low);
        }
    }
    // Above zero: for a run length of 10, least at the greatest allowance, where it is 0.2.
    Ok(x / (2.0 * allowance) - OVERSHOOT + correction)
}

/// Average run length between false alarms of a windowed one-sided generalised likelihood ratio
/// `max_j S_j²/(2j) > threshold`, `j ≤ window`, `S_j > 0`, of standardised independent samples, by
/// Siegmund & Venkatraman (1995): `2√(2π) e^{b²/2} / (b ∫ x ν(x)² dx)` over `[b/√window, b]` with
/// `b = √(2·threshold)`. It holds for large thresholds and long windows: what it tells is up to a
/// quarter too long for windows of 16 and more, and up to 1.8 times too long for a window of 4.
#[must_use]
pub fn likelihood_ratio_run_length(window: usize, threshold: f64) -> f64 {
    let b = libm::sqrt(2.0 * threshold);
    let low = b / libm::sqrt(window.max(1) as f64);
    let count = 200;
    let step = (b - low) / f64::from(count);
    let f = |x: f64| x * overshoot(x) * overshoot(x);
    // Simpson; the integrand is smooth.
    let mut sum = f(low) + f(b);
    for index in 1..count {
        sum += f(low + step * f64::from(index)) * if index % 2 == 1 { 4.0 } else { 2.0 };
    }
    let integral = sum * step / 3.0;
    if integral > 0.0 {
        2.0 * libm::sqrt(core::f64::consts::TAU) * libm::exp(threshold) / (b * integral)
    } else {
        f64::INFINITY
    }
}

/// The threshold that gives the likelihood ratio a wanted average run length.
///
/// # Errors
/// [`BadParameter`] unless the window is at least 2 and the run length at least 100 and finite.
pub fn likelihood_ratio_threshold(window: usize, run_length: f64) -> Result<f64, BadParameter> {
    if window < 2 {
        return Err(BadParameter { parameter: "window", requirement: "at least 2" });
    }
    if !(run_length >= 100.0 && run_length.is_finite()) {
        return Err(BadParameter { parameter: "average run length", requirement: "at least 100 and finite" });
    }
    // The run length grows with the threshold from 2 on.
    let (mut low, mut high) = (2.0, 700.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if likelihood_ratio_run_length(window, middle) < run_length {
            low = middle;
        } else {
            high = middle;
        }
    }
    Ok(high)
}

/// ν: the mean of `e^{−μR}` over the overshoot R, by Siegmund & Yakir (2007).
fn overshoot(x: f64) -> f64 {
    let half = 0.5 * x;
    let share = normal_distribution(half);
    let density = libm::exp(-0.5 * half * half) / libm::sqrt(core::f64::consts::TAU);
    (2.0 / x) * (share - 0.5) / (half * share + density)
}

/// Average run length between false alarms for a rate per minute at a sample rate \[Hz\].
#[must_use]
pub fn run_length_for(false_alarms_per_minute: f64, sample_rate: f64) -> f64 {
    60.0 * sample_rate / false_alarms_per_minute
}

/// Average run length of a one-sided cumulative sum of independent samples of the given mean and
/// unit variance, exact to about nine digits: the integral equation
/// `L(s) = 1 + L(0)Φ(k−s−m) + ∫₀ʰ L(u) φ(u−s+k−m) du` (Page 1954) by Nyström's method on
/// Gauss-Legendre points. NaN unless the threshold is positive and the others are finite.
#[cfg(feature = "std")]
#[must_use]
pub fn cusum_run_length(allowance: f64, threshold: f64, mean: f64) -> f64 {
    if !(threshold > 0.0 && threshold.is_finite() && allowance.is_finite() && mean.is_finite()) {
        return f64::NAN;
    }
    // The kernel is a bell of unit width: six points to a deviation resolve it to rounding.
    let panels = (threshold / 4.0).ceil().clamp(1.0, 64.0);
    let width = threshold / panels;
    let mut points = vec![(0.0, 0.0)];
    for panel in 0..panels as usize {
        for (x, weight) in gauss_legendre(24) {
            points.push((width * (panel as f64 + 0.5 * (x + 1.0)), 0.5 * width * weight));
        }
    }
    let shift = allowance - mean;
    let density = |x: f64| libm::exp(-0.5 * x * x) / core::f64::consts::TAU.sqrt();
    let size = points.len();
    let matrix = nalgebra::DMatrix::from_fn(size, size, |row, column| {
        let (start, identity) = (points[row].0, f64::from(u8::from(row == column)));
        if column == 0 {
            identity - normal_distribution(shift - start)
        } else {
            let (end, weight) = points[column];
            identity - weight * density(end - start + shift)
        }
    });
    let ones = nalgebra::DVector::from_element(size, 1.0);
    matrix.lu().solve(&ones).map_or(f64::INFINITY, |lengths| lengths[0])
}

/// Points and weights of the Gauss-Legendre rule on [−1, 1], by Newton on the Legendre polynomial.
#[cfg(feature = "std")]
fn gauss_legendre(count: u32) -> Vec<(f64, f64)> {
    let n = f64::from(count);
    (0..count)
        .map(|index| {
            let mut x = libm::cos(core::f64::consts::PI * (f64::from(index) + 0.75) / (n + 0.5));
            let mut slope = 1.0;
            for _ in 0..20 {
                let (mut last, mut value) = (1.0, x);
                for degree in 2..=count {
                    let d = f64::from(degree);
                    (last, value) = (value, ((2.0 * d - 1.0) * x * value - (d - 1.0) * last) / d);
                }
                slope = n * (x * value - last) / (x * x - 1.0);
                let step = value / slope;
                x -= step;
                if step.abs() < 1e-16 {
                    break;
                }
            }
            (x, 2.0 / ((1.0 - x * x) * slope * slope))
        })
        .collect()
}

#[cfg(all(test, feature = "std"))]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    #[test]
    fn nystrom_matches_published_run_lengths() {
        // The table of `docs/theory/friction.md#cumulative-sum`; the two-sided 168 and 465 of Montgomery are
        // half of 335.4 and 930.9.
        for (k, h, quiet, changed) in [
            (0.25, 8.0, 736.8, 28.76),
            (0.5, 4.0, 335.4, 8.38),
            (0.5, 5.0, 930.9, 10.38),
            (1.0, 4.0, 14_511.0, 4.75),
        ] {
            let quiet_found = cusum_run_length(k, h, 0.0);
            let changed_found = cusum_run_length(k, h, 2.0 * k);
            assert!((quiet_found / quiet - 1.0).abs() < 1e-4, "{k} {h} {quiet_found}");
            assert!((changed_found / changed - 1.0).abs() < 1e-3, "{k} {h} {changed_found}");
        }
        assert!(cusum_run_length(0.5, f64::NAN, 0.0).is_nan());
    }

    /// Prints the table's entries as they should be.
    #[test]
    fn correction_table_is_the_solvers() {
        let mut worst = fingertip_test_support::Worst::new();
        for (k, told) in CORRECTION {
            let start = cusum_threshold(k, 1e5).unwrap();
            let (mut low, mut high) = (start - 0.3, start + 0.3);
            for _ in 0..24 {
                let middle = 0.5 * (low + high);
                if cusum_run_length(k, middle, 0.0) < 1e5 { low = middle } else { high = middle }
            }
            let plain = cusum_threshold(k, 1e5).unwrap() - told;
            println!("({k}, {:.4}),", high - plain);
            worst.see(high - plain - told);
        }
        assert!(worst.get() < 1e-4, "{}", worst.get());
    }

    #[test]
    fn thresholds_give_the_wanted_run_length() {
        for k in [0.125, 0.2, 0.5, 0.6, 0.9, 1.0, 1.3, 1.5] {
            for run_length in [1e3, 6e4, 1e7] {
                let h = cusum_threshold(k, run_length).unwrap();
                let found = cusum_run_length(k, h, 0.0);
                // Half a percent of the threshold.
                let bound = (2.0 * k * 0.005 * (h + OVERSHOOT)).exp_m1() + 1e-3;
                assert!((found / run_length - 1.0).abs() < bound.max(0.02), "{k} {run_length} {h} {found}");
            }
        }
        // One a minute: `docs/theory/friction.md#cumulative-sum`.
        for (rate, k, h) in [(1e3, 0.5, 9.15), (1e3, 1.0, 4.71), (1e4, 0.5, 11.45), (1e2, 1.0, 3.56)] {
            let found = cusum_threshold(k, run_length_for(1.0, rate)).unwrap();
            assert!((found - h).abs() < 0.01, "{found} {h}");
        }
        for bad in [0.0, 3.0, f64::NAN] {
            assert!(cusum_threshold(bad, 1e3).is_err());
        }
        assert!(cusum_threshold(0.5, f64::INFINITY).is_err() && cusum_threshold(0.5, 1.0).is_err());
    }

    #[test]
    fn likelihood_ratio_run_lengths_match_simulation() {
        let mut rng = rand_pcg::Pcg64Mcg::seed_from_u64(1);
        for (window, threshold) in [(16, 6.0), (64, 6.0), (64, 7.0)] {
            let mut ratio = crate::LikelihoodRatio::<f64, 64>::with_window(window, threshold).unwrap();
            let (mut total, mut alarms) = (0.0, 0.0);
            while alarms < 400.0 {
                total += 1.0;
                if ratio.add(StandardNormal.sample(&mut rng)) {
                    alarms += 1.0;
                    ratio.reset();
                }
            }
            let (simulated, told) = (total / alarms, likelihood_ratio_run_length(window, threshold));
            println!("window {window} threshold {threshold}: simulated {simulated:.0}, told {told:.0}");
            // Sampling error 5 %, and the approximation itself.
            assert!((told / simulated - 1.0).abs() < 0.25, "{simulated} {told}");
            let back = likelihood_ratio_threshold(window, told).unwrap();
            assert!((back - threshold).abs() < 1e-6);
        }
        assert!(likelihood_ratio_threshold(1, 1e5).is_err());
        assert!(likelihood_ratio_threshold(64, f64::NAN).is_err());
    }
}
