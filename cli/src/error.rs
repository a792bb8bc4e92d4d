//! What can stop a run, each in one sentence: what is wrong, where, and how to mend it.

use std::io;
use std::path::{Path, PathBuf};

use fingertip_recordings::RecordingError;
use fingertip_scene::SceneError;
use thiserror::Error;

use crate::sensor::SensorError;
use crate::standard::{is_standard, shown};

/// Why a run stopped.
#[derive(Debug, Error)]
pub(crate) enum CliError {
    /// A file that is to be read cannot be.
    #[error("cannot read {what} {path}: {source}; check the path and its permissions", path = shown(.path))]
    Read { what: &'static str, path: PathBuf, source: io::Error },
    /// A file that is to be written cannot be.
    #[error(
        "cannot write {what} {path}: {source}{mend}",
        path = shown(.path), mend = mend_writing(.source)
    )]
    Write { what: &'static str, path: PathBuf, source: io::Error },
    /// Two outputs are one file.
    #[error("{first} and {second} are the same file; give two outputs two names", first = shown(.first), second = shown(.second))]
    OneFile { first: PathBuf, second: PathBuf },
    /// An output would overwrite an input.
    #[error("{what} {path} is also an input of this run and would be overwritten; give another path", path = shown(.path))]
    WouldOverwrite { what: &'static str, path: PathBuf },
    /// The scene does not say what it must.
    #[error(transparent)]
    Scene(SceneError),
    /// The recording cannot be used; the message names the file.
    #[error(transparent)]
    Recording(#[from] RecordingError),
    /// Neither the recording nor the scene tells the time.
    #[error(
        "{path} has no column of time; add one (t_s), or write `sample_rate_Hz` into [input] of {scene}",
        path = shown(.path), scene = shown(.scene)
    )]
    NoTime { path: PathBuf, scene: PathBuf },
    /// Volts without a calibration.
    #[error(
        "{path} holds signals but no wrench; give the sensor's calibration with --calibration",
        path = shown(.path)
    )]
    NeedsCalibration { path: PathBuf },
    /// A header and nothing else.
    #[error("{path} has a header but no rows; record something first", path = shown(.path))]
    NoRows { path: PathBuf },
    /// Some of several recordings are bad; each was named.
    #[error("{bad} of {of} recordings failed; the others were done")]
    Several { bad: usize, of: usize },
    /// The standard input was given for two inputs.
    #[error("the standard input can be read once; give it for one input, and files for the others")]
    StdinTwice,
    /// The standard output was given for two outputs.
    #[error("the standard output holds one output; give the others files")]
    StdoutTwice,
    /// Several recordings are to write one stream.
    #[error("the rows of several recordings cannot share the standard output; give --output a file")]
    SharedStdout,
    /// The rest of the scene is longer than the recording.
    #[error(
        "{path} ends within the {rest} s of rest that the scene states ({rows} rows); shorten `rest_s`",
        path = shown(.path)
    )]
    RestTooLong { path: PathBuf, rest: f64, rows: u64 },
    /// Nothing to take the tare from.
    #[error("fewer than 2 usable rows within the {rest} s of rest; lengthen `rest_s` of the scene")]
    NoRest { rest: f64 },
    /// The rest of the scene was clearly none.
    #[error(
        "{path} is not at rest within the first {rest} s, from which the tare is to be taken: {seen}; shorten `rest_s` \
         of the scene to the part without load and motion, or set `rest_s = 0` for no tare",
        path = shown(.path)
    )]
    NotAtRest { path: PathBuf, rest: f64, seen: String },
    /// The calibration cannot be used.
    #[error("calibration {path}: {message}", path = shown(.path))]
    Calibration { path: PathBuf, message: String },
    /// A table of loads, of poses or of rest cannot be used.
    #[error("{path}: {message}", path = shown(.path))]
    Calibrate { path: PathBuf, message: String },
    /// Readings of the sensor are wrong.
    #[error("the sensor in {path} gives wrong readings: {reason}", path = shown(.path))]
    Unhealthy { path: PathBuf, reason: String },
    /// A calibration that was fitted is not worth having.
    #[error(
        "the calibration {path} is bad: {reason}; mend the loads that the report names, or take it as it is with \
         --accept-bad",
        path = shown(.path)
    )]
    BadCalibration { path: PathBuf, reason: String },
    /// A calibration that was checked is wrong.
    #[error(
        "the calibration {calibration} does not hold on {loads}: {reason}",
        calibration = shown(.calibration), loads = shown(.loads)
    )]
    DoesNotHold { calibration: PathBuf, loads: PathBuf, reason: String },
    /// The simulated fingertip or a stage of the demo could not be built.
    #[error("the demo cannot run: {message}")]
    Demo { message: String },
    /// No sensor for what is wanted.
    #[error("no such sensor: {message}")]
    Design { message: String },
    /// An MCAP file cannot be used.
    #[error("{path}: {message}", path = shown(.path))]
    Mcap { path: PathBuf, message: String },
    /// A bag of ROS 2 in a database.
    #[error(
        "{path} is a ROS 2 bag in SQLite, which is not read; convert it to MCAP: ros2 bag convert -i {path} -o out.yaml, \
         where out.yaml holds output_bags: [{{uri: out, storage_id: mcap, all: true}}]",
        path = shown(.path)
    )]
    Bag { path: PathBuf },
    /// A bag of ROS 2 as a folder.
    #[error("{path} is the folder of a ROS 2 bag; give the .mcap file in it", path = shown(.path))]
    BagFolder { path: PathBuf },
    /// A name that says MCAP, and a file that is none.
    #[error("{path} is no MCAP file: it does not begin as one; if it is text, call it .csv", path = shown(.path))]
    NoMcap { path: PathBuf },
    /// No such topic.
    #[error("{path} has no topic {topic}; there are: {known}", path = shown(.path))]
    NoTopic { path: PathBuf, topic: String, known: String },
    /// A file of another kind.
    #[error("{path} is neither .csv nor .mcap; give it one of these endings", path = shown(.path))]
    UnknownEnding { path: PathBuf },
    /// What was to be converted cannot be.
    #[error("cannot convert {path}: {message}", path = shown(.path))]
    Convert { path: PathBuf, message: String },
    /// A scene cannot be exported.
    #[error("cannot export {path}: {message}", path = shown(.path))]
    Export { path: PathBuf, message: String },
    /// A sensor cannot be reached, or was lost.
    #[error("{address}: {source}")]
    Sensor { address: String, source: SensorError },
    /// An option of the command line has a value that it cannot have.
    #[error("{option} {problem}")]
    Option { option: String, problem: &'static str },
    /// The simulated sensor cannot be served.
    #[error("cannot simulate: {message}")]
    Simulate { message: String },
    /// What a live view is served by cannot be.
    #[error("{bridge}: {message}")]
    #[cfg(any(feature = "web", feature = "foxglove", feature = "ros2"))]
    Bridge { bridge: &'static str, message: String },
    /// The terminal does not do what a live view needs.
    #[error("terminal: {0}; `fingertip live` needs a terminal, `fingertip record` does not")]
    Terminal(io::Error),
    /// Whoever read our standard output has gone: not a fault.
    #[error("the reader of the standard output has closed it")]
    ClosedPipe,
    /// The standard output cannot be written for another reason.
    #[error("cannot write to the standard output: {0}; check where it is redirected to")]
    Stdout(io::Error),
}

impl CliError {
    pub(crate) fn read(what: &'static str, path: &Path, source: io::Error) -> Self {
        Self::Read { what, path: path.to_owned(), source }
    }

    pub(crate) fn write(what: &'static str, path: &Path, source: io::Error) -> Self {
        if is_standard(path) {
            return Self::stdout(source);
        }
        Self::Write { what, path: path.to_owned(), source }
    }

    /// What is wrong with a sensor or the recording in its place.
    pub(crate) fn sensor(address: impl ToString, source: impl Into<SensorError>) -> Self {
        Self::Sensor { address: address.to_string(), source: source.into() }
    }

    /// An option of the command line, as it was written, and what it must be.
    pub(crate) fn option(name: &str, value: impl core::fmt::Display, problem: &'static str) -> Self {
        Self::Option { option: format!("{name} {value}"), problem }
    }

    /// What went wrong with the standard output.
    pub(crate) fn stdout(source: io::Error) -> Self {
        if source.kind() == io::ErrorKind::BrokenPipe { Self::ClosedPipe } else { Self::Stdout(source) }
    }
}

/// What to do about a file that cannot be written.
fn mend_writing(source: &io::Error) -> &'static str {
    match source.kind() {
        // It is in the message.
        io::ErrorKind::AlreadyExists | io::ErrorKind::Other | io::ErrorKind::InvalidData => "",
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => "; make room, or choose another disk",
        _ => "; choose a folder that exists and may be written to",
    }
}
