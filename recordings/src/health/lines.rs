//! Lines of a spectrum, and where they come from.

use super::spectrum::Spectra;

/// A frequency at which a channel swings.
///
/// ```
/// use fingertip_recordings::health::{Depth, HealthWatch, Kind, WatchedChannel};
///
/// let mut watch = HealthWatch::new(vec![WatchedChannel::new("v1", "V", Kind::Signal)], Depth::Full);
/// for i in 0..20_000_u32 {
///     let noise = f64::from(i.wrapping_mul(2_654_435_769) >> 16) / 65_536.0 - 0.5;
///     // The mains, 20 mV from peak to peak.
///     let hum = 0.01 * (std::f64::consts::TAU * 50.0 * f64::from(i) * 1e-3).sin();
///     watch.add(Some(f64::from(i) * 1e-3), &[0.01 * noise + hum]);
/// }
/// let health = watch.finish();
/// let line = &health.channels[0].lines[0];
/// assert!((line.frequency - 50.0).abs() < 0.1 && (line.rms - 0.01 / 2.0_f64.sqrt()).abs() < 1e-4);
/// assert_eq!(line.name, "mains, 50 Hz");
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct SpectralLine {
    /// \[Hz\]
    pub frequency: f64,
    /// Root mean square of the swing, in the unit of the channel.
    pub rms: f64,
    /// What is known of this frequency, such as `mains, 50 Hz`; empty if nothing is.
    pub name: String,
}

/// Bins to each side of which the power around a line is the median.
const AROUND: usize = 24;
/// Bins to each side that von Hann's window spreads a line over.
const SPREAD: usize = 2;
/// Normal deviations that a bin must stand out by: once in 10⁹ bins.
const DEVIATIONS: f64 = 6.0;
/// The median of so few bins is uncertain itself.
const UNCERTAIN: f64 = 1.4;
/// Most lines that are listed.
const MOST: usize = 12;

/// The lines of a mean periodogram of so many stretches, strongest first; `rate` is in samples a second.
pub(super) fn find(powers: &[f64], stretches: u32, rate: f64) -> Vec<SpectralLine> {
    // Stretches that overlap by half are not independent.
    let independent = (0.55 * f64::from(stretches)).max(1.0);
    // Quantiles of χ² over its mean, by Wilson & Hilferty's cube.
    let ninth = 1.0 / (9.0 * independent);
    let quantile = |deviations: f64| (1.0 - ninth + deviations * ninth.sqrt()).powi(3);
    let threshold = UNCERTAIN * quantile(DEVIATIONS) / quantile(0.0);
    let width = rate / Spectra::LENGTH as f64;
    let mut lines = Vec::new();
    for bin in SPREAD + 1..powers.len().saturating_sub(SPREAD) {
        let at = |k: usize| powers.get(k).copied().unwrap_or(0.0);
        // Of two that are alike, as for a swing between them, the first.
        let is_peak = (bin - SPREAD..bin).all(|before| at(before) < at(bin))
            && (bin + 1..=bin + SPREAD).all(|behind| at(behind) <= at(bin));
        let floor = around(powers, bin);
        if !is_peak || !(at(bin) > threshold * floor) {
            continue;
        }
        let (mut power, mut moment) = (0.0, 0.0);
        for k in bin - SPREAD..=bin + SPREAD {
            let above = (at(k) - floor).max(0.0);
            power += above;
            moment += above * k as f64;
        }
        let frequency = moment / power * width;
        // The power is a squared unit for each sample⁻¹, of which there are one in all.
        let rms = (power / Spectra::LENGTH as f64).sqrt();
        lines.push(SpectralLine { frequency, rms, name: name(frequency, rate, width) });
    }
    lines.sort_by(|a, b| b.rms.total_cmp(&a.rms));
    lines.truncate(MOST);
    lines
}

/// The median of the bins around one, without those of a line on it.
fn around(powers: &[f64], bin: usize) -> f64 {
    let from = bin.saturating_sub(AROUND).max(1);
    let to = (bin + AROUND + 1).min(powers.len());
    let near = (from..to).filter(|k| k.abs_diff(bin) > SPREAD);
    let mut values: Vec<f64> = near.filter_map(|k| powers.get(k).copied()).collect();
    if values.is_empty() {
        return 0.0;
    }
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// Mains and their harmonics, as they appear at this rate.
fn name(frequency: f64, rate: f64, width: f64) -> String {
    let mut best: Option<(f64, String)> = None;
    for mains in [50.0, 60.0] {
        for harmonic in 1..=10_u32 {
            let exact = mains * f64::from(harmonic);
            let folded = fold(exact, rate);
            let is_folded = (folded - exact).abs() > 1e-6;
            // Mains keep to a percent, and harmonics that are folded often come to lie anywhere.
            if is_folded && harmonic > 3 {
                continue;
            }
            let (off, slack) = ((frequency - folded).abs(), 0.6 * width + 0.004 * exact);
            // What is within the slack of everything is named after nothing.
            if off <= slack && slack < 0.02 * rate && best.as_ref().is_none_or(|(least, _)| off < *least) {
                let which = if harmonic == 1 {
                    format!("mains, {mains} Hz")
                } else {
                    format!("mains, harmonic {harmonic} of {mains} Hz")
                };
                let which = if is_folded { format!("{which}, folded by the sample rate") } else { which };
                best = Some((off, which));
            }
        }
    }
    best.map_or_else(String::new, |(_, name)| name)
}

/// Where a frequency appears when it is sampled.
fn fold(frequency: f64, rate: f64) -> f64 {
    let within = frequency.rem_euclid(rate);
    within.min(rate - within)
}

#[cfg(test)]
mod tests {
    use super::super::spectrum::Spectra;
    use super::{AROUND, around, find, fold, name};
    use core::f64::consts::TAU;
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    fn lines(samples: u64, rate: f64, seed: u64, swing: impl Fn(f64) -> f64) -> Vec<super::SpectralLine> {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(seed);
        let mut spectra = Spectra::new(1);
        for i in 0..samples {
            let noise: f64 = StandardNormal.sample(&mut random);
            spectra.add(i, &[noise + swing(i as f64 / rate)]);
        }
        let mean = spectra.mean(0, 0, u64::MAX).unwrap();
        find(&mean.powers, mean.stretches, rate)
    }

    #[test]
    fn lines_are_found_with_their_size_and_name() {
        let swing =
            |t: f64| 0.5 * (TAU * 50.03 * t).sin() + 0.4 * (TAU * 150.1 * t).cos() + (TAU * 408.3 * t).sin();
        let found = lines(20_000, 1000.0, 1, swing);
        let wanted =
            [(408.3, 1.0, ""), (50.03, 0.5, "mains, 50 Hz"), (150.1, 0.4, "mains, harmonic 3 of 50 Hz")];
        assert_eq!(found.len(), 3, "{found:?}");
        for (line, (frequency, amplitude, name)) in found.iter().zip(wanted) {
            assert!((line.frequency - frequency).abs() < 0.15, "{line:?}");
            assert!((line.rms * 2_f64.sqrt() / amplitude - 1.0).abs() < 0.1, "{line:?}");
            assert_eq!(line.name, name);
        }
        // Where the rate is too low, mains fold.
        let found = lines(8000, 80.0, 2, |t| (TAU * 50.0 * t).sin());
        assert!(found.len() == 1 && (found[0].frequency - 30.0).abs() < 0.02, "{found:?}");
        assert!(found[0].name.starts_with("mains, 50 Hz, folded"), "{found:?}");
    }

    #[test]
    fn noise_has_no_lines() {
        for seed in 0..150 {
            let samples = [1100, 3000, 12_000][seed as usize % 3];
            let found = lines(samples, 1000.0, 100 + seed, |t| 0.5 * (TAU * 0.1 * t).sin());
            assert!(found.is_empty(), "{seed}: {found:?}");
        }
    }

    /// Noise of one on the most bins around a line, by two: the skirts of the line have no say in which of both it is.
    #[test]
    fn a_line_is_no_part_of_the_noise_around_it() {
        let mut powers = vec![3.0; 512];
        powers[101 - AROUND..=100].fill(1.0);
        powers[98..=102].fill(1000.0);
        assert_eq!(around(&powers, 100), 3.0);
        powers[103..105].fill(1.0);
        assert_eq!(around(&powers, 100), 1.0);
    }

    #[test]
    fn names_are_for_what_mains_are_near_to() {
        assert_eq!(name(50.3, 1000.0, 1.0), "mains, 50 Hz");
        assert_eq!(name(120.0, 1000.0, 1.0), "mains, harmonic 2 of 60 Hz");
        assert_eq!(name(53.0, 1000.0, 1.0), "");
        assert_eq!((fold(50.0, 80.0), fold(30.0, 80.0), fold(160.0, 80.0)), (30.0, 30.0, 0.0));
    }
}
