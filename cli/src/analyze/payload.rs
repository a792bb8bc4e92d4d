//! How the sensor lies at each row, for the weight of what it carries.

use fingertip::wrench::{Motion, Wrench};
use fingertip_recordings::{NumberColumn, Row};
use fingertip_scene::Carried;
use nalgebra::Vector3;

use crate::error::CliError;
use crate::opened::Rows;

/// A payload, and where a recording tells how the sensor lies.
pub(super) struct Hanging {
    carried: Carried<f64>,
    quaternion: [NumberColumn; 4],
}

impl Hanging {
    /// The recording must have the orientation of the sensor, in columns `qx` … `qw`, or with the sensor's name
    /// before.
    pub(super) fn new(carried: Carried<f64>, reader: &mut Rows, sensor: &str) -> Result<Self, CliError> {
        let mut column = |part: &str| {
            let named = format!("{sensor}_{part}");
            reader.watch(&named).or_else(|| reader.watch(part))
        };
        let parts = [column("qx"), column("qy"), column("qz"), column("qw")];
        let [Some(x), Some(y), Some(z), Some(w)] = parts else {
            let message = "has no columns qx, qy, qz, qw that tell how the sensor lies, so that the weight of the \
                           payload cannot be taken off; add them or leave --payload and [payload] out";
            return Err(CliError::Calibrate { path: reader.file().into(), message: message.to_owned() });
        };
        Ok(Self { carried, quaternion: [x, y, z, w] })
    }

    fn gravity(&self, row: &Row<'_>) -> Option<Vector3<f64>> {
        let [x, y, z, w] = self.quaternion.each_ref().map(|column| row.number(column));
        self.carried.gravity([x?, y?, z?, w?])
    }

    /// Takes a row of the rest; `false` if it has no orientation.
    pub(super) fn rest(&mut self, row: &Row<'_>) -> bool {
        let Some(gravity) = self.gravity(row) else { return false };
        self.carried.rest(&gravity);
        true
    }

    /// The zero was taken with the body on, in the mean orientation of the rest.
    pub(super) fn end_rest(&mut self) {
        self.carried.end_rest();
    }

    /// The wrench without the body's; `None` if the row has no orientation.
    pub(super) fn take_off(&self, measured: &Wrench<f64>, row: &Row<'_>) -> Option<Wrench<f64>> {
        Some(self.carried.take_off(measured, &Motion::resting(self.gravity(row)?)))
    }
}
