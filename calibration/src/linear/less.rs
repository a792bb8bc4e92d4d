//! Rows less one row.

use nalgebra::DMatrix;

/// Readings, samples × gauges, less what counts as zero.
pub(crate) fn less(signals: &DMatrix<f64>, origin: &[f64]) -> DMatrix<f64> {
    let mut signals = signals.clone();
    signals.column_iter_mut().zip(origin).for_each(|(mut column, zero)| column.add_scalar_mut(-zero));
    signals
}
