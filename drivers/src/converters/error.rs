//! What can be wrong with a converter.

use core::fmt::Debug;

use thiserror::Error;

use crate::{SourceError, SourceErrorKind};

/// What can be wrong with what a converter answers, without regard to how it is wired.
///
/// ```
/// use fingertip_drivers::converters::ConverterFault;
/// use fingertip_drivers::{SourceError, SourceErrorKind};
///
/// let fault = ConverterFault::Register { address: 0x04, expected: 0x55, found: 0xFF };
/// assert_eq!(fault.to_string(), "register 0x04 holds 0xff where 0x55 was written");
/// assert_eq!(fault.kind(), SourceErrorKind::Corrupt);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum ConverterFault {
    /// The checksum of an answer does not fit.
    #[error("an answer has the checksum {found:#06x} where its bytes give {expected:#06x}")]
    Checksum {
        /// Of the bytes.
        expected: u16,
        /// In the answer.
        found: u16,
    },
    /// An answer is not of the form that it must have.
    #[error(
        "the converter answers {found:#010x} where {expected:#010x} is due; is it this chip, wired and powered?"
    )]
    Answer {
        /// What must come.
        expected: u32,
        /// What came.
        found: u32,
    },
    /// A register does not hold what was written to it.
    #[error("register {address:#04x} holds {found:#x} where {expected:#x} was written")]
    Register {
        /// The register.
        address: u8,
        /// What was written.
        expected: u32,
        /// What it holds.
        found: u32,
    },
    /// The device says that what it was sent was damaged; it did not obey.
    #[error("the converter says that what it was sent was damaged on the way")]
    Rejected,
    /// The device has reset itself, or its registers have changed: it must be configured anew.
    #[error("the converter has lost its configuration; configure it anew")]
    Reset,
    /// It was not configured.
    #[error("the converter was not configured")]
    NotConfigured,
    /// It did not become ready in time.
    #[error("the converter did not become ready in time; is its clock running, and the pin wired?")]
    Timeout,
    /// A line does not move when it must.
    #[error("the data line of channel {channel} is stuck")]
    Stuck {
        /// The channel.
        channel: usize,
    },
    /// A channel is at an end of the range.
    #[error("channel {channel} is at an end of the converter's range")]
    Saturated {
        /// The channel.
        channel: usize,
    },
    /// Calibration failed, by what the device says.
    #[error("the converter could not calibrate itself; is the input within its range?")]
    Calibration,
}

impl SourceError for ConverterFault {
    fn kind(&self) -> SourceErrorKind {
        match self {
            Self::Checksum { .. } | Self::Answer { .. } | Self::Register { .. } | Self::Rejected => {
                SourceErrorKind::Corrupt
            }
            Self::Reset | Self::Calibration => SourceErrorKind::DeviceFault,
            Self::NotConfigured => SourceErrorKind::Unsupported,
            Self::Timeout => SourceErrorKind::Timeout,
            Self::Stuck { .. } => SourceErrorKind::Transport,
            Self::Saturated { .. } => SourceErrorKind::Overload,
        }
    }
}

/// Why a converter has no sample to give. `B` is the error of the bus, `P` that of the pin.
///
/// What bus and pin say is shown in their `Debug` form: `embedded-hal` asks for no other, and the words that it has for kinds of
/// errors are those of SPI, I²C and pins apart, while a converter of this crate may hang on any of them.
///
/// ```
/// use fingertip_drivers::converters::ads131m::{Ads131m, Configuration, SimulatedAds131m};
/// use fingertip_drivers::converters::{Level, Patience, SimulatedBench, WireFaults};
///
/// // The pin "ready" has come off.
/// let off = WireFaults { stuck_ready: Some(Level::High), ..WireFaults::default() };
/// let bench = SimulatedBench::new(SimulatedAds131m::new(|_| [0.001; 4]), off);
/// let mut converter = Ads131m::new(bench.spi(), bench.ready(), bench.delay(), Patience::default());
/// converter.configure(&Configuration::<4>::default())?;
/// let told = "the converter did not become ready in time; is its clock running, and the pin wired?";
/// assert_eq!(converter.read().unwrap_err().to_string(), told);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum ConverterError<B, P> {
    /// The bus failed.
    #[error("the bus to the converter failed; its driver says {0:?}")]
    Bus(B),
    /// A pin failed.
    #[error("a pin of the converter failed; its driver says {0:?}")]
    Pin(P),
    /// The converter failed.
    #[error(transparent)]
    Fault(#[from] ConverterFault),
}

impl<B: Debug, P: Debug> SourceError for ConverterError<B, P> {
    fn kind(&self) -> SourceErrorKind {
        match self {
            Self::Bus(_) | Self::Pin(_) => SourceErrorKind::Transport,
            Self::Fault(fault) => fault.kind(),
        }
    }
}
