//! Readings that go on changing under a load that does not (`docs/theory/calibration.md#creep`).

mod cycles;
mod error;
mod fit;
mod sums;

pub use error::CreepError;
pub use fit::{CreepFit, fit};

use fingertip_wrench::CreepCompensation;
use nalgebra::{DMatrix, DVector, Vector1};
use serde::{Deserialize, Serialize};

use crate::loads::LoadTable;

/// Times over which a sensor creeps, and the share of a lasting signal that each takes off: see
/// [`CreepCompensation`].
///
/// ```
/// use fingertip_calibration::creep::Creep;
/// use fingertip_calibration::{Axis, file::SignalUnit, loads::LoadTable, nalgebra::DMatrix};
///
/// // Of a lasting signal 5 % is creep, within 10 s.
/// let creep = Creep { times_s: vec![10.0], shares: vec![vec![0.05]] };
/// // 10 N of 0.1 V/N for a minute, read each second; at 0 s there was no load.
/// let newtons = DMatrix::from_fn(60, 1, |second, _| if second == 0 { 0.0 } else { 10.0 });
/// let volts = newtons.map_with_location(|second, _, newtons| {
///     0.1 * newtons * 0.95 / (1.0 - 0.05 * (1.0 + 0.05 - (-(second as f64) / 10.0).exp()))
/// });
/// let mut table = LoadTable::new(&[Axis::Fz], newtons, volts, SignalUnit::Volt)?;
/// table.times = Some((0..60).map(f64::from).collect());
/// let settled = creep.taken_off(&table)?;
/// // Less of the reading is left the longer the load lasts: in the end 95 % of it.
/// assert!((settled.signals[59] / table.signals[59] - 0.95).abs() < 2e-3);
/// assert!(settled.signals[1] / table.signals[1] > 0.99);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Creep {
    /// The times \[s\].
    pub times_s: Vec<f64>,
    /// For each time, the share of each gauge.
    pub shares: Vec<Vec<f64>>,
}

impl Creep {
    /// Most times that are told apart.
    pub const MOST: usize = 3;

    /// The table with readings as they would have been without creep. Each [group](LoadTable::groups) begins settled and
    /// without load, its zero being the mean of its readings up to the first load.
    ///
    /// # Errors
    /// [`CreepError`] for a table without times, of another number of gauges, or of which a group does not begin so.
    pub fn taken_off(&self, table: &LoadTable) -> Result<LoadTable, CreepError> {
        let gauges = table.gauges();
        if self.shares.iter().any(|shares| shares.len() != gauges) || self.shares.len() != self.times_s.len()
        {
            return Err(CreepError::OtherGauges { expected: gauges });
        }
        let history = cycles::History::of(table)?;
        let mut without = table.clone();
        for (time, shares) in self.times_s.iter().zip(&self.shares) {
            let shares = DVector::from_column_slice(shares);
            for (row, average) in averages(&history, *time).row_iter().enumerate() {
                let mut row = without.signals.row_mut(row);
                row -= average.component_mul(&shares.transpose());
            }
        }
        Ok(without)
    }
}

/// Averages of the signals over the past, which forget within `time` \[s\]: samples × gauges. NaN for a time that is none.
fn averages(history: &cycles::History, time: f64) -> DMatrix<f64> {
    let signals = &history.signals;
    let mut averages = DMatrix::from_element(signals.nrows(), signals.ncols(), f64::NAN);
    // Of a share that loses no digit.
    let Ok(half) = CreepCompensation::new([time], [Vector1::new(0.5)]) else { return averages };
    for (run, gauge) in
        history.runs.iter().flat_map(|run| (0..signals.ncols()).map(move |gauge| (run, gauge)))
    {
        let (mut creep, mut before) = (half, f64::INFINITY);
        for row in run {
            let (signal, now) = (signals[(*row, gauge)], history.times[*row]);
            let without = creep.follow(&Vector1::new(signal), now - before);
            averages[(*row, gauge)] = without.map_or(f64::NAN, |without| 2.0 * (signal - without.x));
            before = now;
        }
    }
    averages
}
