//! The rest of a sensor, from which a fingertip takes its zero.

use fingertip::wrench::Wrench;
use fingertip_scene::RestWatch;
use nalgebra::{DMatrix, Vector3, Vector6};
use pyo3::prelude::*;

use crate::errors;
use crate::fingertip::PyFingertip;
use crate::pipe::Beside;

/// The last rest, to take the zero again in a pickle that was loaded.
#[derive(Clone)]
pub(crate) struct Rested {
    pub(crate) readings: DMatrix<f64>,
    pub(crate) gravity: Option<Vector3<f64>>,
    pub(crate) celsius: Option<f64>,
    pub(crate) dummy: Option<Vec<f64>>,
}

impl PyFingertip {
    /// Takes the zero of a rest; gives what may be wrong with it, and the noise of the wrench.
    pub(crate) fn take_zero(&mut self, rested: &Rested) -> PyResult<(Option<String>, Option<Vector6<f64>>)> {
        let Rested { readings, gravity, celsius, dummy } = rested;
        let found = if self.gauges.is_some() {
            for (index, row) in readings.row_iter().enumerate() {
                let gauges: Vec<f64> = row.iter().copied().collect();
                let dummy = dummy.as_ref().and_then(|dummy| dummy.get(index).copied());
                // A reading that cannot be used is passed over, as in a recording.
                let _ = self.pipe.rest(&gauges, &Beside { motion: None, celsius: *celsius, dummy });
            }
            self.pipe.end_rest()?
        } else {
            let mut watch = RestWatch::<f64, 6>::default();
            for row in readings.row_iter() {
                let reading = Vector6::from_iterator(row.iter().copied());
                watch.add(&reading, &reading, &Wrench::from_components(&reading));
            }
            self.zero = *watch.tare().map_err(errors::reading)?.zero();
            let name = |axis: usize| {
                ["fx", "fy", "fz", "tx", "ty", "tz"].get(axis).map_or(String::new(), |n| (*n).into())
            };
            (watch.doubt(name).map(|doubt| doubt.to_string()), watch.noise())
        };
        if let Some(gravity) = gravity {
            self.pipe.rest_carried(gravity);
        }
        if let (_, Some(noise)) = &found {
            self.pipe.know_noise(noise)?;
        }
        Ok(found)
    }
}
