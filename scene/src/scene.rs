//! A scene, read and checked.

use std::fs;
use std::path::Path;

use fingertip::surfaces::DynSurface;
use fingertip::wrench::Real;
use fingertip_calibration::file::CalibrationFile;
use fingertip_recordings::RenamedColumn;
use nalgebra::Vector3;
use serde::Deserialize;
use serde::de::DeserializeOwned;

use crate::carried::{PayloadSection, PayloadSource};
use crate::estimate::EstimateSection;
use crate::fault::{SceneError, SceneFault, SceneProblem, VERSION};
use crate::filter::FilterSection;
use crate::formula::FormulaSection;
use crate::friction::{Friction, FrictionSection, Limit};
use crate::front::Front;
use crate::grip::GripSection;
use crate::input::{Convention, InputSection};
use crate::model::ContactSection;
use crate::noise::Noisy;
use crate::pipeline::{Parts, Pipeline, Tells};
use crate::projection::Projection;
use crate::sensor::{SensorSection, SensorSource};
use crate::slip::{SlipSection, SlipWatch};
use crate::surface::{
    MapSection, MeshSection, PoseSection, ShapeSource, SurfaceSection, flat_normal, map_of, placed,
};
use crate::uncertainty::UncertaintySection;
use crate::{doubts, meaning};

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct SceneFile<S> {
    /// Checked before the rest is read.
    #[serde(rename = "version")]
    _version: u32,
    name: Option<String>,
    input: InputSection,
    sensor: Option<SensorSection>,
    payload: Option<PayloadSection>,
    filter: Option<FilterSection>,
    surface: S,
    #[serde(default)]
    pose: PoseSection,
    map: Option<MapSection>,
    #[serde(default)]
    contact: ContactSection,
    uncertainty: Option<UncertaintySection>,
    friction: Option<FrictionSection>,
    slip: Option<SlipSection>,
    estimate: Option<EstimateSection>,
    grip: Option<GripSection>,
}

/// The version, so that a scene of another one is not taken for a bad one.
#[derive(Deserialize)]
struct Kind {
    version: Option<u32>,
}

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
    name: String,
    /// As it stands in the file.
    pub(crate) document: toml::Table,
    input: InputSection,
    renamed: Vec<RenamedColumn>,
    pub(crate) shape: ShapeSource,
    pub(crate) pose: PoseSection,
    projection: Projection,
    stages: StageSections,
    /// In double precision: that it could be built is what was checked.
    pipeline: Pipeline<f64>,
}

/// The sections of the stages.
#[derive(Clone, Debug)]
struct StageSections {
    convention: Convention,
    sample_rate: Option<f64>,
    rest: Option<f64>,
    sensor: Option<SensorSource>,
    payload: Option<PayloadSource>,
    filter: Option<FilterSection>,
    contact: ContactSection,
    uncertainty: Option<UncertaintySection>,
    friction: Option<FrictionSection>,
    slip: Option<SlipSection>,
    estimate: Option<EstimateSection>,
    grip: Option<GripSection>,
}

impl Scene {
    /// Reads and checks the scene in a file.
    ///
    /// # Errors
    /// [`SceneError`], which names the file, the line where it is known, the key, and the mend.
    pub fn load(path: impl AsRef<Path>) -> Result<Self, SceneError> {
        let path = path.as_ref();
        let text = fs::read_to_string(path)
            .map_err(|source| SceneError::Unreadable { path: path.to_owned(), source })?;
        let name = path.file_stem().map_or_else(|| "scene".into(), |stem| stem.to_string_lossy());
        let folder = path.parent().unwrap_or(Path::new(""));
        Self::parse(&text, &name, folder).map_err(|fault| SceneError::Fault { path: path.to_owned(), fault })
    }

    /// Checks a scene in a text; files that it names are looked for where the program runs.
    ///
    /// # Errors
    /// [`SceneProblem`].
    pub fn from_text(text: &str) -> Result<Self, SceneProblem> {
        Self::parse(text, "scene", Path::new("")).map_err(|fault| fault.problem)
    }

    /// A scene of which the file is called `name`, in a folder that relative paths start from.
    ///
    /// # Errors
    /// [`SceneFault`].
    pub fn parse(text: &str, name: &str, folder: &Path) -> Result<Self, SceneFault> {
        let unread = |error: toml::de::Error| explain::<DynSurface<f64>>(text, &error);
        let Kind { version } = toml::from_str(text).map_err(unread)?;
        let document: toml::Table = toml::from_str(text).map_err(unread)?;
        match version {
            Some(1..=VERSION) => {}
            Some(other) => return Err(SceneProblem::OtherVersion(other).into()),
            None => return Err(SceneProblem::NoVersion.into()),
        }
        let key = |key| document.get("surface").and_then(|surface| surface.get(key));
        let parse = match key("shape").and_then(toml::Value::as_str) {
            Some("mesh") if key("file").is_some() => parse_with::<MeshSection>,
            Some("formula") => parse_with::<FormulaSection>,
            _ => parse_with::<DynSurface<f64>>,
        };
        parse(text, name, folder, document)
    }

    /// What it says, in a line for each of its sections.
    #[must_use]
    pub fn meaning(&self) -> Vec<String> {
        meaning::of(&self.document, self.pipeline.delay())
    }

    /// What in it can be and is hardly meant, such as a radius of 13 m: a sentence each, with the key.
    #[must_use]
    pub fn doubts(&self) -> Vec<String> {
        doubts::of(&self.document)
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
        let celsius = self.celsius();
        self.stages.sensor = Some(SensorSource { celsius, ..SensorSource::read(path.as_ref())? });
        self.rebuilt()
    }

    /// With another payload in the place of `[payload]`.
    ///
    /// # Errors
    /// [`SceneProblem::Payload`].
    pub fn carrying(mut self, path: impl AsRef<Path>) -> Result<Self, SceneProblem> {
        self.stages.payload = Some(PayloadSource::read(path.as_ref(), None)?);
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

    /// Whether slip is watched for.
    #[must_use]
    pub const fn watches_for_slip(&self) -> bool {
        self.stages.slip.is_some()
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

fn parse_with<S: SurfaceSection + DeserializeOwned>(
    text: &str,
    name: &str,
    folder: &Path,
    document: toml::Table,
) -> Result<Scene, SceneFault> {
    let file: SceneFile<S> = toml::from_str(text).map_err(|error| explain::<S>(text, &error))?;
    Ok(file.check(name, folder, document)?)
}

/// Line and sentence for an error of the parser.
fn explain<S: DeserializeOwned>(text: &str, error: &toml::de::Error) -> SceneFault {
    let before = error.span().and_then(|span| text.get(..span.start));
    let line = before.map(|before| before.matches('\n').count() + 1);
    let message = error.message().replace('\n', " ");
    let of_value = message.starts_with("invalid") || message.starts_with("unknown variant");
    let key = if of_value { culprit::<S>(text, error.message()) } else { None };
    let key = key.map_or_else(String::new, |key| format!("key `{key}`: "));
    SceneFault { line, problem: SceneProblem::Key { key, message } }
}

/// The key whose value is wrong, which serde does not tell: the one without which the complaint is
/// another.
fn culprit<S: DeserializeOwned>(text: &str, message: &str) -> Option<String> {
    let document: toml::Table = toml::from_str(text).ok()?;
    let complaint = |document: &toml::Table| {
        toml::Value::Table(document.clone())
            .try_into::<SceneFile<S>>()
            .err()
            .map(|error| error.message().to_owned())
    };
    let changed = |document: &toml::Table| complaint(document).as_deref() != Some(message);
    // What tells the kinds of a section apart changes everything when it is gone.
    let tells_apart = |key: &str| matches!(key, "shape" | "detector" | "limit" | "law" | "kind");
    for (section, value) in &document {
        let mut without = document.clone();
        without.remove(section);
        if !changed(&without) {
            continue;
        }
        let Some(table) = value.as_table() else { return Some(section.clone()) };
        return table.keys().filter(|key| !tells_apart(key)).find_map(|key| {
            let mut smaller = table.clone();
            smaller.remove(key);
            without.insert(section.clone(), toml::Value::Table(smaller));
            changed(&without).then(|| format!("{section}.{key}"))
        });
    }
    None
}

impl<S: SurfaceSection> SceneFile<S> {
    fn check(self, name: &str, folder: &Path, document: toml::Table) -> Result<Scene, SceneProblem> {
        let positive = |key: &'static str, value: Option<f64>| match value {
            Some(found) if !(found > 0.0 && found.is_finite()) => {
                Err(SceneProblem::NotPositive { key, found })
            }
            other => Ok(other),
        };
        let sample_rate = positive("sample_rate_Hz", self.input.sample_rate)?;
        let rest = positive("rest_s", self.input.rest.filter(|rest| *rest != 0.0))?;
        let renamed = self.input.columns.renamed(&self.input.units)?;
        let shape = self.surface.source(folder, &document);
        let pose = self.pose.sensor_from_surface::<f64>()?;
        let surface = placed(shape.shape()?, &self.pose)?;
        let projection = map_of(&surface, &pose, self.map.as_ref())?;
        let convention = self.input.convention;
        let sensor = self.sensor.as_ref().map(|section| section.source(folder)).transpose()?;
        let payload = self.payload.as_ref().map(|section| section.source(folder)).transpose()?;
        let Self { filter, contact, uncertainty, friction, slip, estimate, grip, .. } = self;
        let stages = StageSections {
            convention,
            sample_rate,
            rest,
            sensor,
            payload,
            filter,
            contact,
            uncertainty,
            friction,
            slip,
            estimate,
            grip,
        };
        let pipeline = stages.build(surface.clone(), &surface, &self.pose)?;
        Ok(Scene {
            name: self.name.unwrap_or_else(|| name.to_owned()),
            document,
            input: InputSection { sample_rate, rest, ..self.input },
            renamed,
            shape,
            pose: self.pose,
            projection,
            stages,
            pipeline,
        })
    }
}

impl StageSections {
    /// The pipeline on a surface that is placed; `exact` is the same in double precision.
    fn build<T: Real>(
        &self,
        surface: DynSurface<T>,
        exact: &DynSurface<f64>,
        pose: &PoseSection,
    ) -> Result<Pipeline<T>, SceneProblem> {
        let pose = pose.sensor_from_surface::<f64>()?;
        let pivot = pose.transform_point(&Vector3::zeros());
        let noisy = Noisy { contact: self.contact.clone(), uncertainty: self.uncertainty.clone(), pivot };
        if noisy.awaits_noise() && self.rest.is_none() {
            return Err(SceneProblem::Needs {
                what: "`least_force_deviations` of [contact], or [uncertainty] without its noise,",
                needed: "`rest_s` of [input], in which the noise is measured",
            });
        }
        let (model, uncertainty) = noisy.build(None)?;
        let limit = match &self.friction {
            Some(section) => Some(section.build(flat_normal(exact), |v| pose.rotate(v))?),
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
            carried: self.payload.as_ref().map(PayloadSource::build).transpose()?,
        };
        Ok(Pipeline::new(Parts {
            front,
            filter,
            surface,
            model,
            uncertainty,
            noisy: noisy.awaits_noise().then(|| Box::new(noisy)),
            friction: Friction(limit),
            slip: SlipWatch(detector),
            estimate: self.estimate.as_ref().map(EstimateSection::build).transpose()?,
            grip: self.grip.as_ref().map(GripSection::build).transpose()?,
        }))
    }
}
