//! What can be wrong with a sensor on a line.

use core::fmt::{Debug, Display};

use thiserror::Error;

use crate::{SourceError, SourceErrorKind};

/// Why a sensor on a line has no wrench to give. `E` is the error of the transport, `F` the fault
/// that the device reports.
///
/// ```
/// use fingertip_drivers::sensors::bota_serial::BotaDecoder;
/// use fingertip_drivers::sensors::line::LineSensor;
/// use fingertip_drivers::{Source, SourceError, SourceErrorKind};
///
/// // Bytes come, as from a port at a wrong baud rate, and none is a frame.
/// let mut sensor = LineSensor::<_, f64, _>::new(std::io::repeat(0xF8), BotaDecoder::new());
/// let error = sensor.next_sample().unwrap_err();
/// assert!(error.to_string().ends_with("is this the sensor, and the line at its baud rate?"));
/// assert_eq!(error.kind(), SourceErrorKind::Corrupt);
/// ```
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum LineError<E, F> {
    /// The line failed.
    #[error("serial line: {0}")]
    Line(#[source] E),
    /// No byte came in time.
    #[error("no byte came in time; is the sensor on, streaming, and the line at its baud rate?")]
    Timeout,
    /// Bytes come, but no frame among many of them.
    #[error("no frame among {bytes} bytes; is this the sensor, and the line at its baud rate?")]
    NoFrame {
        /// How many bytes were searched.
        bytes: usize,
    },
    /// The device says that something is wrong.
    #[error(transparent)]
    Device(F),
}

impl<E: Debug, F: SourceError + Display> SourceError for LineError<E, F> {
    fn kind(&self) -> SourceErrorKind {
        match self {
            Self::Line(_) => SourceErrorKind::Transport,
            Self::Timeout => SourceErrorKind::Timeout,
            Self::NoFrame { .. } => SourceErrorKind::Corrupt,
            Self::Device(fault) => fault.kind(),
        }
    }
}
