//! What can be wrong with a scene.

use std::path::PathBuf;

use fingertip::friction::BadParameter;
use fingertip::surfaces::{BadShape, MeshError};
use thiserror::Error;

/// The version of the format that this program reads.
pub(super) const VERSION: u32 = 1;

/// What is wrong, and on which line, if that is known.
#[derive(Debug)]
pub(crate) struct SceneFault {
    pub(crate) line: Option<usize>,
    pub(crate) problem: SceneProblem,
}

impl From<SceneProblem> for SceneFault {
    fn from(problem: SceneProblem) -> Self {
        Self { line: None, problem }
    }
}

/// What is wrong. Each message names the key that the user wrote or has to write.
#[derive(Debug, Error)]
pub(crate) enum SceneProblem {
    /// A key is wrong, missing or not known.
    #[error("{key}{message} (the keys are explained in examples/scenes/README.md)")]
    Key { key: String, message: String },
    #[error("it has version {0}, but this program reads version {VERSION}; install the fingertip that fits")]
    OtherVersion(u32),
    #[error("it does not state its version; put `version = {VERSION}` on its first line")]
    NoVersion,
    #[error("`{key}` must be a positive number, not {found}")]
    NotPositive { key: &'static str, found: f64 },
    #[error("`translation_m` and `rotation_deg` of the pose must be finite numbers")]
    Pose,
    #[error("[map] is for other shapes than plane, sphere and cylinder, whose maps need none")]
    NeedlessMap,
    #[error("`centre_m` of [map] must be finite numbers")]
    MapCentre,
    #[error("`pole` of [map] must be a direction: finite and not zero")]
    MapPole,
    #[error(transparent)]
    Shape(#[from] BadShape),
    #[error("mesh {path}: {source}", path = .path.display())]
    Mesh { path: PathBuf, source: MeshError },
    #[error(transparent)]
    Friction(#[from] BadParameter),
    #[error("the `threshold` detector needs the section [friction] with `static_coefficient`")]
    NoFriction,
}
