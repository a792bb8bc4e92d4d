//! What the book is made of: the reference, from the lists that the code itself reads; the pictures, computed by the
//! library; its links; and a walker that does what the tutorials tell.
//!
//! `mdbook build book` calls `fingertip-book preprocess`; `.ci/book` the rest.

mod built;
mod failure;
mod labels;
mod links;
mod pages;
mod pictures;
mod reference;
mod walk;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Parser, Subcommand};

use failure::Failure;

/// Makes what the book is made of.
#[derive(Debug, Parser)]
#[command(version)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Writes the pages of the reference
    Reference {
        /// Writes nothing, and fails if a page is not what it would be
        #[arg(long)]
        check: bool,
    },
    /// Draws the pictures
    Pictures {
        /// Writes nothing, and fails if a picture is not what it would be
        #[arg(long)]
        check: bool,
    },
    /// Does what tutorials tell, each in an empty folder, and compares what they say comes out
    Walk {
        /// Tutorials; all of them by default
        tutorials: Vec<PathBuf>,
        /// Keeps the folders
        #[arg(long)]
        keep: bool,
    },
    /// Checks the links of the book as it was built
    Links {
        /// Where it was built
        #[arg(default_value = "target/book")]
        folder: PathBuf,
    },
    /// Mends the links of the book and names the blocks of its tutorials, as a preprocessor of mdBook
    Preprocess {
        /// What mdBook asks first: `supports RENDERER`
        question: Vec<String>,
    },
}

fn run(command: Command) -> Result<(), Failure> {
    match command {
        Command::Reference { check } => pages::settle(&reference::pages()?, "reference", check),
        Command::Pictures { check } => pages::settle(&pictures::pictures()?, "pictures", check),
        Command::Walk { tutorials, keep } => walk::walk(&tutorials, keep),
        Command::Links { folder } => {
            let folder = folder.canonicalize().map_err(Failure::file(&folder))?;
            built::check(&folder)
        }
        Command::Preprocess { question } if question.is_empty() => links::preprocess(),
        // Links are the same for every renderer.
        Command::Preprocess { .. } => Ok(()),
    }
}

fn main() -> ExitCode {
    match run(Arguments::parse().command) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("error: {failure}");
            ExitCode::FAILURE
        }
    }
}
