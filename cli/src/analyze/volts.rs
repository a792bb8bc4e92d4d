//! Recordings of a sensor's signals, which a calibration turns into wrenches.

use std::path::Path;

use fingertip::wrench::{
    Compensation, DummyGauge, DummyGaugeAccumulator, GaugesAndDummy, GaugesAndTemperature,
    GaussianElimination, LeastSquares, Tare, TareAccumulator, TareError, TemperatureCompensation, Wrench,
    WrenchSolver,
};
use fingertip_calibration::file::{CalibrationFile, SignalUnit as CalibratedUnit, Verdict};
use fingertip_drivers::recording::{HeaderProblem, Layout, NumberColumn, Row, SignalColumns, SignalUnit};
use nalgebra::SVector;

use super::recorded::Recorded;
use super::rest::{Doubt, RestWatch};
use crate::error::CliError;
use crate::observe::Status;

/// The signals of one sensor and its calibration.
struct Volts<S, const N: usize> {
    columns: SignalColumns,
    solver: S,
    zero: Zero<N>,
    watch: RestWatch<N>,
    /// Readings at or beyond these are saturated.
    range: Option<[f64; 2]>,
}

/// What is taken off the signals.
enum Zero<const N: usize> {
    /// The zero of the calibration, or of the rest when that is over.
    Tare { resting: TareAccumulator<f64, N>, tare: Tare<f64, N> },
    /// Zero and drift at the temperature of the sensor, and what the rest left of it.
    Warm {
        drift: Box<TemperatureCompensation<f64, N, 3>>,
        celsius: KnownTemperature,
        resting: TareAccumulator<f64, N>,
        tare: Tare<f64, N>,
    },
    /// The same, and the drift that the dummy gauge shows since the rest.
    Dummy { resting: DummyGaugeAccumulator<f64, N>, zero: DummyGauge<f64, N> },
}

/// Where the temperature of the sensor is known from.
#[derive(Clone, Copy, Debug)]
pub(super) enum KnownTemperature {
    /// It is in the recording.
    Column(NumberColumn),
    /// The user has said it \[°C\].
    Constant(f64),
}

impl KnownTemperature {
    fn of(self, row: &Row<'_>) -> Option<f64> {
        match self {
            Self::Column(column) => row.number(&column),
            Self::Constant(celsius) => Some(celsius),
        }
    }
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
    if matches!(file.quality.verdict, Verdict::Bad | Verdict::Suspect) {
        let quality = &file.quality;
        notes.push(format!(
            "the calibration calls itself {}: {}",
            quality.verdict.name(),
            quality.reasons.join("; ")
        ));
    }
    let temperature = match (&file.temperature, temperature) {
        (Some(drift), None) => {
            return Err(fault(format!(
                "its readings drift with temperature (reference {} °C), and the recording has no column \
                 temperature_C; add one, or state the temperature with --celsius",
                drift.reference_celsius
            )));
        }
        (Some(_), known) => known,
        (None, Some(_)) => {
            notes.push("the temperature is known, but the calibration has no terms for it".to_owned());
            None
        }
        (None, None) => None,
    };
    if columns.has_dummy() && temperature.is_some() {
        notes.push("the dummy gauge is not used: the temperature terms of the calibration are".to_owned());
    } else if columns.has_dummy() && !has_rest {
        notes.push("the dummy gauge is not used: that needs rest_s in the scene".to_owned());
    }
    // Six gauges give the wrench exactly, more by least squares. The number is part of the type, so
    // that the loop over the gauges is unrolled.
    let solved = match file.gauges() {
        6 => file.sensor_matrix::<6>().map_err(|error| error.to_string()).and_then(|matrix| {
            let solver = GaussianElimination::new(&matrix).map_err(|error| error.to_string())?;
            Volts::<_, 6>::boxed(solver, &file, columns, has_rest, temperature)
        }),
        7 => redundant::<7>(&file, columns, has_rest, temperature),
        8 => redundant::<8>(&file, columns, has_rest, temperature),
        9 => redundant::<9>(&file, columns, has_rest, temperature),
        10 => redundant::<10>(&file, columns, has_rest, temperature),
        11 => redundant::<11>(&file, columns, has_rest, temperature),
        12 => redundant::<12>(&file, columns, has_rest, temperature),
        13 => redundant::<13>(&file, columns, has_rest, temperature),
        14 => redundant::<14>(&file, columns, has_rest, temperature),
        15 => redundant::<15>(&file, columns, has_rest, temperature),
        16 => redundant::<16>(&file, columns, has_rest, temperature),
        other => Err(format!("it has {other} gauges, but this program reads 6 to 16; leave some out")),
    };
    solved.map_err(fault)
}

fn redundant<const N: usize>(
    file: &CalibrationFile,
    columns: SignalColumns,
    has_rest: bool,
    temperature: Option<KnownTemperature>,
) -> Result<Box<dyn Recorded>, String> {
    let matrix = file.sensor_matrix::<N>().map_err(|error| error.to_string())?;
    let solver = LeastSquares::new(&matrix).map_err(|error| error.to_string())?;
    Volts::<_, N>::boxed(solver, file, columns, has_rest, temperature)
}

impl<S: WrenchSolver<f64, N> + 'static, const N: usize> Volts<S, N> {
    fn boxed(
        solver: S,
        file: &CalibrationFile,
        columns: SignalColumns,
        has_rest: bool,
        temperature: Option<KnownTemperature>,
    ) -> Result<Box<dyn Recorded>, String> {
        let drift = file.temperature_compensation::<f64, N>().map_err(|error| error.to_string())?;
        if let (Some(drift), Some(celsius)) = (drift, temperature) {
            let (resting, tare) = (TareAccumulator::default(), Tare::new(SVector::zeros()));
            let zero = Zero::Warm { drift: Box::new(drift), celsius, resting, tare };
            return Ok(Box::new(Self {
                columns,
                solver,
                zero,
                watch: RestWatch::default(),
                range: file.range,
            }));
        }
        let tare = file.zero::<N>().map_err(|error| error.to_string())?;
        let zero = if columns.has_dummy() && has_rest {
            Zero::Dummy { resting: DummyGaugeAccumulator::default(), zero: DummyGauge::new(tare, 0.0) }
        } else {
            Zero::Tare { resting: TareAccumulator::default(), tare }
        };
        Ok(Box::new(Self { columns, solver, zero, watch: RestWatch::default(), range: file.range }))
    }
}

impl<S, const N: usize> Volts<S, N> {
    #[inline]
    fn is_saturated(&self, gauges: &SVector<f64, N>) -> bool {
        self.range.is_some_and(|[low, high]| !gauges.iter().all(|gauge| *gauge > low && *gauge < high))
    }
}

impl<S: WrenchSolver<f64, N>, const N: usize> Recorded for Volts<S, N> {
    fn sensor(&self) -> &str {
        self.columns.name()
    }

    /// The wrench as the calibration has it.
    fn read(&self, row: &Row<'_>) -> Result<Wrench<f64>, Status> {
        let gauges = row.signals::<N>(&self.columns).ok_or(Status::UnusableRow)?;
        if self.is_saturated(&gauges) {
            return Err(Status::Saturated);
        }
        let signals = match &self.zero {
            Zero::Tare { tare, .. } => tare.compensate(&gauges),
            Zero::Warm { drift, celsius, tare, .. } => {
                let temperature = celsius.of(row).ok_or(Status::UnusableRow)?;
                tare.compensate(&drift.compensate(&GaugesAndTemperature { gauges, temperature }))
            }
            Zero::Dummy { zero, .. } => {
                let dummy = row.dummy(&self.columns).ok_or(Status::UnusableRow)?;
                zero.compensate(&GaugesAndDummy { gauges, dummy })
            }
        };
        Ok(self.solver.solve(&signals))
    }

    fn rest(&mut self, row: &Row<'_>) -> Status {
        let Some(gauges) = row.signals::<N>(&self.columns) else { return Status::UnusableRow };
        if self.is_saturated(&gauges) {
            return Status::Saturated;
        }
        let (taken, signals) = match &mut self.zero {
            Zero::Tare { resting, tare } => (resting.add(&gauges), tare.compensate(&gauges)),
            Zero::Warm { drift, celsius, resting, .. } => {
                let Some(temperature) = celsius.of(row) else { return Status::UnusableRow };
                // A drift that the thermometer shows too is taken off, and no motion.
                let signals = drift.compensate(&GaugesAndTemperature { gauges, temperature });
                (resting.add(&signals), signals)
            }
            Zero::Dummy { resting, zero } => {
                let Some(dummy) = row.dummy(&self.columns) else { return Status::UnusableRow };
                let reading = GaugesAndDummy { gauges, dummy };
                // A drift that the dummy gauge shows too is taken off, and no motion.
                (resting.add(&reading), zero.compensate(&reading))
            }
        };
        if !taken {
            return Status::UnusableRow;
        }
        self.watch.add(&gauges, &signals, &self.solver.solve(&signals));
        Status::Rest
    }

    fn end_rest(&mut self) -> Result<(), TareError> {
        match &mut self.zero {
            Zero::Tare { resting, tare } | Zero::Warm { resting, tare, .. } => *tare = resting.finish()?,
            Zero::Dummy { resting, zero } => *zero = resting.finish()?,
        }
        Ok(())
    }

    fn doubt(&self) -> Option<Doubt> {
        self.watch.doubt(|gauge| format!("gauge {}", gauge + 1))
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
