//! When something touches and lets go.

use fingertip_wrench::Real;
use nalgebra::Vector3;

use super::evidence::{Evidence, for_load, magnitude};
use super::impact::{Blow, Impact, Limits, Progress};
use crate::track::BadTrack;

const WHAT: &str = "events of a contact";

/// How long the force of a blow takes to fall to half its peak at most, if nothing else is said [s].
const LONGEST: f64 = 0.05;

/// Less than this share of the smallest touch must be left before it is over: with more, a force between what calls a
/// touch (half of the smallest) and that could be called both again and again; with less, a release is called later.
const LEFT: f64 = 0.4;

/// Tells when something touches, lets go, or strikes, from the force alone and as soon as its noise allows.
///
/// Each is a test of likelihoods, summed up from sample to sample until the evidence is enough
/// (`docs/theory/contact.md#contact-events`): a strong touch is called at once, a weak one after some samples. So
/// hysteresis and debouncing follow from the noise and from how often a false event may be called.
///
/// ```
/// use fingertip_contact::ContactEvents;
/// use nalgebra::Vector3;
///
/// // Noise of 10 mN; touches of 60 mN and more; once in a million samples an event may be false.
/// let mut events = ContactEvents::new(0.01, 0.06, 1e6)?;
/// let push = |newtons: f64| Vector3::new(0.0, 0.0, -newtons);
/// assert!(!events.observe(&push(0.0), 1e-3).touching);
/// let first = events.observe(&push(0.08), 1e-3);
/// let second = events.observe(&push(0.08), 1e-3);
/// assert!(first.touch.is_some() || second.touch.is_some());
/// // One sample near zero is not yet the end.
/// assert!(events.observe(&push(0.0), 1e-3).touching);
/// let released = (0..20).find_map(|_| events.observe(&push(0.0), 1e-3).release);
/// assert!(released.is_some());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactEvents<T: Real> {
    deviation: T,
    /// Of the smallest touch, and what must be left of one [deviations].
    size: T,
    left: T,
    threshold: T,
    limits: Limits<T>,
    touching: bool,
    touch: Evidence<T>,
    release: Evidence<T>,
    blow: Option<Blow<T>>,
}

/// What a sample tells.
///
/// ```
/// use fingertip_contact::ContactEvents;
/// use nalgebra::Vector3;
///
/// // Noise of 10 mN, touches of 60 mN and more, at 1 kHz: nothing at first, then 0.5 N.
/// let mut events = ContactEvents::new(0.01, 0.06, 1e6)?;
/// let before = events.observe(&Vector3::zeros(), 1e-3);
/// assert!(!before.touching && before.touch.is_none());
/// // So strong a touch is called by its first sample.
/// let happened = events.observe(&Vector3::new(0.0, 0.0, -0.5), 1e-3);
/// assert!(happened.touching && happened.touch == Some(0.0) && happened.release.is_none());
/// # Ok::<(), fingertip_contact::BadTrack>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>"))
)]
pub struct Happened<T: Real> {
    /// Whether something touches.
    pub touching: bool,
    /// A touch is called, which showed first so long ago \[s\].
    pub touch: Option<T>,
    /// A release is called, which showed first so long ago \[s\].
    pub release: Option<T>,
    /// A blow is over, with which the contact began.
    pub impact: Option<Impact<T>>,
}

impl<T: Real> ContactEvents<T> {
    /// For a standard deviation of each component of the force at rest \[N\], the smallest force that is a touch \[N\], and
    /// how many samples shall lie between two false events in the mean, or more.
    ///
    /// # Errors
    /// [`BadTrack`] unless all are positive and finite, the samples more than one, and the squared ratio of force and
    /// deviation in the range of the type.
    pub fn new(deviation: T, least_force: T, samples: T) -> Result<Self, BadTrack> {
        let positive = |x: T| x > T::zero() && x.is_number();
        BadTrack::check(WHAT, "noise", "positive and finite", positive(deviation))?;
        BadTrack::check(WHAT, "least force", "positive and finite", positive(least_force))?;
        let enough = samples > T::one() && samples.is_number();
        BadTrack::check(WHAT, "samples between false ones", "finite and more than one", enough)?;
        let size = least_force / deviation;
        let square = size * size;
        let good = square.is_number() && square >= T::LEAST_NORMAL;
        BadTrack::check(WHAT, "least force over its noise", "of ordinary size", good)?;
        let threshold = samples.logarithm();
        // A Gaussian is beyond √(2h) deviations less often than once in e^h samples; two of them are compared.
        let apart = deviation * T::literal(2.0) * (threshold + threshold).root();
        Ok(Self {
            deviation,
            size,
            left: size * T::literal(LEFT),
            threshold,
            limits: Limits { longest: T::literal(LONGEST), apart },
            touching: false,
            touch: Evidence::none(),
            release: Evidence::none(),
            blow: None,
        })
    }

    /// With blows that take longer: so long from the first sign of a touch to where the force has fallen to half its peak
    /// \[s\]; 0.05 s if nothing is said. What takes longer is a press.
    ///
    /// # Errors
    /// [`BadTrack`] unless it is positive and finite.
    pub fn with_longest_impact(self, longest: T) -> Result<Self, BadTrack> {
        let good = longest > T::zero() && longest.is_number();
        BadTrack::check(WHAT, "longest impact", "positive and finite", good)?;
        Ok(Self { limits: Limits { longest, ..self.limits }, ..self })
    }

    /// Whether something touches.
    #[must_use]
    pub const fn is_touching(&self) -> bool {
        self.touching
    }

    /// Takes the force on the fingertip \[N\], whether or not it was a contact, and the time since the sample before \[s\].
    /// A time that is not positive counts as none; a force that is not finite tells nothing.
    pub fn observe(&mut self, force: &Vector3<T>, time_step: T) -> Happened<T> {
        let time = if time_step > T::zero() && time_step.is_number() { time_step } else { T::zero() };
        let nothing = Happened { touching: self.touching, touch: None, release: None, impact: None };
        let Some(magnitude) = magnitude(force, self.deviation) else { return nothing };
        let size = magnitude * self.deviation;
        let size = if size.is_number() { size } else { T::GREATEST };
        let impact = self.follow_blow(force, size, time);
        if self.touching {
            // Less must be left than what calls a touch, or a force between would do both again and again.
            let against = -for_load(magnitude, self.left);
            if self.release.add(against, self.threshold, time) == Some(true) {
                let since = self.release.since;
                let ended = self.blow.and_then(|blow| blow.over());
                self.let_go();
                return Happened {
                    touching: false,
                    release: Some(since),
                    impact: impact.or(ended),
                    ..nothing
                };
            }
            return Happened { impact, ..nothing };
        }
        match self.touch.add(for_load(magnitude, self.size), self.threshold, time) {
            None => self.blow = None,
            Some(called) => {
                if self.blow.is_none() {
                    self.blow = Some(Blow::begin(force, size));
                }
                if called {
                    let since = self.touch.since;
                    (self.touching, self.touch, self.release) = (true, Evidence::none(), Evidence::none());
                    return Happened { touching: true, touch: Some(since), ..nothing };
                }
            }
        }
        nothing
    }

    fn follow_blow(&mut self, force: &Vector3<T>, size: T, time: T) -> Option<Impact<T>> {
        match self.blow.as_mut()?.take(force, size, time, &self.limits) {
            Progress::Going => None,
            Progress::Press => {
                self.blow = None;
                None
            }
            Progress::Over(impact) => {
                self.blow = None;
                self.touching.then_some(impact)
            }
        }
    }

    fn let_go(&mut self) {
        (self.touching, self.touch, self.release) = (false, Evidence::none(), Evidence::none());
        self.blow = None;
    }

    /// Forgets all samples: nothing touches.
    pub fn reset(&mut self) {
        self.let_go();
    }
}
