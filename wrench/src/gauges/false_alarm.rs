//! Thresholds from a false-alarm rate.

use crate::numeric::normal::normal_quantile;

/// The standard normal deviation that is exceeded, to one side, with probability `tail`.
pub(crate) fn normal_threshold(tail: f64) -> f64 {
    -normal_quantile(tail)
}

/// The same of Student's t with many degrees of freedom (Cornish–Fisher expansion, Abramowitz &
/// Stegun 26.7.5): to 1 % of itself for 30 degrees and tails down to 1e-7.
pub(crate) fn student_threshold(tail: f64, degrees: f64) -> f64 {
    let z = normal_threshold(tail);
    let s = z * z;
    let terms = [
        z * (s + 1.0) / 4.0,
        z * ((5.0 * s + 16.0) * s + 3.0) / 96.0,
        z * (((3.0 * s + 19.0) * s + 17.0) * s - 15.0) / 384.0,
        z * ((((79.0 * s + 776.0) * s + 1482.0) * s - 1920.0) * s - 945.0) / 92160.0,
    ];
    let series = terms.iter().rev().fold(0.0, |sum, term| (sum + term) / degrees);
    z + series
}

#[cfg(test)]
mod tests {
    use super::student_threshold;

    /// Computed with 40 digits from the incomplete beta function.
    #[test]
    fn student_quantiles_are_right_from_thirty_degrees_on() {
        for (tail, degrees, expected, error) in [
            (0.4, 30.0, 0.255_605_364_951_912_8, 1e-8),
            (0.1, 30.0, 1.310_415_025_391_396, 1e-7),
            (0.01, 30.0, 2.457_261_542_400_591, 1e-6),
            (1e-4, 30.0, 4.233_985_957_272_021, 1e-4),
            (1e-6, 30.0, 5.871_117_120_418_883, 3e-3),
            (1e-4, 60.0, 3.962_089_364_705_941, 4e-6),
            (1e-6, 60.0, 5.263_554_854_652_545, 1e-4),
            (0.05, 200.0, 1.652_508_100_910_878, 1e-8),
            (1e-7, 200.0, 5.387_193_370_779_757, 2e-6),
            (0.025, 1000.0, 1.962_339_080_826_408, 2e-9),
            (1e-7, 1000.0, 5.235_998_469_292_347, 2e-9),
        ] {
            let found = student_threshold(tail, degrees);
            assert!((found / expected - 1.0).abs() <= error, "{tail} {degrees}: {}", found / expected - 1.0);
        }
    }
}
