//! `fingertip export --c`: a scene as a static library, with what it costs.

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;
use fingertip_scene::{CLibrary, Scalar};

use super::build::{Build, Source};
use super::{failed, play, session};
use crate::error::CliError;
use crate::output::{Outputs, Overwrite};
use crate::scene;

/// Where the library is for, and where it goes.
#[derive(Debug, Args)]
pub(crate) struct LibraryArguments {
    /// With --c: the folder for lib<NAME>.a, <NAME>.h and <NAME>.md, which says what a sample costs
    #[arg(short, long, value_name = "DIR", requires = "c")]
    output: Option<PathBuf>,
    /// With --c: the target as Rust names it, such as thumbv7em-none-eabihf; without it, this computer
    #[arg(long, value_name = "TARGET", requires = "c")]
    target: Option<String>,
    /// With --c: single precision that is never refined in double: a smaller library, less exact at flat angles and under
    /// large spin torques
    #[arg(long, requires = "c")]
    single_only: bool,
    /// With --c: what the names of the functions begin with
    #[arg(long, value_name = "NAME", default_value = "tip", requires = "c")]
    name: String,
    /// With --c: fingertip's source; without it, that which this command was built of, or else the registry's
    #[arg(long, value_name = "DIR", requires = "c")]
    source: Option<PathBuf>,
    /// With --c: a folder where what was compiled stays for the next time
    #[arg(long, value_name = "DIR", requires = "c")]
    build: Option<PathBuf>,
}

pub(super) fn run(
    path: &PathBuf,
    calibration: Option<&PathBuf>,
    scalar: Scalar,
    arguments: &LibraryArguments,
    overwrite: Overwrite,
) -> Result<(), CliError> {
    let LibraryArguments { output, target, single_only, name, source, build } = arguments;
    // The parser asks for it.
    let folder = output.as_deref().unwrap_or(Path::new("."));
    let [library_file, header_file, cost_file] =
        [format!("lib{name}.a"), format!("{name}.h"), format!("{name}.md")].map(|file| folder.join(file));
    let failed = |message: &dyn core::fmt::Display| failed(path, message);
    let mut scene = scene::load_or_simulated(path)?;
    scene::warn_of_doubts(&scene);
    if let Some(calibration) = calibration {
        scene = scene.calibrated_by(calibration).map_err(|error| failed(&error))?;
    }
    if *single_only && matches!(scalar, Scalar::F64) {
        return Err(failed(&"--single-only is for single precision, and --scalar f64 was asked for"));
    }
    let library = scene.to_c(scalar, None, name).map_err(|error| failed(&error))?;
    let library = if *single_only { library.without_mixed_precision() } else { library };
    let mut notes: Vec<String> = library
        .untold()
        .iter()
        .map(|section| format!("the library tells nothing of [{section}]; `--rust` has all of a scene"))
        .collect();

    fs::create_dir_all(folder).map_err(|source| CliError::write("folder", folder, source))?;
    let inputs = core::iter::once(path).chain(calibration).chain(scene.files());
    let outputs = Outputs::guard(overwrite, "the export", inputs, [&library_file, &header_file, &cost_file])?;
    let source = Source::find(source.as_deref());
    let build = Build::new(build.as_deref(), target.as_deref()).map_err(|error| failed(&error))?;
    let compiled = build.compile(&library, name, &source).map_err(|error| failed(&error))?;
    let bytes = fs::read(&compiled).map_err(|source| CliError::Read {
        what: "library",
        path: compiled.clone(),
        source,
    })?;
    let state = CLibrary::state_bytes(&bytes)
        .ok_or_else(|| failed(&"the compiled library does not tell the size of its state"))?;
    let header = library.header(state);

    let session = match scalar {
        Scalar::F32 => session::Session::of::<f32>(&scene, &library),
        Scalar::F64 => session::Session::of::<f64>(&scene, &library),
    }
    .map_err(|error| failed(&error))?;
    let played = play::play(&build, &compiled, &header, name, &session).map_err(|error| failed(&error))?;
    let cost = match &played {
        Ok(cost) => cost.text(scene.name(), target.as_deref(), state),
        Err(missing) => {
            notes.push(format!("what it costs was not measured: {missing}"));
            String::new()
        }
    };
    let mut file = outputs.create("library", &library_file)?;
    file.write_all(&bytes).map_err(|source| CliError::write("library", &library_file, source))?;
    file.finish()?;
    outputs.write("header", &header_file, &header)?;
    if !cost.is_empty() {
        outputs.write("cost", &cost_file, &cost)?;
    }
    outputs.say(&cost, &notes)
}
