//! What can be wrong with a scene.

use std::io;
use std::path::PathBuf;

use fingertip::friction::BadParameter;
use fingertip::surfaces::{BadShape, MeshError};
use fingertip::wrench::BadPayload;
use fingertip_calibration::file::FileError;
use thiserror::Error;

use crate::formula::{BadFormula, FormulaFault};
use crate::sensor::BadSensor;
use crate::urdf::BadUrdf;

/// The newest version of the format that is read; older ones are, too.
pub const VERSION: u32 = 2;

/// A scene that is not as it must be: in which file, on which line, what, and how to mend it.
///
/// ```
/// use fingertip_scene::{Scene, SceneError};
///
/// let refused = Scene::load("no-such-scene.toml").unwrap_err();
/// assert!(matches!(refused, SceneError::Unreadable { .. }));
/// assert!(refused.to_string().starts_with("cannot read the scene no-such-scene.toml: "));
/// ```
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SceneError {
    /// The file cannot be read.
    #[error("cannot read the scene {path}: {source}", path = .path.display())]
    Unreadable {
        /// Which file.
        path: PathBuf,
        /// Why not.
        source: io::Error,
    },
    /// Something in it is wrong.
    #[error("scene {path}{line}: {problem}", path = .path.display(), line = Line(.fault.line), problem = .fault.problem)]
    Fault {
        /// Which file.
        path: PathBuf,
        /// What, and where.
        fault: SceneFault,
    },
}

/// A line, if it is known, behind a path.
struct Line(Option<usize>);

impl core::fmt::Display for Line {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        self.0.map_or(Ok(()), |line| write!(f, ", line {line}"))
    }
}

/// What is wrong, and on which line, if that is known.
///
/// ```
/// use std::path::Path;
///
/// use fingertip_scene::Scene;
///
/// let text = "version = 2\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"sphere\"\nradius_mm = 13\n";
/// let fault = Scene::parse(text, "ball", Path::new(".")).unwrap_err();
/// assert_eq!(fault.line, Some(4));
/// assert!(fault.problem.to_string().contains("radius_m"));
/// ```
#[derive(Debug)]
pub struct SceneFault {
    /// Counted from 1.
    pub line: Option<usize>,
    /// What is wrong.
    pub problem: SceneProblem,
}

impl From<SceneProblem> for SceneFault {
    fn from(problem: SceneProblem) -> Self {
        Self { line: None, problem }
    }
}

/// What is wrong. Each message names the key that the user wrote or has to write.
///
/// ```
/// use fingertip_scene::{Scene, SceneProblem};
///
/// let refused = Scene::from_text("[surface]\nshape = \"sphere\"\nradius_m = 0.013\n").unwrap_err();
/// assert!(matches!(refused, SceneProblem::NoVersion));
/// assert_eq!(refused.to_string(), "it does not state its version; put `version = 2` on its first line");
/// ```
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SceneProblem {
    /// A key is wrong, missing or not known.
    #[error("{key}{message} (the keys are explained in book/src/reference/scene.md)")]
    Key {
        /// Which, with a colon, or nothing where the message names it.
        key: String,
        /// What the parser says.
        message: String,
    },
    /// Another version than is read here.
    #[error(
        "it has version {0}, but this program reads versions 1 to {VERSION}; install the fingertip that fits"
    )]
    OtherVersion(u32),
    /// No version is stated.
    #[error("it does not state its version; put `version = {VERSION}` on its first line")]
    NoVersion,
    /// A number that must be positive is not.
    #[error("`{key}` must be a positive number, not {found}")]
    NotPositive {
        /// Which key.
        key: &'static str,
        /// Its value.
        found: f64,
    },
    /// A unit that is not known.
    #[error(
        "`{key}` of [input.units] is {unit:?}, which is no unit that is known; write it as N, N*mm, lbf, ms, mV, counts or the like"
    )]
    Unit {
        /// Of which quantity.
        key: &'static str,
        /// As the user wrote it.
        unit: String,
    },
    /// A column that means nothing.
    #[error(
        "`{0}` of [input.columns] is no quantity; there are time, fx, fy, fz, tx, ty, tz, v1 and so on, dummy, temperature_C, ax, ay, az, wx, wy and wz, and a minus for all but time"
    )]
    Column(String),
    /// The pose is none.
    #[error("`translation_m` and `rotation_deg` of the pose must be finite numbers")]
    Pose,
    /// A map where none is needed.
    #[error("[map] is for other shapes than plane, sphere and cylinder, whose maps need none")]
    NeedlessMap,
    /// The middle of the map is none.
    #[error("`centre_m` of [map] must be finite numbers")]
    MapCentre,
    /// The pole of the map is none.
    #[error("`pole` of [map] must be a direction: finite and not zero")]
    MapPole,
    /// The grain of a flat surface is none.
    #[error("`grain` of [friction] must be a direction along the surface, in the surface's frame")]
    Grain,
    /// A shape, a contact model or an uncertainty whose numbers cannot be.
    #[error(transparent)]
    Shape(#[from] BadShape),
    /// A formula that cannot be.
    #[error(transparent)]
    Formula(#[from] BadFormula),
    /// A mesh that cannot be read.
    #[error("mesh {path}: {source}", path = .path.display())]
    Mesh {
        /// Its file.
        path: PathBuf,
        /// Why not.
        source: MeshError,
    },
    /// A robot's description that gives no surface.
    #[error(transparent)]
    Urdf(Box<BadUrdf>),
    /// A friction or a detector whose numbers cannot be.
    #[error(transparent)]
    Friction(#[from] BadParameter),
    /// A calibration, or the matrix of a sensor, that cannot be.
    #[error("{name}: {source}")]
    Sensor {
        /// Where it stands.
        name: String,
        /// What is wrong with it.
        source: Box<BadSensor>,
    },
    /// What the sensor carries cannot be.
    #[error("{name}: {source}")]
    Payload {
        /// Where it stands.
        name: String,
        /// What is wrong with it.
        source: Box<BadCarried>,
    },
    /// A number that is out of its range.
    #[error("`{key}` of [{section}] must be {requirement}")]
    Range {
        /// Which key.
        key: &'static str,
        /// In which section.
        section: &'static str,
        /// What it must be.
        requirement: &'static str,
    },
    /// One part of the scene asks for another.
    #[error("{what} needs {needed}")]
    Needs {
        /// Which part.
        what: &'static str,
        /// What is missing.
        needed: &'static str,
    },
    /// A key that belongs to another choice.
    #[error("`{key}` of [{section}] is for {belongs}; take it out, or choose that")]
    Misplaced {
        /// In which section.
        section: &'static str,
        /// Which key.
        key: &'static str,
        /// To what it belongs.
        belongs: &'static str,
    },
}

/// Why a payload cannot be used.
///
/// ```
/// # const BALL: &str = "version = 2\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"sphere\"\nradius_m = 0.013\n";
/// use fingertip_scene::{BadCarried, Scene, SceneProblem};
///
/// let payload = "[payload]\nmass_kg = -0.1\ncentre_of_mass_m = [0.0, 0.0, 0.02]\n";
/// let refused = Scene::from_text(&format!("{BALL}{payload}")).unwrap_err();
/// let SceneProblem::Payload { source, .. } = &refused else { panic!("{refused}") };
/// assert!(matches!(**source, BadCarried::File(_)));
/// assert!(refused.to_string().contains("mass_kg"));
/// ```
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum BadCarried {
    /// Its file, or a number of it.
    #[error(transparent)]
    File(#[from] FileError),
    /// Its body.
    #[error(transparent)]
    Body(#[from] BadPayload),
}

impl From<BadUrdf> for SceneProblem {
    fn from(bad: BadUrdf) -> Self {
        Self::Urdf(Box::new(bad))
    }
}

impl From<FormulaFault> for SceneProblem {
    fn from(fault: FormulaFault) -> Self {
        match fault {
            FormulaFault::Formula(bad) => bad.into(),
            FormulaFault::Shape(bad) => bad.into(),
        }
    }
}
