//! How the sensor lies or moves at each row, for the load of what it carries.

use fingertip::wrench::{Motion, Wrench};
use fingertip_recordings::{InertialColumns, NumberColumn, Row};
use fingertip_scene::Carried;
use nalgebra::Vector3;

use crate::error::CliError;
use crate::opened::Rows;

/// A payload, and where a recording tells how the sensor lies or moves.
pub(super) struct Hanging {
    carried: Carried<f64>,
    told: Told,
    /// Time of rows that did not tell it \[s\].
    waited: f64,
}

/// The columns that tell it.
enum Told {
    /// The orientation.
    Quaternion([NumberColumn; 4]),
    /// The readings of an inertial unit.
    Inertial(InertialColumns),
}

impl Hanging {
    /// The recording must have the orientation of the sensor, in columns `qx` … `qw`, or what its `[inertial_unit]` reads, in
    /// columns `ax` … `wz`; or with the sensor's name before.
    pub(super) fn new(carried: Carried<f64>, reader: &mut Rows, sensor: &str) -> Result<Self, CliError> {
        if carried.has_inertial_unit() {
            let found = reader.watch_inertial_unit(sensor);
            let columns = found.map_err(|problem| CliError::Recording(reader.header_error(problem)))?;
            return Ok(Self { carried, told: Told::Inertial(columns), waited: 0.0 });
        }
        let mut column = |part: &str| {
            let named = format!("{sensor}_{part}");
            reader.watch(&named).or_else(|| reader.watch(part))
        };
        let parts = [column("qx"), column("qy"), column("qz"), column("qw")];
        let [Some(x), Some(y), Some(z), Some(w)] = parts else {
            let message = "has no columns qx, qy, qz, qw that tell how the sensor lies, so that the weight of the \
                           payload cannot be taken off; add them, or an [inertial_unit] to the scene, or leave --payload and [payload] out";
            return Err(CliError::Calibrate { path: reader.file().into(), message: message.to_owned() });
        };
        Ok(Self { carried, told: Told::Quaternion([x, y, z, w]), waited: 0.0 })
    }

    fn gravity(&self, columns: &[NumberColumn; 4], row: &Row<'_>) -> Option<Vector3<f64>> {
        let [x, y, z, w] = columns.each_ref().map(|column| row.number(column));
        self.carried.gravity([x?, y?, z?, w?])
    }

    /// Takes a row of the rest; `false` if it does not tell how the sensor lies.
    pub(super) fn rest(&mut self, row: &Row<'_>) -> bool {
        match &self.told {
            Told::Quaternion(columns) => {
                let Some(gravity) = self.gravity(columns, row) else { return false };
                self.carried.rest(&gravity);
                true
            }
            Told::Inertial(columns) => {
                row.inertial(columns).is_some_and(|reading| self.carried.rest_moving(&reading))
            }
        }
    }

    /// The zero was taken with the body on, in the mean orientation of the rest.
    pub(super) fn end_rest(&mut self) {
        self.carried.end_rest();
    }

    /// The wrench without the body's, `time_step` seconds after the one before; `None` if the row does not tell how the
    /// sensor lies or moves.
    pub(super) fn take_off(
        &mut self,
        measured: &Wrench<f64>,
        row: &Row<'_>,
        time_step: f64,
    ) -> Option<Wrench<f64>> {
        match &self.told {
            Told::Quaternion(columns) => {
                Some(self.carried.take_off(measured, &Motion::resting(self.gravity(columns, row)?)))
            }
            Told::Inertial(columns) => {
                self.waited += time_step;
                let reading = row.inertial(columns)?;
                let time_step = core::mem::take(&mut self.waited);
                if row.marks().gap {
                    self.carried.start_anew();
                }
                self.carried.take_off_moving(measured, &reading, time_step)
            }
        }
    }

    /// By how much what is left comes late \[s\].
    pub(super) fn delay(&self) -> f64 {
        self.carried.delay()
    }
}
