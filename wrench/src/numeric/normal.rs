//! The normal distribution.

/// Φ: the share of a standard normal variable below `x`.
#[must_use]
pub(crate) fn normal_distribution(x: f64) -> f64 {
    0.5 * libm::erfc(-x * core::f64::consts::FRAC_1_SQRT_2)
}

/// The inverse of Φ; ±infinity at 0 and 1 and beyond, 0 for NaN. Newton on the logarithm of the
/// lower tail, which is concave, so that it converges from any start on its left.
#[must_use]
pub(crate) fn normal_quantile(probability: f64) -> f64 {
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

    #[test]
    fn quantiles_match_tables() {
        // Abramowitz & Stegun 26.2, and the far tail by the distribution itself.
        for (p, z) in [(0.5, 0.0), (0.025, -1.959_963_984_540_054), (1e-3, -3.090_232_306_167_813)] {
            assert!((normal_quantile(p) - z).abs() < 1e-13, "{p}");
            assert!((normal_quantile(1.0 - p) + z).abs() < 1e-12);
        }
        for exponent in [-10.0, -50.0, -300.0] {
            let p = 10.0_f64.powf(exponent);
            assert!((normal_distribution(normal_quantile(p)) / p - 1.0).abs() < 1e-10);
        }
        assert_eq!(normal_quantile(f64::NAN), 0.0);
        assert_eq!(normal_quantile(0.0), f64::NEG_INFINITY);
        assert_eq!(normal_quantile(2.0), f64::INFINITY);
    }
}
