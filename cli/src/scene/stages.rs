//! The contact model, the friction and the slip detector of a scene.

use fingertip::contact::PointContact;
use fingertip::friction::{
    BadParameter, Coulomb, DropDetector, ForceNoise, FrictionModel, NormalForceGate, RatioThreshold,
    SlipDetector, SlipMargin, SlipVerdict,
};
use fingertip::surfaces::BadShape;
use fingertip::wrench::ContactForce;
use fingertip::{GripStage, SlipStage};
use serde::Deserialize;

use super::fault::SceneProblem;

#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Model {
    #[default]
    Point,
}

#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct ContactSection {
    model: Model,
    #[serde(rename = "least_force_N")]
    least_force: f64,
    #[serde(rename = "greatest_gap_m")]
    greatest_gap: f64,
    greatest_friction_ratio: Option<f64>,
}

impl ContactSection {
    pub(super) fn model(&self) -> Result<PointContact<f64>, BadShape> {
        match self.model {
            Model::Point => PointContact::new(self.least_force)
                .and_then(|model| model.accepting_gap(self.greatest_gap))
                .and_then(|model| match self.greatest_friction_ratio {
                    Some(ratio) => model.with_greatest_friction(ratio),
                    None => Ok(model),
                }),
        }
    }
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct FrictionSection {
    static_coefficient: f64,
}

/// Coulomb friction, where the scene knows the coefficient.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Friction(Option<Coulomb<f64>>);

impl Friction {
    pub(crate) fn known(model: Coulomb<f64>) -> Self {
        Self(Some(model))
    }

    pub(super) fn from_section(section: Option<&FrictionSection>) -> Result<Self, BadParameter> {
        let model = section.map(|section| Coulomb::new(section.static_coefficient));
        Ok(Self(model.transpose()?))
    }

    pub(crate) fn coefficient(&self) -> Option<f64> {
        self.0.map(|model| model.coefficient())
    }
}

impl GripStage<f64> for Friction {
    type Reading = Option<SlipMargin<f64>>;

    #[inline]
    fn judge(&self, force: &ContactForce<f64>) -> Self::Reading {
        self.0.map(|model| model.slip_margin(force))
    }
}

#[derive(Clone, Debug, Deserialize)]
#[serde(tag = "detector", rename_all = "snake_case", deny_unknown_fields)]
pub(super) enum SlipSection {
    Drop {
        #[serde(rename = "noise_N")]
        noise: f64,
    },
    Threshold {
        #[serde(rename = "noise_N")]
        noise: f64,
        #[serde(default = "usual_warning_share")]
        warning_share: f64,
    },
}

const fn usual_warning_share() -> f64 {
    0.8
}

/// The slip detector that the scene names, if any. The choice costs one predictable branch per
/// sample.
#[derive(Clone, Copy, Debug)]
pub(crate) enum SlipWatch {
    Off,
    Drop(DropDetector<f64>),
    Threshold(RatioThreshold<f64>),
}

impl SlipWatch {
    pub(super) fn from_section(
        section: Option<&SlipSection>,
        friction: Friction,
    ) -> Result<Self, SceneProblem> {
        Ok(match section {
            None => Self::Off,
            Some(SlipSection::Drop { noise }) => {
                Self::Drop(DropDetector::new(ForceNoise::isotropic(*noise)?)?)
            }
            Some(SlipSection::Threshold { noise, warning_share }) => {
                let coefficient = friction.coefficient().ok_or(SceneProblem::NoFriction)?;
                let gate = NormalForceGate::from_noise(&ForceNoise::isotropic(*noise)?);
                Self::Threshold(RatioThreshold::new(gate, coefficient, *warning_share)?)
            }
        })
    }
}

impl SlipWatch {
    /// Watches for sudden falls of the friction ratio.
    pub(super) const fn falls(detector: DropDetector<f64>) -> Self {
        Self::Drop(detector)
    }

    /// Whether anything is watched for.
    pub(crate) const fn is_on(&self) -> bool {
        !matches!(self, Self::Off)
    }

    /// Forgets what was seen, as after a gap in the recording.
    pub(crate) fn reset(&mut self) {
        match self {
            Self::Off => {}
            Self::Drop(detector) => SlipDetector::<f64>::reset(detector),
            Self::Threshold(detector) => SlipDetector::<f64>::reset(detector),
        }
    }
}

impl SlipStage<f64> for SlipWatch {
    type Verdict = Option<SlipVerdict>;

    #[inline]
    fn follow(&mut self, force: Option<&ContactForce<f64>>, time_step: f64) -> Self::Verdict {
        let detector: &mut dyn SlipDetector<f64> = match self {
            Self::Off => return None,
            Self::Drop(detector) => detector,
            Self::Threshold(detector) => detector,
        };
        Some(match force {
            Some(force) => detector.update(force, time_step),
            None => detector.update_open(time_step),
        })
    }
}
