//! Wrenches from a serial line.

use std::io::{self, Read};

use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;
use thiserror::Error;

use super::deframer::Deframer;
use super::wire::Frame;
use crate::{ErrorType, Sample, SourceError, SourceErrorKind, WrenchSource};

/// Why the sensor has no wrench to give.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum BotaError {
    /// The line failed.
    #[error("serial line: {0}")]
    Line(io::Error),
    /// No byte came in time.
    #[error("no byte came in time; is the sensor on, streaming, and the line at its baud rate?")]
    Timeout,
    /// Bytes come, but no frame among many of them.
    #[error("no frame among {bytes} bytes; is the line at the sensor's baud rate (460800 as delivered)?")]
    NoFrame {
        /// How many bytes were searched.
        bytes: usize,
    },
    /// The load is beyond what a gauge can measure.
    #[error("the sensor is overloaded at its time {microseconds} µs")]
    Overrange {
        /// Time on the sensor's clock \[µs\].
        microseconds: u32,
    },
    /// The sensor says that its numbers are invalid, or one is not finite.
    #[error("the sensor gives no valid numbers at its time {microseconds} µs (status {status:#06x})")]
    Invalid {
        /// Time on the sensor's clock \[µs\].
        microseconds: u32,
        /// The status bits.
        status: u16,
    },
}

impl SourceError for BotaError {
    fn kind(&self) -> SourceErrorKind {
        match self {
            Self::Line(_) => SourceErrorKind::Transport,
            Self::Timeout => SourceErrorKind::Timeout,
            Self::NoFrame { .. } => SourceErrorKind::Corrupt,
            Self::Overrange { .. } => SourceErrorKind::Overload,
            Self::Invalid { .. } => SourceErrorKind::DeviceFault,
        }
    }
}

/// A sensor on a line that can be read. The time of its samples is that of its own clock, unwrapped.
#[derive(Debug)]
pub struct BotaSensor<R> {
    line: R,
    deframer: Deframer,
    buffer: [u8; 256],
    length: usize,
    next: usize,
    last_microseconds: Option<u32>,
    elapsed: u64,
}

impl<R: Read> BotaSensor<R> {
    /// How many bytes may pass without a frame: some 27 frames, or 60 ms of a full line.
    const PATIENCE: usize = 1000;

    /// On an open line. Set its read timeout to some periods of the sensor.
    #[must_use]
    pub const fn new(line: R) -> Self {
        Self {
            line,
            deframer: Deframer::new(),
            buffer: [0; 256],
            length: 0,
            next: 0,
            last_microseconds: None,
            elapsed: 0,
        }
    }

    /// What was found on the line so far.
    #[must_use]
    pub const fn deframer(&self) -> &Deframer {
        &self.deframer
    }

    /// The next frame whose checksum fits, whatever its status; `None` at the end of the line (a
    /// file, or a port that was closed).
    ///
    /// # Errors
    /// [`BotaError::Line`], [`BotaError::Timeout`] or [`BotaError::NoFrame`].
    pub fn next_frame(&mut self) -> Result<Option<Frame>, BotaError> {
        for _ in 0..Self::PATIENCE {
            if self.next >= self.length {
                (self.next, self.length) = (0, 0);
                self.length = loop {
                    match self.line.read(&mut self.buffer) {
                        Ok(0) => return Ok(None),
                        Ok(length) => break length,
                        Err(error) => match error.kind() {
                            io::ErrorKind::Interrupted => {}
                            io::ErrorKind::TimedOut | io::ErrorKind::WouldBlock => {
                                return Err(BotaError::Timeout);
                            }
                            _ => return Err(BotaError::Line(error)),
                        },
                    }
                };
            }
            let byte = self.buffer.get(self.next).copied().unwrap_or_default();
            self.next += 1;
            if let Some(frame) = self.deframer.push(byte) {
                return Ok(Some(frame));
            }
        }
        Err(BotaError::NoFrame { bytes: Self::PATIENCE })
    }

    /// Microseconds since the first frame, over the wrap-around of the sensor's clock.
    fn unwrap_time(&mut self, microseconds: u32) -> u64 {
        if let Some(last) = self.last_microseconds.replace(microseconds) {
            self.elapsed += u64::from(microseconds.wrapping_sub(last));
        }
        self.elapsed
    }
}

impl<R> ErrorType for BotaSensor<R> {
    type Error = BotaError;
}

impl<R: Read, T: Real> WrenchSource<T> for BotaSensor<R> {
    /// Time counts from the first frame. A sensor that is overloaded or whose numbers are invalid
    /// is an error for each such sample.
    fn next_wrench(&mut self) -> Result<Option<Sample<T, Wrench<T>>>, BotaError> {
        let Some(frame) = self.next_frame()? else { return Ok(None) };
        let Frame { status, components, microseconds, .. } = frame;
        let elapsed = self.unwrap_time(microseconds);
        if status & Frame::OVERRANGE != 0 {
            return Err(BotaError::Overrange { microseconds });
        }
        if status & Frame::INVALID != 0 || !components.iter().all(|component| component.is_finite()) {
            return Err(BotaError::Invalid { microseconds, status });
        }
        let [fx, fy, fz, tx, ty, tz] = components.map(|component| T::literal(f64::from(component)));
        let value = Wrench::on_fingertip(Vector3::new(fx, fy, fz), Vector3::new(tx, ty, tz));
        #[allow(clippy::cast_precision_loss, reason = "exact for 285 years")]
        let time = T::literal(elapsed as f64 * 1e-6);
        Ok(Some(Sample { time: Some(time), value }))
    }
}
