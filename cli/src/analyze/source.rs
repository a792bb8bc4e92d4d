//! From the rows of a recording to wrenches on the fingertip.

use std::fs::File;

use fingertip::wrench::{
    Compensation, DummyGauge, DummyGaugeAccumulator, GaugesAndDummy, GaussianElimination, Tare, TareAccumulator,
    Wrench, WrenchSolver,
};
use fingertip_calibration::file::{CalibrationFile, SignalUnit as CalibratedUnit, Verdict};
use fingertip_drivers::recording::{
    HeaderProblem, Layout, RecordingReader, Row, SignalColumns, SignalUnit, WrenchColumns,
};
use nalgebra::Vector6;

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
    sensor: String,
    notes: Vec<String>,
}

enum Kind {
    Wrenches { columns: WrenchColumns, resting: TareAccumulator<f64, 6>, zero: Vector6<f64> },
    Volts(Box<Volts>),
}

struct Volts {
    columns: SignalColumns,
    solver: GaussianElimination<f64>,
    zero: Zero,
    range: Option<[f64; 2]>,
}

/// What is taken off the volts.
enum Zero {
    /// The zero of the calibration, or of the rest when that is over.
    Tare { resting: TareAccumulator<f64, 6>, tare: Tare<f64, 6> },
    /// The same, and the drift that the dummy gauge shows since the rest.
    Dummy { resting: DummyGaugeAccumulator<f64, 6>, zero: DummyGauge<f64, 6> },
}

impl Source {
    pub(super) fn new(
        reader: &RecordingReader<File>,
        scene: &Scene,
        arguments: &AnalyzeArguments,
    ) -> Result<Self, CliError> {
        let layout = reader.layout();
        if !layout.has_time() && scene.sample_rate.is_none() {
            return Err(CliError::NoTime { path: arguments.recording.clone(), scene: arguments.scene.clone() });
        }
        let header = |problem: HeaderProblem| CliError::Recording(reader.header_error(problem));
        let sensor = arguments.sensor.as_deref().or(scene.sensor.as_deref());
        let mut notes = Vec::new();
        let (kind, sensor) = if arguments.calibration.is_some() {
            let volts = Volts::new(layout, sensor, scene, arguments, &mut notes, header)?;
            let name = volts.columns.name().to_owned();
            (Kind::Volts(Box::new(volts)), name)
        } else {
            if layout.wrenches().is_empty() && sensor.is_none() {
                return Err(CliError::NeedsCalibration { path: arguments.recording.clone() });
            }
            let columns = match sensor {
                Some(sensor) => layout.wrench(sensor),
                None => layout.only_wrench(),
            };
            let columns = columns.map_err(header)?.clone();
            let name = columns.name().to_owned();
            (Kind::Wrenches { columns, resting: TareAccumulator::default(), zero: Vector6::zeros() }, name)
        };
        if scene.rest.is_none() {
            notes.push(match kind {
                Kind::Wrenches { .. } => "no tare: the scene gives no rest_s, the wrenches are taken as they are".to_owned(),
                Kind::Volts(_) => "tare: the zero of the calibration, since the scene gives no rest_s".to_owned(),
            });
        }
        Ok(Self {
            kind,
            convention: scene.convention,
            rest: scene.rest,
            sample_interval: if layout.has_time() { None } else { scene.sample_rate.map(f64::recip) },
            rows: 0,
            first_time: None,
            sensor,
            notes,
        })
    }

    /// Name of the sensor; empty if the recording gives none.
    pub(super) fn sensor(&self) -> &str {
        &self.sensor
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
        let start = *self.first_time.get_or_insert(time);
        match self.rest {
            Some(rest) if !(time - start >= rest) => {
                Ok(Reading::Without(if self.kind.rest(row) { Status::Rest } else { Status::UnusableRow }))
            }
            _ => {
                let rest = self.rest.take();
                self.kind.end_rest().map_err(|()| CliError::NoRest { rest: rest.unwrap_or(0.0) })?;
                Ok(self.kind.read(row, self.convention))
            }
        }
    }
}

impl Kind {
    #[inline]
    fn read(&self, row: &Row<'_>, convention: Convention) -> Reading {
        match self {
            Self::Wrenches { columns, zero, .. } => match row.wrench(columns) {
                Some(recorded) => {
                    let load: Wrench<f64> = Wrench::from_components(&(recorded.components() - zero));
                    Reading::Wrench(convention.wrench(load.force(), load.torque()))
                }
                None => Reading::Without(Status::UnusableRow),
            },
            Self::Volts(volts) => volts.read(row, convention),
        }
    }

    /// Takes a row of the rest; `false` if it is unusable.
    fn rest(&mut self, row: &Row<'_>) -> bool {
        match self {
            Self::Wrenches { columns, resting, .. } => {
                row.wrench(columns).is_some_and(|wrench| resting.add(&wrench.components()))
            }
            Self::Volts(volts) => match &mut volts.zero {
                Zero::Tare { resting, .. } => {
                    row.signals(&volts.columns).is_some_and(|signals| resting.add(&signals))
                }
                Zero::Dummy { resting, .. } => match (row.signals(&volts.columns), row.dummy(&volts.columns)) {
                    (Some(gauges), Some(dummy)) => resting.add(&GaugesAndDummy { gauges, dummy }),
                    _ => false,
                },
            },
        }
    }

    /// Makes the tare of what was collected.
    fn end_rest(&mut self) -> Result<(), ()> {
        match self {
            Self::Wrenches { resting, zero, .. } => *zero = *resting.finish().map_err(drop)?.zero(),
            Self::Volts(volts) => match &mut volts.zero {
                Zero::Tare { resting, tare } => *tare = resting.finish().map_err(drop)?,
                Zero::Dummy { resting, zero } => *zero = resting.finish().map_err(drop)?,
            },
        }
        Ok(())
    }
}

impl Volts {
    fn new(
        layout: &Layout,
        sensor: Option<&str>,
        scene: &Scene,
        arguments: &AnalyzeArguments,
        notes: &mut Vec<String>,
        header: impl Fn(HeaderProblem) -> CliError,
    ) -> Result<Self, CliError> {
        let path = arguments.calibration.clone().unwrap_or_default();
        let fault = |message: String| CliError::Calibration { path: path.clone(), message };
        let file = CalibrationFile::read(&path).map_err(|error| fault(error.to_string()))?;
        let columns = match sensor {
            Some(sensor) => layout.signals_of(sensor),
            None => layout.only_signals(),
        };
        let columns = columns.and_then(|columns| columns.expecting(file.gauges())).map_err(&header)?.clone();
        let agree = matches!(
            (columns.unit(), file.signal_unit),
            (SignalUnit::Volts, CalibratedUnit::Volt)
                | (SignalUnit::Counts, CalibratedUnit::Count)
                | (SignalUnit::Unstated, _)
        );
        if !agree {
            return Err(fault(format!(
                "it is for signals in {:?}, but the recording holds {:?}; use the calibration that belongs to the recording",
                file.signal_unit,
                columns.unit()
            )));
        }
        let matrix = file.sensor_matrix::<6>().map_err(|error| fault(error.to_string()))?;
        let solver = GaussianElimination::new(&matrix).map_err(|error| fault(error.to_string()))?;
        let tare = file.zero::<6>().map_err(|error| fault(error.to_string()))?;
        if file.quality.verdict == Verdict::Bad {
            notes.push(format!("the calibration calls itself bad: {}", file.quality.reasons.join("; ")));
        }
        if file.temperature.is_some() {
            notes.push("the calibration's drift with temperature is not applied".to_owned());
        }
        let zero = if columns.has_dummy() && scene.rest.is_some() {
            Zero::Dummy { resting: DummyGaugeAccumulator::default(), zero: DummyGauge::new(tare, 0.0) }
        } else {
            if columns.has_dummy() {
                notes.push("the dummy gauge is not used: that needs rest_s in the scene".to_owned());
            }
            Zero::Tare { resting: TareAccumulator::default(), tare }
        };
        Ok(Self { columns, solver, zero, range: file.range })
    }

    #[inline]
    fn read(&self, row: &Row<'_>, convention: Convention) -> Reading {
        let Some(gauges) = row.signals::<6>(&self.columns) else {
            return Reading::Without(Status::UnusableRow);
        };
        if let Some([low, high]) = self.range
            && !gauges.iter().all(|gauge| *gauge > low && *gauge < high)
        {
            return Reading::Without(Status::Saturated);
        }
        let signals = match &self.zero {
            Zero::Tare { tare, .. } => tare.compensate(&gauges),
            Zero::Dummy { zero, .. } => match row.dummy(&self.columns) {
                Some(dummy) => zero.compensate(&GaugesAndDummy { gauges, dummy }),
                None => return Reading::Without(Status::UnusableRow),
            },
        };
        let load = self.solver.solve(&signals);
        Reading::Wrench(convention.wrench(load.force(), load.torque()))
    }
}
