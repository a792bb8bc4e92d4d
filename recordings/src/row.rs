//! One row of a recording.

use fingertip_wrench::{InertialReading, Wrench};
use nalgebra::{SVector, Vector3};

use crate::columns::{
    ContactCells, ContactColumns, InertialColumns, NumberColumn, SignalColumns, WrenchColumns,
};

/// What is remarkable about a row.
///
/// ```
/// use fingertip_recordings::RecordingReader;
///
/// let file = "t_s,v1_V\n0.000,0.1\n0.001,0.2\n0.002,nan\n0.003,0.3\n0.006,0.2\n";
/// let mut reader = RecordingReader::new("gauge.csv", file.as_bytes())?;
/// let mut marks = Vec::new();
/// while let Some(row) = reader.next_row()? {
///     marks.push(row.marks());
/// }
/// assert!(!marks[1].not_finite && !marks[1].gap);
/// assert!(marks[2].not_finite);
/// assert!(marks[4].gap); // two samples are missing before it
/// # Ok::<(), fingertip_recordings::RecordingError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct RowMarks {
    /// A used cell is empty.
    pub empty: bool,
    /// A used cell is NaN or infinite.
    pub not_finite: bool,
    /// The time of the row is missing or not finite.
    pub bad_time: bool,
    /// The row repeats the one before, at the same time or in a file without time.
    pub repeated: bool,
    /// The time is not after that of the row before.
    pub backward: bool,
    /// The row came after a pause: what follows from sample to sample starts anew.
    pub gap: bool,
    /// The values are those of the row before, at a later time.
    pub held: bool,
}

/// One row: its line in the file, its time, and the values of its sensors in SI.
///
/// ```
/// use fingertip_recordings::RecordingReader;
///
/// let file = "t_s,v1_V\n0.000,0.1\n0.002,0.2\n0.002,0.3\n";
/// let mut reader = RecordingReader::new("gauge.csv", file.as_bytes())?;
/// let gauge = reader.layout().only_signals()?.clone();
/// reader.next_row()?;
/// let second = reader.next_row()?.ok_or("no row")?;
/// assert_eq!((second.line(), second.time(), second.time_step()), (3, Some(0.002), Some(0.002)));
/// // The time of the third does not advance.
/// let third = reader.next_row()?.ok_or("no row")?;
/// assert!(!third.is_usable() && third.signals::<1>(&gauge).is_none());
/// assert_eq!(third.unchecked_signals(&gauge).collect::<Vec<_>>(), [0.3]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row<'a> {
    pub(super) line: u64,
    pub(super) time: Option<f64>,
    pub(super) time_step: Option<f64>,
    pub(super) marks: RowMarks,
    pub(super) values: &'a [f64],
}

impl Row<'_> {
    /// The line of the file, counted from 1.
    #[must_use]
    pub const fn line(&self) -> u64 {
        self.line
    }

    /// Time \[s\]; `None` if the file has none or the cell is unusable.
    #[must_use]
    pub const fn time(&self) -> Option<f64> {
        self.time
    }

    /// Time since the row before \[s\], always positive; `None` for the first row, one whose time
    /// does not advance, and where there is no time.
    #[must_use]
    pub const fn time_step(&self) -> Option<f64> {
        self.time_step
    }

    /// What is remarkable about the row.
    #[must_use]
    pub const fn marks(&self) -> RowMarks {
        self.marks
    }

    /// `false` for a row that repeats another one or whose time is missing or does not advance.
    /// Such a row gives neither wrench nor signals. Cells that are missing spoil only the sensor
    /// that they belong to.
    #[must_use]
    pub const fn is_usable(&self) -> bool {
        !(self.marks.repeated || self.marks.backward || self.marks.bad_time)
    }

    /// The wrench of a sensor, as in the file (converted to SI): the file's sign convention is the
    /// caller's to know, see [`Wrench::on_fingertip`] and [`Wrench::from_reaction`]. `None` if the
    /// row is unusable or one of the six numbers is missing or not finite.
    #[inline]
    #[must_use]
    pub fn wrench(&self, sensor: &WrenchColumns) -> Option<Wrench<f64>> {
        if !self.is_usable() {
            return None;
        }
        let [fx, fy, fz, tx, ty, tz] = sensor.slots.map(|slot| self.value(slot));
        let wrench = Wrench::on_fingertip(Vector3::new(fx, fy, fz), Vector3::new(tx, ty, tz));
        wrench.is_finite().then_some(wrench)
    }

    /// The signals of a sensor with `N` gauges. `None` if the row is unusable, a number is missing
    /// or not finite, or the sensor has not `N` signals (see [`SignalColumns::expecting`]).
    #[inline]
    #[must_use]
    pub fn signals<const N: usize>(&self, sensor: &SignalColumns) -> Option<SVector<f64, N>> {
        if !self.is_usable() || sensor.slots.len() != N {
            return None;
        }
        let mut signals = SVector::<f64, N>::zeros();
        for (signal, slot) in signals.iter_mut().zip(&sensor.slots) {
            *signal = self.value(*slot);
            if !signal.is_finite() {
                return None;
            }
        }
        Some(signals)
    }

    /// The dummy gauge of a sensor; `None` if the row is unusable, there is no such gauge, or its
    /// number is missing or not finite.
    #[inline]
    #[must_use]
    pub fn dummy(&self, sensor: &SignalColumns) -> Option<f64> {
        let value = self.value(sensor.dummy?);
        (self.is_usable() && value.is_finite()).then_some(value)
    }

    /// The number in a column that is watched, as in the file; `None` if the row is unusable, or the
    /// number is missing or not finite.
    #[inline]
    #[must_use]
    pub fn number(&self, column: &NumberColumn) -> Option<f64> {
        let value = self.value(column.slot);
        (self.is_usable() && value.is_finite()).then_some(value)
    }

    /// What an inertial unit read; `None` if the row is unusable, or a number is missing or not finite.
    #[inline]
    #[must_use]
    pub fn inertial(&self, columns: &InertialColumns) -> Option<InertialReading<f64>> {
        let cells = columns.slots.map(|slot| self.value(slot));
        let [ax, ay, az, wx, wy, wz] = cells;
        let reading = InertialReading {
            acceleration: Vector3::new(ax, ay, az),
            angular_velocity: Vector3::new(wx, wy, wz),
        };
        (self.is_usable() && cells.iter().all(|cell| cell.is_finite())).then_some(reading)
    }

    /// The contact. `None` where there is none, and if the row is unusable or a number is missing.
    #[must_use]
    pub fn contact(&self, columns: &ContactColumns) -> Option<ContactCells> {
        let cells = columns.slots.map(|slot| self.value(slot));
        ContactCells::from_cells(cells).filter(|_| self.is_usable())
    }

    /// The numbers of a wrench whatever is wrong with the row; NaN where one is missing.
    #[must_use]
    pub fn unchecked_components(&self, sensor: &WrenchColumns) -> [f64; 6] {
        sensor.slots.map(|slot| self.value(slot))
    }

    /// The numbers of the signals whatever is wrong with the row, then that of the dummy gauge if there is
    /// one; NaN where one is missing.
    pub fn unchecked_signals(&self, sensor: &SignalColumns) -> impl Iterator<Item = f64> {
        sensor.slots.iter().chain(&sensor.dummy).map(|slot| self.value(*slot))
    }

    #[inline]
    fn value(&self, slot: usize) -> f64 {
        self.values.get(slot).copied().unwrap_or(f64::NAN)
    }
}
