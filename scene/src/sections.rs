//! The sections of the stages, and the pipeline that they make.

use fingertip::surfaces::DynSurface;
use fingertip::wrench::Real;
use nalgebra::Vector3;

use crate::carried::{Carried, PayloadSource};
use crate::estimate::EstimateSection;
use crate::fault::SceneProblem;
use crate::filter::FilterSection;
use crate::friction::{Friction, FrictionSection, Limit};
use crate::front::Front;
use crate::fusion::FusionSection;
use crate::grip::GripSection;
use crate::inertial::InertialSection;
use crate::input::Convention;
use crate::model::ContactSection;
use crate::noise::{Known, Noisy};
use crate::pipeline::{Parts, Pipeline};
use crate::sensor::SensorSource;
use crate::slip::{SlipSection, SlipWatch};
use crate::surface::{PoseSection, flat_normal};
use crate::tracking::TrackingSection;
use crate::uncertainty::UncertaintySection;

/// The sections of the stages.
#[derive(Clone, Debug)]
pub(crate) struct StageSections {
    pub(crate) convention: Convention,
    pub(crate) sample_rate: Option<f64>,
    pub(crate) rest: Option<f64>,
    pub(crate) sensor: Option<SensorSource>,
    pub(crate) payload: Option<PayloadSource>,
    pub(crate) inertial_unit: Option<InertialSection>,
    pub(crate) filter: Option<FilterSection>,
    pub(crate) contact: ContactSection,
    pub(crate) uncertainty: Option<UncertaintySection>,
    pub(crate) tracking: Option<TrackingSection>,
    pub(crate) fusion: Option<FusionSection>,
    pub(crate) friction: Option<FrictionSection>,
    pub(crate) slip: Option<SlipSection>,
    pub(crate) estimate: Option<EstimateSection>,
    pub(crate) grip: Option<GripSection>,
}

impl StageSections {
    fn carried<T: Real>(&self) -> Result<Option<Carried<T>>, SceneProblem> {
        let unit = self.inertial_unit.as_ref();
        match &self.payload {
            Some(payload) => payload.build(unit, self.sample_rate).map(Some),
            None if unit.is_some() => {
                let needed = "the section [payload], or --payload: what its readings take off";
                Err(SceneProblem::Needs { what: "[inertial_unit]", needed })
            }
            None => Ok(None),
        }
    }

    /// The pipeline on a surface that is placed; `exact` is the same in double precision.
    pub(crate) fn build<T: Real>(
        &self,
        surface: DynSurface<T>,
        exact: &DynSurface<f64>,
        pose: &PoseSection,
    ) -> Result<Pipeline<T>, SceneProblem> {
        let pose = pose.sensor_from_surface::<f64>()?;
        let pivot = pose.transform_point(&Vector3::zeros());
        let noisy = Noisy {
            contact: self.contact.clone(),
            uncertainty: self.uncertainty.clone(),
            tracking: self.tracking.clone(),
            pivot,
            sensor: self.sensor.clone().filter(|_| self.uncertainty.is_some()),
        };
        if noisy.awaits_noise() && self.rest.is_none() {
            return Err(SceneProblem::Needs {
                what: "`least_force_deviations` of [contact], or [uncertainty] without its noise,",
                needed: "`rest_s` of [input], in which the noise is measured",
            });
        }
        let Known { model, uncertainty, tracking } = noisy.build(None)?;
        let limit = match &self.friction {
            Some(section) => Some(section.build(flat_normal(exact), |v| pose.rotate(v))?),
            None => None,
        };
        let fusion = match &self.fusion {
            Some(section) => {
                let coefficient = limit.as_ref().map(Limit::coefficient);
                Some(section.build(uncertainty.as_ref(), coefficient)?)
            }
            None => None,
        };
        let detector = match &self.slip {
            Some(section) => {
                Some(section.build(limit.map(|limit: Limit<T>| limit.coefficient()), self.sample_rate)?)
            }
            None => None,
        };
        if self.estimate.is_some() && self.slip.is_none() {
            return Err(SceneProblem::Needs {
                what: "[estimate]",
                needed: "the section [slip], which tells when",
            });
        }
        if self.grip.is_some() && self.friction.is_none() {
            return Err(SceneProblem::Needs { what: "[grip]", needed: "the section [friction]" });
        }
        let filter = self.filter.as_ref().map(|section| section.build(self.sample_rate)).transpose()?;
        let front = Front {
            convention: self.convention,
            sensor: self.sensor.as_ref().map(SensorSource::build).transpose()?,
            celsius: self.sensor.as_ref().and_then(|sensor| sensor.celsius).map(T::literal),
            carried: self.carried()?,
        };
        Ok(Pipeline::new(Parts {
            front,
            filter,
            surface,
            model,
            uncertainty,
            tracking,
            fusion,
            noisy: noisy.awaits_noise().then(|| Box::new(noisy)),
            friction: Friction(limit),
            slip: SlipWatch(detector),
            estimate: self.estimate.as_ref().map(EstimateSection::build).transpose()?,
            grip: self.grip.as_ref().map(GripSection::build).transpose()?,
        }))
    }
}
