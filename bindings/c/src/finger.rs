//! A finger of a hand: where it touches, and what friction allows there.

use fingertip::friction::{SlipMargin, SlipVerdict};
use fingertip::hand::{
    BadContact, ContactFriction, FingerLimits, FingerSample, FingerState, Grasp, GraspContact, Hand, HandLoad,
};
use fingertip::wrench::{ContactForce, RigidTransform, Sensor};
use nalgebra::Matrix3;

use crate::border::{place, read, told};
use crate::fault::{Fault, finite, ft_status};
use crate::hand::ROWS;
use crate::load::ft_wrench;
use crate::message::ft_error;
use crate::touch::{ft_resolution, ft_slip, ft_touch};

/// Most fingers of a hand.
pub const FT_MAX_FINGERS: usize = 6;

/// How the sensor of a finger lies in the frame of the hand: where a point of the sensor frame is there.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ft_pose {
    /// Rows of the rotation: its columns are the axes of the sensor frame in that of the hand.
    pub rotation: [[f64; 3]; 3],
    /// The origin of the sensor frame in that of the hand, in m.
    pub origin: [f64; 3],
}

/// What a finger feels, in the frame of the hand. All zero is a finger that touches nothing.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ft_finger {
    /// 0 if it touches nothing or is to be left out, 1 if it touches. 2 if it feels a force that no contact explains: what it
    /// bears is not known then, and the rest below is not looked at.
    pub touching: u32,
    /// What its slip detector says: a number of ft_slip.
    pub slip: u32,
    /// Where it touches, in m.
    pub point: [f64; 3],
    /// Outward normal of the fingertip there, into the object, of any length.
    pub normal: [f64; 3],
    /// Friction coefficient: better a low quantile than the mean.
    pub friction: f64,
    /// Of a soft finger: greatest spin torque over greatest tangential force, in m; 0 for a point contact.
    pub torque_arm: f64,
    /// Normal force in N, positive when pressing.
    pub normal_force: f64,
    /// Tangential force on the fingertip, in N.
    pub tangential_force: [f64; 3],
    /// Spin torque on the fingertip about the outward normal, in N·m.
    pub spin_torque: f64,
}

/// What a finger can give. All zero is a finger that can give any force.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ft_finger_limits {
    /// Least normal force in N while it touches; 0 for none.
    pub least_normal_force: f64,
    /// Greatest normal force in N; 0 for none.
    pub greatest_normal_force: f64,
    /// What a newton of it costs, next to the other fingers; 0 counts as 1.
    pub cost: f64,
}

/// How far a contact is from slipping.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ft_margin {
    /// Distance to the friction limit in N, positive while the contact holds; zero of a finger that is left out.
    pub newtons: f64,
    /// How much of the limit is used: 0 without tangential load, 1 at slip.
    pub utilisation: f64,
}

/// Fingers on this side of the border.
pub(crate) type Fingers = [FingerState<f64>; FT_MAX_FINGERS];

/// Numbers of `touching`.
const TOUCHING: u32 = 1;
const UNEXPLAINED: u32 = 2;

impl ft_finger {
    const NONE: Self = Self {
        touching: 0,
        slip: 0,
        point: [0.0; 3],
        normal: [0.0; 3],
        friction: 0.0,
        torque_arm: 0.0,
        normal_force: 0.0,
        tangential_force: [0.0; 3],
        spin_torque: 0.0,
    };

    fn state(&self, finger: usize) -> Result<FingerState<f64>, Fault> {
        match self.touching {
            0 => return Ok(FingerState::Free),
            TOUCHING => {}
            UNEXPLAINED => return Ok(FingerState::Unexplained),
            _ => return Err(Fault::Number { name: "touching", requirement: "0, 1 or 2" }),
        }
        let friction = friction(self.friction, self.torque_arm);
        let contact = friction
            .and_then(|friction| GraspContact::new(self.point.into(), self.normal.into(), friction))
            .map_err(|source| Fault::Contact { finger, source })?;
        let force = ContactForce::new(self.normal_force, self.tangential_force.into(), self.spin_torque);
        Ok(FingerState::Touching(FingerSample { contact, force, slip: verdict(self.slip)? }))
    }
}

fn verdict(slip: u32) -> Result<SlipVerdict, Fault> {
    let unknown = Fault::Number { name: "slip", requirement: "that of a verdict, 0 to 3" };
    SlipVerdict::of_number(slip).ok_or(unknown)
}

/// A torque arm of zero is a point contact.
fn friction(coefficient: f64, arm: f64) -> Result<ContactFriction<f64>, BadContact> {
    match arm == 0.0 {
        true => ContactFriction::point(coefficient),
        false => ContactFriction::soft(coefficient, arm),
    }
}

impl ft_finger_limits {
    pub(crate) fn limits(&self, finger: usize) -> Result<FingerLimits<f64, ROWS>, Fault> {
        let bad = |source| Fault::Limit { finger, source };
        let mut limits = FingerLimits::none();
        if self.least_normal_force != 0.0 {
            limits = limits.with_least_normal(self.least_normal_force).map_err(bad)?;
        }
        if self.greatest_normal_force != 0.0 {
            limits = limits.with_greatest_normal(self.greatest_normal_force).map_err(bad)?;
        }
        if self.cost != 0.0 {
            limits = limits.with_cost(self.cost).map_err(bad)?;
        }
        Ok(limits)
    }
}

/// Copies the caller's fingers.
pub(crate) fn fingers(fingers: *const ft_finger, count: usize) -> Result<Fingers, Fault> {
    if !(1..=FT_MAX_FINGERS).contains(&count) {
        return Err(Fault::Fingers { found: count, most: FT_MAX_FINGERS });
    }
    let given: [ft_finger; FT_MAX_FINGERS] =
        crate::border::read_many(fingers, count, "fingers", ft_finger::NONE)?;
    let mut fingers = [FingerState::Free; FT_MAX_FINGERS];
    for (index, (state, finger)) in fingers.iter_mut().zip(&given).enumerate() {
        *state = finger.state(index)?;
    }
    Ok(fingers)
}

/// The load that a caller gives; NULL for what the fingers feel.
pub(crate) fn load(load: *const ft_wrench) -> Result<HandLoad<f64>, Fault> {
    if load.is_null() {
        return Ok(HandLoad::FromFingers);
    }
    Ok(HandLoad::Known(read(load, "load")?.wrench()))
}

/// A finger of a touch, moved into the frame of the hand; the friction coefficient and, for a soft finger, the torque
/// arm in m (0 for a point contact) are the caller's. A force below the threshold makes a finger that touches nothing, any
/// other that is no contact one whose `touching` is 2. `error` may be NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ft_finger_from_touch(
    touch: *const ft_touch,
    hand_from_sensor: *const ft_pose,
    friction: f64,
    torque_arm: f64,
    finger: *mut ft_finger,
    error: *mut ft_error,
) -> ft_status {
    told(error, || {
        let place = place(finger, "finger")?;
        let touched = resolved(touch)?;
        let pose = read(hand_from_sensor, "hand_from_sensor")?;
        let rotation = Matrix3::from_fn(|row, column| pose.rotation[row][column]);
        let pose: RigidTransform<f64, Hand, Sensor> =
            RigidTransform::from_matrix(rotation, pose.origin.into()).map_err(Fault::Pose)?;
        let (friction, torque_arm) = (finite("friction", friction)?, finite("torque_arm", torque_arm)?);
        let touch = match touched {
            Touching::Nothing => {
                place.put(ft_finger::NONE);
                return Ok(());
            }
            Touching::Unexplained => {
                place.put(ft_finger { touching: UNEXPLAINED, ..ft_finger::NONE });
                return Ok(());
            }
            Touching::Here(touch) => touch,
        };
        let contact = self::friction(friction, torque_arm)
            .and_then(|friction| GraspContact::new(touch.point.into(), touch.normal.into(), friction))
            .map_err(Fault::NoFinger)?;
        let force = ContactForce::new(touch.normal_force, touch.tangential_force.into(), touch.spin_torque);
        let sample: FingerSample<f64, Sensor> = FingerSample { contact, force, slip: verdict(touch.slip)? };
        let FingerSample { contact, force, .. } = sample.expressed_in(&pose);
        place.put(ft_finger {
            touching: TOUCHING,
            slip: touch.slip,
            point: contact.place().into(),
            normal: contact.normal().into(),
            friction,
            torque_arm,
            normal_force: force.normal,
            tangential_force: force.tangential.vector().into(),
            spin_torque: force.spin,
        });
        Ok(())
    })
}

/// A touch as a finger takes it.
enum Touching {
    Nothing,
    Here(Touched),
    Unexplained,
}

/// What of a touch makes a finger.
#[derive(Clone, Copy)]
struct Touched {
    slip: u32,
    point: [f64; 3],
    normal: [f64; 3],
    normal_force: f64,
    tangential_force: [f64; 3],
    spin_torque: f64,
}

/// Reads a touch that a caller may have written anything into: its enumerations as the numbers that they are.
fn resolved(touch: *const ft_touch) -> Result<Touching, Fault> {
    if touch.is_null() {
        return Err(Fault::Null("touch"));
    }
    // SAFETY: the caller's structure; fields are taken by their addresses, and as numbers, of which any bits are one.
    unsafe {
        let resolution = (&raw const (*touch).resolution).cast::<u32>().read_unaligned();
        if resolution == ft_resolution::FT_BELOW_THRESHOLD as u32 {
            return Ok(Touching::Nothing);
        }
        if resolution != ft_resolution::FT_CONTACT as u32 {
            return Ok(Touching::Unexplained);
        }
        Ok(Touching::Here(Touched {
            slip: (&raw const (*touch).slip).cast::<u32>().read_unaligned(),
            point: (&raw const (*touch).point).read_unaligned(),
            normal: (&raw const (*touch).normal).read_unaligned(),
            normal_force: (&raw const (*touch).normal_force).read_unaligned(),
            tangential_force: (&raw const (*touch).tangential_force).read_unaligned(),
            spin_torque: (&raw const (*touch).spin_torque).read_unaligned(),
        }))
    }
}

/// What the contacts of the fingers feel together: what the object loads them with, its weight among it, if none of them is
/// wrong. About the origin of the frame of the hand. `error` may be NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ft_object_wrench(
    fingers: *const ft_finger,
    count: usize,
    wrench: *mut ft_wrench,
    error: *mut ft_error,
) -> ft_status {
    told(error, || {
        let place = place(wrench, "wrench")?;
        let fingers = self::fingers(fingers, count)?;
        let (grasp, forces) = Grasp::of_fingers(&fingers);
        let load = grasp.wrench(&forces);
        place.put(ft_wrench { force: load.force().into(), torque: load.torque().into() });
        Ok(())
    })
}

/// How far each finger is from slipping: `margins` has room for `count` of them. `error` may be NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ft_slip_margins(
    fingers: *const ft_finger,
    count: usize,
    margins: *mut ft_margin,
    error: *mut ft_error,
) -> ft_status {
    told(error, || {
        place(margins, "margins")?;
        let fingers = self::fingers(fingers, count)?;
        let (grasp, forces) = Grasp::of_fingers(&fingers);
        let none = SlipMargin { newtons: 0.0, utilisation: 0.0 };
        let told = grasp.slip_margins(&forces).map(|margin| {
            let margin = margin.unwrap_or(none);
            ft_margin { newtons: margin.newtons, utilisation: margin.utilisation }
        });
        crate::border::write_many(margins, told.get(..count).unwrap_or_default());
        Ok(())
    })
}

/// A verdict is a number of 32 bits, as `resolved` reads it.
const _: () = assert!(size_of::<ft_slip>() == 4 && size_of::<ft_resolution>() == 4);
