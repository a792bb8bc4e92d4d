//! Ctrl-C, and what else asks a program to end.

use alloc::sync::Arc;
use core::sync::atomic::{AtomicBool, Ordering};

use crate::args::Command;
use crate::exit::INTERRUPTED;
use crate::output::remove_unfinished;

/// Has Ctrl-C take away what is half written, where the command does not listen to it by itself.
pub(crate) fn guard(command: &Command) {
    if !matches!(command, Command::Record(_) | Command::Live(_) | Command::Simulate(_)) {
        // Without it the half stays under a name that says so.
        let _ = ctrlc::set_handler(|| remove_unfinished(|| std::process::exit(INTERRUPTED.into())));
    }
}

/// Turns true when the user wants to end: Ctrl-C, or a request of the system. A second one is no more
/// urgent than the first: what is being written is finished.
#[derive(Clone, Debug, Default)]
pub(crate) struct Stop(Arc<AtomicBool>);

impl Stop {
    /// Listens from now on. Call it once.
    pub(crate) fn listen() -> Self {
        let stop = Self::default();
        let flag = Arc::clone(&stop.0);
        // Without it Ctrl-C ends the program at once, as it ends any other.
        let _ = ctrlc::set_handler(move || flag.store(true, Ordering::Relaxed));
        stop
    }

    /// Whether to end.
    pub(crate) fn is_asked(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    /// Asks for it from within.
    pub(crate) fn ask(&self) {
        self.0.store(true, Ordering::Relaxed);
    }
}
