//! One fingertip of the simulated hand, with its drive.

use fingertip_hand::Hand;
use fingertip_surfaces::SignedDistance;
use fingertip_wrench::{ContactForce, RigidTransform, Sensor, Wrench};
use nalgebra::{Matrix3, Rotation3, UnitVector3, Vector3};

use super::body::RigidBody;
use super::script::HandMotion;
use super::skin::{Approach, Skin, SkinForce, SkinSettings};
use crate::error::SimulationError;
use crate::fingertip::Options;
use crate::sensor::SimulatedSensor;
use crate::timeline::TrueContact;

/// Where a fingertip is while it is open, and so which way it closes: along the beam of its sensor, the first axis of
/// its frame.
///
/// ```
/// use fingertip_simulation::hand::FingerPlace;
/// use nalgebra::Vector3;
///
/// let [left, right] = FingerPlace::ring(0.05);
/// assert!((left.tip().origin() - Vector3::x() * 0.05).norm() < 1e-15);
/// assert!((right.closing() - Vector3::x()).norm() < 1e-15);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FingerPlace {
    tip: RigidTransform<f64, Hand, Sensor>,
}

impl FingerPlace {
    /// With the centre of its sphere at a place of the hand \[m\], closing in a direction.
    ///
    /// # Errors
    /// [`SimulationError::BadParameter`] for a place that is not finite, or no direction.
    pub fn new(centre: Vector3<f64>, closing: Vector3<f64>) -> Result<Self, SimulationError> {
        let bad = |requirement| SimulationError::BadParameter { parameter: "place of a finger", requirement };
        let axis = UnitVector3::try_new(closing, f64::MIN_POSITIVE)
            .filter(|axis| axis.iter().all(|x| x.is_finite()))
            .ok_or_else(|| bad("with a direction in which it closes"))?;
        if !centre.iter().all(|x| x.is_finite()) {
            return Err(bad("finite"));
        }
        let across = if axis.z.abs() < 0.9 { Vector3::z() } else { Vector3::y() };
        let second = across.cross(&axis).normalize();
        let third = axis.cross(&second);
        let rotation = Matrix3::from_columns(&[axis.into_inner(), second, third]);
        let tip = RigidTransform::from_parts(Rotation3::from_matrix_unchecked(rotation), centre);
        Ok(Self { tip })
    }

    /// Fingers evenly around the third axis of the hand, at a distance from it \[m\], closing towards it.
    #[must_use]
    pub fn ring<const K: usize>(distance: f64) -> [Self; K] {
        core::array::from_fn(|index| {
            #[allow(clippy::cast_precision_loss, reason = "few fingers")]
            let angle = core::f64::consts::TAU * index as f64 / K as f64;
            let outward = Vector3::new(angle.cos(), angle.sin(), 0.0);
            let rotation = Matrix3::from_columns(&[-outward, Vector3::z().cross(&-outward), Vector3::z()]);
            let tip =
                RigidTransform::from_parts(Rotation3::from_matrix_unchecked(rotation), outward * distance);
            Self { tip }
        })
    }

    /// Its pose while it is open.
    #[must_use]
    pub const fn tip(&self) -> RigidTransform<f64, Hand, Sensor> {
        self.tip
    }

    /// The direction in which it closes.
    #[must_use]
    pub fn closing(&self) -> Vector3<f64> {
        self.tip.rotate(&Vector3::x())
    }
}

/// A fingertip in motion.
#[derive(Clone, Debug)]
pub(super) struct Finger {
    place: FingerPlace,
    pub(super) sensor: SimulatedSensor,
    skin: Skin,
    radius: f64,
    /// How far it has closed \[m\].
    pub(super) closed: f64,
    speed: f64,
    wanted: f64,
    /// What it feels now, about the centre of its sphere.
    pub(super) felt: Wrench<f64>,
    /// Point, normal and what it feels there, in its own frame.
    pub(super) contact: Option<(TrueContact, f64)>,
}

/// No drive closes faster \[m/s\].
const FASTEST: f64 = 0.2;

/// What a fingertip does to the object, in the world.
#[derive(Clone, Copy, Debug)]
pub(super) struct OnObject {
    pub(super) force: Vector3<f64>,
    pub(super) at: Vector3<f64>,
    pub(super) torque: Vector3<f64>,
}

impl Finger {
    pub(super) fn new(
        place: FingerPlace,
        skin: SkinSettings,
        options: Options,
    ) -> Result<Self, SimulationError> {
        let skin = Skin::new(skin).map_err(|error| SimulationError::Hand { reason: error.to_string() })?;
        let radius = options.design.sphere()?.radius();
        let sensor = SimulatedSensor::new(options)?;
        let (felt, contact) = (Wrench::zero(), None);
        Ok(Self { place, sensor, skin, radius, closed: 0.0, speed: 0.0, wanted: 0.0, felt, contact })
    }

    /// Its pose in the hand.
    pub(super) fn tip(&self) -> RigidTransform<f64, Hand, Sensor> {
        let tip = self.place.tip;
        let rotation = Rotation3::from_matrix_unchecked(tip.rotation());
        RigidTransform::from_parts(rotation, tip.origin() + self.place.closing() * self.closed)
    }

    /// Wants to close at a speed \[m/s\] from now on; one that is not a number is none.
    pub(super) fn drive(&mut self, speed: f64) {
        self.wanted = if speed.is_nan() { 0.0 } else { speed.clamp(-FASTEST, FASTEST) };
    }

    /// The drive follows what is wanted with a lag \[s\].
    pub(super) fn advance(&mut self, lag: f64, time_step: f64) {
        self.speed += (self.wanted - self.speed) * -(-time_step / lag).exp_m1();
        self.closed += self.speed * time_step;
    }

    /// Touches the object for a time step.
    pub(super) fn touch<S: SignedDistance<f64>>(
        &mut self,
        shape: &S,
        body: &RigidBody,
        hand: &HandMotion,
        time_step: f64,
    ) -> Option<OnObject> {
        let tip = self.tip();
        let reach = hand.attitude * tip.origin();
        let centre = hand.origin + reach;
        let attitude = hand.attitude.to_rotation_matrix() * Rotation3::from_matrix_unchecked(tip.rotation());
        let of_object = body.attitude().inverse_transform_vector(&(centre - body.origin()));
        let nearest = shape.signed_distance(&of_object);
        let normal = -(body.attitude() * nearest.normal);
        let at = centre + normal * self.radius;
        let moves = hand.velocity
            + hand.attitude * (self.place.closing() * self.speed)
            + hand.turning.cross(&(reach + normal * self.radius));
        let velocity = body.velocity_at(&at) - moves;
        let spin = (body.angular_velocity() - hand.turning).dot(&normal);
        let depth = self.radius - nearest.distance;
        let approach = Approach {
            depth,
            normal: attitude.inverse_transform_vector(&normal),
            velocity: attitude.inverse_transform_vector(&velocity),
            spin,
        };
        let SkinForce { force, spin } = self.skin.step(&approach, time_step);
        if !(depth > 0.0) {
            (self.felt, self.contact) = (Wrench::zero(), None);
            return None;
        }
        let point = approach.normal * self.radius;
        self.felt = Wrench::on_fingertip(force, point.cross(&force) + approach.normal * spin);
        self.contact = Some((TrueContact { point, normal: approach.normal, force }, spin));
        Some(OnObject { force: -(attitude * force), at, torque: normal * -spin })
    }

    /// The force of the contact, in the frame of the sensor.
    pub(super) fn contact_force(&self) -> Option<ContactForce<f64>> {
        self.contact.map(|(contact, spin)| ContactForce::split(&contact.force, &contact.normal, spin))
    }

    pub(super) const fn slipping(&self) -> bool {
        self.skin.slipping()
    }

    pub(super) fn energy(&self) -> f64 {
        self.skin.energy()
    }
}

#[cfg(test)]
mod tests {
    use super::super::object::HeldObject;
    use super::*;
    use nalgebra::UnitQuaternion;

    #[test]
    fn fingers_stand_where_they_are_put_and_close_as_is_said() {
        let (centre, closing) = (Vector3::new(0.01, -0.02, 0.03), Vector3::new(0.0, 3.0, 4.0));
        for closing in [closing, -closing, Vector3::z() * 2.0, Vector3::x()] {
            let place = FingerPlace::new(centre, closing).unwrap();
            assert_eq!(place.tip().origin(), centre);
            assert!((place.closing() - closing.normalize()).norm() < 1e-15);
            let rotation = place.tip().rotation();
            assert!((rotation * rotation.transpose() - Matrix3::identity()).norm() < 1e-15);
            assert!((rotation.determinant() - 1.0).abs() < 1e-15);
        }
        for bad in [f64::NAN, f64::INFINITY] {
            for axis in 0..3 {
                let mut off = centre;
                off[axis] = bad;
                assert!(FingerPlace::new(off, closing).is_err() && FingerPlace::new(centre, off).is_err());
            }
        }
        assert!(FingerPlace::new(centre, Vector3::zeros()).is_err());
    }

    /// A hand and an object that move and turn as one do not move against each other: all that a fingertip feels is how deep
    /// it is pressed in. Closing faster it feels more.
    #[test]
    fn what_moves_as_one_does_not_slide() {
        let object = HeldObject::cylinder(0.03, 0.05, 0.2).unwrap();
        let (velocity, turning) = (Vector3::new(0.1, -0.2, 0.3), Vector3::new(1.0, 2.0, -3.0));
        for speed in [0.0, 0.02] {
            let mut finger = {
                let [open, _, _] = FingerPlace::ring::<3>(0.1);
                Finger::new(open, SkinSettings::default(), Options::default()).unwrap()
            };
            finger.closed = 0.1 - 0.03 - finger.radius + 0.5e-3;
            finger.drive(speed);
            finger.advance(1e-9, 1e-7);
            // The origin of the hand lies off that of the object, and the hand is turned about the object's axis.
            let hand = HandMotion {
                origin: Vector3::new(0.0, 0.0, 0.01),
                attitude: UnitQuaternion::from_scaled_axis(Vector3::z() * 0.7),
                velocity,
                acceleration: Vector3::zeros(),
                turning,
            };
            let mut body = RigidBody::at_rest(object.made_of, Vector3::zeros());
            body.set_motion(&(velocity + turning.cross(&-hand.origin)), &turning);
            let on_object = finger.touch(&object.shape, &body, &hand, 1e-6).unwrap();
            let expected = 5000.0 * 0.5e-3 + 10.0 * speed;
            let inward = hand.attitude * -Vector3::x();
            assert!((on_object.force - inward * expected).norm() < 1e-4, "{on_object:?} {expected}");
            assert!(on_object.torque.norm() < 1e-9, "{on_object:?}");
            let (contact, _) = finger.contact.unwrap();
            // The fingertip closes along its own x, and is pushed back.
            assert!((contact.normal - Vector3::x()).norm() < 1e-12);
            assert!((contact.force + Vector3::x() * expected).norm() < 1e-4);
            assert!((contact.point - Vector3::x() * finger.radius).norm() < 1e-12);
            assert!(finger.felt.torque().norm() < 1e-9);
        }
    }
}
