//! Recordings: their rows as columns, and what they show.

use std::path::PathBuf;

use fingertip::friction::SlipVerdict;
use fingertip_cli::library::{HealthOf, Recorded, Sample, analyze, health};
use fingertip_recordings::{
    AssumedUnits, FaultCount, ForceUnit, LeftOut, Quality, ReaderOptions, RowMarks, TorqueUnit,
};
use nalgebra::Vector3;
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors;
use crate::scene::PyScene;

/// Numbers row by row as an array of rows and columns.
fn table<'py>(py: Python<'py>, numbers: Vec<f64>, columns: usize) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let rows = numbers.len() / columns.max(1);
    PyArray1::from_vec(py, numbers).reshape([rows, columns])
}

/// The faults that were found: how often each, and in which lines first.
fn faults<'py>(py: Python<'py>, quality: &Quality) -> PyResult<Bound<'py, PyDict>> {
    let all = PyDict::new(py);
    for (name, fault) in quality.faults() {
        let fault: FaultCount = fault;
        if fault.count() > 0 {
            all.set_item(name, (fault.count(), fault.first_lines().to_vec()))?;
        }
    }
    Ok(all)
}

fn assumed(force: Option<&str>, torque: Option<&str>) -> PyResult<AssumedUnits> {
    let unknown = |what, name: &str| errors::recording(format!("`{what}` {name:?} is no unit that is known"));
    let force = force.map(|name| ForceUnit::from_name(name).ok_or_else(|| unknown("force_unit", name)));
    let torque = torque.map(|name| TorqueUnit::from_name(name).ok_or_else(|| unknown("torque_unit", name)));
    Ok(AssumedUnits { force: force.transpose()?, torque: torque.transpose()? })
}

/// The rows of a recording, in a dictionary that `fingertip.Recording` is made of.
#[pyfunction]
#[pyo3(signature = (path, scene, topics, force_unit, torque_unit))]
pub(crate) fn read_rows<'py>(
    py: Python<'py>,
    path: PathBuf,
    scene: Option<&PyScene>,
    topics: Vec<String>,
    force_unit: Option<&str>,
    torque_unit: Option<&str>,
) -> PyResult<Bound<'py, PyDict>> {
    let mut notes = Vec::new();
    let recorded = Recorded { path, topics, ..Recorded::default() };
    let renamed = scene.map(|scene| scene.scene().renamed_columns().to_vec()).unwrap_or_default();
    let assumed_units = assumed(force_unit, torque_unit)?;
    let header = scene.is_none_or(|scene| scene.scene().has_header());
    let options = ReaderOptions { assumed_units, renamed, header, ..ReaderOptions::default() };
    let mut reader = recorded.rows(options, &mut notes).map_err(errors::recording)?;
    let layout = reader.layout().clone();
    let (mut time, mut gap, mut usable) = (Vec::new(), Vec::new(), Vec::new());
    let mut wrenches = vec![Vec::new(); layout.wrenches().len()];
    let mut signals = vec![Vec::new(); layout.signals().len()];
    py.detach(|| {
        while let Some(row) = reader.next_row().map_err(errors::recording)? {
            let marks: RowMarks = row.marks();
            time.push(row.time().unwrap_or(f64::NAN));
            gap.push(marks.gap);
            usable.push(row.is_usable());
            for (numbers, columns) in wrenches.iter_mut().zip(layout.wrenches()) {
                numbers.extend(row.unchecked_components(columns));
            }
            for (numbers, columns) in signals.iter_mut().zip(layout.signals()) {
                numbers.extend(row.unchecked_signals(columns));
            }
        }
        PyResult::Ok(())
    })?;
    let (of_wrenches, of_signals, units) = (PyDict::new(py), PyDict::new(py), PyDict::new(py));
    for (numbers, columns) in wrenches.into_iter().zip(layout.wrenches()) {
        of_wrenches.set_item(columns.name(), table(py, numbers, 6)?)?;
    }
    for (numbers, columns) in signals.into_iter().zip(layout.signals()) {
        let count = columns.count() + usize::from(columns.has_dummy());
        of_signals.set_item(columns.name(), table(py, numbers, count)?)?;
        units.set_item(columns.name(), serde_json::to_value(columns.unit()).ok().and_then(word))?;
    }
    let said = |LeftOut { sensor, problem }: &LeftOut| format!("sensor {sensor:?} is left out: {problem}");
    notes.extend(layout.left_out().iter().map(said));
    let parts = PyDict::new(py);
    parts.set_item("time", PyArray1::from_vec(py, time))?;
    parts.set_item("wrenches", of_wrenches)?;
    parts.set_item("signals", of_signals)?;
    parts.set_item("signal_units", units)?;
    parts.set_item("gap", PyArray1::from_vec(py, gap))?;
    parts.set_item("usable", PyArray1::from_vec(py, usable))?;
    parts.set_item("faults", faults(py, reader.quality())?)?;
    parts.set_item("quality", reader.quality().to_string())?;
    parts.set_item("notes", notes)?;
    Ok(parts)
}

fn word(value: serde_json::Value) -> Option<String> {
    value.as_str().map(str::to_owned)
}

/// The columns of an analysis while they grow.
#[derive(Default)]
struct Rows {
    status: Vec<u8>,
    /// By the number that `status` holds.
    words: Vec<&'static str>,
    slip: Vec<u8>,
    numbers: Vec<(&'static str, Vec<f64>)>,
    /// Which of `numbers` is next.
    next: usize,
}

impl Rows {
    fn put(&mut self, name: &'static str, value: f64) {
        if self.next == self.numbers.len() {
            self.numbers.push((name, Vec::new()));
        }
        if let Some((_, column)) = self.numbers.get_mut(self.next) {
            column.push(value);
        }
        self.next += 1;
    }

    fn put3(&mut self, names: [&'static str; 3], vector: Option<Vector3<f64>>) {
        let vector = vector.unwrap_or_else(|| Vector3::repeat(f64::NAN));
        names.into_iter().zip(&vector).for_each(|(name, value)| self.put(name, *value));
    }

    fn code(&mut self, word: &'static str) -> u8 {
        let place = self.words.iter().position(|known| *known == word).unwrap_or_else(|| {
            self.words.push(word);
            self.words.len() - 1
        });
        u8::try_from(place).unwrap_or(u8::MAX)
    }

    fn add(&mut self, time: f64, sample: Sample<'_>) {
        self.next = 0;
        let code = self.code(sample.status());
        self.status.push(code);
        let felt = match sample {
            Sample::Felt(felt) => Some(felt),
            Sample::Without(_) => None,
        };
        let (contact, force) = (felt.and_then(|felt| felt.contact()), felt.and_then(|felt| felt.force()));
        let margin = felt.and_then(|felt| felt.margin());
        let slip = felt.and_then(|felt| felt.touch.slip).unwrap_or(SlipVerdict::NotPressing);
        self.slip.push(slip as u8);
        let number = |value: Option<f64>| value.unwrap_or(f64::NAN);
        self.put("t_s", time);
        self.put3(["fx_N", "fy_N", "fz_N"], felt.map(|felt| felt.touch.wrench.force()));
        self.put3(["tx_Nm", "ty_Nm", "tz_Nm"], felt.map(|felt| felt.touch.wrench.torque()));
        self.put3(["x_m", "y_m", "z_m"], contact.map(|contact| contact.point));
        self.put3(["nx", "ny", "nz"], contact.map(|contact| contact.normal));
        self.put("normal_N", number(force.map(|force| force.normal)));
        let tangential = ["tangential_x_N", "tangential_y_N", "tangential_z_N"];
        self.put3(tangential, force.map(|force| force.tangential.vector()));
        self.put("spin_Nm", number(force.map(|force| force.spin)));
        self.put("margin_N", number(margin.map(|margin| margin.newtons)));
        self.put("utilisation", number(margin.map(|margin| margin.utilisation)));
        let spread = felt.and_then(|felt| felt.spread);
        self.put("ellipse_a_m", number(spread.map(|spread| spread.ellipse.semi_axes[0])));
        self.put("ellipse_b_m", number(spread.map(|spread| spread.ellipse.semi_axes[1])));
        self.put("normal_deviation_N", number(spread.map(|spread| spread.normal_force)));
        let tracked = felt.and_then(|felt| felt.tracked);
        self.put3(["track_x_m", "track_y_m", "track_z_m"], tracked.map(|tracked| tracked.point));
        let learnt = felt.and_then(|felt| felt.friction);
        self.put("mu_static", number(learnt.and_then(|learnt| learnt.at_rest).map(|mu| mu.coefficient)));
        self.put("mu_kinetic", number(learnt.and_then(|learnt| learnt.sliding).map(|mu| mu.coefficient)));
        self.put("slip_probability", number(felt.and_then(|felt| felt.slip_probability)));
        self.put("grip_N", number(felt.and_then(|felt| felt.grip_force)));
    }
}

/// What a recording shows, in a dictionary that `fingertip.Analysis` is made of.
#[pyfunction]
#[pyo3(signature = (path, scene, sensor, topics, celsius, start, end))]
#[allow(clippy::too_many_arguments, reason = "keywords in Python")]
pub(crate) fn analyze_rows<'py>(
    py: Python<'py>,
    path: PathBuf,
    scene: &PyScene,
    sensor: Option<String>,
    topics: Vec<String>,
    celsius: Option<f64>,
    start: Option<f64>,
    end: Option<f64>,
) -> PyResult<Bound<'py, PyDict>> {
    let recorded = Recorded { path, sensor, topics, celsius, start, end };
    let mut rows = Rows::default();
    let (of, file) = (scene.scene(), scene.path());
    let analysis = py
        .detach(|| analyze(of, file, &recorded, &mut |time, sample| rows.add(time, sample)))
        .map_err(errors::recording)?;
    let columns = PyDict::new(py);
    for (name, numbers) in rows.numbers {
        columns.set_item(name, PyArray1::from_vec(py, numbers))?;
    }
    columns.set_item("slip", PyArray1::from_vec(py, rows.slip))?;
    let parts = PyDict::new(py);
    parts.set_item("columns", columns)?;
    parts.set_item("status_codes", PyArray1::from_vec(py, rows.status))?;
    parts.set_item("status_words", rows.words)?;
    parts.set_item("sensor", analysis.sensor)?;
    parts.set_item("notes", analysis.notes)?;
    parts.set_item("faults", faults(py, &analysis.quality)?)?;
    parts.set_item("quality", analysis.quality.to_string())?;
    parts.set_item("summary", analysis.summary)?;
    parts.set_item("html", analysis.html)?;
    Ok(parts)
}

/// What a recording shows of its sensor, in a dictionary that `fingertip.Health` is made of.
#[pyfunction]
#[pyo3(signature = (path, sensor, topics, calibration, celsius, rate))]
pub(crate) fn look_at_health<'py>(
    py: Python<'py>,
    path: PathBuf,
    sensor: Option<String>,
    topics: Vec<String>,
    calibration: Option<PathBuf>,
    celsius: Option<f64>,
    rate: Option<f64>,
) -> PyResult<Bound<'py, PyDict>> {
    let recorded = Recorded { path, sensor, topics, celsius, ..Recorded::default() };
    let found = py.detach(|| health(&recorded, calibration.as_deref(), rate)).map_err(errors::recording)?;
    let HealthOf { health, notes, summary, html } = found;
    let (spectra, courses) = (PyDict::new(py), PyDict::new(py));
    for channel in &health.channels {
        let flat = |numbers: Vec<f64>, columns| table(py, numbers, columns);
        let spectrum = channel.spectrum.iter().flat_map(|(frequency, density)| [*frequency, *density]);
        spectra.set_item(&channel.name, flat(spectrum.collect(), 2)?)?;
        let course = channel.course.iter().flat_map(|part| [part.time, part.least, part.mean, part.greatest]);
        courses.set_item(&channel.name, flat(course.collect(), 4)?)?;
    }
    let parts = PyDict::new(py);
    parts.set_item("figures", pythonize::pythonize(py, &health).map_err(errors::recording)?)?;
    parts.set_item("verdict", health.level().name())?;
    parts.set_item("spectra", spectra)?;
    parts.set_item("courses", courses)?;
    parts.set_item("notes", notes)?;
    parts.set_item("summary", summary)?;
    parts.set_item("html", html)?;
    Ok(parts)
}

/// The command, with the arguments of a shell; gives its exit code.
#[pyfunction]
pub(crate) fn run_command(py: Python<'_>, arguments: Vec<std::ffi::OsString>) -> u8 {
    py.detach(|| fingertip_cli::run(arguments))
}
