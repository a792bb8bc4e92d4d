//! Texas Instruments ADS1255 and ADS1256: one converter of 24 bits with very little noise, gains up to 64 and a
//! multiplexer for up to four pairs of pins.
//!
//! Wire: SPI mode 1, most significant bit first, up to a quarter of the clock: 1.92 MHz at 7.68 MHz. `N` is the
//! number of inputs that it goes through; a sample is one cycle.
//!
//! Sections below are those of the ADS1255/6 data sheet (SBAS288, revision K, 2013), by their titles.
//!
//! # Commands (Command Definitions, table 24)
//! | command | bytes | used for |
//! |---|---|---|
//! | WAKEUP | 00 | ends SYNC |
//! | RDATA | 01 | reads the conversion |
//! | SDATAC | 0F | ends continuous reading |
//! | RREG | 10 + address, number − 1 | reads registers |
//! | WREG | 50 + address, number − 1 | writes registers |
//! | SELFCAL | F0 | calibrates its own offset and gain |
//! | SYSOCAL, SYSGCAL | F3, F4 | calibrates with the input as it is |
//! | SYNC | FC | begins a conversion, with WAKEUP |
//! | STANDBY | FD | off until WAKEUP |
//! | RESET | FE | reset |
//!
//! # Registers (Register Map, table 23)
//! | address | register | after reset | used for |
//! |---|---|---|---|
//! | 0 | `STATUS` | x1 | recognition, bit order, calibration, buffer, not ready (bit 0) |
//! | 1 | `MUX` | 01 | positive and negative input |
//! | 2 | `ADCON` | 20 | clock output, test currents, gain |
//! | 3 | `DRATE` | F0 | data rate |
//! | 4 | `IO` | E0 | pins, not used |
//! | 5, 8 | `OFC`, `FSC`, three bytes each | set by calibration | offset and gain |
//!
//! # Times (Timing Characteristics; τ is one clock)
//! | what | least |
//! |---|---|
//! | command until the first bit that it reads (t6) | 50 τ |
//! | after RREG, WREG, RDATA (t11) | 4 τ |
//! | after SYNC (t11) | 24 τ |
//! | after RESET, SELFCAL, SDATAC (t11) | until ready |
//! | settling after SYNC (t18, Settling Time, table 13) | 0.21 ms at 30 kHz … 400.18 ms at 2.5 Hz |
//! | cycling (Settling Time Using the Input Multiplexer, table 14) | 4374 inputs a second at most |
//! | range (Data Format) | ±2 · VREF / gain, ends 7FFFFF and 800000 |
//!
//! Inputs are cycled as the data sheet says: when a conversion is ready the multiplexer is set to the next
//! input, the conversion begun, and only then the finished one is read. So conversions settle in one.
//!
//! # What is noticed, and what cannot be
//! Before every reading `STATUS`, `MUX`, `ADCON` and `DRATE` are read: a device that was reset, a multiplexer
//! that did not obey and a bus that gives only ones or zeros are errors, and "not ready" is waited for. There
//! is no checksum, so each conversion is read twice: if the two differ, the cycle is an error. Not noticed: a
//! SYNC that is damaged on the way, after which the next conversion has begun before the multiplexer was set.
//!
//! # What was confirmed, and what was not
//! Nothing was tried with a chip. Commands, registers, values after reset, settling times, cycling and the data
//! format were read in pages of the data sheet; t6 and t11 could not be looked up again and are as commonly
//! used. That RDATA gives the same conversion twice before the next one is done is an assumption; were it
//! wrong, every cycle would be an error and none a wrong number.

mod driver;
#[cfg(feature = "devices")]
mod figures;
mod wire;

#[cfg(feature = "simulators")]
mod simulator;

pub use crate::converters::Reading;
pub use driver::{Ads1256, AsyncAds1256};
pub use wire::{Calibration, Command, Configuration, Gain, Input, Pin, Rate, Register};

#[cfg(feature = "simulators")]
pub use simulator::SimulatedAds1256;

/// Its entry among the devices.
#[cfg(feature = "devices")]
pub(crate) const DEVICE: crate::devices::Device = crate::devices::Device::converter(
    "ads1256",
    "Texas Instruments ADS1255 and ADS1256",
    crate::devices::Link::Spi,
    &figures::FIGURES,
);
