//! What a sample says beside contact, forces, margin and verdict, where the scene asks for it.

use fingertip::contact::{Continuity, Happened, Tracked};
use fingertip_scene::Felt;

use crate::border::{on, place};
use crate::fault::ft_status;
use crate::tip::ft_tip;

/// How a sample fits to the track before it.
#[repr(u32)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ft_continuity {
    /// Another contact than before, or the first: what was known of the old one is forgotten.
    #[default]
    FT_TRACK_NEW = 0,
    /// The same contact, a little farther.
    FT_TRACK_FOLLOWED = 1,
    /// Too far away for the same contact: a sample gone wrong, or, if the next one is there too, a new contact.
    FT_TRACK_DOUBTED = 2,
    /// No contact was seen, but the track still knows where it would be.
    FT_TRACK_BRIDGED = 3,
}

impl ft_continuity {
    const fn of(continuity: Continuity) -> Self {
        match continuity {
            Continuity::New => Self::FT_TRACK_NEW,
            Continuity::Followed => Self::FT_TRACK_FOLLOWED,
            Continuity::Doubted => Self::FT_TRACK_DOUBTED,
            Continuity::Bridged => Self::FT_TRACK_BRIDGED,
        }
    }
}

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
    /// At the sample at which a touch is called.
    pub has_touch: u32,
    /// At the sample at which a release is called.
    pub has_release: u32,
    /// At the sample at which a blow is over.
    pub has_impact: u32,
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
    /// How the sample fits to the track.
    pub continuity: ft_continuity,
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
    /// Two unit vectors in the tangent plane there, to which the next four refer.
    pub tracked_tangents: [[f64; 3]; 2],
    /// Covariance of the position in m².
    pub tracked_position_covariance: [[f64; 2]; 2],
    /// Covariance of the velocity in m²/s².
    pub tracked_velocity_covariance: [[f64; 2]; 2],
    /// From where the contact was expected to where the sample saw it, along the tangents of the sample before, in m.
    pub tracked_innovation: [f64; 2],
    /// The same squared over its variance: chi squared of two degrees of freedom while the contact moves as the scene says.
    pub tracked_surprise: f64,
    /// How long ago the touch that is called showed first, in s.
    pub touch_age: f64,
    /// How long ago the release that is called showed first, in s.
    pub release_age: f64,
    /// Greatest force of the blow, in N.
    pub impact_peak: f64,
    /// Its force summed over its time, on the fingertip, in N·s.
    pub impact_impulse: [f64; 3],
    /// From its first sign to where the force was least behind its peak, in s.
    pub impact_duration: f64,
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
            told.follow(tracked);
        }
        if let Some(happened) = &felt.happened {
            told.call(happened);
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

    fn follow(&mut self, tracked: &Tracked<f64>) {
        self.has_tracked = 1;
        self.continuity = ft_continuity::of(tracked.continuity);
        self.tracked_point = tracked.point.into();
        self.tracked_normal = tracked.normal.into();
        self.tracked_velocity = tracked.velocity.into();
        self.tracked_tangents = tracked.tangents.map(Into::into);
        // Symmetric, so that rows and columns are the same.
        self.tracked_position_covariance = tracked.position_covariance.into();
        self.tracked_velocity_covariance = tracked.velocity_covariance.into();
        self.tracked_innovation = tracked.innovation.into();
        self.tracked_surprise = tracked.surprise;
    }

    fn call(&mut self, happened: &Happened<f64>) {
        (self.has_touching, self.touching) = (1, u32::from(happened.touching));
        if let Some(age) = happened.touch {
            (self.has_touch, self.touch_age) = (1, age);
        }
        if let Some(age) = happened.release {
            (self.has_release, self.release_age) = (1, age);
        }
        if let Some(impact) = &happened.impact {
            (self.has_impact, self.impact_peak, self.impact_duration) = (1, impact.peak, impact.duration);
            self.impact_impulse = impact.impulse.into();
        }
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
