//! `[contact.skin]`: a soft cover, and how it gives way.

use fingertip::contact::{
    Contact, Hertz, Indentation, IndentationSlope, LinearStiffness, LocalHertz, PowerLaw, SkinLaw, Tabulated,
    contact_modulus,
};
use fingertip::surfaces::{BadShape, SmoothSurface};
use fingertip::wrench::Real;
use serde::{Deserialize, Serialize};

/// `[contact.skin]` of a scene: each variant is a law by its name in the file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "law", rename_all = "snake_case", deny_unknown_fields)]
pub(crate) enum SkinSection {
    Linear {
        #[serde(rename = "stiffness_N_per_m")]
        stiffness: f64,
        radius_m: f64,
    },
    Power {
        #[serde(rename = "patch_at_1_N_m")]
        patch: f64,
        patch_exponent: f64,
        #[serde(rename = "depth_at_1_N_m")]
        depth: f64,
        depth_exponent: f64,
    },
    Hertz {
        radii_m: [f64; 2],
        #[serde(rename = "young_moduli_Pa")]
        young: [f64; 2],
        poisson_ratios: [f64; 2],
    },
    LocalHertz {
        #[serde(default)]
        object_curvature_per_m: f64,
        largest_radius_m: f64,
        #[serde(rename = "young_moduli_Pa")]
        young: [f64; 2],
        poisson_ratios: [f64; 2],
    },
    Table {
        #[serde(rename = "force_depth_patch_N_m_m")]
        points: Vec<[f64; 3]>,
    },
}

impl SkinSection {
    pub(crate) fn build<T: Real>(&self) -> Result<Skin<T>, BadShape> {
        let number = T::literal;
        let modulus =
            |young: [f64; 2], poisson: [f64; 2]| contact_modulus(young.map(number), poisson.map(number));
        Ok(match self {
            Self::Linear { stiffness, radius_m } => {
                Skin::Linear(LinearStiffness::new(number(*stiffness), number(*radius_m))?)
            }
            Self::Power { patch, patch_exponent, depth, depth_exponent } => Skin::Power(PowerLaw::new(
                [*patch, *patch_exponent].map(number),
                [*depth, *depth_exponent].map(number),
            )?),
            Self::Hertz { radii_m, young, poisson_ratios } => {
                Skin::Hertz(Hertz::new(radii_m.map(number), modulus(*young, *poisson_ratios)?)?)
            }
            Self::LocalHertz { object_curvature_per_m, largest_radius_m, young, poisson_ratios } => {
                let modulus = modulus(*young, *poisson_ratios)?;
                let curvature = number(*object_curvature_per_m);
                Skin::LocalHertz(LocalHertz::new(modulus, curvature, number(*largest_radius_m))?)
            }
            Self::Table { points } => {
                Skin::Table(Tabulated::new(points.iter().map(|point| point.map(number)).collect())?)
            }
        })
    }
}

/// Any of the laws of a skin, chosen at run time.
///
/// ```
/// # const BALL: &str = "version = 2\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"sphere\"\nradius_m = 0.013\n";
/// use fingertip::wrench::Wrench;
/// use fingertip_scene::{Model, Scene, Skin};
/// use nalgebra::Vector3;
///
/// let skin = "[contact.skin]\nlaw = \"linear\"\nstiffness_N_per_m = 4000.0\nradius_m = 0.013\n";
/// let mut pipeline = Scene::from_text(&format!("{BALL}{skin}"))?.pipeline();
/// assert!(matches!(pipeline.model(), Model::PointUnderSkin(_)));
/// // 2 N press the skin in by half a millimetre.
/// let push = Wrench::from_force_at(&Vector3::new(0.0, 0.0, 0.013), Vector3::new(0.0, 0.0, -2.0));
/// let contact = *pipeline.sense(push, 1e-3).contact().ok_or("a contact")?;
/// assert!((contact.point.z - 0.0125).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum Skin<T: Real> {
    /// Depth in proportion to the force.
    Linear(LinearStiffness<T>),
    /// Depth and patch as powers of the force.
    Power(PowerLaw<T>),
    /// An elastic body of the same curvature everywhere.
    Hertz(Hertz<T>),
    /// An elastic body with the curvature that the surface has where it touches.
    LocalHertz(LocalHertz<T>),
    /// Measured points.
    Table(Tabulated<T, Vec<[T; 3]>>),
}

macro_rules! each_law {
    ($skin:expr, $law:ident => $call:expr) => {
        match $skin {
            Skin::Linear($law) => $call,
            Skin::Power($law) => $call,
            Skin::Hertz($law) => $call,
            Skin::LocalHertz($law) => $call,
            Skin::Table($law) => $call,
        }
    };
}

impl<T: Real, S: SmoothSurface<T>> SkinLaw<T, S> for Skin<T> {
    #[inline]
    fn indentation_at(&self, surface: &S, contact: &Contact<T>, normal_force: T) -> Indentation<T> {
        each_law!(self, law => law.indentation_at(surface, contact, normal_force))
    }

    #[inline]
    fn slope_at(&self, surface: &S, contact: &Contact<T>, normal_force: T) -> IndentationSlope<T> {
        each_law!(self, law => law.slope_at(surface, contact, normal_force))
    }
}
