//! `[friction]`: how much the contact can hold.

use fingertip::GripStage;
use fingertip::friction::{
    AnisotropicCoulomb, BadParameter, Coulomb, ForceNoise, FrictionModel, LoadDependentLimit, PowerLimit,
    PressureDistribution, SlipMargin, SoftFingerLimit, UncertainCoulomb,
};
use fingertip::wrench::{ContactForce, Real};
use nalgebra::Vector3;
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize};

use crate::fault::SceneProblem;
use crate::lent::lent;

/// `[friction]` of a scene: Coulomb's limit unless `limit` names another.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(transparent)]
pub(crate) struct FrictionSection(LimitSection);

impl<'de> Deserialize<'de> for FrictionSection {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let mut table = toml::Table::deserialize(deserializer)?;
        table.entry("limit").or_insert_with(|| "coulomb".into());
        table.try_into().map(Self).map_err(|error: toml::de::Error| D::Error::custom(error.message()))
    }
}

/// Each variant is a limit by its name in the file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "limit", rename_all = "snake_case", deny_unknown_fields)]
enum LimitSection {
    Coulomb {
        static_coefficient: f64,
    },
    /// One coefficient along the grain, another across it, on a flat surface.
    Anisotropic {
        /// In the surface's frame.
        grain: [f64; 3],
        coefficient_along: f64,
        coefficient_across: f64,
    },
    SoftFinger {
        static_coefficient: f64,
        /// Greatest spin torque over greatest tangential force.
        torque_arm_m: f64,
        #[serde(default)]
        conservative: bool,
    },
    Power {
        static_coefficient: f64,
        patch_radius_m: f64,
        pressure: Pressure,
    },
    LoadDependent {
        static_coefficient: f64,
        torque_arm_m: f64,
        #[serde(rename = "reference_force_N")]
        reference: f64,
        growth_exponent: f64,
    },
    Uncertain {
        static_coefficient: f64,
        deviation: f64,
        #[serde(rename = "noise_N", default, skip_serializing_if = "Option::is_none")]
        noise: Option<f64>,
        /// The coefficient that margins and grip count with is undercut with this probability.
        #[serde(default = "usual_probability")]
        probability: f64,
    },
}

const fn usual_probability() -> f64 {
    0.01
}

/// How the pressure is spread over the patch, by its name in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Pressure {
    Uniform,
    Hertz,
    Winkler,
}

impl Pressure {
    const fn distribution(self) -> PressureDistribution {
        match self {
            Self::Uniform => PressureDistribution::Uniform,
            Self::Hertz => PressureDistribution::Hertz,
            Self::Winkler => PressureDistribution::Winkler,
        }
    }
}

impl FrictionSection {
    /// The limit. `flat` is the outward normal of the surface if that is flat, and `turn` takes directions from
    /// the surface's frame to the sensor's.
    pub(crate) fn build<T: Real>(
        &self,
        flat: Option<Vector3<f64>>,
        turn: impl Fn(&Vector3<f64>) -> Vector3<f64>,
    ) -> Result<Limit<T>, SceneProblem> {
        let number = T::literal;
        Ok(match self.0 {
            LimitSection::Coulomb { static_coefficient } => {
                Limit::Coulomb(Coulomb::new(number(static_coefficient))?)
            }
            LimitSection::Anisotropic { grain, coefficient_along, coefficient_across } => {
                let normal = flat.ok_or(SceneProblem::Misplaced {
                    section: "friction",
                    key: "grain",
                    belongs: "the shapes \"plane\", \"disk\" and \"rectangle\"",
                })?;
                let grain = turn(&Vector3::from(grain));
                let along = (grain - normal * grain.dot(&normal))
                    .try_normalize(grain.norm() * 1e-6)
                    .filter(|along| along.iter().all(|x| x.is_finite()))
                    .ok_or(SceneProblem::Grain)?;
                let directions = [along, normal.cross(&along)].map(|v| v.map(number));
                let coefficients = [coefficient_along, coefficient_across].map(number);
                Limit::Anisotropic(AnisotropicCoulomb::new(directions, coefficients)?)
            }
            LimitSection::SoftFinger { static_coefficient, torque_arm_m, conservative } => {
                let make = if conservative { SoftFingerLimit::conservative } else { SoftFingerLimit::new };
                Limit::SoftFinger(make(number(static_coefficient), number(torque_arm_m))?)
            }
            LimitSection::Power { static_coefficient, patch_radius_m, pressure } => {
                let (coefficient, radius) = (number(static_coefficient), number(patch_radius_m));
                Limit::Power(PowerLimit::for_patch(coefficient, radius, pressure.distribution())?)
            }
            LimitSection::LoadDependent { static_coefficient, torque_arm_m, reference, growth_exponent } => {
                Limit::LoadDependent(LoadDependentLimit::new(
                    number(static_coefficient),
                    number(torque_arm_m),
                    number(reference),
                    number(growth_exponent),
                )?)
            }
            LimitSection::Uncertain { static_coefficient, deviation, noise, probability } => {
                let noise = noise.map(|noise| ForceNoise::isotropic(number(noise))).transpose()?;
                let model = UncertainCoulomb::new(number(static_coefficient), number(deviation), noise)?;
                if !(probability > 0.0 && probability < 0.5) {
                    let requirement = "between 0 and 0.5";
                    return Err(BadParameter { parameter: "probability", requirement }.into());
                }
                let cautious = Coulomb::new(model.quantile(probability)).map_err(|bad| BadParameter {
                    parameter: "friction coefficient less its deviation, by `probability`,",
                    ..bad
                })?;
                Limit::Uncertain { model, cautious }
            }
        })
    }
}

/// Any of the friction limits, chosen at run time.
///
/// ```
/// # const BALL: &str = "version = 2\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"sphere\"\nradius_m = 0.013\n";
/// use fingertip::friction::FrictionModel;
/// use fingertip::wrench::ContactForce;
/// use fingertip_scene::{Limit, Scene};
/// use nalgebra::Vector3;
///
/// let scene = Scene::from_text(&format!("{BALL}[friction]\nstatic_coefficient = 0.5\n"))?;
/// let limit = scene.limit().ok_or("friction")?;
/// assert!(matches!(limit, Limit::Coulomb(_)) && limit.coefficient() == 0.5);
/// let force = ContactForce::new(2.0, Vector3::new(0.6, 0.0, 0.0), 0.0);
/// assert!((limit.slip_margin(&force).utilisation - 0.6).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Limit<T: Real> {
    /// One coefficient in all directions.
    Coulomb(Coulomb<T>),
    /// Two coefficients, along two directions of a flat surface.
    Anisotropic(AnisotropicCoulomb<T>),
    /// Tangential force and spin torque together, within an ellipse or a rhombus.
    SoftFinger(SoftFingerLimit<T>),
    /// The same for a pressure that is known.
    Power(PowerLimit<T>),
    /// The same for a patch that grows with the force.
    LoadDependent(LoadDependentLimit<T>),
    /// A coefficient with a standard deviation; margins and grip count with one that is undercut seldom.
    Uncertain {
        /// What is known of the friction.
        model: UncertainCoulomb<T>,
        /// With the coefficient that is undercut seldom.
        cautious: Coulomb<T>,
    },
}

macro_rules! each_limit {
    ($of:expr, $limit:ident => $call:expr) => {
        match $of {
            Limit::Coulomb($limit) => $call,
            Limit::Anisotropic($limit) => $call,
            Limit::SoftFinger($limit) => $call,
            Limit::Power($limit) => $call,
            Limit::LoadDependent($limit) => $call,
            Limit::Uncertain { cautious: $limit, .. } => $call,
        }
    };
}

impl<T: Real> FrictionModel<T> for Limit<T> {
    #[inline]
    fn slip_margin(&self, force: &ContactForce<T>) -> SlipMargin<T> {
        each_limit!(self, limit => limit.slip_margin(force))
    }

    #[inline]
    fn least_normal_force(&self, force: &ContactForce<T>, safety: T) -> T {
        each_limit!(self, limit => limit.least_normal_force(force, safety))
    }
}

impl<T: Real> Limit<T> {
    /// The static coefficient; the lowest where it depends on the direction.
    #[must_use]
    pub fn coefficient(&self) -> T {
        match self {
            Self::Coulomb(limit) => limit.coefficient(),
            Self::Anisotropic(limit) => limit.coefficients()[0],
            Self::SoftFinger(limit) => limit.coefficient(),
            Self::Power(limit) => limit.coefficient(),
            Self::LoadDependent(limit) => limit.coefficient(),
            Self::Uncertain { model, .. } => model.coefficient(),
        }
    }

    /// The probability that the contact slips, where the friction is known with a deviation.
    #[must_use]
    pub fn slip_probability(&self, force: &ContactForce<T>) -> Option<T> {
        match self {
            Self::Uncertain { model, .. } => Some(model.slip_probability(force)),
            _ => None,
        }
    }
}

/// The friction of a scene that may know none.
///
/// ```
/// use fingertip::GripStage;
/// use fingertip::wrench::ContactForce;
/// use fingertip_scene::Friction;
/// use nalgebra::Vector3;
///
/// // A scene without [friction] judges nothing.
/// let force = ContactForce::new(2.0, Vector3::new(0.6, 0.0, 0.0), 0.0);
/// assert_eq!(Friction::<f64>(None).judge(&force), None);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction<T: Real>(pub Option<Limit<T>>);

impl<T: Real> GripStage<T> for Friction<T> {
    type Reading = Option<SlipMargin<T>>;

    // The commonest within the caller: what a call returns in memory is waited for (see `stages`).
    #[inline(always)]
    fn judge(&self, force: &ContactForce<T>) -> Self::Reading {
        Some(match self.0.as_ref()? {
            Limit::Coulomb(limit) => limit.slip_margin(force),
            Limit::SoftFinger(limit) => limit.slip_margin(force),
            other => other.slip_margin(&lent(force)),
        })
    }

    #[inline]
    fn margin(reading: &Self::Reading) -> Option<SlipMargin<T>> {
        *reading
    }
}
