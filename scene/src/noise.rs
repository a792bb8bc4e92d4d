//! What a scene asks of the rest: how noisy the sensor is.

use fingertip::wrench::Real;
use nalgebra::{Vector3, Vector6};

use crate::fault::SceneProblem;
use crate::model::{ContactSection, Model};
use crate::sensor::SensorSource;
use crate::tracking::{Tracking, TrackingSection};
use crate::uncertainty::{Uncertainty, UncertaintySection};

/// The sections that answer to the noise.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Noisy {
    pub(crate) contact: ContactSection,
    pub(crate) uncertainty: Option<UncertaintySection>,
    pub(crate) tracking: Option<TrackingSection>,
    /// Origin of the surface's frame, in that of the sensor.
    pub(crate) pivot: Vector3<f64>,
    /// The calibration, whose fit leaves something uncertain.
    pub(crate) sensor: Option<SensorSource>,
}

/// What a noise makes of them.
pub(crate) struct Known<T: Real> {
    pub(crate) model: Model<T>,
    pub(crate) uncertainty: Option<Uncertainty<T>>,
    pub(crate) tracking: Option<Tracking<T>>,
}

/// The noise that stands for one that is not known yet.
const UNKNOWN: f64 = 1.0;

impl Noisy {
    /// Whether one of them asks for the noise of the rest.
    pub(crate) fn awaits_noise(&self) -> bool {
        self.contact.awaits_noise() || self.uncertainty.as_ref().is_some_and(UncertaintySection::awaits_noise)
    }

    /// Model, uncertainty and tracking under a noise of each component \[N, N·m\]. As long as that is asked for and not known, no
    /// force is a contact.
    pub(crate) fn build<T: Real>(&self, noise: Option<&Vector6<f64>>) -> Result<Known<T>, SceneProblem> {
        let known = noise.copied().unwrap_or_else(|| Vector6::repeat(UNKNOWN));
        let uncertainty: Option<Uncertainty<T>> = match &self.uncertainty {
            Some(section) => Some(section.build(&self.pivot, &known, self.sensor.as_ref())?),
            None => None,
        };
        // What is wrong with it is said before the noise is known.
        let contact = &self.contact;
        let at_rest = uncertainty.as_ref().map(Uncertainty::at_rest);
        let model = contact.build(at_rest)?;
        let tracking = self.tracking.as_ref();
        let tracking = tracking.map(|section| section.build(uncertainty.as_ref())).transpose()?;
        if !self.awaits_noise() {
            return Ok(Known { model, uncertainty, tracking });
        }
        let force = noise.map(|noise| noise.fixed_rows::<3>(0).amax());
        Ok(Known { model: contact.at_noise(force).build(at_rest)?, uncertainty, tracking })
    }
}
