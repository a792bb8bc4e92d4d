//! What was wrong in a recording, counted.

use core::fmt;

/// How often a fault was seen, and in which lines first.
///
/// ```
/// use fingertip_recordings::RecordingReader;
///
/// let file = "t_s,v1_V\n0.000,0.1\n0.001,\n0.002,0.1\n0.003,\n";
/// let mut reader = RecordingReader::new("gauge.csv", file.as_bytes())?;
/// while reader.next_row()?.is_some() {}
/// let empty = reader.quality().empty_cells;
/// assert_eq!((empty.count(), empty.first_lines()), (2, &[3, 5][..]));
/// # Ok::<(), fingertip_recordings::RecordingError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FaultCount {
    count: u64,
    lines: [u64; Self::LINES],
    kept: usize,
}

impl FaultCount {
    /// How many lines are remembered.
    pub const LINES: usize = 5;

    /// How often the fault was seen.
    #[must_use]
    pub const fn count(&self) -> u64 {
        self.count
    }

    /// The first lines with the fault, at most [`LINES`](Self::LINES), each once.
    #[must_use]
    pub fn first_lines(&self) -> &[u64] {
        self.lines.get(..self.kept).unwrap_or_default()
    }

    pub(super) fn add(&mut self, line: u64) {
        self.count += 1;
        if self.first_lines().last() != Some(&line)
            && let Some(place) = self.lines.get_mut(self.kept)
        {
            *place = line;
            self.kept += 1;
        }
    }
}

/// The faults of a recording, as far as it has been read.
///
/// ```
/// use fingertip_recordings::RecordingReader;
///
/// // A row that says the same again, one that is late, and one that goes back in time.
/// let file = "t_s,v1_V\n0.000,0.1\n0.000,0.1\n0.001,0.2\n0.002,0.3\n0.003,0.4\n0.006,0.5\n0.005,0.6\n";
/// let mut reader = RecordingReader::new("gauge.csv", file.as_bytes())?;
/// while reader.next_row()?.is_some() {}
/// let quality = reader.quality();
/// assert!(!quality.is_clean());
/// assert_eq!(quality.repeated_rows.first_lines(), [3]);
/// assert_eq!(quality.gaps.first_lines(), [7]);
/// assert_eq!(quality.backward_times.first_lines(), [8]);
/// # Ok::<(), fingertip_recordings::RecordingError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Quality {
    /// Rows read, those with faults included.
    pub rows: u64,
    /// Rows that gave no sample of any sensor, or whose time is unusable.
    pub unusable_rows: FaultCount,
    /// Cells without a number (empty, `NA`, `null`) in columns that are used.
    pub empty_cells: FaultCount,
    /// Cells that hold NaN or infinity, or a number beyond the range of `f64`.
    pub not_finite_cells: FaultCount,
    /// Rows that came after a pause: the step was more than the allowed factor above the median of
    /// the steps before.
    pub gaps: FaultCount,
    /// Rows that say again what the row before said, at the same time or in a file without time.
    pub repeated_rows: FaultCount,
    /// Rows whose time is not after that of the row before, with other values.
    pub backward_times: FaultCount,
    /// Rows with the values of the row before at a later time: a sensor that was read faster than
    /// it measures, or one that stands still. They are used, since a coarse converter gives them
    /// too.
    pub held_rows: FaultCount,
    /// A last line that was cut: it has no end, and cells are missing or half. It is not among the rows.
    pub cut_lines: FaultCount,
}

impl Quality {
    /// `true` if nothing was found but held rows.
    #[must_use]
    pub const fn is_clean(&self) -> bool {
        self.unusable_rows.count == 0
            && self.empty_cells.count == 0
            && self.not_finite_cells.count == 0
            && self.gaps.count == 0
            && self.cut_lines.count == 0
    }

    /// Every kind of fault with its name, for a table.
    #[must_use]
    pub const fn faults(&self) -> [(&'static str, FaultCount); 8] {
        [
            ("unusable rows", self.unusable_rows),
            ("empty cells", self.empty_cells),
            ("cells that are not finite", self.not_finite_cells),
            ("gaps in time", self.gaps),
            ("repeated rows", self.repeated_rows),
            ("times that do not advance", self.backward_times),
            ("rows that hold the last values", self.held_rows),
            ("last lines that were cut", self.cut_lines),
        ]
    }
}

impl fmt::Display for Quality {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} rows", self.rows)?;
        for (name, fault) in self.faults() {
            if fault.count() > 0 {
                write!(f, "; {} {name} (first in line", fault.count())?;
                for (index, line) in fault.first_lines().iter().enumerate() {
                    write!(f, "{} {line}", if index == 0 { "" } else { "," })?;
                }
                f.write_str(")")?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_remembered_once_and_not_beyond_the_room() {
        let mut fault = FaultCount::default();
        for line in [3, 3, 7, 8, 9, 10, 11, 12] {
            fault.add(line);
        }
        assert_eq!((fault.count(), fault.first_lines()), (8, [3, 7, 8, 9, 10].as_slice()));
    }

    #[test]
    fn the_summary_names_each_fault_and_its_lines() {
        let mut quality = Quality { rows: 9, ..Quality::default() };
        quality.gaps.add(4);
        quality.gaps.add(6);
        assert_eq!(quality.to_string(), "9 rows; 2 gaps in time (first in line 4, 6)");
        assert!(!quality.is_clean());
    }
}
