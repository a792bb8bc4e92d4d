//! Limits of the joints of a finger.

use nalgebra::{SMatrix, Vector6};

use crate::border::{on, read_many};
use crate::fault::{Fault, ft_status};
use crate::hand::ft_hand;

/// Most joints of a finger.
pub const FT_MAX_JOINTS: usize = 6;

/// Says what the joints of a finger can give from now on, as in each sample where they turn; `count` 0 for no limits.
/// `jacobian` has six numbers of each joint, one joint behind the other: the motion of the fingertip as a rigid body for a
/// unit rate of the joint, its velocity at the origin of the hand's frame in m/s and its angular velocity in rad/s. `greatest`
/// has the torque of each in N·m either way, or the force of a linear drive in N. Commands and the least grip keep to it.
/// Allocates nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ft_hand_set_joints(
    hand: *mut ft_hand,
    finger: usize,
    jacobian: *const f64,
    greatest: *const f64,
    count: usize,
) -> ft_status {
    on(hand, |hand| {
        if count > FT_MAX_JOINTS {
            return Err(Fault::Size { what: "joints", found: count, needed: FT_MAX_JOINTS });
        }
        if finger >= hand.count {
            return Err(Fault::Number { name: "finger", requirement: "less than the number of fingers" });
        }
        let (mut columns, mut torques) = ([[0.0; 6]; FT_MAX_JOINTS], [0.0; FT_MAX_JOINTS]);
        if count > 0 {
            torques = read_many(greatest, count, "greatest", 0.0)?;
            columns = read_many(jacobian.cast::<[f64; 6]>(), count, "jacobian", [0.0; 6])?;
        }
        let Some(place) = hand.limits.get_mut(finger) else { return Ok(()) };
        let bad = |source| Fault::Limit { finger, source };
        let mut limits = place.with_joint_torques(&SMatrix::<f64, 6, 0>::zeros(), &[]).map_err(bad)?;
        for (column, torque) in columns.iter().zip(torques).take(count) {
            limits = limits.with_joint(&Vector6::from(*column), torque).map_err(bad)?;
        }
        *place = limits;
        hand.controller.set_limits(hand.limits);
        Ok(())
    })
}
