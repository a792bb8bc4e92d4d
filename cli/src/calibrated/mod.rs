//! The calibration that a command is given, and what is to be minded when readings go through it.

mod tests;

use std::path::Path;

use fingertip_calibration::file::{CalibrationFile, Verdict};
use fingertip_recordings::SignalUnit;
use fingertip_scene::Sensor;

use crate::calibrate::files::read_calibration;
use crate::error::CliError;

/// What is known of the readings that a calibration is for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Readings {
    pub(crate) unit: SignalUnit,
    pub(crate) has_dummy: bool,
    /// Whether there will be a rest, which gives the zero.
    pub(crate) has_rest: bool,
    pub(crate) has_temperature: bool,
}

/// A calibration, and the file in which it stands.
#[derive(Debug)]
pub(crate) struct Calibration<'a> {
    file: CalibrationFile,
    path: &'a Path,
}

impl<'a> Calibration<'a> {
    pub(crate) fn read(path: &'a Path) -> Result<Self, CliError> {
        Ok(Self { file: read_calibration(path)?, path })
    }

    /// That of a scene, which stands in this file.
    pub(crate) const fn of_scene(file: CalibrationFile, path: &'a Path) -> Self {
        Self { file, path }
    }

    /// How many gauges it is for.
    pub(crate) fn gauges(&self) -> usize {
        self.file.gauges()
    }

    /// The range of its readings.
    pub(crate) const fn range(&self) -> Option<[f64; 2]> {
        self.file.range
    }

    /// For readings; what is to be minded about it is added to `notes`.
    pub(crate) fn of(&self, readings: &Readings, notes: &mut Vec<String>) -> Result<Sensor<f64>, CliError> {
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
        if file.quality.verdict == Verdict::Unchecked {
            // A rest gives the zero that it may lack.
            let counts = |reason: &&String| !(has_rest && reason.contains("tare before use"));
            notes.extend(file.quality.reasons.iter().filter(counts).cloned());
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
        Sensor::new(file).map_err(|error| fault(error.to_string()))
    }
}

/// Whether a calibration is in the unit of a recording. Columns that do not state theirs are taken
/// at their user's word.
fn agree(recorded: SignalUnit, calibrated: SignalUnit) -> bool {
    recorded == SignalUnit::Unstated || recorded == calibrated
}
