//! The solver and the zero of a sensor with a known number of gauges.

use fingertip::wrench::{
    Compensation, DummyGauge, DummyGaugeAccumulator, GaugesAndDummy, GaugesAndTemperature, Tare,
    TareAccumulator, TareError, TemperatureCompensation, Wrench, WrenchSolver,
};
use fingertip_calibration::file::{CalibrationFile, FileError};
use nalgebra::SVector;

use super::{Calibrated, GaugeReading};
use crate::observe::Status;
use crate::rest_watch::{Doubt, RestWatch};

/// A sensor with `N` gauges.
pub(super) struct Gauges<S, const N: usize> {
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
        resting: TareAccumulator<f64, N>,
        tare: Tare<f64, N>,
    },
    /// The same, and the drift that the dummy gauge shows since the rest.
    Dummy { resting: DummyGaugeAccumulator<f64, N>, zero: DummyGauge<f64, N> },
}

impl<S: WrenchSolver<f64, N> + Send + 'static, const N: usize> Gauges<S, N> {
    pub(super) fn boxed(
        solver: S,
        file: &CalibrationFile,
        uses_dummy: bool,
    ) -> Result<Box<dyn Calibrated>, FileError> {
        let drift = file.temperature_compensation::<f64, N>()?;
        let zero = match drift {
            Some(drift) => {
                let (resting, tare) = (TareAccumulator::default(), Tare::new(SVector::zeros()));
                Zero::Warm { drift: Box::new(drift), resting, tare }
            }
            None => {
                let tare = file.zero::<N>()?;
                if uses_dummy {
                    let zero = DummyGauge::new(tare, 0.0);
                    Zero::Dummy { resting: DummyGaugeAccumulator::default(), zero }
                } else {
                    Zero::Tare { resting: TareAccumulator::default(), tare }
                }
            }
        };
        Ok(Box::new(Self { solver, zero, watch: RestWatch::default(), range: file.range }))
    }
}

impl<S, const N: usize> Gauges<S, N> {
    /// The gauges of a reading, if they are as many, finite and within range.
    #[inline]
    fn sound(&self, reading: &GaugeReading<'_>) -> Result<SVector<f64, N>, Status> {
        let gauges: &[f64; N] = reading.gauges.try_into().map_err(|_| Status::UnusableRow)?;
        if !gauges.iter().all(|gauge| gauge.is_finite()) {
            return Err(Status::UnusableRow);
        }
        let within = |[low, high]: [f64; 2]| gauges.iter().all(|gauge| *gauge > low && *gauge < high);
        if self.range.is_none_or(within) { Ok((*gauges).into()) } else { Err(Status::Saturated) }
    }
}

fn known(number: Option<f64>) -> Result<f64, Status> {
    number.filter(|number| number.is_finite()).ok_or(Status::UnusableRow)
}

impl<S: WrenchSolver<f64, N> + Send, const N: usize> Calibrated for Gauges<S, N> {
    fn wrench(&self, reading: &GaugeReading<'_>) -> Result<Wrench<f64>, Status> {
        let gauges = self.sound(reading)?;
        let signals = match &self.zero {
            Zero::Tare { tare, .. } => tare.compensate(&gauges),
            Zero::Warm { drift, tare, .. } => {
                let temperature = known(reading.celsius)?;
                tare.compensate(&drift.compensate(&GaugesAndTemperature { gauges, temperature }))
            }
            Zero::Dummy { zero, .. } => {
                zero.compensate(&GaugesAndDummy { gauges, dummy: known(reading.dummy)? })
            }
        };
        Ok(self.solver.solve(&signals))
    }

    fn rest(&mut self, reading: &GaugeReading<'_>) -> Status {
        let gauges = match self.sound(reading) {
            Ok(gauges) => gauges,
            Err(status) => return status,
        };
        let (taken, signals) = match &mut self.zero {
            Zero::Tare { resting, tare } => (resting.add(&gauges), tare.compensate(&gauges)),
            Zero::Warm { drift, resting, .. } => {
                let Ok(temperature) = known(reading.celsius) else { return Status::UnusableRow };
                // A drift that the thermometer shows too is taken off, and no motion.
                let signals = drift.compensate(&GaugesAndTemperature { gauges, temperature });
                (resting.add(&signals), signals)
            }
            Zero::Dummy { resting, zero } => {
                let Ok(dummy) = known(reading.dummy) else { return Status::UnusableRow };
                let reading = GaugesAndDummy { gauges, dummy };
                // A drift that the dummy gauge shows too is taken off, and no motion.
                (resting.add(&reading), zero.compensate(&reading))
            }
        };
        let sound = taken && self.watch.add(&gauges, &signals, &self.solver.solve(&signals));
        if sound { Status::Rest } else { Status::UnusableRow }
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
