//! Why nothing can be said of creep.

use thiserror::Error;

/// Why nothing can be said of creep.
///
/// ```
/// # use fingertip_calibration::{Axis, file::SignalUnit, loads::LoadTable, nalgebra::DMatrix};
/// # // Three forces one after another, up to ±9.5 N; each has a gauge of 0.1 V/N, and they scatter by a millivolt.
/// # let loads = DMatrix::from_fn(60, 3, |i, j| if i % 3 == j { (i / 3) as f64 - 9.5 } else { 0.0 });
/// # let signals = loads.map_with_location(|i, j, newtons| 0.1 * newtons + 1e-3 * ((7 * i + 3 * j) as f64).sin());
/// # let table = LoadTable::new(&Axis::FORCES, loads, signals, SignalUnit::Volt)?;
/// use fingertip_calibration::creep::{CreepError, fit};
///
/// // Without the time of each sample nothing can be said of creep.
/// assert!(matches!(fit(&table, false), Err(CreepError::NoTimes)));
/// # Ok::<(), fingertip_calibration::loads::LoadError>(())
/// ```
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
