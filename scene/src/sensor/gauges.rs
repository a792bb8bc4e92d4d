//! The solver and the zero of a sensor, by its number of gauges.

use fingertip::wrench::{
    CalibratedRegion, Compensation, DummyGauge, DummyGaugeAccumulator, GaugesAndDummy, GaugesAndTemperature,
    GaussianElimination, LeastSquares, Real, SensorMatrix, Tare, TareAccumulator, TareError,
    TemperatureCompensation, Wrench, WrenchSolver,
};
use fingertip_calibration::file::{AnyCreep, AnyCurve, CalibrationFile};
use nalgebra::{SVector, Vector6};

use super::{BadSensor, GaugeReading, NoWrench};
use crate::rest::{Doubt, RestWatch};

/// A sensor with `N` gauges.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Gauges<T: Real, S, const N: usize> {
    solver: Solver<T, S, N>,
    zero: Zero<T, N>,
    /// What goes on changing under a load that does not.
    creep: Option<Box<AnyCreep<T, N>>>,
    rest: Option<Resting<T, N>>,
    /// Of the rest that goes on, or of the last one.
    watch: RestWatch<T, N>,
    /// Readings at or beyond these are saturated.
    range: Option<[T; 2]>,
    /// Where a curved sensor was calibrated.
    region: Option<Box<CalibratedRegion<T, N>>>,
}

/// From signals to the wrench.
#[derive(Clone, Debug, PartialEq)]
enum Solver<T: Real, S, const N: usize> {
    Straight(S),
    Curved(Box<AnyCurve<T, N>>),
}

impl<T: Real, S: WrenchSolver<T, N>, const N: usize> Solver<T, S, N> {
    #[inline]
    fn solve(&self, signals: &SVector<T, N>) -> Wrench<T> {
        match self {
            Self::Straight(solver) => solver.solve(signals),
            Self::Curved(solver) => solver.solve(signals),
        }
    }
}

/// What is taken off the signals.
#[derive(Clone, Debug, PartialEq)]
enum Zero<T: Real, const N: usize> {
    /// The zero of the calibration, or of the last rest.
    Tare(Tare<T, N>),
    /// Zero and drift at the temperature of the sensor, and what the last rest left of it.
    Warm(Box<TemperatureCompensation<T, N, 3>>, Tare<T, N>),
    /// The zero of the last rest, and the drift that the dummy gauge shows since then.
    Dummy(DummyGauge<T, N>),
}

/// A rest that goes on.
#[derive(Clone, Debug, PartialEq)]
enum Resting<T: Real, const N: usize> {
    Plain(TareAccumulator<T, N>),
    Dummy(DummyGaugeAccumulator<T, N>),
}

/// A number that was measured.
fn known<T: Real>(number: Option<T>) -> Result<T, NoWrench> {
    number.filter(|number| number.is_number()).ok_or(NoWrench::Incomplete)
}

impl<T: Real, S: WrenchSolver<T, N>, const N: usize> Gauges<T, S, N> {
    fn new<E>(
        file: &CalibrationFile,
        solver: impl FnOnce(&SensorMatrix<T, N>) -> Result<S, E>,
    ) -> Result<Self, BadSensor>
    where
        BadSensor: From<E>,
    {
        let solver = if file.is_curved() {
            Solver::Curved(Box::new(file.curved_inverse_in()?))
        } else {
            Solver::Straight(solver(&file.sensor_matrix_in()?)?)
        };
        let zero = match file.temperature_compensation()? {
            Some(drift) => Zero::Warm(Box::new(drift), Tare::new(SVector::zeros())),
            None => Zero::Tare(file.zero_in()?),
        };
        let creep = file.creep_compensation_in()?.map(Box::new);
        let range = file.range.map(|range| range.map(T::literal));
        let region =
            file.region.as_ref().filter(|_| file.is_curved()).map(|region| region.in_type()).transpose()?;
        Ok(Self {
            solver,
            zero,
            creep,
            rest: None,
            watch: RestWatch::default(),
            range,
            region: region.map(Box::new),
        })
    }

    /// The gauges of a reading, if they are as many, finite and within range.
    #[inline]
    fn sound(&self, reading: &GaugeReading<'_, T>) -> Result<SVector<T, N>, NoWrench> {
        let gauges: &[T; N] = reading.gauges.try_into().map_err(|_| NoWrench::Incomplete)?;
        if !gauges.iter().all(|gauge| gauge.is_number()) {
            return Err(NoWrench::Incomplete);
        }
        let within = |[low, high]: [T; 2]| gauges.iter().all(|gauge| *gauge > low && *gauge < high);
        if self.range.is_none_or(within) { Ok((*gauges).into()) } else { Err(NoWrench::Saturated) }
    }

    #[inline]
    fn wrench(&mut self, reading: &GaugeReading<'_, T>, time_step: T) -> Result<Wrench<T>, NoWrench> {
        let gauges = self.sound(reading)?;
        let mut signals = match &self.zero {
            Zero::Tare(tare) => tare.compensate(&gauges),
            Zero::Warm(drift, tare) => {
                let temperature = known(reading.celsius)?;
                tare.compensate(&drift.compensate(&GaugesAndTemperature { gauges, temperature }))
            }
            Zero::Dummy(zero) => zero.compensate(&GaugesAndDummy { gauges, dummy: known(reading.dummy)? }),
        };
        if let Some(creep) = &mut self.creep {
            signals = creep.follow(&signals, time_step).ok_or(NoWrench::Incomplete)?;
        }
        if self.region.as_ref().is_some_and(|region| !region.holds(&signals)) {
            return Err(NoWrench::Uncalibrated);
        }
        Ok(self.solver.solve(&signals))
    }

    fn rest(&mut self, reading: &GaugeReading<'_, T>) -> Result<(), NoWrench> {
        let gauges = self.sound(reading)?;
        // What drift a thermometer or a dummy gauge shows is no motion.
        let (steady, dummy) = match (&self.zero, &self.rest, reading.dummy) {
            (Zero::Warm(drift, _), ..) => {
                let temperature = known(reading.celsius)?;
                (drift.compensate(&GaugesAndTemperature { gauges, temperature }), None)
            }
            (_, None, None) | (_, Some(Resting::Plain(_)), _) => (gauges, None),
            (_, _, dummy) => {
                let dummy = known(dummy)?;
                (gauges - SVector::repeat(dummy), Some(dummy))
            }
        };
        if self.rest.is_none() {
            self.watch = RestWatch::default();
        }
        let resting = self.rest.get_or_insert_with(|| match dummy {
            Some(_) => Resting::Dummy(DummyGaugeAccumulator::default()),
            None => Resting::Plain(TareAccumulator::default()),
        });
        let taken = match (resting, dummy) {
            (Resting::Dummy(mean), Some(dummy)) => mean.add(&GaugesAndDummy { gauges, dummy }),
            // As it stands, or at the reference temperature.
            (Resting::Plain(mean), _) => mean.add(&steady),
            (Resting::Dummy(_), None) => false,
        };
        let sound = taken && self.watch.add(&gauges, &steady, &self.solver.solve(&steady));
        if sound { Ok(()) } else { Err(NoWrench::Incomplete) }
    }

    fn end_rest(&mut self) -> Result<(), TareError> {
        let resting = self.rest.take();
        if let Some(creep) = &mut self.creep {
            creep.start_anew();
        }
        let tare = match &resting {
            Some(Resting::Dummy(mean)) => {
                self.zero = Zero::Dummy(mean.finish()?);
                return Ok(());
            }
            Some(Resting::Plain(mean)) => mean.finish()?,
            None => return Err(TareError::TooFewSamples { samples: 0 }),
        };
        match &mut self.zero {
            Zero::Warm(_, zero) => *zero = tare,
            zero => *zero = Zero::Tare(tare),
        }
        Ok(())
    }

    fn noise(&self) -> Option<Vector6<T>> {
        self.watch.noise()
    }

    fn doubt(&self) -> Option<Doubt> {
        self.watch.doubt(|gauge| format!("gauge {}", gauge + 1))
    }
}

/// The number of gauges is part of the type, so that the loop over them is unrolled.
macro_rules! by_number {
    ($($name:ident: $solver:ty, $count:literal, $make:expr;)*) => {
        /// A sensor of any number of gauges.
        #[derive(Clone, Debug, PartialEq)]
        pub(crate) enum AnyGauges<T: Real> {
            $($name(Box<Gauges<T, $solver, $count>>),)*
        }

        macro_rules! each {
            ($any:expr, $gauges:ident => $call:expr) => {
                match $any {
                    $(AnyGauges::$name($gauges) => $call,)*
                }
            };
        }

        impl<T: Real> AnyGauges<T> {
            pub(crate) fn new(file: &CalibrationFile) -> Result<Self, BadSensor> {
                match file.gauges() {
                    $($count => Ok(Self::$name(Box::new(Gauges::new(file, $make)?))),)*
                    other => Err(BadSensor::Gauges(other)),
                }
            }

            pub(crate) const fn count(&self) -> usize {
                match self {
                    $(Self::$name(_) => $count,)*
                }
            }
        }
    };
}

// Six gauges give the wrench exactly, more by least squares.
by_number! {
    Six: GaussianElimination<T>, 6, GaussianElimination::new;
    Seven: LeastSquares<T, 7>, 7, LeastSquares::new;
    Eight: LeastSquares<T, 8>, 8, LeastSquares::new;
    Nine: LeastSquares<T, 9>, 9, LeastSquares::new;
    Ten: LeastSquares<T, 10>, 10, LeastSquares::new;
    Eleven: LeastSquares<T, 11>, 11, LeastSquares::new;
    Twelve: LeastSquares<T, 12>, 12, LeastSquares::new;
    Thirteen: LeastSquares<T, 13>, 13, LeastSquares::new;
    Fourteen: LeastSquares<T, 14>, 14, LeastSquares::new;
    Fifteen: LeastSquares<T, 15>, 15, LeastSquares::new;
    Sixteen: LeastSquares<T, 16>, 16, LeastSquares::new;
}

impl<T: Real> AnyGauges<T> {
    #[inline]
    pub(crate) fn wrench(
        &mut self,
        reading: &GaugeReading<'_, T>,
        time_step: T,
    ) -> Result<Wrench<T>, NoWrench> {
        each!(self, gauges => gauges.wrench(reading, time_step))
    }

    pub(crate) fn rest(&mut self, reading: &GaugeReading<'_, T>) -> Result<(), NoWrench> {
        each!(self, gauges => gauges.rest(reading))
    }

    pub(crate) fn end_rest(&mut self) -> Result<(), TareError> {
        each!(self, gauges => gauges.end_rest())
    }

    pub(crate) fn noise(&self) -> Option<Vector6<T>> {
        each!(self, gauges => gauges.noise())
    }

    pub(crate) fn doubt(&self) -> Option<Doubt> {
        each!(self, gauges => gauges.doubt())
    }
}
