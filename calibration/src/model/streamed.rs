//! Least squares of a table that does not fit into memory.

use nalgebra::DMatrix;

use super::{CalibrationError, Direction, SensorModel};
use crate::Axis;
use crate::curve::Terms;
use crate::file::SignalUnit;
use crate::fit::{Fit, FitError};
use crate::linear::Triangular;

/// Gathers samples one by one, in memory that does not grow with them, for a least-squares fit of
/// signals on loads: the same as [`calibrate`](crate::calibrate) finds by that method, without what needs
/// all samples at once (outliers, leaving out, plots).
///
/// ```
/// use fingertip_calibration::Axis;
/// use fingertip_calibration::file::SignalUnit;
/// use fingertip_calibration::model::StreamedFit;
///
/// let mut fit = StreamedFit::new(&[Axis::Fz], 1, SignalUnit::Volt, true);
/// for i in 0..1000 {
///     let load = f64::from(i % 11);
///     fit.push(&[load], &[0.5 + 0.2 * load], 1.0);
/// }
/// let (matrix, zero) = fit.finish(None)?.matrix_and_zero()?;
/// // Normalised by the greatest load, 10 N.
/// assert!((matrix[(0, 0)] - 2.0).abs() < 1e-12 && (zero[0] - 0.5).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct StreamedFit {
    axes: Vec<Axis>,
    gauges: usize,
    signal_unit: SignalUnit,
    bias: bool,
    triangular: Triangular,
    greatest: Vec<f64>,
    regressors: Vec<f64>,
}

impl StreamedFit {
    /// For a sensor with these axes and this number of gauges.
    #[must_use]
    pub fn new(axes: &[Axis], gauges: usize, signal_unit: SignalUnit, bias: bool) -> Self {
        let regressors = axes.len() + usize::from(bias);
        Self {
            axes: axes.to_vec(),
            gauges,
            signal_unit,
            bias,
            triangular: Triangular::new(regressors, gauges),
            greatest: vec![0.0; axes.len()],
            regressors: vec![1.0; regressors],
        }
    }

    /// Takes one sample: load \[N, N·m\], readings, weight. `false`, and it is left out and counted, if a
    /// number is not finite or a length is wrong.
    pub fn push(&mut self, load: &[f64], signals: &[f64], weight: f64) -> bool {
        if load.len() != self.axes.len() {
            return false;
        }
        self.regressors[..load.len()].copy_from_slice(load);
        let taken = self.triangular.push_weighted(&self.regressors, signals, weight);
        if taken {
            for (greatest, load) in self.greatest.iter_mut().zip(load) {
                *greatest = greatest.max(load.abs());
            }
        }
        taken
    }

    /// How many samples were taken.
    #[must_use]
    pub const fn samples(&self) -> u64 {
        self.triangular.samples()
    }

    /// The fitted sensor; full scale is the greatest loads if not given.
    ///
    /// # Errors
    /// [`CalibrationError::Fit`] with the unobserved directions, or too few samples;
    /// [`CalibrationError::BadOption`] for a full scale that is not positive and finite.
    pub fn finish(mut self, full_scale: Option<&[f64]>) -> Result<SensorModel, CalibrationError> {
        let axes = self.axes.len();
        let nominal: Vec<f64> = match full_scale {
            Some(list) if list.len() == axes && list.iter().all(|x| *x > 0.0 && x.is_finite()) => {
                list.to_vec()
            }
            Some(_) => {
                let message = format!("one positive load for each of the {axes} axes is needed");
                return Err(CalibrationError::BadOption { option: "nominal", message });
            }
            None => self.greatest.iter().map(|x| if *x > 0.0 { *x } else { 1.0 }).collect(),
        };
        let factors = self.triangular.factors();
        let unobserved = |mut unobserved: crate::linear::Unobserved| {
            unobserved.names = self.axes.iter().map(ToString::to_string).collect();
            unobserved.names.extend(self.bias.then(|| "constant".to_owned()));
            CalibrationError::from(FitError::Unobserved(unobserved))
        };
        let mut coefficients = factors.coefficients().map_err(unobserved)?;
        let mut inverse_gram = factors.inverse_gram().map_err(unobserved)?;
        // From loads in SI to nominal loads.
        for (i, size) in nominal.iter().enumerate() {
            coefficients.row_mut(i).scale_mut(*size);
            inverse_gram.row_mut(i).scale_mut(*size);
            inverse_gram.column_mut(i).scale_mut(*size);
        }
        let coefficient_count = axes + usize::from(self.bias);
        let residual_covariance = factors.residual_covariance().ok_or(FitError::TooFewSamples {
            samples: usize::try_from(factors.samples).unwrap_or(usize::MAX),
            coefficients: coefficient_count,
        })?;
        Ok(SensorModel {
            axes: self.axes,
            nominal,
            signal_unit: self.signal_unit,
            direction: Direction::SignalsFromLoads,
            bias: self.bias,
            terms: Terms::default(),
            origin: vec![0.0; self.gauges],
            fit: Fit {
                coefficients,
                inverse_gram,
                residual_covariance,
                full_covariance: None,
                freedom: factors.samples as f64 - coefficient_count as f64,
                trust: DMatrix::zeros(0, self.gauges),
                iterations: 1,
            },
        })
    }
}

#[cfg(test)]
mod tests {
    use super::StreamedFit;
    use crate::Axis;
    use crate::calibrate;
    use crate::file::SignalUnit;
    use crate::fit::testing::{gaussian_matrix, sensor};
    use crate::loads::LoadTable;
    use crate::model::{CalibrationError, Options};
    use crate::testing::Largest as _;
    use rand::SeedableRng as _;

    #[test]
    fn streamed_is_the_same_as_all_at_once() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(41);
        let loads = gaussian_matrix(&mut random, 300, 6);
        let signals = &loads * sensor(&mut random, 6, 8) + gaussian_matrix(&mut random, 300, 8) * 0.01;
        let mut fit = StreamedFit::new(&Axis::ALL, 8, SignalUnit::Volt, true);
        for i in 0..300 {
            let row = |m: &nalgebra::DMatrix<f64>| m.row(i).iter().copied().collect::<Vec<_>>();
            assert!(fit.push(&row(&loads), &row(&signals), 1.0));
        }
        assert!(!fit.push(&[f64::NAN; 6], &[0.0; 8], 1.0) && !fit.push(&[0.0; 5], &[0.0; 8], 1.0));
        assert_eq!(fit.samples(), 300);
        let table = LoadTable::new(&Axis::ALL, loads, signals, SignalUnit::Volt).unwrap();
        let whole = calibrate(&table, &Options::default()).unwrap().model;
        let streamed = fit.clone().finish(None).unwrap();
        assert_eq!(streamed.nominal, whole.nominal);
        assert!((&streamed.fit.coefficients - &whole.fit.coefficients).largest() < 1e-12);
        assert!((&streamed.fit.inverse_gram - &whole.fit.inverse_gram).largest() < 1e-13);
        assert!((&streamed.fit.residual_covariance - &whole.fit.residual_covariance).largest() < 1e-15);
        assert!(matches!(fit.finish(Some(&[1.0; 5])), Err(CalibrationError::BadOption { .. })));
        let mut blind = StreamedFit::new(&[Axis::Fx, Axis::Fz], 2, SignalUnit::Volt, true);
        (0..9).for_each(|i| assert!(blind.push(&[f64::from(i), 0.0], &[f64::from(i), 1.0], 1.0)));
        assert!(blind.finish(None).unwrap_err().to_string().contains("Fz"));
    }
}
