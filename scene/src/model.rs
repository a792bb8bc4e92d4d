//! `[contact]`: what a contact can transmit.

use fingertip::contact::{
    Auto, Choice, Compliant, Contact, ContactJacobian, ContactModel, PointContact, Resolution, SoftFinger,
};
use fingertip::surfaces::{BadShape, DynSurface, SmoothSurface};
use fingertip::wrench::{ContactForce, Real, Wrench};
use nalgebra::{Matrix6, Vector3};
use serde::{Deserialize, Serialize};

use crate::fault::SceneProblem;
use crate::skin::{Skin, SkinSection};

/// A contact model by its name in a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum ModelName {
    #[default]
    Point,
    SoftFinger,
    Auto,
}

/// `[contact]` of a scene.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct ContactSection {
    model: ModelName,
    #[serde(rename = "least_force_N")]
    least_force: f64,
    /// In place of that, standard deviations of a force component in the rest.
    #[serde(skip_serializing_if = "Option::is_none")]
    least_force_deviations: Option<f64>,
    greatest_gap_m: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    greatest_friction_ratio: Option<f64>,
    /// By which a spin torque counts as a tangential force.
    #[serde(skip_serializing_if = "Option::is_none")]
    torque_arm_m: Option<f64>,
    /// So much torque along a force may be noise.
    #[serde(rename = "spin_noise_Nm", skip_serializing_if = "Option::is_none")]
    spin_noise: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    greatest_pitch_m: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pitch_deviations: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    skin_share: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    skin: Option<SkinSection>,
}

/// No force is a contact \[N\].
const UNREACHABLE: f64 = 1e15;

impl ContactSection {
    /// Whether the least force is told by the noise of the rest.
    pub(crate) const fn awaits_noise(&self) -> bool {
        self.least_force_deviations.is_some()
    }

    /// With the least force that this noise of a force component asks for \[N\]; none yet: no force is a contact.
    pub(crate) fn at_noise(&self, force_noise: Option<f64>) -> Self {
        let least_force = match (self.least_force_deviations, force_noise) {
            (_, None) => UNREACHABLE,
            (Some(deviations), Some(noise)) => deviations * noise,
            (None, Some(_)) => self.least_force,
        };
        Self { least_force, least_force_deviations: None, ..self.clone() }
    }

    /// Smaller forces are no contact \[N\].
    pub(crate) const fn least_force(&self) -> f64 {
        self.least_force
    }

    fn point<T: Real>(&self) -> Result<PointContact<T>, BadShape> {
        PointContact::new(T::literal(self.least_force))
            .and_then(|model| model.with_greatest_gap(T::literal(self.greatest_gap_m)))
            .and_then(|model| match self.greatest_friction_ratio {
                Some(ratio) => model.with_greatest_friction(T::literal(ratio)),
                None => Ok(model),
            })
    }

    fn soft_finger<T: Real>(&self) -> Result<SoftFinger<T>, BadShape> {
        let mut model = SoftFinger::new(T::literal(self.least_force))?;
        if let Some(ratio) = self.greatest_friction_ratio {
            model = model.with_greatest_friction(T::literal(ratio))?;
        }
        if let Some(noise) = self.spin_noise {
            model = model.with_torque_noise(T::literal(noise))?;
        }
        match self.torque_arm_m {
            Some(arm) => model.with_torque_arm(T::literal(arm)),
            None => Ok(model),
        }
    }

    fn auto<T: Real>(&self, noise: Matrix6<T>) -> Result<Auto<T>, BadShape> {
        let auto = Auto::new(self.point()?, self.soft_finger()?, noise)?;
        match self.greatest_pitch_m {
            Some(pitch) => {
                let deviations = self.pitch_deviations.unwrap_or(USUAL_DEVIATIONS);
                auto.with_greatest_pitch(T::literal(pitch), T::literal(deviations))
            }
            None => Ok(auto),
        }
    }

    fn under_skin<T: Real, M>(&self, rigid: M, skin: Skin<T>) -> Result<Compliant<T, M, Skin<T>>, BadShape> {
        let model = Compliant::new(rigid, skin);
        match self.skin_share {
            Some(share) => model.with_share(T::literal(share)),
            None => Ok(model),
        }
    }

    /// The model; `noise` is the covariance of a wrench at rest.
    pub(crate) fn build<T: Real>(&self, noise: Option<Matrix6<T>>) -> Result<Model<T>, SceneProblem> {
        self.check_keys()?;
        let skin = self.skin.as_ref().map(SkinSection::build).transpose()?;
        Ok(match (self.model, skin) {
            (ModelName::Point, None) => Model::Point(self.point()?),
            (ModelName::SoftFinger, None) => Model::SoftFinger(self.soft_finger()?),
            (ModelName::Point, Some(skin)) => {
                Model::PointUnderSkin(Box::new(self.under_skin(self.point()?, skin)?))
            }
            (ModelName::SoftFinger, Some(skin)) => {
                Model::SoftFingerUnderSkin(Box::new(self.under_skin(self.soft_finger()?, skin)?))
            }
            (ModelName::Auto, _) => {
                let noise = noise.ok_or(SceneProblem::Needs {
                    what: "`model = \"auto\"` of [contact]",
                    needed: "the section [uncertainty] with `force_noise_N` and `torque_noise_Nm`",
                })?;
                Model::Auto(Box::new(self.auto(noise)?))
            }
        })
    }

    /// That no key is given which the model does not know.
    fn check_keys(&self) -> Result<(), SceneProblem> {
        let point = self.model != ModelName::SoftFinger;
        let auto = self.model == ModelName::Auto;
        if self.least_force_deviations.is_some_and(|deviations| !(deviations > 0.0 && deviations < 1e6)) {
            let (key, section) = ("least_force_deviations", "contact");
            return Err(SceneProblem::Range { key, section, requirement: "positive and below a million" });
        }
        let checks = [
            (
                "least_force_N",
                self.least_force > 0.0 && self.least_force_deviations.is_some(),
                "a contact without `least_force_deviations`",
            ),
            ("greatest_gap_m", self.greatest_gap_m > 0.0 && !point, "the point contact"),
            (
                "torque_arm_m",
                self.torque_arm_m.is_some()
                    && (self.model == ModelName::Point || self.greatest_friction_ratio.is_none()),
                "a soft finger with `greatest_friction_ratio`",
            ),
            (
                "spin_noise_Nm",
                self.spin_noise.is_some() && self.model == ModelName::Point,
                "the models \"soft_finger\" and \"auto\"",
            ),
            ("greatest_pitch_m", self.greatest_pitch_m.is_some() && !auto, "the model \"auto\""),
            (
                "pitch_deviations",
                self.pitch_deviations.is_some() && self.greatest_pitch_m.is_none(),
                "`greatest_pitch_m`",
            ),
            ("skin_share", self.skin_share.is_some() && self.skin.is_none(), "a [contact.skin]"),
            ("skin", self.skin.is_some() && auto, "the models \"point\" and \"soft_finger\""),
        ];
        match checks.into_iter().find(|(_, wrong, _)| *wrong) {
            Some((key, _, belongs)) => Err(SceneProblem::Misplaced { section: "contact", key, belongs }),
            None => Ok(()),
        }
    }
}

/// By how many standard deviations a pitch must be too large.
pub(crate) const USUAL_DEVIATIONS: f64 = 3.0;

/// Any of the contact models, chosen at run time.
///
/// ```
/// # const BALL: &str = "version = 2\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"sphere\"\nradius_m = 0.013\n";
/// use fingertip_scene::{Model, Scene};
///
/// let model = |rest: &str| -> Result<Model<f64>, Box<dyn std::error::Error>> {
///     Ok(Scene::from_text(&format!("{BALL}{rest}"))?.pipeline().model().clone())
/// };
/// assert!(matches!(model("")?, Model::Point(_)));
/// assert!(matches!(model("[contact]\nmodel = \"soft_finger\"\n")?, Model::SoftFinger(_)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum Model<T: Real> {
    /// A force and no torque of its own.
    Point(PointContact<T>),
    /// A torque about the normal, too.
    SoftFinger(SoftFinger<T>),
    /// The one of both that the wrench speaks for.
    Auto(Box<Auto<T>>),
    /// A point contact through a skin.
    PointUnderSkin(Box<Compliant<T, PointContact<T>, Skin<T>>>),
    /// A soft finger's contact through a skin.
    SoftFingerUnderSkin(Box<Compliant<T, SoftFinger<T>, Skin<T>>>),
}

macro_rules! each_model {
    ($of:expr, $model:ident => $call:expr) => {
        match $of {
            Model::Point($model) => $call,
            Model::SoftFinger($model) => $call,
            Model::Auto($model) => {
                let $model = &**$model;
                $call
            }
            Model::PointUnderSkin($model) => {
                let $model = &**$model;
                $call
            }
            Model::SoftFingerUnderSkin($model) => {
                let $model = &**$model;
                $call
            }
        }
    };
}

impl<T: Real> ContactModel<T, DynSurface<T>> for Model<T> {
    #[inline]
    fn resolve_near(
        &self,
        wrench: &Wrench<T>,
        surface: &DynSurface<T>,
        last: Option<&Vector3<T>>,
    ) -> Resolution<T> {
        each_model!(self, model => model.resolve_near(wrench, surface, last))
    }

    #[inline]
    fn feel_near(
        &self,
        wrench: &Wrench<T>,
        surface: &DynSurface<T>,
        last: Option<&Vector3<T>>,
    ) -> (Resolution<T>, Option<ContactForce<T>>) {
        each_model!(self, model => model.feel_near(wrench, surface, last))
    }
}

impl<T: Real> Model<T> {
    /// Whether its contacts may have a spin torque.
    pub(crate) const fn knows_spin(&self) -> bool {
        !matches!(self, Self::Point(_) | Self::PointUnderSkin(_))
    }

    /// The first derivatives of a contact that this model found in a wrench; `None` where they do not exist.
    pub fn jacobian(
        &self,
        contact: &Contact<T>,
        wrench: &Wrench<T>,
        surface: &DynSurface<T>,
        last: Option<&Vector3<T>>,
    ) -> Option<ContactJacobian<T>> {
        let of_point =
            || ContactJacobian::of_point_contact(contact, wrench, &surface.shape_operator(&contact.point));
        let of_soft_finger = || ContactJacobian::of_soft_finger_on(contact, surface);
        match self {
            Self::Point(_) => of_point(),
            Self::SoftFinger(_) => of_soft_finger(),
            Self::Auto(auto) => match auto.test(wrench)?.choice {
                Choice::SoftFinger => of_soft_finger(),
                _ => of_point(),
            },
            Self::PointUnderSkin(model) => {
                model.jacobian(&model.resolve_indented(wrench, surface, last).ok()?, wrench, surface)
            }
            Self::SoftFingerUnderSkin(model) => {
                model.jacobian(&model.resolve_indented(wrench, surface, last).ok()?, surface)
            }
        }
    }
}
