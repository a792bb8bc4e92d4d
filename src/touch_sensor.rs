//! A fingertip of whatever kind.

use fingertip_contact::ContactModel;
use fingertip_friction::{SlipMargin, SlipVerdict};
use fingertip_wrench::{Compensation, Real, Wrench};

use crate::{Fingertip, GripStage, SlipStage, Step, Touch, TrackStage};

/// What a sample says, of whichever stages there are.
pub type AnyTouch<T> = Touch<T, Option<SlipMargin<T>>, Option<SlipVerdict>>;

impl<T: Real, Reading, Verdict, Tracked> Touch<T, Reading, Verdict, Tracked> {
    /// The same in words that all stages have in common.
    #[inline(always)]
    pub(crate) fn any<Friction, Detector>(self) -> AnyTouch<T>
    where
        Friction: GripStage<T, Reading = Reading>,
        Detector: SlipStage<T, Verdict = Verdict>,
    {
        let Self { wrench, resolution, force, grip, slip, .. } = self;
        let grip = grip.map(|reading| Friction::margin(&reading));
        Touch { wrench, resolution, force, grip, slip: Detector::slip(&slip), tracked: () }
    }
}

/// A fingertip of whatever kind: every [`Fingertip`] without a payload, and the pipelines that are chosen at run
/// time from a scene. For hands whose fingers differ: it can be a `dyn`, at the price of one call through a pointer.
///
/// ```
/// use fingertip::contact::{PointContact, SoftFinger};
/// use fingertip::friction::Coulomb;
/// use fingertip::surfaces::{Capsule, Sphere};
/// use fingertip::wrench::Wrench;
/// use fingertip::{Fingertip, Step, TouchSensor};
/// use nalgebra::Vector3;
///
/// let ball = Sphere::centred(13e-3)?;
/// let tip = Capsule::new(Vector3::zeros(), Vector3::z(), 7e-3, 6e-3)?;
/// let friction = Coulomb::new(0.6)?;
/// let mut thumb = Fingertip::builder().contact(ball, PointContact::new(0.1)?).friction(friction).build();
/// let mut index = Fingertip::builder().contact(tip, SoftFinger::new(0.1)?).build();
/// let hand: [&mut dyn TouchSensor<f64>; 2] = [&mut thumb, &mut index];
///
/// let push = Wrench::on_fingertip(Vector3::new(-1.0, 0.0, 0.0), Vector3::zeros());
/// let touches = hand.map(|finger| finger.feel(push, Step::of(1e-3)));
/// assert!((touches[0].point().unwrap().x - 13e-3).abs() < 1e-12);
/// assert!((touches[1].point().unwrap().x - 7e-3).abs() < 1e-12);
/// // A stage that a finger has not says nothing.
/// assert!(touches[0].grip.flatten().is_some() && touches[1].grip.flatten().is_none());
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` feels no touch of `{T}`",
    note = "a `Fingertip` whose stages are of one scalar does; a sensor of your own implements `TouchSensor::feel` and `start_anew`"
)]
pub trait TouchSensor<T: Real> {
    /// One wrench on the fingertip, in the frame of the sensor, and what is known of the sample beside it.
    fn feel(&mut self, wrench: Wrench<T>, step: Step<T>) -> AnyTouch<T>;

    /// Forgets the samples before, as after a change of grasp or a pause; what was calibrated or tared stays.
    fn start_anew(&mut self);
}

impl<T, Solver, Surface, Model, Friction, Detector, Zero, Payload, Track> TouchSensor<T>
    for Fingertip<Solver, Surface, Model, Friction, Detector, Zero, Payload, Track>
where
    T: Real,
    Payload: Compensation<Wrench<T>, Raw = (Wrench<T>, ())>,
    Model: ContactModel<T, Surface>,
    Friction: GripStage<T>,
    Detector: SlipStage<T>,
    Track: TrackStage<T, Model, Surface>,
{
    fn feel(&mut self, wrench: Wrench<T>, step: Step<T>) -> AnyTouch<T> {
        self.sense_wrench(wrench, step).any::<Friction, Detector>()
    }

    fn start_anew(&mut self) {
        self.detector_mut().start_anew();
        self.track_mut().start_anew();
    }
}

impl<T: Real, S: TouchSensor<T> + ?Sized> TouchSensor<T> for &mut S {
    fn feel(&mut self, wrench: Wrench<T>, step: Step<T>) -> AnyTouch<T> {
        (**self).feel(wrench, step)
    }

    fn start_anew(&mut self) {
        (**self).start_anew();
    }
}
