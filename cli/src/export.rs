//! `fingertip export`: a scene as what runs without files.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use fingertip_scene::Scalar;

use crate::calibrate::files::read_calibration;
use crate::error::CliError;
use crate::output::{Outputs, Overwrite};
use crate::scene;

/// A scene as a Rust module, as JSON, or both.
#[derive(Debug, Args)]
pub(crate) struct ExportArguments {
    /// The scene (examples/scenes/README.md), or `sim` for that of the simulated fingertip
    #[arg(value_name = "SCENE.toml")]
    scene: PathBuf,
    /// Write a Rust module with the typed pipeline and a function that makes it: no files, no standard library, no heap
    /// but for meshes and heightfields
    #[arg(long, value_name = "TIP.rs", required_unless_present = "json")]
    rust: Option<PathBuf>,
    /// The precision of the module
    #[arg(long, value_enum, default_value_t = Precision::F64, requires = "rust")]
    scalar: Precision,
    /// The calibration of the sensor, so that the module begins with readings of its gauges, not with wrenches
    #[arg(long, value_name = "CAL", requires = "rust")]
    calibration: Option<PathBuf>,
    /// Write the scene with all defaults filled in, and a mesh in the place of its file
    #[arg(long, value_name = "SCENE.json")]
    json: Option<PathBuf>,
    #[command(flatten)]
    overwrite: Overwrite,
}

/// The precision of a module.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Precision {
    F32,
    F64,
}

pub(crate) fn run(arguments: &ExportArguments) -> Result<(), CliError> {
    let ExportArguments { scene: path, rust, scalar, calibration, json, overwrite } = arguments;
    let inputs = core::iter::once(path).chain(calibration);
    let outputs = Outputs::guard(*overwrite, "the export", inputs, rust.iter().chain(json))?;
    let scene = scene::load_or_simulated(path)?;
    let calibration = calibration.as_deref().map(read_calibration).transpose()?;
    let failed = |error: fingertip_scene::ExportError| CliError::Export {
        path: path.clone(),
        message: error.to_string(),
    };
    let scalar = match scalar {
        Precision::F32 => Scalar::F32,
        Precision::F64 => Scalar::F64,
    };
    // Both texts before a file is written: what cannot be exported leaves none behind.
    let mut files = Vec::new();
    if let Some(path) = rust {
        files.push(("Rust file", path, scene.to_rust(scalar, calibration.as_ref()).map_err(failed)?));
    }
    if let Some(path) = json {
        files.push(("JSON file", path, scene.to_json().map_err(failed)?));
    }
    for (what, path, text) in &files {
        outputs.write(what, path, text)?;
    }
    outputs.print(&outputs.written())
}
