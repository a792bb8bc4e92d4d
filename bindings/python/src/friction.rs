//! `fingertip.FrictionLimit`, `fingertip.SlipDetector` and `fingertip.IncipientSlip`.

use fingertip::friction::{
    ForceNoise, FrictionLimit, FrictionModel, IncipientSlip, LimitCurve, LimitPoint, NormalForceGate,
    PressureDistribution, SlipDetector, SlipDirection, SlipVerdict,
};
use fingertip::wrench::ContactForce;
use fingertip_scene::{Detector, Limit};
use nalgebra::Vector3;
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::scene::PyScene;
use crate::sections::document;
use crate::{enums, errors, numbers, value};

/// A scene of a flat fingertip with some sections, to check them as scenes are checked.
fn flat_scene(py: Python<'_>, rate: f64, sections: [(&str, &Bound<'_, PyDict>); 2]) -> PyResult<PyScene> {
    let (surface, input, all) = (PyDict::new(py), PyDict::new(py), PyDict::new(py));
    input.set_item("convention", "on_fingertip")?;
    input.set_item("sample_rate_Hz", rate)?;
    all.set_item("input", input)?;
    surface.set_item("shape", "plane")?;
    surface.set_item("point_m", [0.0, 0.0, 0.0])?;
    surface.set_item("normal", [0.0, 0.0, 1.0])?;
    all.set_item("surface", surface)?;
    for (name, section) in sections {
        if !section.is_empty() {
            all.set_item(name, section)?;
        }
    }
    PyScene::from_text(document(&all)?)
}

fn force(normal: f64, tangential: Option<&Bound<'_, PyAny>>, spin: f64) -> PyResult<ContactForce<f64>> {
    let tangential = tangential.map_or_else(|| Ok(Vector3::zeros()), |t| numbers::three(t, "tangential"))?;
    Ok(ContactForce::new(normal, tangential, spin))
}

/// A limit of friction: how far a contact force is from slipping.
///
/// Parameters
/// ----------
/// limit : str, optional
///     "coulomb", "anisotropic", "soft_finger", "power", "load_dependent" or "uncertain": see `Scene.choices`.
/// **parameters
///     What the section `[friction]` of a scene would hold. The anisotropic one is for forces along a plane whose
///     normal is z.
///
/// Examples
/// --------
/// >>> from fingertip import FrictionLimit
/// >>> limit = FrictionLimit("soft_finger", static_coefficient=0.5, torque_arm_m=0.003)
/// >>> newtons, utilisation = limit.margin(2.0, [0.6, 0.0, 0.0])
/// >>> newtons > 0, round(utilisation, 6)
/// (True, 0.6)
#[pyclass(name = "FrictionLimit", module = "fingertip", frozen, skip_from_py_object)]
pub(crate) struct PyLimit {
    limit: Limit<f64>,
    scene: String,
}

impl PyLimit {
    fn of(scene: &PyScene) -> PyResult<Self> {
        let limit =
            scene.scene().limit().copied().ok_or_else(|| errors::friction("there is no [friction]"))?;
        Ok(Self { limit, scene: scene.text().to_owned() })
    }
}

#[pymethods]
impl PyLimit {
    #[new]
    #[pyo3(signature = (limit="coulomb", **parameters))]
    fn new(limit: &str, parameters: Option<&Bound<'_, PyDict>>, py: Python<'_>) -> PyResult<Self> {
        let section = parameters.map_or_else(|| Ok(PyDict::new(py)), Bound::copy)?;
        section.set_item("limit", limit)?;
        Self::of(&flat_scene(py, 1000.0, [("friction", &section), ("slip", &PyDict::new(py))])?)
    }

    /// Signed distance to the limit [N], positive while the contact holds, and how much of the limit is used.
    ///
    /// Parameters
    /// ----------
    /// normal : float
    ///     Normal force [N].
    /// tangential : array_like, shape (3,), optional
    ///     Tangential force [N].
    /// spin : float, optional
    ///     Torque about the normal [N·m].
    #[pyo3(signature = (normal, tangential=None, spin=0.0))]
    fn margin(&self, normal: f64, tangential: Option<&Bound<'_, PyAny>>, spin: f64) -> PyResult<(f64, f64)> {
        let margin = self.limit.slip_margin(&force(normal, tangential, spin)?);
        Ok((margin.newtons, margin.utilisation))
    }

    /// The least normal force that holds a tangential load with a factor of safety [N].
    #[pyo3(signature = (tangential=None, spin=0.0, safety=1.0))]
    fn least_normal_force(
        &self,
        tangential: Option<&Bound<'_, PyAny>>,
        spin: f64,
        safety: f64,
    ) -> PyResult<f64> {
        Ok(self.limit.least_normal_force(&force(0.0, tangential, spin)?, safety))
    }

    /// The probability that the contact slips, where the coefficient has a deviation.
    #[pyo3(signature = (normal, tangential=None, spin=0.0))]
    fn slip_probability(
        &self,
        normal: f64,
        tangential: Option<&Bound<'_, PyAny>>,
        spin: f64,
    ) -> PyResult<Option<f64>> {
        Ok(self.limit.slip_probability(&force(normal, tangential, spin)?))
    }

    /// How the finger slides over the object when this force slips: direction of its velocity, and the spin that goes with
    /// it [1/m]. `None` where there is no tangential load.
    #[pyo3(signature = (normal, tangential=None, spin=0.0))]
    fn slip_direction<'py>(
        &self,
        py: Python<'py>,
        normal: f64,
        tangential: Option<&Bound<'py, PyAny>>,
        spin: f64,
    ) -> PyResult<Option<(Bound<'py, PyArray1<f64>>, f64)>> {
        let force = force(normal, tangential, spin)?;
        let slips: Option<SlipDirection<f64>> = match &self.limit {
            Limit::Coulomb(limit) => limit.slip_direction(&force),
            Limit::Anisotropic(limit) => limit.slip_direction(&force),
            Limit::SoftFinger(limit) => limit.slip_direction(&force),
            Limit::Power(limit) => limit.slip_direction(&force),
            Limit::LoadDependent(limit) => limit.slip_direction(&force),
            Limit::Uncertain { cautious, .. } => cautious.slip_direction(&force),
        };
        Ok(slips.map(|SlipDirection { velocity, spin }| (numbers::array(py, &velocity), spin)))
    }

    /// The static coefficient; the lowest where it depends on the direction.
    #[getter]
    fn coefficient(&self) -> f64 {
        self.limit.coefficient()
    }

    #[staticmethod]
    fn _from_bytes(bytes: &[u8]) -> PyResult<Self> {
        Self::of(&PyScene::from_text(value::from_bytes(bytes)?)?)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<value::Reduced<'py>> {
        value::reduced(slf.as_any(), &slf.get().scene)
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        other.cast::<Self>().is_ok_and(|other| other.get().limit == self.limit)
    }
}

/// Finds slip in a stream of contact forces. A copy keeps what it saw; a pickle begins anew.
///
/// Parameters
/// ----------
/// detector : str
///     "drop", "threshold", "likelihood_ratio", "stick_slip" or "adaptive_drop": see `Scene.choices`.
/// static_coefficient : float, optional
///     For the threshold.
/// sample_rate : float, optional
///     For detectors that count false alarms by the minute [Hz].
/// **parameters
///     What the section `[slip]` of a scene would hold.
#[pyclass(name = "SlipDetector", module = "fingertip")]
pub(crate) struct PyDetector {
    detector: Detector<f64>,
    scene: String,
}

impl PyDetector {
    fn of(scene: &PyScene) -> PyResult<Self> {
        let detector = scene.scene().pipeline().detector().cloned();
        let detector = detector.ok_or_else(|| errors::friction("there is no [slip]"))?;
        Ok(Self { detector, scene: scene.text().to_owned() })
    }
}

#[pymethods]
impl PyDetector {
    #[new]
    #[pyo3(signature = (detector, *, static_coefficient=None, sample_rate=1000.0, **parameters))]
    fn new(
        detector: &str,
        static_coefficient: Option<f64>,
        sample_rate: f64,
        parameters: Option<&Bound<'_, PyDict>>,
        py: Python<'_>,
    ) -> PyResult<Self> {
        let slip = parameters.map_or_else(|| Ok(PyDict::new(py)), Bound::copy)?;
        slip.set_item("detector", detector)?;
        let friction = PyDict::new(py);
        if let Some(coefficient) = static_coefficient {
            friction.set_item("static_coefficient", coefficient)?;
        }
        Self::of(&flat_scene(py, sample_rate, [("friction", &friction), ("slip", &slip)])?)
    }

    /// Takes a contact force and the time since the one before [s]; gives a `SlipVerdict`.
    #[pyo3(signature = (normal, tangential, time_step, spin=0.0))]
    fn update(
        &mut self,
        py: Python<'_>,
        normal: f64,
        tangential: &Bound<'_, PyAny>,
        time_step: f64,
        spin: f64,
    ) -> PyResult<Py<PyAny>> {
        let verdict = self.detector.update(&force(normal, Some(tangential), spin)?, time_step);
        enums::slip(py, verdict)
    }

    /// Forgets all samples.
    fn reset(&mut self) {
        self.detector.reset();
    }

    fn __copy__(&self) -> Self {
        Self { detector: self.detector.clone(), scene: self.scene.clone() }
    }

    fn __deepcopy__(&self, _memo: &Bound<'_, PyAny>) -> Self {
        self.__copy__()
    }

    #[staticmethod]
    fn _from_bytes(bytes: &[u8]) -> PyResult<Self> {
        Self::of(&PyScene::from_text(value::from_bytes(bytes)?)?)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<value::Reduced<'py>> {
        value::reduced(slf.as_any(), &slf.borrow().scene)
    }
}

/// Warns of slip from how a contact gives way, before it slips: needs the displacement of the finger over the object.
///
/// Parameters
/// ----------
/// noise : float
///     Standard deviation of a force component [N].
/// window : float
///     Displacement over which the stiffness is told [m].
/// warning_share : float
///     The share of the first stiffness that is left when it warns.
///
/// Notes
/// -----
/// A copy keeps what it saw; a pickle begins anew.
#[pyclass(name = "IncipientSlip", module = "fingertip", skip_from_py_object)]
#[derive(Clone)]
pub(crate) struct PyIncipient {
    watch: IncipientSlip<f64>,
    made: (f64, f64, f64),
}

impl PyIncipient {
    fn of(made: (f64, f64, f64)) -> PyResult<Self> {
        let (noise, window, warning_share) = made;
        let noise = ForceNoise::isotropic(noise).map_err(errors::friction)?;
        let gate = NormalForceGate::from_noise(&noise);
        let watch = IncipientSlip::new(gate, window)
            .and_then(|detector| detector.with_warning_share(warning_share))
            .map_err(errors::friction)?;
        Ok(Self { watch, made })
    }
}

value::watcher_class!(PyIncipient);

#[pymethods]
impl PyIncipient {
    #[new]
    fn new(noise: f64, window: f64, warning_share: f64) -> PyResult<Self> {
        Self::of((noise, window, warning_share))
    }

    /// Takes a contact force and where the finger is over the object [m]; gives a `SlipVerdict`.
    fn update(
        &mut self,
        py: Python<'_>,
        normal: f64,
        tangential: &Bound<'_, PyAny>,
        displacement: &Bound<'_, PyAny>,
    ) -> PyResult<Py<PyAny>> {
        let displacement = numbers::three(displacement, "displacement")?;
        let verdict: SlipVerdict = self.watch.update(&force(normal, Some(tangential), 0.0)?, &displacement);
        enums::slip(py, verdict)
    }

    /// The stiffness of the contact now [N/m], or `None`.
    #[getter]
    fn stiffness(&self) -> Option<f64> {
        self.watch.stiffness()
    }

    /// Forgets all samples.
    fn reset(&mut self) {
        self.watch.reset();
    }
}

/// The greatest tangential force and spin torque that a round patch holds together.
///
/// Parameters
/// ----------
/// pressure : str
///     "uniform", "hertz" or "winkler".
/// count : int
///     Number of points.
///
/// Returns
/// -------
/// ndarray, shape (count, 3)
///     Force over μ·normal, torque over μ·normal·torque arm, and where the patch turns about, over its radius.
#[pyfunction]
pub(crate) fn limit_curve<'py>(
    py: Python<'py>,
    pressure: &str,
    count: usize,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let pressure = match pressure {
        "uniform" => PressureDistribution::Uniform,
        "hertz" => PressureDistribution::Hertz,
        "winkler" => PressureDistribution::Winkler,
        other => {
            return Err(errors::friction(format!("`pressure` {other:?} is not uniform, hertz or winkler")));
        }
    };
    let numbers: Vec<f64> = LimitCurve::new(pressure)
        .table(count)
        .iter()
        .flat_map(|LimitPoint { force, torque, centre }| [*force, *torque, *centre])
        .collect();
    PyArray1::from_vec(py, numbers).reshape([count, 3])
}
