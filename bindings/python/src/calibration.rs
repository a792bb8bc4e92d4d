//! `fingertip.Calibration`.

use std::path::PathBuf;

use fingertip_calibration::file::{CalibrationFile, SignalUnit};
use fingertip_calibration::loads::LoadTable;
use fingertip_calibration::model::{Curvature, Direction, Limits, Method, Options};
use fingertip_calibration::{Axis, Calibration};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use pythonize::pythonize;

use crate::{enums, errors, numbers};

/// What a calibration was made of: a pickle makes it again.
struct From {
    loads: Py<PyAny>,
    signals: Py<PyAny>,
    options: Py<PyDict>,
}

/// A sensor that was fitted to known loads, and what it is worth. `calibrate` makes it.
#[pyclass(name = "Calibration", module = "fingertip", frozen, skip_from_py_object)]
pub(crate) struct PyCalibration {
    calibration: Calibration,
    from: From,
}

/// An option that was given.
fn option<'py>(options: &Bound<'py, PyDict>, key: &str) -> PyResult<Option<Bound<'py, PyAny>>> {
    Ok(options.get_item(key)?.filter(|option| !option.is_none()))
}

fn unit(name: &str) -> PyResult<SignalUnit> {
    let unit = SignalUnit::from_name(name).filter(|(_, size)| *size == 1.0).map(|(unit, _)| unit);
    unit.ok_or_else(|| {
        errors::calibration(format!("`unit` {name:?} is not known; write V, mV/V, count or strain"))
    })
}

fn axes(count: usize) -> PyResult<Vec<Axis>> {
    match count {
        6 => Ok(Axis::ALL.to_vec()),
        3 => Ok(Axis::FORCES.to_vec()),
        _ => Err(errors::calibration(format!(
            "`loads` must have 6 columns (fx to tz), or 3 (fx, fy, fz), not {count}"
        ))),
    }
}

fn table(
    loads: &Bound<'_, PyAny>,
    signals: &Bound<'_, PyAny>,
    options: &Bound<'_, PyDict>,
) -> PyResult<LoadTable> {
    let (loads, signals) = (numbers::table(loads, "loads")?, numbers::table(signals, "signals")?);
    let name: String = option(options, "unit")?.map_or_else(|| Ok("V".to_owned()), |unit| unit.extract())?;
    let axes = axes(loads.ncols())?;
    let mut table = LoadTable::new(&axes, loads, signals, unit(&name)?).map_err(errors::calibration)?;
    if let Some(names) = option(options, "names")? {
        table.names = names.extract::<Vec<String>>()?.into();
    }
    if let Some(cases) = option(options, "cases")? {
        table.cases = cases.extract()?;
    }
    if let Some(groups) = option(options, "groups")? {
        table.groups = groups.extract()?;
    }
    if let Some(weights) = option(options, "weights")? {
        table.weights = Some(numbers::list(&weights, "weights")?);
    }
    if let Some(times) = option(options, "times")? {
        table.times = Some(numbers::list(&times, "times")?);
    }
    if let Some(celsius) = option(options, "celsius")? {
        table.temperatures = Some(numbers::list(&celsius, "celsius")?);
    }
    table.validate().map_err(errors::calibration)?;
    Ok(table)
}

fn method(options: &Bound<'_, PyDict>) -> PyResult<Method> {
    let name: Option<String> = option(options, "method")?.map(|name| name.extract()).transpose()?;
    match name.as_deref() {
        None | Some("least_squares") => Ok(Method::LeastSquares),
        Some("huber") => Ok(Method::Huber),
        Some("ransac") => {
            let outliers = option(options, "outliers")?.map_or(Ok(0.3), |share| share.extract())?;
            let seed = option(options, "seed")?.map_or(Ok(1), |seed| seed.extract())?;
            Ok(Method::Ransac { outliers, seed })
        }
        Some(other) => Err(errors::calibration(format!(
            "`method` {other:?} is not known; there are \"least_squares\", \"huber\" and \"ransac\""
        ))),
    }
}

fn curvature(options: &Bound<'_, PyDict>) -> PyResult<Curvature> {
    let name: Option<String> = option(options, "curvature")?.map(|name| name.extract()).transpose()?;
    match name.as_deref() {
        None | Some("straight") => Ok(Curvature::Straight),
        Some("quadratic") => Ok(Curvature::Quadratic),
        Some("chosen") => Ok(Curvature::Chosen),
        Some(other) => Err(errors::calibration(format!(
            "`curvature` {other:?} is not known; there are \"straight\", \"quadratic\" and \"chosen\""
        ))),
    }
}

fn chosen(options: &Bound<'_, PyDict>) -> PyResult<Options> {
    let flag = |key, usual| option(options, key)?.map_or(Ok(usual), |flag| flag.extract::<bool>());
    let number = |key, usual| option(options, key)?.map_or(Ok(usual), |number| number.extract::<f64>());
    let curvature = curvature(options)?;
    let inverse = flag("loads_from_signals", curvature != Curvature::Straight)?;
    let usual = Limits::default();
    Ok(Options {
        direction: if inverse { Direction::LoadsFromSignals } else { Direction::SignalsFromLoads },
        bias: flag("bias", true)?,
        curvature,
        method: method(options)?,
        nominal: option(options, "nominal")?.map(|loads| numbers::list(&loads, "nominal")).transpose()?,
        range: option(options, "range")?.map(|range| numbers::numbers::<2>(&range, "range")).transpose()?,
        tare_groups: flag("tare_groups", false)?,
        reference_celsius: option(options, "reference_celsius")?
            .map(|celsius| celsius.extract())
            .transpose()?,
        creep: flag("creep", false)?,
        reject_outliers: flag("reject_outliers", false)?,
        touches: None,
        limits: Limits {
            left_out_percent: number("greatest_left_out_percent", usual.left_out_percent)?,
            condition_number: number("greatest_condition_number", usual.condition_number)?,
            ..usual
        },
    })
}

/// Fits a sensor; `fingertip.calibrate` has the options.
#[pyfunction]
pub(crate) fn calibrate_table(
    py: Python<'_>,
    loads: &Bound<'_, PyAny>,
    signals: &Bound<'_, PyAny>,
    options: &Bound<'_, PyDict>,
) -> PyResult<PyCalibration> {
    let (table, chosen) = (table(loads, signals, options)?, chosen(options)?);
    let calibration =
        py.detach(|| fingertip_calibration::calibrate(&table, &chosen)).map_err(errors::calibration)?;
    let from = From {
        loads: loads.clone().unbind(),
        signals: signals.clone().unbind(),
        options: options.clone().unbind(),
    };
    Ok(PyCalibration { calibration, from })
}

impl PyCalibration {
    fn file(&self) -> PyResult<CalibrationFile> {
        self.calibration.to_file().map_err(errors::calibration)
    }
}

/// What `__reduce__` gives.
type Reduced<'py> = (Bound<'py, PyAny>, (Py<PyAny>, Py<PyAny>, Py<PyDict>));

#[pymethods]
impl PyCalibration {
    /// Whether it can be trusted, a `Quality`.
    #[getter]
    fn verdict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        enums::member(py, "Quality", &self.calibration.report.verdict)
    }

    /// Why it cannot be.
    #[getter]
    fn reasons(&self) -> Vec<String> {
        self.calibration.report.reasons.clone()
    }

    /// What to mind although it can.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.calibration.report.notes.clone()
    }

    /// The normalised sensor matrix, gauges × axes: signals under nominal loads.
    #[getter]
    fn matrix<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let (matrix, _) = self.calibration.model.matrix_and_zero().map_err(errors::calibration)?;
        Ok(numbers::array2(py, &matrix))
    }

    /// The readings without load.
    #[getter]
    fn zero<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let (_, zero) = self.calibration.model.matrix_and_zero().map_err(errors::calibration)?;
        Ok(PyArray1::from_slice(py, zero.as_slice()))
    }

    /// Nominal load of each axis [N, N·m].
    #[getter]
    fn nominal<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.calibration.model.nominal)
    }

    /// Condition number of the normalised matrix.
    #[getter]
    fn condition_number(&self) -> f64 {
        self.calibration.model.condition_number()
    }

    /// The loads [N, N·m] that readings tell of, taken one by one: what of them is creep is not taken off.
    ///
    /// Parameters
    /// ----------
    /// signals : array_like, shape (n, gauges)
    ///
    /// Returns
    /// -------
    /// ndarray, shape (n, axes)
    fn loads<'py>(
        &self,
        py: Python<'py>,
        signals: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let signals = numbers::table(signals, "signals")?;
        let (found, expected) = (signals.ncols(), self.calibration.model.gauges());
        if found != expected {
            return Err(errors::bad(format!("`signals` must have {expected} columns, not {found}")));
        }
        let loads = self.calibration.model.loads(&signals);
        let loads = loads.ok_or_else(|| errors::calibration("the sensor matrix has deficient rank"))?;
        Ok(numbers::array2(py, &loads))
    }

    /// What can be said of it, as a dictionary: errors axis by axis, cross-talk, suspicions, every sample.
    fn report<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        pythonize(py, &self.calibration.report).map_err(errors::calibration)
    }

    /// The report as one page with tables and plots.
    #[pyo3(signature = (title="Calibration"))]
    fn report_html(&self, title: &str) -> String {
        self.calibration.report.to_html(title, &[])
    }

    /// The calibration file as a text, which a scene can name as `calibration` of `[sensor]`.
    fn to_toml(&self) -> PyResult<String> {
        self.file()?.to_toml().map_err(errors::calibration)
    }

    /// Writes the calibration file; it appears whole or not at all.
    fn save(&self, path: PathBuf) -> PyResult<()> {
        self.file()?.write(path).map_err(errors::calibration)
    }

    fn _repr_html_(&self) -> String {
        self.report_html("Calibration")
    }

    fn __str__(&self) -> String {
        self.calibration.report.to_string()
    }

    fn __repr__(&self) -> String {
        let report = &self.calibration.report;
        let (gauges, axes) = (self.calibration.model.gauges(), self.calibration.model.axes.len());
        format!(
            "<fingertip.Calibration: {}, {gauges} gauges, {axes} axes, {} samples, condition number {:.3}>",
            report.verdict.name(),
            report.samples,
            self.condition_number()
        )
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        let (py, From { loads, signals, options }) = (slf.py(), &slf.get().from);
        let make = py.import("fingertip._native")?.getattr("calibrate_table")?;
        Ok((make, (loads.clone_ref(py), signals.clone_ref(py), options.clone_ref(py))))
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        other.cast::<Self>().is_ok_and(|other| other.get().calibration == self.calibration)
    }
}
