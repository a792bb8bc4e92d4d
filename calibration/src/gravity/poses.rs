//! Poses of a sensor that carries a body, and their CSV.

use std::io::Read;

use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3, Vector6};

use crate::Axis;
use crate::loads::LoadError;

/// One pose and what the sensor said in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Columns are the axes of the sensor (or of the flange it is on) in the base frame.
    pub base_from_sensor: Matrix3<f64>,
    /// Reading \[N, N·m\] in the sensor frame.
    pub wrench: Vector6<f64>,
}

impl Pose {
    /// From a quaternion (x, y, z, w), normalised here, and the reading in the sensor frame. `None` if
    /// the quaternion is zero or a number is not finite.
    #[must_use]
    pub fn from_quaternion(xyzw: [f64; 4], wrench: Vector6<f64>) -> Option<Self> {
        let [x, y, z, w] = xyzw;
        let quaternion = Quaternion::new(w, x, y, z);
        let norm = quaternion.norm();
        if !(norm > 0.0 && norm.is_finite() && wrench.iter().all(|x| x.is_finite())) {
            return None;
        }
        let rotation = UnitQuaternion::from_quaternion(quaternion).to_rotation_matrix();
        Some(Self { base_from_sensor: rotation.into_inner(), wrench })
    }

    /// The same pose with a reading that was given in the axes of the base frame (about the origin of
    /// the sensor), as some robots do.
    #[must_use]
    pub fn with_wrench_in_base(&self, wrench: &Vector6<f64>) -> Self {
        Self { wrench: turn(&self.base_from_sensor.transpose(), wrench), ..*self }
    }
}

impl Pose {
    /// The pose of the sensor, if this one is of the flange that it sits on.
    #[must_use]
    pub fn on_mount(&self, sensor_from_flange: &Matrix3<f64>) -> Self {
        Self { base_from_sensor: self.base_from_sensor * sensor_from_flange.transpose(), ..*self }
    }
}

/// Turns force and torque.
pub(super) fn turn(rotation: &Matrix3<f64>, wrench: &Vector6<f64>) -> Vector6<f64> {
    let force = rotation * wrench.fixed_rows::<3>(0);
    let torque = rotation * wrench.fixed_rows::<3>(3);
    Vector6::new(force.x, force.y, force.z, torque.x, torque.y, torque.z)
}

/// Reads poses from CSV with a header: `qx`, `qy`, `qz`, `qw` (the sensor in the base frame) and
/// `fx_N` … `tz_Nm` in units of [`crate::units`]; columns of other names are ignored. The readings are
/// taken as given in the sensor frame: see [`Pose::with_wrench_in_base`].
///
/// # Errors
/// [`LoadError::BadText`], naming line and column.
pub fn poses_from_csv(reader: impl Read) -> Result<Vec<Pose>, LoadError> {
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).comment(Some(b'#')).from_reader(reader);
    let bad = |line: u64, column: &str, message: &str| LoadError::BadText {
        line,
        column: column.to_owned(),
        message: message.to_owned(),
    };
    let header = reader.headers().map_err(|error| bad(1, "", &error.to_string()))?.clone();
    let position = |wanted: &str| {
        header.iter().position(|name| name == wanted).ok_or_else(|| bad(1, wanted, "there is no such column"))
    };
    let quaternion = [position("qx")?, position("qy")?, position("qz")?, position("qw")?];
    let mut components = Vec::new();
    for axis in Axis::ALL {
        let found = header.iter().enumerate().find_map(|(index, name)| {
            let (stem, unit) = name.rsplit_once('_')?;
            (Axis::from_name(stem) == Some(axis)).then_some((index, axis.unit_size(unit)))
        });
        match found {
            Some((index, Some(size))) => components.push((index, size)),
            Some((index, None)) => {
                return Err(bad(1, header.get(index).unwrap_or(""), "the unit is not known"));
            }
            None => {
                return Err(bad(1, axis.name(), "there is no such column with a unit, such as fx_N, tx_Nm"));
            }
        }
    }
    let mut poses = Vec::new();
    for record in reader.records() {
        let record = record
            .map_err(|error| bad(error.position().map_or(0, csv::Position::line), "", &error.to_string()))?;
        let line = record.position().map_or(0, csv::Position::line);
        let number = |index: usize| {
            let number = record.get(index).and_then(|text| text.parse::<f64>().ok());
            number
                .filter(|number| number.is_finite())
                .ok_or_else(|| bad(line, header.get(index).unwrap_or(""), "not a finite number"))
        };
        let mut wrench = Vector6::zeros();
        for (slot, (index, size)) in wrench.iter_mut().zip(&components) {
            *slot = number(*index)? * size;
        }
        let [x, y, z, w] = quaternion;
        let xyzw = [number(x)?, number(y)?, number(z)?, number(w)?];
        poses.push(
            Pose::from_quaternion(xyzw, wrench).ok_or_else(|| bad(line, "qw", "the quaternion is zero"))?,
        );
    }
    Ok(poses)
}

/// A direction as a unit vector; `None` if it has none.
pub(super) fn unit(direction: &Vector3<f64>) -> Option<Vector3<f64>> {
    let norm = direction.norm();
    (norm > 0.0 && norm.is_finite()).then(|| direction / norm)
}
