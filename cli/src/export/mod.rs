//! `fingertip export`: a scene as what runs without files.

mod build;
mod library;
mod play;
mod session;

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use fingertip_scene::Scalar;

use crate::calibrate::files::read_calibration;
use crate::error::CliError;
use crate::output::{Outputs, Overwrite};
use crate::scene;

/// A scene as a Rust module, as JSON, or as a library for C.
#[derive(Debug, Args)]
pub(crate) struct ExportArguments {
    /// The scene (book/src/reference/scene.md), or `sim` for that of the simulated fingertip
    #[arg(value_name = "SCENE.toml")]
    scene: PathBuf,
    /// Write a Rust module with the typed pipeline and a function that makes it: no files, no standard library, no heap
    /// but for meshes and heightfields
    #[arg(long, value_name = "TIP.rs", required_unless_present_any = ["json", "c"], group = "typed")]
    rust: Option<PathBuf>,
    /// The precision of the module (f64 if none is given) or of the library (f32)
    #[arg(long, value_enum, requires = "typed")]
    scalar: Option<Precision>,
    /// The calibration of the sensor, so that the module begins with readings of its gauges, not with wrenches
    #[arg(long, value_name = "CAL", requires = "typed")]
    calibration: Option<PathBuf>,
    /// Write the scene with all defaults filled in, and a mesh in the place of its file
    #[arg(long, value_name = "SCENE.json")]
    json: Option<PathBuf>,
    /// Make a static library and a header of three functions for C; it takes cargo
    #[arg(long, requires = "output", conflicts_with_all = ["rust", "json"], group = "typed")]
    c: bool,
    #[command(flatten)]
    library: library::LibraryArguments,
    #[command(flatten)]
    overwrite: Overwrite,
}

/// The precision of a module.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Precision {
    F32,
    F64,
}

impl Precision {
    const fn scalar(self) -> Scalar {
        match self {
            Self::F32 => Scalar::F32,
            Self::F64 => Scalar::F64,
        }
    }
}

/// What an export that fails says.
fn failed(path: &Path, message: &dyn core::fmt::Display) -> CliError {
    CliError::Export { path: path.to_owned(), message: message.to_string() }
}

pub(crate) fn run(arguments: &ExportArguments) -> Result<(), CliError> {
    let ExportArguments { scene: path, rust, scalar, calibration, json, c, library, overwrite } = arguments;
    if *c {
        let scalar = scalar.unwrap_or(Precision::F32).scalar();
        return library::run(path, calibration.as_ref(), scalar, library, *overwrite);
    }
    let inputs = core::iter::once(path).chain(calibration);
    let outputs = Outputs::guard(*overwrite, "the export", inputs, rust.iter().chain(json))?;
    let scene = scene::load_or_simulated(path)?;
    outputs.spare(scene.files())?;
    scene::warn_of_doubts(&scene);
    let calibration = calibration.as_deref().map(read_calibration).transpose()?;
    let scalar = scalar.unwrap_or(Precision::F64).scalar();
    // Both texts before a file is written: what cannot be exported leaves none behind.
    let mut files = Vec::new();
    if let Some(to) = rust {
        let text = scene.to_rust(scalar, calibration.as_ref()).map_err(|error| failed(path, &error))?;
        files.push(("Rust file", to, text));
    }
    if let Some(to) = json {
        files.push(("JSON file", to, scene.to_json().map_err(|error| failed(path, &error))?));
    }
    for (what, path, text) in &files {
        outputs.write(what, path, text)?;
    }
    outputs.tell(&outputs.written())
}
