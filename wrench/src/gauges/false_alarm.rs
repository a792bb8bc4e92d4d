//! Thresholds from a false-alarm rate.

/// The standard normal deviation that is exceeded, to one side, with probability `tail` in
/// (0, 1): Acklam's rational approximation, relative error below 1.2e-9.
pub(crate) fn normal_quantile(tail: f64) -> f64 {
    const A: [f64; 6] = [
        -3.969683028665376e1,
        2.209460984245205e2,
        -2.759285104469687e2,
        1.383_577_518_672_69e2,
        -3.066479806614716e1,
        2.506628277459239,
    ];
    const B: [f64; 5] = [
        -5.447609879822406e1,
        1.615858368580409e2,
        -1.556989798598866e2,
        6.680131188771972e1,
        -1.328068155288572e1,
    ];
    const C: [f64; 6] = [
        -7.784894002430293e-3,
        -3.223964580411365e-1,
        -2.400758277161838,
        -2.549732539343734,
        4.374664141464968,
        2.938163982698783,
    ];
    const D: [f64; 4] = [7.784695709041462e-3, 3.224671290700398e-1, 2.445134137142996, 3.754408661907416];
    let polynomial = |coefficients: &[f64], x: f64| coefficients.iter().fold(0.0, |sum, c| sum * x + c);
    if tail > 0.5 {
        return -normal_quantile(1.0 - tail);
    }
    if tail < 0.02425 {
        let q = nalgebra::ComplexField::sqrt(-2.0 * nalgebra::ComplexField::ln(tail));
        -polynomial(&C, q) / (polynomial(&D, q) * q + 1.0)
    } else {
        let q = 0.5 - tail;
        let r = q * q;
        polynomial(&A, r) * q / (polynomial(&B, r) * r + 1.0)
    }
}

/// The same of Student's t with many degrees of freedom (Cornish–Fisher expansion, Abramowitz &
/// Stegun 26.7.5): to 1 % of itself for 30 degrees and tails down to 1e-7.
pub(crate) fn student_quantile(tail: f64, degrees: f64) -> f64 {
    let z = normal_quantile(tail);
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
    use super::*;

    /// Computed with 40 digits from the error function.
    #[test]
    fn normal_quantiles_are_right_in_both_tails() {
        for (tail, expected) in [
            (0.5, 0.0),
            (0.45, 0.125_661_346_855_074),
            (0.4, 0.253_347_103_135_799_8),
            (0.3, 0.524_400_512_708_040_8),
            (0.2, 0.841_621_233_572_914_2),
            (0.1, 1.281_551_565_544_6),
            (0.05, 1.644_853_626_951_473),
            (0.03, 1.880_793_608_151_251),
            (0.0242, 1.973_839_463_313_199),
            (0.01, 2.326_347_874_040_841),
            (1e-3, 3.090_232_306_167_814),
            (1e-4, 3.719_016_485_455_681),
            (1e-6, 4.753_424_308_822_899),
            (1e-8, 5.612_001_244_174_789),
            (1e-10, 6.361_340_902_404_056),
            (1e-15, 7.941_345_326_170_997),
        ] {
            // Acklam states 1.15e-9 of the quantile.
            assert!((normal_quantile(tail) - expected).abs() <= 1.2e-9 * expected, "{tail}");
            // The other tail, as far as 1 − tail holds it.
            let known = 1.2e-9 * expected + 1e-15 / tail;
            assert!((normal_quantile(1.0 - tail) + expected).abs() <= known, "1 - {tail}");
        }
    }

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
            let found = student_quantile(tail, degrees);
            assert!((found / expected - 1.0).abs() <= error, "{tail} {degrees}: {}", found / expected - 1.0);
        }
    }
}
