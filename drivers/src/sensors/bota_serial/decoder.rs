//! From frames to wrenches.

use fingertip_wrench::{Real, Wrench};
use thiserror::Error;

use super::wire::{FORMAT, Frame};
use crate::sensors::line::{Deframer, LineDecoder, LineStatistics, finite_wrench};
use crate::{Sample, SourceError, SourceErrorKind};

/// What the sensor says is wrong with a sample.
///
/// ```
/// use fingertip_drivers::sensors::bota_serial::{BotaDecoder, Frame};
/// use fingertip_drivers::sensors::line::LineSensor;
/// use fingertip_drivers::{Source, SourceError, SourceErrorKind};
///
/// let bytes = Frame { status: Frame::OVERRANGE, microseconds: 1250, ..Frame::default() }.emit();
/// let mut sensor = LineSensor::<_, f64, _>::new(&bytes[..], BotaDecoder::new());
/// let error = sensor.next_sample().unwrap_err();
/// assert_eq!(error.to_string(), "the sensor is overloaded at its time 1250 µs");
/// assert_eq!(error.kind(), SourceErrorKind::Overload);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum BotaFault {
    /// The load is beyond what a gauge can measure.
    #[error("the sensor is overloaded at its time {microseconds} µs")]
    Overrange {
        /// Time on the sensor's clock \[µs\].
        microseconds: u32,
    },
    /// The sensor says that its numbers are invalid, or one is not finite, or beyond what any sensor measures.
    #[error("the sensor gives no valid numbers at its time {microseconds} µs (status {status:#06x})")]
    Invalid {
        /// Time on the sensor's clock \[µs\].
        microseconds: u32,
        /// The status bits.
        status: u16,
    },
}

impl SourceError for BotaFault {
    fn kind(&self) -> SourceErrorKind {
        match self {
            Self::Overrange { .. } => SourceErrorKind::Overload,
            Self::Invalid { .. } => SourceErrorKind::DeviceFault,
        }
    }
}

/// Decodes what the sensor sends. Time counts from the first frame on the sensor's own clock,
/// unwrapped. A sensor that is overloaded or whose numbers are invalid is an error for each such
/// sample.
///
/// A frame whose time is not after that of the newest one is a repetition or comes late: it is counted and not
/// given. If [`RESTARTED`](Self::RESTARTED) of them in a row follow on each other, the sensor has been switched
/// off and on, and time goes on from there.
///
/// ```
/// use fingertip_drivers::Source;
/// use fingertip_drivers::sensors::bota_serial::{BotaDecoder, Frame};
/// use fingertip_drivers::sensors::line::LineSensor;
///
/// // In place of the port: two frames, and bytes between them that mean nothing.
/// let frame = |microseconds, fz| Frame {
///     microseconds,
///     components: [0.0, 0.0, fz, 0.0, 0.0, 0.0],
///     ..Frame::default()
/// };
/// let bytes = [&frame(1000, -2.0).emit()[..], &[0xAA, 7, 7], &frame(2000, -3.0).emit()].concat();
/// let mut sensor = LineSensor::<_, f64, _>::new(&bytes[..], BotaDecoder::new());
/// let first = sensor.next_sample()?.unwrap();
/// let second = sensor.next_sample()?.unwrap();
/// assert_eq!((first.time, first.value.force().z), (Some(0.0), -2.0));
/// assert_eq!((second.time, second.value.force().z), (Some(0.001), -3.0));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct BotaDecoder {
    deframer: Deframer<Frame, { Frame::LENGTH }>,
    last_microseconds: Option<u32>,
    elapsed: u64,
    /// Time of the last frame that was not news, and how many of them follow on each other.
    behind: (u32, u32),
    not_news: u64,
    restarts: u64,
}

impl Default for BotaDecoder {
    fn default() -> Self {
        Self::new()
    }
}

impl BotaDecoder {
    /// Nothing seen yet.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            deframer: Deframer::new(FORMAT),
            last_microseconds: None,
            elapsed: 0,
            behind: (0, 0),
            not_news: 0,
            restarts: 0,
        }
    }

    /// How many frames in a row that are not news, but follow on each other, mean that the sensor's clock has
    /// begun anew.
    pub const RESTARTED: u32 = 16;

    /// Frames that were sound and not given, since they were repeated or late.
    #[must_use]
    pub const fn not_news(&self) -> u64 {
        self.not_news
    }

    /// How often the sensor's clock began anew.
    #[must_use]
    pub const fn restarts(&self) -> u64 {
        self.restarts
    }

    /// Microseconds since the first frame, over the wrap-around of the sensor's clock; `None` for a frame that
    /// is not after the newest one.
    fn unwrap_time(&mut self, microseconds: u32) -> Option<u64> {
        const HALF: u32 = 1 << 31;
        let Some(last) = self.last_microseconds else {
            self.last_microseconds = Some(microseconds);
            return Some(0);
        };
        let ahead = microseconds.wrapping_sub(last);
        if ahead != 0 && ahead < HALF {
            self.last_microseconds = Some(microseconds);
            self.elapsed += u64::from(ahead);
            self.behind.1 = 0;
            return Some(self.elapsed);
        }
        self.not_news += 1;
        let (before, run) = self.behind;
        let step = microseconds.wrapping_sub(before);
        // Not more than a second apart.
        let follows = step != 0 && step < 1_000_000;
        self.behind = (microseconds, if follows { run + 1 } else { 1 });
        if self.behind.1 < Self::RESTARTED {
            return None;
        }
        self.last_microseconds = Some(microseconds);
        self.elapsed += u64::from(step);
        self.behind.1 = 0;
        self.restarts += 1;
        Some(self.elapsed)
    }
}

/// Beyond every sensor of the maker, by far \[N\], \[N·m\]: bytes that are no frame, and pass for one by chance.
const GREATEST: [f64; 2] = [1e5, 1e4];

fn is_plausible<T: Real>(wrench: &Wrench<T>) -> bool {
    let [force, torque] = GREATEST.map(T::literal);
    wrench.force().iter().all(|component| component.abs() <= force)
        && wrench.torque().iter().all(|component| component.abs() <= torque)
}

impl<T: Real> LineDecoder<T> for BotaDecoder {
    type Fault = BotaFault;
    /// Some 27 frames, or 20 ms of a full line.
    const PATIENCE: usize = 1000;

    fn push(&mut self, byte: u8) -> Option<Result<Sample<T, Wrench<T>>, BotaFault>> {
        let Frame { status, components, microseconds, .. } = self.deframer.push(byte)?;
        let elapsed = self.unwrap_time(microseconds)?;
        if status & Frame::OVERRANGE != 0 {
            return Some(Err(BotaFault::Overrange { microseconds }));
        }
        let wrench = finite_wrench(components.map(f64::from));
        let is_valid = |wrench: &Wrench<T>| status & Frame::INVALID == 0 && is_plausible(wrench);
        Some(match wrench.filter(is_valid) {
            Some(value) => {
                #[allow(clippy::cast_precision_loss, reason = "exact for 285 years")]
                let time = T::literal(elapsed as f64 * 1e-6);
                Ok(Sample { time: Some(time), value })
            }
            None => Err(BotaFault::Invalid { microseconds, status }),
        })
    }

    fn restart(&mut self) {
        self.deframer.clear();
    }

    fn statistics(&self) -> LineStatistics {
        self.deframer.statistics()
    }
}
