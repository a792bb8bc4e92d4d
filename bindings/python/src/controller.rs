//! `fingertip.HandController`: how firmly each finger shall press.

use fingertip::friction::SlipVerdict;
use fingertip::hand::{FingerSample, HandCommand, HandController, HandSettings, HandState};
use fingertip::wrench::ContactForce;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::hand::{MOST, contact, limits, wrench};
use crate::{errors, numbers, value};

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
/// least, greatest : float, optional
///     Normal force of each finger [N].
///
/// Notes
/// -----
/// A copy keeps what was learnt of the friction, and the last command; a pickle begins anew.
#[pyclass(name = "HandController", module = "fingertip", skip_from_py_object)]
#[derive(Clone)]
pub(crate) struct PyController {
    hand: HandController<f64, MOST, 2>,
    made: (HandSettings<f64>, f64, Option<f64>),
}

impl PyController {
    fn of(made: (HandSettings<f64>, f64, Option<f64>)) -> PyResult<Self> {
        let (settings, least, greatest) = made;
        let hand = HandController::new(settings, limits(least, greatest)?).map_err(errors::hand)?;
        Ok(Self { hand, made })
    }
}

value::watcher_class!(PyController);

/// The command: normal forces [N], whether the load is held (`None` where it is not known), and fingers whose contact
/// cannot be believed.
type Command = (Vec<f64>, Option<bool>, Vec<bool>);

/// What a finger feels, from the argument of `command`.
fn finger(given: &Bound<'_, PyDict>) -> PyResult<FingerSample<f64>> {
    let part =
        |key: &str| given.get_item(key)?.ok_or_else(|| errors::hand(format!("a finger needs `{key}`")));
    let spin = given.get_item("spin")?.map_or(Ok(0.0), |spin| spin.extract())?;
    let tangential = numbers::three(&part("tangential")?, "tangential")?;
    let slips: u8 = given.get_item("slip")?.map_or(Ok(SlipVerdict::Holding as u8), |slip| slip.extract())?;
    let slip = match slips {
        0 => SlipVerdict::NotPressing,
        1 => SlipVerdict::Holding,
        2 => SlipVerdict::Warning,
        _ => SlipVerdict::Slipping,
    };
    Ok(FingerSample {
        contact: contact(given)?,
        force: ContactForce::new(part("normal")?.extract()?, tangential, spin),
        slip,
    })
}

#[pymethods]
impl PyController {
    #[new]
    #[pyo3(signature = (*, safety=1.3, rise=200.0, fall=2.0, at_slip=0.8, least_friction=0.1, greatest_ratio=3.0, least=0.3, greatest=None))]
    #[allow(clippy::too_many_arguments, reason = "keywords in Python")]
    fn new(
        safety: f64,
        rise: f64,
        fall: f64,
        at_slip: f64,
        least_friction: f64,
        greatest_ratio: f64,
        least: f64,
        greatest: Option<f64>,
    ) -> PyResult<Self> {
        let settings = HandSettings { safety, rise, fall, at_slip, least_friction, greatest_ratio };
        Self::of((settings, least, greatest))
    }

    /// Takes what the fingers feel; gives what to command.
    ///
    /// Parameters
    /// ----------
    /// fingers : list of dict or None
    ///     Of each of up to five fingers `None` without contact, or a contact as of a `Grasp`, with `normal` [N],
    ///     `tangential` [N], and if known `spin` [N·m] and `slip`, a `SlipVerdict`.
    /// load : array_like, shape (6,)
    ///     What pulls at the object [N, N·m].
    /// time_step : float
    ///     Since the command before [s].
    ///
    /// Returns
    /// -------
    /// normal : list of float
    ///     Normal forces to command [N].
    /// holds : bool or None
    ///     Whether the load can be held; `None` where that is not known.
    /// implausible : list of bool
    ///     Fingers whose friction cannot be believed.
    fn command(
        &mut self,
        fingers: Vec<Option<Bound<'_, PyDict>>>,
        load: &Bound<'_, PyAny>,
        time_step: f64,
    ) -> PyResult<Command> {
        let count = fingers.len();
        if count > MOST {
            return Err(errors::hand(format!("a hand has at most {MOST} fingers, not {count}")));
        }
        let mut samples = [None; MOST];
        for (sample, given) in samples.iter_mut().zip(&fingers) {
            *sample = given.as_ref().map(finger).transpose()?;
        }
        let HandCommand { normal, state, implausible } =
            self.hand.command(&samples, &wrench(load, "load")?, time_step);
        let holds = match state {
            HandState::Holding => Some(true),
            HandState::CannotHold(_) => Some(false),
            HandState::Blind => None,
        };
        Ok((normal.into_iter().take(count).collect(), holds, implausible.into_iter().take(count).collect()))
    }

    /// Forgets what was learnt of the friction, as for another object.
    fn forget_friction(&mut self) {
        self.hand.forget_friction();
    }
}
