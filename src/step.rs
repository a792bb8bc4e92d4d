//! What is known of a sample beside its reading.

use fingertip_wrench::Real;
use nalgebra::Vector3;

/// The time since the sample before and, for those who have them, the last contact and the motion of the
/// sensor.
///
/// [`Fingertip::sense`](crate::Fingertip::sense) takes a time step alone, too:
///
/// ```
/// use fingertip::contact::PointContact;
/// use fingertip::surfaces::Torus;
/// use fingertip::wrench::{Motion, Payload, Wrench};
/// use fingertip::{Fingertip, Step};
/// use nalgebra::Vector3;
///
/// let ring = Torus::new(10e-3, 3e-3)?;
/// let push: Wrench<f64> = Wrench::on_fingertip(Vector3::new(-1.0, 0.0, 0.0), Vector3::zeros());
/// let mut fingertip = Fingertip::builder().contact(ring, PointContact::new(0.1)?).build();
/// let touch = fingertip.sense_wrench(push, 1e-3);
/// // A line through both sides of a ring enters twice; the contact before tells which entry is meant.
/// let inside = Vector3::new(-7e-3, 0.0, 0.0);
/// let again = fingertip.sense_wrench(push, Step::of(1e-3).with_last(Some(inside)));
/// assert!((touch.point().unwrap().x - 13e-3).abs() < 1e-12);
/// assert!((again.point().unwrap().x + 7e-3).abs() < 1e-12);
///
/// // With a payload, the motion is asked for by the types.
/// let tip = Payload::new(0.02, Vector3::zeros())?;
/// let gravity = Vector3::new(0.0, 0.0, -9.80665);
/// let mut carrying = Fingertip::builder().payload(tip).contact(ring, PointContact::new(0.1)?).build();
/// let hanging = Step::of(1e-3).with_motion(Motion::resting(gravity));
/// assert!(carrying.sense_wrench(tip.weight(&gravity), hanging).point().is_none());
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step<T: Real, M = ()> {
    /// Time since the sample before \[s\].
    pub time: T,
    /// The contact point of the sample before \[m\], for shapes that are not convex.
    pub last: Option<Vector3<T>>,
    /// How the sensor moves: what the payload, a [`Compensation`](fingertip_wrench::Compensation) of the wrench,
    /// takes beside it.
    pub motion: M,
}

impl<T: Real> Step<T> {
    /// So much time \[s\], and nothing else known.
    #[inline(always)]
    pub const fn of(time: T) -> Self {
        Self { time, last: None, motion: () }
    }
}

impl<T: Real, M> Step<T, M> {
    /// The same with the contact point of the sample before \[m\], if there was a contact.
    #[inline(always)]
    #[must_use]
    pub fn with_last(self, last: Option<Vector3<T>>) -> Self {
        Self { last, ..self }
    }

    /// The same with the motion of the sensor.
    #[inline(always)]
    pub fn with_motion<N>(self, motion: N) -> Step<T, N> {
        Step { time: self.time, last: self.last, motion }
    }
}

impl<T: Real> From<T> for Step<T> {
    #[inline(always)]
    fn from(time: T) -> Self {
        Self::of(time)
    }
}
