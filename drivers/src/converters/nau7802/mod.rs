//! Nuvoton NAU7802: a bridge converter of 24 bits on I²C (address 0x2A, up to 400 kHz) with gains up to 128,
//! a regulator for the bridge and two inputs of which one is converted at a time.
//!
//! Sections below are those of the NAU7802 data sheet, revision 1.7.
//!
//! # Registers (10 Summary Device Register Map; 11 Device Register Map Details)
//! | address | register | after reset | used for |
//! |---|---|---|---|
//! | 00 | `PU_CTRL` | 00 | reset, power, oscillator, regulator, start; powered and conversion-ready flags |
//! | 01 | `CTRL1` | 00 | polarity of the pin DRDY, regulator voltage, gain |
//! | 02 | `CTRL2` | 00 | input, rate, calibration and its error |
//! | 03, 0A | `OCAL1`, `OCAL2`, three bytes | 000000 | offset of inputs 1 and 2 |
//! | 06, 0D | `GCAL1`, `GCAL2`, four bytes | 00800000 | gain of inputs 1 and 2, 00800000 being 1 |
//! | 12 | `ADCO`, three bytes | 000000 | the conversion, two's complement |
//! | 15 | `ADC` | 00 | chopper clock: 30 switches it off |
//! | 1B | `PGA` | 00 | amplifier bypassed |
//! | 1C | `POWER` | 00 | bit 7: a capacitor stands across input 2 |
//! | 1F | revision | low half F | recognition |
//!
//! # Times and ranges
//! | what | figure | section |
//! |---|---|---|
//! | from power-up of the digital part until the powered flag | about 200 µs | 9 Application Information, power-up sequencing |
//! | rates | 10, 20, 40, 80, 320 Hz | 11, `CTRL2` |
//! | range | ±0.5 · VREF / gain | 7.2 DC Electrical Characteristics |
//! | result | gain calibration · (measurement − offset calibration) | 8.6 Calibration |
//! | calibration error | `CAL_ERR` stays up until a reset or a calibration that succeeds | 8.6.3 Calibration Error |
//!
//! REFP is the excitation as a rule: use [`Excitation::Reference`](crate::bridge::Excitation::Reference) with a
//! full scale of [`Gain::full_scale`].
//!
//! After a start, a calibration and a change of input four conversions are thrown away, the length of the
//! converter's filter to be safe; the regulator is given 250 ms. Both are choices made here.
//!
//! # What is noticed, and what cannot be
//! Every sample is read together with `PU_CTRL`, so that a device that was reset, or a bus that gives only
//! ones or zeros, is an error. A conversion is given once: the ready flag says whether it is new. I²C has no
//! checksum: a bit that is flipped in a number is not noticed.
//!
//! # What was confirmed, and what was not
//! Nothing was tried with a chip. Addresses, fields and values after reset agree with published drivers, the
//! calibration with a page of the data sheet. The 200 µs, and 30 in `ADC`, are as commonly used.

mod driver;
#[cfg(feature = "devices")]
mod figures;
mod wire;

#[cfg(feature = "simulators")]
mod simulator;

pub use crate::converters::Reading;
pub use driver::{AsyncNau7802, Nau7802};
pub use wire::{ADDRESS, Calibration, Configuration, Control, Gain, Input, Rate, Register, Regulator};

#[cfg(feature = "simulators")]
pub use simulator::{SimulatedI2c, SimulatedNau7802};

/// Its entry among the devices.
#[cfg(feature = "devices")]
pub(crate) const DEVICE: crate::devices::Device = crate::devices::Device::converter(
    "nau7802",
    "Nuvoton NAU7802",
    crate::devices::Link::I2c,
    &figures::FIGURES,
);
