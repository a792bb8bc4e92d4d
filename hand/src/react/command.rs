//! What is commanded, and what it rests on.

use fingertip_wrench::{Frame, Real};

use crate::{CannotHold, Hand};

/// What the commands rest on.
///
/// ```
/// use fingertip_friction::SlipVerdict;
/// use fingertip_hand::*;
/// use fingertip_wrench::ContactForce;
/// use nalgebra::Vector3;
///
/// let touching = |x: f64| {
///     let contact = GraspContact::<f64, Hand>::soft(Vector3::x() * x, -Vector3::x() * x, 0.6, 3e-3)?;
///     let force = ContactForce::new(3.0, -Vector3::z(), 0.0);
///     Ok::<_, BadContact>(FingerState::Touching(FingerSample { contact, force, slip: SlipVerdict::Holding }))
/// };
/// let mut hand = HandController::new(HandSettings::default(), [FingerLimits::<f64, 2>::none(); 2])?;
/// let mut state = |fingers| hand.command(&fingers, &HandLoad::FromFingers, 1e-3).state;
/// assert_eq!(state([touching(-0.02)?, touching(0.02)?]), HandState::Holding);
/// // One sensor says what cannot be; then nothing is felt at all.
/// assert_eq!(state([touching(-0.02)?, FingerState::Unexplained]), HandState::Doubtful);
/// assert_eq!(state([FingerState::Free, FingerState::Free]), HandState::Blind);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(
        rename_all = "snake_case",
        bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>")
    )
)]
pub enum HandState<T: Real, F: Frame = Hand> {
    /// The least grip for the load, with the factor of safety on friction.
    Holding,
    /// The load can be held, but not with the factor of safety, as when it needs more than the limits or when the contacts do
    /// not face each other well. The least grip without that factor, squeezed more as far as limits allow, up to the factor of
    /// safety: what holds now, while slip is nearer than was asked for.
    WithoutSafety,
    /// No forces within friction and limits hold the load, even without the factor of safety. The commands are those of
    /// before: pressing harder does not help.
    CannotHold(CannotHold<T, F>),
    /// A finger feels what cannot be, so that what it bears is not known, and no load was
    /// [stated](crate::HandLoad::Known): the commands are those of before.
    Doubtful,
    /// A number is not finite, no plausible contact is left, or the program was not decided: the commands are those of
    /// before.
    Blind,
}

/// Normal forces to command.
///
/// ```
/// use fingertip_hand::{FingerLimits, FingerState, HandController, HandLoad, HandSettings, HandState};
///
/// let limits = FingerLimits::<f64, 2>::none().with_least_normal(0.2)?;
/// let mut hand = HandController::new(HandSettings::default(), [limits; 2])?;
/// let fingers: [FingerState<f64>; 2] = [FingerState::Free, FingerState::Unexplained];
/// let command = hand.command(&fingers, &HandLoad::FromFingers, 1e-3);
/// // Nothing drives the fingers: they keep to their least force. The second one is named.
/// assert_eq!(command.normal, [0.2, 0.2]);
/// assert_eq!((command.implausible, command.state), ([false, true], HandState::Blind));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>"))
)]
pub struct HandCommand<T: Real, const N: usize, F: Frame = Hand> {
    /// For each finger \[N\].
    #[cfg_attr(feature = "serde", serde(with = "serde_big_array::BigArray"))]
    pub normal: [T; N],
    /// What they rest on.
    pub state: HandState<T, F>,
    /// The fingers that were not believed in this sample: their contact cannot be, or they feel a force without one.
    #[cfg_attr(feature = "serde", serde(with = "serde_big_array::BigArray"))]
    pub implausible: [bool; N],
}
