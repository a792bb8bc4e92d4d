//! Readings without load.

use std::io::Read;

use nalgebra::DMatrix;

use super::LoadError;
use super::header::{Column, NameProblem, bad, number_in, parse_name, signal_layout};
use crate::file::SignalUnit;

/// Readings without load.
#[derive(Clone, Debug, PartialEq)]
pub struct Rest {
    /// Samples × gauges.
    pub signals: DMatrix<f64>,
    /// Unit of the signals.
    pub unit: SignalUnit,
    /// Temperature of each sample \[°C\], if the file has them.
    pub temperatures: Option<Vec<f64>>,
}

/// Reads the signals alone of a CSV with the header of [`LoadTable::from_csv`](super::LoadTable::from_csv), and their temperatures.
/// Columns of loads are ignored.
///
/// # Errors
/// [`LoadError`], naming line and column.
pub fn signals_from_csv(reader: impl Read) -> Result<Rest, LoadError> {
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).comment(Some(b'#')).from_reader(reader);
    let header = reader.headers().map_err(|error| bad(1, "", error.to_string()))?.clone();
    let mut columns = Vec::new();
    for name in &header {
        // A load in an unknown unit does not matter here.
        columns.push(match parse_name(name) {
            Ok(Column::Load(..)) | Err(NameProblem::LoadUnit { .. }) => Column::Ignored,
            Ok(column) => column,
            Err(message) => return Err(bad(1, name, message)),
        });
    }
    let (_, gauges, unit) = signal_layout(&columns).map_err(|(column, message)| bad(1, &column, message))?;
    let (mut signals, mut temperatures) = (Vec::new(), Vec::new());
    let mut samples = 0;
    for record in reader.records() {
        let record = record
            .map_err(|error| bad(error.position().map_or(0, csv::Position::line), "", error.to_string()))?;
        let line = record.position().map_or(0, csv::Position::line);
        let start = signals.len();
        signals.resize(start + gauges, 0.0);
        for ((column, name), text) in columns.iter().zip(&header).zip(&record) {
            let number = |size: f64| {
                number_in(text, size).map_err(|what| bad(line, name, format!("{text:?} is not {what}")))
            };
            match *column {
                Column::Signal(gauge, _, size) => signals[start + gauge] = number(size)?,
                Column::Temperature => temperatures.push(number(1.0)?),
                _ => {}
            }
        }
        samples += 1;
    }
    let signals = DMatrix::from_row_slice(samples, gauges, &signals);
    Ok(Rest { signals, unit, temperatures: (!temperatures.is_empty()).then_some(temperatures) })
}
