//! What a calibration says of a table's readings.

use nalgebra::DMatrix;

use fingertip_wrench::CalibratedRegion;

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

/// The samples that lie beyond what a curved sensor was calibrated for, of which it tells nothing, and how far.
///
/// # Errors
/// [`CalibrationError::File`] if the calibration needs temperatures and there are none.
pub(super) fn beyond(
    file: &CalibrationFile,
    table: &LoadTable,
) -> Result<Vec<(usize, String)>, CalibrationError> {
    let Some(region) = file.region.as_ref().filter(|_| file.is_curved()) else { return Ok(Vec::new()) };
    let greatest = CalibratedRegion::<f64, 6>::GREATEST;
    let mut beyond = Vec::new();
    for sample in 0..table.samples() {
        let reading: Vec<f64> = table.signals.row(sample).iter().copied().collect();
        let celsius = table.temperatures.as_ref().map(|temperatures| temperatures[sample]);
        let reading = file.brought_to_reference(&reading, celsius)?;
        let signals: Vec<f64> =
            reading.iter().zip(&file.zero).map(|(reading, zero)| reading - zero).collect();
        let distance = region.distance(&signals);
        if !(distance <= greatest) {
            let reason = format!(
                "{distance:.2} times as far out as the farthest reading of the calibration: a curved sensor tells nothing there"
            );
            beyond.push((sample, reason));
        }
    }
    Ok(beyond)
}
