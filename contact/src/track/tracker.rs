//! Follows a contact from sample to sample.

use fingertip_surfaces::ActiveSurface;
use fingertip_wrench::Real;
use nalgebra::Vector2;

use super::bad_track::is_ordinary;
use super::followed::{Seen, Track};
use super::{BadTrack, Continuity, Sighting, Tracked};

const WHAT: &str = "a tracker";

/// A pause that is so many times as long as the contact takes to turn is the end of a track.
const PAUSE: f64 = 10.0;

/// The share of samples of the contact itself that are taken for another one, if nothing else is said.
const ASTRAY: f64 = 1e-3;

/// Follows a contact on the surface: a Kalman filter of position and velocity in the tangent plane
/// (`docs/theory/contact.md#tracking`), in which each sample counts by how sure it is under its force.
///
/// How a contact moves is said in words: it moves at about `speed` and may turn round within about the time
/// `within`. That is white acceleration of the density `speed/√within` \[m/s^1.5\]. The slower and steadier, the more
/// samples are averaged.
///
/// A sample that is too far off for the contact that is followed is not taken at first. If the next one is there too, it
/// is another contact, and the track starts anew: nothing is dragged along.
///
/// Forces are not touched: they are those of the sample.
///
/// ```
/// use fingertip_contact::{ContactModel, PointContact, Sighting, Tracker, WrenchSpread};
/// use fingertip_surfaces::Sphere;
/// use fingertip_wrench::Wrench;
/// use nalgebra::Vector3;
///
/// let ball = Sphere::new(Vector3::zeros(), 0.013)?;
/// let model = PointContact::new(0.05)?;
/// let noise = WrenchSpread::Isotropic { force: 1e-4, torque: 1e-8 };
/// // It moves at about 10 mm/s and may turn within a tenth of a second.
/// let mut tracker = Tracker::new(0.01, 0.1)?;
/// let mut last = None;
/// for sample in 0..200 {
///     // In truth it rolls along at 10 mm/s.
///     let angle = 0.01 / 0.013 * 1e-3 * f64::from(sample);
///     let normal = Vector3::new(angle.sin(), 0.0, angle.cos());
///     let wrench = Wrench::from_force_at(&(normal * 0.013), -normal * 0.5);
///     let found = model.resolve(&wrench, &ball);
///     let sighting = found.contact().and_then(|contact| Sighting::of_point_contact(contact, &wrench, noise));
///     last = tracker.follow(&ball, sighting.as_ref(), 1e-3);
/// }
/// let tracked = last.ok_or("no contact")?;
/// assert!((tracked.velocity.norm() - 0.01).abs() < 1e-3);
/// // One sample has a deviation of 0.33 mm.
/// assert!(tracked.deviation() < 0.12e-3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tracker<T: Real> {
    speed: T,
    within: T,
    /// The unit of length \[m\] and its reciprocal.
    unit: T,
    shorter: T,
    /// The reciprocal of the unit of time \[1/s\].
    faster: T,
    gate: T,
    track: Option<Track<T>>,
    /// What the sample before would be if it was no mistake.
    rival: Option<Track<T>>,
    /// Sum of the variances of the last sighting that was taken [units].
    sample: T,
}

impl<T: Real> Tracker<T> {
    /// For a contact that moves at about `speed` \[m/s\] and may turn round within about so long \[s\].
    ///
    /// # Errors
    /// [`BadTrack`] unless both are positive and finite, and their product, a length, has a square and its reciprocal in
    /// the range of the type.
    pub fn new(speed: T, within: T) -> Result<Self, BadTrack> {
        let positive = |x: T| x > T::zero() && (T::one() / x).is_number() && x.is_number();
        BadTrack::check(WHAT, "speed", "positive and finite", positive(speed))?;
        BadTrack::check(WHAT, "time to turn", "positive and finite", positive(within))?;
        let unit = speed * within;
        BadTrack::check(
            WHAT,
            "speed times its time to turn",
            "a length of ordinary size",
            is_ordinary(unit),
        )?;
        Ok(Self {
            speed,
            within,
            unit,
            shorter: T::one() / unit,
            faster: T::one() / within,
            gate: gate_at(T::literal(ASTRAY)),
            track: None,
            rival: None,
            sample: T::zero(),
        })
    }

    /// With another gate: of the samples of the contact itself, so many are taken for another one at first, by their
    /// noise. The share is 0.001 if nothing is said. A smaller one lets the contact jump farther unnoticed.
    ///
    /// # Errors
    /// [`BadTrack`] unless the share is between 0 and 1.
    pub fn with_gate(self, share: T) -> Result<Self, BadTrack> {
        let good = share > T::zero() && share < T::one();
        BadTrack::check(WHAT, "share of samples beyond the gate", "between 0 and 1", good)?;
        Ok(Self { gate: gate_at(share), ..self })
    }

    /// How fast the contact moves, about \[m/s\].
    #[must_use]
    pub const fn speed(&self) -> T {
        self.speed
    }

    /// How long it takes to turn round, about \[s\].
    #[must_use]
    pub const fn within(&self) -> T {
        self.within
    }

    /// The normalised innovation squared beyond which a sample is of another contact.
    #[must_use]
    pub const fn gate(&self) -> T {
        self.gate
    }

    /// Takes a sample, and the time since the one before \[s\]; `None` if it has no contact. Says what is known now, and
    /// `None` if no contact is followed.
    ///
    /// A time that is not positive counts as none. After a pause of ten times the time to turn the next contact is
    /// new; so it is when, without any contact, the track knows less of the place than a sample did.
    #[inline]
    pub fn follow<S: ActiveSurface<T>>(
        &mut self,
        surface: &S,
        sighting: Option<&Sighting<T>>,
        time_step: T,
    ) -> Option<Tracked<T>> {
        let time = if time_step > T::zero() { time_step * self.faster } else { T::zero() };
        if !(time <= T::literal(PAUSE)) {
            self.reset();
        }
        let said = match sighting {
            Some(sighting) => self.see(surface, sighting, time),
            None => self.coast(surface, time),
        }?;
        // Here alone, so that of a track only that is read which is asked for.
        self.track.as_ref().map(|track| said.of(track, self.speed, self.unit))
    }

    #[inline(always)]
    fn see<S: ActiveSurface<T>>(&mut self, surface: &S, sighting: &Sighting<T>, time: T) -> Option<Said<T>> {
        if let Some(track) = &mut self.track
            && let Some(compared) = track.compare(sighting, time, self.shorter)
            && compared.surprise() <= self.gate
        {
            if track.take(surface, &compared, self.unit).is_none() {
                return self.forget();
            }
            self.rival = None;
            self.sample = compared.variance();
            let (innovation, surprise) = (compared.innovation, compared.surprise());
            return Some(Said { continuity: Continuity::Followed, innovation, surprise });
        }
        self.doubt(surface, Seen::new(sighting, self.shorter), time)
    }

    /// The first sample, or one that may be of another contact: of the one that the sample before was of, if that was in
    /// doubt, too.
    #[cold]
    #[inline(never)]
    fn doubt<S: ActiveSurface<T>>(&mut self, surface: &S, seen: Seen<T>, time: T) -> Option<Said<T>> {
        let variance = seen.variance();
        if !variance.is_number() {
            // It says nothing.
            return self.coast(surface, time);
        }
        let Some(track) = &mut self.track else {
            self.track = Some(Track::start(&seen));
            self.sample = variance;
            return self.checked(Said::plainly(Continuity::New));
        };
        // Once more, since to carry it here would cost the samples that are not in doubt.
        let (shorter, unit) = (self.shorter, self.unit);
        let compared =
            track.compare_seen(&seen, time, shorter).filter(|compared| compared.surprise().is_number());
        let mut continuity = Continuity::Doubted;
        let follow = |mut rival: Track<T>| {
            let again = rival.compare_seen(&seen, time, shorter)?;
            if !(again.surprise() <= self.gate) {
                return None;
            }
            rival.take(surface, &again, unit).map(|()| rival)
        };
        if let Some(rival) = self.rival.and_then(follow) {
            (self.track, self.rival) = (Some(rival), None);
            self.sample = variance;
            continuity = Continuity::New;
        } else {
            self.rival = Some(Track::start(&seen));
            track.move_on(surface, track.state.wait(time), unit);
        }
        let (innovation, surprise) = match compared {
            Some(compared) => (compared.innovation, compared.surprise()),
            // On another side of the body.
            None if continuity == Continuity::Doubted => (Vector2::zeros(), T::GREATEST),
            None => (Vector2::zeros(), T::zero()),
        };
        self.checked(Said { continuity, innovation, surprise })
    }

    #[cold]
    #[inline(never)]
    fn coast<S: ActiveSurface<T>>(&mut self, surface: &S, time: T) -> Option<Said<T>> {
        let track = self.track.as_mut()?;
        let now = track.state.wait(time);
        if !(now.0.positions.trace() <= self.sample) {
            return self.forget();
        }
        self.rival = None;
        track.move_on(surface, now, self.unit);
        self.checked(Said::plainly(Continuity::Bridged))
    }

    /// Nothing of a track whose numbers are out of range, and it is forgotten.
    fn checked(&mut self, said: Said<T>) -> Option<Said<T>> {
        if self.track.as_ref().is_some_and(|track| track.state.is_number()) {
            Some(said)
        } else {
            self.forget()
        }
    }

    #[cold]
    fn forget(&mut self) -> Option<Said<T>> {
        self.reset();
        None
    }

    /// Forgets the contact: the next one is new.
    pub fn reset(&mut self) {
        self.track = None;
        self.rival = None;
    }
}

/// What is said of a sample beside the track.
struct Said<T: Real> {
    continuity: Continuity,
    /// [units]
    innovation: Vector2<T>,
    surprise: T,
}

impl<T: Real> Said<T> {
    /// Of a sample that was compared with nothing.
    fn plainly(continuity: Continuity) -> Self {
        Self { continuity, innovation: Vector2::zeros(), surprise: T::zero() }
    }

    /// With the track, in SI units.
    #[inline(always)]
    fn of(&self, track: &Track<T>, speed: T, unit: T) -> Tracked<T> {
        let Track { point, normal, tangents, state } = track;
        let [e1, e2] = tangents;
        Tracked {
            point: *point,
            normal: *normal,
            tangents: *tangents,
            velocity: e1 * (state.velocity.x * speed) + e2 * (state.velocity.y * speed),
            position_covariance: state.positions.scaled(unit * unit).matrix(),
            velocity_covariance: state.velocities.scaled(speed * speed).matrix(),
            innovation: self.innovation * unit,
            surprise: self.surprise,
            continuity: self.continuity,
        }
    }
}

/// The quantile of χ² with two degrees of freedom that this share exceeds.
fn gate_at<T: Real>(share: T) -> T {
    -share.logarithm() * T::literal(2.0)
}
