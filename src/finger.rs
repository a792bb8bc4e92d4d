//! A touch as a finger of a hand.

use fingertip_contact::{NoContact, Resolution};
use fingertip_friction::SlipVerdict;
use fingertip_hand::{ContactFriction, FingerSample, FingerState, GraspContact};
use fingertip_wrench::{Real, Sensor};

use crate::Touch;

impl<T: Real, Reading, Verdict, Tracked> Touch<T, Reading, Verdict, Tracked>
where
    Verdict: Copy + Into<Option<SlipVerdict>>,
{
    /// What a finger of a hand says by this touch, in the frame of the sensor: the one place where a touch becomes part of
    /// a grasp. A force that is too small is no contact; any other that has none is
    /// [unexplained](FingerState::Unexplained). Without a detector nothing slips.
    ///
    /// ```
    /// use fingertip::hand::{ContactFriction, FingerState, Hand};
    /// use fingertip::prelude::*;
    /// use fingertip::wrench::{RigidTransform, Sensor};
    ///
    /// let ball = Sphere::centred(13e-3)?;
    /// let noise = ForceNoise::isotropic(0.01)?;
    /// let mut tip = Fingertip::builder()
    ///     .contact(ball, PointContact::new(0.1)?)
    ///     .slip_detector(DropDetector::new(noise)?)
    ///     .build();
    /// let friction = ContactFriction::point(0.6)?;
    /// let pose: RigidTransform<f64, Hand, Sensor> = RigidTransform::translation(Vector3::z() * 0.1);
    ///
    /// let push = Wrench::on_fingertip(Vector3::new(0.0, 0.0, -2.0), Vector3::zeros());
    /// let finger = tip.sense_wrench(push, 1e-3).finger(&friction).expressed_in(&pose);
    /// let sample = finger.sample().expect("it touches");
    /// assert!((sample.contact.place().z - 0.113).abs() < 1e-12 && sample.force.normal == 2.0);
    /// // A force that passes the ball by.
    /// let beside = Wrench::from_force_at(&Vector3::new(0.05, 0.0, 0.0), Vector3::new(0.0, 0.0, -2.0));
    /// assert_eq!(tip.sense_wrench(beside, 1e-3).finger(&friction), FingerState::Unexplained);
    /// assert_eq!(tip.sense_wrench(Wrench::zero(), 1e-3).finger(&friction), FingerState::Free);
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    #[must_use]
    pub fn finger(&self, friction: &ContactFriction<T>) -> FingerState<T, Sensor> {
        let contact = match &self.resolution {
            Resolution::Contact(contact) => contact,
            Resolution::NoContact(NoContact::BelowThreshold { .. }) => return FingerState::Free,
            Resolution::NoContact(_) => return FingerState::Unexplained,
        };
        let force = self.force.unwrap_or_else(|| contact.contact_force());
        let slip = self.slip.into().unwrap_or(SlipVerdict::Holding);
        match GraspContact::new(contact.point, contact.normal, *friction) {
            Ok(contact) => FingerState::Touching(FingerSample { contact, force, slip }),
            Err(_) => FingerState::Unexplained,
        }
    }
}
