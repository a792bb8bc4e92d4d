//! `[estimate]`: friction that is learnt from slips.

use fingertip::friction::{
    BadParameter, ForceNoise, FrictionEstimate, KineticFriction, SlipVerdict, StaticFriction,
};
use fingertip::wrench::{ContactForce, Real};
use serde::{Deserialize, Serialize};

/// `[estimate]` of a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct EstimateSection {
    #[serde(rename = "noise_N")]
    noise: f64,
    /// Relative scatter of break-away on one surface.
    #[serde(default = "usual_scatter")]
    scatter: f64,
    /// Relative change of the surface from one slip to the next.
    #[serde(default = "usual_wander")]
    wander: f64,
    /// Over how long a slide is averaged.
    #[serde(default = "usual_memory")]
    memory_s: f64,
    /// For so long after a slip begins the fingertip is taken to slide.
    #[serde(default = "usual_slide")]
    slide_s: f64,
}

const fn usual_scatter() -> f64 {
    0.05
}
const fn usual_wander() -> f64 {
    0.01
}
const fn usual_memory() -> f64 {
    0.1
}

const fn usual_slide() -> f64 {
    0.05
}

impl EstimateSection {
    pub(crate) fn build<T: Real>(&self) -> Result<Estimate<T>, BadParameter> {
        let noise = ForceNoise::isotropic(T::literal(self.noise))?;
        let at_rest = StaticFriction::new(noise, T::literal(self.scatter), T::literal(self.wander))?;
        let sliding = KineticFriction::new(noise, T::literal(self.memory_s))?;
        if !(self.slide_s > 0.0 && self.slide_s.is_finite()) {
            return Err(BadParameter {
                parameter: "`slide_s` of [estimate]",
                requirement: "positive and finite",
            });
        }
        Ok(Estimate { at_rest, sliding, slide: T::literal(self.slide_s), left: T::zero() })
    }
}

/// Learns both coefficients: the static one from the peak before each slip, the kinetic one for a while from there
/// on, for which the fingertip is taken to slide.
///
/// ```
/// # const BALL: &str = "version = 2\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"sphere\"\nradius_m = 0.013\n";
/// use fingertip_scene::Scene;
///
/// // It needs a detector that tells when it slips.
/// let slip = "[slip]\ndetector = \"drop\"\nnoise_N = 0.01\n";
/// let scene = Scene::from_text(&format!("{BALL}{slip}[estimate]\nnoise_N = 0.01\n"))?;
/// assert!(scene.tells().friction);
/// let refused = Scene::from_text(&format!("{BALL}[estimate]\nnoise_N = 0.01\n")).unwrap_err();
/// assert!(refused.to_string().contains("[slip]"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate<T: Real> {
    at_rest: StaticFriction<T>,
    sliding: KineticFriction<T>,
    /// How long a slide is taken to last, and how long this one still does \[s\].
    slide: T,
    left: T,
}

/// What is known of the friction so far.
///
/// ```
/// # const BALL: &str = "version = 2\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"sphere\"\nradius_m = 0.013\n";
/// use fingertip::wrench::Wrench;
/// use fingertip_scene::Scene;
/// use nalgebra::Vector3;
///
/// let rest = "[slip]\ndetector = \"drop\"\nnoise_N = 0.005\n[estimate]\nnoise_N = 0.005\n";
/// let mut pipeline = Scene::from_text(&format!("{BALL}{rest}"))?.pipeline();
/// // It is pushed aside more and more, holds up to 0.6 of the normal force, and slips at 0.4.
/// for sample in 0..500 {
///     let ratio = if sample < 400 { 0.0015 * f64::from(sample) } else { 0.4 };
///     let push = Vector3::new(2.0 * ratio, 0.0, -2.0);
///     pipeline.sense(Wrench::from_force_at(&Vector3::new(0.0, 0.0, 0.013), push), 1e-3);
/// }
/// let learnt = pipeline.felt().friction.ok_or("it learns")?;
/// let at_rest = learnt.at_rest.ok_or("it slipped once")?;
/// assert!((at_rest.coefficient - 0.6).abs() < 0.02, "{at_rest:?}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound(serialize = "T: Serialize", deserialize = "T: Deserialize<'de>"))]
pub struct Learnt<T: Real> {
    /// The static coefficient; `None` before the first slip.
    pub at_rest: Option<FrictionEstimate<T>>,
    /// The kinetic coefficient; `None` before the first slide.
    pub sliding: Option<FrictionEstimate<T>>,
}

impl<T: Real> Estimate<T> {
    /// Takes a sample and what the slip detector said of it.
    pub(crate) fn follow(
        &mut self,
        force: Option<&ContactForce<T>>,
        slip: Option<SlipVerdict>,
        time_step: T,
    ) {
        let slips = slip == Some(SlipVerdict::Slipping);
        self.left = if slips { self.slide } else { self.left - time_step };
        match force {
            Some(force) if self.left > T::zero() => {
                // Without enough samples before it, as within a slide, a slip teaches nothing.
                if slips {
                    let _ = self.at_rest.onset();
                }
                self.sliding.observe(force, time_step);
            }
            Some(force) => self.at_rest.observe(force),
            None => self.left = T::zero(),
        }
    }

    /// What is known so far.
    #[must_use]
    pub fn learnt(&self) -> Learnt<T> {
        Learnt { at_rest: self.at_rest.estimate(), sliding: self.sliding.estimate() }
    }

    /// Forgets the surface.
    pub(crate) fn reset(&mut self) {
        self.at_rest.reset();
        self.sliding.reset();
        self.left = T::zero();
    }
}
