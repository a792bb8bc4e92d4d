//! The demo's volts and calibration as files, to try `fingertip analyze` on.

use std::io;
use std::path::{Path, PathBuf};

use fingertip_calibration::file::{CalibrationFile, Provenance};
use fingertip_recordings::{RecordingWriter, Schema, SignalUnit};
use fingertip_simulation::{SimulatedFingertip, SimulatedSample};
use nalgebra::DMatrix;

use crate::error::CliError;
use crate::output::{Outputs, Whole};
use crate::recording_file::csv as failed;

/// Writes samples as they come, if somebody wants them.
pub(super) struct VoltsFile(Option<(RecordingWriter<Whole>, PathBuf)>);

impl VoltsFile {
    pub(super) fn create(path: Option<&Path>, outputs: &Outputs) -> Result<Self, CliError> {
        let Some(path) = path else { return Ok(Self(None)) };
        let file = outputs.create("recording", path)?;
        let schema = Schema::default().time().signals("", 6, SignalUnit::Volt).dummy("", SignalUnit::Volt);
        let writer = RecordingWriter::new(file, &schema).map_err(|fault| failed(path, fault))?;
        Ok(Self(Some((writer, path.to_owned()))))
    }

    pub(super) fn write(&mut self, sample: &SimulatedSample) -> Result<(), CliError> {
        let Some((writer, path)) = &mut self.0 else { return Ok(()) };
        let cells = core::iter::once(sample.time).chain(sample.raw.iter().copied());
        writer.write(cells).map_err(|fault| failed(path, fault))
    }

    pub(super) fn finish(self) -> Result<(), CliError> {
        match self.0 {
            Some((writer, path)) => writer.finish().map_err(|fault| failed(&path, fault))?.finish(),
            None => Ok(()),
        }
    }
}

/// Writes the calibration of the simulated sensor, its zero left to the tare. Readings at either
/// end of the converter's range are marked as saturated.
pub(super) fn calibration(
    path: &Path,
    simulated: &SimulatedFingertip,
    outputs: &Outputs,
) -> Result<(), CliError> {
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
    let text = file.and_then(|file| file.to_toml());
    let text =
        text.map_err(|fault| CliError::write("calibration", path, io::Error::other(fault.to_string())))?;
    outputs.write("calibration", path, &text)
}
