//! A finger of a hand: where it touches, and what friction allows there.

use fingertip::friction::{SlipMargin, SlipVerdict};
use fingertip::hand::{FingerLimits, FingerSample, Grasp, GraspContact, Hand};
use fingertip::wrench::{ContactForce, RigidTransform, Sensor, Wrench};
use nalgebra::{Matrix3, Vector3};

use crate::border::{place, read, told};
use crate::fault::{Fault, finite, ft_status};
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
    /// 1 if it touches, 0 if it is to be left out.
    pub touching: u32,
    /// What its slip detector says: a number of ft_slip; more than 3 counts as FT_NOT_PRESSING.
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
pub(crate) type Fingers = [Option<FingerSample<f64, Hand>>; FT_MAX_FINGERS];

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

    fn sample(&self, finger: usize) -> Result<Option<FingerSample<f64, Hand>>, Fault> {
        if self.touching == 0 {
            return Ok(None);
        }
        let (point, normal) = (self.point.into(), self.normal.into());
        let contact = match self.torque_arm == 0.0 {
            true => GraspContact::point(point, normal, self.friction),
            false => GraspContact::soft(point, normal, self.friction, self.torque_arm),
        };
        let contact = contact.map_err(|source| Fault::Contact { finger, source })?;
        let slip = match self.slip {
            1 => SlipVerdict::Holding,
            2 => SlipVerdict::Warning,
            3 => SlipVerdict::Slipping,
            _ => SlipVerdict::NotPressing,
        };
        let force = ContactForce::new(self.normal_force, self.tangential_force.into(), self.spin_torque);
        Ok(Some(FingerSample { contact, force, slip }))
    }
}

impl ft_finger_limits {
    pub(crate) fn limits(&self, finger: usize) -> Result<FingerLimits<f64, 2>, Fault> {
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
    let mut samples = [None; FT_MAX_FINGERS];
    for (index, (sample, finger)) in samples.iter_mut().zip(&given).enumerate() {
        *sample = finger.sample(index)?;
    }
    Ok(samples)
}

/// The grasp of fingers, and the forces that they feel.
pub(crate) fn grasp(fingers: &Fingers) -> (Grasp<f64, FT_MAX_FINGERS>, [ContactForce<f64>; FT_MAX_FINGERS]) {
    let contacts = fingers.map(|finger| finger.map(|finger| finger.contact));
    let forces = fingers.map(|finger| finger.map_or_else(ContactForce::zero, |finger| finger.force));
    (Grasp::new(contacts), forces)
}

/// The load that a caller gives, or what the fingers feel together.
pub(crate) fn load(load: *const ft_wrench, fingers: &Fingers) -> Result<Wrench<f64, Hand>, Fault> {
    if load.is_null() {
        let (grasp, forces) = grasp(fingers);
        return Ok(grasp.wrench(&forces));
    }
    let load = read(load, "load")?;
    Ok(Wrench::on_fingertip(load.force.into(), load.torque.into()))
}

/// A finger of a touch, moved into the frame of the hand; the friction coefficient and, for a soft finger, the torque
/// arm in m (0 for a point contact) are the caller's. A touch that is no contact makes a finger that touches nothing.
/// `error` may be NULL.
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
        let Some(touch) = touched else {
            place.put(ft_finger::NONE);
            return Ok(());
        };
        let turned = |vector: [f64; 3]| pose.rotate(&Vector3::from(vector)).into();
        place.put(ft_finger {
            touching: 1,
            slip: touch.slip,
            point: pose.transform_point(&touch.point.into()).into(),
            normal: turned(touch.normal),
            friction,
            torque_arm,
            normal_force: touch.normal_force,
            tangential_force: turned(touch.tangential_force),
            spin_torque: touch.spin_torque,
        });
        Ok(())
    })
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
fn resolved(touch: *const ft_touch) -> Result<Option<Touched>, Fault> {
    if touch.is_null() {
        return Err(Fault::Null("touch"));
    }
    // SAFETY: the caller's structure; fields are taken by their addresses, and as numbers, of which any bits are one.
    unsafe {
        let resolution = (&raw const (*touch).resolution).cast::<u32>().read_unaligned();
        if resolution != ft_resolution::FT_CONTACT as u32 {
            return Ok(None);
        }
        Ok(Some(Touched {
            slip: (&raw const (*touch).slip).cast::<u32>().read_unaligned(),
            point: (&raw const (*touch).point).read_unaligned(),
            normal: (&raw const (*touch).normal).read_unaligned(),
            normal_force: (&raw const (*touch).normal_force).read_unaligned(),
            tangential_force: (&raw const (*touch).tangential_force).read_unaligned(),
            spin_torque: (&raw const (*touch).spin_torque).read_unaligned(),
        }))
    }
}

/// What the fingers feel together: what the object loads them with, its weight among it. About the origin of the frame
/// of the hand. `error` may be NULL.
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
        let (grasp, forces) = grasp(&fingers);
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
        let (grasp, forces) = grasp(&fingers);
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
