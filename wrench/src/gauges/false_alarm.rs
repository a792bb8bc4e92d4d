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

    #[test]
    fn normal_quantiles_of_the_tables() {
        for (tail, expected) in [
            (0.5, 0.0),
            (0.158_655_253_931_457, 1.0),
            (0.025, 1.959_963_984_540_054),
            (0.001_349_898_031_630_094_6, 3.0),
            (2.866_515_718_791_939e-7, 5.0),
            (9.865_876_450_376_98e-10, 6.0),
        ] {
            assert!((normal_quantile(tail) - expected).abs() < 5e-8 * (1.0 + expected));
            assert!((normal_quantile(1.0 - tail) + expected).abs() < 1e-6 * (1.0 + expected));
        }
    }

    #[test]
    fn student_quantiles_of_the_tables() {
        for (tail, degrees, expected) in [
            (0.025, 30.0, 2.042_272_456),
            (0.005, 30.0, 2.749_995_654),
            (0.0005, 30.0, 3.645_958_635),
            (0.0005, 60.0, 3.460_200_469),
            (0.025, 120.0, 1.979_930_405),
        ] {
            assert!((student_quantile(tail, degrees) - expected).abs() < 2e-5 * expected);
        }
    }
}
