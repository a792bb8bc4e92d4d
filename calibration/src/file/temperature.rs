//! How readings drift with temperature.

use fingertip_wrench::{Real, TemperatureCompensation};
use nalgebra::{DVector, SVector};
use serde::{Deserialize, Serialize};

use super::{CalibrationFile, FileError};

/// Drift of the readings with ΔT = temperature − reference:
/// `reading = zero + zero_drift·ΔT + zero_curvature·ΔT² + (1 + gain_drift·ΔT)·matrix·(load/nominal)`.
///
/// A calibration with these terms gives no load without a temperature: what cannot use them refuses
/// it ([`FileError::NeedsTemperature`]).
///
/// ```
/// use fingertip_calibration::file::Temperature;
///
/// // One gauge: 1 mV/K and 2 ‰/K, fitted from 15 °C to 45 °C.
/// let drift = Temperature {
///     reference_celsius: 20.0,
///     range_celsius: [15.0, 45.0],
///     zero_drift: vec![1e-3],
///     zero_curvature: vec![0.0],
///     gain_drift: vec![2e-3],
/// };
/// // At 30 °C a zero of 0.1 V is 0.11 V, and a signal of 2 V is 2.04 V.
/// assert!((drift.drift_of_zero(30.0)[0] - 0.01).abs() < 1e-12);
/// let cold = drift.at_reference(&[0.11 + 2.04], &[0.1], 30.0).ok_or("wrong length")?;
/// assert!((cold[0] - 2.1).abs() < 1e-12);
/// # Ok::<(), &str>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Temperature {
    /// Reference temperature \[°C\].
    pub reference_celsius: f64,
    /// Least and greatest temperature of the fit \[°C\]; the reference lies within. Beyond, the drift of
    /// the nearer end is used.
    pub range_celsius: [f64; 2],
    /// Drift of each gauge's zero \[signal/K\].
    pub zero_drift: Vec<f64>,
    /// Curvature of each gauge's zero \[signal/K²\].
    pub zero_curvature: Vec<f64>,
    /// Drift of each gauge's gain \[1/K\].
    pub gain_drift: Vec<f64>,
}

impl Temperature {
    /// By how much the reading of each gauge without load differs from that at the reference temperature.
    #[must_use]
    pub fn drift_of_zero(&self, celsius: f64) -> Vec<f64> {
        let warmer = self.warmer(celsius);
        let drift = self.zero_drift.iter().zip(&self.zero_curvature);
        drift.map(|(slope, curvature)| warmer * (slope + curvature * warmer)).collect()
    }

    /// Kelvin above the reference, held within the range of the fit.
    fn warmer(&self, celsius: f64) -> f64 {
        let [least, greatest] = self.range_celsius;
        celsius.max(least).min(greatest) - self.reference_celsius
    }

    /// What a reading would have been at the reference temperature, given the reading without load
    /// there. `None` for a wrong length, a temperature that is not finite, or a gain that the drift turns
    /// negative.
    #[must_use]
    pub fn at_reference(&self, reading: &[f64], zero: &[f64], celsius: f64) -> Option<Vec<f64>> {
        let gauges = self.zero_drift.len();
        if reading.len() != gauges || zero.len() != gauges || !celsius.is_finite() {
            return None;
        }
        let warmer = self.warmer(celsius);
        let drift = self.drift_of_zero(celsius);
        (0..gauges)
            .map(|i| {
                let gain = 1.0 + self.gain_drift[i] * warmer;
                (gain > 0.0).then(|| zero[i] + (reading[i] - zero[i] - drift[i]) / gain)
            })
            .collect()
    }
}

impl CalibrationFile {
    /// The load \[N, N·m, in the order of `axes`\] that a reading at a temperature \[°C\] tells of. For
    /// a calibration without temperature terms the temperature does not matter.
    ///
    /// # Errors
    /// [`FileError::WrongShape`] for a reading of the wrong length, [`FileError::NeedsTemperature`] if
    /// the temperature is not finite where it matters, [`FileError::Singular`].
    pub fn load_at(&self, reading: &[f64], celsius: f64) -> Result<DVector<f64>, FileError> {
        let inverse = crate::linear::pseudo_inverse(&self.matrix).ok_or(FileError::Singular)?;
        let reading = self.brought_to_reference(reading, Some(celsius))?;
        self.load_with(&inverse, &reading).ok_or(FileError::Singular)
    }

    /// A reading as it would have been at the reference temperature; as it is without temperature terms.
    pub(crate) fn brought_to_reference(
        &self,
        reading: &[f64],
        celsius: Option<f64>,
    ) -> Result<Vec<f64>, FileError> {
        if reading.len() != self.gauges() {
            let (found, expected) = (reading.len(), self.gauges());
            return Err(FileError::WrongShape { field: "reading".to_owned(), found, expected });
        }
        let Some(drift) = &self.temperature else { return Ok(reading.to_vec()) };
        let needs = FileError::NeedsTemperature { reference: drift.reference_celsius };
        match celsius {
            Some(celsius) => drift.at_reference(reading, &self.zero, celsius).ok_or(needs),
            None => Err(needs),
        }
    }

    /// Zero and drift for the hot path, in scalar type `T`: gives signals at the reference temperature.
    /// `None` without temperature terms; then [`zero`](Self::zero) is the one to use.
    ///
    /// # Errors
    /// [`FileError::WrongGauges`] if the sensor has not `N` gauges, [`FileError::OutOfRange`] if the
    /// gain may vanish within the range of temperatures.
    pub fn temperature_compensation<T: Real, const N: usize>(
        &self,
    ) -> Result<Option<TemperatureCompensation<T, N, 3>>, FileError> {
        self.validate()?;
        let Some(drift) = &self.temperature else { return Ok(None) };
        self.check_gauges::<N>()?;
        let vector = |list: &[f64]| SVector::<T, N>::from_fn(|i, _| T::literal(list[i]));
        let range = drift.range_celsius.map(T::literal);
        let zero = [vector(&self.zero), vector(&drift.zero_drift), vector(&drift.zero_curvature)];
        let gain = [vector(&drift.gain_drift), SVector::zeros(), SVector::zeros()];
        TemperatureCompensation::new(T::literal(drift.reference_celsius), (range[0], range[1]), zero, gain)
            .map(Some)
            .map_err(|_| FileError::OutOfRange {
                field: "temperature".to_owned(),
                requirement: "such that no gain vanishes within range_celsius",
            })
    }
}

#[cfg(test)]
mod tests {
    use super::Temperature;
    use crate::file::{CalibrationFile, FileError, SignalUnit};
    use fingertip_wrench::{Compensation as _, GaugesAndTemperature};
    use nalgebra::{DMatrix, SVector};

    fn file() -> CalibrationFile {
        let matrix = DMatrix::from_diagonal_element(6, 6, 2.0);
        let mut file = CalibrationFile::new(matrix, vec![10.0; 6], vec![0.5; 6], SignalUnit::Volt).unwrap();
        file.temperature = Some(Temperature {
            reference_celsius: 20.0,
            range_celsius: [10.0, 40.0],
            zero_drift: vec![0.01; 6],
            zero_curvature: vec![-1e-4; 6],
            gain_drift: vec![2e-3; 6],
        });
        file
    }

    #[test]
    fn drift_is_taken_off_and_never_ignored() {
        let file = file();
        // 5 N on each axis at 30 °C.
        let reading = [0.5 + 0.1 - 0.01 + 1.02; 6];
        let load = file.load_at(&reading, 30.0).unwrap();
        assert!(load.iter().all(|load| (load - 5.0).abs() < 1e-12), "{load}");
        assert!(matches!(file.load(&reading), Err(FileError::NeedsTemperature { .. })));
        assert!(matches!(file.load_at(&reading, f64::NAN), Err(FileError::NeedsTemperature { .. })));
        assert!(matches!(file.zero::<6>(), Err(FileError::NeedsTemperature { .. })));
        let hot = file.temperature_compensation::<f32, 6>().unwrap().unwrap();
        let raw = GaugesAndTemperature { gauges: SVector::repeat(reading[0] as f32), temperature: 30.0 };
        assert!(hot.compensate(&raw).iter().all(|signal| (signal - 1.0).abs() < 1e-6));
        // Beyond the fit both hold the end.
        let drift = file.temperature.as_ref().unwrap();
        assert_eq!(
            drift.at_reference(&[1.0; 6], &[0.5; 6], 90.0),
            drift.at_reference(&[1.0; 6], &[0.5; 6], 40.0)
        );
        // A gain that is gone tells nothing, nor does one turned round.
        for (lost, told) in [(-0.0625, true), (-0.125, false), (-0.25, false)] {
            let drift = Temperature { gain_drift: vec![lost; 6], ..drift.clone() };
            assert_eq!(drift.at_reference(&[1.0; 6], &[0.5; 6], 28.0).is_some(), told, "{lost}");
        }
        assert!(crate::file::AtiCalibration::from_calibration(&file).is_err());
        let mut plain = file;
        plain.temperature = None;
        assert!(plain.load(&reading).is_ok() && plain.load_at(&reading, f64::NAN).is_ok());
        assert!(plain.temperature_compensation::<f64, 6>().unwrap().is_none());
    }

    #[test]
    fn a_range_without_the_reference_or_a_vanishing_gain_is_refused() {
        let mut wrong = file();
        wrong.temperature.as_mut().unwrap().range_celsius = [30.0, 40.0];
        assert!(wrong.to_toml().unwrap_err().to_string().contains("range_celsius"));
        wrong = file();
        wrong.temperature.as_mut().unwrap().gain_drift[2] = -0.1;
        assert!(wrong.temperature_compensation::<f64, 6>().is_err());
        assert!(wrong.load_at(&[0.5; 6], 35.0).is_err());
    }
}
