//! What a sample says beside contact, forces, margin and verdict, where the scene asks for it.

use fingertip_scene::Felt;

use crate::border::{on, place};
use crate::fault::ft_status;
use crate::tip::ft_tip;

/// What the last sample says beside its touch. Each group counts only where its flag is 1, and is zero else.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct ft_beside {
    /// With [uncertainty], where it can be said: ellipse and the deviations.
    pub has_spread: u32,
    /// With [tracking], where a contact is followed.
    pub has_tracked: u32,
    /// With [tracking] that has a least_touch_N.
    pub has_touching: u32,
    /// 1 while something touches, by all samples so far.
    pub touching: u32,
    /// With a friction that is known with a deviation.
    pub has_slip_probability: u32,
    /// While a stick-slip motion goes on that the scene looks for.
    pub has_stick_slip: u32,
    /// With [estimate], behind the first slip.
    pub has_static_friction: u32,
    /// With [estimate], behind the first slide.
    pub has_kinetic_friction: u32,
    /// With [grip].
    pub has_grip_force: u32,
    /// Zero.
    pub reserved: u32,
    /// Semi-axes of the ellipse in which the contact lies, the longer first, in m.
    pub ellipse_semi_axes: [f64; 2],
    /// Unit vectors along them.
    pub ellipse_directions: [[f64; 3]; 2],
    /// Standard deviation of the normal force in N.
    pub normal_force_deviation: f64,
    /// Standard deviation of the spin torque in N·m.
    pub spin_torque_deviation: f64,
    /// Where the contact is by all samples so far, in m.
    pub tracked_point: [f64; 3],
    /// Outward unit normal there.
    pub tracked_normal: [f64; 3],
    /// How fast it moves over the fingertip, in m/s.
    pub tracked_velocity: [f64; 3],
    /// The probability that the contact slips.
    pub slip_probability: f64,
    /// Mean time between the drops of the stick-slip motion, in s.
    pub stick_slip_period: f64,
    /// The static friction coefficient as it was learnt.
    pub static_friction: f64,
    /// Its standard deviation.
    pub static_friction_deviation: f64,
    /// The kinetic friction coefficient as it was learnt.
    pub kinetic_friction: f64,
    /// Its standard deviation.
    pub kinetic_friction_deviation: f64,
    /// The normal force to command next, in N.
    pub grip_force: f64,
}

impl ft_beside {
    fn of(felt: &Felt<f64>) -> Self {
        let mut told = Self::default();
        if let Some(spread) = &felt.spread {
            told.has_spread = 1;
            told.ellipse_semi_axes = spread.ellipse.semi_axes;
            told.ellipse_directions = spread.ellipse.directions.map(Into::into);
            told.normal_force_deviation = spread.normal_force;
            told.spin_torque_deviation = spread.spin_torque;
        }
        if let Some(tracked) = &felt.tracked {
            told.has_tracked = 1;
            told.tracked_point = tracked.point.into();
            told.tracked_normal = tracked.normal.into();
            told.tracked_velocity = tracked.velocity.into();
        }
        if let Some(happened) = &felt.happened {
            (told.has_touching, told.touching) = (1, u32::from(happened.touching));
        }
        if let Some(probability) = felt.slip_probability {
            (told.has_slip_probability, told.slip_probability) = (1, probability);
        }
        if let Some(motion) = &felt.stick_slip {
            (told.has_stick_slip, told.stick_slip_period) = (1, motion.period);
        }
        let learnt = felt.friction;
        if let Some(at_rest) = learnt.and_then(|learnt| learnt.at_rest) {
            told.has_static_friction = 1;
            (told.static_friction, told.static_friction_deviation) = (at_rest.coefficient, at_rest.deviation);
        }
        if let Some(sliding) = learnt.and_then(|learnt| learnt.sliding) {
            told.has_kinetic_friction = 1;
            (told.kinetic_friction, told.kinetic_friction_deviation) =
                (sliding.coefficient, sliding.deviation);
        }
        if let Some(force) = felt.grip_force {
            (told.has_grip_force, told.grip_force) = (1, force);
        }
        told
    }
}

/// What the last sample says beside its touch. Allocates nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ft_beside_last(tip: *mut ft_tip, beside: *mut ft_beside) -> ft_status {
    on(tip, |tip| {
        place(beside, "beside")?.put(ft_beside::of(tip.pipeline.felt()));
        Ok(())
    })
}
