//! Poses of a sensor that carries a body, and their CSV.

use std::io::Read;

use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3, Vector6};

use crate::loads::{Columns, LoadError};

/// One pose and what the sensor said in it.
///
/// ```
/// use fingertip_calibration::gravity::{Pose, poses_from_csv};
/// use fingertip_calibration::nalgebra::{Vector3, Vector6};
///
/// // The sensor stands on its head: turned by 180° about x. The 4 N of its gripper are along its +z.
/// let pose = Pose::from_quaternion([1.0, 0.0, 0.0, 0.0], Vector6::new(0.0, 0.0, 4.0, 0.0, 0.0, 0.0));
/// let pose = pose.ok_or("no quaternion")?;
/// assert!((pose.base_from_sensor * Vector3::z() + Vector3::z()).norm() < 1e-12);
/// // The same from a file.
/// let text = "qx,qy,qz,qw,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm\n1,0,0,0,0,0,4,0,0,0\n";
/// assert_eq!(poses_from_csv(text.as_bytes())?, [pose]);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
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
    let columns = Columns::from_csv(reader)?;
    let wrenches = columns.wrenches()?;
    let [x, y, z] = ["qx", "qy", "qz"].map(|name| columns.numbers(name));
    let (x, y, z, w) = (x?, y?, z?, columns.numbers("qw")?);
    (0..columns.rows())
        .map(|i| {
            Pose::from_quaternion([x[i], y[i], z[i], w[i]], wrenches[i]).ok_or_else(|| LoadError::BadText {
                line: columns.line(i),
                column: "qw".to_owned(),
                message: "the quaternion is zero".to_owned(),
            })
        })
        .collect()
}

/// A direction as a unit vector; `None` if it has none.
pub(super) fn unit(direction: &Vector3<f64>) -> Option<Vector3<f64>> {
    let norm = direction.norm();
    (norm > 0.0 && norm.is_finite()).then(|| direction / norm)
}
