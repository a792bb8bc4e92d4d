//! What the columns of a table of loads mean, by their names.

use super::LoadError;
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
    Time,
    Temperature,
    Weight,
    /// Part of the orientation: x, y, z, w.
    Quaternion(usize),
    Ignored,
}

pub(super) fn parse_name(name: &str) -> Result<Column, String> {
    match name {
        "case" | "level" => return Ok(Column::Case),
        "group" => return Ok(Column::Group),
        "name" => return Ok(Column::Name),
        "t_s" => return Ok(Column::Time),
        "temperature_C" => return Ok(Column::Temperature),
        "weight" => return Ok(Column::Weight),
        "qx" => return Ok(Column::Quaternion(0)),
        "qy" => return Ok(Column::Quaternion(1)),
        "qz" => return Ok(Column::Quaternion(2)),
        "qw" => return Ok(Column::Quaternion(3)),
        _ => {}
    }
    let (stem, unit) = name.rsplit_once('_').unwrap_or((name, ""));
    if let Some(axis) = Axis::from_name(stem) {
        let size = axis.unit_size(unit).ok_or_else(|| {
            let quantity = if axis.is_torque() { "torque" } else { "force" };
            format!("{unit:?} is not a unit of {quantity}; write such as `fx_N` or `tx_Nm`")
        })?;
        return Ok(Column::Load(axis, size));
    }
    let number = stem.strip_prefix('v').and_then(|digits| digits.parse::<usize>().ok());
    let Some(number) = number else { return Ok(Column::Ignored) };
    if number == 0 || number > 1000 {
        return Err("gauges are numbered from 1".to_owned());
    }
    let (unit, size) = match unit {
        "V" => (SignalUnit::Volt, 1.0),
        "mV" => (SignalUnit::Volt, 1e-3),
        "count" | "counts" => (SignalUnit::Count, 1.0),
        "mVpV" | "mV/V" => (SignalUnit::MillivoltPerVolt, 1.0),
        "strain" => (SignalUnit::Strain, 1.0),
        _ => match Axis::Fx.unit_size(unit).or_else(|| Axis::Tx.unit_size(unit)) {
            Some(size) => (SignalUnit::Wrench, size),
            None => {
                return Err(format!("{unit:?} is not a unit of signals; write such as `v1_V`, `v1_count`"));
            }
        },
    };
    Ok(Column::Signal(number - 1, unit, size))
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
pub(super) fn bad(line: u64, column: &str, message: String) -> LoadError {
    LoadError::BadText { line, column: column.to_owned(), message }
}

/// The number that a cell says, in a unit of this size; or what it is not. A finite number may be infinite in
/// SI.
pub(super) fn number_in(text: &str, size: f64) -> Result<f64, &'static str> {
    let number = text.parse::<f64>().map_err(|_| "a number")?;
    let scaled = number * size;
    match (number.is_finite(), scaled.is_finite()) {
        (_, true) => Ok(scaled),
        (true, false) => Err("a finite number in SI"),
        (false, false) => Err("a finite number"),
    }
}
