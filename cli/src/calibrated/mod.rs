//! Readings of gauges, which a calibration turns into wrenches.

mod gauges;
mod tests;

use std::path::Path;

use fingertip::wrench::{
    GaussianElimination, LeastSquares, LeastSquaresError, SingularMatrix, TareError, Wrench,
};
use fingertip_calibration::file::{CalibrationFile, FileError, Verdict};
use fingertip_recordings::SignalUnit;
use thiserror::Error;

use crate::error::CliError;
use crate::observe::Status;
use crate::rest_watch::Doubt;
use gauges::Gauges;

/// Most gauges of a sensor.
pub(crate) const MOST_GAUGES: usize = 16;

/// One reading of a sensor's gauges.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GaugeReading<'a> {
    pub(crate) gauges: &'a [f64],
    pub(crate) dummy: Option<f64>,
    /// Temperature of the sensor \[°C\].
    pub(crate) celsius: Option<f64>,
}

/// Readings to wrenches, by the calibration of their sensor and its zero.
pub(crate) trait Calibrated: Send {
    /// The wrench as the calibration has it, or why there is none.
    fn wrench(&self, reading: &GaugeReading<'_>) -> Result<Wrench<f64>, Status>;

    /// Takes a reading of the rest: [`Status::Rest`], or why it cannot be used.
    fn rest(&mut self, reading: &GaugeReading<'_>) -> Status;

    /// The mean of the rest is the zero from now on.
    fn end_rest(&mut self) -> Result<(), TareError>;

    /// Why the rest may not have been one.
    fn doubt(&self) -> Option<Doubt>;
}

/// What is known of the readings that a calibration is for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Readings {
    pub(crate) unit: SignalUnit,
    pub(crate) has_dummy: bool,
    /// Whether there will be a rest, which gives the zero.
    pub(crate) has_rest: bool,
    pub(crate) has_temperature: bool,
}

/// A calibration that was read.
pub(crate) struct Calibration<'a> {
    file: CalibrationFile,
    path: &'a Path,
}

impl<'a> Calibration<'a> {
    pub(crate) fn read(path: &'a Path) -> Result<Self, CliError> {
        let file = CalibrationFile::read(path)
            .map_err(|error| CliError::Calibration { path: path.to_owned(), message: error.to_string() })?;
        Ok(Self { file, path })
    }

    /// How many gauges it is for.
    pub(crate) fn gauges(&self) -> usize {
        self.file.gauges()
    }

    /// For readings; what is to be minded about it is added to `notes`.
    pub(crate) fn of(
        &self,
        readings: &Readings,
        notes: &mut Vec<String>,
    ) -> Result<Box<dyn Calibrated>, CliError> {
        let Readings { unit, has_dummy, has_rest, has_temperature } = *readings;
        let file = &self.file;
        let fault = |message: String| CliError::Calibration { path: self.path.to_owned(), message };
        if !agree(unit, file.signal_unit) {
            return Err(fault(format!(
                "it is for signals in {:?}, but the recording holds {unit:?}; use the calibration that belongs to the \
                 recording",
                file.signal_unit,
            )));
        }
        if matches!(file.quality.verdict, Verdict::Bad | Verdict::Suspect) {
            let quality = &file.quality;
            let reasons = quality.reasons.join("; ");
            notes.push(format!("the calibration calls itself {}: {reasons}", quality.verdict.name()));
        }
        match &file.temperature {
            Some(drift) if !has_temperature => {
                return Err(fault(format!(
                    "its readings drift with temperature (reference {} °C), and the recording has no column \
                     temperature_C; add one, or state the temperature with --celsius",
                    drift.reference_celsius
                )));
            }
            None if has_temperature => {
                notes.push("the temperature is known, but the calibration has no terms for it".to_owned());
            }
            _ => {}
        }
        let is_warm = file.temperature.is_some();
        if has_dummy && is_warm {
            notes
                .push("the dummy gauge is not used: the temperature terms of the calibration are".to_owned());
        } else if has_dummy && !has_rest {
            notes.push("the dummy gauge is not used: that needs a rest, rest_s in the scene".to_owned());
        }
        let uses_dummy = has_dummy && has_rest && !is_warm;
        // Six gauges give the wrench exactly, more by least squares. The number is part of the type, so
        // that the loop over the gauges is unrolled.
        let solved = match file.gauges() {
            6 => exact(file, uses_dummy),
            7 => redundant::<7>(file, uses_dummy),
            8 => redundant::<8>(file, uses_dummy),
            9 => redundant::<9>(file, uses_dummy),
            10 => redundant::<10>(file, uses_dummy),
            11 => redundant::<11>(file, uses_dummy),
            12 => redundant::<12>(file, uses_dummy),
            13 => redundant::<13>(file, uses_dummy),
            14 => redundant::<14>(file, uses_dummy),
            15 => redundant::<15>(file, uses_dummy),
            MOST_GAUGES => redundant::<MOST_GAUGES>(file, uses_dummy),
            other => Err(Unsolvable::Gauges(other)),
        };
        solved.map_err(|error| fault(error.to_string()))
    }
}

/// Why no wrench comes of a calibration.
#[derive(Debug, Error)]
pub(crate) enum Unsolvable {
    #[error(transparent)]
    File(#[from] FileError),
    #[error(transparent)]
    Singular(#[from] SingularMatrix),
    #[error(transparent)]
    LeastSquares(#[from] LeastSquaresError),
    #[error("it has {0} gauges, but this program reads 6 to {MOST_GAUGES}; leave some out")]
    Gauges(usize),
}

fn exact(file: &CalibrationFile, uses_dummy: bool) -> Result<Box<dyn Calibrated>, Unsolvable> {
    let solver = GaussianElimination::new(&file.sensor_matrix::<6>()?)?;
    Ok(Gauges::<_, 6>::boxed(solver, file, uses_dummy)?)
}

fn redundant<const N: usize>(
    file: &CalibrationFile,
    uses_dummy: bool,
) -> Result<Box<dyn Calibrated>, Unsolvable> {
    let solver = LeastSquares::new(&file.sensor_matrix::<N>()?)?;
    Ok(Gauges::<_, N>::boxed(solver, file, uses_dummy)?)
}

/// Whether a calibration is in the unit of a recording. Columns that do not state theirs are taken
/// at their user's word.
fn agree(recorded: SignalUnit, calibrated: SignalUnit) -> bool {
    recorded == SignalUnit::Unstated || recorded == calibrated
}
