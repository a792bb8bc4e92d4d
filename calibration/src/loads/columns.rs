//! Columns of a CSV by their names.

use std::io::Read;

use fingertip_recordings::TableReader;
use nalgebra::{DMatrix, Vector3, Vector6};

use super::LoadError;
use super::header::{number_in, unreadable};
use crate::Axis;

/// A CSV with a header, whose columns are taken by name; columns nobody asks for do not matter. Blanks around
/// cells are passed over, as are lines that start with `#`.
///
/// ```
/// use fingertip_calibration::Axis;
/// use fingertip_calibration::loads::Columns;
///
/// let text = "# Tuesday\npose,fx_N,tz_Nmm\nup,1.5,20\ndown,-1.5,-20\n";
/// let columns = Columns::from_csv(text.as_bytes())?;
/// assert_eq!(columns.texts("pose")?, ["up", "down"]);
/// // In SI, whatever unit the header says.
/// let (axes, loads) = columns.loads()?;
/// assert_eq!(axes, [Axis::Fx, Axis::Tz]);
/// assert!((loads[(0, 1)] - 0.02).abs() < 1e-15 && loads[(1, 0)] == -1.5);
/// # Ok::<(), fingertip_calibration::loads::LoadError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Columns {
    header: Vec<String>,
    /// Line of the file, and its cells.
    rows: Vec<(u64, Vec<String>)>,
    cut_line: Option<u64>,
}

fn bad(line: u64, column: &str, message: &str) -> LoadError {
    LoadError::BadText { line, column: column.to_owned(), message: message.to_owned() }
}

impl Columns {
    /// Reads all of it.
    ///
    /// # Errors
    /// [`LoadError::BadText`] for lines of different lengths,
    /// [`LoadError::Empty`] without a row.
    pub fn from_csv(reader: impl Read) -> Result<Self, LoadError> {
        let mut table = TableReader::new("the table", reader).map_err(|error| unreadable(&error))?;
        let mut rows = Vec::new();
        while table.advance().map_err(|error| unreadable(&error))? {
            let cells = (0..table.names().len()).map(|column| table.text(column).to_owned());
            rows.push((table.line(), cells.collect()));
        }
        let (header, cut_line) = (table.names().to_vec(), table.cut_line());
        if rows.is_empty() {
            Err(LoadError::Empty { what: "rows" })
        } else {
            Ok(Self { header, rows, cut_line })
        }
    }

    /// The line in which the file was cut, if its last cells are missing: it is not among the rows.
    #[must_use]
    pub const fn cut_line(&self) -> Option<u64> {
        self.cut_line
    }

    /// How many rows there are; at least one.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.rows.len()
    }

    /// Whether there is a column called so.
    #[must_use]
    pub fn has(&self, name: &str) -> bool {
        self.header.iter().any(|column| column == name)
    }

    fn position(&self, name: &str) -> Result<usize, LoadError> {
        self.header
            .iter()
            .position(|column| column == name)
            .ok_or_else(|| bad(1, name, "there is no such column"))
    }

    fn numbers_at(&self, index: usize, scale: f64) -> Result<Vec<f64>, LoadError> {
        let name = self.header.get(index).map_or("", String::as_str);
        let number = |(line, cells): &(u64, Vec<String>)| {
            let cell = cells.get(index).map_or("", String::as_str);
            number_in(cell, scale).map_err(|what| bad(*line, name, &format!("{cell:?} is not {what}")))
        };
        self.rows.iter().map(number).collect()
    }

    /// The numbers of a column.
    ///
    /// # Errors
    /// [`LoadError::BadText`], naming line and column, if there is no such column or a cell is not a finite number.
    pub fn numbers(&self, name: &str) -> Result<Vec<f64>, LoadError> {
        self.numbers_at(self.position(name)?, 1.0)
    }

    /// The texts of a column.
    ///
    /// # Errors
    /// [`LoadError::BadText`] if there is no such column.
    pub fn texts(&self, name: &str) -> Result<Vec<&str>, LoadError> {
        let index = self.position(name)?;
        Ok(self.rows.iter().map(|(_, cells)| cells.get(index).map_or("", String::as_str)).collect())
    }

    /// Three columns as vectors.
    ///
    /// # Errors
    /// As [`numbers`](Self::numbers).
    pub fn vectors(&self, names: [&str; 3]) -> Result<Vec<Vector3<f64>>, LoadError> {
        let [x, y, z] = [self.numbers(names[0])?, self.numbers(names[1])?, self.numbers(names[2])?];
        Ok((0..self.rows()).map(|i| Vector3::new(x[i], y[i], z[i])).collect())
    }

    /// The columns `fx_N` … `tz_Nm` that there are, in any unit of [`crate::units`]: their axes in order, and
    /// the loads \[N, N·m\], rows × axes.
    ///
    /// # Errors
    /// As [`numbers`](Self::numbers); also for a unit that is not known, or no such column.
    pub fn loads(&self) -> Result<(Vec<Axis>, DMatrix<f64>), LoadError> {
        let (mut axes, mut numbers) = (Vec::new(), Vec::new());
        for axis in Axis::ALL {
            let found = self.header.iter().enumerate().find_map(|(index, name)| {
                let (stem, unit) = name.rsplit_once('_').unwrap_or((name, ""));
                (Axis::from_name(stem) == Some(axis)).then_some((index, axis.unit_size(unit)))
            });
            match found {
                Some((index, Some(size))) => {
                    axes.push(axis);
                    numbers.extend(self.numbers_at(index, size)?);
                }
                Some((index, None)) => {
                    let name = self.header.get(index).map_or("", String::as_str);
                    return Err(bad(1, name, "it has no unit that is known; write such as fx_N, tx_Nm"));
                }
                None => {}
            }
        }
        if axes.is_empty() {
            return Err(bad(1, "fx_N", "there is no column of loads"));
        }
        let loads = DMatrix::from_vec(self.rows(), axes.len(), numbers);
        Ok((axes, loads))
    }

    /// All six columns `fx_N` … `tz_Nm` as wrenches \[N, N·m\].
    ///
    /// # Errors
    /// As [`loads`](Self::loads), and if one of the six is missing.
    pub fn wrenches(&self) -> Result<Vec<Vector6<f64>>, LoadError> {
        let (axes, loads) = self.loads()?;
        if let Some(missing) = Axis::ALL.iter().find(|axis| !axes.contains(axis)) {
            let hint = "there is no such column with a unit, such as fx_N, tx_Nm";
            return Err(bad(1, missing.name(), hint));
        }
        Ok(loads.row_iter().map(|row| Vector6::from_fn(|j, _| row[j])).collect())
    }

    /// The line of the file that a row stands on.
    #[must_use]
    pub fn line(&self, row: usize) -> u64 {
        self.rows.get(row).map_or(0, |(line, _)| *line)
    }
}

#[cfg(test)]
mod tests {
    use super::Columns;

    #[test]
    fn columns_are_found_and_faults_are_placed() {
        let text = "# touches\nfx_mN,fy_N,fz_N,mx_Nmm,ty_Nm,tz_Nm,nx,ny,nz,what\n1000,2,3,4,5,6,0,0,1,a\n1,2,3,4,5,6,0,x,1,b\n";
        let columns = Columns::from_csv(text.as_bytes()).unwrap();
        let wrench = columns.wrenches().unwrap()[0];
        assert_eq!((columns.rows(), wrench[0], wrench[3]), (2, 1.0, 0.004));
        assert_eq!(columns.texts("what").unwrap(), ["a", "b"]);
        assert!(columns.has("nz") && !columns.has("nw"));
        let error = columns.vectors(["nx", "ny", "nz"]).unwrap_err().to_string();
        assert!(error.contains("line 4") && error.contains("ny") && error.contains("\"x\""), "{error}");
        assert!(columns.numbers("q").unwrap_err().to_string().contains("`q`"));
        let stone = text.replace("fy_N", "fy_stone");
        let error = Columns::from_csv(stone.as_bytes()).unwrap().wrenches().unwrap_err().to_string();
        assert!(error.contains("fy_stone"), "{error}");
        assert!(Columns::from_csv("a,b\n".as_bytes()).is_err());
        assert!(Columns::from_csv("a,b\n1\n".as_bytes()).is_err());
    }
}
