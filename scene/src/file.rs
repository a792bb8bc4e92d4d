//! From the text of a scene to the scene.

use std::path::Path;

use fingertip::surfaces::DynSurface;
use fingertip_calibration::file::read_text;
use serde::Deserialize;
use serde::de::DeserializeOwned;

use crate::carried::PayloadSection;
use crate::estimate::EstimateSection;
use crate::fault::{SceneError, SceneFault, SceneProblem, VERSION};
use crate::filter::FilterSection;
use crate::formula::FormulaSection;
use crate::friction::FrictionSection;
use crate::fusion::FusionSection;
use crate::grip::GripSection;
use crate::inertial::InertialSection;
use crate::input::InputSection;
use crate::model::ContactSection;
use crate::named::Folder;
use crate::scene::Scene;
use crate::sections::StageSections;
use crate::sensor::SensorSection;
use crate::slip::SlipSection;
use crate::surface::{MapSection, MeshSection, PoseSection, SurfaceSection, map_of, placed};
use crate::tracking::TrackingSection;
use crate::uncertainty::UncertaintySection;
use crate::urdf::UrdfSection;

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
    inertial_unit: Option<InertialSection>,
    filter: Option<FilterSection>,
    surface: S,
    #[serde(default)]
    pose: PoseSection,
    map: Option<MapSection>,
    #[serde(default)]
    contact: ContactSection,
    uncertainty: Option<UncertaintySection>,
    tracking: Option<TrackingSection>,
    friction: Option<FrictionSection>,
    slip: Option<SlipSection>,
    fusion: Option<FusionSection>,
    estimate: Option<EstimateSection>,
    grip: Option<GripSection>,
}

/// The version, so that a scene of another one is not taken for a bad one.
#[derive(Deserialize)]
struct Kind {
    version: Option<u32>,
}

impl Scene {
    /// Reads and checks the scene in a file.
    ///
    /// # Errors
    /// [`SceneError`], which names the file, the line where it is known, the key, and the mend.
    pub fn load(path: impl AsRef<Path>) -> Result<Self, SceneError> {
        let path = path.as_ref();
        let text =
            read_text(path).map_err(|source| SceneError::Unreadable { path: path.to_owned(), source })?;
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
            None if key("urdf").is_some() => parse_with::<UrdfSection>,
            _ => parse_with::<DynSurface<f64>>,
        };
        parse(text, name, folder, document)
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
    let of_key =
        ["invalid", "unknown variant", "unknown field"].iter().any(|start| message.starts_with(start));
    let key = if of_key { culprit::<S>(text, error.message()) } else { None };
    let key = key.map_or_else(String::new, |key| format!("key `{key}`: "));
    SceneFault { line, problem: SceneProblem::Key { key, message } }
}

/// The key that is wrong or has a wrong value, with its section, which serde does not tell: the one without
/// which the complaint is another.
fn culprit<S: DeserializeOwned>(text: &str, message: &str) -> Option<String> {
    let document: toml::Table = toml::from_str(text).ok()?;
    let complaint = |document: &toml::Table| {
        toml::Value::Table(document.clone())
            .try_into::<SceneFile<S>>()
            .err()
            .map(|error| error.message().to_owned())
    };
    let changed = |document: &toml::Table| complaint(document).as_deref() != Some(message);
    if changed(&document) {
        return None;
    }
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
        let folder = Folder::new(folder);
        let shape = self.surface.source(&folder, &document)?;
        let pose = self.pose.sensor_from_surface::<f64>()?;
        let surface = placed(shape.shape()?, &self.pose)?;
        let projection = map_of(&surface, &pose, self.map.as_ref())?;
        let convention = self.input.convention;
        let sensor = self.sensor.as_ref().map(|section| section.source(&folder)).transpose()?;
        let payload = self.payload.as_ref().map(|section| section.source(&folder)).transpose()?;
        let files = folder.into_files();
        let Self {
            inertial_unit,
            filter,
            contact,
            uncertainty,
            tracking,
            fusion,
            friction,
            slip,
            estimate,
            grip,
            ..
        } = self;
        let stages = StageSections {
            convention,
            sample_rate,
            rest,
            sensor,
            payload,
            inertial_unit,
            filter,
            contact,
            uncertainty,
            tracking,
            fusion,
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
            files,
            projection,
            stages,
            pipeline,
        })
    }
}
