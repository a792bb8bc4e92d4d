//! What hangs on the sensor, and how it hangs at each row.

use std::path::Path;

use fingertip::wrench::{Payload, Wrench};
use fingertip_calibration::file::PayloadFile;
use fingertip_recordings::{NumberColumn, Row};
use nalgebra::Vector3;

use super::files::Rows;

use crate::calibrate::files::{bad, read_payload};
use crate::error::CliError;

/// A payload, and where a recording tells how the sensor lies.
pub(super) struct Carried {
    file: PayloadFile,
    body: Payload<f64>,
    quaternion: [NumberColumn; 4],
    /// Sum and number of the gravities \[m/s²\] during the rest.
    resting: (Vector3<f64>, u32),
    /// Gravity in the sensor frame when the zero was taken; none if the file's zero is used.
    at_tare: Option<Vector3<f64>>,
}

impl Carried {
    /// Reads the payload; the recording must have the orientation of the sensor, in columns `qx` … `qw`, or
    /// with the sensor's name before.
    pub(super) fn open(path: &Path, reader: &mut Rows, sensor: &str) -> Result<Self, CliError> {
        let file = read_payload(path)?;
        let body = file.payload().map_err(|error| bad(path, &error))?;
        let mut column = |part: &str| {
            let named = format!("{sensor}_{part}");
            reader.watch(&named).or_else(|| reader.watch(part))
        };
        let parts = [column("qx"), column("qy"), column("qz"), column("qw")];
        let [Some(x), Some(y), Some(z), Some(w)] = parts else {
            let message = "has no columns qx, qy, qz, qw that tell how the sensor lies, so that the weight of \
                           --payload cannot be taken off; add them or leave --payload out";
            return Err(CliError::Calibrate { path: reader.file().into(), message: message.to_owned() });
        };
        let quaternion = [x, y, z, w];
        Ok(Self { file, body, quaternion, resting: (Vector3::zeros(), 0), at_tare: None })
    }

    fn gravity(&self, row: &Row<'_>) -> Option<Vector3<f64>> {
        let [x, y, z, w] = self.quaternion.each_ref().map(|column| row.number(column));
        self.file.gravity_at([x?, y?, z?, w?])
    }

    /// Takes a row of the rest; `false` if it has no orientation.
    pub(super) fn rest(&mut self, row: &Row<'_>) -> bool {
        let Some(gravity) = self.gravity(row) else { return false };
        self.resting = (self.resting.0 + gravity, self.resting.1 + 1);
        true
    }

    /// The zero was taken with the body on, in the mean orientation of the rest.
    pub(super) fn end_rest(&mut self) {
        self.at_tare = Some(self.resting.0 / f64::from(self.resting.1.max(1)));
    }

    /// The body.
    pub(super) const fn payload(&self) -> Payload<f64> {
        self.body
    }

    /// What the sensor reads without load and without the body; zero if the rest has taken it off.
    pub(super) fn bias(&self) -> Wrench<f64> {
        if self.at_tare.is_some() { Wrench::zero() } else { self.file.bias() }
    }

    /// Gravity in the sensor frame \[m/s²\], less that under which the zero was taken with the body on; `None`
    /// if the row has no orientation.
    pub(super) fn gravity_since_zero(&self, row: &Row<'_>) -> Option<Vector3<f64>> {
        Some(self.gravity(row)? - self.at_tare.unwrap_or_else(Vector3::zeros))
    }
}
