//! What a drift that was fitted to the same readings does to the covariance of a fit.

use nalgebra::DMatrix;

use super::sensor_model::{design, normalised};
use super::{Direction, Options, SensorModel};
use crate::fit::{FitError, TemperatureFit, fit_temperature, least_squares};
use crate::loads::LoadTable;

/// A drift that was fitted to the readings of a table, and how uncertain it is.
#[derive(Clone, Debug)]
pub(crate) struct FittedDrift {
    fit: TemperatureFit,
    /// Covariances of the three coefficients of two gauges (slope and curvature of the zero, slope of the gain) in
    /// units of the covariance of these gauges' noise: gauge by gauge, of each with all others.
    of_pairs: Vec<DMatrix<f64>>,
}

/// Coefficients of the drift of a gauge.
const TERMS: usize = 3;

/// Readings by the coefficients of one gauge's drift: `ΔT, ΔT², ΔT · Cᵀload`, over the gain there.
fn slopes(loads: &DMatrix<f64>, celsius: &[f64], drift: &TemperatureFit, gauge: usize) -> DMatrix<f64> {
    let gain = drift.temperature.gain_drift[gauge];
    DMatrix::from_fn(loads.nrows(), TERMS, |i, term| {
        let warmer = celsius[i] - drift.temperature.reference_celsius;
        let by = match term {
            0 => warmer,
            1 => warmer * warmer,
            _ => warmer * loads.row(i).dot(&drift.matrix.row(gauge)),
        };
        by / (1.0 + gain * warmer)
    })
}

impl FittedDrift {
    /// Fits the drift of a table with temperatures, which its rows have (`celsius`), about a reference \[°C\].
    ///
    /// The coefficients are `(J⊥ᵀWJ⊥)⁻¹J⊥ᵀW` times the readings, with `J⊥` what the loads and the constant leave of the
    /// [`slopes`] (Frisch & Waugh 1933).
    ///
    /// # Errors
    /// As [`fit_temperature`].
    pub(crate) fn new(
        table: &LoadTable,
        nominal: &[f64],
        celsius: &[f64],
        reference: f64,
    ) -> Result<Self, FitError> {
        let loads = &normalised(&table.loads, nominal);
        let weights = table.weights.as_deref();
        let fit = fit_temperature(loads, &table.signals, weights, celsius, reference)?;
        let (samples, axes) = loads.shape();
        let known = loads.clone().insert_column(axes, 1.0);
        let (mut left, mut inverses) = (Vec::new(), Vec::new());
        for gauge in 0..fit.matrix.nrows() {
            let slopes = slopes(loads, celsius, &fit, gauge);
            let taken_up = least_squares(&known, &slopes, weights)?.coefficients;
            let mut across = slopes - &known * taken_up;
            for (i, mut row) in across.row_iter_mut().enumerate() {
                row *= weights.map_or(1.0, |weights| weights[i]).sqrt();
            }
            // The Gram matrix alone is wanted, whatever the responses.
            let none = DMatrix::zeros(samples, 1);
            inverses.push(least_squares(&across, &none, None)?.inverse_gram);
            left.push(across);
        }
        let pair = |a: usize, b: usize| &inverses[a] * left[a].tr_mul(&left[b]) * &inverses[b];
        let gauges = left.len();
        let of_pairs = (0..gauges)
            .map(|a| {
                let mut row = DMatrix::zeros(TERMS, TERMS * gauges);
                (0..gauges).for_each(|b| row.columns_mut(TERMS * b, TERMS).copy_from(&pair(a, b)));
                row
            })
            .collect();
        Ok(Self { fit, of_pairs })
    }

    /// What was fitted.
    pub(crate) const fn fit(&self) -> &TemperatureFit {
        &self.fit
    }

    /// Adds what the drift's own error does to a fit of signals on loads: with `K = GXᵀWJ`, by how much the fit would
    /// change with the coefficients, `K Cov K'ᵀ` for each pair of gauges. The errors of the drift and of a fit that knew it
    /// are independent, since the former come from what is orthogonal to all loads.
    ///
    /// A fit of loads on signals is left as it is.
    ///
    /// # Errors
    /// As [`least_squares`].
    pub(crate) fn account(
        &self,
        table: &LoadTable,
        options: &Options,
        model: &mut SensorModel,
    ) -> Result<(), FitError> {
        let forward = options.direction == Direction::SignalsFromLoads;
        let Some(celsius) = table.temperatures.as_ref().filter(|_| forward) else { return Ok(()) };
        let design = &design(table, options, &model.nominal);
        let loads = normalised(&table.loads, &model.nominal);
        let weights = table.weights.as_deref();
        let fit = &mut model.fit;
        let (k, gauges) = fit.coefficients.shape();
        let before = fit.freedom;
        if before > TERMS as f64 {
            fit.freedom -= TERMS as f64;
            let scale = before / fit.freedom;
            fit.residual_covariance *= scale;
            if let Some(full) = &mut fit.full_covariance {
                *full *= scale;
            }
        }
        let mut full = match fit.full_covariance.take() {
            Some(full) => full,
            None => fit.residual_covariance.kronecker(&fit.inverse_gram),
        };
        let mut pulls = Vec::with_capacity(gauges);
        for gauge in 0..gauges {
            pulls.push(
                least_squares(design, &slopes(&loads, celsius, &self.fit, gauge), weights)?.coefficients,
            );
        }
        for (a, b) in (0..gauges).flat_map(|a| (0..gauges).map(move |b| (a, b))) {
            let of_pair = self.of_pairs[a].columns(TERMS * b, TERMS) * fit.residual_covariance[(a, b)];
            let mut block = full.view_mut((a * k, b * k), (k, k));
            block += &pulls[a] * of_pair * pulls[b].transpose();
        }
        fit.full_covariance = Some(full);
        Ok(())
    }
}
