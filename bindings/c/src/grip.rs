//! The least grip that holds a load, as a question of its own.

use fingertip::hand::{Grasp, GripOutcome};

use crate::border::{on, place};
use crate::fault::ft_status;
use crate::finger::{FT_MAX_FINGERS, fingers, ft_finger, load};
use crate::hand::{ft_hand, ft_hand_state};
use crate::load::ft_wrench;

/// The least normal forces that hold a load within friction and limits.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ft_grip {
    /// Whether there are such forces.
    pub state: ft_hand_state,
    /// Zero.
    pub reserved: u32,
    /// Normal force of each finger in N.
    pub normal_force: [f64; FT_MAX_FINGERS],
    /// Tangential force on each fingertip in N.
    pub tangential_force: [[f64; 3]; FT_MAX_FINGERS],
    /// Spin torque on each fingertip in N·m.
    pub spin_torque: [f64; FT_MAX_FINGERS],
    /// The sum of cost times normal force, in N.
    pub cost: f64,
    /// No forces that hold cost less, in N: how far `cost` can be off.
    pub least_cost: f64,
    /// With FT_HAND_CANNOT_HOLD, the velocity by which the object will go, as in ft_hand_order.
    pub velocity: [f64; 3],
    /// Its angular velocity, in rad/s.
    pub turning: [f64; 3],
}

impl ft_grip {
    fn none(state: ft_hand_state) -> Self {
        Self {
            state,
            reserved: 0,
            normal_force: [0.0; FT_MAX_FINGERS],
            tangential_force: [[0.0; 3]; FT_MAX_FINGERS],
            spin_torque: [0.0; FT_MAX_FINGERS],
            cost: 0.0,
            least_cost: 0.0,
            velocity: [0.0; 3],
            turning: [0.0; 3],
        }
    }
}

/// The least grip for the fingers as they are given: without the hand's safety and without what slip has taught, and
/// no command changes. `load` as in ft_hand_command. Allocates nothing. That no forces hold is FT_OK, and a state.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ft_hand_least_grip(
    hand: *mut ft_hand,
    fingers: *const ft_finger,
    count: usize,
    load: *const ft_wrench,
    grip: *mut ft_grip,
) -> ft_status {
    on(hand, |hand| {
        let place = place(grip, "grip")?;
        hand.check(count)?;
        let fingers = self::fingers(fingers, count)?;
        let greatest_ratio = hand.controller.settings().greatest_ratio;
        let Some(load) = self::load(load)?.wrench(&fingers, greatest_ratio) else {
            place.put(ft_grip::none(ft_hand_state::FT_HAND_DOUBTFUL));
            return Ok(());
        };
        let (grasp, _) = Grasp::of_fingers(&fingers);
        place.put(match hand.least.solve(&grasp, &hand.limits, &load) {
            GripOutcome::Held(found) => ft_grip {
                normal_force: found.forces.map(|force| force.normal),
                tangential_force: found.forces.map(|force| force.tangential.vector().into()),
                spin_torque: found.forces.map(|force| force.spin),
                cost: found.cost,
                least_cost: found.least_cost,
                ..ft_grip::none(ft_hand_state::FT_HAND_HOLDING)
            },
            GripOutcome::CannotHold(why) => ft_grip {
                velocity: why.velocity.into(),
                turning: why.turning.into(),
                ..ft_grip::none(ft_hand_state::FT_HAND_CANNOT_HOLD)
            },
            GripOutcome::NotFinite | GripOutcome::Undecided => ft_grip::none(ft_hand_state::FT_HAND_BLIND),
        });
        Ok(())
    })
}
