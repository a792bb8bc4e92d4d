//! Recordings of a sensor's signals, which a calibration turns into wrenches.

use std::path::Path;

use fingertip::wrench::{
    Compensation, DummyGauge, DummyGaugeAccumulator, GaugesAndDummy, GaussianElimination, Tare,
    TareAccumulator, TareError, Wrench, WrenchSolver,
};
use fingertip_calibration::file::{CalibrationFile, SignalUnit as CalibratedUnit, Verdict};
use fingertip_drivers::recording::{HeaderProblem, Layout, Row, SignalColumns, SignalUnit};

use crate::error::CliError;
use crate::observe::Status;

/// The signals of one sensor and its calibration.
pub(super) struct Volts {
    columns: SignalColumns,
    solver: GaussianElimination<f64>,
    zero: Zero,
    /// Readings at or beyond these are saturated.
    range: Option<[f64; 2]>,
}

/// What is taken off the signals.
enum Zero {
    /// The zero of the calibration, or of the rest when that is over.
    Tare { resting: TareAccumulator<f64, 6>, tare: Tare<f64, 6> },
    /// The same, and the drift that the dummy gauge shows since the rest.
    Dummy { resting: DummyGaugeAccumulator<f64, 6>, zero: DummyGauge<f64, 6> },
}

impl Volts {
    /// Reads the calibration; what is to be minded about it is added to `notes`.
    pub(super) fn new(
        layout: &Layout,
        sensor: Option<&str>,
        calibration: &Path,
        has_rest: bool,
        notes: &mut Vec<String>,
        header: impl Fn(HeaderProblem) -> CliError,
    ) -> Result<Self, CliError> {
        let fault = |message: String| CliError::Calibration { path: calibration.to_owned(), message };
        let file = CalibrationFile::read(calibration).map_err(|error| fault(error.to_string()))?;
        let columns = match sensor {
            Some(sensor) => layout.signals_of(sensor),
            None => layout.only_signals(),
        };
        let columns = columns.and_then(|columns| columns.expecting(file.gauges())).map_err(&header)?.clone();
        if !agree(columns.unit(), file.signal_unit) {
            return Err(fault(format!(
                "it is for signals in {:?}, but the recording holds {:?}; use the calibration that belongs to the \
                 recording",
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
        if columns.has_dummy() && !has_rest {
            notes.push("the dummy gauge is not used: that needs rest_s in the scene".to_owned());
        }
        let zero = if columns.has_dummy() && has_rest {
            Zero::Dummy { resting: DummyGaugeAccumulator::default(), zero: DummyGauge::new(tare, 0.0) }
        } else {
            Zero::Tare { resting: TareAccumulator::default(), tare }
        };
        Ok(Self { columns, solver, zero, range: file.range })
    }

    pub(super) fn sensor(&self) -> &str {
        self.columns.name()
    }

    /// The wrench as the calibration has it, or why there is none.
    #[inline]
    pub(super) fn read(&self, row: &Row<'_>) -> Result<Wrench<f64>, Status> {
        let gauges = row.signals::<6>(&self.columns).ok_or(Status::UnusableRow)?;
        if let Some([low, high]) = self.range
            && !gauges.iter().all(|gauge| *gauge > low && *gauge < high)
        {
            return Err(Status::Saturated);
        }
        let signals = match &self.zero {
            Zero::Tare { tare, .. } => tare.compensate(&gauges),
            Zero::Dummy { zero, .. } => {
                let dummy = row.dummy(&self.columns).ok_or(Status::UnusableRow)?;
                zero.compensate(&GaugesAndDummy { gauges, dummy })
            }
        };
        Ok(self.solver.solve(&signals))
    }

    /// Takes a row of the rest; `false` if it is unusable.
    pub(super) fn rest(&mut self, row: &Row<'_>) -> bool {
        let Some(gauges) = row.signals(&self.columns) else { return false };
        match &mut self.zero {
            Zero::Tare { resting, .. } => resting.add(&gauges),
            Zero::Dummy { resting, .. } => {
                row.dummy(&self.columns).is_some_and(|dummy| resting.add(&GaugesAndDummy { gauges, dummy }))
            }
        }
    }

    /// The mean of the rest is the zero from now on.
    pub(super) fn end_rest(&mut self) -> Result<(), TareError> {
        match &mut self.zero {
            Zero::Tare { resting, tare } => *tare = resting.finish()?,
            Zero::Dummy { resting, zero } => *zero = resting.finish()?,
        }
        Ok(())
    }
}

/// Whether a calibration is in the unit of a recording. Columns that do not state theirs are taken
/// at their user's word.
const fn agree(recorded: SignalUnit, calibrated: CalibratedUnit) -> bool {
    matches!(
        (recorded, calibrated),
        (SignalUnit::Volts, CalibratedUnit::Volt)
            | (SignalUnit::Counts, CalibratedUnit::Count)
            | (SignalUnit::Unstated, _)
    )
}
