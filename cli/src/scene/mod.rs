//! The scene that a command is given: a file, or that of the simulated fingertip.

pub(crate) mod command;
mod simulated;

use std::path::Path;

use fingertip_calibration::file::{FileError, ReadError};
use fingertip_scene::{BadCarried, BadSensor, Scene, SceneError, SceneProblem};

pub(crate) use simulated::least_static_coefficient;

use crate::calibrate::files::{bad, text};
use crate::error::CliError;
use crate::output::printable;
use crate::progress::working;
use crate::standard::{is_standard, shown};
use crate::verbosity::{detail, is_quiet};

/// Checks the text of a scene that came by the standard input, whose files are looked for where the command runs.
pub(crate) fn of_standard(text: &str) -> Result<Scene, CliError> {
    let fault = |fault| CliError::Scene(SceneError::Fault { path: shown("-".as_ref()).into(), fault });
    Scene::parse(text, "scene", Path::new("")).map_err(fault)
}

/// Reads and checks a scene; `-` is the standard input.
pub(crate) fn load(path: &Path) -> Result<Scene, CliError> {
    if is_standard(path) {
        return of_standard(&text("scene", path)?);
    }
    detail(|| format!("reads scene {}", shown(path)));
    // A mesh may have millions of triangles.
    working("builds the scene", || Scene::load(path)).map_err(|error| match error {
        SceneError::Unreadable { path, source } => CliError::read("scene", &path, source),
        other => CliError::Scene(other),
    })
}

/// With the calibration and the payload that the command line gives in the place of the scene's own.
pub(crate) fn with(
    scene: Scene,
    calibration: Option<&Path>,
    payload: Option<&Path>,
) -> Result<Scene, CliError> {
    let scene = match calibration {
        Some(path) => scene.calibrated_by(path).map_err(|error| replaced("calibration", path, error))?,
        None => scene,
    };
    match payload {
        Some(path) => scene.carrying(path).map_err(|error| replaced("payload", path, error)),
        None => Ok(scene),
    }
}

/// Says on the standard error what in a scene can be and is hardly meant, for a run that has no other place for it.
pub(crate) fn warn_of_doubts(scene: &Scene) {
    if !is_quiet() {
        scene.doubts().iter().for_each(|doubt| eprintln!("warning: {}", printable(doubt)));
    }
}

/// Names the file of the command line, which is not that of the scene.
fn replaced(what: &'static str, path: &Path, problem: SceneProblem) -> CliError {
    let named = |message: String| CliError::Calibration { path: path.to_owned(), message };
    match problem {
        SceneProblem::Sensor { source, .. } => match *source {
            BadSensor::Read(ReadError::Io(source)) => CliError::read(what, path, source),
            other => named(other.to_string()),
        },
        SceneProblem::Payload { source, .. } => match *source {
            BadCarried::File(FileError::Io { source, .. }) => CliError::read(what, path, source),
            other => bad(path, &other),
        },
        other => named(other.to_string()),
    }
}

/// As [`load`]; `sim` is that of the simulated fingertip, unless there is a file of this name.
pub(crate) fn load_or_simulated(path: &Path) -> Result<Scene, CliError> {
    if path == Path::new("sim") && !path.exists() { simulated::scene() } else { load(path) }
}
