//! What a scene says of the sensor, and the calibration that it means.

use std::path::{Path, PathBuf};

use fingertip::contact::CalibrationUncertainty;
use fingertip::wrench::Real;
use fingertip_calibration::file::{self, CalibrationFile, SignalUnit};
use fingertip_calibration::linear::pseudo_inverse;
use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use super::{BadSensor, Sensor};
use crate::fault::SceneProblem;
use crate::named::Folder;

/// `[sensor]` of a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SensorSection {
    #[serde(skip_serializing_if = "Option::is_none")]
    calibration: Option<PathBuf>,
    #[serde(rename = "load_per_signal_N_Nm", skip_serializing_if = "Option::is_none")]
    load_per_signal: Option<Vec<Vec<f64>>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    zero: Option<Vec<f64>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    range: Option<[f64; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    signal_unit: Option<SignalUnit>,
    #[serde(rename = "temperature_C", skip_serializing_if = "Option::is_none")]
    celsius: Option<f64>,
}

/// A calibration that was read, and what it is called.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SensorSource {
    pub(crate) file: CalibrationFile,
    pub(crate) name: String,
    /// Temperature of the sensor where no reading tells it \[°C\].
    pub(crate) celsius: Option<f64>,
}

impl SensorSource {
    pub(crate) fn read(path: &Path) -> Result<Self, SceneProblem> {
        let name = format!("calibration {}", path.display());
        match file::read_calibration(path) {
            Ok(file) => Ok(Self { file, name, celsius: None }),
            Err(source) => Err(SceneProblem::Sensor { name, source: Box::new(source.into()) }),
        }
    }

    pub(crate) fn build<T: Real>(&self) -> Result<Sensor<T>, SceneProblem> {
        Sensor::new(&self.file)
            .map_err(|source| SceneProblem::Sensor { name: self.name.clone(), source: Box::new(source) })
    }
}

impl SensorSource {
    /// What the fit of the calibration leaves uncertain; `None` if its file does not tell.
    pub(crate) fn uncertainty<T: Real>(&self) -> Result<Option<CalibrationUncertainty<T>>, SceneProblem> {
        self.file.uncertainty_in().map_err(|source| SceneProblem::Sensor {
            name: self.name.clone(),
            source: Box::new(source.into()),
        })
    }
}

const MATRIX: &str = "[sensor]";

fn wrong(key: &'static str, belongs: &'static str) -> SceneProblem {
    SceneProblem::Misplaced { section: "sensor", key, belongs }
}

impl SensorSection {
    /// Reads what it names; files are looked for in `folder`.
    pub(crate) fn source(&self, folder: &Folder<'_>) -> Result<SensorSource, SceneProblem> {
        if self.celsius.is_some_and(|celsius| !celsius.is_finite()) {
            return Err(SceneProblem::Range {
                key: "temperature_C",
                section: "sensor",
                requirement: "a finite number",
            });
        }
        let source = match (&self.calibration, &self.load_per_signal) {
            (Some(calibration), None) => {
                let belongs = "a sensor with `load_per_signal_N_Nm`; a calibration has its own";
                for (key, given) in [
                    ("zero", self.zero.is_some()),
                    ("range", self.range.is_some()),
                    ("signal_unit", self.signal_unit.is_some()),
                ] {
                    if given {
                        return Err(wrong(key, belongs));
                    }
                }
                SensorSource::read(&folder.file(calibration))?
            }
            (None, Some(rows)) => {
                let Some(unit) = self.signal_unit else {
                    let needed = "`signal_unit` beside the matrix: \"V\", \"mV/V\", \"count\" or \"strain\"";
                    return Err(SceneProblem::Needs { what: "[sensor]", needed });
                };
                let file = self.calibration_of(rows, unit);
                let file = file.map_err(|source| SceneProblem::Sensor {
                    name: MATRIX.to_owned(),
                    source: Box::new(source),
                })?;
                SensorSource { file, name: MATRIX.to_owned(), celsius: None }
            }
            (Some(_), Some(_)) => {
                return Err(wrong("load_per_signal_N_Nm", "a sensor without `calibration`"));
            }
            (None, None) => {
                let needed = "`calibration`, a file, or the matrix `load_per_signal_N_Nm`";
                return Err(SceneProblem::Needs { what: "[sensor]", needed });
            }
        };
        Ok(SensorSource { celsius: self.celsius, ..source })
    }

    /// A matrix that stands in the scene, as its calibration: the load of one unit of all signals, axis by axis, is
    /// taken for the nominal one, which scales the numbers and changes no answer.
    fn calibration_of(&self, rows: &[Vec<f64>], unit: SignalUnit) -> Result<CalibrationFile, BadSensor> {
        let gauges = rows.first().map_or(0, Vec::len);
        let shape = |found, expected| {
            let field = "load_per_signal_N_Nm".to_owned();
            BadSensor::File(file::FileError::WrongShape { field, found, expected })
        };
        if rows.len() != 6 {
            return Err(shape(rows.len(), 6));
        }
        if let Some(row) = rows.iter().find(|row| row.len() != gauges) {
            return Err(shape(row.len(), gauges));
        }
        // Whether it has as many, the file says.
        let zero = self.zero.clone().unwrap_or_else(|| vec![0.0; gauges]);
        let matrix = DMatrix::from_row_iterator(6, gauges, rows.iter().flatten().copied());
        let nominal: Vec<f64> = matrix.row_iter().map(|row| row.norm()).collect();
        if !nominal.iter().all(|load| *load > 0.0 && load.is_finite()) {
            return Err(file::FileError::Singular.into());
        }
        let shares = DMatrix::from_fn(6, gauges, |axis, gauge| matrix[(axis, gauge)] / nominal[axis]);
        let inverse = pseudo_inverse(&shares).ok_or(file::FileError::Singular)?;
        let mut file = CalibrationFile::new(inverse, nominal, zero, unit)?;
        file.range = self.range;
        file.validate()?;
        Ok(file)
    }
}
