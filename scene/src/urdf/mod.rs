//! `[surface]` with `urdf`: the collision shapes of a link of a robot, as it is described everywhere.
//!
//! What is read becomes a shape as it could stand in the scene itself, so that all that scenes can do can be done with it.

mod collada;
mod robot;
mod shapes;
mod xml;

use std::path::{Path, PathBuf};

use fingertip::surfaces::MeshError;
use fingertip_calibration::file::read_text;
use serde::{Deserialize, Serialize};
use thiserror::Error;
use toml::{Table, Value};

use crate::named::Folder;
use robot::Robot;

/// `[surface]` of a scene whose fingertip is a link of a robot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct UrdfSection {
    urdf: PathBuf,
    /// Whose collision shapes are the surface.
    link: String,
    /// In whose frame the sensor tells its wrenches; the link itself without it.
    #[serde(skip_serializing_if = "Option::is_none")]
    sensor_link: Option<String>,
}

/// Why a robot's description gives no surface.
///
/// ```
/// use fingertip_scene::{Scene, SceneProblem, UrdfFault};
///
/// let text = "version = 2\n[input]\nconvention = \"on_fingertip\"\n[surface]\nurdf = \"no-such-hand.urdf\"\nlink = \"tip\"\n";
/// let refused = Scene::from_text(text).unwrap_err();
/// let SceneProblem::Urdf(bad) = refused else { panic!("{refused}") };
/// assert!(bad.path.ends_with("no-such-hand.urdf") && matches!(bad.fault, UrdfFault::Unreadable(_)));
/// ```
#[derive(Debug, Error)]
#[error("robot {path}: {fault}", path = .path.display())]
pub struct BadUrdf {
    /// The description.
    pub path: PathBuf,
    /// What is wrong.
    pub fault: UrdfFault,
}

/// What is wrong with a robot's description, or with what a scene asks of it.
///
/// ```
/// use fingertip_scene::UrdfFault;
///
/// let fault = UrdfFault::NoCollision("palm".to_owned());
/// assert!(fault.to_string().starts_with("link \"palm\" has no <collision>"));
/// ```
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum UrdfFault {
    /// The file cannot be read.
    #[error("it cannot be read: {0}")]
    Unreadable(#[from] std::io::Error),
    /// The file is no XML.
    #[error("it is no XML: {0}")]
    Xml(#[from] roxmltree::Error),
    /// The file is no robot.
    #[error(
        "its outermost element is <{0}>, not <robot>; a xacro file is to be expanded first (`xacro hand.xacro > hand.urdf`)"
    )]
    NoRobot(String),
    /// Elements within elements, as no description has them.
    #[error("its elements lie more than {0} deep in each other")]
    TooDeep(usize),
    /// Something in the file is not as it must be.
    #[error("line {line}: {message}")]
    Element {
        /// Where, counted from 1.
        line: u32,
        /// What, and the mend.
        message: String,
    },
    /// A link that is not there.
    #[error("it has no link {name:?}; its links are {known}")]
    NoLink {
        /// As the scene has it.
        name: String,
        /// Those that there are, or the first of them.
        known: String,
    },
    /// A link without collision shapes.
    #[error("link {0:?} has no <collision>; name a link that touches, or describe the surface in the scene")]
    NoCollision(String),
    /// A joint that moves lies between link and sensor.
    #[error(
        "joint {joint:?} between the links {link:?} and {sensor:?} is {kind}, and only fixed joints may lie between them; take a `sensor_link` that moves with the link"
    )]
    Moves {
        /// The joint.
        joint: String,
        /// What it is.
        kind: String,
        /// The fingertip.
        link: String,
        /// Where the sensor is.
        sensor: String,
    },
    /// No joints lead from the one to the other.
    #[error("no joints connect the links {link:?} and {sensor:?}")]
    Apart {
        /// The fingertip.
        link: String,
        /// Where the sensor is.
        sensor: String,
    },
    /// A link that is its own parent by way of its joints.
    #[error("the joints above link {0:?} lead round in a circle")]
    Circle(String),
    /// A mesh that cannot be read.
    #[error("mesh {path} of link {link:?}: {source}", path = .path.display())]
    Mesh {
        /// The link.
        link: String,
        /// The file.
        path: PathBuf,
        /// Why not.
        source: MeshError,
    },
    /// A Collada file that gives no mesh.
    #[error("mesh {path} of link {link:?}: {fault}", path = .path.display())]
    Collada {
        /// The link.
        link: String,
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        fault: Box<UrdfFault>,
    },
    /// A mesh in a format that is not read.
    #[error("mesh {path} of link {link:?} is neither .stl nor .obj nor .dae; convert it", path = .path.display())]
    MeshFormat {
        /// The link.
        link: String,
        /// The file.
        path: PathBuf,
    },
    /// A mesh whose file is not found.
    #[error("mesh {uri:?} of link {link:?} was looked for at {tried}, and is not there")]
    NoMesh {
        /// The link.
        link: String,
        /// As the description names it.
        uri: String,
        /// Where.
        tried: String,
    },
}

impl UrdfSection {
    /// The shape, as a `[surface]` that stands in the scene; files are looked for in `folder`.
    pub(crate) fn shape(&self, folder: &Folder<'_>) -> Result<Value, BadUrdf> {
        let path = folder.file(&self.urdf);
        self.read(&path, folder).map_err(|fault| BadUrdf { path, fault })
    }

    fn read(&self, path: &Path, folder: &Folder<'_>) -> Result<Value, UrdfFault> {
        let text = read_text(path)?;
        let document = xml::parse(&text)?;
        let robot = Robot::of(&document)?;
        let sensor = self.sensor_link.as_deref().unwrap_or(&self.link);
        let sensor_from_link = robot.between(&self.link, sensor)?;
        let mut parts = Vec::new();
        for (origin, shape) in shapes::of_link(robot.link(&self.link)?, &self.link, path, folder)? {
            parts.push(Value::Table(posed(&(sensor_from_link * origin), shape)));
        }
        match parts.len() {
            0 => Err(UrdfFault::NoCollision(self.link.clone())),
            1 => Ok(parts.remove(0)),
            _ => Ok(Value::Table(table([("shape", "compound".into()), ("parts", Value::Array(parts))]))),
        }
    }
}

/// A table of TOML.
fn table<const N: usize>(keys: [(&str, Value); N]) -> Table {
    keys.into_iter().map(|(key, value)| (key.to_owned(), value)).collect()
}

/// A list of numbers.
fn numbers(list: &[f64]) -> Value {
    Value::Array(list.iter().copied().map(Value::Float).collect())
}

/// A shape in another frame; as it is, where the frames are one.
fn posed(pose: &nalgebra::Isometry3<f64>, shape: Table) -> Table {
    if *pose == nalgebra::Isometry3::identity() {
        return shape;
    }
    let turned = pose.rotation.scaled_axis().map(f64::to_degrees);
    table([
        ("shape", "posed".into()),
        ("translation_m", numbers(pose.translation.vector.as_slice())),
        ("rotation_deg", numbers(turned.as_slice())),
        ("surface", Value::Table(shape)),
    ])
}
