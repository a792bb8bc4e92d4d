//! Avia Semiconductor HX711: bridge converters of 24 bits with a gain of 128, 64 or 32, several of which share
//! one clock line, so that all are read in the same 25 to 27 pulses.
//!
//! ```text
//!           ┌──── PD_SCK to all ────┐
//! controller├──── DOUT of chip 0 ───┤ chips
//!           └──── DOUT of chip N−1 ─┘
//! ```
//!
//! Sections below are those of the HX711 data sheet, by their titles. There are no registers.
//!
//! | what | figure | section |
//! |---|---|---|
//! | DOUT low: a conversion is there; high: none | | Serial Interface |
//! | 25 pulses: next conversion is input A at gain 128; 26: input B at 32; 27: input A at 64 | | Serial Interface, table 3 |
//! | after a reset: input A at 128 | | Reset and Power-Down |
//! | DOUT is high after the 25th pulse | | Serial Interface |
//! | DOUT low until the first pulse (T1) | 0.1 µs or more | figure 2 |
//! | pulse high until the bit is there (T2) | 0.1 µs or less | figure 2 |
//! | pulse high (T3) | 0.2 to 50 µs, 1 µs typical | figure 2 |
//! | pulse low (T4) | 0.2 µs or more | figure 2 |
//! | clock high until power-down | 60 µs | Reset and Power-Down |
//! | rate | 10 or 80 Hz by the pin RATE | Output Data Rate and Format |
//! | settling after power-up, or another gain or input | 400 ms at 10 Hz, 50 ms at 80 Hz: four conversions | Key Electrical Characteristics |
//! | range | ±0.5 · AVDD / gain, two's complement, ends 800000 and 7FFFFF | Analog Inputs; Output Data Rate and Format |
//!
//! AVDD is the excitation as a rule: use [`Excitation::Reference`](crate::bridge::Excitation::Reference) with a
//! full scale of [`Mode::full_scale`].
//!
//! # What is noticed, and what cannot be
//! A chip that never becomes ready (no power, wire off) is a time-out. DOUT that is low after the last
//! pulse is [`ConverterFault::Stuck`](crate::converters::ConverterFault::Stuck). Ends of the range are
//! told. There is no checksum: a bit that is flipped on the wire is not noticed.
//!
//! **A pulse that is high for more than 60 µs resets the chips in the midst of a reading.** The remaining bits are
//! ones, which looks like a number. Nothing on the wires tells. Where interrupts can take as long, read
//! within a critical section: a reading takes some 60 µs.
//!
//! The task's face awaits the pins, but makes the pulses without pausing, for the same reason.
//!
//! # What was confirmed, and what was not
//! Nothing was tried with a chip. All figures were read in pages of the data sheet. What a chip does with a
//! conversion that ends while it is read is not in there.

mod driver;
#[cfg(feature = "devices")]
mod figures;
mod wire;

#[cfg(feature = "simulators")]
mod simulator;

pub use driver::{AsyncHx711, Hx711};
pub use wire::{Mode, Shift};

#[cfg(feature = "simulators")]
pub use simulator::{SimulatedClock, SimulatedHx711s};

/// Its entry among the devices.
#[cfg(feature = "devices")]
pub(crate) const DEVICE: crate::devices::Device =
    crate::devices::Device::converter("hx711", "Avia HX711", crate::devices::Link::Pins, &figures::FIGURES);
