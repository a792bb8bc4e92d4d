//! A hand behind a handle: normal forces to command.

use core::ffi::c_char;

use fingertip::hand::{
    AnyBelief, FingerLimits, HandController, HandSettings, HandState, LeastGrip, ObjectWeight,
};

use crate::border::{self, Keeps, hand_out, on, place, read, read_many, told};
use crate::fault::{Fault, ft_status};
use crate::finger::{FT_MAX_FINGERS, fingers, ft_finger, ft_finger_limits, load};
use crate::joints::FT_MAX_JOINTS;
use crate::load::ft_wrench;
use crate::message::ft_error;

/// Half-spaces that limit a finger: of its least and its greatest normal force, and two of each joint.
pub(crate) const ROWS: usize = 2 + 2 * FT_MAX_JOINTS;

/// A hand: what it commanded last, what slip has taught it, and what it has learnt of the object. Made by ft_hand_create,
/// freed by ft_hand_free.
#[derive(Debug)]
pub struct ft_hand {
    pub(crate) controller: HandController<f64, FT_MAX_FINGERS, ROWS, AnyBelief<f64>>,
    pub(crate) limits: [FingerLimits<f64, ROWS>; FT_MAX_FINGERS],
    /// For the question of the least grip alone.
    pub(crate) least: LeastGrip<f64, FT_MAX_FINGERS, ROWS>,
    /// Of what is held.
    pub(crate) weight: ObjectWeight<f64>,
    pub(crate) count: usize,
    error: ft_error,
}

impl Keeps for ft_hand {
    fn kept(&mut self) -> &mut ft_error {
        &mut self.error
    }
}

impl ft_hand {
    /// That as many fingers are given as the hand has.
    pub(crate) fn check(&self, count: usize) -> Result<(), Fault> {
        if count == self.count {
            return Ok(());
        }
        Err(Fault::Size { what: "fingers", found: count, needed: self.count })
    }
}

/// Limits and habits of a hand. ft_hand_settings_defaults has values to begin with.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ft_hand_settings {
    /// Factor of safety on friction, at least 1.
    pub safety: f64,
    /// How fast a normal force may rise, in N/s.
    pub rise: f64,
    /// How fast it may fall, in N/s.
    pub fall: f64,
    /// By what a finger's friction coefficient is multiplied when it slips, between 0 and 1.
    pub at_slip: f64,
    /// Below what friction coefficient it is never taken, however often it slips.
    pub least_friction: f64,
    /// A contact that asks for a greater friction ratio is implausible, and its force is not used.
    pub greatest_ratio: f64,
    /// With what rate the factor that slips have taught goes back to one, in 1/s; 0 for never.
    pub recovery: f64,
    /// Standard deviation of a component of the contact force, in N, with which each finger learns its friction at slips;
    /// 0 for none that learns. What is learnt is relied on in place of the coefficient of the finger.
    pub friction_noise: f64,
    /// How break-away scatters on one surface, as a share; where friction is learnt.
    pub friction_scatter: f64,
    /// With what probability the friction may be less than what is relied on; where it is learnt.
    pub friction_probability: f64,
}

impl ft_hand_settings {
    fn habits(&self) -> HandSettings<f64> {
        let Self { safety, rise, fall, at_slip, least_friction, greatest_ratio, recovery, .. } = *self;
        HandSettings { safety, rise, fall, at_slip, least_friction, greatest_ratio, recovery }
    }

    fn belief(&self) -> Result<AnyBelief<f64>, Fault> {
        if self.friction_noise == 0.0 {
            return Ok(AnyBelief::default());
        }
        Ok(AnyBelief::learning(self.friction_noise, self.friction_scatter, self.friction_probability)?)
    }
}

/// What commands rest on.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ft_hand_state {
    /// The least grip for the load, with the factor of safety.
    FT_HAND_HOLDING = 0,
    /// No forces within friction and limits hold the load, even without the factor of safety. The commands are those of before.
    FT_HAND_CANNOT_HOLD = 1,
    /// A number is not finite, no plausible contact is left, or no answer was found. The commands are those of before.
    FT_HAND_BLIND = 2,
    /// A finger feels what cannot be, so that what the others are to bear is not known, and no load was given. The commands
    /// are those of before.
    FT_HAND_DOUBTFUL = 3,
    /// The load can be held, but not with the factor of safety: the least grip without it, squeezed more as far as limits allow.
    FT_HAND_WITHOUT_SAFETY = 4,
}

/// Normal forces to command.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ft_hand_order {
    /// What they rest on.
    pub state: ft_hand_state,
    /// Bit i is 1 if finger i was not believed.
    pub implausible: u32,
    /// For each finger, in N; zero of fingers that the hand has not.
    pub normal_force: [f64; FT_MAX_FINGERS],
    /// Friction coefficient of each finger as slips have taught it; zero before the first slip, and where none is learnt.
    pub friction: [f64; FT_MAX_FINGERS],
    /// Its standard deviation.
    pub friction_deviation: [f64; FT_MAX_FINGERS],
    /// With FT_HAND_CANNOT_HOLD, the motion by which the object will go, of which the direction alone has a meaning: its
    /// velocity at the origin of the hand's frame, in m/s.
    pub velocity: [f64; 3],
    /// Its angular velocity, in rad/s.
    pub turning: [f64; 3],
}

/// A safety of 1.3, 200 N/s up and 2 N/s down, friction taken as 0.8 times as large at each slip and never below 0.1,
/// without recovery, and no contact beyond a friction ratio of 3. No friction is learnt; where it is, with a scatter of 0.05
/// and so that one slip in a hundred has less.
#[unsafe(no_mangle)]
pub extern "C" fn ft_hand_settings_defaults() -> ft_hand_settings {
    let HandSettings { safety, rise, fall, at_slip, least_friction, greatest_ratio, recovery } =
        HandSettings::default();
    ft_hand_settings {
        safety,
        rise,
        fall,
        at_slip,
        least_friction,
        greatest_ratio,
        recovery,
        friction_noise: 0.0,
        friction_scatter: AnyBelief::<f64>::SCATTER,
        friction_probability: AnyBelief::<f64>::PROBABILITY,
    }
}

/// Makes a hand of 1 to FT_MAX_FINGERS fingers; it begins with the least normal forces of their limits. `limits` has
/// `count` of them, or is NULL for none; `error` may be NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ft_hand_create(
    settings: *const ft_hand_settings,
    limits: *const ft_finger_limits,
    count: usize,
    hand: *mut *mut ft_hand,
    error: *mut ft_error,
) -> ft_status {
    told(error, || {
        let (place, given) = (place(hand, "hand")?, read(settings, "settings")?);
        if !(1..=FT_MAX_FINGERS).contains(&count) {
            return Err(Fault::Fingers { found: count, most: FT_MAX_FINGERS });
        }
        let mut each = [FingerLimits::none(); FT_MAX_FINGERS];
        if !limits.is_null() {
            let none = ft_finger_limits { least_normal_force: 0.0, greatest_normal_force: 0.0, cost: 0.0 };
            let limits: [ft_finger_limits; FT_MAX_FINGERS] = read_many(limits, count, "limits", none)?;
            for (index, (to, from)) in each.iter_mut().zip(&limits).enumerate() {
                *to = from.limits(index)?;
            }
        }
        let beliefs = [given.belief()?; FT_MAX_FINGERS];
        let controller = HandController::with_beliefs(given.habits(), each, beliefs)?;
        let least = LeastGrip::new();
        let weight = ObjectWeight::new();
        hand_out(place, ft_hand { controller, limits: each, least, weight, count, error: ft_error::none() });
        Ok(())
    })
}

/// Frees a hand and sets the variable that held it to NULL: to do so twice does no harm. NULL is left.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ft_hand_free(hand: *mut *mut ft_hand) {
    border::free(hand);
}

/// Why the last call of this hand failed that did; as ft_tip_message.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ft_hand_message(hand: *const ft_hand) -> *const c_char {
    if hand.is_null() {
        return crate::ft_status_text(1);
    }
    // SAFETY: a handle that nobody else uses now. No reference to the whole is made: see `ft_tip_message`.
    unsafe { (&raw const (*hand).error.message).cast() }
}

/// The normal forces to command for the next sample, which rise at once when a finger slips. `load` is what the object
/// loads the fingers with, where that is known without them, as from its mass or a sensor in the wrist: a finger that feels
/// what cannot be is left out then. NULL for what the fingers feel: while one feels what cannot be, commands stay. `time_step` is the time since the call before,
/// in s. Allocates nothing. That no forces hold is FT_OK, and a state of the order.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ft_hand_command(
    hand: *mut ft_hand,
    fingers: *const ft_finger,
    count: usize,
    load: *const ft_wrench,
    time_step: f64,
    order: *mut ft_hand_order,
) -> ft_status {
    on(hand, |hand| {
        let place = place(order, "order")?;
        hand.check(count)?;
        let fingers = self::fingers(fingers, count)?;
        let load = self::load(load)?;
        let command = hand.controller.command(&fingers, &load, time_step);
        let mut told = ft_hand_order {
            state: ft_hand_state::FT_HAND_HOLDING,
            implausible: 0,
            normal_force: [0.0; FT_MAX_FINGERS],
            friction: [0.0; FT_MAX_FINGERS],
            friction_deviation: [0.0; FT_MAX_FINGERS],
            velocity: [0.0; 3],
            turning: [0.0; 3],
        };
        for (to, from) in told.normal_force.iter_mut().zip(&command.normal).take(count) {
            *to = *from;
        }
        let learnt = told.friction.iter_mut().zip(&mut told.friction_deviation);
        for ((friction, deviation), belief) in learnt.zip(hand.controller.beliefs()).take(count) {
            if let Some(estimate) = belief.estimate() {
                (*friction, *deviation) = (estimate.coefficient, estimate.deviation);
            }
        }
        for (index, implausible) in command.implausible.iter().enumerate() {
            told.implausible |= u32::from(*implausible) << index;
        }
        match &command.state {
            HandState::Holding => {}
            HandState::WithoutSafety => told.state = ft_hand_state::FT_HAND_WITHOUT_SAFETY,
            HandState::CannotHold(why) => {
                told.state = ft_hand_state::FT_HAND_CANNOT_HOLD;
                (told.velocity, told.turning) = (why.velocity.into(), why.turning.into());
            }
            HandState::Doubtful => told.state = ft_hand_state::FT_HAND_DOUBTFUL,
            HandState::Blind => told.state = ft_hand_state::FT_HAND_BLIND,
        }
        place.put(told);
        Ok(())
    })
}

/// Forgets what slip has taught of the friction and what the object weighs, as when another one is grasped. Commands and
/// limits stay.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ft_hand_forget(hand: *mut ft_hand) -> ft_status {
    on(hand, |hand| {
        hand.controller.forget_friction();
        hand.least.forget();
        hand.weight = ObjectWeight::new();
        Ok(())
    })
}
