//! Puts a pipeline together, stage by stage.

#[cfg(feature = "track")]
use fingertip_contact::{Tracker, WrenchNoise};
#[cfg(feature = "track")]
use fingertip_wrench::Real;
use fingertip_wrench::Uncompensated;

#[cfg(feature = "track")]
use crate::Tracking;
use crate::{Absent, Fingertip, Present};

/// Chooses the stages of a [`Fingertip`]; what is not chosen is left out.
///
/// ```
/// use fingertip::prelude::*;
///
/// // Friction that is chosen at run time, in a box; no detector.
/// let friction: Box<dyn FrictionModel<f64>> = Box::new(Coulomb::new(0.5)?);
/// let mut tip = Fingertip::builder()
///     .contact(Sphere::centred(13e-3)?, PointContact::new(0.1)?)
///     .friction(friction)
///     .build();
/// let push = Wrench::from_force_at(&Vector3::new(0.0, 0.0, 13e-3), Vector3::new(0.5, 0.0, -2.0));
/// assert!(tip.sense_wrench(push, 1e-3).grip.is_some_and(|margin| margin.newtons > 0.4));
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct FingertipBuilder<Solver, Surface, Model, Friction, Detector, Zero, Payload, Track> {
    fingertip: Fingertip<Solver, Surface, Model, Friction, Detector, Zero, Payload, Track>,
}

impl FingertipBuilder<Absent, Absent, Absent, Absent, Absent, Uncompensated, Absent, Absent> {
    pub(crate) const fn new() -> Self {
        Self {
            fingertip: Fingertip {
                zero: Uncompensated,
                solver: Absent,
                payload: Absent,
                surface: Absent,
                model: Absent,
                friction: Absent,
                detector: Absent,
                track: Absent,
            },
        }
    }
}

impl<Solver, Surface, Model, Friction, Detector, Zero, Payload, Track>
    FingertipBuilder<Solver, Surface, Model, Friction, Detector, Zero, Payload, Track>
{
    /// What takes the zero and the temperature off the readings.
    pub fn zero<Next>(
        self,
        zero: Next,
    ) -> FingertipBuilder<Solver, Surface, Model, Friction, Detector, Next, Payload, Track> {
        let Fingertip { solver, payload, surface, model, friction, detector, track, .. } = self.fingertip;
        FingertipBuilder {
            fingertip: Fingertip { zero, solver, payload, surface, model, friction, detector, track },
        }
    }

    /// What turns signals into a wrench.
    pub fn solver<Next>(
        self,
        solver: Next,
    ) -> FingertipBuilder<Next, Surface, Model, Friction, Detector, Zero, Payload, Track> {
        let Fingertip { zero, payload, surface, model, friction, detector, track, .. } = self.fingertip;
        FingertipBuilder {
            fingertip: Fingertip { zero, solver, payload, surface, model, friction, detector, track },
        }
    }

    /// What the sensor carries all the time, whose weight and inertia are no contact: a
    /// [`Payload`](fingertip_wrench::Payload), or any [`Compensation`](fingertip_wrench::Compensation) of a wrench and
    /// something beside it. Every sample takes that, a payload's the motion of the sensor, with it by
    /// [`Step::with_motion`](crate::Step::with_motion).
    pub fn payload<Next>(
        self,
        payload: Next,
    ) -> FingertipBuilder<Solver, Surface, Model, Friction, Detector, Zero, Next, Track> {
        let Fingertip { zero, solver, surface, model, friction, detector, track, .. } = self.fingertip;
        FingertipBuilder {
            fingertip: Fingertip { zero, solver, payload, surface, model, friction, detector, track },
        }
    }

    /// The shape that may touch, and the assumption under which the contact is found on it.
    pub fn contact<Shape, Assumption>(
        self,
        surface: Shape,
        model: Assumption,
    ) -> FingertipBuilder<Solver, Shape, Assumption, Friction, Detector, Zero, Payload, Track> {
        let Fingertip { zero, solver, payload, friction, detector, track, .. } = self.fingertip;
        FingertipBuilder {
            fingertip: Fingertip { zero, solver, payload, surface, model, friction, detector, track },
        }
    }

    /// What says how far the contact is from slipping.
    pub fn friction<Next>(
        self,
        friction: Next,
    ) -> FingertipBuilder<Solver, Surface, Model, Present<Next>, Detector, Zero, Payload, Track> {
        self.friction_stage(Present(friction))
    }

    /// What watches for slip from sample to sample.
    pub fn slip_detector<Next>(
        self,
        detector: Next,
    ) -> FingertipBuilder<Solver, Surface, Model, Friction, Present<Next>, Zero, Payload, Track> {
        self.slip_stage(Present(detector))
    }

    /// A stage of your own in the place of [`friction`](Self::friction): any
    /// [`GripStage`](crate::GripStage), such as one that is chosen at run time.
    pub fn friction_stage<Next>(
        self,
        friction: Next,
    ) -> FingertipBuilder<Solver, Surface, Model, Next, Detector, Zero, Payload, Track> {
        let Fingertip { zero, solver, payload, surface, model, detector, track, .. } = self.fingertip;
        FingertipBuilder {
            fingertip: Fingertip { zero, solver, payload, surface, model, friction, detector, track },
        }
    }

    /// A stage of your own in the place of [`slip_detector`](Self::slip_detector): any
    /// [`SlipStage`](crate::SlipStage).
    pub fn slip_stage<Next>(
        self,
        detector: Next,
    ) -> FingertipBuilder<Solver, Surface, Model, Friction, Next, Zero, Payload, Track> {
        let Fingertip { zero, solver, payload, surface, model, friction, track, .. } = self.fingertip;
        FingertipBuilder {
            fingertip: Fingertip { zero, solver, payload, surface, model, friction, detector, track },
        }
    }

    /// What follows the contact over time, and how noisy the wrench is, by which it weighs each contact: every touch
    /// then says where the contact is by all samples so far, and how fast it moves.
    #[cfg(feature = "track")]
    pub fn tracker<T: Real>(
        self,
        tracker: Tracker<T>,
        noise: WrenchNoise<T>,
    ) -> FingertipBuilder<Solver, Surface, Model, Friction, Detector, Zero, Payload, Tracking<T>> {
        self.track_stage(Tracking { tracker, noise })
    }

    /// A stage of your own in the place of `tracker`: any [`TrackStage`](crate::TrackStage).
    pub fn track_stage<Next>(
        self,
        track: Next,
    ) -> FingertipBuilder<Solver, Surface, Model, Friction, Detector, Zero, Payload, Next> {
        let Fingertip { zero, solver, payload, surface, model, friction, detector, .. } = self.fingertip;
        FingertipBuilder {
            fingertip: Fingertip { zero, solver, payload, surface, model, friction, detector, track },
        }
    }

    /// The pipeline. It runs as soon as it has a surface and a contact model (for wrenches), and a
    /// solver (for signals).
    #[must_use]
    pub fn build(self) -> Fingertip<Solver, Surface, Model, Friction, Detector, Zero, Payload, Track> {
        self.fingertip
    }
}
