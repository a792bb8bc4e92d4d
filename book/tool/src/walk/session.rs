//! A reader at a shell, in a folder that was empty.

use std::ffi::OsString;
use std::fs::File;
use std::io::{self, Read, Seek};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::failure::Failure;
use crate::pages::sources;
use crate::reference::program;

/// What is between a block's output and the folder in which it ends.
const END: &str = "\u{1}folder ";

/// A shell that remembers the folder from one block to the next.
pub(super) struct Session {
    folder: PathBuf,
    project: PathBuf,
    path: OsString,
    targets: PathBuf,
}

impl Session {
    pub(super) fn new(folder: &Path) -> Result<Self, Failure> {
        let project = sources().join("../..");
        let project = project.canonicalize().map_err(Failure::file(&project))?;
        let program = program()?;
        let mut paths: Vec<PathBuf> = program.parent().map(Path::to_owned).into_iter().collect();
        paths.extend(std::env::var_os("PATH").iter().flat_map(std::env::split_paths));
        let path = std::env::join_paths(paths).map_err(|error| Failure::Command(error.to_string()))?;
        // One folder for what tutorials compile, so that the next walk is fast.
        let targets = project.join("target/tutorials");
        Ok(Self { folder: folder.to_owned(), project, path, targets })
    }

    /// Writes a file into the folder where the shell is.
    pub(super) fn write(&self, file: &str, contents: &str) -> Result<(), Failure> {
        let path = self.folder.join(file);
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder).map_err(Failure::file(folder))?;
        }
        std::fs::write(&path, contents).map_err(Failure::file(&path))
    }

    /// Runs commands and gives what they print on the standard output.
    pub(super) fn run(&mut self, commands: &str) -> Result<String, String> {
        let script = format!("{commands}\nprintf '{END}%s' \"$PWD\"\n");
        let said = |error: io::Error| format!("bash: {error}");
        // Files rather than pipes: what a block leaves running in the background holds them open.
        let (mut printed, mut errors) =
            (tempfile::tempfile().map_err(said)?, tempfile::tempfile().map_err(said)?);
        let status = Command::new("bash")
            .args(["-euo", "pipefail", "-c", &script])
            .current_dir(&self.folder)
            .env("FINGERTIP", &self.project)
            .env("PATH", &self.path)
            .env("CARGO_TARGET_DIR", &self.targets)
            .env("CARGO_TERM_QUIET", "true")
            .stdin(Stdio::null())
            .stdout(printed.try_clone().map_err(said)?)
            .stderr(errors.try_clone().map_err(said)?)
            .status()
            .map_err(said)?;
        let printed = whole(&mut printed).map_err(said)?;
        if !status.success() {
            let errors = whole(&mut errors).map_err(said)?;
            return Err(format!("{status}\n$ {}\n{printed}{errors}", commands.trim_end()));
        }
        let (text, folder) = printed.rsplit_once(END).ok_or("the commands end the shell")?;
        self.folder = PathBuf::from(folder);
        Ok(text.to_owned())
    }
}

/// All that was written into a file, from its beginning.
fn whole(file: &mut File) -> io::Result<String> {
    let mut bytes = Vec::new();
    file.rewind()?;
    file.read_to_end(&mut bytes)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}
