//! What every calibration file must satisfy.

use nalgebra::DMatrix;

use super::{CalibrationFile, FileError, SignalUnit};

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
        if self.signal_unit == SignalUnit::Unstated {
            return Err(out_of_range("signal_unit", "stated"));
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
        if let Some(curve) = &self.curve {
            curve.validate(gauges, axes)?;
        }
        if let Some(region) = &self.region {
            finite_list("region.centre", &region.centre, gauges)?;
            finite_matrix("region.whitening", &region.whitening)?;
            shape("region.whitening", &region.whitening, gauges, gauges)?;
        }
        if let Some(covariance) = &self.covariance {
            finite_matrix("covariance.signals", &covariance.signals)?;
            shape("covariance.signals", &covariance.signals, gauges, gauges)?;
            finite_matrix("covariance.loads", &covariance.loads)?;
            shape("covariance.loads", &covariance.loads, axes, axes)?;
            if let Some(entries) = &covariance.entries {
                finite_matrix("covariance.entries", entries)?;
                shape("covariance.entries", entries, gauges * axes, gauges * axes)?;
            }
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
        if let Some(creep) = &self.creep {
            creep.validate(gauges)?;
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

pub(super) fn out_of_range(field: &str, requirement: &'static str) -> FileError {
    FileError::OutOfRange { field: field.to_owned(), requirement }
}

pub(super) fn finite_list(field: &str, list: &[f64], expected: usize) -> Result<(), FileError> {
    if list.len() != expected {
        return Err(FileError::WrongShape { field: field.to_owned(), found: list.len(), expected });
    }
    match list.iter().position(|x| !x.is_finite()) {
        Some(_) if expected == 1 => Err(FileError::NotFinite { field: field.to_owned() }),
        Some(index) => Err(FileError::NotFinite { field: format!("{field}[{index}]") }),
        None => Ok(()),
    }
}

pub(super) fn finite_matrix(field: &str, matrix: &DMatrix<f64>) -> Result<(), FileError> {
    for (i, row) in matrix.row_iter().enumerate() {
        if let Some(j) = row.iter().position(|x| !x.is_finite()) {
            return Err(FileError::NotFinite { field: format!("{field}[{i}][{j}]") });
        }
    }
    Ok(())
}

pub(super) fn shape(
    field: &str,
    matrix: &DMatrix<f64>,
    rows: usize,
    columns: usize,
) -> Result<(), FileError> {
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

#[cfg(test)]
mod tests {
    use super::super::{CalibrationFile, Covariance, SignalUnit, Temperature};
    use nalgebra::DMatrix;

    /// Seven gauges, six axes, every field.
    fn file() -> CalibrationFile {
        let matrix = DMatrix::from_fn(7, 6, |i, j| if i == j { 2.0 } else { 0.1 });
        let mut file = CalibrationFile::new(matrix, vec![10.0; 6], vec![0.5; 7], SignalUnit::Volt).unwrap();
        file.noise = Some(vec![0.0; 7]);
        file.range = Some([-1.0, 1.0]);
        file.quadratic = Some(DMatrix::zeros(6, 28));
        file.covariance = Some(Covariance::of_entries(DMatrix::zeros(7, 7), DMatrix::zeros(42, 42)));
        file.temperature = Some(Temperature {
            reference_celsius: 20.0,
            range_celsius: [20.0, 20.0],
            zero_drift: vec![0.0; 7],
            zero_curvature: vec![0.0; 7],
            gain_drift: vec![0.0; 7],
        });
        file.quality.condition_number = Some(2.0);
        file.quality.rms_percent = Some(vec![0.0; 6]);
        file.quality.greatest_percent = Some(vec![0.0; 6]);
        file.quality.left_out_percent = Some(vec![0.0; 6]);
        file
    }

    fn refused(change: impl FnOnce(&mut CalibrationFile)) -> String {
        let mut file = file();
        change(&mut file);
        file.validate().unwrap_err().to_string()
    }

    fn warm(change: impl FnOnce(&mut Temperature)) -> String {
        refused(|file| change(file.temperature.as_mut().unwrap()))
    }

    #[test]
    fn numbers_that_are_none_are_named() {
        file().validate().unwrap();
        let nan = f64::NAN;
        for (found, field) in [
            (refused(|file| file.matrix[(6, 5)] = nan), "matrix[6][5]"),
            (refused(|file| file.nominal[1] = f64::INFINITY), "nominal[1]"),
            (refused(|file| file.zero[6] = nan), "zero[6]"),
            (refused(|file| file.noise.as_mut().unwrap()[2] = nan), "noise[2]"),
            (refused(|file| file.range = Some([nan, 1.0])), "range[0]"),
            (refused(|file| file.quadratic.as_mut().unwrap()[(5, 27)] = nan), "quadratic[5][27]"),
            (
                refused(|file| file.covariance.as_mut().unwrap().signals[(6, 0)] = nan),
                "covariance.signals[6][0]",
            ),
            (refused(|file| file.covariance.as_mut().unwrap().loads[(0, 5)] = nan), "covariance.loads[0][5]"),
            (
                refused(|file| file.covariance.as_mut().unwrap().entries.as_mut().unwrap()[(41, 2)] = nan),
                "covariance.entries[41][2]",
            ),
            (warm(|drift| drift.reference_celsius = nan), "temperature.reference_celsius"),
            (warm(|drift| drift.range_celsius[1] = f64::INFINITY), "temperature.range_celsius[1]"),
            (warm(|drift| drift.zero_drift[0] = nan), "temperature.zero_drift[0]"),
            (warm(|drift| drift.zero_curvature[6] = nan), "temperature.zero_curvature[6]"),
            (warm(|drift| drift.gain_drift[3] = nan), "temperature.gain_drift[3]"),
            (refused(|file| file.quality.condition_number = Some(f64::INFINITY)), "quality.condition_number"),
            (refused(|file| file.quality.rms_percent.as_mut().unwrap()[4] = nan), "quality.rms_percent[4]"),
            (
                refused(|file| file.quality.greatest_percent.as_mut().unwrap()[0] = nan),
                "quality.greatest_percent[0]",
            ),
            (
                refused(|file| file.quality.left_out_percent.as_mut().unwrap()[5] = nan),
                "quality.left_out_percent[5]",
            ),
        ] {
            assert_eq!(found, format!("field `{field}` is not a finite number"));
        }
    }

    #[test]
    fn lists_of_the_wrong_length_are_named() {
        for (found, field, length, expected) in [
            (refused(|file| file.matrix = DMatrix::zeros(0, 6)), "matrix", 0, 6),
            (refused(|file| file.matrix = DMatrix::zeros(7, 0)), "matrix", 0, 6),
            (refused(|file| file.matrix = DMatrix::zeros(7, 5)), "matrix[0]", 5, 6),
            (refused(|file| file.nominal.truncate(5)), "nominal", 5, 6),
            (refused(|file| file.zero.push(0.0)), "zero", 8, 7),
            (refused(|file| file.noise = Some(vec![0.0; 6])), "noise", 6, 7),
            (refused(|file| file.quadratic = Some(DMatrix::zeros(7, 28))), "quadratic", 7, 6),
            (refused(|file| file.quadratic = Some(DMatrix::zeros(6, 27))), "quadratic[0]", 27, 28),
            (
                refused(|file| file.covariance.as_mut().unwrap().signals = DMatrix::zeros(6, 7)),
                "covariance.signals",
                6,
                7,
            ),
            (
                refused(|file| file.covariance.as_mut().unwrap().signals = DMatrix::zeros(7, 6)),
                "covariance.signals[0]",
                6,
                7,
            ),
            (
                refused(|file| file.covariance.as_mut().unwrap().loads = DMatrix::zeros(7, 6)),
                "covariance.loads",
                7,
                6,
            ),
            (
                refused(|file| file.covariance.as_mut().unwrap().entries = Some(DMatrix::zeros(41, 42))),
                "covariance.entries",
                41,
                42,
            ),
            (
                refused(|file| file.covariance.as_mut().unwrap().entries = Some(DMatrix::zeros(42, 6))),
                "covariance.entries[0]",
                6,
                42,
            ),
            (warm(|drift| drift.zero_drift.truncate(6)), "temperature.zero_drift", 6, 7),
            (warm(|drift| drift.zero_curvature.push(0.0)), "temperature.zero_curvature", 8, 7),
            (warm(|drift| drift.gain_drift.clear()), "temperature.gain_drift", 0, 7),
            (refused(|file| file.quality.rms_percent = Some(vec![])), "quality.rms_percent", 0, 6),
        ] {
            assert_eq!(found, format!("field `{field}` has {length} entries; expected {expected}"));
        }
    }

    #[test]
    fn numbers_out_of_range_are_named() {
        for (found, field) in [
            (refused(|file| file.axes.swap(1, 2)), "axes"),
            (refused(|file| file.axes[5] = file.axes[4]), "axes"),
            (refused(|file| file.nominal[3] = 0.0), "nominal[3]"),
            (refused(|file| file.nominal[0] = -1.0), "nominal[0]"),
            (refused(|file| file.noise.as_mut().unwrap()[6] = -1e-9), "noise[6]"),
            (refused(|file| file.range = Some([1.0, 1.0])), "range"),
            (warm(|drift| drift.range_celsius = [20.1, 30.0]), "temperature.range_celsius"),
            (warm(|drift| drift.range_celsius = [10.0, 19.9]), "temperature.range_celsius"),
        ] {
            assert!(found.starts_with(&format!("field `{field}` must be ")), "{found}");
        }
    }
}
