//! What is learnt of a contact over time: `LineMeeting`, `ContactEvents`, `MotionJudge`; and `fuse`.

use fingertip::contact::{
    ArrayContact, ContactEvents, FingerVelocity, Fused, FusedContact, Fusion, Grip, LineMeeting, Met,
    MotionJudge, Motions,
};
use fingertip::surfaces::DynSurface;
use fingertip::wrench::Wrench;
use nalgebra::Vector6;
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::surface::PySurface;
use crate::touch::{PyHappened, PyTracked};
use crate::{errors, numbers, value};

fn wrench(given: &Bound<'_, PyAny>) -> PyResult<Wrench<f64>> {
    Ok(Wrench::from_components(&Vector6::from(numbers::numbers::<6>(given, "wrench")?)))
}

/// Where the lines of action of several wrenches meet: the contact, whatever the shape, while it stays and its force
/// turns. Copies and pickles keep what it has learnt.
#[pyclass(name = "LineMeeting", module = "fingertip", skip_from_py_object)]
#[derive(Clone)]
pub(crate) struct PyMeeting(LineMeeting<f64>);

#[pymethods]
impl PyMeeting {
    #[new]
    fn new() -> Self {
        Self(LineMeeting::new())
    }

    /// Takes a wrench and its covariance; `False` for one that tells nothing.
    fn add(&mut self, wrench: &Bound<'_, PyAny>, covariance: &Bound<'_, PyAny>) -> PyResult<bool> {
        let covariance = numbers::matrix::<6, 6>(covariance, "covariance")?;
        Ok(self.0.add(&self::wrench(wrench)?, &covariance))
    }

    /// The place [m], its covariance [m²], and by how much more than their noise the lines miss it.
    ///
    /// Raises
    /// ------
    /// FingertipError
    ///     The lines do not tell where they meet.
    fn find<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyArray1<f64>>, Bound<'py, PyArray2<f64>>, f64)> {
        let Met { point, covariance, excess } = self.0.find().map_err(errors::bad)?;
        Ok((numbers::array(py, &point), numbers::array2(py, &covariance), excess))
    }

    fn __len__(&self) -> usize {
        self.0.count() as usize
    }

    /// Forgets all wrenches.
    fn reset(&mut self) {
        self.0.reset();
    }
}

/// Tells when something touches, lets go or strikes, from the force alone.
///
/// Parameters
/// ----------
/// noise : float
///     Standard deviation of a force component [N].
/// least_force : float
///     The smallest touch [N].
/// samples_per_false_event : float, optional
///     So many samples lie between two false events, or more, in the mean.
/// longest_impact : float, optional
///     So soon the force of a blow falls to half its peak, or it is a press [s].
///
/// Examples
/// --------
/// >>> from fingertip import ContactEvents
/// >>> events = ContactEvents(0.01, 0.06)
/// >>> [events.observe([0, 0, -force], 1e-3).touching for force in (0.0, 0.3, 0.3)]
/// [False, True, True]
///
/// Notes
/// -----
/// A copy keeps what it saw; a pickle begins anew.
#[pyclass(name = "ContactEvents", module = "fingertip", skip_from_py_object)]
#[derive(Clone)]
pub(crate) struct PyEvents {
    events: ContactEvents<f64>,
    made: (f64, f64, f64, f64),
}

impl PyEvents {
    fn of(made: (f64, f64, f64, f64)) -> PyResult<Self> {
        let events = ContactEvents::new(made.0, made.1, made.2);
        let events = events.and_then(|events| events.with_longest_impact(made.3)).map_err(errors::bad)?;
        Ok(Self { events, made })
    }
}

value::watcher_class!(PyEvents);
value::learner_class!(PyMeeting);

#[pymethods]
impl PyEvents {
    #[new]
    #[pyo3(signature = (noise, least_force, samples_per_false_event=1e6, longest_impact=0.05))]
    fn new(
        noise: f64,
        least_force: f64,
        samples_per_false_event: f64,
        longest_impact: f64,
    ) -> PyResult<Self> {
        Self::of((noise, least_force, samples_per_false_event, longest_impact))
    }

    /// Takes a force on the fingertip [N], shape (3,), and the time since the one before [s].
    fn observe(&mut self, force: &Bound<'_, PyAny>, time_step: f64) -> PyResult<PyHappened> {
        Ok(PyHappened(self.events.observe(&numbers::three(force, "force")?, time_step)))
    }

    /// Whether something touches.
    #[getter]
    fn is_touching(&self) -> bool {
        self.events.is_touching()
    }

    /// Forgets all samples.
    fn reset(&mut self) {
        self.events.reset();
    }
}

/// Tells whether a contact sticks, rolls or slides, by how the finger moves over an object at rest.
///
/// Parameters
/// ----------
/// speed : float
///     At which contacts move over the finger, about [m/s].
/// linear, angular : float
///     Standard deviations of the finger's velocity [m/s] and turning [rad/s].
#[pyclass(name = "MotionJudge", module = "fingertip", frozen, skip_from_py_object)]
#[derive(Clone)]
pub(crate) struct PyJudge {
    judge: MotionJudge<f64>,
    made: (f64, f64, f64),
}

impl PyJudge {
    fn of(made: (f64, f64, f64)) -> PyResult<Self> {
        let judge = MotionJudge::new(made.0, made.1, made.2).map_err(errors::bad)?;
        Ok(Self { judge, made })
    }
}

value::watcher_class!(PyJudge);

#[pymethods]
impl PyJudge {
    #[new]
    fn new(speed: f64, linear: f64, angular: f64) -> PyResult<Self> {
        Self::of((speed, linear, angular))
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        other.cast::<Self>().is_ok_and(|other| other.get().judge == self.judge)
    }

    /// The probabilities that it sticks, rolls and slides; `None` where nothing can be said.
    ///
    /// Parameters
    /// ----------
    /// tracked : Tracked
    /// linear, angular : array_like, shape (3,)
    ///     Velocity of the sensor's origin over the object [m/s], and turning [rad/s], in the sensor frame.
    fn judge(
        &self,
        tracked: &PyTracked,
        linear: &Bound<'_, PyAny>,
        angular: &Bound<'_, PyAny>,
    ) -> PyResult<Option<(f64, f64, f64)>> {
        let (linear, angular) = (numbers::three(linear, "linear")?, numbers::three(angular, "angular")?);
        let judged = self.judge.judge(&tracked.0, &FingerVelocity { linear, angular });
        Ok(judged.map(|Motions { sticking, rolling, sliding }| (sticking, rolling, sliding)))
    }
}

/// A reading of a tactile array, from the arguments of `fuse`.
fn reading(given: &Bound<'_, PyAny>) -> PyResult<ArrayContact<f64>> {
    let part = |key: &str| given.get_item(key);
    Ok(ArrayContact {
        centroid: numbers::three(&part("centroid")?, "centroid")?,
        centroid_covariance: numbers::matrix::<3, 3>(&part("centroid_covariance")?, "centroid_covariance")?,
        normal_force: part("normal_force")?.extract()?,
        normal_deviation: part("normal_deviation")?.extract()?,
    })
}

/// A contact of those that wrench and array tell, by the names of its parts.
pub(crate) fn parts<'py>(py: Python<'py>, contact: &FusedContact<f64>) -> PyResult<Bound<'py, PyDict>> {
    let parts = PyDict::new(py);
    parts.set_item("point", numbers::array(py, &contact.point))?;
    parts.set_item("normal", numbers::array(py, &contact.normal))?;
    parts.set_item("force", numbers::array(py, &contact.force))?;
    parts.set_item("point_covariance", numbers::array2(py, &contact.point_covariance))?;
    parts.set_item("force_covariance", numbers::array2(py, &contact.force_covariance))?;
    parts.set_item("share_from_wrench", contact.share_from_wrench)?;
    let grip = match contact.grip {
        Grip::Sticks => "sticks",
        Grip::Slides => "slides",
        Grip::Lifted => "lifted",
    };
    parts.set_item("grip", grip)?;
    Ok(parts)
}

fn fused<'py, const K: usize>(
    py: Python<'py>,
    fusion: &Fusion<f64>,
    surface: &DynSurface<f64>,
    wrench: &Wrench<f64>,
    readings: &[ArrayContact<f64>],
) -> PyResult<(Vec<Bound<'py, PyDict>>, f64)> {
    let wrong = || errors::bad("there must be one to four readings");
    let readings: &[ArrayContact<f64>; K] = readings.try_into().map_err(|_| wrong())?;
    let Fused { contacts, disagreement, .. } =
        fusion.estimate(surface, wrench, readings).map_err(errors::shape)?;
    Ok((contacts.iter().map(|contact| parts(py, contact)).collect::<PyResult<Vec<_>>>()?, disagreement))
}

/// The most probable contacts, by a wrench and a tactile array together.
///
/// Parameters
/// ----------
/// surface : Surface
/// wrench : array_like, shape (6,)
///     On the fingertip [N, N·m].
/// covariance : array_like, shape (6, 6)
///     Of the wrench.
/// readings : list of dict
///     One to four places where the array feels pressure: `centroid` [m], `centroid_covariance` [m²], `normal_force` [N],
///     `normal_deviation` [N].
/// friction : float
///     The greatest coefficient to expect.
///
/// Returns
/// -------
/// contacts : list of dict
///     With `point`, `normal`, `force`, `point_covariance`, `force_covariance`, `share_from_wrench` and `grip`.
/// disagreement : float
///     How badly wrench and array fit: χ².
#[pyfunction]
pub(crate) fn fuse<'py>(
    py: Python<'py>,
    surface: &PySurface,
    wrench: &Bound<'py, PyAny>,
    covariance: &Bound<'py, PyAny>,
    readings: Vec<Bound<'py, PyAny>>,
    friction: f64,
) -> PyResult<(Vec<Bound<'py, PyDict>>, f64)> {
    let covariance = numbers::matrix::<6, 6>(covariance, "covariance")?;
    let fusion = Fusion::new(covariance, friction).map_err(errors::shape)?;
    let wrench = self::wrench(wrench)?;
    let readings = readings.iter().map(reading).collect::<PyResult<Vec<_>>>()?;
    let surface = surface.surface();
    match readings.len() {
        1 => fused::<1>(py, &fusion, surface, &wrench, &readings),
        2 => fused::<2>(py, &fusion, surface, &wrench, &readings),
        3 => fused::<3>(py, &fusion, surface, &wrench, &readings),
        _ => fused::<4>(py, &fusion, surface, &wrench, &readings),
    }
}
