//! From text to wrenches.

use fingertip_wrench::{Real, Wrench};
use thiserror::Error;

use super::wire::{FORMAT, Reading};
use crate::sensors::axis_counts::AxisCounts;
use crate::sensors::line::{Deframer, LineDecoder, LineStatistics};
use crate::{Sample, SourceError, SourceErrorKind};

/// What is wrong with a reading.
///
/// ```
/// use fingertip_drivers::sensors::AxisCounts;
/// use fingertip_drivers::sensors::dynpick::{DynPickDecoder, Reading};
/// use fingertip_drivers::sensors::line::LineDecoder;
///
/// // Fy is at the end of the converter's range.
/// let mut raw = [Reading::ZERO; 6];
/// raw[1] = Reading::GREATEST;
/// let mut decoder = DynPickDecoder::new(AxisCounts::uniform(24.9, 1664.0)?);
/// let found = Reading { tick: 0, raw }
///     .emit()
///     .into_iter()
///     .find_map(|byte| LineDecoder::<f64>::push(&mut decoder, byte));
/// let told = found.unwrap().unwrap_err().to_string();
/// assert_eq!(told, "axis 1 (Fx, Fy, Fz, Tx, Ty, Tz from 0) is at the end of its range");
/// # Ok::<(), fingertip_drivers::sensors::BadAxisCounts>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum DynPickFault {
    /// An axis is at the end of the converter's range, so that its load is beyond it.
    #[error("axis {axis} (Fx, Fy, Fz, Tx, Ty, Tz from 0) is at the end of its range")]
    Saturated {
        /// Index of the axis.
        axis: usize,
    },
}

impl SourceError for DynPickFault {
    fn kind(&self) -> SourceErrorKind {
        SourceErrorKind::Overload
    }
}

/// Decodes what the sensor sends. Samples have no time.
///
/// ```
/// use fingertip_drivers::Source;
/// use fingertip_drivers::sensors::AxisCounts;
/// use fingertip_drivers::sensors::dynpick::{DynPickDecoder, REQUEST, SimulatedDynPick};
/// use fingertip_drivers::sensors::line::{LineFaults, LineSensor, SimulatedSerial};
/// use std::io::Write;
///
/// let counts = AxisCounts::uniform(25.0, 1664.0)?;
/// let port = SimulatedSerial::new(SimulatedDynPick::new(counts), LineFaults::default());
/// let mut sensor = LineSensor::<_, f64, _>::new(port, DynPickDecoder::new(counts));
/// // Each reading is asked for.
/// sensor.line_mut().write_all(&[REQUEST])?;
/// sensor.line_mut().sample([0.0, 0.0, -2.0, 0.0, 0.0, 0.0]);
/// assert_eq!(sensor.next_sample()?.unwrap().value.force().z, -2.0);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct DynPickDecoder {
    counts: AxisCounts,
    deframer: Deframer<Reading, { Reading::LENGTH }>,
    tick: Option<u8>,
    missing: u64,
}

impl DynPickDecoder {
    /// For a sensor whose counts are these: its data sheet has them, or
    /// [`Sensitivities`](super::Sensitivities).
    #[must_use]
    pub const fn new(counts: AxisCounts) -> Self {
        Self { counts, deframer: Deframer::new(FORMAT), tick: None, missing: 0 }
    }

    /// Readings that are missing by the digit that counts them. Ten in a row that are missing cannot be
    /// told.
    #[must_use]
    pub const fn missing(&self) -> u64 {
        self.missing
    }
}

impl<T: Real> LineDecoder<T> for DynPickDecoder {
    type Fault = DynPickFault;
    /// Some 18 frames.
    const PATIENCE: usize = 500;

    fn push(&mut self, byte: u8) -> Option<Result<Sample<T, Wrench<T>>, DynPickFault>> {
        let Reading { tick, raw } = self.deframer.push(byte)?;
        if let Some(last) = self.tick.replace(tick) {
            self.missing += u64::from((tick + 19 - last) % 10);
        }
        if let Some(axis) = raw.iter().position(|raw| matches!(*raw, 0 | Reading::GREATEST)) {
            return Some(Err(DynPickFault::Saturated { axis }));
        }
        let counts = raw.map(|raw| i32::from(raw) - i32::from(Reading::ZERO));
        Some(Ok(Sample { time: None, value: self.counts.wrench(counts) }))
    }

    fn restart(&mut self) {
        self.deframer.clear();
    }

    fn statistics(&self) -> LineStatistics {
        self.deframer.statistics()
    }
}
