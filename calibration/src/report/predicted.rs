//! What a calibration says of a table's readings.

use nalgebra::DMatrix;

use crate::file::CalibrationFile;
use crate::linear::less;
use crate::loads::LoadTable;
use crate::model::CalibrationError;

/// The loads \[N, N·m\] that a calibration with this inverse tells of readings: samples × axes.
///
/// # Errors
/// [`CalibrationError::File`] if it needs temperatures and there are none, [`CalibrationError::Singular`].
pub(super) fn predicted(
    file: &CalibrationFile,
    table: &LoadTable,
    inverse: &DMatrix<f64>,
) -> Result<DMatrix<f64>, CalibrationError> {
    let without;
    let table = match &file.creep {
        Some(creep) => {
            without = creep.taken_off(table)?;
            &without
        }
        None => table,
    };
    if file.temperature.is_none() && !file.is_curved() && file.zero.len() == table.gauges() {
        // All at once.
        let mut loads = less(&table.signals, &file.zero) * inverse.transpose();
        for (mut column, nominal) in loads.column_iter_mut().zip(&file.nominal) {
            column *= *nominal;
        }
        return Ok(loads);
    }
    let mut loads = DMatrix::zeros(table.samples(), table.axes.len());
    for i in 0..table.samples() {
        let reading: Vec<f64> = table.signals.row(i).iter().copied().collect();
        let celsius = table.temperatures.as_ref().map(|temperatures| temperatures[i]);
        let reading = file.brought_to_reference(&reading, celsius)?;
        let load = file.load_with(inverse, &reading).ok_or(CalibrationError::Singular)?;
        loads.set_row(i, &load.transpose());
    }
    Ok(loads)
}
