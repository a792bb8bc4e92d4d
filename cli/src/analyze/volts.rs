//! Recordings of a sensor's signals, which a calibration turns into wrenches.

use fingertip::wrench::{TareError, Wrench};
use fingertip_recordings::{HeaderProblem, Layout, Row};
use fingertip_scene::{Doubt, Sensor};
use nalgebra::Vector6;

use super::recorded::Recorded;
use crate::calibrated::{Calibration, Readings};
use crate::error::CliError;
use crate::gauge_rows::{GaugeRows, KnownTemperature};
use crate::observe::Status;

/// The signals of one sensor and its calibration.
struct Volts {
    rows: GaugeRows,
    calibrated: Sensor<f64>,
}

/// Of a recording with these columns; what is to be minded about the calibration is added to `notes`.
pub(super) fn open(
    layout: &Layout,
    sensor: Option<&str>,
    calibration: &Calibration<'_>,
    has_rest: bool,
    temperature: Option<KnownTemperature>,
    notes: &mut Vec<String>,
    header: impl Fn(HeaderProblem) -> CliError,
) -> Result<Box<dyn Recorded>, CliError> {
    let rows = GaugeRows::of(layout, sensor, calibration.gauges(), temperature).map_err(header)?;
    let calibrated = calibration.of(&Readings { has_rest, ..rows.readings() }, notes)?;
    Ok(Box::new(Volts { rows, calibrated }))
}

impl Recorded for Volts {
    fn sensor(&self) -> &str {
        self.rows.sensor()
    }

    /// The wrench as the calibration has it.
    #[inline]
    fn read(&mut self, row: &Row<'_>, time_step: f64) -> Result<Wrench<f64>, Status> {
        let wrench = self.rows.reading(row, |reading| self.calibrated.wrench(reading, time_step));
        wrench.map_or(Err(Status::UnusableRow), |wrench| wrench.map_err(Status::without_wrench))
    }

    fn rest(&mut self, row: &Row<'_>) -> Status {
        let rest = self.rows.reading(row, |reading| self.calibrated.rest(reading));
        rest.map_or(Status::UnusableRow, |rest| rest.map_or_else(Status::without_wrench, |()| Status::Rest))
    }

    fn end_rest(&mut self) -> Result<(), TareError> {
        self.calibrated.end_rest()
    }

    fn noise(&self) -> Option<Vector6<f64>> {
        self.calibrated.noise()
    }

    fn doubt(&self) -> Option<Doubt> {
        self.calibrated.doubt()
    }
}
