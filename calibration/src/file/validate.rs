//! What every calibration file must satisfy.

use nalgebra::DMatrix;

use super::{CalibrationFile, FileError};

impl CalibrationFile {
    /// Checks shapes, ranges and that every number is finite. [`read`](Self::read) and
    /// [`write`](Self::write) call it.
    ///
    /// # Errors
    /// [`FileError`] naming the first field that is wrong.
    pub fn validate(&self) -> Result<(), FileError> {
        let (gauges, axes) = self.matrix.shape();
        if gauges == 0 || axes == 0 {
            return Err(FileError::WrongShape { field: "matrix".to_owned(), found: 0, expected: 6 });
        }
        if axes != self.axes.len() {
            return Err(FileError::WrongShape {
                field: "matrix[0]".to_owned(),
                found: axes,
                expected: self.axes.len(),
            });
        }
        if !self.axes.is_sorted_by(|a, b| a < b) {
            return Err(out_of_range("axes", "in the order fx, fy, fz, tx, ty, tz, each once"));
        }
        finite_matrix("matrix", &self.matrix)?;
        finite_list("nominal", &self.nominal, axes)?;
        finite_list("zero", &self.zero, gauges)?;
        if let Some(index) = self.nominal.iter().position(|x| !(*x > 0.0)) {
            return Err(out_of_range(&format!("nominal[{index}]"), "positive"));
        }
        if let Some(noise) = &self.noise {
            finite_list("noise", noise, gauges)?;
            if let Some(index) = noise.iter().position(|x| !(*x >= 0.0)) {
                return Err(out_of_range(&format!("noise[{index}]"), "zero or positive"));
            }
        }
        if let Some(range) = &self.range {
            finite_list("range", range, 2)?;
            if !(range[0] < range[1]) {
                return Err(out_of_range("range", "two readings, the lesser first"));
            }
        }
        if let Some(quadratic) = &self.quadratic {
            finite_matrix("quadratic", quadratic)?;
            shape("quadratic", quadratic, axes, gauges * (gauges + 1) / 2)?;
        }
        if let Some(covariance) = &self.covariance {
            finite_matrix("covariance.signals", &covariance.signals)?;
            shape("covariance.signals", &covariance.signals, gauges, gauges)?;
            finite_matrix("covariance.loads", &covariance.loads)?;
            shape("covariance.loads", &covariance.loads, axes, axes)?;
        }
        if let Some(temperature) = &self.temperature {
            finite_list("temperature.reference_celsius", &[temperature.reference_celsius], 1)?;
            let [least, greatest] = temperature.range_celsius;
            finite_list("temperature.range_celsius", &temperature.range_celsius, 2)?;
            if !(least <= temperature.reference_celsius && temperature.reference_celsius <= greatest) {
                return Err(out_of_range(
                    "temperature.range_celsius",
                    "two temperatures about the reference",
                ));
            }
            finite_list("temperature.zero_drift", &temperature.zero_drift, gauges)?;
            finite_list("temperature.zero_curvature", &temperature.zero_curvature, gauges)?;
            finite_list("temperature.gain_drift", &temperature.gain_drift, gauges)?;
        }
        let quality = &self.quality;
        if let Some(number) = quality.condition_number {
            finite_list("quality.condition_number", &[number], 1)?;
        }
        for (field, list) in [
            ("quality.rms_percent", &quality.rms_percent),
            ("quality.greatest_percent", &quality.greatest_percent),
            ("quality.left_out_percent", &quality.left_out_percent),
        ] {
            if let Some(list) = list {
                finite_list(field, list, axes)?;
            }
        }
        Ok(())
    }
}

fn out_of_range(field: &str, requirement: &'static str) -> FileError {
    FileError::OutOfRange { field: field.to_owned(), requirement }
}

fn finite_list(field: &str, list: &[f64], expected: usize) -> Result<(), FileError> {
    if list.len() != expected {
        return Err(FileError::WrongShape { field: field.to_owned(), found: list.len(), expected });
    }
    match list.iter().position(|x| !x.is_finite()) {
        Some(_) if expected == 1 => Err(FileError::NotFinite { field: field.to_owned() }),
        Some(index) => Err(FileError::NotFinite { field: format!("{field}[{index}]") }),
        None => Ok(()),
    }
}

fn finite_matrix(field: &str, matrix: &DMatrix<f64>) -> Result<(), FileError> {
    for (i, row) in matrix.row_iter().enumerate() {
        if let Some(j) = row.iter().position(|x| !x.is_finite()) {
            return Err(FileError::NotFinite { field: format!("{field}[{i}][{j}]") });
        }
    }
    Ok(())
}

fn shape(field: &str, matrix: &DMatrix<f64>, rows: usize, columns: usize) -> Result<(), FileError> {
    if matrix.nrows() != rows {
        let field = field.to_owned();
        return Err(FileError::WrongShape { field, found: matrix.nrows(), expected: rows });
    }
    if matrix.ncols() != columns {
        let field = format!("{field}[0]");
        return Err(FileError::WrongShape { field, found: matrix.ncols(), expected: columns });
    }
    Ok(())
}
