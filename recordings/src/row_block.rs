//! Rows that were read ahead.

use crate::row::{Row, RowMarks};

/// What a row has beside its values.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Stamp {
    line: u64,
    time: Option<f64>,
    time_step: Option<f64>,
    marks: RowMarks,
}

/// Some rows of one recording, to be handed from the thread that reads to the one that works on them: see
/// [`RecordingReader::read_block`](crate::RecordingReader::read_block). Its memory is used again.
///
/// ```
/// use fingertip_recordings::{RecordingReader, RowBlock};
///
/// let file = "t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm\n0,0,0,1,0,0,0\n0.01,0,0,2,0,0,0\n0.02,0,0,3,0,0,0\n";
/// let mut reader = RecordingReader::new("example.csv", file.as_bytes())?;
/// let force = reader.layout().only_wrench()?.clone();
/// let mut block = RowBlock::default();
/// let mut forces = Vec::new();
/// while reader.read_block(&mut block, 2)? {
///     forces.extend(block.rows().filter_map(|row| Some(row.wrench(&force)?.force().z)));
/// }
/// assert_eq!(forces, [1.0, 2.0, 3.0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RowBlock {
    stamps: Vec<Stamp>,
    /// Row after row.
    values: Vec<f64>,
    /// Values of a row.
    width: usize,
}

impl RowBlock {
    /// How many rows it holds.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.stamps.len()
    }

    /// Whether it holds none.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.stamps.is_empty()
    }

    /// The rows, in their order.
    pub fn rows(&self) -> impl Iterator<Item = Row<'_>> {
        let of = |(number, stamp): (usize, &Stamp)| {
            let values = self.values.get(number * self.width..).and_then(|rest| rest.get(..self.width));
            let Stamp { line, time, time_step, marks } = *stamp;
            Row { line, time, time_step, marks, values: values.unwrap_or_default() }
        };
        self.stamps.iter().enumerate().map(of)
    }

    /// Forgets its rows; the next have so many values each.
    pub(super) fn start(&mut self, width: usize) {
        self.stamps.clear();
        self.values.clear();
        self.width = width;
    }

    /// Takes a row of the width that it was started with.
    #[inline]
    pub(super) fn push(&mut self, row: &Row<'_>) {
        let Row { line, time, time_step, marks, values } = *row;
        self.stamps.push(Stamp { line, time, time_step, marks });
        self.values.extend_from_slice(values);
    }
}
