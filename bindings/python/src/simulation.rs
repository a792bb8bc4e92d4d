//! A simulated fingertip, and the design of a sensor.

use fingertip_calibration::design::{
    Assessment, ContactWeight, Criterion, DesignError, Excitation, LayoutFile, LoadedTube, Material,
    NominalLoads, Search, TubeSpace, Wall, search,
};
use fingertip_simulation::{Options, Script, Segment, SimulatedFingertip, standard_session};
use nalgebra::Vector3;
use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use pythonize::depythonize;

use crate::{errors, numbers};

/// What a simulated fingertip reads, and what was really so, in a dictionary that `fingertip.Simulation` is made of.
#[pyfunction]
pub(crate) fn simulate_script<'py>(
    py: Python<'py>,
    script: Option<&Bound<'py, PyAny>>,
    sample_rate: f64,
    seed: u64,
) -> PyResult<Bound<'py, PyDict>> {
    let script = match script {
        None => standard_session(),
        Some(list) => {
            let segments: Vec<Segment> = depythonize(list)
                .map_err(|error| errors::simulation(format!("the script is none: {error}")))?;
            Script { segments }
        }
    };
    let options = Options { sample_rate, seed, ..Options::default() };
    let tip = SimulatedFingertip::new(&script, options).map_err(errors::simulation)?;
    let (matrix, onsets) = (*tip.calibrated_matrix(), tip.slip_onsets().to_vec());
    let sphere = tip.sphere();
    let rim = tip.options().design.greatest_angle();
    let none = || Vector3::repeat(f64::NAN);
    let (mut time, mut raw, mut wrench) = (Vec::new(), Vec::<f64>::new(), Vec::<f64>::new());
    let (mut point, mut normal, mut force) = (Vec::<f64>::new(), Vec::<f64>::new(), Vec::<f64>::new());
    let (mut slipping, mut phase) = (Vec::new(), Vec::new());
    py.detach(|| {
        for sample in tip {
            time.push(sample.time);
            raw.extend(sample.raw.iter());
            wrench.extend(sample.truth.wrench.components().iter());
            let contact = sample.truth.contact;
            point.extend(contact.map_or_else(none, |contact| contact.point).iter());
            normal.extend(contact.map_or_else(none, |contact| contact.normal).iter());
            force.extend(contact.map_or_else(none, |contact| contact.force).iter());
            slipping.push(sample.truth.slipping);
            phase.push(sample.truth.phase as u64);
        }
    });
    let rows = time.len();
    let parts = PyDict::new(py);
    parts.set_item("time", PyArray1::from_vec(py, time))?;
    parts.set_item("raw", PyArray1::from_vec(py, raw).reshape([rows, 7])?)?;
    parts.set_item("wrench", PyArray1::from_vec(py, wrench).reshape([rows, 6])?)?;
    for (name, vectors) in [("point", point), ("normal", normal), ("force", force)] {
        parts.set_item(name, PyArray1::from_vec(py, vectors).reshape([rows, 3])?)?;
    }
    parts.set_item("slipping", PyArray1::from_vec(py, slipping))?;
    parts.set_item("phase", PyArray1::from_vec(py, phase))?;
    parts.set_item("slip_onsets", PyArray1::from_vec(py, onsets))?;
    parts.set_item("matrix", numbers::array2(py, matrix.normalised()))?;
    parts.set_item("nominal", numbers::array(py, matrix.nominal()))?;
    parts.set_item("centre", numbers::array(py, &sphere.centre()))?;
    parts.set_item("radius", sphere.radius())?;
    parts.set_item("half_angle", rim)?;
    Ok(parts)
}

/// What a sensor is to be, with the units of the command.
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Wanted {
    force: f64,
    torque: f64,
    radius: [f64; 2],
    length: f64,
    layout: String,
    gauges: usize,
    criterion: String,
    material: String,
    safety: f64,
    tip_radius: f64,
    friction: f64,
    supply: f64,
    gauge_factor: f64,
    gain: f64,
    starts: usize,
    seed: u64,
}

/// Angles of gauges that a search may use: none along the axis, none where axial strain is nil.
const ANGLES: [f64; 2] = [1.0, 59.0];
/// Part of the clamped length that gauges may use: near the clamp the strain is not that of a beam.
const USABLE: f64 = 0.8;

impl Wanted {
    fn space(&self, tube: LoadedTube) -> Result<TubeSpace, DesignError> {
        let wall = Wall::AtStrength { safety: self.safety };
        let (length, angles) = (USABLE * self.length, ANGLES.map(f64::to_radians));
        let (radius, angles) = (self.radius.into(), angles.into());
        let wrong = |expected| DesignError::WrongCount { what: "gauges", found: self.gauges, expected };
        match self.layout.as_str() {
            "paper" if self.gauges == 6 => {
                TubeSpace::bicchi_dario(radius, angles, (0.05 * length, length), tube, wall)
            }
            "paper" => Err(wrong(6)),
            "free" => TubeSpace::free(self.gauges, (0.0, length), tube, wall),
            _ if self.gauges < 6 || self.gauges % 2 == 1 => Err(wrong(6.max(self.gauges + 1))),
            _ => TubeSpace::rosettes(self.gauges / 2, radius, angles, (0.0, length), tube, wall),
        }
    }

    /// What is made small, and the weight of contact errors that every design is judged by.
    fn criterion(&self, loads: &NominalLoads) -> Result<(Option<Criterion>, ContactWeight), DesignError> {
        let half_angle = core::f64::consts::FRAC_PI_2;
        let weight = ContactWeight::on_sphere(self.tip_radius, half_angle, self.friction, 0.1 * self.force)?;
        let weight = weight.normalised(&loads.components());
        let criterion = match self.criterion.as_str() {
            "condition_number" => Some(Criterion::ConditionNumber),
            "contact_error" => Some(Criterion::ContactError(weight)),
            "worst_axis" => Some(Criterion::WorstAxis),
            "trace" => Some(Criterion::Trace),
            "log_determinant" => Some(Criterion::LogDeterminant),
            _ => None,
        };
        Ok((criterion, weight))
    }
}

/// Searches for a layout of gauges; `fingertip.design` has the options.
#[pyfunction]
pub(crate) fn design_layout<'py>(
    py: Python<'py>,
    wanted: &Bound<'py, PyDict>,
) -> PyResult<Bound<'py, PyDict>> {
    let wanted: Wanted = depythonize(wanted)
        .map_err(|error| errors::design(format!("what is wanted cannot be read: {error}")))?;
    let known = Material::NAMED.map(|(name, _)| name).join(", ");
    let material = Material::from_name(&wanted.material).ok_or_else(|| {
        errors::design(format!("`material` {:?} is not known; there are {known}", wanted.material))
    })?;
    let loads = NominalLoads::equal(wanted.force, wanted.torque).map_err(errors::design)?;
    let tube = LoadedTube { material, radius: wanted.radius[1], length: wanted.length, loads };
    let (criterion, weight) = wanted.criterion(&loads).map_err(errors::design)?;
    let criterion = criterion
        .ok_or_else(|| errors::design(format!("`criterion` {:?} is not known", wanted.criterion)))?;
    let space = wanted.space(tube).map_err(errors::design)?;
    let how = Search { starts: wanted.starts, seed: wanted.seed, ..Search::default() };
    let found = py.detach(|| search(&space, &criterion, &loads, &how, &|_| ())).map_err(errors::design)?;
    let best = found.best().ok_or_else(|| errors::design("no start gave a sensor"))?;
    let layout = space.layout(&best.values).map_err(errors::design)?;
    let tube = LoadedTube { radius: layout.beam.radius, ..tube };
    let (supply, gauge_factor) = (wanted.supply, wanted.gauge_factor);
    let excitation = Excitation { supply, gauge_factor, amplifier_gain: wanted.gain };
    let file = LayoutFile::new(&layout, &tube, excitation).map_err(errors::design)?;
    let strain = layout.normalised(1.0, &loads).map_err(errors::design)?;
    let singular = || errors::design("the sensor matrix is not finite");
    let assessed = Assessment::new(&strain, Some(&weight)).ok_or_else(singular)?;
    let volts = layout.normalised(excitation.gain(), &loads).map_err(errors::design)?;
    let predicted = file.predicted_calibration().map_err(errors::design)?;
    let gauges: Vec<f64> = layout.gauges.iter().flat_map(|gauge| [gauge.z, gauge.theta, gauge.q]).collect();
    let parts = PyDict::new(py);
    parts.set_item("gauges", PyArray1::from_vec(py, gauges).reshape([layout.gauges.len(), 3])?)?;
    parts.set_item("radius", layout.beam.radius)?;
    parts.set_item("thickness", layout.beam.thickness)?;
    parts.set_item("condition_number", assessed.condition_number)?;
    parts.set_item("criterion", best.criterion)?;
    parts.set_item("matrix", numbers::array2(py, &volts))?;
    parts.set_item("layout_toml", file.to_toml().map_err(errors::design)?)?;
    parts.set_item("calibration_toml", predicted.to_toml().map_err(errors::design)?)?;
    Ok(parts)
}
