//! Readings without load.

use std::io::Read;

use fingertip_recordings::TableReader;
use nalgebra::DMatrix;

use super::LoadError;
use super::header::{
    Column, NameProblem, bad, not_a_number, number_in, parse_name, signal_layout, unreadable,
};
use crate::file::SignalUnit;

/// Readings without load.
///
/// ```
/// use fingertip_calibration::file::SignalUnit;
/// use fingertip_calibration::loads::{Rest, signals_from_csv};
///
/// let text = "v1_mV,v2_mV,temperature_C\n300,-20,21.5\n302,-20,21.5\n";
/// let rest: Rest = signals_from_csv(text.as_bytes())?;
/// assert_eq!((rest.unit, rest.signals.nrows()), (SignalUnit::Volt, 2));
/// assert!((rest.signals.column(0).mean() - 0.301).abs() < 1e-12);
/// assert_eq!(rest.temperatures, Some(vec![21.5, 21.5]));
/// # Ok::<(), fingertip_calibration::loads::LoadError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Rest {
    /// Samples × gauges.
    pub signals: DMatrix<f64>,
    /// Unit of the signals.
    pub unit: SignalUnit,
    /// Temperature of each sample \[°C\], if the file has them.
    pub temperatures: Option<Vec<f64>>,
    /// The line in which the file was cut, if that was found at its end: it is not among the samples.
    pub cut_line: Option<u64>,
}

/// Reads the signals alone of a CSV with the header of [`LoadTable::from_csv`](super::LoadTable::from_csv), and their temperatures.
/// Columns of loads are ignored.
///
/// # Errors
/// [`LoadError`], naming line and column.
pub fn signals_from_csv(reader: impl Read) -> Result<Rest, LoadError> {
    let mut table = TableReader::new("the table", reader).map_err(|error| unreadable(&error))?;
    let mut columns = Vec::new();
    for name in table.names() {
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
    'rows: while table.advance().map_err(|error| unreadable(&error))? {
        let mut row = vec![0.0; gauges];
        let mut temperature = None;
        for (index, column) in columns.iter().enumerate() {
            let read = match *column {
                Column::Signal(gauge, _, size) => {
                    number_in(table.text(index), size).map(|number| row[gauge] = number)
                }
                Column::Temperature => {
                    number_in(table.text(index), 1.0).map(|number| temperature = Some(number))
                }
                _ => Ok(()),
            };
            match read {
                Ok(()) => {}
                Err(_) if table.is_cut_in(index) => break 'rows,
                Err(what) => return Err(not_a_number(&table, index, what)),
            }
        }
        signals.extend(row);
        temperatures.extend(temperature);
        samples += 1;
    }
    let signals = DMatrix::from_row_slice(samples, gauges, &signals);
    let temperatures = (!temperatures.is_empty()).then_some(temperatures);
    Ok(Rest { signals, unit, temperatures, cut_line: table.cut_line() })
}
