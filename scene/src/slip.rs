//! `[slip]`: what watches for slip.

use fingertip::SlipStage;
use fingertip::friction::{
    AdaptiveDropDetector, Cusum, DropDetector, ForceNoise, LikelihoodRatioDetector, NormalForceGate,
    RatioThreshold, SlipDetector, SlipVerdict, StickSlip, StickSlipDetector,
};
use fingertip::wrench::{ContactForce, Real};
use serde::{Deserialize, Serialize};

use crate::fault::SceneProblem;
use crate::lent::lent;

/// How many samples the likelihood ratio looks back over.
pub(crate) const WINDOW: usize = 32;
/// The allowance of a cumulative sum whose false alarms are given.
pub(crate) const ALLOWANCE: f64 = 0.75;

/// `[slip]` of a scene: each variant is a detector by its name in the file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "detector", rename_all = "snake_case", deny_unknown_fields)]
pub(crate) enum SlipSection {
    Drop {
        #[serde(rename = "noise_N")]
        noise: f64,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        false_alarms_per_minute: Option<f64>,
    },
    Threshold {
        #[serde(rename = "noise_N")]
        noise: f64,
        #[serde(default = "usual_warning_share")]
        warning_share: f64,
    },
    LikelihoodRatio {
        #[serde(rename = "noise_N")]
        noise: f64,
        #[serde(default = "one")]
        false_alarms_per_minute: f64,
    },
    StickSlip {
        #[serde(rename = "noise_N")]
        noise: f64,
    },
    AdaptiveDrop {
        #[serde(rename = "noise_N")]
        noise: f64,
        #[serde(default = "one")]
        false_alarms_per_minute: f64,
    },
}

const fn usual_warning_share() -> f64 {
    0.8
}
const fn one() -> f64 {
    1.0
}

impl SlipSection {
    /// The detector; `coefficient` is that of `[friction]`.
    pub(crate) fn build<T: Real>(
        &self,
        coefficient: Option<T>,
        sample_rate: Option<f64>,
    ) -> Result<Detector<T>, SceneProblem> {
        let noise_of = |noise: f64| ForceNoise::isotropic(T::literal(noise));
        let rate = sample_rate.ok_or(SceneProblem::Needs {
            what: "`false_alarms_per_minute` of [slip]",
            needed: "`sample_rate_Hz` in [input]",
        });
        Ok(match *self {
            Self::Drop { noise, false_alarms_per_minute: None } => {
                Detector::Drop(DropDetector::new(noise_of(noise)?)?)
            }
            Self::Drop { noise, false_alarms_per_minute: Some(alarms) } => {
                let sum = Cusum::for_false_alarms(T::literal(ALLOWANCE), alarms, rate?)?;
                Detector::Drop(DropDetector::with_sum(noise_of(noise)?, sum)?)
            }
            Self::Threshold { noise, warning_share } => {
                let coefficient = coefficient.ok_or(SceneProblem::Needs {
                    what: "the `threshold` detector",
                    needed: "the section [friction] with `static_coefficient`",
                })?;
                let gate = NormalForceGate::from_noise(&noise_of(noise)?);
                Detector::Threshold(
                    RatioThreshold::new(gate, coefficient)?.with_warning_share(T::literal(warning_share))?,
                )
            }
            Self::LikelihoodRatio { noise, false_alarms_per_minute } => {
                let rate = sample_rate.ok_or(SceneProblem::Needs {
                    what: "the `likelihood_ratio` detector",
                    needed: "`sample_rate_Hz` in [input]",
                })?;
                let detector = LikelihoodRatioDetector::new(noise_of(noise)?, false_alarms_per_minute, rate)?;
                Detector::LikelihoodRatio(Box::new(detector))
            }
            Self::AdaptiveDrop { noise, false_alarms_per_minute } => {
                let rate = sample_rate.ok_or(SceneProblem::Needs {
                    what: "the `adaptive_drop` detector",
                    needed: "`sample_rate_Hz` in [input]",
                })?;
                let detector = AdaptiveDropDetector::new(noise_of(noise)?, false_alarms_per_minute, rate)?;
                Detector::AdaptiveDrop(Box::new(detector))
            }
            Self::StickSlip { noise } => {
                Detector::StickSlip(StickSlipDetector::new(DropDetector::new(noise_of(noise)?)?))
            }
        })
    }
}

/// Any of the slip detectors, chosen at run time.
///
/// ```
/// # const BALL: &str = "version = 2\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"sphere\"\nradius_m = 0.013\n";
/// use fingertip_scene::{Detector, Scene};
///
/// let scene = Scene::from_text(&format!("{BALL}[slip]\ndetector = \"drop\"\nnoise_N = 0.01\n"))?;
/// assert!(matches!(scene.pipeline().detector(), Some(Detector::Drop(_))));
/// assert!(Scene::from_text(BALL)?.pipeline().detector().is_none());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum Detector<T: Real> {
    /// A sudden fall of the friction ratio.
    Drop(DropDetector<T>),
    /// The friction ratio passes a known coefficient.
    Threshold(RatioThreshold<T>),
    /// A fall of unknown size.
    LikelihoodRatio(Box<LikelihoodRatioDetector<T, WINDOW>>),
    /// Falls that come again and again.
    StickSlip(StickSlipDetector<T>),
    /// A sudden fall, in noise that is learnt.
    AdaptiveDrop(Box<AdaptiveDropDetector<T>>),
}

macro_rules! each_detector {
    ($of:expr, $detector:ident => $call:expr) => {
        match $of {
            Detector::Drop($detector) => $call,
            Detector::Threshold($detector) => $call,
            Detector::LikelihoodRatio(boxed) => {
                let $detector = &mut **boxed;
                $call
            }
            Detector::StickSlip($detector) => $call,
            Detector::AdaptiveDrop(boxed) => {
                let $detector = &mut **boxed;
                $call
            }
        }
    };
}

impl<T: Real> SlipDetector<T> for Detector<T> {
    #[inline(never)]
    fn update(&mut self, force: &ContactForce<T>, time_step: T) -> SlipVerdict {
        each_detector!(self, detector => detector.update(force, time_step))
    }

    #[inline(never)]
    fn update_open(&mut self, time_step: T) -> SlipVerdict {
        each_detector!(self, detector => detector.update_open(time_step))
    }

    fn reset(&mut self) {
        each_detector!(self, detector => SlipDetector::<T>::reset(detector));
    }
}

/// The slip detector of a scene that may have none.
///
/// ```
/// use fingertip::SlipStage;
/// use fingertip_scene::SlipWatch;
///
/// // A scene without [slip] watches nothing.
/// let mut watch = SlipWatch::<f64>(None);
/// assert_eq!(watch.follow(None, 1e-3), None);
/// assert_eq!(watch.stick_slip(), None);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct SlipWatch<T: Real>(pub Option<Detector<T>>);

impl<T: Real> SlipWatch<T> {
    /// Forgets what was seen, as after a gap in a recording.
    pub fn reset(&mut self) {
        if let Some(detector) = &mut self.0 {
            detector.reset();
        }
    }

    /// The stick-slip motion that goes on, where it is looked for.
    #[must_use]
    pub fn stick_slip(&self) -> Option<StickSlip<T>> {
        match &self.0 {
            Some(Detector::StickSlip(detector)) => detector.motion(),
            _ => None,
        }
    }
}

impl<T: Real> SlipStage<T> for SlipWatch<T> {
    type Verdict = Option<SlipVerdict>;

    // Nothing is called where nothing watches.
    #[inline(always)]
    fn follow(&mut self, force: Option<&ContactForce<T>>, time_step: T) -> Self::Verdict {
        let detector = self.0.as_mut()?;
        Some(match force {
            Some(force) => detector.update(&lent(force), time_step),
            None => detector.update_open(time_step),
        })
    }

    #[inline]
    fn slip(verdict: &Self::Verdict) -> Option<SlipVerdict> {
        *verdict
    }
}
