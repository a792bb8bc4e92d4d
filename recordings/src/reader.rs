//! Reads a recording row by row.

use core::fmt;
use std::fs::File;
use std::io::Read;
use std::path::Path;

use crate::cell::Cell;
use crate::columns::{InertialColumns, NumberColumn};
use crate::error::{HeaderProblem, RecordingError};
use crate::layout::{Layout, UsedColumn};
use crate::options::{ReaderOptions, rename};
use crate::quality::{FaultCount, Quality};
use crate::row::{Row, RowMarks};
use crate::row_block::RowBlock;
use crate::shortened::shortened;
use crate::table::TableReader;
use crate::time_watch::Step;
use crate::timing::Timing;

/// Reads a recording row by row, in memory that does not grow with the file.
///
/// ```
/// use fingertip_recordings::RecordingReader;
/// use nalgebra::Vector2;
///
/// let file = "t_s,v1_V,v2_V\n0.000,0.25,0.5\n0.001,0.26,0.5\n"; // or a file, by `open`
/// let mut reader = RecordingReader::new("gauges.csv", file.as_bytes())?;
/// let gauges = reader.layout().only_signals()?.expecting(2)?.clone();
/// let mut sum = Vector2::zeros();
/// while let Some(row) = reader.next_row()? {
///     sum += row.signals::<2>(&gauges).ok_or("a number is missing")?;
/// }
/// assert_eq!(sum, Vector2::new(0.51, 1.0));
/// assert_eq!(reader.quality().rows, 2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct RecordingReader<R> {
    table: TableReader<R>,
    layout: Layout,
    /// Columns whose numbers have the other sign.
    negative: Vec<usize>,
    timing: Timing,
    values: Vec<f64>,
    last_values: Vec<f64>,
    /// Whether the line before was a row, with which the next one can be compared.
    follows: bool,
    quality: Quality,
}

impl<R> fmt::Debug for RecordingReader<R> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { layout, quality, .. } = self;
        f.debug_struct("RecordingReader")
            .field("layout", layout)
            .field("quality", quality)
            .finish_non_exhaustive()
    }
}

impl RecordingReader<File> {
    /// Opens a file.
    ///
    /// # Errors
    /// [`RecordingError`] if it cannot be read or its header does not describe a sensor.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, RecordingError> {
        Self::open_with(path, ReaderOptions::default())
    }

    /// Opens a file, with options.
    ///
    /// # Errors
    /// As [`open`](Self::open).
    pub fn open_with(path: impl AsRef<Path>, options: ReaderOptions) -> Result<Self, RecordingError> {
        let file = path.as_ref().display().to_string();
        match File::open(path) {
            Ok(input) => Self::with_options(file, input, options),
            Err(source) => Err(RecordingError::Open { file, source }),
        }
    }
}

impl<R: Read> RecordingReader<R> {
    /// Reads the header of `input`; `file` is what errors call it. No buffer is needed around it.
    ///
    /// # Errors
    /// [`RecordingError`] if it cannot be read or its header does not describe a sensor.
    pub fn new(file: impl Into<String>, input: R) -> Result<Self, RecordingError> {
        Self::with_options(file, input, ReaderOptions::default())
    }

    /// Reads the header, with options.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn with_options(
        file: impl Into<String>,
        input: R,
        options: ReaderOptions,
    ) -> Result<Self, RecordingError> {
        let table = if options.header {
            TableReader::new(file, input)
        } else {
            TableReader::without_header(file, input)
        }?;
        let header = |problem| RecordingError::Header { file: table.file().to_owned(), problem };
        let mut names = table.names().to_vec();
        let negative = rename(&mut names, &options.renamed).map_err(header)?;
        let mut layout = Layout::from_header(&names, options.assumed_units).map_err(header)?;
        layout.take_frames(table.comments());
        for used in layout.used.iter_mut().filter(|used| negative.contains(&used.column)) {
            used.scale = -used.scale;
        }
        let values = vec![f64::NAN; layout.used.len()];
        Ok(Self {
            table,
            last_values: values.clone(),
            values,
            layout,
            negative,
            timing: Timing::with_gap_factor(options.gap_factor),
            follows: false,
            quality: Quality::default(),
        })
    }

    /// What the file holds.
    #[must_use]
    pub const fn layout(&self) -> &Layout {
        &self.layout
    }

    /// Reads the column called so too, whatever its case, from the next row on; `None` if there is no
    /// such column. For what belongs to no sensor, such as `temperature_C` or `qx`: numbers are given as
    /// they stand in the file.
    ///
    /// ```
    /// use fingertip_recordings::RecordingReader;
    ///
    /// let file = "t_s,v1_V,temperature_C\n0,0.5,21.5\n1,0.5,\n";
    /// let mut reader = RecordingReader::new("example.csv", file.as_bytes())?;
    /// let celsius = reader.watch("temperature_c").ok_or("no such column")?;
    /// assert_eq!(reader.next_row()?.and_then(|row| row.number(&celsius)), Some(21.5));
    /// assert_eq!(reader.next_row()?.and_then(|row| row.number(&celsius)), None);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn watch(&mut self, name: &str) -> Option<NumberColumn> {
        let column = self.layout.columns().iter().position(|column| column.eq_ignore_ascii_case(name))?;
        self.layout.used.push(UsedColumn { column, scale: 1.0, optional: false });
        self.values.push(f64::NAN);
        self.last_values.push(f64::NAN);
        Some(NumberColumn { slot: self.values.len() - 1 })
    }

    /// Reads the columns of an inertial unit too, from the next row on: `ax`, `ay`, `az` and `wx`, `wy`, `wz` with their
    /// units (m/s², g; rad/s, deg/s), with the name of the sensor before or without a name.
    ///
    /// ```
    /// use fingertip_recordings::RecordingReader;
    ///
    /// let file = "fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm,ax_g,ay_g,az_g,wx_dps,wy_dps,wz_dps\n0,0,0,0,0,0,0,0,1,180,0,0\n";
    /// let mut reader = RecordingReader::new("example.csv", file.as_bytes())?;
    /// let unit = reader.watch_inertial_unit("")?;
    /// let row = reader.next_row()?.ok_or("a row")?;
    /// let reading = row.inertial(&unit).ok_or("numbers")?;
    /// assert_eq!((reading.acceleration.z, reading.angular_velocity.x), (9.80665, core::f64::consts::PI));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`HeaderProblem`] if one is missing, has no unit, or is there twice.
    pub fn watch_inertial_unit(&mut self, sensor: &str) -> Result<InertialColumns, HeaderProblem> {
        let found = self.layout.find_inertial(sensor)?;
        let slots = found.map(|mut used| {
            if self.negative.contains(&used.column) {
                used.scale = -used.scale;
            }
            self.layout.used.push(used);
            self.values.push(f64::NAN);
            self.last_values.push(f64::NAN);
            self.values.len() - 1
        });
        Ok(InertialColumns { slots })
    }

    /// What was wrong so far.
    #[must_use]
    pub const fn quality(&self) -> &Quality {
        &self.quality
    }

    /// Rate, jitter and gaps so far.
    #[must_use]
    pub const fn timing(&self) -> &Timing {
        &self.timing
    }

    /// What errors call the file.
    #[must_use]
    pub fn file(&self) -> &str {
        self.table.file()
    }

    /// Bytes taken from the input so far, those read ahead included: for a progress bar.
    #[must_use]
    pub fn bytes_read(&self) -> u64 {
        self.table.bytes_read()
    }

    /// Wraps a problem with the header in an error that names the file, as for a sensor that the
    /// layout does not have.
    #[must_use]
    pub fn header_error(&self, problem: HeaderProblem) -> RecordingError {
        RecordingError::Header { file: self.table.file().to_owned(), problem }
    }

    /// The next row, or `None` at the end.
    ///
    /// # Errors
    /// [`RecordingError`] for a row with too few or too many cells, a cell that is not a number, or
    /// if reading fails. The next call goes on behind the bad row.
    pub fn next_row(&mut self) -> Result<Option<Row<'_>>, RecordingError> {
        // Behind a row that cannot be read, whose numbers are half of one row and half of another, nothing is
        // known to be repeated.
        let mut same = core::mem::take(&mut self.follows);
        if !self.table.advance()? {
            return Ok(self.end());
        }
        let line = self.table.line();
        let mut marks = RowMarks::default();
        core::mem::swap(&mut self.values, &mut self.last_values);
        let mut any_bad = false;
        for ((used, value), last) in self.layout.used.iter().zip(&mut self.values).zip(&self.last_values) {
            *value = match Cell::read(&self.table.record, *used) {
                Cell::Number(number) => number,
                Cell::Empty if used.optional => f64::NAN,
                bad => {
                    any_bad = true;
                    let Some(nan) = bad.count(line, &mut marks, &mut self.quality) else {
                        return if self.table.is_cut_in(used.column) {
                            Ok(self.end())
                        } else {
                            Err(not_a_number(&self.table, *used))
                        };
                    };
                    nan
                }
            };
            // Bits, so that a NaN equals itself.
            same &= value.to_bits() == last.to_bits();
        }
        let (mut time, mut time_step) = (None, None);
        if let Some(used) = self.layout.time {
            match Cell::read(&self.table.record, used) {
                Cell::Number(number) => {
                    time = Some(number);
                    match self.timing.judge(number) {
                        Some(Step::First) | None => {}
                        Some(Step::Usual(step)) => time_step = Some(step),
                        Some(Step::Gap(step)) => {
                            time_step = Some(step);
                            marks.gap = true;
                        }
                        Some(Step::Same) if same => marks.repeated = true,
                        Some(Step::Same | Step::Backward) => marks.backward = true,
                    }
                    marks.held = same && time_step.is_some();
                }
                bad => {
                    marks.bad_time = true;
                    if bad.count(line, &mut marks, &mut self.quality).is_none() {
                        return if self.table.is_cut_in(used.column) {
                            Ok(self.end())
                        } else {
                            Err(not_a_number(&self.table, used))
                        };
                    }
                }
            }
        } else {
            marks.repeated = same;
        }
        let row = Row { line, time, time_step, marks, values: &self.values };
        self.quality.note(&row, any_bad);
        self.follows = true;
        Ok(Some(row))
    }

    /// Reads so many rows at most into a block, in the place of what it holds; `false` at the end, where it holds none.
    ///
    /// # Errors
    /// As [`next_row`](Self::next_row); the block then holds the rows before the bad one.
    pub fn read_block(&mut self, block: &mut RowBlock, most: usize) -> Result<bool, RecordingError> {
        block.start(self.values.len());
        while block.len() < most.max(1) {
            let Some(row) = self.next_row()? else { break };
            block.push(&row);
        }
        Ok(!block.is_empty())
    }

    /// No more rows; a line that was cut is counted.
    #[cold]
    fn end(&mut self) -> Option<Row<'_>> {
        if let Some(line) = self.table.cut_line() {
            self.quality.cut_lines = FaultCount::default();
            self.quality.cut_lines.add(line);
        }
        None
    }
}

impl Quality {
    fn note(&mut self, row: &Row<'_>, any_bad: bool) {
        self.rows += 1;
        let (marks, line) = (row.marks, row.line);
        if marks == RowMarks::default() {
            return;
        }
        for (marked, fault) in [
            (marks.gap, &mut self.gaps),
            (marks.repeated, &mut self.repeated_rows),
            (marks.backward, &mut self.backward_times),
            (marks.held, &mut self.held_rows),
            (!row.is_usable() || any_bad, &mut self.unusable_rows),
        ] {
            if marked {
                fault.add(line);
            }
        }
    }
}

#[cold]
fn not_a_number<R: Read>(table: &TableReader<R>, used: UsedColumn) -> RecordingError {
    RecordingError::NotANumber {
        file: table.file().to_owned(),
        line: table.line(),
        column: table.names().get(used.column).cloned().unwrap_or_default(),
        found: shortened(&String::from_utf8_lossy(table.record.get(used.column).unwrap_or_default()), 40),
    }
}
