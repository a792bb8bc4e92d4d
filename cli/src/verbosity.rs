//! How much a run says beside what it is asked for.

use core::sync::atomic::{AtomicU8, Ordering};
use std::time::Instant;

use clap::Args;

use crate::output::printable;

/// Of the run of this process, as the standard streams are: usual, quiet or verbose.
static LEVEL: AtomicU8 = AtomicU8::new(USUAL);

const USUAL: u8 = 0;
const QUIET: u8 = 1;
const VERBOSE: u8 = 2;

/// What every command asks.
#[derive(Clone, Copy, Debug, Default, Args)]
pub(crate) struct Verbosity {
    /// Show no progress, and say nothing of a run that writes files, but errors
    #[arg(short, long, global = true, conflicts_with = "verbose", display_order = 900)]
    quiet: bool,
    /// Say on the standard error what is read and written, and how long it took
    #[arg(short, long, global = true, display_order = 901)]
    verbose: bool,
}

impl Verbosity {
    /// From here on.
    pub(crate) fn take_effect(self) -> Took {
        let level = match (self.quiet, self.verbose) {
            (true, _) => QUIET,
            (_, true) => VERBOSE,
            _ => USUAL,
        };
        LEVEL.store(level, Ordering::Relaxed);
        Took(Instant::now())
    }
}

/// Whether nothing is to be said but errors.
pub(crate) fn is_quiet() -> bool {
    LEVEL.load(Ordering::Relaxed) == QUIET
}

/// Says what only those want to know who asked for it.
pub(crate) fn detail(said: impl FnOnce() -> String) {
    if LEVEL.load(Ordering::Relaxed) == VERBOSE {
        eprintln!("{}", printable(&said()));
    }
}

/// Since when a run goes on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Took(Instant);

impl Took {
    /// Says how long that was.
    pub(crate) fn tell(self) {
        detail(|| format!("took {:.2} s", self.0.elapsed().as_secs_f64()));
    }
}
