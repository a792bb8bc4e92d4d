//! The `fingertip` command: what the crates do, from files to files.
// The examples of its README are commands.
#![cfg_attr(not(doctest), doc = include_str!("../README.md"))]

extern crate alloc;

mod about;
mod analyze;
mod args;
mod bench;
mod calibrate;
mod calibrated;
mod convert;
mod demo;
mod design;
mod error;
mod exit;
mod export;
mod felt;
mod gauge_rows;
mod geometry;
mod health;
mod info;
mod input;
mod live;
mod motion;
mod observe;
mod opened;
mod output;
mod plan;
mod progress;
mod record;
mod recording_file;
mod recover;
mod refine;
mod report;
mod scene;
mod sensor;
mod serve;
mod several;
mod shell;
mod span;
mod standard;
mod stop;
mod summary;
mod table;
mod verbosity;

use std::ffi::OsString;

use clap::{CommandFactory, Parser};

pub use analyze::columns as contact_columns;
pub use analyze::library;
use args::{Arguments, Command};
use error::CliError;
pub use exit::EXIT_CODES;

/// Runs the command with the arguments that a shell gives it, the name of the program first, and gives its exit code.
/// What it says goes to the standard streams, `--help` and what is wrong with the arguments too.
///
/// Programs that have the command within them call this, as the Python package does.
pub fn run<A: Into<OsString> + Clone>(arguments: impl IntoIterator<Item = A>) -> u8 {
    let Arguments { verbosity, command } = match Arguments::try_parse_from(arguments) {
        Ok(arguments) => arguments,
        Err(told) => {
            // As clap does where it ends the program itself: a stream that is closed is no reason to fail.
            let _ = told.print();
            return u8::try_from(told.exit_code()).unwrap_or(exit::USAGE);
        }
    };
    stop::guard(&command);
    let took = verbosity.take_effect();
    let done = match command {
        Command::Demo(arguments) => demo::run(&arguments),
        Command::Analyze(arguments) => analyze::run(&arguments),
        Command::Record(arguments) => record::run(&arguments),
        Command::Live(arguments) => live::run(&arguments),
        Command::Scene(arguments) => scene::command::run(&arguments),
        Command::Export(arguments) => export::run(&arguments),
        Command::Convert(arguments) => convert::run(&arguments),
        Command::Simulate(arguments) => serve::run(&arguments),
        Command::Design(arguments) => design::run(&arguments),
        Command::Bench(arguments) => bench::run(&arguments),
        Command::Calibrate(arguments) => calibrate::calibrate(&arguments),
        Command::Check(arguments) => calibrate::check::run(&arguments),
        Command::Import(arguments) => calibrate::import::run(&arguments),
        Command::Tare(arguments) => calibrate::tare::run(&arguments),
        Command::Plan(arguments) => plan::run(&arguments),
        Command::Geometry(arguments) => geometry::run(&arguments),
        Command::Object(arguments) => analyze::object::run(&arguments),
        Command::Motion(arguments) => motion::run(&arguments),
        Command::Refine(arguments) => refine::run(&arguments),
        Command::Info(arguments) => info::run(&arguments),
        Command::Health(arguments) => health::run(&arguments),
        Command::Recover(arguments) => recover::run(&arguments),
        Command::Completions(arguments) => shell::completions(&arguments, Arguments::command()),
        Command::Man(arguments) => shell::man(&arguments, Arguments::command()),
    };
    took.tell();
    match done {
        // Whoever reads our output may stop when they have seen enough.
        Ok(()) | Err(CliError::ClosedPipe) => exit::DONE,
        Err(error) => {
            eprintln!("error: {}", output::printable(&error.to_string()));
            exit::FAILED
        }
    }
}
