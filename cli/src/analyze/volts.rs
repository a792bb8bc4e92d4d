//! Recordings of a sensor's signals, which a calibration turns into wrenches.

use std::path::Path;

use fingertip::wrench::{TareError, Wrench};
use fingertip_recordings::{HeaderProblem, Layout, Row};

use super::recorded::Recorded;
use crate::calibrated::{Calibrated, Calibration, Readings};
use crate::error::CliError;
use crate::gauge_rows::{GaugeRows, KnownTemperature};
use crate::observe::Status;
use crate::rest_watch::Doubt;

/// The signals of one sensor and its calibration.
struct Volts {
    rows: GaugeRows,
    calibrated: Box<dyn Calibrated>,
}

/// Reads the calibration; what is to be minded about it is added to `notes`.
pub(super) fn open(
    layout: &Layout,
    sensor: Option<&str>,
    calibration: &Path,
    has_rest: bool,
    temperature: Option<KnownTemperature>,
    notes: &mut Vec<String>,
    header: impl Fn(HeaderProblem) -> CliError,
) -> Result<Box<dyn Recorded>, CliError> {
    let calibration = Calibration::read(calibration)?;
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
    fn read(&self, row: &Row<'_>) -> Result<Wrench<f64>, Status> {
        self.rows.reading(row, |reading| self.calibrated.wrench(reading)).unwrap_or(Err(Status::UnusableRow))
    }

    fn rest(&mut self, row: &Row<'_>) -> Status {
        self.rows.reading(row, |reading| self.calibrated.rest(reading)).unwrap_or(Status::UnusableRow)
    }

    fn end_rest(&mut self) -> Result<(), TareError> {
        self.calibrated.end_rest()
    }

    fn doubt(&self) -> Option<Doubt> {
        self.calibrated.doubt()
    }
}
