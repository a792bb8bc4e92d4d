//! Sources around sources: watch how fresh samples are, record them, pace them, break them, solve them.
//!
//! Each wraps any source and is one itself, so that they stack:
//! `Watched::new(Recorder::new(client, log), None)`. Errors of the source inside pass through
//! unchanged; the `FaultInjector` adds one of its own.

mod recorder;
mod solved;
mod supervised;
mod watch;

#[cfg(feature = "simulators")]
mod fault_injector;
#[cfg(feature = "std")]
mod paced;

pub use recorder::Recorder;
pub use solved::Solved;
pub use supervised::{OnLoss, Supervised, SupervisedError};
pub use watch::{Fresh, ReadCounts, Watch, Watched};

#[cfg(feature = "simulators")]
pub use fault_injector::{FaultInjector, InjectedError, Injections, SampleFaults};
#[cfg(feature = "std")]
pub use paced::Paced;
