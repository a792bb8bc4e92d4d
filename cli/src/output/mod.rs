//! What a run leaves: words on the standard output, and files that are whole and none of those it has read.

mod guard;
mod printable;
mod unfinished;
mod whole;

use alloc::rc::Rc;
use core::cell::RefCell;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use clap::Args;

pub(crate) use guard::read_once;
pub(crate) use printable::printable;
pub(crate) use unfinished::remove_all as remove_unfinished;
pub(crate) use whole::Whole;

use crate::error::CliError;
use crate::standard::is_standard;
use crate::verbosity::is_quiet;
use guard::Taken;

/// What every command that writes files asks.
#[derive(Clone, Copy, Debug, Default, Args)]
pub(crate) struct Overwrite {
    /// Write over files that exist
    #[arg(long)]
    pub(crate) overwrite: bool,
}

impl Overwrite {
    /// Asked for by another name, too.
    pub(crate) const fn or(self, force: bool) -> Self {
        Self { overwrite: self.overwrite || force }
    }
}

/// The files that a run writes: none before they were compared with what it reads, and with one another.
#[derive(Debug)]
pub(crate) struct Outputs {
    overwrite: bool,
    taken: Rc<Taken>,
    /// One of them is the standard output: words then go to the standard error.
    to_stdout: bool,
    written: RefCell<Vec<PathBuf>>,
}

impl Outputs {
    /// Refuses to write over what is read, twice into one file, or without `--overwrite` over what is there; `what` the
    /// outputs are is for the message.
    pub(crate) fn guard<'a>(
        Overwrite { overwrite }: Overwrite,
        what: &'static str,
        inputs: impl IntoIterator<Item = &'a PathBuf>,
        outputs: impl IntoIterator<Item = &'a PathBuf>,
    ) -> Result<Self, CliError> {
        let outputs: Vec<&Path> = outputs.into_iter().map(PathBuf::as_path).collect();
        let inputs: Vec<&Path> = inputs.into_iter().map(PathBuf::as_path).collect();
        let taken = guard::check(overwrite, what, &inputs, &outputs)?.into();
        let to_stdout = outputs.iter().any(|path| is_standard(path));
        Ok(Self { overwrite, taken, to_stdout, written: RefCell::default() })
    }

    /// Refuses to write over what turned out to be read, too: what a scene names.
    pub(crate) fn spare<'a>(&self, inputs: impl IntoIterator<Item = &'a PathBuf>) -> Result<(), CliError> {
        inputs.into_iter().try_for_each(|input| self.taken.spare(input))
    }

    /// The same of a part of the run that speaks of its own files alone.
    pub(crate) fn part(&self) -> Self {
        Self { taken: self.taken.clone(), written: RefCell::default(), ..*self }
    }

    /// Begins a file. It appears when it is finished, and is then among those that [`say`](Self::say) names.
    pub(crate) fn create(&self, what: &'static str, path: &Path) -> Result<Whole, CliError> {
        let file = Whole::create(what, path, self.overwrite)?;
        if !is_standard(path) {
            self.written.borrow_mut().push(path.to_owned());
        }
        Ok(file)
    }

    /// Writes a file of text.
    pub(crate) fn write(&self, what: &'static str, path: &Path, text: &str) -> Result<(), CliError> {
        self.write_bytes(what, path, text.as_bytes())
    }

    /// Writes a file.
    pub(crate) fn write_bytes(&self, what: &'static str, path: &Path, bytes: &[u8]) -> Result<(), CliError> {
        let mut file = self.create(what, path)?;
        file.write_all(bytes).map_err(|source| CliError::write(what, path, source))?;
        file.finish()
    }

    /// Prints a text, what to mind, and what was written; if anything was, unless the run is to be quiet.
    pub(crate) fn say(&self, text: &str, notes: &[String]) -> Result<(), CliError> {
        let mut text = text.to_owned();
        for note in notes {
            text.push_str(&format!("note: {note}\n"));
        }
        let written = self.written();
        if !written.is_empty() {
            text.push_str(&format!("\n{written}"));
        }
        self.tell(&text)
    }

    /// Prints what is said of files that were written, unless the run is to be quiet.
    pub(crate) fn tell(&self, text: &str) -> Result<(), CliError> {
        let is_beside = self.to_stdout || !self.written.borrow().is_empty();
        if is_beside && is_quiet() { Ok(()) } else { self.print(text) }
    }

    /// Prints to the standard output, or to the standard error if the former is one of the files.
    pub(crate) fn print(&self, text: &str) -> Result<(), CliError> {
        if self.to_stdout {
            // If even the standard error is closed, there is nobody left to tell.
            let _ = io::stderr().write_all(printable(text).as_bytes());
            return Ok(());
        }
        print(text)
    }

    /// The names of what was written.
    pub(crate) fn names(&self) -> Vec<String> {
        self.written.borrow().iter().map(|path| path.display().to_string()).collect()
    }

    /// The line that names what was written.
    pub(crate) fn written(&self) -> String {
        let names = self.names();
        if names.is_empty() { String::new() } else { format!("Written: {}\n", names.join(", ")) }
    }
}

/// Prints to the standard output, at once; names and texts of files cannot steer the terminal.
pub(crate) fn print(text: &str) -> Result<(), CliError> {
    print_exactly(&printable(text))
}

/// Prints what is ours to the last byte.
pub(crate) fn print_exactly(text: &str) -> Result<(), CliError> {
    let mut stdout = io::stdout();
    stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()).map_err(CliError::stdout)
}
