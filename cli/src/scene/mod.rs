//! The scene: what the recording was made with, and what to look for in it.
//!
//! Format, units and defaults are documented in `examples/scenes/README.md`, and nowhere else.

pub(crate) mod fault;
mod hostile;
mod simulated;
mod stages;
mod surface;

use std::fs;
use std::path::Path;

use fingertip::contact::PointContact;
use fingertip::surfaces::DynSurface;
use fingertip::wrench::Wrench;
use nalgebra::Vector3;
use serde::Deserialize;
use serde::de::DeserializeOwned;

pub(crate) use simulated::least_static_coefficient;
pub(crate) use stages::{Friction, SlipWatch};

use crate::error::{CliError, Place};
use crate::shape::{Projection, Shape};
use fault::{SceneFault, SceneProblem, VERSION};
use stages::{ContactSection, FrictionSection, SlipSection};
use surface::{MapSection, MeshSection, PoseSection, SurfaceSection, place};

/// Which of the two opposite loads of a contact the recording holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Convention {
    /// The load that the environment applies to the fingertip.
    OnFingertip,
    /// The load that the fingertip applies to the environment.
    Reaction,
}

impl Convention {
    /// The load on the fingertip.
    #[inline]
    pub(crate) fn wrench(self, force: Vector3<f64>, torque: Vector3<f64>) -> Wrench<f64> {
        match self {
            Self::OnFingertip => Wrench::on_fingertip(force, torque),
            Self::Reaction => Wrench::from_reaction(force, torque),
        }
    }
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct InputSection {
    convention: Convention,
    sensor: Option<String>,
    #[serde(rename = "sample_rate_Hz")]
    sample_rate: Option<f64>,
    #[serde(rename = "rest_s")]
    rest: Option<f64>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct SceneFile<S> {
    /// Checked before the rest is read.
    #[serde(rename = "version")]
    _version: u32,
    name: Option<String>,
    input: InputSection,
    surface: S,
    #[serde(default)]
    pose: PoseSection,
    map: Option<MapSection>,
    #[serde(default)]
    contact: ContactSection,
    friction: Option<FrictionSection>,
    slip: Option<SlipSection>,
}

/// What tells kinds of scenes apart: the version, so that a scene of another version is not taken for
/// a bad one, and the shape.
#[derive(Deserialize)]
struct Kind {
    version: Option<u32>,
    surface: Option<toml::Value>,
}

/// A scene that has been checked: every stage can be built from it.
#[derive(Clone, Debug)]
pub(crate) struct Scene {
    pub(crate) name: String,
    pub(crate) convention: Convention,
    /// Prefix of the sensor's columns.
    pub(crate) sensor: Option<String>,
    /// Samples per second, where the recording has no time.
    pub(crate) sample_rate: Option<f64>,
    /// How long the sensor is known to be unloaded at the start \[s\].
    pub(crate) rest: Option<f64>,
    pub(crate) shape: Shape,
    pub(crate) projection: Projection,
    pub(crate) model: PointContact<f64>,
    pub(crate) friction: Friction,
    pub(crate) slip: SlipWatch,
}

impl Scene {
    /// Reads and checks a scene; `sim` is that of the simulated fingertip, unless there is a file of this name.
    pub(crate) fn load_or_simulated(path: &Path) -> Result<Self, CliError> {
        if path == Path::new("sim") && !path.exists() { simulated::scene() } else { Self::load(path) }
    }

    /// Reads and checks a scene.
    pub(crate) fn load(path: &Path) -> Result<Self, CliError> {
        let text = fs::read_to_string(path).map_err(|source| CliError::read("scene", path, source))?;
        let name = path.file_stem().map_or_else(|| "scene".into(), |stem| stem.to_string_lossy());
        let folder = path.parent().unwrap_or(Path::new(""));
        parse(&text, &name, folder).map_err(|fault| CliError::Scene {
            path: path.to_owned(),
            place: Place(fault.line),
            problem: fault.problem,
        })
    }
}

#[cfg(test)]
impl Scene {
    /// A scene of this text.
    pub(crate) fn read(text: &str, name: &str, folder: &Path) -> Result<Self, SceneProblem> {
        parse(text, name, folder).map_err(|fault| fault.problem)
    }
}

/// A scene of which the file is called `name`, in a folder that relative paths start from.
fn parse(text: &str, name: &str, folder: &Path) -> Result<Scene, SceneFault> {
    let Kind { version, surface } =
        toml::from_str(text).map_err(|error| explain::<DynSurface<f64>>(text, &error))?;
    let word = |key| surface.as_ref().and_then(|surface| surface.get(key)).and_then(toml::Value::as_str);
    match version {
        Some(VERSION) => match word("shape") {
            Some("mesh") if word("file").is_some() => parse_with::<MeshSection>(text, name, folder),
            _ => parse_with::<DynSurface<f64>>(text, name, folder),
        },
        Some(other) => Err(SceneProblem::OtherVersion(other).into()),
        None => Err(SceneProblem::NoVersion.into()),
    }
}

fn parse_with<S: SurfaceSection + DeserializeOwned>(
    text: &str,
    name: &str,
    folder: &Path,
) -> Result<Scene, SceneFault> {
    let file: SceneFile<S> = toml::from_str(text).map_err(|error| explain::<S>(text, &error))?;
    Ok(file.check(name, folder)?)
}

/// Line and sentence for an error of the parser.
fn explain<S: DeserializeOwned>(text: &str, error: &toml::de::Error) -> SceneFault {
    let before = error.span().and_then(|span| text.get(..span.start));
    let line = before.map(|before| before.matches('\n').count() + 1);
    let message = error.message().replace('\n', " ");
    let key = if message.starts_with("invalid") { culprit::<S>(text, error.message()) } else { None };
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
    let tells_apart = |key: &str| matches!(key, "shape" | "detector");
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
    fn check(self, name: &str, folder: &Path) -> Result<Scene, SceneProblem> {
        let positive = |key: &'static str, value: Option<f64>| match value {
            Some(found) if !(found > 0.0 && found.is_finite()) => {
                Err(SceneProblem::NotPositive { key, found })
            }
            other => Ok(other),
        };
        let sample_rate = positive("sample_rate_Hz", self.input.sample_rate)?;
        let rest = positive("rest_s", self.input.rest.filter(|rest| *rest != 0.0))?;
        let (shape, projection) = place(self.surface.shape(folder)?, &self.pose, self.map.as_ref())?;
        let friction = Friction::from_section(self.friction.as_ref())?;
        Ok(Scene {
            name: self.name.unwrap_or_else(|| name.to_owned()),
            convention: self.input.convention,
            sensor: self.input.sensor,
            sample_rate,
            rest,
            shape,
            projection,
            model: self.contact.model()?,
            slip: SlipWatch::from_section(self.slip.as_ref(), friction)?,
            friction,
        })
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::{Convention, Scene, SceneProblem, parse};
    use crate::shape::Shape;

    const GOOD: &str =
        "version = 1\n[input]\nconvention = \"reaction\"\n[surface]\nshape = \"sphere\"\nradius_m = 0.013\n";

    fn check(text: &str) -> Result<Scene, SceneProblem> {
        Scene::read(text, "test", Path::new(""))
    }

    #[test]
    fn a_short_scene_is_enough() {
        let scene = check(GOOD).unwrap();
        assert_eq!(scene.convention, Convention::Reaction);
        assert!(matches!(scene.shape, Shape::Sphere(_)));
    }

    #[test]
    fn faults_are_named() {
        let without = |line: &str| GOOD.replace(line, "");
        let cases = [
            (without("version = 1\n"), "version"),
            (GOOD.replace("version = 1", "version = 2"), "version 2"),
            (without("convention = \"reaction\"\n"), "missing field `convention`"),
            (GOOD.replace("reaction", "object"), "expected `on_fingertip` or `reaction`"),
            (format!("{GOOD}radius_mm = 13.0\n"), "unknown field `radius_mm`"),
            (format!("{GOOD}[contacts]\n"), "unknown field `contacts`"),
            (GOOD.replace("sphere", "cube"), "unknown variant `cube`"),
            (without("radius_m = 0.013\n"), "missing field `radius_m`"),
            (GOOD.replace("0.013", "-0.013"), "radius of a sphere"),
            (GOOD.replace("0.013", "nan"), "radius of a sphere"),
            (GOOD.replace("0.013", "\"13 mm\""), "key `surface.radius_m`: invalid type: string"),
            (format!("{GOOD}pole = [0.0, 1.0]\n"), "key `surface.pole`: invalid length 2"),
            (GOOD.replace("[input]", "[input]\nsensor = 1"), "key `input.sensor`: invalid type: integer"),
            (format!("name = 3\n{GOOD}"), "key `name`: invalid type: integer"),
            (format!("{GOOD}[contact]\nleast_force_N = -1.0\n"), "least force"),
            (format!("{GOOD}[friction]\nstatic_coefficient = 0.0\n"), "friction coefficient"),
            (format!("{GOOD}[slip]\ndetector = \"threshold\"\nnoise_N = 0.01\n"), "[friction]"),
            (format!("{GOOD}[slip]\ndetector = \"drop\"\nnoise_N = 0.0\n"), "noise"),
            (GOOD.replace("[input]", "[input]\nrest_s = -1"), "rest_s"),
            (GOOD.replace("[input]", "[input]\nsample_rate_Hz = -5.0"), "sample_rate_Hz"),
            (format!("{GOOD}active_half_angle_deg = 190.0\n"), "active_half_angle_deg"),
            (format!("{GOOD}pole = [0.0, 0.0, 0.0]\n"), "pole"),
            (format!("{GOOD}[pose]\nrotation_deg = [0.0, inf, 0.0]\n"), "rotation_deg"),
        ];
        for (text, expected) in cases {
            match check(&text) {
                Ok(_) => panic!("accepted, but should complain of {expected}:\n{text}"),
                Err(problem) => {
                    assert!(problem.to_string().contains(expected), "{problem} lacks {expected:?}");
                }
            }
        }
    }

    #[test]
    fn an_unknown_key_is_answered_with_the_known_ones_and_its_line() {
        let fault = parse(&GOOD.replace("convention", "convection"), "test", Path::new("")).unwrap_err();
        let message = fault.problem.to_string();
        assert_eq!(fault.line, Some(3));
        assert!(message.contains("unknown field `convection`"), "{message}");
        assert!(message.contains("`convention`") && message.contains("`sample_rate_Hz`"), "{message}");
    }

    #[test]
    fn the_shapes_of_the_readme_are_understood() {
        let shapes = [
            "shape = 'disk'\nradius_m = 0.01",
            "shape = 'rectangle'\nfirst_half_edge_m = [0.01, 0.0, 0.0]\nsecond_half_edge_m = [0.0, 0.02, 0.0]",
            "shape = 'ellipsoid'\nsemi_axes_m = [0.01, 0.02, 0.03]",
            "shape = 'capped_cylinder'\nradius_m = 0.01\nhalf_length_m = 0.02",
            "shape = 'elliptic_cylinder'\nsemi_axes_m = [0.01, 0.02]\nends_m = 'unbounded'",
            "shape = 'elliptic_cylinder'\nsemi_axes_m = [0.01, 0.02]\nends_m = { capped = 0.01 }",
            "shape = 'capsule'\nradius_m = 0.01\nhalf_length_m = 0.02",
            "shape = 'cone'\nhalf_angle_deg = 30.0\ndepth_m = 0.02",
            "shape = 'frustum'\nbase_radius_m = 0.02\ntop_radius_m = 0.01\nheight_m = 0.02",
            "shape = 'torus'\nring_radius_m = 0.03\ntube_radius_m = 0.01",
            "shape = 'superquadric'\nsemi_axes_m = [0.01, 0.02, 0.03]\nexponents = [0.5, 0.5]",
            "shape = 'rounded_box'\nhalf_extents_m = [0.01, 0.02, 0.03]\nrounding_m = 0.002",
            "shape = 'paraboloid'\nradii_m = [0.01, 0.02]\ndepth_m = 0.01",
            "shape = 'heightfield'\ncorner_m = [0.0, 0.0]\nspacing_m = [0.01, 0.01]\ncolumns = 2\nheights_m = [0.0, 0.0, 0.0, 0.001]",
        ];
        let readme = include_str!("../../../examples/scenes/README.md");
        let (head, _) = GOOD.split_once("shape").unwrap();
        for shape in shapes {
            let scene = check(&format!("{head}{shape}\n[map]\npole = [1.0, 0.0, 0.0]\n"));
            assert!(matches!(scene.unwrap().shape, Shape::Other(_)), "{shape}");
            for key in shape.lines().skip(1).filter_map(|line| line.split_once(" =")) {
                assert!(readme.contains(&format!("`{}`", key.0)), "{}", key.0);
            }
            assert!(check(&format!("{head}{shape}\nradius_mm = 1.0\n")).is_err(), "{shape}");
        }
        for (key, bad) in
            [("centre_m", "[inf, 0.0, 0.0]"), ("centre_m", "[0.0, nan, 0.0]"), ("pole", "[0.0, 0.0, inf]")]
        {
            let error =
                check(&format!("{head}{}\n[map]\n{key} = {bad}\n", shapes[2])).unwrap_err().to_string();
            assert!(error.contains(&format!("`{key}` of [map]")), "{error}");
        }
        let error = check(&format!("{GOOD}[map]\n")).unwrap_err().to_string();
        assert!(error.contains("[map]"), "{error}");
    }
}
