//! Why nothing can be said of creep.

use thiserror::Error;

/// Why nothing can be said of creep.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum CreepError {
    /// Creep goes by time.
    #[error("creep needs the time of every sample: give a column t_s")]
    NoTimes,
    /// A time is before that of the sample before it, in the same group.
    #[error("{sample}: its time is before that of the sample before it in the same group")]
    TimeGoesBack {
        /// Which sample.
        sample: String,
    },
    /// A group does not begin without load.
    #[error("{sample}: its group begins under load; creep needs groups that begin settled and without load")]
    BeginsLoaded {
        /// Its first sample.
        sample: String,
    },
    /// Too few load cycles to leave some out.
    #[error(
        "there are {found} load cycles, from no load to loads and back, and creep needs {needed} at least: some are left \
         out to see what its compensation is worth"
    )]
    TooFewCycles {
        /// How many there are.
        found: usize,
        /// How many it takes.
        needed: usize,
    },
    /// The samples are too few, or too far apart.
    #[error("the samples are too few or too far apart to tell how readings change under a load that stays")]
    TooCoarse,
    /// Shares for another number of gauges.
    #[error("the shares of creep are not those of a sensor with {expected} gauges")]
    OtherGauges {
        /// How many there are.
        expected: usize,
    },
}
