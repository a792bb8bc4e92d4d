//! `fingertip.Touch`: what one sample says.

use fingertip::AnyTouch;
use fingertip::friction::FrictionEstimate;
use fingertip::hand::{ContactFriction, FingerState, Hand};
use fingertip::wrench::{RigidTransform, Sensor};
use fingertip_scene::Felt;
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyString;
use serde::{Deserialize, Serialize};

use crate::contact::{PyContact, PyNoContact};
use crate::value::value_class;
use crate::{controller, enums, errors, numbers};

/// What one sample says, as an object of Python holds it: small, since it is copied on its way there. What few scenes tell
/// has memory of its own.
#[derive(Clone, PartialEq, Serialize, Deserialize)]
#[serde(from = "Felt<f64>", into = "Felt<f64>")]
pub(crate) struct Said {
    touch: AnyTouch<f64>,
    more: Option<Box<Felt<f64>>>,
}

impl From<&Felt<f64>> for Said {
    #[inline]
    fn from(felt: &Felt<f64>) -> Self {
        let Felt { touch, spread, tracked, happened, slip_probability, stick_slip, friction, grip_force } =
            felt;
        let more = spread.is_some()
            || tracked.is_some()
            || happened.is_some()
            || slip_probability.is_some()
            || stick_slip.is_some()
            || friction.is_some()
            || grip_force.is_some();
        Self { touch: *touch, more: more.then(|| Box::new(*felt)) }
    }
}

impl From<Felt<f64>> for Said {
    fn from(felt: Felt<f64>) -> Self {
        Self::from(&felt)
    }
}

impl From<Said> for Felt<f64> {
    fn from(said: Said) -> Self {
        match said.more {
            Some(felt) => *felt,
            None => Self { touch: said.touch, ..Self::nothing() },
        }
    }
}

impl Said {
    fn more<V>(&self, of: impl FnOnce(&Felt<f64>) -> Option<V>) -> Option<V> {
        self.more.as_deref().and_then(of)
    }
}

/// What one sample says. Of a stage that the scene has not, `None`.
#[pyclass(name = "Touch", module = "fingertip", frozen, skip_from_py_object)]
pub(crate) struct PyTouch(Said);

impl<F> From<F> for PyTouch
where
    Said: From<F>,
{
    #[inline]
    fn from(felt: F) -> Self {
        Self(felt.into())
    }
}

impl PyTouch {
    fn estimate(
        &self,
        of: impl Fn(fingertip_scene::Learnt<f64>) -> Option<FrictionEstimate<f64>>,
    ) -> Option<(f64, f64)> {
        let estimate = of(self.0.more(|felt| felt.friction)?)?;
        Some((estimate.coefficient, estimate.deviation))
    }
}

#[pymethods]
impl PyTouch {
    /// Load on the fingertip, (fx, fy, fz [N], tx, ty, tz [N·m]), behind zero, payload and filter.
    #[getter]
    fn wrench<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        numbers::array(py, &self.0.touch.wrench.components())
    }

    /// Where it touches, and how.
    #[getter]
    fn contact(&self) -> Option<PyContact> {
        self.0.touch.resolution.contact().copied().map(PyContact)
    }

    /// Why there is no contact, or `None` where there is one.
    #[getter]
    fn no_contact(&self) -> Option<PyNoContact> {
        self.0.touch.resolution.into_result().err().map(PyNoContact)
    }

    /// Where the environment touches [m], or `None`.
    #[getter]
    fn point<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f64>>> {
        Some(numbers::array(py, &self.0.touch.resolution.contact()?.point))
    }

    /// Outward normal there, or `None`.
    #[getter]
    fn normal<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f64>>> {
        Some(numbers::array(py, &self.0.touch.resolution.contact()?.normal))
    }

    /// Normal force [N], positive when pressing, or `None`.
    #[getter]
    fn normal_force(&self) -> Option<f64> {
        self.0.touch.force.map(|force| force.normal)
    }

    /// Tangential force on the fingertip [N], or `None`.
    #[getter]
    fn tangential_force<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f64>>> {
        Some(numbers::array(py, &self.0.touch.force?.tangential.vector()))
    }

    /// Spin torque on the fingertip about the normal [N·m], or `None`.
    #[getter]
    fn spin_torque(&self) -> Option<f64> {
        self.0.touch.force.map(|force| force.spin)
    }

    /// Signed distance to the friction limit [N], positive while the contact holds; needs `[friction]`.
    #[getter]
    fn margin(&self) -> Option<f64> {
        self.0.touch.grip.flatten().map(|margin| margin.newtons)
    }

    /// How much of the friction limit is used: 1 at slip; needs `[friction]`.
    #[getter]
    fn utilisation(&self) -> Option<f64> {
        self.0.touch.grip.flatten().map(|margin| margin.utilisation)
    }

    /// What the slip detector says, a `SlipVerdict`; needs `[slip]`.
    #[getter]
    fn slip(&self, py: Python<'_>) -> PyResult<Option<Py<PyAny>>> {
        self.0.touch.slip.map(|verdict| enums::slip(py, verdict)).transpose()
    }

    /// How sure the contact is; needs `[uncertainty]`.
    #[getter]
    fn spread(&self) -> Option<PySpread> {
        self.0.more(|felt| felt.spread).map(PySpread)
    }

    /// Where the contact is by all samples so far; needs `[tracking]`.
    #[getter]
    fn tracked(&self) -> Option<PyTracked> {
        self.0.more(|felt| felt.tracked).map(PyTracked)
    }

    /// Whether something touches, lets go or strikes; needs `[tracking]` with `least_touch_N`.
    #[getter]
    fn happened(&self) -> Option<PyHappened> {
        self.0.more(|felt| felt.happened).map(PyHappened)
    }

    /// The probability that the contact slips; needs a friction with a deviation.
    #[getter]
    fn slip_probability(&self) -> Option<f64> {
        self.0.more(|felt| felt.slip_probability)
    }

    /// Period of the stick-slip motion that goes on [s], and its spread over the period; needs that detector.
    #[getter]
    fn stick_slip(&self) -> Option<(f64, f64)> {
        self.0.more(|felt| felt.stick_slip).map(|motion| (motion.period, motion.spread))
    }

    /// Static coefficient of friction learnt so far, and its deviation; needs `[estimate]`.
    #[getter]
    fn static_friction(&self) -> Option<(f64, f64)> {
        self.estimate(|learnt| learnt.at_rest)
    }

    /// Kinetic coefficient of friction learnt so far, and its deviation; needs `[estimate]`.
    #[getter]
    fn kinetic_friction(&self) -> Option<(f64, f64)> {
        self.estimate(|learnt| learnt.sliding)
    }

    /// The normal force to command next [N]; needs `[grip]`.
    #[getter]
    fn grip_force(&self) -> Option<f64> {
        self.0.more(|felt| felt.grip_force)
    }

    /// What a finger of a hand says by this touch, in the frame of the hand, as `HandController.command` takes it.
    ///
    /// Parameters
    /// ----------
    /// rotation : array_like, shape (3, 3)
    ///     How the sensor is turned in the hand: its columns are the axes of the sensor there.
    /// origin : array_like, shape (3,)
    ///     Where the origin of the sensor is in the hand [m].
    /// friction : float
    ///     Coefficient of friction, as far as it is known.
    /// arm : float, optional
    ///     Of a soft finger the greatest spin torque over the greatest tangential force [m].
    ///
    /// Returns
    /// -------
    /// dict, None or str
    ///     `None` for a force too small for a contact, "unexplained" for one that no contact gives.
    #[pyo3(signature = (rotation, origin, friction, arm=None))]
    fn finger<'py>(
        &self,
        py: Python<'py>,
        rotation: &Bound<'py, PyAny>,
        origin: &Bound<'py, PyAny>,
        friction: f64,
        arm: Option<f64>,
    ) -> PyResult<Option<Bound<'py, PyAny>>> {
        let mut friction = ContactFriction::point(friction).map_err(errors::hand)?;
        if let Some(arm) = arm {
            friction = friction.with_arm(arm).map_err(errors::hand)?;
        }
        let rotation = numbers::matrix::<3, 3>(rotation, "rotation")?;
        let pose: RigidTransform<f64, Hand, Sensor> =
            RigidTransform::from_matrix(rotation, numbers::three(origin, "origin")?).map_err(errors::hand)?;
        match self.0.touch.finger(&friction).expressed_in(&pose) {
            FingerState::Free => Ok(None),
            FingerState::Touching(sample) => controller::told(py, &sample).map(Some),
            FingerState::Unexplained => Ok(Some(PyString::new(py, controller::UNEXPLAINED).into_any())),
        }
    }

    /// Whether something touches.
    fn __bool__(&self) -> bool {
        self.0.touch.resolution.contact().is_some()
    }

    fn __repr__(&self) -> String {
        match self.contact() {
            Some(contact) => format!("Touch({})", contact.__repr__()),
            None => format!("Touch({})", self.no_contact().map_or_else(String::new, |none| none.__repr__())),
        }
    }
}

/// How sure a contact is: standard deviations to first order.
#[pyclass(name = "Spread", module = "fingertip", frozen, skip_from_py_object)]
pub(crate) struct PySpread(fingertip_scene::Spread<f64>);

#[pymethods]
impl PySpread {
    /// Longer and shorter semi-axis of the ellipse in which the contact lies with the probability of the scene [m].
    #[getter]
    fn semi_axes(&self) -> [f64; 2] {
        self.0.ellipse.semi_axes
    }

    /// Unit vectors along these.
    #[getter]
    fn directions<'py>(&self, py: Python<'py>) -> [Bound<'py, PyArray1<f64>>; 2] {
        self.0.ellipse.directions.map(|direction| numbers::array(py, &direction))
    }

    /// Standard deviation of the normal force [N].
    #[getter]
    fn normal_force(&self) -> f64 {
        self.0.normal_force
    }

    /// Standard deviation of the spin torque [N·m].
    #[getter]
    fn spin_torque(&self) -> f64 {
        self.0.spin_torque
    }
}

/// Where a contact is, by all samples so far.
#[pyclass(name = "Tracked", module = "fingertip", frozen, skip_from_py_object)]
pub(crate) struct PyTracked(pub(crate) fingertip::contact::Tracked<f64>);

#[pymethods]
impl PyTracked {
    /// Where it is [m].
    #[getter]
    fn point<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        numbers::array(py, &self.0.point)
    }

    /// Outward unit normal there.
    #[getter]
    fn normal<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        numbers::array(py, &self.0.normal)
    }

    /// How fast it moves over the fingertip [m/s].
    #[getter]
    fn velocity<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        numbers::array(py, &self.0.velocity)
    }

    /// Two unit vectors in the tangent plane, to which the covariances refer.
    #[getter]
    fn tangents<'py>(&self, py: Python<'py>) -> [Bound<'py, PyArray1<f64>>; 2] {
        self.0.tangents.map(|tangent| numbers::array(py, &tangent))
    }

    /// Covariance of the position along the tangents [m²].
    #[getter]
    fn position_covariance<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        numbers::array2(py, &self.0.position_covariance)
    }

    /// Covariance of the velocity along the tangents [m²/s²].
    #[getter]
    fn velocity_covariance<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        numbers::array2(py, &self.0.velocity_covariance)
    }

    /// Standard deviation of the position in the direction in which it is known worst [m].
    #[getter]
    fn deviation(&self) -> f64 {
        self.0.deviation()
    }

    /// From where the contact was expected to where the sample saw it, along the tangents of the sample before [m].
    #[getter]
    fn innovation<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        numbers::array(py, &self.0.innovation)
    }

    /// How far the sample is from what was expected: χ² of two degrees of freedom.
    #[getter]
    fn surprise(&self) -> f64 {
        self.0.surprise
    }

    /// How the sample fits to those before, a `Continuity`.
    #[getter]
    fn continuity<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        enums::member(py, "Continuity", &self.0.continuity)
    }
}

/// What begins, ends or strikes.
#[pyclass(name = "Happened", module = "fingertip", frozen, skip_from_py_object)]
pub(crate) struct PyHappened(pub(crate) fingertip::contact::Happened<f64>);

#[pymethods]
impl PyHappened {
    /// Whether something touches.
    #[getter]
    fn touching(&self) -> bool {
        self.0.touching
    }

    /// A touch is called, which showed first so long ago [s], or `None`.
    #[getter]
    fn touch(&self) -> Option<f64> {
        self.0.touch
    }

    /// A release is called, which showed first so long ago [s], or `None`.
    #[getter]
    fn release(&self) -> Option<f64> {
        self.0.release
    }

    /// A blow is over, with which the contact began, an `Impact`, or `None`.
    #[getter]
    fn impact(&self) -> Option<PyImpact> {
        self.0.impact.map(PyImpact)
    }
}

/// A blow.
#[pyclass(name = "Impact", module = "fingertip", frozen, skip_from_py_object)]
pub(crate) struct PyImpact(fingertip::contact::Impact<f64>);

#[pymethods]
impl PyImpact {
    /// Greatest magnitude of the force [N].
    #[getter]
    fn peak(&self) -> f64 {
        self.0.peak
    }

    /// The force summed over the time of the blow, on the fingertip [N·s].
    #[getter]
    fn impulse<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        numbers::array(py, &self.0.impulse)
    }

    /// From the first sign of the touch to where the force was least after its peak [s].
    #[getter]
    fn duration(&self) -> f64 {
        self.0.duration
    }
}

value_class!(PyTouch, PySpread, PyTracked, PyHappened, PyImpact);
