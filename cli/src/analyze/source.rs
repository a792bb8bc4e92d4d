//! From the rows of a recording to wrenches on the fingertip.

use std::path::{Path, PathBuf};

use fingertip::wrench::Wrench;
use fingertip_recordings::{HeaderProblem, Row};
use nalgebra::Vector6;

use super::args::AnalyzeArguments;
use super::payload::Hanging;
use super::recorded::Recorded;
use super::volts;
use super::wrenches::Wrenches;
use crate::calibrated::Calibration;
use crate::error::CliError;
use crate::gauge_rows::KnownTemperature;
use crate::observe::Status;
use crate::opened::Rows;
use crate::output::printable;
use crate::span::Window;
use fingertip_scene::{Convention, Scene};

/// What one row gives.
pub(super) enum Reading {
    /// The load on the fingertip.
    Wrench(Wrench<f64>),
    Without(Status),
}

/// A rest that fails its test while its forces range over so many times the threshold of contact is
/// no rest.
const UNMISTAKABLE: f64 = 100.0;

/// Turns rows into wrenches: unit and sign, tare, and for volts the calibration.
pub(super) struct Source {
    recorded: Box<dyn Recorded>,
    /// What hangs on the sensor.
    hanging: Option<Hanging>,
    /// Forces below this are no contact \[N\].
    least_force: f64,
    convention: Convention,
    /// Seconds at the start in which the sensor is unloaded, while they last.
    rest: Option<f64>,
    /// For recordings without time \[s\].
    sample_interval: Option<f64>,
    /// For messages.
    recording: PathBuf,
    /// Whether a calibration turns readings into wrenches.
    calibrated: bool,
    rows: u64,
    /// Since the row before, and what rows without a wrench add to it \[s\].
    time_step: f64,
    first_time: Option<f64>,
    notes: Vec<String>,
}

impl Source {
    pub(super) fn new(
        reader: &mut Rows,
        scene: &Scene,
        recording: &Path,
        arguments: &AnalyzeArguments,
        mut notes: Vec<String>,
    ) -> Result<Self, CliError> {
        let column = reader.watch("temperature_C").map(KnownTemperature::Column);
        let known = |celsius: Option<f64>| celsius.map(KnownTemperature::Constant);
        let temperature = known(arguments.celsius).or(column).or(known(scene.celsius()));
        let layout = reader.layout();
        let has_time = layout.has_time();
        if !has_time && scene.sample_rate().is_none() {
            return Err(CliError::NoTime { path: recording.to_owned(), scene: arguments.scene.clone() });
        }
        let header = |problem: HeaderProblem| CliError::Recording(reader.header_error(problem));
        let sensor = arguments.sensor.as_deref().or(scene.sensor_name());
        let has_signals = !layout.signals().is_empty();
        let calibration = match scene.calibration() {
            // The user asked for it, and is told if it fits nothing.
            Some(file) if has_signals || arguments.calibration.is_some() => {
                let path = arguments.calibration.as_ref().unwrap_or(&arguments.scene);
                Some(Calibration::of_scene(file.clone(), path))
            }
            Some(_) => {
                notes.push("[sensor] of the scene is not used: the recording holds wrenches".to_owned());
                None
            }
            None => None,
        };
        let recorded: Box<dyn Recorded> = if let Some(calibration) = &calibration {
            let has_rest = scene.rest().is_some();
            volts::open(layout, sensor, calibration, has_rest, temperature, &mut notes, header)?
        } else {
            if layout.wrenches().is_empty() && sensor.is_none() {
                return Err(CliError::NeedsCalibration { path: recording.to_owned() });
            }
            Box::new(Wrenches::new(layout, sensor).map_err(header)?)
        };
        if scene.rest().is_none() {
            let note = if calibration.is_some() {
                "tare: the zero of the calibration, since the scene gives no rest_s"
            } else {
                "no tare: the scene gives no rest_s, the wrenches are taken as they are"
            };
            notes.push(note.to_owned());
        }
        notes.extend(scene.doubts());
        if scene.delay() > 0.0 {
            let late = scene.delay() * 1e3;
            notes.push(format!("the filter makes what changes slowly come {late:.1} ms late"));
        }
        let carried = scene.carried().cloned();
        let hanging = carried.map(|carried| Hanging::new(carried, reader, recorded.sensor())).transpose()?;
        if let Some(late) = hanging.as_ref().map(Hanging::delay).filter(|late| *late > 0.0) {
            let late = late * 1e3;
            notes.push(format!("behind the inertial unit, what changes slowly comes {late:.1} ms late"));
        }
        Ok(Self {
            recorded,
            hanging,
            least_force: scene.least_force(),
            convention: scene.convention(),
            rest: scene.rest(),
            sample_interval: if has_time { None } else { scene.sample_rate().map(f64::recip) },
            recording: recording.to_owned(),
            calibrated: calibration.is_some(),
            rows: 0,
            time_step: 0.0,
            first_time: None,
            notes,
        })
    }

    /// Name of the sensor; empty if the recording gives none.
    pub(super) fn sensor(&self) -> &str {
        self.recorded.sensor()
    }

    /// Standard deviation of each component of the wrench in the rest \[N, N·m\].
    pub(super) fn noise(&self) -> Option<Vector6<f64>> {
        self.recorded.noise()
    }

    /// Adds what the reader of the results should know.
    pub(super) fn note(&mut self, note: String) {
        self.notes.push(note);
    }

    /// Whether a calibration turns readings into wrenches.
    pub(super) fn is_calibrated(&self) -> bool {
        self.calibrated
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
        let (time, step) = match self.sample_interval {
            Some(interval) => (number as f64 * interval, if number > 0 { interval } else { 0.0 }),
            None => (row.time().unwrap_or(f64::NAN), row.time_step().unwrap_or(0.0)),
        };
        self.time_step += step;
        (time, step)
    }

    /// How many rows of the recording have come.
    pub(super) const fn rows(&self) -> u64 {
        self.rows
    }

    /// The seconds of rest that the recording was too short for.
    fn unfinished_rest(&self) -> Option<f64> {
        self.rest.filter(|_| self.rows > 0)
    }

    /// Fails where the recording is shorter than the rest, of which it had so many rows, or where `--end` cut it off before.
    pub(super) fn has_rested(&self, window: &Window, recording: &Path, rows: u64) -> Result<(), CliError> {
        let Some(rest) = self.unfinished_rest() else { return Ok(()) };
        Err(match window.end() {
            Some(end) => CliError::option("--end", end, "must be behind `rest_s` of the scene"),
            None => CliError::RestTooLong { path: recording.to_owned(), rest, rows },
        })
    }

    #[inline]
    pub(super) fn read(&mut self, row: &Row<'_>, time: f64) -> Result<Reading, CliError> {
        if self.rest.is_some() {
            return self.read_at_rest(row, time);
        }
        Ok(self.read_load(row))
    }

    #[inline]
    fn read_load(&mut self, row: &Row<'_>) -> Reading {
        let load = match self.recorded.read(row, self.time_step) {
            Ok(load) => self.convention.wrench(load.force(), load.torque()),
            Err(status) => return Reading::Without(status),
        };
        let time_step = core::mem::take(&mut self.time_step);
        match &mut self.hanging {
            None => Reading::Wrench(load),
            Some(hanging) => hanging
                .take_off(&load, row, time_step)
                .map_or(Reading::Without(Status::UnusableRow), Reading::Wrench),
        }
    }

    /// Refuses a rest that clearly was none, and warns of a doubtful one.
    fn judge_rest(&mut self, rest: f64) -> Result<(), CliError> {
        let Some(doubt) = self.recorded.doubt() else { return Ok(()) };
        if self.least_force > 0.0 && doubt.force_range > UNMISTAKABLE * self.least_force {
            return Err(CliError::NotAtRest { path: self.recording.clone(), rest, seen: doubt.to_string() });
        }
        let warning = format!(
            "the sensor may not have been at rest in the first {rest} s, from which the tare is taken: {doubt}; if \
             contacts look wrong, shorten rest_s of the scene to the part without load and motion, or set it to 0"
        );
        // Those who read only the table of contacts should learn of it too.
        eprintln!("warning: {}", printable(&warning));
        self.notes.insert(0, warning);
        Ok(())
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
                if self.hanging.as_mut().is_some_and(|hanging| !hanging.rest(row)) {
                    return Ok(Reading::Without(Status::UnusableRow));
                }
                Ok(Reading::Without(self.recorded.rest(row)))
            }
            _ => {
                let rest = self.rest.take().unwrap_or(0.0);
                self.recorded.end_rest().map_err(|_| CliError::NoRest { rest })?;
                self.judge_rest(rest)?;
                if let Some(hanging) = &mut self.hanging {
                    hanging.end_rest();
                }
                Ok(self.read_load(row))
            }
        }
    }
}
