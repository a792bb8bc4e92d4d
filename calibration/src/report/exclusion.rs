//! What is no part of a fit.

use serde::Serialize;

/// A sample that was left out.
///
/// ```
/// # use fingertip_calibration::{Axis, file::SignalUnit, loads::LoadTable, nalgebra::DMatrix};
/// # // Three forces one after another, up to ±9.5 N; each has a gauge of 0.1 V/N, and they scatter by a millivolt.
/// # let loads = DMatrix::from_fn(60, 3, |i, j| if i % 3 == j { (i / 3) as f64 - 9.5 } else { 0.0 });
/// # let signals = loads.map_with_location(|i, j, newtons| 0.1 * newtons + 1e-3 * ((7 * i + 3 * j) as f64).sin());
/// # let table = LoadTable::new(&Axis::FORCES, loads, signals, SignalUnit::Volt)?;
/// use fingertip_calibration::report::Exclusion;
/// use fingertip_calibration::{calibrate, model::Options};
///
/// // The converter ends at 0.9 V; the first three samples are loads of −9.5 N, one on each axis.
/// let options = Options { range: Some([-0.9, 0.9]), ..Options::default() };
/// let excluded: Vec<Exclusion> = calibrate(&table, &options)?.report.excluded;
/// assert_eq!(excluded.len(), 6);
/// assert_eq!(excluded[0].sample, table.names.get(0));
/// assert!(excluded[0].reason.contains("gauge 1"));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Exclusion {
    /// What it is called.
    pub sample: String,
    /// Why.
    pub reason: String,
}
