//! `[sensor]`: readings of gauges, and the calibration that turns them into wrenches.

mod gauges;
mod section;

use fingertip::wrench::{LeastSquaresError, Real, SingularMatrix, TareError, Wrench};
use fingertip_calibration::file::{CalibrationFile, FileError, ReadError};
use nalgebra::Vector6;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::rest::Doubt;
pub(crate) use gauges::AnyGauges;
pub(crate) use section::{SensorSection, SensorSource};

/// Fewest and most gauges of a sensor.
pub const GAUGES: core::ops::RangeInclusive<usize> = 6..=16;

/// One reading of a sensor's gauges, and what was measured beside them.
///
/// ```
/// use fingertip_scene::GaugeReading;
///
/// let gauges = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6];
/// let plain = GaugeReading::of(&gauges);
/// assert_eq!((plain.dummy, plain.celsius), (None, None));
/// let warm = GaugeReading { celsius: Some(31.5), ..plain };
/// assert_ne!(warm, plain);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GaugeReading<'a, T> {
    /// The gauges, in the unit of the calibration.
    pub gauges: &'a [T],
    /// A gauge that no load strains, which shows what drifts with all of them.
    pub dummy: Option<T>,
    /// Temperature of the sensor \[°C\].
    pub celsius: Option<T>,
}

impl<'a, T> GaugeReading<'a, T> {
    /// Of gauges alone.
    pub const fn of(gauges: &'a [T]) -> Self {
        Self { gauges, dummy: None, celsius: None }
    }
}

/// Why a reading gives no wrench.
///
/// ```
/// # const BALL: &str = "version = 2\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"sphere\"\nradius_m = 0.013\n";
/// use fingertip_scene::{GaugeReading, NoWrench, Scene};
///
/// let mut pipeline = Scene::from_text(BALL)?.pipeline();
/// let why = pipeline.sense_reading(&GaugeReading::of(&[0.0; 6]), None, 1e-3).unwrap_err();
/// assert_eq!(why, NoWrench::NoSensor);
/// assert_eq!(why.to_string(), "the scene has no [sensor] that turns readings into wrenches");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum NoWrench {
    /// A gauge reads at or beyond the range that its calibration states.
    #[error("a gauge is saturated")]
    Saturated,
    /// The reading lies too far from those that a curved sensor was calibrated with: it says nothing there
    /// ([`CalibratedRegion`](fingertip::wrench::CalibratedRegion)).
    #[error("the reading lies beyond what the curved sensor was calibrated for")]
    Uncalibrated,
    /// Too few or too many gauges, a number that is not finite, or the temperature or the dummy gauge is missing
    /// where the zero needs it.
    #[error("the reading is incomplete")]
    Incomplete,
    /// The scene has no `[sensor]`.
    #[error("the scene has no [sensor] that turns readings into wrenches")]
    NoSensor,
    /// The scene has a `[payload]`, and how the sensor lies was not told.
    #[error("the scene has a [payload], whose weight cannot be taken off without the motion of the sensor")]
    NoMotion,
}

/// Why no wrench comes of a calibration.
///
/// ```
/// # const BALL: &str = "version = 2\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"sphere\"\nradius_m = 0.013\n";
/// use fingertip_scene::{BadSensor, Scene, SceneProblem};
///
/// let sensor = "[sensor]\nsignal_unit = \"V\"\nload_per_signal_N_Nm = [[1.0, 0.0], [0.0, 1.0]]\n";
/// let refused = Scene::from_text(&format!("{BALL}{sensor}")).unwrap_err();
/// println!("{refused} {refused:?}");
/// assert!(matches!(&refused, SceneProblem::Sensor { source, .. } if matches!(**source, BadSensor::File(_))));
/// ```
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum BadSensor {
    /// It cannot be read.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// Something in it is wrong.
    #[error(transparent)]
    File(#[from] FileError),
    /// Its matrix has no inverse.
    #[error(transparent)]
    Singular(#[from] SingularMatrix),
    /// Its matrix has no inverse.
    #[error(transparent)]
    LeastSquares(#[from] LeastSquaresError),
    /// More or fewer gauges than are read here.
    #[error("it has {0} gauges, but this program reads {first} to {last}; leave some out", first = GAUGES.start(), last = GAUGES.end())]
    Gauges(usize),
}

/// A sensor with its calibration and its zero: readings to wrenches.
///
/// Six gauges give the wrench exactly, more by least squares, and a curved calibration by its terms of higher order. The
/// zero is that of the calibration, drift with temperature included, or the mean of a rest: readings are given to
/// [`rest`](Self::rest), and behind [`end_rest`](Self::end_rest) their mean is the zero. If the first reading of the
/// rest has a dummy gauge, all later ones need it, and what it shows to drift is taken off.
///
/// ```
/// use fingertip_calibration::file::{CalibrationFile, SignalUnit};
/// use fingertip_calibration::nalgebra::DMatrix;
/// use fingertip_scene::{GaugeReading, NoWrench, Sensor};
///
/// // Each gauge answers to one axis: 2 V under 10 N or 0.1 N·m.
/// let matrix = DMatrix::from_diagonal_element(6, 6, 2.0);
/// let nominal = vec![10.0, 10.0, 10.0, 0.1, 0.1, 0.1];
/// let mut file = CalibrationFile::new(matrix, nominal, vec![0.5; 6], SignalUnit::Volt)?;
/// file.range = Some([-5.0, 5.0]);
/// let mut sensor = Sensor::<f64>::new(&file)?;
/// let wrench = sensor.wrench(&GaugeReading::of(&[0.5, 0.5, 0.1, 0.5, 0.5, 0.5]), 1e-3)?;
/// assert!((wrench.force().z + 2.0).abs() < 1e-12);
/// let stuck = sensor.wrench(&GaugeReading::of(&[0.5, 0.5, 5.0, 0.5, 0.5, 0.5]), 1e-3);
/// assert_eq!(stuck, Err(NoWrench::Saturated));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Sensor<T: Real>(AnyGauges<T>);

impl<T: Real> Sensor<T> {
    /// From a calibration.
    ///
    /// # Errors
    /// [`BadSensor`].
    pub fn new(file: &CalibrationFile) -> Result<Self, BadSensor> {
        AnyGauges::new(file).map(Self)
    }

    /// How many gauges it reads.
    #[must_use]
    pub const fn gauges(&self) -> usize {
        self.0.count()
    }

    /// The wrench of a reading as the calibration has it, in the frame and of the sign that it was calibrated in.
    ///
    /// `time_step` is the time since the last reading that gave a wrench \[s\]. It matters for a calibration with
    /// [`creep`](CalibrationFile::creep) alone, which is taken off as if the sensor were settled and without load at the
    /// first reading, and behind each rest.
    ///
    /// # Errors
    /// [`NoWrench::Saturated`], [`NoWrench::Uncalibrated`], [`NoWrench::Incomplete`].
    #[inline]
    pub fn wrench(&mut self, reading: &GaugeReading<'_, T>, time_step: T) -> Result<Wrench<T>, NoWrench> {
        self.0.wrench(reading, time_step)
    }

    /// Takes a reading of the rest.
    ///
    /// # Errors
    /// As [`wrench`](Self::wrench); it is passed over.
    pub fn rest(&mut self, reading: &GaugeReading<'_, T>) -> Result<(), NoWrench> {
        self.0.rest(reading)
    }

    /// The mean of the rest is the zero from now on, and the next reading of a rest begins another one.
    ///
    /// # Errors
    /// [`TareError`] if there were too few readings; the zero then stays.
    pub fn end_rest(&mut self) -> Result<(), TareError> {
        self.0.end_rest()
    }

    /// Standard deviation of each component of the wrench in the last rest \[N, N·m\]; `None` for fewer than two readings.
    #[must_use]
    pub fn noise(&self) -> Option<Vector6<T>> {
        self.0.noise()
    }

    /// Why the last rest may not have been one.
    #[must_use]
    pub fn doubt(&self) -> Option<Doubt> {
        self.0.doubt()
    }
}
