//! From frames to wrenches.

use fingertip_wrench::{Real, Wrench};
use thiserror::Error;

use super::wire::{FORMAT, Reading};
use crate::sensors::axis_counts::AxisCounts;
use crate::sensors::line::{Deframer, LineDecoder, LineStatistics};
use crate::{Sample, SourceError, SourceErrorKind};

/// What the sensor says is wrong with a reading.
///
/// ```
/// use fingertip_drivers::sensors::AxisCounts;
/// use fingertip_drivers::sensors::line::LineSensor;
/// use fingertip_drivers::sensors::optoforce::{OptoForceDecoder, Reading};
/// use fingertip_drivers::{Source, SourceError, SourceErrorKind};
///
/// let bytes = Reading { status: 1 << 9, ..Reading::default() }.emit();
/// let decoder = OptoForceDecoder::new(AxisCounts::uniform(80.0, 1800.0)?);
/// let error = LineSensor::<_, f64, _>::new(&bytes[..], decoder).next_sample().unwrap_err();
/// assert_eq!(error.to_string(), "the sensor is overloaded (status 0x0200: Fx at bit 9 to Tz at bit 4)");
/// assert_eq!(error.kind(), SourceErrorKind::Overload);
/// # Ok::<(), fingertip_drivers::sensors::BadAxisCounts>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum OptoForceFault {
    /// Axes are overloaded.
    #[error("the sensor is overloaded (status {status:#06x}: Fx at bit 9 to Tz at bit 4)")]
    Overload {
        /// The status word.
        status: u16,
    },
    /// The electronics or the sensor report an error.
    #[error("the sensor reports a fault (status {status:#06x})")]
    Fault {
        /// The status word.
        status: u16,
    },
}

impl SourceError for OptoForceFault {
    fn kind(&self) -> SourceErrorKind {
        match self {
            Self::Overload { .. } => SourceErrorKind::Overload,
            Self::Fault { .. } => SourceErrorKind::DeviceFault,
        }
    }
}

/// Decodes what the sensor sends. Samples have no time: the sensor numbers them, but at a rate that
/// it does not say.
///
/// ```
/// use fingertip_drivers::Source;
/// use fingertip_drivers::sensors::AxisCounts;
/// use fingertip_drivers::sensors::line::LineSensor;
/// use fingertip_drivers::sensors::optoforce::{OptoForceDecoder, Reading};
///
/// // In place of the port: readings 7 and 10.
/// let reading = |count| Reading { count, status: 0, counts: [0, 0, -160, 0, 0, 0] };
/// let bytes = [reading(7).emit(), reading(10).emit()].concat();
/// let decoder = OptoForceDecoder::new(AxisCounts::uniform(80.0, 1800.0)?);
/// let mut sensor = LineSensor::<_, f64, _>::new(&bytes[..], decoder);
/// while let Some(sample) = sensor.next_sample()? {
///     assert!((sample.value.force().z + 2.0).abs() < 1e-12);
/// }
/// assert_eq!(sensor.decoder().missing(), 2);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct OptoForceDecoder {
    counts: AxisCounts,
    deframer: Deframer<Reading, { Reading::LENGTH }>,
    last: Option<u16>,
    missing: u64,
}

impl OptoForceDecoder {
    /// For a sensor whose counts are these.
    #[must_use]
    pub const fn new(counts: AxisCounts) -> Self {
        Self { counts, deframer: Deframer::new(FORMAT), last: None, missing: 0 }
    }

    /// Readings that are missing by their numbers.
    #[must_use]
    pub const fn missing(&self) -> u64 {
        self.missing
    }
}

impl<T: Real> LineDecoder<T> for OptoForceDecoder {
    type Fault = OptoForceFault;
    /// Some 22 frames.
    const PATIENCE: usize = 500;

    fn push(&mut self, byte: u8) -> Option<Result<Sample<T, Wrench<T>>, OptoForceFault>> {
        let Reading { count, status, counts } = self.deframer.push(byte)?;
        if let Some(last) = self.last.replace(count) {
            self.missing += u64::from(count.wrapping_sub(last).wrapping_sub(1));
        }
        Some(match status {
            0 => Ok(Sample { time: None, value: self.counts.wrench(counts.map(i32::from)) }),
            _ if status & !Reading::OVERLOAD == 0 => Err(OptoForceFault::Overload { status }),
            _ => Err(OptoForceFault::Fault { status }),
        })
    }

    fn restart(&mut self) {
        self.deframer.clear();
    }

    fn statistics(&self) -> LineStatistics {
        self.deframer.statistics()
    }
}
