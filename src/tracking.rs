//! The stage that follows the contact over time, and its absence.

use fingertip_contact::Contact;
#[cfg(feature = "track")]
use fingertip_contact::{PointContact, Sighting, SoftFinger, Tracked, Tracker, WrenchNoise, WrenchSpread};
#[cfg(feature = "track")]
use fingertip_surfaces::{ActiveSurface, SmoothSurface};
use fingertip_wrench::{Real, Wrench};

use crate::Absent;

/// Follows the contact over the surface from sample to sample: [`Tracking`] does, with a tracker.
///
/// ```
/// use fingertip::TrackStage;
/// use fingertip::prelude::*;
///
/// /// Tells how far the contact has moved since the last sample that had one [m].
/// #[derive(Default)]
/// struct Way(Option<Vector3<f64>>);
///
/// impl<Model, Surface> TrackStage<f64, Model, Surface> for Way {
///     type Tracked = f64;
///
///     fn follow(&mut self, found: Option<&Contact<f64>>, _: &Wrench<f64>, _: (&Model, &Surface), _: f64) -> f64 {
///         let Some(found) = found else { return 0.0 };
///         self.0.replace(found.point).map_or(0.0, |last| (found.point - last).norm())
///     }
/// }
///
/// let (ball, model) = (Sphere::centred(13e-3)?, PointContact::new(0.1)?);
/// let mut tip = Fingertip::builder().contact(ball, model).track_stage(Way::default()).build();
/// let push = |x: f64| Wrench::from_force_at(&Vector3::new(x, 0.0, 20e-3), Vector3::new(0.0, 0.0, -2.0));
/// assert_eq!(tip.sense_wrench(push(0.0), 1e-3).tracked, 0.0);
/// assert!((tip.sense_wrench(push(1e-4), 1e-3).tracked - 1e-4).abs() < 1e-6);
/// # Ok::<(), Error>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot follow contacts that `{Model}` finds on `{Surface}` in `{T}`",
    note = "give a tracker to `.tracker(…)`, for a point contact or a soft finger, or a `TrackStage` to `.track_stage(…)`"
)]
pub trait TrackStage<T: Real, Model, Surface> {
    /// What it says after a sample.
    type Tracked;

    /// Takes the contact of the next sample, if there is one, with its wrench, what found it and where, and the time since
    /// the sample before \[s\].
    fn follow(
        &mut self,
        found: Option<&Contact<T>>,
        wrench: &Wrench<T>,
        on: (&Model, &Surface),
        time_step: T,
    ) -> Self::Tracked;

    /// Forgets the samples before; the default has nothing to forget.
    #[inline]
    fn start_anew(&mut self) {}
}

impl<T: Real, Model, Surface> TrackStage<T, Model, Surface> for Absent {
    type Tracked = ();

    #[inline(always)]
    fn follow(&mut self, _: Option<&Contact<T>>, _: &Wrench<T>, _: (&Model, &Surface), _: T) {}
}

/// A tracker as a stage, with the noise of the wrench, by which it weighs each contact.
///
/// ```
/// use fingertip::contact::{Tracker, WrenchNoise};
/// use fingertip::prelude::*;
///
/// // Noise of 10 mN and 0.1 N·mm. The contact moves at about 10 mm/s and may turn within a tenth of a second.
/// let noise = WrenchNoise::new(Vector6::new(0.01, 0.01, 0.01, 1e-4, 1e-4, 1e-4), 0.0)?;
/// let mut tip = Fingertip::builder()
///     .contact(Sphere::centred(13e-3)?, PointContact::new(0.1)?)
///     .tracker(Tracker::new(0.01, 0.1)?, noise)
///     .build();
/// let mut last = None;
/// for sample in 0..200 {
///     // It rolls along at 10 mm/s.
///     let angle: f64 = 0.01 / 13e-3 * 1e-3 * f64::from(sample);
///     let normal = Vector3::new(angle.sin(), 0.0, angle.cos());
///     last = tip.sense_wrench(Wrench::from_force_at(&(normal * 13e-3), -normal * 0.5), 1e-3).tracked;
/// }
/// let tracked = last.ok_or("no contact")?;
/// assert!((tracked.velocity.norm() - 0.01).abs() < 1e-3 && tracked.deviation() < 0.12e-3);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[cfg(feature = "track")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tracking<T: Real> {
    /// What follows.
    pub tracker: Tracker<T>,
    /// How noisy the wrench is.
    pub noise: WrenchNoise<T>,
}

#[cfg(feature = "track")]
impl<T: Real, Surface: ActiveSurface<T>> TrackStage<T, PointContact<T>, Surface> for Tracking<T> {
    type Tracked = Option<Tracked<T>>;

    #[inline]
    fn follow(
        &mut self,
        found: Option<&Contact<T>>,
        wrench: &Wrench<T>,
        (_, surface): (&PointContact<T>, &Surface),
        time_step: T,
    ) -> Option<Tracked<T>> {
        let spread = WrenchSpread::Independent(self.noise.variances(wrench));
        let sighting = found.and_then(|found| Sighting::of_point_contact(found, wrench, spread));
        self.tracker.follow(surface, sighting.as_ref(), time_step)
    }

    fn start_anew(&mut self) {
        self.tracker.reset();
    }
}

#[cfg(feature = "track")]
impl<T: Real, Surface> TrackStage<T, SoftFinger<T>, Surface> for Tracking<T>
where
    Surface: ActiveSurface<T> + SmoothSurface<T>,
{
    type Tracked = Option<Tracked<T>>;

    #[inline]
    fn follow(
        &mut self,
        found: Option<&Contact<T>>,
        wrench: &Wrench<T>,
        (_, surface): (&SoftFinger<T>, &Surface),
        time_step: T,
    ) -> Option<Tracked<T>> {
        let spread = WrenchSpread::Independent(self.noise.variances(wrench));
        let sighting = found.and_then(|found| Sighting::of_soft_finger(found, surface, spread));
        self.tracker.follow(surface, sighting.as_ref(), time_step)
    }

    fn start_anew(&mut self) {
        self.tracker.reset();
    }
}
