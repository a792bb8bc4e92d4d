//! Tables of loads row by row.

use std::io::Read;

use fingertip_recordings::TableReader;

use super::LoadError;
use super::header::{Column, bad, layout, not_a_number, number_in, parse_name, unreadable};
use crate::Axis;
use crate::file::SignalUnit;

/// Reads a table of loads row by row, in the memory of one row: the format of
/// [`LoadTable::from_csv`](super::LoadTable::from_csv).
///
/// ```
/// use fingertip_calibration::loads::LoadReader;
///
/// let text = "fx_N,fz_N,v1_mV,v2_mV\n0,-5,12,300\n1,-5,80,301\n";
/// let mut reader = LoadReader::new(text.as_bytes())?;
/// assert_eq!((reader.axes().len(), reader.gauges()), (2, 2));
/// let (mut rows, mut greatest_volts) = (0, 0.0_f64);
/// while let Some(row) = reader.next_row()? {
///     rows += 1;
///     greatest_volts = row.signals.iter().copied().fold(greatest_volts, f64::max);
/// }
/// assert!(rows == 2 && (greatest_volts - 0.301).abs() < 1e-12);
/// # Ok::<(), fingertip_calibration::loads::LoadError>(())
/// ```
#[derive(Debug)]
pub struct LoadReader<R> {
    table: TableReader<R>,
    columns: Vec<Column>,
    axes: Vec<Axis>,
    unit: SignalUnit,
    row: LoadRow,
}

/// One row of a table of loads.
///
/// ```
/// use fingertip_calibration::loads::{LoadReader, LoadRow};
///
/// let text = "t_s,fz_N,v1_mV\n0.5,-5,300\n";
/// let mut reader = LoadReader::new(text.as_bytes())?;
/// let row: &LoadRow = reader.next_row()?.ok_or("no row")?;
/// // Newtons, volts and seconds; the header is line 1.
/// assert_eq!((row.line, row.loads[0], row.time), (2, -5.0, Some(0.5)));
/// assert!((row.signals[0] - 0.3).abs() < 1e-15);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LoadRow {
    /// Line of the file, counting from 1.
    pub line: u64,
    /// The known load \[N, N·m\], in the order of the axes.
    pub loads: Vec<f64>,
    /// The readings.
    pub signals: Vec<f64>,
    /// Time \[s\].
    pub time: Option<f64>,
    /// Temperature \[°C\].
    pub temperature: Option<f64>,
    /// Weight.
    pub weight: Option<f64>,
    /// Quaternion x, y, z, w.
    pub orientation: Option<[f64; 4]>,
    /// What to call the sample.
    pub name: Option<String>,
    /// Its load case.
    pub case: Option<String>,
    /// Its group.
    pub group: Option<String>,
}

impl<R: Read> LoadReader<R> {
    /// Reads the header.
    ///
    /// # Errors
    /// [`LoadError::BadText`], naming the column.
    pub fn new(reader: R) -> Result<Self, LoadError> {
        let table = TableReader::new("the table", reader).map_err(|error| unreadable(&error))?;
        let columns = table
            .names()
            .iter()
            .map(|name| parse_name(name).map_err(|message| bad(1, name, message)))
            .collect::<Result<Vec<_>, _>>()?;
        let (axes, gauges, unit) = layout(&columns).map_err(|(column, message)| bad(1, &column, message))?;
        let parts: Vec<usize> = columns
            .iter()
            .filter_map(|column| if let Column::Quaternion(part) = column { Some(*part) } else { None })
            .collect();
        let whole = parts.len() == 4 && (0..4).all(|part| parts.contains(&part));
        if !(parts.is_empty() || whole) {
            return Err(bad(1, "qx", "an orientation takes qx, qy, qz and qw, each once".to_owned()));
        }
        let row = LoadRow {
            loads: vec![0.0; axes.len()],
            signals: vec![0.0; gauges],
            orientation: (!parts.is_empty()).then_some([0.0; 4]),
            ..LoadRow::default()
        };
        Ok(Self { table, columns, axes, unit, row })
    }

    /// The axes that have loads.
    #[must_use]
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// How many gauges there are.
    #[must_use]
    pub fn gauges(&self) -> usize {
        self.row.signals.len()
    }

    /// Unit of the readings.
    #[must_use]
    pub const fn signal_unit(&self) -> SignalUnit {
        self.unit
    }

    /// Names of the columns that are not used.
    #[must_use]
    pub fn ignored(&self) -> Vec<String> {
        let ignored =
            self.table.names().iter().zip(&self.columns).filter(|(_, column)| **column == Column::Ignored);
        ignored.map(|(name, _)| name.clone()).collect()
    }

    /// The line in which the file was cut, if that was found at its end: it is not among the rows.
    #[must_use]
    pub const fn cut_line(&self) -> Option<u64> {
        self.table.cut_line()
    }

    /// The next row; `None` at the end.
    ///
    /// # Errors
    /// [`LoadError::BadText`], naming line and column.
    pub fn next_row(&mut self) -> Result<Option<&LoadRow>, LoadError> {
        if !self.table.advance().map_err(|error| unreadable(&error))? {
            return Ok(None);
        }
        match self.take_row() {
            Ok(()) => Ok(Some(&self.row)),
            Err((column, _)) if self.table.is_cut_in(column) => Ok(None),
            Err((column, what)) => Err(not_a_number(&self.table, column, what)),
        }
    }

    /// Takes the cells of the row at hand, or says which is not what.
    fn take_row(&mut self) -> Result<(), (usize, &'static str)> {
        let row = &mut self.row;
        row.line = self.table.line();
        for (index, column) in self.columns.iter().enumerate() {
            let text = self.table.text(index);
            let number = |size: f64| number_in(text, size).map_err(|what| (index, what));
            match *column {
                Column::Load(axis, size) => {
                    if let Some(slot) = self.axes.iter().position(|a| *a == axis) {
                        row.loads[slot] = number(size)?;
                    }
                }
                Column::Signal(gauge, _, size) => row.signals[gauge] = number(size)?,
                Column::Time(seconds) => row.time = Some(number(seconds)?),
                Column::Temperature => row.temperature = Some(number(1.0)?),
                Column::Weight => row.weight = Some(number(1.0)?),
                Column::Quaternion(part) => {
                    if let Some(orientation) = &mut row.orientation {
                        orientation[part] = number(1.0)?;
                    }
                }
                Column::Case => row.case = Some(text.to_owned()),
                Column::Group => row.group = Some(text.to_owned()),
                Column::Name => row.name = Some(text.to_owned()),
                Column::Ignored => {}
            }
        }
        Ok(())
    }
}
