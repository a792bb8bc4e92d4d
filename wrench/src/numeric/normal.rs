//! The normal distribution.

/// Φ: the share of a standard normal variable below `x`.
#[must_use]
pub fn normal_distribution(x: f64) -> f64 {
    0.5 * libm::erfc(-x * core::f64::consts::FRAC_1_SQRT_2)
}

/// The inverse of Φ; ±infinity at 0 and 1 and beyond, 0 for NaN. Newton on the logarithm of the
/// lower tail, which is concave, so that it converges from any start on its left.
#[must_use]
pub fn normal_quantile(probability: f64) -> f64 {
    if probability.is_nan() {
        return 0.0;
    }
    if probability <= 0.0 {
        return f64::NEG_INFINITY;
    }
    if probability >= 1.0 {
        return f64::INFINITY;
    }
    if probability > 0.5 {
        return -normal_quantile(1.0 - probability);
    }
    let target = libm::log(probability);
    // The tail's leading term is on the left of the root for every probability up to a half.
    let mut x = -libm::sqrt(-2.0 * target);
    for _ in 0..60 {
        let below = normal_distribution(x);
        let density = libm::exp(-0.5 * x * x) / libm::sqrt(core::f64::consts::TAU);
        let step = (libm::log(below) - target) * below / density;
        if !step.is_finite() {
            break;
        }
        x -= step;
        if step.abs() <= 4.0 * f64::EPSILON * x.abs() {
            break;
        }
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Computed with 40 digits from the error function.
    #[test]
    fn quantiles_are_right_in_both_tails() {
        for (tail, expected) in [
            (0.5, 0.0),
            (0.45, 0.125_661_346_855_074),
            (0.4, 0.253_347_103_135_799_8),
            (0.3, 0.524_400_512_708_040_8),
            (0.2, 0.841_621_233_572_914_2),
            (0.1, 1.281_551_565_544_6),
            (0.05, 1.644_853_626_951_473),
            (0.03, 1.880_793_608_151_251),
            (0.025, 1.959_963_984_540_054),
            (0.0242, 1.973_839_463_313_199),
            (0.01, 2.326_347_874_040_841),
            (1e-3, 3.090_232_306_167_814),
            (1e-4, 3.719_016_485_455_681),
            (1e-6, 4.753_424_308_822_899),
            (1e-8, 5.612_001_244_174_789),
            (1e-10, 6.361_340_902_404_056),
            (1e-15, 7.941_345_326_170_997),
        ] {
            let found = normal_quantile(tail);
            assert!((found + expected).abs() <= 1e-16 + 1e-14 * expected, "{tail}: {found}");
            // The other tail, as far as 1 − tail holds it.
            let known = 1e-14 * expected + 1e-15 / tail;
            assert!((normal_quantile(1.0 - tail) - expected).abs() <= known, "1 - {tail}");
        }
        // The far tail by the distribution itself.
        for exponent in [-10.0, -50.0, -300.0] {
            let p = 10.0_f64.powf(exponent);
            assert!((normal_distribution(normal_quantile(p)) / p - 1.0).abs() < 1e-10);
        }
        assert_eq!(normal_quantile(f64::NAN), 0.0);
        assert_eq!(normal_quantile(0.0), f64::NEG_INFINITY);
        assert_eq!(normal_quantile(2.0), f64::INFINITY);
    }
}
