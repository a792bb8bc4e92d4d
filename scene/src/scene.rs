//! A scene, read and checked.

use std::path::{Path, PathBuf};

use fingertip::surfaces::DynSurface;
use fingertip::wrench::Real;
use fingertip_calibration::file::CalibrationFile;
use fingertip_recordings::RenamedColumn;
use serde::de::DeserializeOwned;

use crate::carried::{Carried, PayloadSource};
use crate::fault::SceneProblem;
use crate::felt::Tells;
use crate::friction::Limit;
use crate::input::{Convention, InputSection};
use crate::pipeline::Pipeline;
use crate::projection::Projection;
use crate::sections::StageSections;
use crate::sensor::SensorSource;
use crate::surface::{PoseSection, ShapeSource, placed};
use crate::{doubts, meaning};

/// A scene that has been checked: every stage can be built from it.
///
/// ```
/// use fingertip_scene::Scene;
/// use fingertip::wrench::Wrench;
/// use nalgebra::Vector3;
///
/// let scene = Scene::from_text(
///     r#"
///     version = 2
///     [input]
///     convention = "on_fingertip"
///     [surface]
///     shape = "sphere"
///     radius_m = 0.013
///     [contact]
///     model = "soft_finger"
///     least_force_N = 0.1
///     [friction]
///     static_coefficient = 0.5
///     "#,
/// )?;
/// let mut pipeline = scene.pipeline();
/// let push = Wrench::from_force_at(&Vector3::new(0.0, 0.0, 0.013), Vector3::new(0.2, 0.0, -1.0));
/// let felt = pipeline.sense(push, 1e-3);
/// assert!((felt.contact().unwrap().point.z - 0.013).abs() < 1e-12);
/// assert!((felt.margin().unwrap().utilisation - 0.4).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Scene {
    pub(crate) name: String,
    /// As it stands in the file.
    pub(crate) document: toml::Table,
    pub(crate) input: InputSection,
    pub(crate) renamed: Vec<RenamedColumn>,
    pub(crate) shape: ShapeSource,
    pub(crate) pose: PoseSection,
    /// That it names, and that these name.
    pub(crate) files: Vec<PathBuf>,
    pub(crate) projection: Projection,
    pub(crate) stages: StageSections,
    /// In double precision: that it could be built is what was checked.
    pub(crate) pipeline: Pipeline<f64>,
}

impl Scene {
    /// What it says, in a line for each of its sections.
    #[must_use]
    pub fn meaning(&self) -> Vec<String> {
        let of_motion = self.carried().map_or(0.0, Carried::delay);
        meaning::of(&self.document, self.delay(), of_motion)
    }

    /// What in it can be and is hardly meant, such as a radius of 13 m: a sentence each, with the key.
    #[must_use]
    pub fn doubts(&self) -> Vec<String> {
        doubts::of(&self.document, &self.shape, self.surface())
    }

    /// The files that were read for it beside its own: calibration, payload, mesh, the description of a robot and the meshes
    /// that it names. Whoever writes files should write over none of them.
    #[must_use]
    pub fn files(&self) -> &[PathBuf] {
        &self.files
    }

    /// What reports call it.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Whose load was recorded.
    #[must_use]
    pub const fn convention(&self) -> Convention {
        self.input.convention
    }

    /// The calibration of the sensor, if the scene has one.
    #[must_use]
    pub fn calibration(&self) -> Option<&CalibrationFile> {
        self.stages.sensor.as_ref().map(|sensor| &sensor.file)
    }

    /// Temperature of the sensor where no reading tells it \[°C\].
    #[must_use]
    pub fn celsius(&self) -> Option<f64> {
        self.stages.sensor.as_ref()?.celsius
    }

    /// With another calibration in the place of `[sensor]`.
    ///
    /// # Errors
    /// [`SceneProblem::Sensor`].
    pub fn calibrated_by(mut self, path: impl AsRef<Path>) -> Result<Self, SceneProblem> {
        let (celsius, path) = (self.celsius(), path.as_ref());
        self.stages.sensor = Some(SensorSource { celsius, ..SensorSource::read(path)? });
        self.files.push(path.to_owned());
        self.rebuilt()
    }

    /// With another payload in the place of `[payload]`.
    ///
    /// # Errors
    /// [`SceneProblem::Payload`].
    pub fn carrying(mut self, path: impl AsRef<Path>) -> Result<Self, SceneProblem> {
        let path = path.as_ref();
        self.stages.payload = Some(PayloadSource::read(path, None)?);
        self.files.push(path.to_owned());
        self.rebuilt()
    }

    fn rebuilt(mut self) -> Result<Self, SceneProblem> {
        self.pipeline = self.stages.build(self.surface().clone(), self.surface(), &self.pose)?;
        Ok(self)
    }

    /// Prefix of the sensor's columns.
    #[must_use]
    pub fn sensor_name(&self) -> Option<&str> {
        self.input.sensor.as_deref()
    }

    /// Columns of the recording that have names of their own, and what they are to be taken for.
    #[must_use]
    pub fn renamed_columns(&self) -> &[RenamedColumn] {
        &self.renamed
    }

    /// Whether the first line of a recording names its columns.
    #[must_use]
    pub const fn has_header(&self) -> bool {
        self.input.header
    }

    /// Samples per second where the recording has no time \[Hz\].
    #[must_use]
    pub const fn sample_rate(&self) -> Option<f64> {
        self.input.sample_rate
    }

    /// How long the sensor is known to be unloaded at the start \[s\].
    #[must_use]
    pub const fn rest(&self) -> Option<f64> {
        self.input.rest
    }

    /// Smaller forces are no contact \[N\].
    #[must_use]
    pub const fn least_force(&self) -> f64 {
        self.stages.contact.least_force()
    }

    /// How points of the surface are drawn flat.
    #[must_use]
    pub const fn projection(&self) -> &Projection {
        &self.projection
    }

    /// The surface, in the sensor frame.
    #[must_use]
    pub const fn surface(&self) -> &DynSurface<f64> {
        self.pipeline.surface()
    }

    /// The friction limit, if the scene has one.
    #[must_use]
    pub const fn limit(&self) -> Option<&Limit<f64>> {
        self.pipeline.limit()
    }

    /// How many places the tactile array of `[fusion]` has; `None` for a scene without one.
    #[must_use]
    pub fn array_places(&self) -> Option<usize> {
        self.pipeline.array_places()
    }

    /// Whether slip is watched for.
    #[must_use]
    pub const fn watches_for_slip(&self) -> bool {
        self.stages.slip.is_some()
    }

    /// What the sensor carries, if the scene has a `[payload]`.
    #[must_use]
    pub const fn carried(&self) -> Option<&Carried<f64>> {
        self.pipeline.carried()
    }

    /// By how much the wrench comes late that a `[filter]` gives, where it changes slowly \[s\].
    #[must_use]
    pub fn delay(&self) -> f64 {
        self.pipeline.delay()
    }

    /// Whether the scene asks for the noise of the rest: see [`Pipeline::know_noise`].
    #[must_use]
    pub const fn awaits_noise(&self) -> bool {
        self.pipeline.awaits_noise()
    }

    /// What is told of each sample beside contact, forces, margin and verdict.
    #[must_use]
    pub fn tells(&self) -> Tells {
        self.pipeline.tells()
    }

    /// The pipeline, in double precision.
    #[must_use]
    pub fn pipeline(&self) -> Pipeline<f64> {
        self.pipeline.clone()
    }

    /// The pipeline in another precision.
    ///
    /// # Errors
    /// [`SceneProblem`] where a number of the scene is out of the range of the type.
    pub fn pipeline_in<T: Real + DeserializeOwned>(&self) -> Result<Pipeline<T>, SceneProblem> {
        let surface = placed(self.shape.shape()?, &self.pose)?;
        self.stages.build(surface, self.surface(), &self.pose)
    }
}
