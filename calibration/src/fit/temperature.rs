//! Drift of zero and gain with temperature.

use nalgebra::{DMatrix, DVector};

use super::regression::check;
use super::{FitError, least_squares};
use crate::file::Temperature;

/// A sensor whose readings drift: `v = zero + z₁ΔT + z₂ΔT² + (1 + αΔT) · C · load`, each gauge with
/// coefficients of its own (`docs/theory/calibration.md#temperature`).
///
/// ```
/// use fingertip_calibration::fit::{TemperatureFit, fit_temperature};
/// use fingertip_calibration::nalgebra::DMatrix;
///
/// // From 20 °C to 41 °C, without load and with the nominal one: 2 V, a zero of 0.1 V that drifts by 1 mV/K, and 2 ‰/K
/// // of gain.
/// let celsius: Vec<f64> = (0..8).map(|i| 20.0 + 3.0 * f64::from(i)).collect();
/// let loads = DMatrix::from_fn(8, 1, |i, _| (i % 2) as f64);
/// let volts = DMatrix::from_fn(8, 1, |i, _| {
///     let warmer = celsius[i] - 20.0;
///     0.1 + 1e-3 * warmer + (1.0 + 2e-3 * warmer) * 2.0 * loads[i]
/// });
/// let fit: TemperatureFit = fit_temperature(&loads, &volts, None, &celsius, 20.0)?;
/// assert!((fit.matrix[0] - 2.0).abs() < 1e-9 && (fit.zero[0] - 0.1).abs() < 1e-9);
/// assert!((fit.temperature.zero_drift[0] - 1e-3).abs() < 1e-9);
/// assert!((fit.temperature.gain_drift[0] - 2e-3).abs() < 1e-9);
/// # Ok::<(), fingertip_calibration::fit::FitError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct TemperatureFit {
    /// The matrix at the reference temperature, gauges × regressors.
    pub matrix: DMatrix<f64>,
    /// The readings without load at the reference temperature.
    pub zero: DVector<f64>,
    /// The drift.
    pub temperature: Temperature,
    /// Standard deviation of the residuals of each gauge.
    pub residual_deviation: DVector<f64>,
    /// Covariance of what was fitted to each gauge: its row of the matrix, its zero, drift and curvature
    /// of the zero, drift of the gain.
    pub covariances: Vec<DMatrix<f64>>,
}

const MOST_ITERATIONS: usize = 100;

/// Fits matrix, zero and drift together to loads (samples × regressors, such as nominal loads) and
/// signals (samples × gauges) at known temperatures, weighted as in [`least_squares`].
///
/// The gain drift makes the problem bilinear; it is solved by Gauss-Newton from α = 0, each step a least-squares
/// problem. A soak without load determines the drift of the zero, loads at two temperatures that of
/// the gain.
///
/// # Errors
/// [`FitError::Unobserved`] if the temperature hardly varies or loads are missing,
/// [`FitError::NoConvergence`], [`FitError::BadInput`].
pub fn fit_temperature(
    loads: &DMatrix<f64>,
    signals: &DMatrix<f64>,
    weights: Option<&[f64]>,
    celsius: &[f64],
    reference_celsius: f64,
) -> Result<TemperatureFit, FitError> {
    check(loads, signals, weights)?;
    let (samples, k) = loads.shape();
    let gauges = signals.ncols();
    if celsius.len() != samples || celsius.iter().any(|t| !t.is_finite()) || !reference_celsius.is_finite() {
        return Err(FitError::BadInput { what: "the list of temperatures" });
    }
    let difference: Vec<f64> = celsius.iter().map(|t| t - reference_celsius).collect();
    let mut result = unfitted(gauges, k, celsius, reference_celsius);
    let mut design = DMatrix::zeros(samples, k + 3);
    for i in 0..samples {
        design[(i, k)] = 1.0;
        design[(i, k + 1)] = difference[i];
        design[(i, k + 2)] = difference[i] * difference[i];
    }
    for gauge in 0..gauges {
        let response = signals.columns(gauge, 1).into_owned();
        let mut gain = 0.0;
        let mut matrix = DVector::zeros(k);
        let mut settled = false;
        let mut covariance = DMatrix::zeros(0, 0);
        for iteration in 0..MOST_ITERATIONS {
            for i in 0..samples {
                for j in 0..k {
                    design[(i, j)] = loads[(i, j)] * (1.0 + gain * difference[i]);
                }
            }
            let fit = if iteration == 0 {
                least_squares(&design, &response, weights)?
            } else {
                // One more column: the derivative by α.
                let slope =
                    DVector::from_fn(samples, |i, _| difference[i] * loads.row(i).transpose().dot(&matrix));
                let mut extended = design.clone().insert_column(k + 3, 0.0);
                extended.set_column(k + 3, &slope);
                least_squares(&extended, &response, weights)?
            };
            matrix = fit.coefficients.view((0, 0), (k, 1)).column(0).into_owned();
            let step = if iteration == 0 { 0.0 } else { fit.coefficients[(k + 3, 0)] };
            gain += step;
            result.zero[gauge] = fit.coefficients[(k, 0)];
            result.temperature.zero_drift[gauge] = fit.coefficients[(k + 1, 0)];
            result.temperature.zero_curvature[gauge] = fit.coefficients[(k + 2, 0)];
            result.residual_deviation[gauge] = fit.residual_covariance[(0, 0)].sqrt();
            covariance = fit.inverse_gram * fit.residual_covariance[(0, 0)];
            let span = difference.iter().fold(0.0_f64, |most, t| most.max(t.abs()));
            if iteration > 0 && (step * span).abs() < 1e-13 {
                settled = true;
                break;
            }
            if !(gain * span).is_finite() {
                break;
            }
        }
        if !settled {
            return Err(FitError::NoConvergence { iterations: MOST_ITERATIONS, change: gain });
        }
        result.matrix.set_row(gauge, &matrix.transpose());
        result.temperature.gain_drift[gauge] = gain;
        result.covariances.push(covariance);
    }
    Ok(result)
}

/// Room for what is to be fitted.
fn unfitted(gauges: usize, k: usize, celsius: &[f64], reference_celsius: f64) -> TemperatureFit {
    TemperatureFit {
        matrix: DMatrix::zeros(gauges, k),
        zero: DVector::zeros(gauges),
        temperature: Temperature {
            reference_celsius,
            range_celsius: [
                celsius.iter().fold(reference_celsius, |least, t| least.min(*t)),
                celsius.iter().fold(reference_celsius, |most, t| most.max(*t)),
            ],
            zero_drift: vec![0.0; gauges],
            zero_curvature: vec![0.0; gauges],
            gain_drift: vec![0.0; gauges],
        },
        residual_deviation: DVector::zeros(gauges),
        covariances: Vec::with_capacity(gauges),
    }
}

#[cfg(test)]
mod tests {
    use super::fit_temperature;
    use crate::fit::FitError;
    use crate::fit::testing::{gaussian, gaussian_matrix, sensor};
    use crate::testing::Largest as _;
    use nalgebra::{DMatrix, DVector};
    use rand::SeedableRng as _;

    /// Loads, signals, temperatures, matrix, gain drift.
    type Made = (DMatrix<f64>, DMatrix<f64>, Vec<f64>, DMatrix<f64>, DVector<f64>);

    fn made(noise: f64) -> Made {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(3);
        let matrix = sensor(&mut random, 7, 6);
        let loads = gaussian_matrix(&mut random, 60, 6);
        let celsius: Vec<f64> = (0..60).map(|i| 15.0 + 20.0 * f64::from(i) / 60.0).collect();
        let gain = DVector::from_fn(7, |i, _| 1e-3 * (i as f64 - 3.0));
        let signals = DMatrix::from_fn(60, 7, |i, j| {
            let t = celsius[i] - 22.0;
            0.3 + 0.01 * t - 1e-4 * t * t
                + (1.0 + gain[j] * t) * (matrix.row(j) * loads.row(i).transpose())[(0, 0)]
                + noise * gaussian(&mut random)
        });
        (loads, signals, celsius, matrix, gain)
    }

    #[test]
    fn exact_without_noise() {
        let (loads, signals, celsius, matrix, gain) = made(0.0);
        let fit = fit_temperature(&loads, &signals, None, &celsius, 22.0).unwrap();
        assert!((fit.matrix - matrix).largest() < 1e-12);
        assert!((DVector::from_vec(fit.temperature.gain_drift) - gain).largest() < 1e-13);
        assert!(fit.temperature.zero_drift.iter().all(|z| (z - 0.01).abs() < 1e-13));
        assert!(fit.temperature.zero_curvature.iter().all(|z| (z + 1e-4).abs() < 1e-14));
        assert!(fit.zero.iter().all(|z| (z - 0.3).abs() < 1e-12));
    }

    #[test]
    fn noise_is_estimated_and_constant_temperature_refused() {
        let (loads, signals, celsius, ..) = made(0.01);
        let fit = fit_temperature(&loads, &signals, None, &celsius, 22.0).unwrap();
        assert!(fit.residual_deviation.iter().all(|s| (s / 0.01 - 1.0).abs() < 0.4));
        let error = fit_temperature(&loads, &signals, None, &[20.0; 60], 22.0).unwrap_err();
        assert!(matches!(error, FitError::Unobserved(_)));
    }
}
