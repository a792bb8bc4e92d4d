//! The rest of a sensor, from which a fingertip takes its zero.

use fingertip::wrench::Wrench;
use fingertip_scene::RestWatch;
use nalgebra::{DMatrix, Vector3, Vector6};
use pyo3::prelude::*;

use crate::errors;
use crate::pipe::{Beside, Pipe};

/// The last rest, to take the zero again in a pickle that was loaded.
#[derive(Clone)]
pub(crate) struct Rested {
    pub(crate) readings: DMatrix<f64>,
    pub(crate) gravity: Option<Vector3<f64>>,
    pub(crate) celsius: Option<f64>,
    pub(crate) dummy: Option<Vec<f64>>,
}

impl Rested {
    /// Takes the zero from this rest, within a pipeline of gauges or into `zero` of wrenches; gives what may be wrong with
    /// it, and the noise of the wrench.
    pub(crate) fn take_zero(
        &self,
        pipe: &mut Pipe,
        of_gauges: bool,
        zero: &mut Vector6<f64>,
    ) -> PyResult<(Option<String>, Option<Vector6<f64>>)> {
        let Self { readings, gravity, celsius, dummy } = self;
        let found = if of_gauges {
            for (index, row) in readings.row_iter().enumerate() {
                let gauges: Vec<f64> = row.iter().copied().collect();
                let dummy = dummy.as_ref().and_then(|dummy| dummy.get(index).copied());
                // A reading that cannot be used is passed over, as in a recording.
                let _ = pipe.rest(&gauges, &Beside { motion: None, celsius: *celsius, dummy });
            }
            pipe.end_rest()?
        } else {
            let mut watch = RestWatch::<f64, 6>::default();
            for row in readings.row_iter() {
                let reading = Vector6::from_iterator(row.iter().copied());
                watch.add(&reading, &reading, &Wrench::from_components(&reading));
            }
            *zero = *watch.tare().map_err(errors::reading)?.zero();
            let name = |axis: usize| {
                ["fx", "fy", "fz", "tx", "ty", "tz"].get(axis).map_or(String::new(), |n| (*n).into())
            };
            (watch.doubt(name).map(|doubt| doubt.to_string()), watch.noise())
        };
        if let Some(gravity) = gravity {
            pipe.rest_carried(gravity);
        }
        if let (_, Some(noise)) = &found {
            pipe.know_noise(noise)?;
        }
        Ok(found)
    }
}
