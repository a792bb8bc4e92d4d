//! The demo's volts and calibration as files, to try `fingertip analyze` on.

use std::fs::File;
use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};

use fingertip_calibration::file::{CalibrationFile, FileError, Provenance};
use fingertip_recordings::{RecordingError, RecordingWriter, Schema, SignalUnit};
use fingertip_simulation::{SimulatedFingertip, SimulatedSample};
use nalgebra::DMatrix;

use crate::error::CliError;

/// Writes samples as they come, if somebody wants them.
pub(super) struct VoltsFile(Option<(RecordingWriter<BufWriter<File>>, PathBuf)>);

impl VoltsFile {
    pub(super) fn create(path: Option<&Path>) -> Result<Self, CliError> {
        let Some(path) = path else { return Ok(Self(None)) };
        let file = File::create(path).map_err(|source| CliError::write("recording", path, source))?;
        let schema = Schema::default().time().signals("", 6, SignalUnit::Volt).dummy("", SignalUnit::Volt);
        let writer =
            RecordingWriter::new(BufWriter::new(file), &schema).map_err(|fault| failed(path, fault))?;
        Ok(Self(Some((writer, path.to_owned()))))
    }

    pub(super) fn write(&mut self, sample: &SimulatedSample) -> Result<(), CliError> {
        let Some((writer, path)) = &mut self.0 else { return Ok(()) };
        let cells = core::iter::once(sample.time).chain(sample.raw.iter().copied());
        writer.write(cells).map_err(|fault| failed(path, fault))
    }

    pub(super) fn finish(self) -> Result<(), CliError> {
        match self.0 {
            Some((writer, path)) => writer.finish().map(drop).map_err(|fault| failed(&path, fault)),
            None => Ok(()),
        }
    }
}

fn failed(path: &Path, fault: RecordingError) -> CliError {
    match fault {
        RecordingError::Write { source } => CliError::write("recording", path, source),
        other => CliError::Recording(other),
    }
}

/// Writes the calibration of the simulated sensor, its zero left to the tare. Readings at either
/// end of the converter's range are marked as saturated.
pub(super) fn calibration(path: &Path, simulated: &SimulatedFingertip) -> Result<(), CliError> {
    let (matrix, electronics) = (simulated.calibrated_matrix(), &simulated.options().electronics);
    let normalised = DMatrix::from_iterator(6, 6, matrix.normalised().iter().copied());
    let nominal = matrix.nominal().iter().copied().collect();
    let file = CalibrationFile::new(normalised, nominal, vec![0.0; 6], SignalUnit::Volt).map(|file| {
        CalibrationFile {
            provenance: Provenance {
                method: "simulated".to_owned(),
                source: "fingertip demo".to_owned(),
                ..file.provenance.clone()
            },
            range: Some([0.0, electronics.converter_range - electronics.step()]),
            ..file
        }
    });
    file.and_then(|file| file.write(path)).map_err(|fault| {
        let source = match fault {
            FileError::Io { source, .. } => source,
            other => io::Error::other(other.to_string()),
        };
        CliError::write("calibration", path, source)
    })
}
