//! What can be wrong with a recording.

use std::io;

use thiserror::Error;

/// Why a recording cannot be read or written. Lines count from 1, the header included.
///
/// ```
/// use fingertip_recordings::{RecordingError, RecordingReader};
///
/// // Somebody wrote a decimal comma.
/// let file = "t_s;v1_V;v2_V\n0.0;0.25;0,5\n";
/// let mut reader = RecordingReader::new("gauges.csv", file.as_bytes())?;
/// let refused = reader.next_row().unwrap_err();
/// assert!(matches!(&refused, RecordingError::NotANumber { line: 2, column, .. } if column == "v2_V"));
/// assert!(refused.to_string().starts_with("gauges.csv, line 2, column v2_V: “0,5” is not a number"));
/// # Ok::<(), RecordingError>(())
/// ```
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum RecordingError {
    /// The file cannot be opened.
    #[error("cannot open {file}: {source}")]
    Open {
        /// Name of the file.
        file: String,
        /// What the system says.
        source: io::Error,
    },
    /// Reading failed.
    #[error("cannot read on in {file} behind line {line}: {source}")]
    Read {
        /// Name of the file.
        file: String,
        /// The last line that was read.
        line: u64,
        /// What the system says.
        source: io::Error,
    },
    /// Writing failed.
    #[error("cannot write the recording: {source}")]
    Write {
        /// What the system says.
        source: io::Error,
    },
    /// A row to write has not one value for every column.
    #[error("a row of {found} values was given to a recording of {expected} columns")]
    WrongRow {
        /// Columns of the recording.
        expected: usize,
        /// Values given.
        found: usize,
    },
    /// There is no header.
    #[error(
        "{file} is empty: a recording starts with a line that names its columns, such as t_s,fx_N,…,tz_Nm"
    )]
    Empty {
        /// Name of the file.
        file: String,
    },
    /// The header does not say what is needed.
    #[error("header of {file}: {problem}")]
    Header {
        /// Name of the file.
        file: String,
        /// What is wrong, and how to mend it.
        problem: HeaderProblem,
    },
    /// A row has more or fewer cells than the header.
    #[error(
        "{file}, line {line}: {found} cells where the header names {expected} columns; mend or delete that line"
    )]
    Ragged {
        /// Name of the file.
        file: String,
        /// The line.
        line: u64,
        /// Columns of the header.
        expected: usize,
        /// Cells of the line.
        found: usize,
    },
    /// A cell holds something other than a number.
    #[error(
        "{file}, line {line}, column {column}: “{found}” is not a number; write numbers as 0.25 or 2.5e-1, and leave a missing one empty"
    )]
    NotANumber {
        /// Name of the file.
        file: String,
        /// The line.
        line: u64,
        /// Name of the column.
        column: String,
        /// What stands there, shortened if it is long.
        found: String,
    },
    /// A line is too long to be one of a recording.
    #[error(
        "{file}, behind line {line}: a line longer than {limit} bytes, or a quote that is never closed; is this a text file?"
    )]
    TooLong {
        /// Name of the file.
        file: String,
        /// The last line that was read.
        line: u64,
        /// The longest line that is read.
        limit: u64,
    },
}

/// What a header lacks, and how to mend it.
///
/// ```
/// use fingertip_recordings::{AssumedUnits, HeaderProblem, Layout};
///
/// let refused = Layout::from_header(&["t_s", "v1_V", "v2_V", "v4_V"], AssumedUnits::default()).unwrap_err();
/// assert_eq!(refused, HeaderProblem::MissingSignal { sensor: String::new(), number: 3 });
/// let told = "the signals lack number 3; they must be numbered without a hole, from 0 or 1";
/// assert_eq!(refused.to_string(), told);
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum HeaderProblem {
    /// No column is one of a sensor.
    #[error(
        "no column is a force, a torque or a signal; name them fx_N, fy_N, fz_N, tx_Nm, ty_Nm, tz_Nm, or v1_V to v6_V (found: {columns})"
    )]
    NoSensor {
        /// The columns that there are.
        columns: String,
    },
    /// A column that was named is not there.
    #[error("there is no column {column:?}; there are: {columns}")]
    NoColumn {
        /// As it was named.
        column: String,
        /// The columns that there are.
        columns: String,
    },
    /// A force, torque or time without a unit.
    #[error("column {column} has no unit that is known; rename it, for example to {example}")]
    MissingUnit {
        /// Name of the column.
        column: String,
        /// How it could be named.
        example: String,
    },
    /// A wrench of which axes are missing.
    #[error("the wrench{sensor} lacks {missing}; a wrench needs fx, fy, fz, tx, ty and tz")]
    MissingAxis {
        /// ` of sensor x`, or nothing if the sensor has no name.
        sensor: String,
        /// The axes that are missing.
        missing: String,
    },
    /// An inertial unit of which columns are missing.
    #[error(
        "the inertial unit{sensor} lacks {missing}; it needs ax, ay, az and wx, wy, wz with their units, such as ax_m_per_s2 and wx_rad_per_s"
    )]
    MissingInertial {
        /// ` of sensor x`, or nothing if the sensor has no name.
        sensor: String,
        /// The columns that are missing.
        missing: String,
    },
    /// The numbers of the signals have a hole.
    #[error("the signals{sensor} lack number {number}; they must be numbered without a hole, from 0 or 1")]
    MissingSignal {
        /// ` of sensor x`, or nothing if the sensor has no name.
        sensor: String,
        /// The number that is missing.
        number: u32,
    },
    /// Signals of one sensor in volts and in counts.
    #[error("columns {first} and {second} belong to one sensor but have different units; use one unit")]
    MixedUnits {
        /// One column.
        first: String,
        /// Another one.
        second: String,
    },
    /// Two columns mean the same.
    #[error("columns {first} and {second} mean the same; rename or delete one")]
    Duplicate {
        /// The first of them.
        first: String,
        /// The other.
        second: String,
    },
    /// The sensor that was asked for is not there.
    #[error("there is no {what} of a sensor “{sensor}”; there is: {known}")]
    NoSuchSensor {
        /// Wrench or signals.
        what: &'static str,
        /// The name asked for.
        sensor: String,
        /// What the file has.
        known: String,
    },
    /// There are several sensors and none was chosen.
    #[error("the file holds several sensors; choose one of: {known}")]
    SeveralSensors {
        /// Their names.
        known: String,
    },
    /// Not as many signals as asked for.
    #[error("there are {found} signals{sensor}, and {expected} are needed")]
    WrongSignalCount {
        /// ` of sensor x`, or nothing if the sensor has no name.
        sensor: String,
        /// How many the file has.
        found: usize,
        /// How many were asked for.
        expected: usize,
    },
    /// No dummy gauge where one is needed.
    #[error("the signals{sensor} have no dummy gauge; name its column dummy_V")]
    NoDummy {
        /// ` of sensor x`, or nothing if the sensor has no name.
        sensor: String,
    },
}
