//! `fingertip.HandController`: how firmly each finger shall press.

use fingertip::friction::SlipVerdict;
use fingertip::hand::{
    AnyBelief, FingerSample, FingerState, HandCommand, HandController, HandLoad, HandSettings, HandState,
};
use fingertip::wrench::ContactForce;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::hand::{MOST, contact, wrench};
use crate::limits::{Each, Given, Joints, ROWS};
use crate::{enums, errors, numbers, value};

/// Tells the fingers of a hand how firmly to press, so that they hold with some safety and no more.
///
/// Parameters
/// ----------
/// safety : float, optional
///     Over the least grip that holds.
/// rise, fall : float, optional
///     How fast a command may grow and shrink [N/s].
/// at_slip : float, optional
///     By what a coefficient of friction is multiplied when a finger slips.
/// least_friction, greatest_ratio : float, optional
///     Below what coefficient friction is never taken, and the greatest friction ratio that a contact can have: one that
///     asks for more is not believed.
/// recovery : float, optional
///     With what rate the factor that slips have taught goes back to one [1/s]; 0 for never.
/// least, greatest, cost, joints : optional
///     What each finger can give, as in `Grasp.least_grip`; the least normal force is 0.3 N where none is given. Where joints
///     turn, `set_limits` takes them anew.
/// friction_noise : float, optional
///     Standard deviation of a component of the contact force [N]. With it, each finger learns its friction at slips, and
///     relies on that in place of the coefficient of its contact.
/// friction_scatter, friction_probability : float, optional
///     How break-away scatters on one surface, as a share, and with what probability the friction may be less than what is
///     relied on; where it is learnt.
///
/// Notes
/// -----
/// A copy keeps what was learnt of the friction, and the last command; a pickle begins anew.
#[pyclass(name = "HandController", module = "fingertip", skip_from_py_object)]
#[derive(Clone)]
pub(crate) struct PyController {
    hand: HandController<f64, MOST, ROWS, AnyBelief<f64>>,
    made: Made,
    /// What the last command rests on.
    state: Option<&'static str>,
}

/// Habits, what the fingers can give, and noise, scatter and probability of friction that is learnt.
type Made = (HandSettings<f64>, Given, Option<[f64; 3]>);

impl PyController {
    fn of(made: Made) -> PyResult<Self> {
        let (settings, given, learning) = &made;
        let belief = match learning {
            None => AnyBelief::default(),
            Some([noise, scatter, probability]) => {
                AnyBelief::learning(*noise, *scatter, *probability).map_err(errors::hand)?
            }
        };
        let limits = given.limits()?;
        let hand = HandController::with_beliefs(*settings, limits, [belief; MOST]).map_err(errors::hand)?;
        Ok(Self { hand, made, state: None })
    }
}

value::watcher_class!(PyController);

/// What a finger says that feels a force without a contact.
pub(crate) const UNEXPLAINED: &str = "unexplained";

/// The command: normal forces [N], whether the load is held (`None` where it is not known), and fingers whose contact
/// cannot be believed.
type Command = (Vec<f64>, Option<bool>, Vec<bool>);

/// What a finger says, from the argument of `command`.
fn finger(given: &Bound<'_, PyAny>) -> PyResult<FingerState<f64>> {
    if given.is_none() {
        return Ok(FingerState::Free);
    }
    if given.extract::<&str>().is_ok_and(|word| word == UNEXPLAINED) {
        return Ok(FingerState::Unexplained);
    }
    let given = given
        .cast::<PyDict>()
        .map_err(|_| errors::hand(format!("a finger is a dict, `None` or \"{UNEXPLAINED}\"")))?;
    let part =
        |key: &str| given.get_item(key)?.ok_or_else(|| errors::hand(format!("a finger needs `{key}`")));
    let spin = given.get_item("spin")?.map_or(Ok(0.0), |spin| spin.extract())?;
    let tangential = numbers::three(&part("tangential")?, "tangential")?;
    let slip: u32 = given.get_item("slip")?.map_or(Ok(SlipVerdict::Holding as u32), |slip| slip.extract())?;
    let slip = SlipVerdict::of_number(slip)
        .ok_or_else(|| errors::hand(format!("`slip` is the number of a verdict, 0 to 3, not {slip}")))?;
    Ok(FingerState::Touching(FingerSample {
        contact: contact(given)?,
        force: ContactForce::new(part("normal")?.extract()?, tangential, spin),
        slip,
    }))
}

/// A contact of a finger as `command` takes it.
pub(crate) fn told<'py>(py: Python<'py>, sample: &FingerSample<f64>) -> PyResult<Bound<'py, PyAny>> {
    let FingerSample { contact, force, slip } = sample;
    let told = PyDict::new(py);
    told.set_item("point", numbers::array(py, &contact.place()))?;
    told.set_item("outward", numbers::array(py, &contact.normal()))?;
    told.set_item("friction", contact.friction())?;
    if contact.arm() > 0.0 {
        told.set_item("arm", contact.arm())?;
    }
    told.set_item("normal", force.normal)?;
    told.set_item("tangential", numbers::array(py, &force.tangential.vector()))?;
    told.set_item("spin", force.spin)?;
    told.set_item("slip", enums::slip(py, *slip)?)?;
    Ok(told.into_any())
}

#[pymethods]
impl PyController {
    #[new]
    #[pyo3(
        signature = (*, safety=1.3, rise=200.0, fall=2.0, at_slip=0.8, least_friction=0.1, greatest_ratio=3.0, recovery=0.0, least=Each::All(0.3), greatest=None, cost=Each::All(1.0), joints=None, friction_noise=None, friction_scatter=0.05, friction_probability=0.01),
        text_signature = "(*, safety=1.3, rise=200.0, fall=2.0, at_slip=0.8, least_friction=0.1, greatest_ratio=3.0, recovery=0.0, least=0.3, greatest=None, cost=1.0, joints=None, friction_noise=None, friction_scatter=0.05, friction_probability=0.01)"
    )]
    #[allow(clippy::too_many_arguments, reason = "keywords in Python")]
    fn new(
        safety: f64,
        rise: f64,
        fall: f64,
        at_slip: f64,
        least_friction: f64,
        greatest_ratio: f64,
        recovery: f64,
        least: Each,
        greatest: Option<Each>,
        cost: Each,
        joints: Option<Joints<'_>>,
        friction_noise: Option<f64>,
        friction_scatter: f64,
        friction_probability: f64,
    ) -> PyResult<Self> {
        let settings = HandSettings { safety, rise, fall, at_slip, least_friction, greatest_ratio, recovery };
        let learning = friction_noise.map(|noise| [noise, friction_scatter, friction_probability]);
        let given = Given::read(None, &least, greatest.as_ref(), &cost, joints)?;
        Self::of((settings, given, learning))
    }

    /// Other limits from the next command on, as of joints that have turned: as in `Grasp.least_grip`.
    #[pyo3(
        signature = (*, least=Each::All(0.3), greatest=None, cost=Each::All(1.0), joints=None),
        text_signature = "($self, *, least=0.3, greatest=None, cost=1.0, joints=None)"
    )]
    fn set_limits(
        &mut self,
        least: Each,
        greatest: Option<Each>,
        cost: Each,
        joints: Option<Joints<'_>>,
    ) -> PyResult<()> {
        let given = Given::read(None, &least, greatest.as_ref(), &cost, joints)?;
        self.hand.set_limits(given.limits()?);
        self.made.1 = given;
        Ok(())
    }

    /// Takes what the fingers feel; gives what to command.
    ///
    /// Parameters
    /// ----------
    /// fingers : list of dict, None or "unexplained"
    ///     Of each of up to five fingers `None` without contact, or a contact as of a `Grasp`, with `normal` [N],
    ///     `tangential` [N], and if known `spin` [N·m] and `slip`, a `SlipVerdict`; "unexplained" if it feels a force
    ///     without a contact. As `Touch.finger` gives it.
    /// time_step : float
    ///     Since the command before [s].
    /// load : array_like, shape (6,), optional
    ///     What pulls at the object [N, N·m], where it is known without the fingers; by default what they feel. While one of
    ///     them feels what cannot be, that is not known, and commands stay.
    ///
    /// Returns
    /// -------
    /// normal : list of float
    ///     Normal forces to command [N].
    /// holds : bool or None
    ///     Whether the load can be held; `None` where that is not known. Unless it is `True`, commands are those of before.
    ///     `state` says whether it is held with the factor of safety.
    /// implausible : list of bool
    ///     Fingers that are not believed.
    #[pyo3(signature = (fingers, time_step, *, load=None))]
    fn command(
        &mut self,
        fingers: Vec<Bound<'_, PyAny>>,
        time_step: f64,
        load: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Command> {
        let count = fingers.len();
        if count > MOST {
            return Err(errors::hand(format!("a hand has at most {MOST} fingers, not {count}")));
        }
        let mut states = [FingerState::Free; MOST];
        for (state, given) in states.iter_mut().zip(&fingers) {
            *state = finger(given)?;
        }
        let load = load.map(|load| wrench(load, "load")).transpose()?;
        let load = load.map_or(HandLoad::FromFingers, HandLoad::Known);
        let HandCommand { normal, state, implausible } = self.hand.command(&states, &load, time_step);
        let (holds, state) = match state {
            HandState::Holding => (Some(true), "holding"),
            HandState::WithoutSafety => (Some(true), "without_safety"),
            HandState::CannotHold(_) => (Some(false), "cannot_hold"),
            HandState::Doubtful => (None, "doubtful"),
            HandState::Blind => (None, "blind"),
        };
        self.state = Some(state);
        Ok((normal.into_iter().take(count).collect(), holds, implausible.into_iter().take(count).collect()))
    }

    /// What the last command rests on; `None` before the first. "holding": the least grip with the factor of safety.
    /// "without_safety": the load can be held, but not with that factor, and what holds without it is commanded, squeezed more as
    /// far as limits allow. Commands are those of before with "cannot_hold" (nothing holds), "doubtful" (a finger feels what
    /// cannot be, and no load was given) and "blind" (a number is not finite, no plausible contact is left, or no answer was
    /// found).
    #[getter]
    fn state(&self) -> Option<&'static str> {
        self.state
    }

    /// Coefficient and standard deviation of each of up to five fingers as slips have taught them, or `None`.
    #[getter]
    fn friction(&self) -> Vec<Option<(f64, f64)>> {
        let beliefs = self.hand.beliefs().iter();
        beliefs.map(|belief| belief.estimate().map(|learnt| (learnt.coefficient, learnt.deviation))).collect()
    }

    /// Forgets what was learnt of the friction, as for another object.
    fn forget_friction(&mut self) {
        self.hand.forget_friction();
    }
}
