//! Where readings of gauges come from: CSV, MCAP, the simulated fingertip.

use std::fs::File;
use std::io::BufReader;

use fingertip_drivers::{Sample, Source, SourceError, SourceErrorKind};
use fingertip_recordings::mcap::{McapError, McapReader, Recorded};
use fingertip_recordings::{RecordingError, RecordingReader};
use fingertip_scene::{GaugeReading, NoWrench};
use thiserror::Error;

use super::simulated::Rounds;
use crate::calibrated::Readings;
use crate::error::CliError;
use crate::gauge_rows::GaugeRows;
use crate::input::{Input, Text};
use crate::recording_file::{self, mcap};

/// A reading on its own.
pub(super) struct Owned {
    pub(super) time: Option<f64>,
    pub(super) gauges: Vec<f64>,
    pub(super) dummy: Option<f64>,
    pub(super) celsius: Option<f64>,
}

impl Owned {
    pub(super) fn borrowed(&self) -> GaugeReading<'_, f64> {
        GaugeReading { gauges: &self.gauges, dummy: self.dummy, celsius: self.celsius }
    }
}

/// Gives readings, as far as they can be used, one after another.
pub(super) trait GaugeSource: Send {
    fn next(&mut self) -> Result<Option<Owned>, GaugeFault>;
}

/// Why there is no wrench.
#[derive(Debug, Error)]
pub(super) enum GaugeFault {
    #[error(transparent)]
    Reading(#[from] NoWrench),
    #[error("{0}")]
    Damaged(String),
    #[error("the sensor may not have been at rest while its zero was taken: {0}")]
    Doubtful(String),
    #[error("{0}")]
    Unusable(String),
}

impl SourceError for GaugeFault {
    fn kind(&self) -> SourceErrorKind {
        match self {
            Self::Reading(NoWrench::Saturated | NoWrench::Uncalibrated) => SourceErrorKind::Overload,
            Self::Reading(_) | Self::Damaged(_) => SourceErrorKind::Corrupt,
            Self::Doubtful(_) => SourceErrorKind::DeviceFault,
            Self::Unusable(_) => SourceErrorKind::Unsupported,
        }
    }
}

/// The rows of a recording.
pub(super) struct CsvGauges {
    pub(super) reader: RecordingReader<Text>,
    pub(super) rows: GaugeRows,
}

impl GaugeSource for CsvGauges {
    fn next(&mut self) -> Result<Option<Owned>, GaugeFault> {
        let damaged = |error: RecordingError| GaugeFault::Unusable(error.to_string());
        while let Some(row) = self.reader.next_row().map_err(damaged)? {
            let time = row.time();
            let owned = self.rows.reading(&row, |reading| Owned {
                time,
                gauges: reading.gauges.to_vec(),
                dummy: reading.dummy,
                celsius: reading.celsius,
            });
            // Rows that repeat another one, or whose time does not advance, are passed over.
            if owned.is_some() {
                return Ok(owned);
            }
        }
        Ok(None)
    }
}

/// A topic of signals, with that of the dummy gauge beside it.
pub(super) struct McapGauges {
    reader: McapReader<BufReader<File>>,
    topic: String,
    dummy: Option<String>,
    /// A reading whose dummy gauge is still to come.
    waiting: Option<Owned>,
    celsius: Option<f64>,
}

impl McapGauges {
    /// Reads the file through once, to see what there is.
    pub(super) fn open(
        input: &Input,
        sensor: Option<&str>,
        celsius: Option<f64>,
    ) -> Result<(Self, Readings), CliError> {
        let mut known: Vec<(String, String)> = Vec::new();
        let path = input.path();
        let mut reader = input.entries()?;
        loop {
            let entry = match reader.next_entry() {
                Ok(Some(entry)) => entry,
                Ok(None) | Err(McapError::Cut) => break,
                Err(error) => return Err(mcap(path, &error)),
            };
            if let Recorded::Signals(signals) = entry.recorded
                && !known.iter().any(|(topic, _)| *topic == entry.topic)
            {
                known.push((entry.topic, signals.unit));
            }
        }
        let gauges: Vec<_> = known.iter().filter(|(topic, _)| !topic.ends_with("/dummy")).collect();
        let chosen = match (sensor, gauges.as_slice()) {
            (Some(sensor), gauges) => gauges.iter().find(|(topic, _)| topic == sensor),
            (None, [only]) => Some(only),
            (None, _) => None,
        };
        let Some((topic, unit)) = chosen else {
            let topics: Vec<&str> = gauges.iter().map(|(topic, _)| topic.as_str()).collect();
            return Err(CliError::Mcap {
                path: path.to_owned(),
                message: format!("choose a topic of signals with --sensor; there are: {}", topics.join(", ")),
            });
        };
        let beside = topic.rsplit_once('/').map(|(folder, _)| format!("{folder}/dummy"));
        let dummy = beside.filter(|dummy| known.iter().any(|(topic, _)| topic == dummy));
        let readings = Readings {
            unit: recording_file::unit(unit),
            has_dummy: dummy.is_some(),
            has_rest: false,
            has_temperature: celsius.is_some(),
        };
        Ok((Self { reader: input.entries()?, topic: topic.clone(), dummy, waiting: None, celsius }, readings))
    }
}

impl GaugeSource for McapGauges {
    fn next(&mut self) -> Result<Option<Owned>, GaugeFault> {
        loop {
            let entry = self.reader.next_entry().map_err(|error| GaugeFault::Damaged(error.to_string()))?;
            let Some(entry) = entry else { return Ok(self.waiting.take()) };
            let Recorded::Signals(signals) = entry.recorded else { continue };
            if entry.topic == self.topic {
                let (time, celsius) = (Some(entry.time), self.celsius);
                let reading = Owned { time, gauges: signals.values, dummy: None, celsius };
                if self.dummy.is_none() {
                    return Ok(Some(reading));
                }
                if let Some(alone) = self.waiting.replace(reading) {
                    return Ok(Some(alone));
                }
            } else if Some(&entry.topic) == self.dummy.as_ref()
                && let Some(reading) = self.waiting.take_if(|reading| reading.time == Some(entry.time))
            {
                return Ok(Some(Owned { dummy: signals.values.first().copied(), ..reading }));
            }
        }
    }
}

/// The simulated fingertip.
pub(super) struct SimulatedGauges {
    pub(super) rounds: Rounds,
    pub(super) celsius: Option<f64>,
}

impl GaugeSource for SimulatedGauges {
    fn next(&mut self) -> Result<Option<Owned>, GaugeFault> {
        let Ok(sample) = self.rounds.next_sample();
        Ok(sample.and_then(|Sample { time, value }| {
            let (dummy, gauges) = value.as_slice().split_last()?;
            Some(Owned { time, gauges: gauges.to_vec(), dummy: Some(*dummy), celsius: self.celsius })
        }))
    }
}
