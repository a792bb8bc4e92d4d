//! Texas Instruments ADS131M02, M03, M04, M06 and M08: two to eight converters of 24 bits that sample at
//! the same moment. The M08 is the natural chip for a fingertip: six gauges, the excitation and a
//! dummy gauge in one frame.
//!
//! `N` is the number of channels of the chip. Wire: SPI mode 1, most significant bit first, up to 25 MHz.
//!
//! Sections below are those of the ADS131M08 data sheet (SBAS950, revision B, 2021), by their titles,
//! since the numbers differ between the chips.
//!
//! # The frame (Programming: SPI Communication Frames, Words; Communication CRC)
//! ```text
//! in:   command │ CRC │ 0 …                           a register's value stands before the CRC
//! out:  answer to the last command │ channel 0 … N−1 │ CRC
//! ```
//! Words of 24 bits; commands, registers and checksums stand in the upper 16. The CRC is CCITT with
//! seed 0xFFFF over all words before it. The CRC of commands is always sent; the device checks it once
//! it is configured (`RX_CRC_EN`).
//!
//! # Commands (Programming: Commands)
//! | command | word | answer in the next frame |
//! |---|---|---|
//! | NULL | 0000 | `STATUS` |
//! | RESET | 0011 | FF20 + number of channels |
//! | STANDBY, WAKEUP | 0022, 0033 | the same word |
//! | LOCK, UNLOCK | 0555, 0655 | the same word |
//! | RREG | 101a aaaa a000 0000 | the register |
//! | WREG | 011a aaaa a000 0000 | 010a aaaa a000 0000 |
//!
//! # Registers (Register Map)
//! | address | register | after reset | used for |
//! |---|---|---|---|
//! | 00 | `ID` | 2N00 and the revision | number of channels |
//! | 01 | `STATUS` | 0500 | lock, resynchronised, register CRC, command CRC, reset, word length, data ready |
//! | 02 | `MODE` | 0510 | CRCs on, reset flag, word length, time-out, ready pin |
//! | 03 | `CLOCK` | channels on, then 0E | channels, crystal, reference, OSR, power |
//! | 04, 05 | `GAIN1`, `GAIN2` | 0000 | gains; 05 not on chips of up to four channels |
//! | 06 | `CFG` | 0600 | chopping |
//! | 09 + 5n | `CHn_CFG` | 0000 | input, phase |
//! | 0A + 5n … | `CHn_OCAL` (two registers) | 000000 | offset in counts |
//! | 0C + 5n … | `CHn_GCAL` (two registers) | 800000 | gain, 800000 being 1 |
//! | 3E | `REGMAP_CRC` | 0000 | CRC of the registers |
//!
//! Not used: current detection (`THRSHLD`), the DC block filter, words of 16 and 32 bits, the turbo mode
//! of the smaller chips.
//!
//! # Times (Timing Requirements, Switching Characteristics; Device Functional Modes: Reset)
//! | what | how long |
//! |---|---|
//! | after a reset until registers can be reached (t_REGACQ) | 5 µs |
//! | after power-up until then (t_POR) | 250 µs |
//! | SYNC/RESET low to synchronise | 1 to 2047 clocks |
//! | SYNC/RESET low to reset | 2048 clocks or more |
//! | data rate | clock / 2, 4 or 8 (power mode) / OSR: 4000 Hz at 8.192 MHz after reset |
//! | register CRC, once through | one bit a clock: 125 µs at 8.192 MHz |
//!
//! # What is noticed
//! Damaged answers (CRC), damaged commands (`CRC_ERR`; counted), a device that was reset
//! (`RESET`), registers that change (`REG_MAP`, if asked for), data that was read before (`DRDY` bits),
//! stuck lines (the CRC of words of ones or zeros does not fit, or no new data comes in time).
//!
//! The device holds two conversions. After a pause the older one would come first, so two frames are
//! thrown away after configuration, synchronisation and a time-out (Collecting Data for the First Time or
//! After a Pause in Data Collection). Call `restart` after a pause of your own.
//!
//! # What was confirmed, and what was not
//! Nothing was tried with a chip. Commands, register addresses and fields, values after reset, the range with an
//! external reference, t_REGACQ and the pulse of a reset agree with TI's published header and with the Linux
//! kernel's driver; the CRC with a frame that a user read from an ADS131M04. t_POR, and that `REG_MAP` is taken
//! down by reading `STATUS`, are from the data sheet alone.

mod configuration;
mod driver;
#[cfg(feature = "devices")]
mod figures;
mod state;
mod wire;

#[cfg(feature = "simulators")]
mod simulator;

pub use configuration::{ChannelSetup, Configuration, Gain, Input, Oversampling, Power};
pub use driver::{Ads131m, AsyncAds131m};
pub use wire::{Answer, Register, Request, Status};

#[cfg(feature = "simulators")]
pub use simulator::SimulatedAds131m;

/// Its entry among the devices.
#[cfg(feature = "devices")]
pub(crate) const DEVICE: crate::devices::Device = crate::devices::Device::converter(
    "ads131m",
    "Texas Instruments ADS131M02 to ADS131M08",
    crate::devices::Link::Spi,
    &figures::FIGURES,
);
