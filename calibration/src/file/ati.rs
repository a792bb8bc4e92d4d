//! ATI's calibration files (`FTxxxxx.cal`), both layouts.

use fingertip_wrench::units::LengthUnit;
use nalgebra::{DMatrix, Vector3};

use super::{AtiError, CalibrationFile, FileError, Provenance, Quality, SignalUnit, Verdict};
use crate::linear::pseudo_inverse;
use crate::{Axis, TOOL};

/// Why a calibration is to be tared, which a tare takes away.
pub(crate) const UNTARED: &str = "a .cal file tells no zero: tare before use";

/// What an ATI `.cal` file says: the matrix from gauge volts to loads, in the units of the file.
///
/// The older layout has six `Axis` elements, scaled, about an inner origin, and a `BasicTransform`
/// to the tool side of the sensor; the newer one adds six `UserAxis` elements, which software
/// shall prefer. They are tied by `UserAxis = T · (Axis / scale)` where T moves the origin by
/// (Dx, Dy, Dz): `m' = m − d × f`.
///
/// ```no_run
/// use fingertip_calibration::file::{AtiCalibration, CalibrationFile};
///
/// let ati = AtiCalibration::from_xml(&std::fs::read_to_string("FT12345.cal")?)?;
/// let calibration: CalibrationFile = ati.to_calibration()?;
/// calibration.write("ft12345.toml")?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct AtiCalibration {
    /// Serial number, such as `FT16810`.
    pub serial: String,
    /// Model, such as `Nano17`.
    pub body_style: String,
    /// Electronics, such as `DAQ`.
    pub family: String,
    /// Version that the file gives itself.
    pub file_version: String,
    /// Calibration, such as `SI-25-0.25`.
    pub part_number: String,
    /// When it was calibrated, in ATI's notation.
    pub date: String,
    /// Unit of force, such as `N` or `lbf`.
    pub force_unit: String,
    /// Unit of torque, such as `N-mm` or `lbf-in`.
    pub torque_unit: String,
    /// Unit of length of the transform, such as `mm` or `in`.
    pub distance_unit: String,
    /// The other attributes of the calibration, as they stand: `OutputMode`, `OutputRange`, ….
    pub other: Vec<(String, String)>,
    /// The `Axis` elements, Fx to Tz.
    pub axes: [AtiAxis; 6],
    /// Origin of the user's frame, in distance units of the file.
    pub translation: [f64; 3],
    /// Rotation of the user's frame \[degrees\]; zero in every file that we have seen.
    pub rotation: [f64; 3],
    /// The `UserAxis` elements of the newer layout; their scale is 1.
    pub user_axes: Option<[AtiAxis; 6]>,
}

/// One row of an ATI matrix.
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
/// use fingertip_calibration::file::{AtiAxis, AtiCalibration};
///
/// // 2 V under 10 N on the first axis: 5 N/V.
/// let axes: [AtiAxis; 6] = AtiCalibration::from_calibration(&file)?.user_axes.ok_or("the older layout")?;
/// assert!(axes[0].max == 10.0 && axes[0].scale == 1.0);
/// assert!((axes[0].values[0] - 5.0).abs() < 1e-12 && axes[0].values[1] == 0.0);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct AtiAxis {
    /// Load per volt of each gauge, times [`scale`](Self::scale).
    pub values: Vec<f64>,
    /// Full scale, in the unit of the file.
    pub max: f64,
    /// By what to divide.
    pub scale: f64,
}

impl AtiCalibration {
    /// Load \[N, N·m\] per volt about the user's origin, 6 × gauges: from `UserAxis` where the file
    /// has it, otherwise from `Axis` and the transform.
    ///
    /// # Errors
    /// [`AtiError::Turned`], or [`AtiError::BadAttribute`] if a number made by hand is not finite in SI.
    pub fn loads_per_volt(&self) -> Result<DMatrix<f64>, AtiError> {
        match &self.user_axes {
            Some(rows) => self.in_si("UserAxis", rows),
            None => self.transformed_axes(),
        }
    }

    /// Load \[N, N·m\] per volt about the user's origin from `Axis` and the transform, whether or
    /// not the file has `UserAxis`.
    ///
    /// # Errors
    /// [`AtiError::Turned`], or [`AtiError::BadAttribute`] if a number is not finite in SI, or too great for
    /// the transform.
    pub fn transformed_axes(&self) -> Result<DMatrix<f64>, AtiError> {
        if self.rotation.iter().any(|angle| *angle != 0.0) {
            return Err(AtiError::Turned);
        }
        let length = length(&self.distance_unit).unwrap_or(f64::NAN);
        let origin = Vector3::from(self.translation) * length;
        let mut matrix = self.in_si("Axis", &self.axes)?;
        for mut column in matrix.column_iter_mut() {
            let force = Vector3::new(column[0], column[1], column[2]);
            let moved = origin.cross(&force);
            for i in 0..3 {
                column[3 + i] -= moved[i];
            }
        }
        if matrix.iter().all(|value| value.is_finite()) {
            return Ok(matrix);
        }
        let [dx, dy, dz] = self.translation;
        Err(AtiError::BadAttribute {
            element: "BasicTransform".to_owned(),
            attribute: "Dx, Dy, Dz".to_owned(),
            found: format!("{dx}, {dy}, {dz}"),
            requirement: "must move the torques by finite numbers",
        })
    }

    /// Full scale of the six axes \[N, N·m\].
    #[must_use]
    pub fn full_scale(&self) -> [f64; 6] {
        let rows = self.user_axes.as_ref().unwrap_or(&self.axes);
        core::array::from_fn(|i| rows[i].max * self.size(Axis::ALL[i]))
    }

    /// As our calibration: the inverse matrix, normalised by full scale. The zero is not part of a
    /// `.cal` file: it is set to 0 V, and the quality says that the sensor must be tared.
    ///
    /// # Errors
    /// [`AtiError::Turned`], or [`AtiError::Calibration`] if the matrix has no inverse.
    pub fn to_calibration(&self) -> Result<CalibrationFile, AtiError> {
        let full_scale = self.full_scale();
        let mut normalised_loads = self.loads_per_volt()?;
        for (mut row, load) in normalised_loads.row_iter_mut().zip(full_scale) {
            row /= load;
        }
        let matrix = pseudo_inverse(&normalised_loads).ok_or(FileError::Singular)?;
        let gauges = matrix.nrows();
        let mut file =
            CalibrationFile::new(matrix, full_scale.to_vec(), vec![0.0; gauges], SignalUnit::Volt)?;
        file.range = self.range();
        file.provenance = Provenance {
            serial: self.serial.clone(),
            date: self.date.clone(),
            method: format!("ATI {} {}", self.body_style, self.part_number),
            tool: TOOL.to_owned(),
            source: "ATI .cal file".to_owned(),
        };
        file.quality = Quality {
            verdict: Verdict::Unchecked,
            reasons: vec![UNTARED.to_owned(), "a .cal file does not tell its accuracy".to_owned()],
            ..Quality::default()
        };
        file.validate()?;
        Ok(file)
    }

    /// A `.cal` of the newer layout from our calibration, in N and N·m, without transform.
    ///
    /// # Errors
    /// [`FileError`] if the sensor does not measure six axes in volts linearly, or its matrix has
    /// no inverse.
    pub fn from_calibration(file: &CalibrationFile) -> Result<Self, FileError> {
        file.validate()?;
        if file.axes != Axis::ALL {
            return Err(FileError::NotSixAxes { found: file.axes.len() });
        }
        let refuse =
            |field: &str, requirement| FileError::OutOfRange { field: field.to_owned(), requirement };
        if file.is_curved() {
            let field = if file.quadratic.is_some() { "quadratic" } else { "curve" };
            return Err(refuse(field, "absent in a .cal file"));
        }
        if let Some(drift) = &file.temperature {
            return Err(FileError::NeedsTemperature { reference: drift.reference_celsius });
        }
        if file.creep.is_some() {
            return Err(refuse("creep", "absent in a .cal file"));
        }
        if file.signal_unit != SignalUnit::Volt {
            return Err(refuse("signal_unit", "V for a .cal file"));
        }
        let inverse = pseudo_inverse(&file.matrix).ok_or(FileError::Singular)?;
        let rows: [AtiAxis; 6] = core::array::from_fn(|i| AtiAxis {
            values: inverse.row(i).iter().map(|x| x * file.nominal[i]).collect(),
            max: file.nominal[i],
            scale: 1.0,
        });
        if let Some(axis) = rows.iter().position(|row| row.values.iter().any(|value| !value.is_finite())) {
            return Err(FileError::NotFinite { field: format!("inverse of matrix[..][{axis}]") });
        }
        let mut other = Vec::new();
        if let Some([low, high]) = file.range {
            other.push(("OutputRange".to_owned(), (high - low).to_string()));
            other.push(("OutputBipolar".to_owned(), (if low < 0.0 { "True" } else { "False" }).to_owned()));
        }
        Ok(Self {
            serial: file.provenance.serial.clone(),
            body_style: String::new(),
            family: "DAQ".to_owned(),
            file_version: "1.1".to_owned(),
            part_number: String::new(),
            date: file.provenance.date.clone(),
            force_unit: "N".to_owned(),
            torque_unit: "N-m".to_owned(),
            distance_unit: "m".to_owned(),
            other,
            axes: rows.clone(),
            translation: [0.0; 3],
            rotation: [0.0; 3],
            user_axes: Some(rows),
        })
    }

    /// Least and greatest voltage, from `OutputRange` and `OutputBipolar`.
    fn range(&self) -> Option<[f64; 2]> {
        let attribute = |name| self.other.iter().find(|(key, _)| key == name).map(|(_, value)| value.trim());
        let range: f64 = attribute("OutputRange")?.parse().ok()?;
        let bipolar = attribute("OutputBipolar")?.eq_ignore_ascii_case("true");
        let range = if bipolar { [-range / 2.0, range / 2.0] } else { [0.0, range] };
        (range[1] > range[0] && range[1].is_finite()).then_some(range)
    }

    fn size(&self, axis: Axis) -> f64 {
        // Only a struct made by hand can have a unit that is not known; reading refuses it.
        axis.unit_size(if axis.is_torque() { &self.torque_unit } else { &self.force_unit })
            .unwrap_or(f64::NAN)
    }

    /// Rows of elements called `tag`, in SI.
    fn in_si(&self, tag: &str, rows: &[AtiAxis; 6]) -> Result<DMatrix<f64>, AtiError> {
        let gauges = rows.iter().map(|row| row.values.len()).min().unwrap_or(0);
        let matrix =
            DMatrix::from_fn(6, gauges, |i, j| rows[i].values[j] / rows[i].scale * self.size(Axis::ALL[i]));
        for ((row, axis), found) in matrix.row_iter().zip(Axis::ALL).zip(rows) {
            if let Some(gauge) = row.iter().position(|value| !value.is_finite()) {
                return Err(AtiError::BadAttribute {
                    element: format!("{tag} {axis}"),
                    attribute: "values".to_owned(),
                    found: found.values[gauge].to_string(),
                    requirement: FINITE_IN_SI,
                });
            }
        }
        Ok(matrix)
    }
}

pub(super) const FINITE_IN_SI: &str = "must be finite, over the scale and in N or N·m";

/// Metres of a unit of length.
pub(super) fn length(name: &str) -> Option<f64> {
    LengthUnit::from_name(name).map(LengthUnit::in_metres)
}
