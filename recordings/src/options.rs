//! How a recording is read.

use fingertip_wrench::units::{ForceUnit, TorqueUnit};

use crate::error::HeaderProblem;
use crate::shortened::shortened;
use crate::timing::Timing;

/// How a recording is read.
///
/// ```
/// use fingertip_recordings::{ReaderOptions, RecordingReader, RenamedColumn};
///
/// // A table without a header: the time in milliseconds, and a signal.
/// let file = "0,0.25\n2,0.5\n";
/// let named = |from: &str, to: &str| RenamedColumn { from: from.into(), to: to.into(), negative: false };
/// let renamed = vec![named("1", "t_ms"), named("2", "v1_V")];
/// let options = ReaderOptions { header: false, renamed, ..ReaderOptions::default() };
/// let mut reader = RecordingReader::with_options("gauge.csv", file.as_bytes(), options)?;
/// reader.next_row()?;
/// assert_eq!(reader.next_row()?.and_then(|row| row.time()), Some(0.002));
/// # Ok::<(), fingertip_recordings::RecordingError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ReaderOptions {
    /// Units of columns whose names have none; none by default.
    pub assumed_units: AssumedUnits,
    /// A step of time above this many times the median of all steps before is a gap; 1.5 by
    /// default, so that one lost sample shows.
    pub gap_factor: f64,
    /// Columns that have names of their own, and what to take them for; none by default.
    pub renamed: Vec<RenamedColumn>,
    /// Whether the first line names the columns, as it does by default. Without names they are called by their numbers,
    /// `1`, `2` and so on, and `renamed` says what they are.
    pub header: bool,
}

/// A column whose name says nothing to this library.
///
/// ```
/// use fingertip_recordings::{ReaderOptions, RecordingReader, RenamedColumn};
/// use nalgebra::Vector1;
///
/// // Somebody called the signal “pressure”, and wired it the other way round.
/// let renamed = vec![RenamedColumn { from: "pressure".into(), to: "v1_V".into(), negative: true }];
/// let options = ReaderOptions { renamed, ..ReaderOptions::default() };
/// let file = "t_s,pressure\n0,0.25\n";
/// let mut reader = RecordingReader::with_options("gauge.csv", file.as_bytes(), options)?;
/// let gauge = reader.layout().only_signals()?.clone();
/// assert_eq!(reader.next_row()?.and_then(|row| row.signals::<1>(&gauge)), Some(Vector1::new(-0.25)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RenamedColumn {
    /// As the file has it.
    pub from: String,
    /// What to take it for, as `fx_N` or `t_ms`.
    pub to: String,
    /// Whether its numbers have the other sign.
    pub negative: bool,
}

impl Default for ReaderOptions {
    fn default() -> Self {
        let (assumed_units, renamed) = (AssumedUnits::default(), Vec::new());
        Self { assumed_units, gap_factor: Timing::GAP_FACTOR, renamed, header: true }
    }
}

/// Units that the *user* states for columns whose names have none. Nothing is assumed by default.
///
/// ```
/// use fingertip_recordings::{AssumedUnits, ForceUnit, Layout, TorqueUnit};
///
/// let header = ["Fx", "Fy", "Fz", "Tx", "Ty", "Tz"];
/// assert!(Layout::from_header(&header, AssumedUnits::default()).is_err());
/// // Whoever recorded it knows that it is newtons and newton millimetres.
/// let units = AssumedUnits { force: Some(ForceUnit::Newton), torque: Some(TorqueUnit::NewtonMillimetre) };
/// assert_eq!(Layout::from_header(&header, units)?.wrenches().len(), 1);
/// # Ok::<(), fingertip_recordings::HeaderProblem>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AssumedUnits {
    /// Of forces.
    pub force: Option<ForceUnit>,
    /// Of torques.
    pub torque: Option<TorqueUnit>,
}

/// Gives columns the names that they are to be taken for, and says which have the other sign.
pub(super) fn rename(names: &mut [String], renamed: &[RenamedColumn]) -> Result<Vec<usize>, HeaderProblem> {
    let mut negative = Vec::new();
    let mut places = Vec::new();
    for column in renamed {
        let place = names.iter().position(|name| name.trim_start_matches('\u{feff}').trim() == column.from);
        let Some(place) = place else {
            let columns = shortened(&names.join(", "), 120);
            return Err(HeaderProblem::NoColumn { column: column.from.clone(), columns });
        };
        places.push((place, &column.to));
        if column.negative {
            negative.push(place);
        }
    }
    for (place, to) in places {
        if let Some(name) = names.get_mut(place) {
            name.clone_from(to);
        }
    }
    Ok(negative)
}
