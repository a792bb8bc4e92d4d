//! `[tracking]`: the contact over time, and when it begins and ends.

use fingertip::contact::{
    BadTrack, Contact, ContactEvents, ContactJacobian, Happened, Sighting, Tracked, Tracker,
};
use fingertip::surfaces::DynSurface;
use fingertip::wrench::{Real, Wrench};
use serde::{Deserialize, Serialize};

use crate::fault::SceneProblem;
use crate::uncertainty::Uncertainty;

/// `[tracking]` of a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct TrackingSection {
    /// How fast the contact moves over the fingertip, about.
    #[serde(rename = "speed_m_per_s")]
    speed: f64,
    /// How soon it may turn round, about.
    #[serde(rename = "turns_within_s")]
    within: f64,
    /// The share of samples of the contact itself that are doubted.
    #[serde(default = "usual_share")]
    doubted_share: f64,
    /// The smallest force that is a touch; without it, no events are told.
    #[serde(rename = "least_touch_N", skip_serializing_if = "Option::is_none")]
    least_touch: Option<f64>,
    /// So many samples lie between two false events, or more.
    #[serde(default = "usual_samples")]
    samples_per_false_event: f64,
    /// So soon the force of a blow falls to half its peak, or sooner.
    #[serde(default = "usual_impact")]
    longest_impact_s: f64,
}

const fn usual_share() -> f64 {
    0.001
}
const fn usual_samples() -> f64 {
    1e6
}
const fn usual_impact() -> f64 {
    0.05
}

/// Which key is wrong.
fn wrong(key: &'static str, requirement: &'static str) -> SceneProblem {
    SceneProblem::Range { key, section: "tracking", requirement }
}

impl TrackingSection {
    /// `uncertainty` tells how noisy the wrench is.
    pub(crate) fn build<T: Real>(
        &self,
        uncertainty: Option<&Uncertainty<T>>,
    ) -> Result<Tracking<T>, SceneProblem> {
        let Some(uncertainty) = uncertainty else {
            return Err(SceneProblem::Needs {
                what: "[tracking]",
                needed: "the section [uncertainty], which tells how much a sample counts",
            });
        };
        let key = |error: BadTrack| match error.parameter {
            "speed" => wrong("speed_m_per_s", "positive and finite"),
            "time to turn" => wrong("turns_within_s", "positive and finite"),
            "share of samples beyond the gate" => wrong("doubted_share", "between 0 and 1"),
            "samples between false ones" => wrong("samples_per_false_event", "finite and more than one"),
            "longest impact" => wrong("longest_impact_s", "positive and finite"),
            "noise" => wrong("least_touch_N", "left out, or `force_noise_N` of [uncertainty] positive"),
            "least force" | "least force over its noise" => {
                wrong("least_touch_N", "positive and finite, and of the size of forces")
            }
            _ => wrong("speed_m_per_s", "such that with `turns_within_s` it makes a length of ordinary size"),
        };
        let number = T::literal;
        let tracker = Tracker::new(number(self.speed), number(self.within)).map_err(key)?;
        let tracker = tracker.with_gate(number(self.doubted_share)).map_err(key)?;
        let samples = number(self.samples_per_false_event);
        let events = match self.least_touch {
            Some(least) => {
                let events = ContactEvents::new(uncertainty.force_noise(), number(least), samples);
                let longest = number(self.longest_impact_s);
                Some(events.and_then(|events| events.with_longest_impact(longest)).map_err(key)?)
            }
            None => None,
        };
        Ok(Tracking { tracker, events })
    }
}

/// Follows the contact from sample to sample.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Tracking<T: Real> {
    tracker: Tracker<T>,
    events: Option<ContactEvents<T>>,
}

impl<T: Real> Tracking<T> {
    /// Whether events are told.
    pub(crate) const fn tells_events(&self) -> bool {
        self.events.is_some()
    }

    /// Takes a sample: its contact with the derivatives, if there is one and they exist.
    pub(crate) fn follow(
        &mut self,
        found: Option<(&Contact<T>, &ContactJacobian<T>)>,
        wrench: &Wrench<T>,
        uncertainty: &Uncertainty<T>,
        surface: &DynSurface<T>,
        time_step: T,
    ) -> (Option<Tracked<T>>, Option<Happened<T>>) {
        // What is uncertain of the geometry is the same in each sample, so it is no noise.
        let sighting = found.and_then(|(contact, jacobian)| {
            Sighting::of(contact, jacobian, &uncertainty.noise.covariance(wrench))
        });
        let tracked = self.tracker.follow(surface, sighting.as_ref(), time_step);
        let happened = self.events.as_mut().map(|events| events.observe(&wrench.force(), time_step));
        (tracked, happened)
    }

    /// The next contact is new, and nothing touches.
    pub(crate) fn start_anew(&mut self) {
        self.tracker.reset();
        if let Some(events) = &mut self.events {
            events.reset();
        }
    }
}
