//! The scene that a command is given: a file, or that of the simulated fingertip.

pub(crate) mod command;
mod simulated;

use std::path::Path;

use fingertip_scene::{Scene, SceneError};

pub(crate) use simulated::least_static_coefficient;

use crate::error::CliError;

/// Reads and checks a scene.
pub(crate) fn load(path: &Path) -> Result<Scene, CliError> {
    Scene::load(path).map_err(|error| match error {
        SceneError::Unreadable { path, source } => CliError::read("scene", &path, source),
        other => CliError::Scene(other),
    })
}

/// The same; `sim` is that of the simulated fingertip, unless there is a file of this name.
pub(crate) fn load_or_simulated(path: &Path) -> Result<Scene, CliError> {
    if path == Path::new("sim") && !path.exists() { simulated::scene() } else { load(path) }
}
