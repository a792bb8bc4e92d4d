//! Solver and zero of a calibration, as its file writes them.

use fingertip::wrench::Real;
use fingertip_calibration::file::{CalibrationFile, Scalar};
use nalgebra::{Vector3, Vector6};
use serde::de::DeserializeOwned;
use toml::Table;

use super::ExportError;
use super::resolved::read;
use super::template::{Typed, Writer};
use crate::input::Convention;
use crate::scene::Scene;
use crate::sensor::SensorSource;
use crate::uncertainty::{Uncertainty, UncertaintySection};

/// The fewest gauges that tell a wrench.
const FEWEST: usize = 6;

/// What a calibration adds to a pipeline.
pub(super) struct Solved {
    pub(super) solver: Typed,
    pub(super) zero: Typed,
    /// The module of its constants.
    pub(super) module: String,
    /// What turns the sensor matrix round, where the scene asks for that.
    pub(super) opposite: String,
    /// Whether a reading has a temperature.
    pub(super) is_warm: bool,
    /// The type of a reading.
    pub(super) reading: String,
    /// Readings at or beyond these are saturated.
    pub(super) range: Option<[f64; 2]>,
}

impl<T: Real + DeserializeOwned> Writer<T> {
    pub(super) fn solved(
        &mut self,
        file: &CalibrationFile,
        scalar: Scalar,
        convention: Convention,
    ) -> Result<Solved, ExportError> {
        let (gauges, t) = (file.gauges(), Self::scalar());
        if gauges < FEWEST {
            return Err(ExportError::Gauges { found: gauges });
        }
        let solver =
            if file.is_curved() { curved(file, t, convention) } else { straight(gauges, t, convention) };
        let zero = if file.temperature.is_some() {
            Typed {
                of: format!("wrench::TemperatureCompensation<{t}, {gauges}, 3>"),
                make: "calibration::temperature_compensation()?".to_owned(),
            }
        } else {
            Typed {
                of: format!("wrench::Tare<{t}, {gauges}>"),
                make: "wrench::Tare::new(nalgebra::SVector::from(calibration::ZERO))".to_owned(),
            }
        };
        let reading = match file.temperature.is_some() {
            true => "wrench::GaugesAndTemperature { gauges, temperature }".to_owned(),
            false => format!("fingertip::nalgebra::SVector<{t}, {gauges}>"),
        };
        let constants: String = file
            .to_rust(scalar)?
            .lines()
            .map(|line| if line.is_empty() { "\n".to_owned() } else { format!("    {line}\n") })
            .collect();
        let opposite = match convention {
            Convention::Reaction if !file.is_curved() => format!(
                "\n/// The scene says `convention = \"reaction\"`: what the calibration calls a load is the fingertip's on the\n\
                 /// environment, and the pipeline wants the opposite.\n\
                 fn opposite(\n    matrix: &wrench::SensorMatrix<{t}, {gauges}>,\n\
                 ) -> Result<wrench::SensorMatrix<{t}, {gauges}>, wrench::SensorMatrixError> {{\n    \
                     wrench::SensorMatrix::new(-matrix.normalised(), *matrix.nominal())\n}}\n"
            ),
            _ => String::new(),
        };
        Ok(Solved {
            solver,
            zero,
            module: format!("\n/// The calibration of the sensor.\npub mod calibration {{\n{constants}}}\n"),
            opposite,
            is_warm: file.temperature.is_some(),
            reading,
            range: file.range,
        })
    }
}

/// The solver of a straight sensor: six gauges give the wrench exactly, more by least squares.
fn straight(gauges: usize, t: &str, convention: Convention) -> Typed {
    let (name, of) = match gauges {
        FEWEST => ("GaussianElimination", format!("wrench::GaussianElimination<{t}>")),
        _ => ("LeastSquares", format!("wrench::LeastSquares<{t}, {gauges}>")),
    };
    let matrix = match convention {
        Convention::OnFingertip => "calibration::sensor_matrix()?",
        // Signals of the opposite load: the solution of the opposite matrix.
        Convention::Reaction => "opposite(&calibration::sensor_matrix()?)?",
    };
    Typed { of, make: format!("wrench::{name}::new(&{matrix})?") }
}

/// The solver of a curved sensor, believed where it was calibrated.
fn curved(file: &CalibrationFile, t: &str, convention: Convention) -> Typed {
    let sign = match convention {
        Convention::OnFingertip => "1.0",
        Convention::Reaction => "-1.0",
    };
    let sensor = format!("calibration::curved_sensor({sign})?");
    match file.region {
        Some(_) => Typed {
            of: format!("wrench::WithinRegion<calibration::Curved, {t}, {}>", file.gauges()),
            make: format!("wrench::WithinRegion::new({sensor}, calibration::region()?)"),
        },
        None => Typed { of: "calibration::Curved".to_owned(), make: sensor },
    }
}

/// What is uncertain of a contact, the fit of the calibration included.
pub(super) fn uncertainty<T: Real>(
    scene: &Scene,
    resolved: &Table,
    calibration: Option<&CalibrationFile>,
) -> Result<Option<Uncertainty<T>>, ExportError> {
    let Some(section) = resolved.get("uncertainty") else { return Ok(None) };
    let section: UncertaintySection = read(section)?;
    let pivot = scene.pose.sensor_from_surface::<f64>()?.transform_point(&Vector3::zeros());
    // The calibration of the command stands in the place of the scene's.
    let of = |file: &CalibrationFile| SensorSource {
        file: file.clone(),
        name: "the calibration".to_owned(),
        celsius: None,
    };
    let sensor = calibration.map(of);
    // What the rest would tell was refused before.
    Ok(Some(section.build(&pivot, &Vector6::zeros(), sensor.as_ref())?))
}
