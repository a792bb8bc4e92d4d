//! Live samples through a scene: sign, tare, contact, slip.

mod noise;

use fingertip::Fingertip;
use fingertip::contact::{ConfidenceEllipse, Contact, ContactCovariance, ContactJacobian, Resolution};
use fingertip::surfaces::ActiveSurface;
use fingertip::wrench::{TareAccumulator, Wrench};
use nalgebra::{Matrix3, Vector6};

use crate::observe::SceneTouch;
use crate::scene::Scene;
use crate::shape::Shape;
pub(crate) use noise::NoiseWatch;

/// A longer step than this is a pause \[s\]: what follows from sample to sample starts anew.
const PAUSE: f64 = 0.5;

/// What the pipeline of a scene makes of a wrench.
type Feel = Box<dyn FnMut(Wrench<f64>, f64) -> SceneTouch + Send>;

/// The pipeline of a scene, with the tare that the scene asks for.
pub(crate) struct SceneFeel {
    scene: Scene,
    feel: Feel,
    rest: Rest,
    last: Option<f64>,
}

/// The mean of the first seconds.
#[derive(Clone, Debug)]
pub(crate) struct Rest {
    /// How long, while it lasts \[s\].
    left: Option<f64>,
    first: Option<f64>,
    resting: TareAccumulator<f64, 6>,
    zero: Vector6<f64>,
}

impl Rest {
    /// Over so many seconds; `None` takes nothing off.
    pub(crate) fn new(seconds: Option<f64>) -> Self {
        Self { left: seconds, first: None, resting: TareAccumulator::default(), zero: Vector6::zeros() }
    }

    /// The wrench less the zero; `None` while it rests.
    pub(crate) fn take(&mut self, time: f64, wrench: &Wrench<f64>) -> Result<Option<Wrench<f64>>, String> {
        let components = wrench.components();
        if let Some(seconds) = self.left {
            if time - *self.first.get_or_insert(time) < seconds {
                self.resting.add(&components);
                return Ok(None);
            }
            self.left = None;
            let tare = self.resting.finish().map_err(|error| {
                format!("no zero from {seconds} s at rest: {error}; rest longer, or check the sensor")
            })?;
            self.zero = *tare.zero();
        }
        Ok(Some(Wrench::from_components(&(components - self.zero))))
    }

    /// Whether the zero is still being taken.
    pub(crate) const fn is_resting(&self) -> bool {
        self.left.is_some()
    }

    /// The zero.
    pub(crate) const fn zero(&self) -> &Vector6<f64> {
        &self.zero
    }
}

impl SceneFeel {
    /// `tared` if the wrenches have their zero taken off already, so that the scene's rest does not count.
    pub(crate) fn new(scene: Scene, tared: bool) -> Self {
        let feel = match &scene.shape {
            Shape::Plane(plane) => over(*plane, &scene),
            Shape::Sphere(sphere) => over(*sphere, &scene),
            Shape::Cylinder(cylinder) => over(*cylinder, &scene),
            Shape::Other(other) => over(other.as_ref().clone(), &scene),
        };
        let rest = Rest::new(scene.rest.filter(|_| !tared));
        Self { scene, feel, rest, last: None }
    }

    /// What a sample means; `None` while the zero is taken.
    pub(crate) fn feel(&mut self, time: f64, reported: &Wrench<f64>) -> Result<Option<SceneTouch>, String> {
        let Some(tared) = self.rest.take(time, reported)? else { return Ok(None) };
        let wrench = self.scene.convention.wrench(tared.force(), tared.torque());
        let step = self.last.replace(time).map_or(0.0, |last| time - last);
        Ok(Some((self.feel)(wrench, if step > 0.0 { step } else { 0.0 })))
    }
}

fn over<S: ActiveSurface<f64> + Send + 'static>(surface: S, scene: &Scene) -> Feel {
    let mut fingertip = Fingertip::builder()
        .contact(surface, scene.model)
        .friction_stage(scene.friction)
        .slip_stage(scene.slip)
        .build();
    let mut last = None;
    Box::new(move |wrench, step| {
        if step > PAUSE {
            fingertip.detector_mut().reset();
            last = None;
        }
        let touch = fingertip.feel(wrench, step, last.as_ref());
        last = touch.resolution.contact().map(|contact: &Contact<f64>| contact.point);
        touch
    })
}

/// Where the contact lies with 95 %, by the noise of the wrench alone. A point contact's position does not
/// depend on the curvature of the surface.
pub(crate) fn ellipse(touch: &SceneTouch, noise: &NoiseWatch) -> Option<ConfidenceEllipse<f64>> {
    let Resolution::Contact(contact) = &touch.resolution else { return None };
    let jacobian = ContactJacobian::of_point_contact(contact, &touch.wrench, &Matrix3::zeros())?;
    let covariance = noise.wrench_noise()?.covariance(&touch.wrench);
    ContactCovariance::new(&jacobian, &covariance).ellipse(0.95)
}
