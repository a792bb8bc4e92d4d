//! A calibration as Rust constants, for firmware without files.

use core::fmt::Write as _;

use super::{CalibrationFile, FileError, Temperature, Verdict};
use crate::Axis;

/// The crates that a module names.
const IMPORTS: &str = "// A program that has `fingertip-wrench` and `nalgebra` instead of `fingertip` leaves this line out.\n\
                       use fingertip::{nalgebra, wrench as fingertip_wrench};";

impl CalibrationFile {
    /// A Rust module with the calibration as `const` arrays of `f32` or `f64` and a function that
    /// makes the [`SensorMatrix`](fingertip_wrench::SensorMatrix) of them, or the
    /// [`CurvedInverse`](fingertip_wrench::CurvedInverse) of a curved sensor; with temperature terms also a
    /// [`TemperatureCompensation`](fingertip_wrench::TemperatureCompensation). It needs the crate
    /// `fingertip` alone, neither heap nor `std`; a comment says which line a program leaves out that has
    /// `fingertip-wrench` and `nalgebra` instead.
    ///
    /// Numbers are written with as many digits as it takes to give the nearest number of the type.
    ///
    /// # Errors
    /// As [`sensor_matrix`](Self::sensor_matrix); and [`FileError::NotFinite`] or
    /// [`FileError::OutOfRange`] for a number that `f32` cannot hold.
    pub fn to_rust(&self, scalar: Scalar) -> Result<String, FileError> {
        self.validate()?;
        if self.axes != Axis::ALL {
            return Err(FileError::NotSixAxes { found: self.axes.len() });
        }
        let gauges = self.gauges();
        let name = scalar.name();
        let list = |field: &str, values: &mut dyn Iterator<Item = f64>| -> Result<String, FileError> {
            let mut text = Vec::new();
            for (index, value) in values.enumerate() {
                text.push(scalar.literal(value).ok_or_else(|| FileError::OutOfRange {
                    field: format!("{field}[{index}]"),
                    requirement: "within the range of f32",
                })?);
            }
            Ok(format!("[{}]", text.join(", ")))
        };
        if self.creep.is_some() {
            let requirement = "absent in Rust constants: give its times and shares to a CreepCompensation";
            return Err(FileError::OutOfRange { field: "creep".to_owned(), requirement });
        }
        let mut text = self.origin_in_rust()?;
        let _ = writeln!(
            text,
            "\n{IMPORTS}\n\n/// Number of gauges.\npub const GAUGES: usize = {gauges};\n\n\
             /// Reading of each gauge without load.\npub const ZERO: [{name}; GAUGES] = {};",
            list("zero", &mut self.zero.iter().copied())?,
        );
        text.push_str(&match self.is_curved() {
            true => self.curve_in_rust(scalar)?,
            false => self.matrix_in_rust(name, &list)?,
        });
        if let Some(drift) = &self.temperature {
            text.push_str(&drift_in_rust(drift, name, &list)?);
        }
        Ok(text)
    }

    /// Matrix and nominal loads of a straight sensor.
    fn matrix_in_rust(&self, name: &str, list: &ListInRust<'_>) -> Result<String, FileError> {
        let mut text = String::new();
        let _ = writeln!(
            text,
            "\n\
             /// Signal of each gauge under the nominal load of each axis.\n\
             pub const NORMALISED: [[{name}; 6]; GAUGES] = ["
        );
        for (i, row) in self.matrix.row_iter().enumerate() {
            let _ = writeln!(text, "    {},", list(&format!("matrix[{i}]"), &mut row.iter().copied())?);
        }
        let _ = writeln!(
            text,
            "];\n\n/// Nominal loads [N, N, N, N·m, N·m, N·m].\npub const NOMINAL: [{name}; 6] = {};\n",
            list("nominal", &mut self.nominal.iter().copied())?,
        );
        let _ = write!(
            text,
            "/// The sensor matrix of these constants.\n\
             ///\n\
             /// # Errors\n\
             /// Never for the numbers above; only if they were edited into nonsense.\n\
             pub fn sensor_matrix()\n\
             -> Result<fingertip_wrench::SensorMatrix<{name}, GAUGES>, fingertip_wrench::SensorMatrixError> {{\n    \
                 fingertip_wrench::SensorMatrix::new(\n        \
                     nalgebra::SMatrix::<{name}, GAUGES, 6>::from_fn(|gauge, axis| NORMALISED[gauge][axis]),\n        \
                     nalgebra::Vector6::from(NOMINAL),\n    )\n}}\n"
        );
        Ok(text)
    }

    /// Where the calibration comes from and how good it is, as comments.
    fn origin_in_rust(&self) -> Result<String, FileError> {
        let mut text = String::new();
        // Writing to a String cannot fail.
        let _ = writeln!(text, "// Calibration {}, written by {}.", self.checksum()?, crate::TOOL);
        for (label, value) in [
            ("Sensor", &self.provenance.serial),
            ("Calibrated", &self.provenance.date),
            ("Method", &self.provenance.method),
        ] {
            if !value.is_empty() {
                let _ = writeln!(text, "// {label}: {}", value.replace(['\n', '\r'], " "));
            }
        }
        let verdict = match self.quality.verdict {
            Verdict::Good => "good",
            Verdict::Suspect => "SUSPECT",
            Verdict::Bad => "BAD",
            Verdict::Unchecked => "unchecked",
        };
        let _ = writeln!(text, "// Quality: {verdict}");
        for reason in &self.quality.reasons {
            let _ = writeln!(text, "// - {}", reason.replace(['\n', '\r'], " "));
        }
        Ok(text)
    }
}

/// Writes the numbers of a field as a list.
type ListInRust<'a> = dyn Fn(&str, &mut dyn Iterator<Item = f64>) -> Result<String, FileError> + 'a;

/// Constants and function of the drift with temperature.
fn drift_in_rust(drift: &Temperature, name: &str, list: &ListInRust<'_>) -> Result<String, FileError> {
    let mut text = String::new();
    let range = [drift.reference_celsius, drift.range_celsius[0], drift.range_celsius[1]];
    let _ = writeln!(
        text,
        "\n/// Reference temperature, least and greatest temperature of the calibration [°C].\n\
         pub const CELSIUS: [{name}; 3] = {};",
        list("temperature", &mut range.into_iter())?
    );
    for (constant, meaning, field, values) in [
        ("ZERO_DRIFT", "Drift of each zero [signal/K].", "temperature.zero_drift", &drift.zero_drift),
        (
            "ZERO_CURVATURE",
            "Curvature of each zero [signal/K²].",
            "temperature.zero_curvature",
            &drift.zero_curvature,
        ),
        ("GAIN_DRIFT", "Drift of each gain [1/K].", "temperature.gain_drift", &drift.gain_drift),
    ] {
        let values = list(field, &mut values.iter().copied())?;
        let _ = writeln!(text, "\n/// {meaning}\npub const {constant}: [{name}; GAUGES] = {values};");
    }
    let _ = write!(
        text,
        "\n/// Takes zero and drift off a reading: use this, not `ZERO` alone.\n\
         ///\n\
         /// # Errors\n\
         /// Never for the numbers above; only if they were edited into nonsense.\n\
         pub fn temperature_compensation() -> Result<\n    \
             fingertip_wrench::TemperatureCompensation<{name}, GAUGES, 3>,\n    \
             fingertip_wrench::BadTemperatureModel,\n\
         > {{\n    \
             let vector = nalgebra::SVector::<{name}, GAUGES>::from;\n    \
             let [reference, least, greatest] = CELSIUS;\n    \
             fingertip_wrench::TemperatureCompensation::new(\n        \
                 reference,\n        \
                 (least, greatest),\n        \
                 [vector(ZERO), vector(ZERO_DRIFT), vector(ZERO_CURVATURE)],\n        \
                 [vector(GAIN_DRIFT), vector([0.0; GAUGES]), vector([0.0; GAUGES])],\n    \
             )\n}}\n"
    );
    Ok(text)
}

/// Scalar type of exported constants.
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
/// use fingertip_calibration::file::Scalar;
///
/// // For a microcontroller whose floats are of 32 bits.
/// let module = file.to_rust(Scalar::F32)?;
/// assert!(module.contains("pub const NORMALISED: [[f32; 6]; GAUGES]"));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scalar {
    /// `f32`.
    F32,
    /// `f64`.
    F64,
}

impl Scalar {
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::F32 => "f32",
            Self::F64 => "f64",
        }
    }

    /// The shortest literal that gives the nearest number of the type; `None` if it has none.
    pub(super) fn literal(self, value: f64) -> Option<String> {
        match self {
            #[allow(clippy::cast_possible_truncation)]
            Self::F32 => {
                let narrow = value as f32;
                (narrow.is_finite() && (narrow != 0.0 || value == 0.0)).then(|| format!("{narrow:?}"))
            }
            Self::F64 => value.is_finite().then(|| format!("{value:?}")),
        }
    }
}
