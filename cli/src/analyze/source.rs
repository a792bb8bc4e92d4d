//! From the rows of a recording to wrenches on the fingertip.

use std::fs::File;

use fingertip::wrench::{TareError, Wrench};
use fingertip_drivers::recording::{HeaderProblem, RecordingReader, Row};

use super::volts::Volts;
use super::wrenches::Wrenches;
use crate::args::AnalyzeArguments;
use crate::error::CliError;
use crate::observe::Status;
use crate::scene::{Convention, Scene};

/// What one row gives.
pub(super) enum Reading {
    Wrench(Wrench<f64>),
    Without(Status),
}

/// Turns rows into wrenches: unit and sign, tare, and for volts the calibration.
pub(super) struct Source {
    kind: Kind,
    convention: Convention,
    /// Seconds at the start in which the sensor is unloaded, while they last.
    rest: Option<f64>,
    /// For recordings without time \[s\].
    sample_interval: Option<f64>,
    rows: u64,
    first_time: Option<f64>,
    notes: Vec<String>,
}

enum Kind {
    Wrenches(Box<Wrenches>),
    Volts(Box<Volts>),
}

impl Source {
    pub(super) fn new(
        reader: &RecordingReader<File>,
        scene: &Scene,
        arguments: &AnalyzeArguments,
    ) -> Result<Self, CliError> {
        let layout = reader.layout();
        if !layout.has_time() && scene.sample_rate.is_none() {
            return Err(CliError::NoTime {
                path: arguments.recording.clone(),
                scene: arguments.scene.clone(),
            });
        }
        let header = |problem: HeaderProblem| CliError::Recording(reader.header_error(problem));
        let sensor = arguments.sensor.as_deref().or(scene.sensor.as_deref());
        let mut notes = Vec::new();
        let kind = if let Some(calibration) = &arguments.calibration {
            let volts = Volts::new(layout, sensor, calibration, scene.rest.is_some(), &mut notes, header)?;
            Kind::Volts(Box::new(volts))
        } else {
            if layout.wrenches().is_empty() && sensor.is_none() {
                return Err(CliError::NeedsCalibration { path: arguments.recording.clone() });
            }
            Kind::Wrenches(Box::new(Wrenches::new(layout, sensor).map_err(header)?))
        };
        if scene.rest.is_none() {
            notes.push(match kind {
                Kind::Wrenches(_) => {
                    "no tare: the scene gives no rest_s, the wrenches are taken as they are".to_owned()
                }
                Kind::Volts(_) => {
                    "tare: the zero of the calibration, since the scene gives no rest_s".to_owned()
                }
            });
        }
        Ok(Self {
            kind,
            convention: scene.convention,
            rest: scene.rest,
            sample_interval: if layout.has_time() { None } else { scene.sample_rate.map(f64::recip) },
            rows: 0,
            first_time: None,
            notes,
        })
    }

    /// Name of the sensor; empty if the recording gives none.
    pub(super) fn sensor(&self) -> &str {
        self.kind.sensor()
    }

    /// What the reader of the results should know.
    pub(super) fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Time of a row, NaN where it has none, and the time since the one before \[s\].
    #[inline]
    pub(super) fn clock(&mut self, row: &Row<'_>) -> (f64, f64) {
        let number = self.rows;
        self.rows += 1;
        match self.sample_interval {
            Some(interval) => (number as f64 * interval, if number > 0 { interval } else { 0.0 }),
            None => (row.time().unwrap_or(f64::NAN), row.time_step().unwrap_or(0.0)),
        }
    }

    /// The seconds of rest that the recording was too short for.
    pub(super) fn unfinished_rest(&self) -> Option<f64> {
        self.rest.filter(|_| self.rows > 0)
    }

    #[inline]
    pub(super) fn read(&mut self, row: &Row<'_>, time: f64) -> Result<Reading, CliError> {
        if self.rest.is_some() {
            return self.read_at_rest(row, time);
        }
        Ok(self.kind.read(row, self.convention))
    }

    /// Collects the tare; the first row behind the rest ends it.
    #[cold]
    fn read_at_rest(&mut self, row: &Row<'_>, time: f64) -> Result<Reading, CliError> {
        if time.is_finite() {
            self.first_time.get_or_insert(time);
        }
        let rested = time - self.first_time.unwrap_or(time);
        match self.rest {
            // A row without time is no reason to end the rest.
            Some(rest) if !(rested >= rest) => {
                Ok(Reading::Without(if self.kind.rest(row) { Status::Rest } else { Status::UnusableRow }))
            }
            _ => {
                let rest = self.rest.take();
                self.kind.end_rest().map_err(|_| CliError::NoRest { rest: rest.unwrap_or(0.0) })?;
                Ok(self.kind.read(row, self.convention))
            }
        }
    }
}

impl Kind {
    #[inline]
    fn read(&self, row: &Row<'_>, convention: Convention) -> Reading {
        let recorded = match self {
            Self::Wrenches(wrenches) => wrenches.read(row),
            Self::Volts(volts) => volts.read(row),
        };
        match recorded {
            Ok(load) => Reading::Wrench(convention.wrench(load.force(), load.torque())),
            Err(status) => Reading::Without(status),
        }
    }

    /// Takes a row of the rest; `false` if it is unusable.
    fn rest(&mut self, row: &Row<'_>) -> bool {
        match self {
            Self::Wrenches(wrenches) => wrenches.rest(row),
            Self::Volts(volts) => volts.rest(row),
        }
    }

    /// Makes the tare of what was collected.
    fn end_rest(&mut self) -> Result<(), TareError> {
        match self {
            Self::Wrenches(wrenches) => wrenches.end_rest(),
            Self::Volts(volts) => volts.end_rest(),
        }
    }

    /// Name of the sensor; empty if the recording gives none.
    fn sensor(&self) -> &str {
        match self {
            Self::Wrenches(wrenches) => wrenches.sensor(),
            Self::Volts(volts) => volts.sensor(),
        }
    }
}
