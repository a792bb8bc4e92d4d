//! From frames on a serial line to wrenches.

use fingertip_wrench::{Real, Wrench};
use thiserror::Error;

use super::wire::{FORMAT, Reading};
use crate::sensors::axis_counts::{AxisCounts, BadAxisCounts};
use crate::sensors::line::{Deframer, LineDecoder, LineStatistics};
use crate::{Sample, SourceError, SourceErrorKind};

/// What the sensor says is wrong with a reading.
///
/// ```
/// use fingertip_drivers::sensors::line::LineSensor;
/// use fingertip_drivers::sensors::robotous::{Reading, RobotousDecoder};
/// use fingertip_drivers::{Source, SourceError, SourceErrorKind};
///
/// let bytes = Reading { overload: 0b100, ..Reading::default() }.emit_serial();
/// let mut sensor = LineSensor::<_, f64, _>::new(&bytes[..], RobotousDecoder::rft60()?);
/// let error = sensor.next_sample().unwrap_err();
/// assert_eq!(error.to_string(), "the sensor is overloaded (overload byte 0x04)");
/// assert_eq!(error.kind(), SourceErrorKind::Overload);
/// # Ok::<(), fingertip_drivers::sensors::BadAxisCounts>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum RobotousFault {
    /// An axis is overloaded.
    #[error("the sensor is overloaded (overload byte {bits:#04x})")]
    Overload {
        /// The overload byte.
        bits: u8,
    },
}

impl SourceError for RobotousFault {
    fn kind(&self) -> SourceErrorKind {
        SourceErrorKind::Overload
    }
}

/// Decodes what the sensor sends. Samples have no time: the sensor sends none, and does not number its
/// readings, so that lost ones cannot be counted from what it sends.
///
/// The checksum is a plain sum: it notices every single damaged byte, but one of 256 frames with
/// several.
///
/// ```
/// use fingertip_drivers::Source;
/// use fingertip_drivers::sensors::line::LineSensor;
/// use fingertip_drivers::sensors::robotous::{Reading, RobotousDecoder};
///
/// // In place of the port: noise and a reading.
/// let reading = Reading { streamed: true, counts: [0, 0, -100, 0, 0, 0], overload: 0 };
/// let bytes = [&[0x55, 3, 7][..], &reading.emit_serial()].concat();
/// let mut sensor = LineSensor::<_, f64, _>::new(&bytes[..], RobotousDecoder::rft60()?);
/// assert!((sensor.next_sample()?.unwrap().value.force().z + 2.0).abs() < 1e-12);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct RobotousDecoder {
    counts: AxisCounts,
    deframer: Deframer<Reading, { Reading::SERIAL_LENGTH }>,
}

impl RobotousDecoder {
    /// For a sensor whose counts are these.
    #[must_use]
    pub const fn new(counts: AxisCounts) -> Self {
        Self { counts, deframer: Deframer::new(FORMAT) }
    }

    /// For a sensor with force divider 50 and torque divider 2000, such as the RFT60.
    ///
    /// # Errors
    /// None; the same form as [`AxisCounts::uniform`].
    pub fn rft60() -> Result<Self, BadAxisCounts> {
        AxisCounts::uniform(50.0, 2000.0).map(Self::new)
    }
}

/// The wrench of a reading, whatever transport it came by.
pub(super) fn wrench<T: Real>(counts: &AxisCounts, reading: &Reading) -> Result<Wrench<T>, RobotousFault> {
    if reading.overload != 0 {
        return Err(RobotousFault::Overload { bits: reading.overload });
    }
    Ok(counts.wrench(reading.counts.map(i32::from)))
}

impl<T: Real> LineDecoder<T> for RobotousDecoder {
    type Fault = RobotousFault;
    /// Some 26 frames.
    const PATIENCE: usize = 500;

    fn push(&mut self, byte: u8) -> Option<Result<Sample<T, Wrench<T>>, RobotousFault>> {
        let reading = self.deframer.push(byte)?;
        Some(wrench(&self.counts, &reading).map(|value| Sample { time: None, value }))
    }

    fn restart(&mut self) {
        self.deframer.clear();
    }

    fn statistics(&self) -> LineStatistics {
        self.deframer.statistics()
    }
}
