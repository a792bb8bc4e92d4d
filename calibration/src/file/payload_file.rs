//! What hangs on the sensor, as it is written to a file.

use std::io;
use std::path::Path;

use fingertip_wrench::{BadInertialUnit, BadPayload, InertialUnit, Payload, Real, Wrench};
use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};
use toml::Value;

use super::bounded::read_text;
use super::document::{compare, malformed, open, write};
use super::{FileError, Provenance, Verdict};

/// Mass, centre of mass and zero of a sensor that carries a body, and how it sits on its flange: what
/// takes the weight off a measured wrench wherever the hand turns.
///
/// ```
/// use fingertip_calibration::file::PayloadFile;
/// use fingertip_calibration::nalgebra::{Matrix3, Vector3};
///
/// let file = PayloadFile::new(0.020, Vector3::new(0.0, 0.0, 0.015), Vector3::new(0.0, 0.0, -9.80665))?;
/// let again = PayloadFile::from_toml(&file.to_toml()?)?;
/// assert_eq!(again, file);
/// // Upright, the weight pulls along −z of the sensor.
/// let gravity = again.gravity_in_sensor(&Matrix3::identity());
/// assert_eq!(again.payload::<f64>()?.weight(&gravity).force().z, -0.020 * 9.80665);
/// # Ok::<(), fingertip_calibration::file::FileError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PayloadFile {
    /// Mass \[kg\].
    #[serde(rename = "mass_kg")]
    pub mass: f64,
    /// Centre of mass in the sensor frame \[m\].
    #[serde(rename = "centre_of_mass_m")]
    pub centre_of_mass: [f64; 3],
    /// Rows of the inertia about the centre of mass, along the axes of the sensor \[kg·m²\]; that of a point if it is not told.
    #[serde(rename = "inertia_kg_m2", default, skip_serializing_if = "is_of_a_point")]
    pub inertia: [[f64; 3]; 3],
    /// Gravity in the base frame, in which orientations are given \[m/s²\].
    #[serde(rename = "gravity_m_per_s2")]
    pub gravity: [f64; 3],
    /// Force that the sensor reads without load \[N\], in its frame.
    #[serde(rename = "force_bias_N")]
    pub force_bias: [f64; 3],
    /// Torque that the sensor reads without load \[N·m\], in its frame.
    #[serde(rename = "torque_bias_Nm")]
    pub torque_bias: [f64; 3],
    /// Rows of the rotation from the frame whose orientation is recorded (the flange) to the sensor's:
    /// the identity if the sensor's own orientation is recorded.
    pub sensor_from_flange: [[f64; 3]; 3],
    /// The inertial unit whose readings take it off under motion, if it was fitted with one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inertial_unit: Option<InertialUnitFile>,
    /// How well this is known.
    pub quality: PayloadQuality,
    /// Where this comes from.
    pub provenance: Provenance,
}

/// How well a payload is known.
///
/// ```
/// use fingertip_calibration::file::{PayloadFile, PayloadQuality, Verdict};
/// use fingertip_calibration::nalgebra::Vector3;
///
/// // A gripper of 0.4 kg whose data sheet we believe: nothing was fitted.
/// let gripper = PayloadFile::new(0.4, Vector3::new(0.0, 0.0, 0.05), Vector3::new(0.0, 0.0, -9.81))?;
/// let quality: &PayloadQuality = &gripper.quality;
/// assert_eq!((quality.poses, quality.verdict), (0, Verdict::Unchecked));
/// # Ok::<(), fingertip_calibration::file::FileError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PayloadQuality {
    /// How many poses, or rows of a motion, stand behind it; 0 if it was not fitted.
    pub poses: u64,
    /// Standard deviation of the mass \[kg\].
    #[serde(rename = "mass_deviation_kg")]
    pub mass_deviation: f64,
    /// Standard deviations of the centre of mass \[m\].
    #[serde(rename = "centre_deviation_m")]
    pub centre_deviation: [f64; 3],
    /// RMS of what is left, per component \[N, N·m\].
    #[serde(rename = "rms_N_Nm")]
    pub rms: [f64; 6],
    /// What to mind.
    pub warnings: Vec<String>,
    /// Whether it can be trusted.
    #[serde(skip_serializing_if = "is_unchecked")]
    pub verdict: Verdict,
}

/// An inertial unit on the sensor, as it was when a payload was fitted by its readings.
///
/// ```
/// use fingertip_calibration::file::InertialUnitFile;
///
/// // 20 mm above the sensor's origin, its axes turned by 90° about z.
/// let unit = InertialUnitFile {
///     position: [0.0, 0.0, 0.02],
///     sensor_from_unit: [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]],
///     resting_rate: [0.0; 3],
///     time_constant: 0.01,
///     delay: 0.002,
/// };
/// assert!(unit.unit::<f32>().is_ok());
/// // Axes that are no rotation are refused.
/// assert!(InertialUnitFile { sensor_from_unit: [[1.0; 3]; 3], ..unit }.unit::<f32>().is_err());
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct InertialUnitFile {
    /// Where its accelerometer sits, in the sensor frame \[m\].
    #[serde(rename = "position_m")]
    pub position: [f64; 3],
    /// Rows of the rotation from its axes to the sensor's.
    pub sensor_from_unit: [[f64; 3]; 3],
    /// What its gyroscope reads at rest, along its axes \[rad/s\].
    #[serde(rename = "resting_rate_rad_per_s")]
    pub resting_rate: [f64; 3],
    /// Time constant of the filter of all readings \[s\].
    #[serde(rename = "time_constant_s")]
    pub time_constant: f64,
    /// So much later than the wrench its readings come \[s\]; negative if the wrench comes later.
    #[serde(rename = "delay_s")]
    pub delay: f64,
}

impl InertialUnitFile {
    /// The unit, in any scalar type.
    ///
    /// # Errors
    /// [`BadInertialUnit`].
    pub fn unit<T: Real>(&self) -> Result<InertialUnit<T>, BadInertialUnit> {
        let rotation = Matrix3::from_fn(|i, j| T::literal(self.sensor_from_unit[i][j]));
        InertialUnit::new(rotation, Vector3::from(self.position).map(T::literal))?
            .with_resting_rate(Vector3::from(self.resting_rate).map(T::literal))
    }

    fn validate(&self) -> Result<(), FileError> {
        let wrong = |field: &str, requirement| {
            Err(FileError::OutOfRange { field: format!("inertial_unit.{field}"), requirement })
        };
        match self.unit::<f64>() {
            Err(BadInertialUnit::Rotation) => {
                return wrong("sensor_from_unit", "a rotation: orthonormal rows, determinant 1");
            }
            Err(BadInertialUnit::Position) => return wrong("position_m", "finite"),
            Err(_) => return wrong("resting_rate_rad_per_s", "finite"),
            Ok(_) => {}
        }
        if !(self.time_constant > 0.0 && self.time_constant.is_finite()) {
            return wrong("time_constant_s", "positive and finite");
        }
        if !self.delay.is_finite() {
            return wrong("delay_s", "finite");
        }
        Ok(())
    }
}

fn is_of_a_point(inertia: &[[f64; 3]; 3]) -> bool {
    *inertia == [[0.0; 3]; 3]
}

/// Files of before say nothing of it.
fn is_unchecked(verdict: &Verdict) -> bool {
    *verdict == Verdict::Unchecked
}

const IDENTITY: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

impl PayloadFile {
    /// Of a body that is known, on a sensor without zero error whose own orientation is recorded.
    ///
    /// # Errors
    /// As [`validate`](Self::validate).
    pub fn new(mass: f64, centre_of_mass: Vector3<f64>, gravity: Vector3<f64>) -> Result<Self, FileError> {
        let file = Self {
            mass,
            centre_of_mass: centre_of_mass.into(),
            inertia: [[0.0; 3]; 3],
            gravity: gravity.into(),
            force_bias: [0.0; 3],
            torque_bias: [0.0; 3],
            sensor_from_flange: IDENTITY,
            inertial_unit: None,
            quality: PayloadQuality::default(),
            provenance: Provenance { tool: crate::TOOL.to_owned(), ..Provenance::default() },
        };
        file.validate()?;
        Ok(file)
    }

    /// Checks that every number is finite, the mass not negative and the rotation one.
    ///
    /// # Errors
    /// [`FileError`] naming the field.
    pub fn validate(&self) -> Result<(), FileError> {
        let quality = &self.quality;
        let rotation: Vec<f64> = self.sensor_from_flange.iter().flatten().copied().collect();
        for (field, list) in [
            ("mass_kg", &[self.mass][..]),
            ("centre_of_mass_m", &self.centre_of_mass),
            ("gravity_m_per_s2", &self.gravity),
            ("force_bias_N", &self.force_bias),
            ("torque_bias_Nm", &self.torque_bias),
            ("sensor_from_flange", &rotation),
            ("quality.mass_deviation_kg", &[quality.mass_deviation]),
            ("quality.centre_deviation_m", &quality.centre_deviation),
            ("quality.rms_N_Nm", &quality.rms),
        ] {
            if list.iter().any(|x| !x.is_finite()) {
                return Err(FileError::NotFinite { field: field.to_owned() });
            }
        }
        let wrong =
            |field: &str, requirement| Err(FileError::OutOfRange { field: field.to_owned(), requirement });
        if self.mass < 0.0 {
            return wrong("mass_kg", "zero or positive");
        }
        if self.payload::<f64>().is_err() {
            return wrong("inertia_kg_m2", "finite, symmetric, and not negative about an axis");
        }
        if let Some(unit) = &self.inertial_unit {
            unit.validate()?;
        }
        let turn = self.rotation();
        let slack = (turn * turn.transpose() - Matrix3::identity()).amax();
        if !(slack < 1e-6 && turn.determinant() > 0.0) {
            return wrong("sensor_from_flange", "a rotation: orthonormal rows, determinant 1");
        }
        Ok(())
    }

    fn rotation(&self) -> Matrix3<f64> {
        Matrix3::from_fn(|i, j| self.sensor_from_flange[i][j])
    }

    /// The body, in any scalar type.
    ///
    /// # Errors
    /// [`FileError::OutOfRange`] if the numbers are none in that type.
    pub fn payload<T: Real>(&self) -> Result<Payload<T>, FileError> {
        let centre = Vector3::from(self.centre_of_mass).map(T::literal);
        let inertia = Matrix3::from_fn(|i, j| T::literal(self.inertia[i][j]));
        let body = Payload::new(T::literal(self.mass), centre).and_then(|body| body.with_inertia(inertia));
        body.map_err(|fault| match fault {
            BadPayload::BadInertia => FileError::OutOfRange {
                field: "inertia_kg_m2".to_owned(),
                requirement: "an inertia in this scalar type",
            },
            BadPayload::BadMass => FileError::OutOfRange {
                field: "mass_kg".to_owned(),
                requirement: "a mass in this scalar type",
            },
            _ => FileError::OutOfRange {
                field: "centre_of_mass_m".to_owned(),
                requirement: "a point in this scalar type",
            },
        })
    }

    /// Gravity in the sensor frame \[m/s²\], from the recorded orientation: columns are the axes of the
    /// flange in the base frame.
    #[must_use]
    pub fn gravity_in_sensor(&self, base_from_flange: &Matrix3<f64>) -> Vector3<f64> {
        self.rotation() * (base_from_flange.transpose() * Vector3::from(self.gravity))
    }

    /// As [`gravity_in_sensor`](Self::gravity_in_sensor), from a quaternion (x, y, z, w) of any length;
    /// `None` if it is zero or not finite.
    #[must_use]
    pub fn gravity_at(&self, [x, y, z, w]: [f64; 4]) -> Option<Vector3<f64>> {
        let quaternion = nalgebra::Quaternion::new(w, x, y, z);
        let norm = quaternion.norm();
        (norm > 0.0 && norm.is_finite()).then(|| {
            let turn = UnitQuaternion::from_quaternion(quaternion).to_rotation_matrix();
            self.gravity_in_sensor(turn.matrix())
        })
    }

    /// What the sensor reads without load.
    #[must_use]
    pub fn bias(&self) -> Wrench<f64> {
        Wrench::on_fingertip(self.force_bias.into(), self.torque_bias.into())
    }

    /// Reads a payload file.
    ///
    /// # Errors
    /// [`FileError`], naming the field, as [`CalibrationFile::read`](super::CalibrationFile::read).
    pub fn read(path: impl AsRef<Path>) -> Result<Self, FileError> {
        let path = path.as_ref();
        let fault = |source: io::Error| FileError::Io { path: path.display().to_string(), source };
        Self::from_toml(&read_text(path).map_err(fault)?)
    }

    /// Reads the text of a payload file.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn from_toml(text: &str) -> Result<Self, FileError> {
        let (table, checksum) = open(text)?;
        let file: Self = Value::Table(table).try_into().map_err(malformed)?;
        file.validate()?;
        compare(&file, checksum.ok_or_else(|| malformed("missing field `checksum`"))?)?;
        Ok(file)
    }

    /// The text of the payload file.
    ///
    /// # Errors
    /// [`FileError`] if a number is not valid.
    pub fn to_toml(&self) -> Result<String, FileError> {
        self.validate()?;
        write("What hangs on a force/torque sensor", 1, self)
    }
}

#[cfg(test)]
mod tests {
    use super::{FileError, PayloadFile};
    use crate::testing::Largest as _;
    use nalgebra::{Matrix3, Vector3};

    fn file() -> PayloadFile {
        PayloadFile::new(0.02, Vector3::new(0.001, -0.002, 0.03), Vector3::new(0.0, 0.0, -9.8)).unwrap()
    }

    #[test]
    fn round_trip_is_exact_and_damage_is_named() {
        let text = file().to_toml().unwrap();
        assert_eq!(PayloadFile::from_toml(&text).unwrap(), file());
        for (from, to, expected) in [
            ("mass_kg = 0.02", "mass_kg = 0.03", "checksum"),
            ("mass_kg = 0.02", "mass_kg = -0.02", "mass_kg"),
            ("mass_kg = 0.02", "mass_kg = nan", "mass_kg"),
            ("mass_kg = 0.02", "mass_g = 20.0", "mass_g"),
            ("[1.0, 0.0, 0.0]", "[2.0, 0.0, 0.0]", "sensor_from_flange"),
            ("[1.0, 0.0, 0.0]", "[-1.0, 0.0, 0.0]", "sensor_from_flange"),
            ("[1.0, 0.0, 0.0]", "[1.0, 1e-5, 0.0]", "sensor_from_flange"),
            ("version = 1", "version = 7", "version 7"),
        ] {
            let broken = text.replacen(from, to, 1);
            assert!(broken != text, "{from} in {text}");
            let error = PayloadFile::from_toml(&broken).unwrap_err().to_string();
            assert!(error.contains(expected), "{error}");
        }
        let unit = super::InertialUnitFile {
            position: [0.01, 0.0, -0.02],
            sensor_from_unit: super::IDENTITY,
            resting_rate: [0.0, 0.001, 0.0],
            time_constant: 0.01,
            delay: -0.003,
        };
        let inertia = [[0.05, 0.03, 0.0], [0.03, 0.06, 0.0], [0.0, 0.0, 0.07]];
        let moving = PayloadFile { inertia, inertial_unit: Some(unit), ..file() };
        let text = moving.to_toml().unwrap();
        assert_eq!(PayloadFile::from_toml(&text).unwrap(), moving);
        assert_eq!(moving.payload::<f64>().unwrap().inertia()[(0, 1)], 0.03);
        for (from, to, expected) in [
            ("[0.05", "[-0.05", "inertia_kg_m2"),
            ("[0.03, 0.06", "[0.04, 0.06", "inertia_kg_m2"),
            ("time_constant_s = 0.01", "time_constant_s = 0.0", "time_constant_s"),
            ("delay_s = -0.003", "delay_s = nan", "delay_s"),
            ("delay_s = -0.003", "delay_s = -0.004", "checksum"),
            ("position_m = [0.01", "position_m = [inf", "position_m"),
            ("[0.0, 0.001", "[nan, 0.001", "resting_rate"),
        ] {
            let broken = text.replacen(from, to, 1);
            assert!(broken != text, "{from} in {text}");
            let error = PayloadFile::from_toml(&broken).unwrap_err().to_string();
            assert!(error.contains(expected), "{error}");
        }
        let huge = PayloadFile { mass: 1e60, ..file() };
        assert!(matches!(huge.payload::<f32>(), Err(FileError::OutOfRange { .. })));
    }

    #[test]
    fn gravity_turns_with_the_flange_and_the_mounting() {
        let mut file = file();
        // The sensor sits a quarter turn about z on its flange.
        file.sensor_from_flange = [[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
        file.validate().unwrap();
        // The flange lies on its side: its y axis is the base's z axis.
        let turn = Matrix3::new(1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0);
        assert!((file.gravity_in_sensor(&turn) - Vector3::new(-9.8, 0.0, 0.0)).largest() < 1e-15);
        let half = core::f64::consts::FRAC_1_SQRT_2;
        let gravity = file.gravity_at([3.0 * half, 0.0, 0.0, 3.0 * half]).unwrap();
        assert!((gravity - Vector3::new(-9.8, 0.0, 0.0)).largest() < 1e-14);
        assert_eq!((file.gravity_at([0.0; 4]), file.gravity_at([f64::NAN; 4])), (None, None));
    }
}
