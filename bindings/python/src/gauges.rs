//! What is to know of gauges: `ChannelMonitor`, `conditioning`, `worst_errors`.

use fingertip::wrench::{
    ChannelFault, ChannelLimits, ChannelMonitor, Conditioning, ErrorBound, LeastSquares, SensorMatrix,
    Uncertainty, WrenchSolver,
};
use nalgebra::{DMatrix, SMatrix, SVector, Vector6};
use numpy::PyArray1;
use pyo3::prelude::*;

use crate::{enums, errors, numbers, value};

/// Watches the raw readings of channels: saturated, stuck, clipped, not finite. It learns the noise and the step of each
/// from its readings.
///
/// Parameters
/// ----------
/// least, greatest : array_like, shape (channels,)
///     The linear range of each.
///
/// Examples
/// --------
/// >>> from fingertip import ChannelMonitor
/// >>> watch = ChannelMonitor([0.0, 0.0], [5.0, 5.0])
/// >>> watch.update([2.5, 5.0])
/// [None, <ChannelFault.SATURATED_HIGH: 'saturated_high'>]
///
/// Notes
/// -----
/// A copy keeps what it saw; a pickle begins anew.
#[pyclass(name = "ChannelMonitor", module = "fingertip", skip_from_py_object)]
#[derive(Clone)]
pub(crate) struct PyMonitor {
    channels: Vec<(ChannelMonitor<f64>, f64)>,
    made: (Vec<f64>, Vec<f64>),
}

impl PyMonitor {
    fn of(made: (Vec<f64>, Vec<f64>)) -> PyResult<Self> {
        let (least, greatest) = &made;
        if least.len() != greatest.len() || least.is_empty() {
            let (low, high) = (least.len(), greatest.len());
            return Err(errors::bad(format!("`least` and `greatest` must be as many, not {low} and {high}")));
        }
        let limits = least.iter().zip(greatest).map(|(least, greatest)| {
            let limits = ChannelLimits::new(*least, *greatest).map_err(errors::bad)?;
            Ok((ChannelMonitor::new(limits), f64::NAN))
        });
        let channels = limits.collect::<PyResult<_>>()?;
        Ok(Self { channels, made })
    }
}

value::watcher_class!(PyMonitor);

const fn word(fault: ChannelFault) -> &'static str {
    match fault {
        ChannelFault::NotFinite => "not_finite",
        ChannelFault::SaturatedLow => "saturated_low",
        ChannelFault::SaturatedHigh => "saturated_high",
        ChannelFault::PlateauLow => "plateau_low",
        ChannelFault::PlateauHigh => "plateau_high",
        ChannelFault::Stuck => "stuck",
    }
}

#[pymethods]
impl PyMonitor {
    #[new]
    fn new(least: &Bound<'_, PyAny>, greatest: &Bound<'_, PyAny>) -> PyResult<Self> {
        Self::of((numbers::list(least, "least")?, numbers::list(greatest, "greatest")?))
    }

    /// Takes a reading; says of each channel what is wrong with it, a `ChannelFault`, or `None`.
    fn update<'py>(&mut self, reading: &Bound<'py, PyAny>) -> PyResult<Vec<Option<Bound<'py, PyAny>>>> {
        let (py, readings) = (reading.py(), numbers::list(reading, "reading")?);
        let (found, channels) = (readings.len(), self.channels.len());
        if found != channels {
            return Err(errors::bad(format!("`reading` must have {channels} numbers, not {found}")));
        }
        let changes = |channel: &(ChannelMonitor<f64>, f64), reading: f64| channel.1 != reading;
        let changed =
            self.channels.iter().zip(&readings).filter(|(channel, reading)| changes(channel, **reading));
        let changed = changed.count();
        let each = self.channels.iter_mut().zip(readings).map(|(channel, reading)| {
            let others = changed > usize::from(changes(channel, reading));
            channel.1 = reading;
            channel.0.update(reading, others).map(word)
        });
        let each: Vec<Option<&str>> = each.collect();
        let member = |word: Option<&str>| word.map(|word| enums::named(py, "ChannelFault", word)).transpose();
        each.into_iter().map(member).collect()
    }

    /// Standard deviation of a reading of each channel at rest; `None` until its readings have told it.
    #[getter]
    fn noise(&self) -> Vec<Option<f64>> {
        self.channels.iter().map(|channel| channel.0.noise()).collect()
    }

    /// The step of each channel's converter; `None` where its readings show none.
    #[getter]
    fn step(&self) -> Vec<Option<f64>> {
        self.channels.iter().map(|channel| channel.0.step()).collect()
    }
}

fn sensor<const N: usize>(matrix: &DMatrix<f64>, nominal: Vector6<f64>) -> PyResult<SensorMatrix<f64, N>> {
    let matrix: SMatrix<f64, N, 6> = matrix.fixed_view::<N, 6>(0, 0).into_owned();
    SensorMatrix::new(matrix, nominal).map_err(errors::calibration)
}

/// Calls a function for the number of gauges.
macro_rules! by_gauges {
    ($matrix:expr, $function:ident($($argument:expr),*)) => {
        match $matrix.shape() {
            (6, 6) => $function::<6>($($argument),*),
            (7, 6) => $function::<7>($($argument),*),
            (8, 6) => $function::<8>($($argument),*),
            (9, 6) => $function::<9>($($argument),*),
            (10, 6) => $function::<10>($($argument),*),
            (12, 6) => $function::<12>($($argument),*),
            (rows, columns) => Err(errors::bad(format!(
                "`matrix` must be of 6 to 10 or 12 gauges by 6 loads, not {rows} × {columns}"
            ))),
        }
    };
}

/// Singular values, the condition number, and by how much noise of the worst direction is amplified in each load.
type Conditioned = (Vector6<f64>, f64, Option<Vector6<f64>>);

fn conditioned<const N: usize>(matrix: &DMatrix<f64>, nominal: Vector6<f64>) -> PyResult<Conditioned> {
    let of = Conditioning::of(&sensor::<N>(matrix, nominal)?);
    Ok((of.singular_values, of.condition_number(), of.worst_amplification))
}

/// How well a sensor matrix tells loads apart.
///
/// Parameters
/// ----------
/// matrix : array_like, shape (gauges, 6)
///     Signals under nominal loads.
/// nominal : array_like, shape (6,)
///     Nominal loads [N, N·m].
///
/// Returns
/// -------
/// singular_values : ndarray, shape (6,)
/// condition_number : float
/// worst_amplification : ndarray, shape (6,), or None
///     Error of each load [N, N·m] per error of the signals, at worst.
#[pyfunction]
#[allow(clippy::type_complexity, reason = "a tuple of Python")]
pub(crate) fn conditioning<'py>(
    py: Python<'py>,
    matrix: &Bound<'py, PyAny>,
    nominal: &Bound<'py, PyAny>,
) -> PyResult<(Bound<'py, PyArray1<f64>>, f64, Option<Bound<'py, PyArray1<f64>>>)> {
    let (matrix, nominal) =
        (numbers::table(matrix, "matrix")?, Vector6::from(numbers::numbers(nominal, "nominal")?));
    let (singular, number, worst) = by_gauges!(matrix, conditioned(&matrix, nominal))?;
    Ok((numbers::array(py, &singular), number, worst.map(|worst| numbers::array(py, &worst))))
}

fn bounded<const N: usize>(
    matrix: &DMatrix<f64>,
    nominal: Vector6<f64>,
    signals: &[f64],
    signal_error: f64,
    matrix_error: f64,
) -> PyResult<Vector6<f64>> {
    let sensor = sensor::<N>(matrix, nominal)?;
    let signals: [f64; N] = signals
        .try_into()
        .map_err(|_| errors::bad(format!("`signals` must be {N} numbers, not {}", signals.len())))?;
    let signals = SVector::from(signals);
    let solver = LeastSquares::new(&sensor).map_err(errors::calibration)?;
    let uncertainty = Uncertainty::of_signals(SVector::repeat(signal_error))
        .with_relative_matrix_error(&sensor, matrix_error);
    let bound = ErrorBound::new(&sensor, &solver, &uncertainty).map_err(errors::calibration)?;
    Ok(bound.at(&signals, &solver.solve(&signals)))
}

/// By how much each load that signals tell of may be off at most, rounding included.
///
/// Parameters
/// ----------
/// matrix : array_like, shape (gauges, 6)
///     Signals under nominal loads.
/// nominal : array_like, shape (6,)
/// signals : array_like, shape (gauges,)
/// signal_error : float
///     Greatest error of a signal.
/// matrix_error : float, optional
///     Greatest error of an entry of the matrix, over the largest of its row.
///
/// Returns
/// -------
/// ndarray, shape (6,)
///     [N, N·m]
#[pyfunction]
#[pyo3(signature = (matrix, nominal, signals, signal_error, matrix_error=0.0))]
pub(crate) fn worst_errors<'py>(
    py: Python<'py>,
    matrix: &Bound<'py, PyAny>,
    nominal: &Bound<'py, PyAny>,
    signals: &Bound<'py, PyAny>,
    signal_error: f64,
    matrix_error: f64,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let (matrix, nominal) =
        (numbers::table(matrix, "matrix")?, Vector6::from(numbers::numbers(nominal, "nominal")?));
    let signals = numbers::list(signals, "signals")?;
    let bound = by_gauges!(matrix, bounded(&matrix, nominal, &signals, signal_error, matrix_error))?;
    Ok(numbers::array(py, &bound))
}
