//! How sure the wrenches are that a calibration makes of readings.

use fingertip_contact::{CalibrationUncertainty, SensorUncertainty};
use fingertip_wrench::{LeastSquares, Real};
use nalgebra::{DMatrix, Matrix6, SVector};

use super::{CalibrationFile, Covariance, FileError};
use crate::Axis;

const FIELD: &str = "covariance";

/// Numbers that are none of a covariance, or deviations that are none.
fn none(field: &str, requirement: &'static str) -> FileError {
    FileError::OutOfRange { field: field.to_owned(), requirement }
}

const SYMMETRIC: &str = "symmetric and without a negative variance";

impl CalibrationFile {
    /// What the fit leaves uncertain of the wrenches that are solved by this calibration, in scalar type `T`; of one with
    /// terms of higher order, what comes nearest to it over the loads of the calibration; of a covariance that is no product, the product that comes near to it.
    /// `None` if the file has no covariance.
    ///
    /// # Errors
    /// [`FileError::NotSixAxes`] if it measures fewer components, [`FileError::Singular`] if its matrix has no inverse,
    /// [`FileError::OutOfRange`] for field `covariance` if its numbers are none of a covariance.
    pub fn uncertainty_in<T: Real>(&self) -> Result<Option<CalibrationUncertainty<T>>, FileError> {
        let Some(Covariance { signals, loads, .. }) = &self.covariance else { return Ok(None) };
        self.validate()?;
        if self.axes != Axis::ALL {
            return Err(FileError::NotSixAxes { found: self.axes.len() });
        }
        let inverse = crate::linear::pseudo_inverse(&self.matrix).ok_or(FileError::Singular)?;
        let readings = &inverse * signals * inverse.transpose();
        // Both halves, which rounding leaves apart.
        let even = |matrix: &DMatrix<f64>, i: usize, j: usize| 0.5 * (matrix[(i, j)] + matrix[(j, i)]);
        let full_scale = |i: usize, j: usize| self.nominal[i] * self.nominal[j];
        let readings = Matrix6::from_fn(|i, j| T::literal(even(&readings, i, j) * full_scale(i, j)));
        let loads = Matrix6::from_fn(|i, j| T::literal(even(loads, i, j) / full_scale(i, j)));
        CalibrationUncertainty::new(readings, loads).map(Some).map_err(|_| none(FIELD, SYMMETRIC))
    }

    /// What is uncertain of the wrenches of a sensor with `N` gauges, by the noise of its gauges and by the fit, for pipelines
    /// of types; what the file does not tell counts as certain. The residuals of the fit count as independent from gauge to
    /// gauge: see [`uncertainty_in`](Self::uncertainty_in) for the whole.
    ///
    /// # Errors
    /// As [`sensor_matrix`](Self::sensor_matrix), and [`FileError::OutOfRange`] for `noise` or `covariance` if their numbers
    /// are none of deviations or of a covariance.
    pub fn sensor_uncertainty_in<T: Real, const N: usize>(
        &self,
    ) -> Result<SensorUncertainty<T, N>, FileError> {
        let solver = LeastSquares::new(&self.sensor_matrix_in::<T, N>()?).map_err(|_| FileError::Singular)?;
        let deviation = |gauge: usize| self.noise.as_ref().and_then(|noise| noise.get(gauge)).copied();
        let noise = SVector::from_fn(|gauge, _| T::literal(deviation(gauge).unwrap_or(0.0)));
        let sensor = SensorUncertainty::independent(&solver, &noise)
            .map_err(|_| none("noise", "finite and not negative"))?;
        let Some(covariance) = &self.covariance else { return Ok(sensor) };
        let between = |gauge, i, j| covariance.between((gauge, i), (gauge, j)).unwrap_or(f64::NAN);
        let row = |gauge: usize| {
            Matrix6::from_fn(|i, j| {
                let both = 0.5 * (between(gauge, i, j) + between(gauge, j, i));
                T::literal(both / (self.nominal[i] * self.nominal[j]))
            })
        };
        sensor.with_calibration(core::array::from_fn(row)).map_err(|_| none(FIELD, SYMMETRIC))
    }
}

#[cfg(test)]
mod tests {
    use fingertip_wrench::Wrench;
    use nalgebra::{DMatrix, Vector6};

    use super::super::{CalibrationFile, Covariance, SignalUnit};

    /// Seven gauges, of which each residual is its own.
    fn file() -> CalibrationFile {
        let matrix = DMatrix::from_fn(7, 6, |i, j| if i % 6 == j { 2.0 } else { 0.1 / (1 + i + j) as f64 });
        let nominal = vec![10.0, 20.0, 30.0, 0.1, 0.2, 0.3];
        let mut file = CalibrationFile::new(matrix, nominal, vec![0.0; 7], SignalUnit::Volt).unwrap();
        file.covariance = Some(Covariance::product(
            DMatrix::from_fn(7, 7, |i, j| if i == j { 1e-6 * (1 + i) as f64 } else { 0.0 }),
            DMatrix::from_fn(6, 6, |i, j| if i == j { 0.2 } else { 0.02 }),
        ));
        file
    }

    #[test]
    fn both_forms_agree_where_residuals_are_independent() {
        let mut file = file();
        let wrench = Wrench::from_components(&Vector6::new(3.0, -5.0, 8.0, 0.02, 0.1, -0.05));
        let whole = file.uncertainty_in::<f64>().unwrap().unwrap().covariance(&wrench);
        let typed = file.sensor_uncertainty_in::<f64, 7>().unwrap().wrench_covariance(&wrench);
        assert!((whole - typed).norm() < 1e-10 * whole.norm(), "{whole} {typed}");
        // The same, written entry by entry.
        let product = file.covariance.take().unwrap();
        file.covariance = Some(Covariance::of_entries(product.signals.clone(), product.all()));
        let entries = file.uncertainty_in::<f64>().unwrap().unwrap().covariance(&wrench);
        assert!((entries - whole).norm() < 1e-10 * whole.norm(), "{entries} {whole}");
        let entries = file.sensor_uncertainty_in::<f64, 7>().unwrap().wrench_covariance(&wrench);
        assert!((entries - typed).norm() < 1e-10 * typed.norm(), "{entries} {typed}");
        // Noise of the gauges is there without a load, and what the fit leaves is not.
        file.noise = Some(vec![1e-3; 7]);
        let noisy = file.sensor_uncertainty_in::<f64, 7>().unwrap();
        let at_rest = noisy.wrench_covariance(&Wrench::zero());
        assert!(at_rest.diagonal().min() > 0.0);
        assert!((noisy.wrench_covariance(&wrench) - at_rest - whole).norm() < 1e-10 * whole.norm());
        file.covariance = None;
        assert_eq!(file.uncertainty_in::<f64>().unwrap(), None);
        assert_eq!(file.sensor_uncertainty_in::<f64, 7>().unwrap().wrench_covariance(&wrench), at_rest);
    }

    #[test]
    fn what_is_no_covariance_is_refused_by_name() {
        let mut twisted = file();
        twisted.covariance.as_mut().unwrap().loads[(1, 1)] = -1.0;
        for error in [
            twisted.uncertainty_in::<f64>().unwrap_err(),
            twisted.sensor_uncertainty_in::<f64, 7>().unwrap_err(),
        ] {
            assert!(error.to_string().contains("covariance"), "{error}");
        }
        assert!(file().sensor_uncertainty_in::<f64, 6>().is_err());
    }
}
