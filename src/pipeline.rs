//! The stages wired together.

use fingertip_contact::{ContactModel, Resolution};
use fingertip_wrench::{Compensation, ContactForce, Real, Uncompensated, Wrench, WrenchSolver};
use nalgebra::{SVector, Vector3};

use crate::{Absent, FingertipBuilder, GripStage, SlipStage, Step, TrackStage};

/// One fingertip: from raw readings to touch.
///
/// The stages are types, so that a scene compiles and runs only what it needs: an [`Absent`] stage
/// takes no memory and no time. Made by [`Fingertip::builder`].
///
/// ```
/// use fingertip::prelude::*;
///
/// // Six signals of which each is one component: 30 N or 0.3 N·m a volt.
/// let nominal = Vector6::new(30.0, 30.0, 30.0, 0.3, 0.3, 0.3);
/// let sensor = SensorMatrix::new(fingertip::nalgebra::SMatrix::identity(), nominal)?;
/// let mut tip = Fingertip::builder()
///     .solver(GaussianElimination::new(&sensor)?)
///     .contact(Sphere::centred(13e-3)?, PointContact::new(0.1)?)
///     .build();
/// let volts = Vector6::new(0.0, 0.0, -0.1, 0.0, 0.0, 0.0);
/// let touch = tip.sense(&volts, 1e-3);
/// assert!(touch.force.is_some_and(|force| (force.normal - 3.0_f64).abs() < 1e-12));
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fingertip<
    Solver,
    Surface,
    Model,
    Friction = Absent,
    Detector = Absent,
    Zero = Uncompensated,
    Payload = Absent,
    Track = Absent,
> {
    pub(crate) zero: Zero,
    pub(crate) solver: Solver,
    pub(crate) payload: Payload,
    pub(crate) surface: Surface,
    pub(crate) model: Model,
    pub(crate) friction: Friction,
    pub(crate) detector: Detector,
    pub(crate) track: Track,
}

/// What one sample says.
///
/// ```
/// use fingertip::prelude::*;
///
/// let mut tip = Fingertip::builder()
///     .contact(Sphere::centred(13e-3)?, PointContact::new(0.1)?)
///     .friction(Coulomb::new(0.5)?)
///     .build();
/// let push = Wrench::from_force_at(&Vector3::new(0.0, 0.0, 13e-3), Vector3::new(0.5, 0.0, -2.0));
/// let Touch { resolution, force, grip, .. } = tip.sense_wrench(push, 1e-3);
/// assert!(resolution.contact().is_some() && grip.is_some());
/// assert!(force.is_some_and(|force| (force.tangential_magnitude() - 0.5_f64).abs() < 1e-12));
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize, Reading: serde::Serialize, Verdict: serde::Serialize, \
            Tracked: serde::Serialize",
        deserialize = "T: serde::Deserialize<'de>, Reading: serde::Deserialize<'de>, \
            Verdict: serde::Deserialize<'de>, Tracked: serde::Deserialize<'de>"
    ))
)]
pub struct Touch<T: Real, Reading = (), Verdict = (), Tracked = ()> {
    /// The load on the fingertip, without that of its payload.
    pub wrench: Wrench<T>,
    /// Where it touches, or why nowhere.
    pub resolution: Resolution<T>,
    /// The force of the contact, split at its tangent plane; `None` without a contact.
    pub force: Option<ContactForce<T>>,
    /// What the friction model says of the contact; `None` without a contact.
    pub grip: Option<Reading>,
    /// What the slip detector says.
    pub slip: Verdict,
    /// Where the contact is by all samples so far, as the tracker says.
    pub tracked: Tracked,
}

impl<T: Real, Reading, Verdict, Tracked> Touch<T, Reading, Verdict, Tracked> {
    /// Where it touches \[m\]; `None` without a contact.
    #[inline(always)]
    pub fn point(&self) -> Option<Vector3<T>> {
        self.resolution.contact().map(|contact| contact.point)
    }
}

impl Fingertip<Absent, Absent, Absent> {
    /// Starts a pipeline with every optional stage left out.
    pub const fn builder()
    -> FingertipBuilder<Absent, Absent, Absent, Absent, Absent, Uncompensated, Absent, Absent> {
        FingertipBuilder::new()
    }
}

impl<Solver, Surface, Model, Friction, Detector, Zero, Payload, Track>
    Fingertip<Solver, Surface, Model, Friction, Detector, Zero, Payload, Track>
{
    /// One raw reading, and the time since the one before \[s\] or a whole [`Step`].
    // Always in line: an answer that goes through memory is written in small pieces and read in large
    // ones, which costs more than a sample of a small scene.
    #[inline(always)]
    pub fn sense<T, M, Reading, Verdict, Tracked, const N: usize>(
        &mut self,
        raw: &Zero::Raw,
        step: impl Into<Step<T, M>>,
    ) -> Touch<T, Reading, Verdict, Tracked>
    where
        T: Real,
        Zero: Compensation<SVector<T, N>>,
        Solver: WrenchSolver<T, N>,
        Payload: Compensation<Wrench<T>, Raw = (Wrench<T>, M)>,
        Model: ContactModel<T, Surface>,
        Friction: GripStage<T, Reading = Reading>,
        Detector: SlipStage<T, Verdict = Verdict>,
        Track: TrackStage<T, Model, Surface, Tracked = Tracked>,
    {
        let measured = self.solver.solve(&self.zero.compensate(raw));
        self.sense_wrench(measured, step)
    }

    /// One wrench, from a sensor that reports wrenches, and the time since the one before \[s\] or a whole
    /// [`Step`].
    #[inline(always)]
    // What stages say are parameters: were it told by their traits in the answer, the compiler would call a stage that
    // is none a method that is not there, without the traits' words for it.
    pub fn sense_wrench<T, M, Reading, Verdict, Tracked>(
        &mut self,
        measured: Wrench<T>,
        step: impl Into<Step<T, M>>,
    ) -> Touch<T, Reading, Verdict, Tracked>
    where
        T: Real,
        Payload: Compensation<Wrench<T>, Raw = (Wrench<T>, M)>,
        Model: ContactModel<T, Surface>,
        Friction: GripStage<T, Reading = Reading>,
        Detector: SlipStage<T, Verdict = Verdict>,
        Track: TrackStage<T, Model, Surface, Tracked = Tracked>,
    {
        let Step { time, last, motion } = step.into();
        let wrench = self.payload.compensate(&(measured, motion));
        let (resolution, force) = self.model.feel_near(&wrench, &self.surface, last.as_ref());
        let (grip, slip) = match &force {
            Some(force) => (Some(self.friction.judge(force)), self.detector.follow(Some(force), time)),
            None => (None, self.detector.follow(None, time)),
        };
        let on = (&self.model, &self.surface);
        let tracked = self.track.follow(resolution.contact(), &wrench, on, time);
        Touch { wrench, resolution, force, grip, slip, tracked }
    }

    /// The stage that takes off what is not load.
    pub const fn zero(&self) -> &Zero {
        &self.zero
    }

    /// Puts another tare in place, as after a rest.
    pub fn set_zero(&mut self, zero: Zero) {
        self.zero = zero;
    }

    /// The active surface.
    pub const fn surface(&self) -> &Surface {
        &self.surface
    }

    /// The friction model.
    pub const fn friction(&self) -> &Friction {
        &self.friction
    }

    /// The assumption under which the contact is found.
    pub const fn model(&self) -> &Model {
        &self.model
    }

    /// The slip detector.
    pub const fn detector(&self) -> &Detector {
        &self.detector
    }

    /// The slip detector, to reset it after a change of grasp.
    pub const fn detector_mut(&mut self) -> &mut Detector {
        &mut self.detector
    }

    /// What follows the contact over time.
    pub const fn track(&self) -> &Track {
        &self.track
    }

    /// The same, to reset it after a pause.
    pub const fn track_mut(&mut self) -> &mut Track {
        &mut self.track
    }
}
