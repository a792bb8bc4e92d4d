//! A plain matrix, as CSV or `.npy`, made a calibration by what its user says of it.

use fingertip_wrench::units::{ForceUnit, TorqueUnit};
use nalgebra::DMatrix;
use thiserror::Error;

use super::{CalibrationFile, FileError, Provenance, Quality, SignalUnit, UNTARED, Verdict, npy};
use crate::linear::pseudo_inverse;

/// Which way a plain matrix goes.
///
/// ```
/// # use fingertip_calibration::file::{PlainUnits, SignalUnit};
/// # use fingertip_calibration::units::{ForceUnit, TorqueUnit};
/// # let units = PlainUnits {
/// #     matrix: PlainMatrix::LoadPerSignal,
/// #     signal: SignalUnit::Volt,
/// #     force: ForceUnit::Newton,
/// #     torque: TorqueUnit::NewtonMetre,
/// #     nominal: [10.0, 10.0, 10.0, 0.1, 0.1, 0.1],
/// #     reaction: false,
/// # };
/// use fingertip_calibration::file::PlainMatrix;
/// use fingertip_calibration::nalgebra::DMatrix;
///
/// // 5 N/V is 0.2 V/N; both ways round 1 V on the first gauge is 5 N.
/// let inverse = DMatrix::from_diagonal_element(6, 6, 5.0);
/// let forward = DMatrix::from_diagonal_element(6, 6, 0.2);
/// for (way, numbers) in [(PlainMatrix::LoadPerSignal, inverse), (PlainMatrix::SignalPerLoad, forward)] {
///     let file = PlainUnits { matrix: way, ..units }.calibration(&numbers)?;
///     assert!((file.load(&[1.0, 0.0, 0.0, 0.0, 0.0, 0.0])?[0] - 5.0).abs() < 1e-12);
/// }
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlainMatrix {
    /// Load = matrix · signals: six rows Fx, Fy, Fz, Tx, Ty, Tz, a column for each gauge.
    LoadPerSignal,
    /// Signals = matrix · load: a row for each gauge, six columns.
    SignalPerLoad,
}

/// What a plain matrix does not say of itself. Nothing of it is guessed.
///
/// ```
/// use fingertip_calibration::file::{PlainMatrix, PlainUnits, SignalUnit, plain_csv};
/// use fingertip_calibration::units::{ForceUnit, TorqueUnit};
///
/// // Six lines of a data sheet: N and N·mm for each volt.
/// let numbers = plain_csv(
///     "5, 0, 0, 0, 0, 0\n0, 5, 0, 0, 0, 0\n0, 0, 5, 0, 0, 0\n\
///      0, 0, 0, 50, 0, 0\n0, 0, 0, 0, 50, 0\n0, 0, 0, 0, 0, 50\n",
/// )?;
/// let units = PlainUnits {
///     matrix: PlainMatrix::LoadPerSignal,
///     signal: SignalUnit::Volt,
///     force: ForceUnit::Newton,
///     torque: TorqueUnit::NewtonMillimetre,
///     nominal: [10.0, 10.0, 10.0, 0.1, 0.1, 0.1],
///     reaction: false,
/// };
/// let load = units.calibration(&numbers)?.load(&[0.0, 0.0, 0.0, 0.0, 0.0, 2.0])?;
/// assert!((load[5] - 0.1).abs() < 1e-12);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlainUnits {
    /// Which way it goes.
    pub matrix: PlainMatrix,
    /// Unit of the signals.
    pub signal: SignalUnit,
    /// Unit of its forces.
    pub force: ForceUnit,
    /// Unit of its torques.
    pub torque: TorqueUnit,
    /// Nominal loads \[N, N·m\].
    pub nominal: [f64; 6],
    /// Whether its loads are what the sensor does to the world, the opposite of what fingertip means.
    pub reaction: bool,
}

/// Why a plain matrix cannot be used.
///
/// ```
/// use fingertip_calibration::file::{PlainError, plain_csv};
///
/// let error = plain_csv("5, 0, 0\n0, five, 0\n").unwrap_err();
/// assert!(matches!(error, PlainError::NotANumber { line: 2, .. }));
/// assert!(matches!(plain_csv("5, 0, 0\n0, 5\n"), Err(PlainError::Ragged { line: 2, found: 2, expected: 3 })));
/// ```
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum PlainError {
    /// It is no `.npy` file of a matrix of floats.
    #[error("the .npy file cannot be used: {what}")]
    Npy {
        /// Why not.
        what: String,
    },
    /// A cell is no number.
    #[error(
        "line {line}: {cell:?} is not a finite number; a plain matrix has numbers alone, and comments behind `#`"
    )]
    NotANumber {
        /// Which line, from 1.
        line: usize,
        /// What stands there.
        cell: String,
    },
    /// Rows of different lengths.
    #[error("line {line}: {found} numbers where the first row has {expected}")]
    Ragged {
        /// Which line, from 1.
        line: usize,
        /// How many there are.
        found: usize,
        /// How many the first row has.
        expected: usize,
    },
    /// It has not the shape of a sensor's matrix.
    #[error("it has {rows} rows and {columns} columns; expected {expected}")]
    Shape {
        /// Rows.
        rows: usize,
        /// Columns.
        columns: usize,
        /// What they must be.
        expected: &'static str,
    },
    /// The calibration that comes of it is wrong.
    #[error(transparent)]
    File(#[from] FileError),
}

/// Reads the numbers of a CSV without header: commas, semicolons, tabs or blanks between them, comments behind `#`.
///
/// # Errors
/// [`PlainError`], naming the line.
pub fn plain_csv(text: &str) -> Result<DMatrix<f64>, PlainError> {
    let mut rows: Vec<Vec<f64>> = Vec::new();
    for (number, line) in text.trim_start_matches('\u{feff}').lines().enumerate() {
        let line_number = number + 1;
        let numbers = line.split('#').next().unwrap_or_default();
        let cells = numbers.split([',', ';', '\t', ' ']).map(str::trim).filter(|cell| !cell.is_empty());
        let mut row = Vec::new();
        for cell in cells {
            let number = cell.parse::<f64>().ok().filter(|number| number.is_finite());
            let number =
                number.ok_or_else(|| PlainError::NotANumber { line: line_number, cell: cell.to_owned() })?;
            row.push(number);
        }
        if row.is_empty() {
            continue;
        }
        if let Some(expected) = rows.first().map(Vec::len).filter(|expected| *expected != row.len()) {
            return Err(PlainError::Ragged { line: line_number, found: row.len(), expected });
        }
        rows.push(row);
    }
    let columns = rows.first().map_or(0, Vec::len);
    Ok(DMatrix::from_row_iterator(rows.len(), columns, rows.into_iter().flatten()))
}

/// Reads a matrix that NumPy saved.
///
/// # Errors
/// [`PlainError::Npy`].
pub fn plain_npy(bytes: &[u8]) -> Result<DMatrix<f64>, PlainError> {
    npy::matrix(bytes)
}

impl PlainUnits {
    /// A calibration of a plain matrix, without zero: it is to be tared.
    ///
    /// # Errors
    /// [`PlainError`].
    pub fn calibration(&self, plain: &DMatrix<f64>) -> Result<CalibrationFile, PlainError> {
        let (rows, columns) = plain.shape();
        let expected = match self.matrix {
            PlainMatrix::LoadPerSignal => {
                "6 rows (Fx, Fy, Fz, Tx, Ty, Tz) and a column for each of 6 gauges or more"
            }
            PlainMatrix::SignalPerLoad => {
                "a row for each of 6 gauges or more and 6 columns (Fx, Fy, Fz, Tx, Ty, Tz)"
            }
        };
        let sides = match self.matrix {
            PlainMatrix::LoadPerSignal => (rows, columns),
            PlainMatrix::SignalPerLoad => (columns, rows),
        };
        if sides.0 != 6 || sides.1 < 6 {
            return Err(PlainError::Shape { rows, columns, expected });
        }
        let sign = if self.reaction { -1.0 } else { 1.0 };
        let size = |axis: usize| {
            sign * if axis < 3 { self.force.in_newtons() } else { self.torque.in_newton_metres() }
        };
        let matrix = match self.matrix {
            PlainMatrix::LoadPerSignal => {
                let normalised =
                    DMatrix::from_fn(6, columns, |i, j| plain[(i, j)] * size(i) / self.nominal[i]);
                pseudo_inverse(&normalised).ok_or(FileError::Singular)?
            }
            PlainMatrix::SignalPerLoad => {
                DMatrix::from_fn(rows, 6, |i, j| plain[(i, j)] / size(j) * self.nominal[j])
            }
        };
        let zero = vec![0.0; matrix.nrows()];
        let mut file = CalibrationFile::new(matrix, self.nominal.to_vec(), zero, self.signal)?;
        pseudo_inverse(&file.matrix).ok_or(FileError::Singular)?;
        file.provenance = Provenance { method: "a plain matrix".to_owned(), ..file.provenance };
        let reasons = vec![UNTARED.to_owned(), "a plain matrix does not tell its accuracy".to_owned()];
        file.quality = Quality { verdict: Verdict::Unchecked, reasons, ..Quality::default() };
        Ok(file)
    }
}

#[cfg(test)]
mod tests {
    use fingertip_wrench::units::{ForceUnit, TorqueUnit};

    use super::{PlainMatrix, PlainUnits, plain_csv};
    use crate::file::SignalUnit;

    const UNITS: PlainUnits = PlainUnits {
        matrix: PlainMatrix::LoadPerSignal,
        signal: SignalUnit::Volt,
        force: ForceUnit::Newton,
        torque: TorqueUnit::NewtonMillimetre,
        nominal: [10.0, 10.0, 10.0, 0.1, 0.1, 0.1],
        reaction: false,
    };

    /// A dominant diagonal: 3 N and 40 N·mm per volt.
    fn text() -> String {
        let row = |i: usize| {
            let cell = |j: usize| {
                if i == j && i < 3 {
                    "3"
                } else if i == j {
                    "40"
                } else {
                    "0.25"
                }
            };
            (0..6).map(cell).collect::<Vec<_>>().join(if i == 1 { "; " } else { "," })
        };
        format!("# six by six\n\n{}\n", (0..6).map(row).collect::<Vec<_>>().join("\n"))
    }

    #[test]
    fn loads_come_out_as_the_matrix_says_in_its_units() {
        let plain = plain_csv(&text()).unwrap();
        let reading = [0.1, -0.2, 0.3, 0.4, -0.5, 0.6];
        let file = UNITS.calibration(&plain).unwrap();
        let expected = &plain * nalgebra::DVector::from_column_slice(&reading);
        let load = file.load(&reading).unwrap();
        for axis in 0..6 {
            let unit = if axis < 3 { 1.0 } else { 1e-3 };
            assert!((load[axis] - unit * expected[axis]).abs() < 1e-12, "{axis}: {load}");
        }
        // The same sensor the other way round, and with the other sign.
        let inverse = plain.clone().try_inverse().unwrap();
        let other = PlainUnits { matrix: PlainMatrix::SignalPerLoad, ..UNITS }.calibration(&inverse).unwrap();
        assert!((other.load(&reading).unwrap() - &load).amax() < 1e-9);
        let reaction = PlainUnits { reaction: true, ..UNITS }.calibration(&plain).unwrap();
        assert!((reaction.load(&reading).unwrap() + &load).amax() < 1e-12);
        assert!(file.quality.reasons[0].contains("tare before use"));
    }

    #[test]
    fn what_is_wrong_is_named() {
        let error = |text: &str| match plain_csv(text) {
            Err(error) => error.to_string(),
            Ok(plain) => UNITS.calibration(&plain).unwrap_err().to_string(),
        };
        assert!(error("1,2\n3,x\n").starts_with("line 2: \"x\" is not a finite number"));
        assert!(error("1,2\n\n3\n").starts_with("line 3: 1 numbers where the first row has 2"));
        assert!(error("1,2\n3,4\n").starts_with("it has 2 rows and 2 columns; expected 6 rows"));
        assert!(error("").starts_with("it has 0 rows"));
        assert!(error(&text().replace("40", "0.25")).contains("no inverse"));
        assert!(error("nan,1\n").contains("nan"));
    }

    #[test]
    fn a_matrix_has_six_loads_and_six_gauges_or_more() {
        let of = |matrix, rows: usize, columns: usize| {
            let plain = nalgebra::DMatrix::from_fn(rows, columns, |i, j| if i == j { 2.0 } else { 0.1 });
            PlainUnits { matrix, ..UNITS }.calibration(&plain)
        };
        for gauges in [6, 7, 9] {
            assert_eq!(of(PlainMatrix::LoadPerSignal, 6, gauges).unwrap().gauges(), gauges);
            assert_eq!(of(PlainMatrix::SignalPerLoad, gauges, 6).unwrap().gauges(), gauges);
        }
        for (loads, gauges) in [(6, 5), (5, 6), (7, 6), (7, 7), (5, 5), (6, 1)] {
            let wrong = |answer| matches!(answer, Err(super::PlainError::Shape { .. }));
            assert!(wrong(of(PlainMatrix::LoadPerSignal, loads, gauges)), "{loads} {gauges}");
            assert!(wrong(of(PlainMatrix::SignalPerLoad, gauges, loads)), "{loads} {gauges}");
        }
    }
}
