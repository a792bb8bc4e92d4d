//! What a scene asks of the rest: how noisy the sensor is.

use fingertip::wrench::Real;
use nalgebra::{Vector3, Vector6};

use crate::fault::SceneProblem;
use crate::model::{ContactSection, Model};
use crate::uncertainty::{Uncertainty, UncertaintySection};

/// The sections that answer to the noise.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Noisy {
    pub(crate) contact: ContactSection,
    pub(crate) uncertainty: Option<UncertaintySection>,
    /// Origin of the surface's frame, in that of the sensor.
    pub(crate) pivot: Vector3<f64>,
}

/// The noise that stands for one that is not known yet.
const UNKNOWN: f64 = 1.0;

impl Noisy {
    /// Whether one of them asks for the noise of the rest.
    pub(crate) fn awaits_noise(&self) -> bool {
        self.contact.awaits_noise() || self.uncertainty.as_ref().is_some_and(UncertaintySection::awaits_noise)
    }

    /// Model and uncertainty under a noise of each component \[N, N·m\]. As long as that is asked for and not known, no
    /// force is a contact.
    pub(crate) fn build<T: Real>(
        &self,
        noise: Option<&Vector6<f64>>,
    ) -> Result<(Model<T>, Option<Uncertainty<T>>), SceneProblem> {
        let known = noise.copied().unwrap_or_else(|| Vector6::repeat(UNKNOWN));
        let uncertainty: Option<Uncertainty<T>> = match &self.uncertainty {
            Some(section) => Some(section.build(&self.pivot, &known)?),
            None => None,
        };
        // What is wrong with it is said before the noise is known.
        let contact = &self.contact;
        let at_rest = uncertainty.as_ref().map(Uncertainty::at_rest);
        let model = contact.build(at_rest)?;
        if !self.awaits_noise() {
            return Ok((model, uncertainty));
        }
        let force = noise.map(|noise| noise.fixed_rows::<3>(0).amax());
        Ok((contact.at_noise(force).build(at_rest)?, uncertainty))
    }
}
