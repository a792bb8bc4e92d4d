//! How to calibrate.

use super::CalibrationError;
use crate::curve::Terms;
use crate::design::TouchSet;
use crate::file::CalibrationFile;

/// Which of load and signal is taken as the cause in the regression.
///
/// ```
/// # use fingertip_calibration::{Axis, file::SignalUnit, loads::LoadTable, nalgebra::DMatrix};
/// # // Three forces one after another, up to ±9.5 N; each has a gauge of 0.1 V/N, and they scatter by a millivolt.
/// # let loads = DMatrix::from_fn(60, 3, |i, j| if i % 3 == j { (i / 3) as f64 - 9.5 } else { 0.0 });
/// # let signals = loads.map_with_location(|i, j, newtons| 0.1 * newtons + 1e-3 * ((7 * i + 3 * j) as f64).sin());
/// # let table = LoadTable::new(&Axis::FORCES, loads, signals, SignalUnit::Volt)?;
/// use fingertip_calibration::calibrate;
/// use fingertip_calibration::model::{Direction, Options};
///
/// let [forward, inverse] = [Direction::SignalsFromLoads, Direction::LoadsFromSignals].map(|direction| {
///     calibrate(&table, &Options { direction, ..Options::default() })
/// });
/// // With a millivolt of noise in a volt both find 0.1 V/N, which is 0.95 V under the greatest load.
/// for calibration in [forward?, inverse?] {
///     let (volts, _) = calibration.model.matrix_and_zero()?;
///     assert!((volts[(0, 0)] - 0.95).abs() < 1e-3);
/// }
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// `signals = C · load + zero`, the physical one: errors are in the readings. The default.
    SignalsFromLoads,
    /// `load = B · signals + constant`, inverse regression: smaller residuals on the loads of the
    /// calibration, but drawn towards their mean (`docs/theory/calibration.md#the-model`). What makers of
    /// sensors often publish, and the only one of curved sensors.
    LoadsFromSignals,
}

/// By which method to fit.
///
/// ```
/// # use fingertip_calibration::{Axis, file::SignalUnit, loads::LoadTable, nalgebra::DMatrix};
/// # // Three forces one after another, up to ±9.5 N; each has a gauge of 0.1 V/N, and they scatter by a millivolt.
/// # let loads = DMatrix::from_fn(60, 3, |i, j| if i % 3 == j { (i / 3) as f64 - 9.5 } else { 0.0 });
/// # let signals = loads.map_with_location(|i, j, newtons| 0.1 * newtons + 1e-3 * ((7 * i + 3 * j) as f64).sin());
/// # let table = LoadTable::new(&Axis::FORCES, loads, signals, SignalUnit::Volt)?;
/// # let mut table = table;
/// use fingertip_calibration::calibrate;
/// use fingertip_calibration::model::{Method, Options};
///
/// // One reading of sixty is wrong by 1 V; the gauge has 0.1 V/N, 0.95 V under the greatest load.
/// table.signals[(57, 0)] += 1.0;
/// let error = |method| -> Result<f64, Box<dyn core::error::Error>> {
///     let calibration = calibrate(&table, &Options { method, ..Options::default() })?;
///     Ok((calibration.model.matrix_and_zero()?.0[(0, 0)] - 0.95).abs())
/// };
/// assert!(error(Method::LeastSquares)? > 0.01);
/// assert!(error(Method::Huber)? < 1e-3);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Method {
    /// Least squares; weighted if the table has weights.
    LeastSquares,
    /// Huber's M-estimate.
    Huber,
    /// RANSAC: thresholds come from the data; samples that do not agree are left out, by name.
    Ransac {
        /// Share of samples that may be bad.
        outliers: f64,
        /// Seed of the draws.
        seed: u64,
    },
    /// Total least squares: the loads are uncertain too. [`Direction::SignalsFromLoads`] only.
    Total {
        /// Standard deviation of the load of each axis \[N, N·m\].
        load_deviations: Vec<f64>,
        /// Standard deviation of the reading of each gauge.
        signal_deviations: Vec<f64>,
    },
    /// Gauss-Helmert: as [`Method::Total`], but the error of a load is a fixed part and a share of
    /// the load itself, as with weights. [`Direction::SignalsFromLoads`] only.
    GaussHelmert {
        /// Standard deviation of the load of each axis \[N, N·m\].
        load_deviations: Vec<f64>,
        /// Standard deviation relative to the load.
        relative: f64,
        /// Standard deviation of the reading of each gauge.
        signal_deviations: Vec<f64>,
    },
    /// Bayes: towards an earlier calibration, which is believed to be right to `relative` of the
    /// greatest sensitivity of each gauge. [`Direction::SignalsFromLoads`] only.
    Prior {
        /// The earlier calibration.
        prior: Box<CalibrationFile>,
        /// Standard deviation of its entries, relative to the root mean square of the matrix.
        relative: f64,
    },
}

impl Method {
    /// As files and reports call it.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::LeastSquares => "least squares",
            Self::Huber => "Huber",
            Self::Ransac { .. } => "RANSAC",
            Self::Total { .. } => "total least squares",
            Self::GaussHelmert { .. } => "Gauss-Helmert",
            Self::Prior { .. } => "least squares with a prior",
        }
    }
}

/// What is fitted beside what is proportional to the signals.
///
/// ```
/// use fingertip_calibration::model::{Curvature, Direction, Options};
/// use fingertip_calibration::{Axis, calibrate, file::SignalUnit, loads::LoadTable, nalgebra::DMatrix};
///
/// // A gauge that bends: F = 10 N/V · v + 2 N/V² · v², from −1 V to 1 V.
/// let volts = DMatrix::from_fn(41, 1, |i, _| 0.05 * i as f64 - 1.0);
/// let newtons = volts.map(|v| 10.0 * v + 2.0 * v * v);
/// let table = LoadTable::new(&[Axis::Fz], newtons, volts, SignalUnit::Volt)?;
/// let options = Options {
///     direction: Direction::LoadsFromSignals,
///     curvature: Curvature::Quadratic,
///     ..Options::default()
/// };
/// let file = calibrate(&table, &options)?.to_file()?;
/// assert!((file.load(&[0.5])?[0] - 5.5).abs() < 1e-9);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum Curvature {
    /// Nothing. The default.
    #[default]
    Straight,
    /// All products of two signals.
    Quadratic,
    /// Products of two and of three signals, and bumps, as many as make the errors of load cases that were left out
    /// smallest; none, if none helps.
    Chosen,
    /// These terms, of readings less an origin, one for each gauge.
    Given {
        /// The terms.
        terms: Box<Terms>,
        /// Readings that count as signals of zero.
        origin: Vec<f64>,
    },
}

impl Curvature {
    /// The terms of a sensor with so many gauges; none before any are [chosen](Self::Chosen).
    pub(crate) fn terms(&self, gauges: usize) -> Terms {
        match self {
            Self::Straight | Self::Chosen => Terms::default(),
            Self::Quadratic => Terms::pairs(gauges),
            Self::Given { terms, .. } => (**terms).clone(),
        }
    }

    /// What readings count as signals of zero; all zeros unless given.
    pub(crate) fn origin(&self, gauges: usize) -> Vec<f64> {
        match self {
            Self::Given { origin, .. } => origin.clone(),
            _ => vec![0.0; gauges],
        }
    }
}

/// How to calibrate.
///
/// ```
/// # use fingertip_calibration::{Axis, file::SignalUnit, loads::LoadTable, nalgebra::DMatrix};
/// # // Three forces one after another, up to ±9.5 N; each has a gauge of 0.1 V/N, and they scatter by a millivolt.
/// # let loads = DMatrix::from_fn(60, 3, |i, j| if i % 3 == j { (i / 3) as f64 - 9.5 } else { 0.0 });
/// # let signals = loads.map_with_location(|i, j, newtons| 0.1 * newtons + 1e-3 * ((7 * i + 3 * j) as f64).sin());
/// # let table = LoadTable::new(&Axis::FORCES, loads, signals, SignalUnit::Volt)?;
/// use fingertip_calibration::calibrate;
/// use fingertip_calibration::model::{Method, Options};
///
/// // A full scale of 20 N, readings of ±0.9 V and more left out as saturated, no zero, robust.
/// let options = Options {
///     nominal: Some(vec![20.0; 3]),
///     range: Some([-0.9, 0.9]),
///     bias: false,
///     method: Method::Huber,
///     ..Options::default()
/// };
/// let calibration = calibrate(&table, &options)?;
/// // 0.95 V were read of ±9.5 N, three times each.
/// assert_eq!(calibration.report.excluded.len(), 6);
/// let (volts, _) = calibration.model.matrix_and_zero()?;
/// assert!((volts[(0, 0)] - 2.0).abs() < 1e-2);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Which way the regression goes.
    pub direction: Direction,
    /// Whether a zero is fitted; without, the readings must be tared.
    pub bias: bool,
    /// Whether the sensor is fitted as curved, and how. Loads from signals only; refused where it over-fits.
    pub curvature: Curvature,
    /// By which method.
    pub method: Method,
    /// Nominal load (full scale) of each axis \[N, N·m\]; the greatest loads if `None`.
    pub nominal: Option<Vec<f64>>,
    /// Least and greatest reading of a gauge: samples at or beyond are left out, by name.
    pub range: Option<[f64; 2]>,
    /// Whether to subtract from the readings the zero of their group first.
    pub tare_groups: bool,
    /// Fit the drift with temperature too (the table must have temperatures), and give matrix and zero at
    /// this one \[°C\].
    pub reference_celsius: Option<f64>,
    /// Whether to find how the readings creep, from load cycles with times, and take that off them first.
    pub creep: bool,
    /// Whether to leave out samples that the outlier test names.
    pub reject_outliers: bool,
    /// Touches on which to say what the calibration is worth; `None` for no such statement.
    pub touches: Option<TouchSet>,
    /// What a good calibration must reach.
    pub limits: Limits,
}

impl Options {
    /// Refuses to fit signals to loads by a curve.
    pub(super) fn check_curvature(&self) -> Result<(), CalibrationError> {
        if self.curvature == Curvature::Straight || self.direction == Direction::LoadsFromSignals {
            return Ok(());
        }
        Err(CalibrationError::BadOption {
            option: "curvature",
            message: "only loads from signals can be curved".to_owned(),
        })
    }
}

impl Default for Options {
    /// Least squares of signals on loads, with bias.
    fn default() -> Self {
        Self {
            direction: Direction::SignalsFromLoads,
            bias: true,
            curvature: Curvature::Straight,
            method: Method::LeastSquares,
            nominal: None,
            range: None,
            tare_groups: false,
            reference_celsius: None,
            creep: false,
            reject_outliers: false,
            touches: None,
            limits: Limits::default(),
        }
    }
}

/// What a good calibration must reach; beyond, it is stamped as bad.
///
/// ```
/// # use fingertip_calibration::{Axis, file::SignalUnit, loads::LoadTable, nalgebra::DMatrix};
/// # // Three forces one after another, up to ±9.5 N; each has a gauge of 0.1 V/N, and they scatter by a millivolt.
/// # let loads = DMatrix::from_fn(60, 3, |i, j| if i % 3 == j { (i / 3) as f64 - 9.5 } else { 0.0 });
/// # let signals = loads.map_with_location(|i, j, newtons| 0.1 * newtons + 1e-3 * ((7 * i + 3 * j) as f64).sin());
/// # let table = LoadTable::new(&Axis::FORCES, loads, signals, SignalUnit::Volt)?;
/// use fingertip_calibration::calibrate;
/// use fingertip_calibration::file::Verdict;
/// use fingertip_calibration::model::{Limits, Options};
///
/// // 1 mV of noise in 1 V passes 2 % of full scale, and fails a thousandth of a per cent.
/// let verdict = |left_out_percent| {
///     let limits = Limits { left_out_percent, ..Limits::default() };
///     calibrate(&table, &Options { limits, ..Options::default() }).map(|calibration| calibration.report.verdict)
/// };
/// assert_eq!(verdict(2.0)?, Verdict::Good);
/// assert_eq!(verdict(0.001)?, Verdict::Bad);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// RMS error of any axis on loads left out of the fit, % of full scale. The default is 2 %, the
    /// accuracy of the sensor of Bicchi & Dario 1987.
    pub left_out_percent: f64,
    /// Condition number N_c of the normalised matrix. The default is 100, which makes 0.02 % of noise
    /// 2 % of error.
    pub condition_number: f64,
    /// Error on loads left out over error on loads of the fit. The default is 3.
    pub over_fitting: f64,
}

impl Default for Limits {
    fn default() -> Self {
        Self { left_out_percent: 2.0, condition_number: 100.0, over_fitting: 3.0 }
    }
}
