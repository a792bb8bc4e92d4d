//! What a pipeline says of a sample.

use fingertip::contact::{Contact, Happened, NoContact, Resolution, Tracked};
use fingertip::friction::{SlipMargin, StickSlip};
use fingertip::wrench::{ContactForce, Real, Wrench};
use fingertip::{AnyTouch, Touch};
use serde::{Deserialize, Serialize};

use crate::estimate::Learnt;
use crate::uncertainty::Spread;

/// What one sample says: of a stage that the scene has not, nothing.
///
/// ```
/// # const BALL: &str = "version = 2\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"sphere\"\nradius_m = 0.013\n";
/// use fingertip::wrench::Wrench;
/// use fingertip_scene::Scene;
/// use nalgebra::Vector3;
///
/// let mut pipeline = Scene::from_text(&format!("{BALL}[friction]\nstatic_coefficient = 0.5\n"))?.pipeline();
/// let push = Wrench::from_force_at(&Vector3::new(0.0, 0.0, 0.013), Vector3::new(0.3, 0.0, -1.0));
/// let felt = pipeline.sense(push, 1e-3);
/// let (contact, force) = (felt.contact().ok_or("a contact")?, felt.force().ok_or("a force")?);
/// assert!((contact.point.z - 0.013).abs() < 1e-12 && (force.normal - 1.0).abs() < 1e-12);
/// assert!((felt.margin().ok_or("friction")?.utilisation - 0.6).abs() < 1e-12);
/// // What the scene does not ask for.
/// assert!(felt.spread.is_none() && felt.tracked.is_none() && felt.grip_force.is_none());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound(serialize = "T: Serialize", deserialize = "T: Deserialize<'de>"))]
pub struct Felt<T: Real> {
    /// Wrench, contact, force, slip margin and slip verdict.
    pub touch: AnyTouch<T>,
    /// How sure the contact is, with `[uncertainty]`; `None` also where it cannot be said, as at grazing.
    pub spread: Option<Spread<T>>,
    /// Where the contact is by all samples so far, with `[tracking]`; `None` where none is followed.
    pub tracked: Option<Tracked<T>>,
    /// Whether something touches, lets go or strikes, where `[tracking]` has a `least_touch_N`.
    pub happened: Option<Happened<T>>,
    /// The probability that the contact slips, where the friction is known with a deviation.
    pub slip_probability: Option<T>,
    /// The stick-slip motion that goes on, where it is looked for.
    pub stick_slip: Option<StickSlip<T>>,
    /// What was learnt of the friction so far, with `[estimate]`.
    pub friction: Option<Learnt<T>>,
    /// The normal force to command next \[N\], with `[grip]`.
    pub grip_force: Option<T>,
}

impl<T: Real> Felt<T> {
    /// What is told before the first sample: that nothing touches.
    pub fn nothing() -> Self {
        let (zero, force) = (Wrench::zero(), T::zero());
        let resolution = Resolution::NoContact(NoContact::BelowThreshold { force });
        Self {
            touch: Touch { wrench: zero, resolution, force: None, grip: None, slip: None, tracked: () },
            spread: None,
            tracked: None,
            happened: None,
            slip_probability: None,
            stick_slip: None,
            friction: None,
            grip_force: None,
        }
    }

    /// Where it touches, and how.
    pub const fn contact(&self) -> Option<&Contact<T>> {
        self.touch.resolution.contact()
    }

    /// The force of the contact, split at its tangent plane.
    pub const fn force(&self) -> Option<&ContactForce<T>> {
        self.touch.force.as_ref()
    }

    /// How far the contact is from slipping, with `[friction]`.
    pub fn margin(&self) -> Option<SlipMargin<T>> {
        self.touch.grip.flatten()
    }
}

/// What a scene tells of a sample beside contact, forces, margin and verdict.
///
/// ```
/// # const BALL: &str = "version = 2\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"sphere\"\nradius_m = 0.013\n";
/// use fingertip_scene::{Scene, Tells};
///
/// assert_eq!(Scene::from_text(BALL)?.tells(), Tells::default());
/// let noise = "[uncertainty]\nforce_noise_N = 0.01\ntorque_noise_Nm = 0.0001\n";
/// let tells = Scene::from_text(&format!("{BALL}[contact]\nmodel = \"soft_finger\"\n{noise}"))?.tells();
/// assert_eq!(tells, Tells { spin_torque: true, spread: true, ..Tells::default() });
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Tells {
    /// A spin torque: the contact model knows one.
    pub spin_torque: bool,
    /// How sure the contact is: there is an `[uncertainty]`.
    pub spread: bool,
    /// Where the contact is over time: there is a `[tracking]`.
    pub tracked: bool,
    /// Touch, release and blow: the `[tracking]` has a `least_touch_N`.
    pub happened: bool,
    /// The probability of slip: the friction has a deviation.
    pub slip_probability: bool,
    /// What was learnt of the friction: there is an `[estimate]`.
    pub friction: bool,
    /// The normal force to command: there is a `[grip]`.
    pub grip_force: bool,
}
