//! The pipeline of a scene, chosen at run time.

mod reported;

use fingertip::friction::{GripController, SlipVerdict};
use fingertip::surfaces::DynSurface;
use fingertip::wrench::{Real, Wrench};
use fingertip::{AnyTouch, Step, TouchSensor};
use nalgebra::{Matrix3, Vector3, Vector6};

use crate::carried::Carried;
use crate::estimate::Estimate;
use crate::fault::SceneProblem;
use crate::felt::{Felt, Tells};
use crate::filter::Filter;
use crate::friction::{Friction, Limit};
use crate::front::Front;
use crate::fusion::Joined;
use crate::model::Model;
use crate::noise::{Known, Noisy};
use crate::sensor::Sensor;
use crate::slip::{Detector, SlipWatch};
use crate::stages::Stages;
use crate::tracking::Tracking;
use crate::uncertainty::Uncertainty;

/// A longer step than this is a pause \[s\]: what follows from sample to sample starts anew.
const PAUSE: f64 = 0.5;

/// A fingertip that a scene describes: every stage is chosen when it is made, once.
///
/// Made by [`Scene::pipeline`](crate::Scene::pipeline). One sample at a time: it keeps the last contact, what the
/// slip detector saw, and what was learnt of the friction. After a pause of more than half a second, and after
/// [`reset`](Self::reset), the next sample is the first.
///
/// ```
/// # const BALL: &str = "version = 2\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"sphere\"\nradius_m = 0.013\n";
/// use fingertip::wrench::Wrench;
/// use fingertip_scene::Scene;
/// use nalgebra::Vector3;
///
/// let scene = Scene::from_text(BALL)?;
/// let mut pipeline = scene.pipeline();
/// let push = Wrench::from_force_at(&Vector3::new(0.0, 0.013, 0.0), Vector3::new(0.0, -1.0, 0.0));
/// let felt = pipeline.sense(push, 1e-3);
/// assert!((felt.contact().ok_or("a contact")?.point.y - 0.013).abs() < 1e-12);
/// // The same in single precision, as a microcontroller has it.
/// let mut single = scene.pipeline_in::<f32>()?;
/// let push = Wrench::from_force_at(&Vector3::new(0.0, 0.013, 0.0), Vector3::new(0.0, -1.0, 0.0));
/// assert!((single.sense(push, 1e-3).contact().ok_or("a contact")?.point.y - 0.013).abs() < 1e-8);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Pipeline<T: Real> {
    front: Front<T>,
    filter: Option<Filter<T>>,
    stages: Stages<T>,
    surface: DynSurface<T>,
    model: Model<T>,
    uncertainty: Option<Uncertainty<T>>,
    tracking: Option<Tracking<T>>,
    fusion: Option<Joined<T>>,
    /// The sections that answer to the noise of the rest, if one does.
    noisy: Option<Box<Noisy>>,
    awaits_noise: bool,
    estimate: Option<Estimate<T>>,
    grip: Option<GripController<T>>,
    /// Whether a stage beside those of every scene is there.
    has_more: bool,
    last: Option<Vector3<T>>,
    felt: Felt<T>,
}

/// The parts that a scene builds.
pub(crate) struct Parts<T: Real> {
    pub(crate) front: Front<T>,
    pub(crate) filter: Option<Filter<T>>,
    pub(crate) surface: DynSurface<T>,
    pub(crate) model: Model<T>,
    pub(crate) uncertainty: Option<Uncertainty<T>>,
    pub(crate) tracking: Option<Tracking<T>>,
    pub(crate) fusion: Option<Joined<T>>,
    pub(crate) noisy: Option<Box<Noisy>>,
    pub(crate) friction: Friction<T>,
    pub(crate) slip: SlipWatch<T>,
    pub(crate) estimate: Option<Estimate<T>>,
    pub(crate) grip: Option<GripController<T>>,
}

impl<T: Real> Pipeline<T> {
    pub(crate) fn new(parts: Parts<T>) -> Self {
        let Parts {
            front,
            filter,
            surface,
            model,
            uncertainty,
            tracking,
            fusion,
            noisy,
            friction,
            slip,
            estimate,
            grip,
        } = parts;
        let stages = Stages::new(surface.clone(), model.clone(), friction, slip);
        let has_more = uncertainty.is_some()
            || estimate.is_some()
            || grip.is_some()
            || matches!(stages.friction(), Friction(Some(Limit::Uncertain { .. })))
            || matches!(stages.slip(), SlipWatch(Some(Detector::StickSlip(_))));
        let felt = Felt::nothing();
        Self {
            front,
            filter,
            stages,
            surface,
            model,
            uncertainty,
            tracking,
            fusion,
            awaits_noise: noisy.is_some(),
            noisy,
            estimate,
            grip,
            has_more,
            last: None,
            felt,
        }
    }

    /// Takes a wrench on the fingertip and the time since the one before \[s\]; a time that is not positive
    /// counts as none. What the sample says stays here until the next one.
    // By reference: to copy it costs as much as a sample of a small scene.
    #[inline]
    pub fn sense(&mut self, wrench: Wrench<T>, time_step: T) -> &Felt<T> {
        let time_step = if time_step > T::zero() { time_step } else { T::zero() };
        if time_step > T::literal(PAUSE) {
            self.start_anew();
        }
        let wrench = match &mut self.filter {
            Some(filter) => filter.follow(wrench),
            None => wrench,
        };
        if self.has_more {
            let before = self.last;
            self.stages.sense(&wrench, time_step, &mut self.last, &mut self.felt.touch);
            self.say_more(before, time_step);
        } else {
            self.stages.sense(&wrench, time_step, &mut self.last, &mut self.felt.touch);
        }
        &self.felt
    }

    /// The sensor of `[sensor]`.
    pub const fn sensor(&self) -> Option<&Sensor<T>> {
        self.front.sensor.as_ref()
    }

    /// The sensor of `[sensor]`, to take its zero at rest.
    pub const fn sensor_mut(&mut self) -> Option<&mut Sensor<T>> {
        self.front.sensor.as_mut()
    }

    /// What the sensor carries, of `[payload]`.
    pub const fn carried(&self) -> Option<&Carried<T>> {
        self.front.carried.as_ref()
    }

    /// What the sensor carries, to say how it hung while the zero was taken.
    pub const fn carried_mut(&mut self) -> Option<&mut Carried<T>> {
        self.front.carried.as_mut()
    }

    /// Whether the scene asks for the noise of the rest, and it is not known: until then no force is a contact.
    pub const fn awaits_noise(&self) -> bool {
        self.awaits_noise
    }

    /// Tells the standard deviation of each component of the wrench at rest \[N, N·m\], which a
    /// [`RestWatch`](crate::RestWatch) and a [`Sensor`] measure. A scene that states its thresholds needs none, and
    /// nothing changes; otherwise the next sample is the first.
    ///
    /// ```
    /// use fingertip::contact::{NoContact, Resolution};
    /// use fingertip::wrench::Wrench;
    /// use fingertip_scene::Scene;
    /// use nalgebra::{Vector3, Vector6};
    ///
    /// let scene = Scene::from_text(
    ///     r#"
    ///     version = 2
    ///     [input]
    ///     convention = "on_fingertip"
    ///     rest_s = 1.0
    ///     [surface]
    ///     shape = "sphere"
    ///     radius_m = 0.013
    ///     [contact]
    ///     least_force_deviations = 5.0
    ///     "#,
    /// )?;
    /// let mut pipeline = scene.pipeline();
    /// let push = Wrench::on_fingertip(Vector3::new(0.0, 0.0, -0.2), Vector3::zeros());
    /// assert!(pipeline.awaits_noise() && pipeline.sense(push, 1e-3).contact().is_none());
    /// pipeline.know_noise(&Vector6::new(0.02, 0.03, 0.01, 1e-4, 1e-4, 1e-4))?;
    /// assert!(pipeline.sense(push, 1e-3).contact().is_some());
    /// let light = Wrench::on_fingertip(Vector3::new(0.0, 0.0, -0.14), Vector3::zeros());
    /// let none = pipeline.sense(light, 1e-3).touch.resolution;
    /// assert!(matches!(none, Resolution::NoContact(NoContact::BelowThreshold { .. })));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`SceneProblem`] for a noise that is none: negative or not finite.
    pub fn know_noise(&mut self, noise: &Vector6<T>) -> Result<(), SceneProblem> {
        let Some(noisy) = &self.noisy else { return Ok(()) };
        let noise = noise.map(Real::to_f64);
        if !noise.iter().all(|deviation| *deviation >= 0.0 && deviation.is_finite()) {
            let (key, section) = ("rest_s", "input");
            return Err(SceneProblem::Range { key, section, requirement: "a rest of finite readings" });
        }
        let Known { model, uncertainty, tracking } = noisy.build(Some(&noise))?;
        let (friction, slip) = (*self.stages.friction(), self.stages.slip().clone());
        self.stages = Stages::new(self.surface.clone(), model.clone(), friction, slip);
        (self.model, self.uncertainty, self.awaits_noise) = (model, uncertainty, false);
        self.tracking = tracking;
        self.start_anew();
        Ok(())
    }

    /// By how much the wrench comes late that a `[filter]` gives, where it changes slowly \[s\].
    pub fn delay(&self) -> T {
        self.filter.as_ref().map_or_else(T::zero, Filter::delay)
    }

    /// What the stages beside those of every scene say.
    #[inline(never)]
    fn say_more(&mut self, before: Option<Vector3<T>>, time_step: T) {
        let felt = &mut self.felt;
        let (force, slip) = (felt.touch.force, felt.touch.slip);
        let limit = self.stages.friction().0.as_ref();
        felt.stick_slip = self.stages.slip().stick_slip();
        felt.slip_probability = force.as_ref().and_then(|force| limit?.slip_probability(force));
        if let Some(uncertainty) = &self.uncertainty {
            let (contact, wrench) = (felt.touch.resolution.contact(), &felt.touch.wrench);
            let jacobian = contact
                .and_then(|contact| self.model.jacobian(contact, wrench, &self.surface, before.as_ref()));
            felt.spread = jacobian.as_ref().and_then(|jacobian| uncertainty.of(jacobian, wrench));
            if let Some(tracking) = &mut self.tracking {
                let found = contact.zip(jacobian.as_ref());
                (felt.tracked, felt.happened) =
                    tracking.follow(found, wrench, uncertainty, &self.surface, time_step);
            }
        }
        if let Some(estimate) = &mut self.estimate {
            estimate.follow(force.as_ref(), slip, time_step);
            felt.friction = Some(estimate.learnt());
        }
        if let (Some(grip), Some(limit)) = (&mut self.grip, limit) {
            // Without a contact, that of before.
            let slip = slip.unwrap_or(SlipVerdict::Holding);
            felt.grip_force = Some(match &force {
                Some(force) => grip.command(limit, force, slip, time_step),
                None => grip.present(),
            });
        }
    }

    /// Forgets all samples: the next is the first.
    pub fn reset(&mut self) {
        self.start_anew();
        if let Some(estimate) = &mut self.estimate {
            estimate.reset();
        }
        if let Some(grip) = &mut self.grip {
            // Held to its limits: the least.
            grip.start_at(T::zero());
        }
    }

    /// Forgets the last contact and its track, what the filter holds and what the slip detector saw, as after a gap in a recording;
    /// what was learnt of the friction stays.
    pub fn start_anew(&mut self) {
        self.stages.slip_mut().reset();
        self.last = None;
        if let Some(tracking) = &mut self.tracking {
            tracking.start_anew();
        }
        if let Some(filter) = &mut self.filter {
            filter.start_anew();
        }
        if let Some(carried) = &mut self.front.carried {
            carried.start_anew();
        }
    }

    /// What is told of each sample beside contact, forces, margin and verdict.
    pub fn tells(&self) -> Tells {
        Tells {
            spin_torque: self.model().knows_spin(),
            spread: self.uncertainty.is_some(),
            tracked: self.tracking.is_some(),
            happened: self.tracking.as_ref().is_some_and(Tracking::tells_events),
            slip_probability: matches!(self.limit(), Some(Limit::Uncertain { .. })),
            friction: self.estimate.is_some(),
            grip_force: self.grip.is_some(),
        }
    }

    /// What the last sample said; before the first, that nothing touches.
    pub const fn felt(&self) -> &Felt<T> {
        &self.felt
    }

    /// Covariance of where the last contact is, in its tangent plane \[m²\]: of which [`Felt::spread`] has the ellipse, or
    /// with `[tracking]` of where it is by all samples so far, for as long as it is tracked. `None` where neither is told.
    pub fn place_covariance(&self) -> Option<Matrix3<T>> {
        let along = |[a, b]: &[Vector3<T>; 2], [aa, ab, bb]: [T; 3]| {
            a * a.transpose() * aa + (a * b.transpose() + b * a.transpose()) * ab + b * b.transpose() * bb
        };
        if let Some(tracked) = &self.felt.tracked {
            let m = &tracked.position_covariance;
            return Some(along(&tracked.tangents, [m.m11, (m.m12 + m.m21) * T::literal(0.5), m.m22]));
        }
        let (spread, uncertainty) = (self.felt.spread.as_ref()?, self.uncertainty.as_ref()?);
        // The square of a semi-axis, less the quantile of χ² with two degrees of freedom.
        let quantile = (T::one() - uncertainty.probability).ln() * T::literal(-2.0);
        let [major, minor] = spread.ellipse.semi_axes.map(|axis| axis * axis / quantile);
        Some(along(&spread.ellipse.directions, [major, T::zero(), minor]))
    }

    /// The surface, in the sensor frame.
    pub const fn surface(&self) -> &DynSurface<T> {
        &self.surface
    }

    /// The contact model.
    pub const fn model(&self) -> &Model<T> {
        &self.model
    }

    pub(crate) const fn fusion(&self) -> Option<&Joined<T>> {
        self.fusion.as_ref()
    }

    pub(crate) const fn uncertainty(&self) -> Option<&Uncertainty<T>> {
        self.uncertainty.as_ref()
    }

    pub(crate) const fn filter(&self) -> Option<&Filter<T>> {
        self.filter.as_ref()
    }

    /// Whether a stage beside those of every scene is there.
    pub(crate) const fn has_more(&self) -> bool {
        self.has_more
    }

    /// The slip detector, if the scene has one, with what it saw so far.
    pub const fn detector(&self) -> Option<&Detector<T>> {
        self.stages.slip().0.as_ref()
    }

    /// The friction limit, if the scene has one.
    pub const fn limit(&self) -> Option<&Limit<T>> {
        self.stages.friction().0.as_ref()
    }
}

/// The last contact is its own, unless the step has one.
impl<T: Real> TouchSensor<T> for Pipeline<T> {
    fn feel(&mut self, wrench: Wrench<T>, step: Step<T>) -> AnyTouch<T> {
        self.last = step.last.or(self.last);
        self.sense(wrench, step.time).touch
    }

    fn start_anew(&mut self) {
        self.start_anew();
    }
}
