//! The calibration of one sensor, as it is written to a file.

use fingertip_wrench::{Real, SensorMatrix, Tare};
use nalgebra::{DMatrix, DVector, SMatrix, SVector, Vector6};
use serde::{Deserialize, Serialize};

use super::{Covariance, Curve, FileError, SignalUnit, Temperature, rows};
use crate::Axis;
use crate::creep::Creep;
use crate::curve::Region;

/// Everything that is known of a calibrated sensor: what turns its readings into a wrench, how
/// good that is, and where it comes from.
///
/// Signals are readings minus [`zero`](Self::zero) (and minus the drift of
/// [`temperature`](Self::temperature)), in [`signal_unit`](Self::signal_unit). The model is
/// `signals = matrix · (load / nominal)`: **the matrix is normalised**, an entry is the signal of
/// gauge `row` under the nominal load of axis `column`, just as in [`SensorMatrix`] (equations
/// (10), (11) of Bicchi & Dario 1987). Loads are in N and N·m, about the origin of the sensor
/// frame, and are what the environment applies **to** the fingertip.
///
/// # The file
/// TOML, all fields below by these names, then `version` and `checksum`. The version is 1; 2 where the
/// [`covariance`](Self::covariance) has `entries`, and 3 where there is a `curve` or a `region`, 4 where there is `creep`,
/// which programs of before don't know. The checksum is taken over the values (see [`read`](Self::read)), so comments and layout may be changed by hand.
///
/// ```
/// use fingertip_calibration::file::{CalibrationFile, SignalUnit};
/// use fingertip_calibration::nalgebra::DMatrix;
///
/// let file = CalibrationFile::new(
///     DMatrix::from_diagonal_element(6, 6, 2.0), // 2 V under each nominal load
///     vec![10.0, 10.0, 10.0, 0.1, 0.1, 0.1],
///     vec![0.0; 6],
///     SignalUnit::Volt,
/// )?;
/// let again = CalibrationFile::from_toml(&file.to_toml()?)?;
/// assert_eq!(again, file);
/// let sensor = again.sensor_matrix::<6>()?;
/// assert_eq!(sensor.nominal()[3], 0.1);
/// # Ok::<(), fingertip_calibration::file::FileError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CalibrationFile {
    /// The components that the sensor measures, one per column of the matrix.
    pub axes: Vec<Axis>,
    /// Unit of the readings, of `zero` and of the matrix.
    pub signal_unit: SignalUnit,
    /// Nominal load (full scale) of each axis \[N, N·m\]; positive.
    pub nominal: Vec<f64>,
    /// Normalised sensor matrix: one row per gauge, one column per axis.
    #[serde(with = "rows")]
    pub matrix: DMatrix<f64>,
    /// Reading of each gauge without load (the bias).
    pub zero: Vec<f64>,
    /// Standard deviation of one reading of each gauge at rest.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub noise: Option<Vec<f64>>,
    /// Least and greatest reading that a gauge can give; beyond them it is saturated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub range: Option<[f64; 2]>,
    /// Second-order terms of a sensor that is not linear: what each product of two signals adds to the load, in nominal
    /// loads. One row per axis, one column per pair of gauges (0,0), (0,1), … (0,N−1), (1,1), ….
    #[serde(default, skip_serializing_if = "Option::is_none", with = "rows::optional")]
    pub quadratic: Option<DMatrix<f64>>,
    /// Other terms of higher order, chosen ones, beside or instead of those.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub curve: Option<Curve>,
    /// Where the signals of the calibration lay: a sensor that is not linear means little beyond.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub region: Option<Region>,
    /// How uncertain the matrix is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub covariance: Option<Covariance>,
    /// How readings drift with temperature.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub temperature: Option<Temperature>,
    /// How readings go on changing under a load that does not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub creep: Option<Creep>,
    /// Where the calibration comes from.
    #[serde(default)]
    pub provenance: Provenance,
    /// How good it is.
    #[serde(default)]
    pub quality: Quality,
}

/// Where a calibration comes from.
///
/// ```
/// # use fingertip_calibration::{file::SignalUnit, nalgebra::DMatrix};
/// # // 2 V on one gauge each under 10 N or 0.1 N·m.
/// # let file = fingertip_calibration::file::CalibrationFile::new(
/// #     DMatrix::from_diagonal_element(6, 6, 2.0),
/// #     vec![10.0, 10.0, 10.0, 0.1, 0.1, 0.1],
/// #     vec![0.0; 6],
/// #     SignalUnit::Volt,
/// # )?;
/// # let mut file = file;
/// use fingertip_calibration::file::{CalibrationFile, Provenance};
///
/// file.provenance = Provenance {
///     serial: "FT-0042".into(),
///     date: "2026-11-26".into(),
///     source: "weights of class M1".into(),
///     ..Provenance::default()
/// };
/// // It is in the file, for whoever finds it.
/// let text = file.to_toml()?;
/// assert!(text.contains("FT-0042"));
/// assert_eq!(CalibrationFile::from_toml(&text)?.provenance, file.provenance);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Provenance {
    /// Serial number of the sensor.
    #[serde(default)]
    pub serial: String,
    /// When it was calibrated, as the user writes dates (ISO 8601 advised).
    #[serde(default)]
    pub date: String,
    /// How it was fitted.
    #[serde(default)]
    pub method: String,
    /// Program and version that wrote the file.
    #[serde(default)]
    pub tool: String,
    /// Where the loads come from: rig, certificate, recording.
    #[serde(default)]
    pub source: String,
}

/// Whether a calibration can be trusted.
///
/// ```
/// # use fingertip_calibration::{Axis, file::SignalUnit, loads::LoadTable, nalgebra::DMatrix};
/// # // Three forces one after another, up to ±9.5 N; each has a gauge of 0.1 V/N, and they scatter by a millivolt.
/// # let loads = DMatrix::from_fn(60, 3, |i, j| if i % 3 == j { (i / 3) as f64 - 9.5 } else { 0.0 });
/// # let signals = loads.map_with_location(|i, j, newtons| 0.1 * newtons + 1e-3 * ((7 * i + 3 * j) as f64).sin());
/// # let table = LoadTable::new(&Axis::FORCES, loads, signals, SignalUnit::Volt)?;
/// use fingertip_calibration::file::{CalibrationFile, Verdict};
/// use fingertip_calibration::{calibrate, model::Options};
///
/// // A calibration that was fitted has been checked; a matrix that somebody typed has not.
/// let fitted = calibrate(&table, &Options::default())?.to_file()?;
/// assert_eq!(fitted.quality.verdict, Verdict::Good);
/// let typed = CalibrationFile::new(fitted.matrix, fitted.nominal, fitted.zero, fitted.signal_unit)?;
/// assert_eq!(typed.quality.verdict.name(), "unchecked");
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// Checked, and within what was asked for.
    Good,
    /// Checked, and within what was asked for but for readings that do not fit the others: either they
    /// are wrong or the sensor is, and nobody has looked. The reasons stand beside it.
    Suspect,
    /// Checked, and not: the reasons stand beside it.
    Bad,
    /// Nobody has checked it.
    #[default]
    Unchecked,
}

impl Verdict {
    /// As files and reports have it: `"good"`, `"suspect"`, `"bad"`, `"unchecked"`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Good => "good",
            Self::Suspect => "suspect",
            Self::Bad => "bad",
            Self::Unchecked => "unchecked",
        }
    }
}

/// Summary of a calibration's report.
///
/// ```
/// # use fingertip_calibration::{Axis, file::SignalUnit, loads::LoadTable, nalgebra::DMatrix};
/// # // Three forces one after another, up to ±9.5 N; each has a gauge of 0.1 V/N, and they scatter by a millivolt.
/// # let loads = DMatrix::from_fn(60, 3, |i, j| if i % 3 == j { (i / 3) as f64 - 9.5 } else { 0.0 });
/// # let signals = loads.map_with_location(|i, j, newtons| 0.1 * newtons + 1e-3 * ((7 * i + 3 * j) as f64).sin());
/// # let table = LoadTable::new(&Axis::FORCES, loads, signals, SignalUnit::Volt)?;
/// use fingertip_calibration::file::Quality;
/// use fingertip_calibration::{calibrate, model::Options};
///
/// // Sixty loads up to 9.5 N, read to 7 mN: 0.07 % of full scale, a little more on loads that were left out.
/// let quality: Quality = calibrate(&table, &Options::default())?.to_file()?.quality;
/// let (rms, left_out) = (quality.rms_percent.ok_or("none")?, quality.left_out_percent.ok_or("none")?);
/// assert_eq!(quality.samples, Some(60));
/// assert!((rms[0] - 0.07).abs() < 0.01 && left_out[0] > rms[0]);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Quality {
    /// Whether it can be trusted.
    pub verdict: Verdict,
    /// Why it is bad or suspect, or what to mind.
    #[serde(default)]
    pub reasons: Vec<String>,
    /// How many loads it was fitted to.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub samples: Option<u64>,
    /// Condition number N_c of the normalised matrix.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub condition_number: Option<f64>,
    /// RMS error of each axis on the loads of the fit, % of full scale.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rms_percent: Option<Vec<f64>>,
    /// Greatest error of each axis on the loads of the fit, % of full scale.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub greatest_percent: Option<Vec<f64>>,
    /// RMS error of each axis on loads that were left out of the fit, % of full scale.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub left_out_percent: Option<Vec<f64>>,
}

impl CalibrationFile {
    /// A linear calibration without temperature terms, its quality unchecked. The axes are all six,
    /// or Fx, Fy, Fz for a matrix of three columns.
    ///
    /// # Errors
    /// As [`validate`](Self::validate).
    pub fn new(
        normalised: DMatrix<f64>,
        nominal: Vec<f64>,
        zero: Vec<f64>,
        signal_unit: SignalUnit,
    ) -> Result<Self, FileError> {
        let axes = if normalised.ncols() == 3 { Axis::FORCES.to_vec() } else { Axis::ALL.to_vec() };
        Self::of_axes(axes, normalised, nominal, zero, signal_unit)
    }

    /// As [`new`](Self::new), of any axes.
    pub(crate) fn of_axes(
        axes: Vec<Axis>,
        normalised: DMatrix<f64>,
        nominal: Vec<f64>,
        zero: Vec<f64>,
        signal_unit: SignalUnit,
    ) -> Result<Self, FileError> {
        let file = Self {
            axes,
            signal_unit,
            nominal,
            matrix: normalised,
            zero,
            noise: None,
            range: None,
            quadratic: None,
            curve: None,
            region: None,
            covariance: None,
            temperature: None,
            creep: None,
            provenance: Provenance { tool: crate::TOOL.to_owned(), ..Provenance::default() },
            quality: Quality::default(),
        };
        file.validate()?;
        Ok(file)
    }

    /// How many gauges the sensor has.
    #[must_use]
    pub fn gauges(&self) -> usize {
        self.matrix.nrows()
    }

    /// The sensor matrix in any scalar type.
    ///
    /// # Errors
    /// [`FileError::WrongGauges`] if the sensor has not `N` gauges, [`FileError::NotSixAxes`] if it
    /// measures fewer components, [`FileError::OutOfRange`] for field `quadratic` or `curve` if it is
    /// not linear, [`FileError::Matrix`] if the numbers are no sensor in that type.
    pub fn sensor_matrix<const N: usize>(&self) -> Result<SensorMatrix<f64, N>, FileError> {
        self.sensor_matrix_in::<f64, N>()
    }

    /// As [`sensor_matrix`](Self::sensor_matrix), in scalar type `T`.
    ///
    /// # Errors
    /// The same.
    pub fn sensor_matrix_in<T: Real, const N: usize>(&self) -> Result<SensorMatrix<T, N>, FileError> {
        self.validate()?;
        if self.is_curved() {
            return Err(FileError::OutOfRange {
                field: if self.quadratic.is_some() { "quadratic" } else { "curve" }.to_owned(),
                requirement: "absent: a curved sensor has no sensor matrix",
            });
        }
        if self.axes != Axis::ALL {
            return Err(FileError::NotSixAxes { found: self.axes.len() });
        }
        self.check_gauges::<N>()?;
        let normalised = SMatrix::<T, N, 6>::from_fn(|i, j| T::literal(self.matrix[(i, j)]));
        let nominal = Vector6::from_fn(|i, _| T::literal(self.nominal[i]));
        Ok(SensorMatrix::new(normalised, nominal)?)
    }

    /// The readings without load.
    ///
    /// # Errors
    /// [`FileError::WrongGauges`] if the sensor has not `N` gauges, [`FileError::NeedsTemperature`] if
    /// its zero drifts with a temperature that is known: see
    /// [`temperature_compensation`](Self::temperature_compensation).
    pub fn zero<const N: usize>(&self) -> Result<Tare<f64, N>, FileError> {
        self.zero_in::<f64, N>()
    }

    /// As [`zero`](Self::zero), in scalar type `T`.
    ///
    /// # Errors
    /// The same.
    pub fn zero_in<T: Real, const N: usize>(&self) -> Result<Tare<T, N>, FileError> {
        self.validate()?;
        self.check_gauges::<N>()?;
        if let Some(drift) = &self.temperature {
            return Err(FileError::NeedsTemperature { reference: drift.reference_celsius });
        }
        Ok(Tare::new(SVector::from_fn(|i, _| T::literal(self.zero[i]))))
    }

    pub(super) fn check_gauges<const N: usize>(&self) -> Result<(), FileError> {
        if self.gauges() == N {
            Ok(())
        } else {
            Err(FileError::WrongGauges { found: self.gauges(), expected: N })
        }
    }

    /// The load \[N, N·m, in the order of `axes`\] that a reading tells of:
    /// `nominal ∘ (C⁺ s + Q (s ⊗ s) + K t(s))` with `s = reading − zero`, C⁺ the least-squares inverse, Q the
    /// quadratic terms and K the loads of the other [terms](crate::curve::Terms) t. Meant for reports; on the hot path use a
    /// solver of `fingertip-wrench`.
    ///
    /// # Errors
    /// [`FileError::NeedsTemperature`] for a calibration with temperature terms: use
    /// [`load_at`](Self::load_at); otherwise as that.
    pub fn load(&self, reading: &[f64]) -> Result<DVector<f64>, FileError> {
        self.load_at(reading, f64::NAN)
    }

    /// The load of a reading at the reference temperature, with the inverse computed before.
    pub(crate) fn load_with(&self, inverse: &DMatrix<f64>, reading: &[f64]) -> Option<DVector<f64>> {
        if reading.len() != self.gauges() || self.zero.len() != self.gauges() {
            return None;
        }
        let signals = DVector::from_fn(reading.len(), |i, _| reading[i] - self.zero[i]);
        let mut load = inverse * &signals;
        if let Some(quadratic) = &self.quadratic {
            load += quadratic * crate::linear::pairs(signals.as_slice());
        }
        if let Some(curve) = &self.curve {
            load += curve.load(signals.as_slice());
        }
        for (value, nominal) in load.iter_mut().zip(&self.nominal) {
            *value *= nominal;
        }
        Some(load)
    }
}
