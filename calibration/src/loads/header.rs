//! What the columns of a table of loads mean, by their names.

use std::io::Read;

use fingertip_recordings::{ColumnMeaning, ColumnName, ForceUnit, RecordingError, TableReader, TorqueUnit};
use thiserror::Error;

use super::{LoadError, LoadTable};
use crate::Axis;
use crate::file::SignalUnit;

/// What a column of the header means.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Column {
    /// A load and the size of its unit in SI.
    Load(Axis, f64),
    /// A signal: number of the gauge from 0, its unit, and the unit's size.
    Signal(usize, SignalUnit, f64),
    Case,
    Group,
    Name,
    /// The size of its unit in seconds.
    Time(f64),
    Temperature,
    Weight,
    /// Part of the orientation: x, y, z, w.
    Quaternion(usize),
    Ignored,
}

/// Why a column cannot be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub(super) enum NameProblem {
    #[error("it states no unit of {quantity} that is known; write such as `fx_N` or `tx_Nm`")]
    LoadUnit { quantity: &'static str },
    #[error("it states no unit of signals that is known; write such as `v1_V`, `v1_count`")]
    SignalUnit,
    #[error("gauges are numbered from 1")]
    Number,
}

/// What a column means: by the grammar of recordings, but for what only tables of loads have. Columns of other sensors,
/// whose name stands in front, are ignored.
pub(super) fn parse_name(name: &str) -> Result<Column, NameProblem> {
    match name {
        "case" | "level" => return Ok(Column::Case),
        "group" => return Ok(Column::Group),
        "name" => return Ok(Column::Name),
        "temperature_C" => return Ok(Column::Temperature),
        "weight" => return Ok(Column::Weight),
        "qx" => return Ok(Column::Quaternion(0)),
        "qy" => return Ok(Column::Quaternion(1)),
        "qz" => return Ok(Column::Quaternion(2)),
        "qw" => return Ok(Column::Quaternion(3)),
        _ => {}
    }
    let ColumnName { sensor, meaning } = ColumnName::parse(name);
    if !sensor.is_empty() && name.to_lowercase().starts_with(&sensor) {
        return Ok(Column::Ignored);
    }
    // What stands behind the quantity and is no unit of it would be the name of a sensor in a recording.
    let is_of_this_sensor = sensor.is_empty();
    let load = |axis: usize, size: Option<f64>, quantity| {
        let axis = Axis::ALL.get(axis).copied().zip(size.filter(|_| is_of_this_sensor));
        axis.map(|(axis, size)| Column::Load(axis, size)).ok_or(NameProblem::LoadUnit { quantity })
    };
    match meaning {
        ColumnMeaning::Time(Some(seconds)) => Ok(Column::Time(seconds)),
        ColumnMeaning::Force(axis, unit) => load(axis, unit.map(ForceUnit::in_newtons), "force"),
        ColumnMeaning::Torque(axis, unit) => load(3 + axis, unit.map(TorqueUnit::in_newton_metres), "torque"),
        ColumnMeaning::Signal(number, ..) if number == 0 || number > 1000 => Err(NameProblem::Number),
        ColumnMeaning::Signal(_, SignalUnit::Unstated, _) => Err(NameProblem::SignalUnit),
        ColumnMeaning::Signal(number, unit, size) if is_of_this_sensor => {
            Ok(Column::Signal(number as usize - 1, unit, size))
        }
        ColumnMeaning::Signal(..) => Err(NameProblem::SignalUnit),
        _ => Ok(Column::Ignored),
    }
}

pub(super) type Layout = Result<(Vec<Axis>, usize, SignalUnit), (String, String)>;

/// Axes in order, number of gauges, unit; or the column that is wrong and why.
pub(super) fn layout(columns: &[Column]) -> Layout {
    let found = signal_layout(columns)?;
    if found.0.is_empty() {
        return Err(("fx_N".to_owned(), "there is no column of loads".to_owned()));
    }
    Ok(found)
}

/// As [`layout`], whether or not there are loads.
pub(super) fn signal_layout(columns: &[Column]) -> Layout {
    let mut axes = Vec::new();
    let mut gauges = Vec::new();
    let mut unit = None;
    for column in columns {
        match *column {
            Column::Load(axis, _) if axes.contains(&axis) => {
                return Err((axis.name().to_owned(), "stands twice".to_owned()));
            }
            Column::Load(axis, _) => axes.push(axis),
            Column::Signal(gauge, of, _) => {
                if gauges.contains(&gauge) {
                    return Err((format!("v{}", gauge + 1), "stands twice".to_owned()));
                }
                if unit.is_some_and(|unit| unit != of) {
                    return Err((format!("v{}", gauge + 1), "is in another unit than v1".to_owned()));
                }
                unit = Some(of);
                gauges.push(gauge);
            }
            _ => {}
        }
    }
    axes.sort_unstable();
    if let Some(missing) = (0..gauges.len()).find(|gauge| !gauges.contains(gauge)) {
        return Err((format!("v{}", missing + 1), "is missing".to_owned()));
    }
    match unit {
        None => Err(("v1_V".to_owned(), "there is no column of signals".to_owned())),
        Some(unit) => Ok((axes, gauges.len(), unit)),
    }
}

/// What is wrong, where.
pub(super) fn bad(line: u64, column: &str, message: impl ToString) -> LoadError {
    LoadError::BadText { line, column: column.to_owned(), message: message.to_string() }
}

/// Why a table cannot be read, as every reader of recordings says it.
pub(super) fn unreadable(error: &RecordingError) -> LoadError {
    match error {
        RecordingError::Ragged { line, expected, found, .. } => bad(
            *line,
            "",
            format!("{found} cells where the header names {expected} columns; mend or delete that line"),
        ),
        RecordingError::TooLong { line, limit, .. } => {
            let what =
                format!("is longer than {limit} bytes, or a quote is never closed; is this a text file?");
            bad(line + 1, "", what)
        }
        RecordingError::Empty { .. } => LoadError::Empty { what: "columns: the file is empty" },
        RecordingError::Read { line, source, .. } => bad(line + 1, "", format!("cannot be read: {source}")),
        other => bad(1, "", other),
    }
}

/// A cell of the row at hand that is not what it should be.
pub(super) fn not_a_number<R: Read>(table: &TableReader<R>, column: usize, what: &str) -> LoadError {
    let name = table.names().get(column).map_or("", String::as_str);
    bad(table.line(), name, format!("{:?} is not {what}", table.text(column)))
}

/// The number that a cell says, in a unit of this size; or what it is not. A number may be finite, and beyond
/// [`LoadTable::GREATEST`] in SI.
pub(super) fn number_in(text: &str, size: f64) -> Result<f64, &'static str> {
    // The same numbers, sooner; it knows fewer ways to write one.
    let number = fast_float2::parse(text).or_else(|_| text.parse::<f64>()).map_err(|_| "a number")?;
    if !number.is_finite() {
        return Err("a finite number");
    }
    let scaled = number * size;
    if LoadTable::carries(scaled) {
        Ok(scaled)
    } else {
        Err(
            "a number that a fit can carry: it is beyond 1e100 in SI. Mend the cell, or the unit in the column's name",
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signals_stand_once_each_in_one_unit() {
        let signal = |gauge, unit| Column::Signal(gauge, unit, 1.0);
        let said = |columns: &[Column]| signal_layout(columns).map(|(_, gauges, unit)| (gauges, unit));
        let refused = |columns: &[Column]| said(columns).unwrap_err();
        let volt = |gauge| signal(gauge, SignalUnit::Volt);
        assert_eq!(said(&[volt(1), Column::Ignored, volt(0)]), Ok((2, SignalUnit::Volt)));
        let words = |column: &str, why: &str| (column.to_owned(), why.to_owned());
        assert_eq!(refused(&[volt(0), volt(1), volt(1)]), words("v2", "stands twice"));
        assert_eq!(refused(&[volt(0), volt(2)]), words("v2", "is missing"));
        let other = signal(1, SignalUnit::MillivoltPerVolt);
        assert_eq!(refused(&[volt(0), other]), words("v2", "is in another unit than v1"));
        let twice = [Column::Load(Axis::Fx, 1.0), volt(0), Column::Load(Axis::Fx, 1.0)];
        assert_eq!(refused(&twice), words("fx", "stands twice"));
    }
}
