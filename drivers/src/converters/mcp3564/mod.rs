//! Microchip MCP3561, MCP3562 and MCP3564 (and the R types with a reference inside): a converter of 24 bits
//! with gains from 1/3 to 64 that goes through a list of up to sixteen inputs by itself.
//!
//! Wire: SPI modes 0 and 3, most significant bit first, up to 20 MHz. `N` is the number of inputs in the
//! list; a sample is one cycle through it.
//!
//! Sections below are those of the MCP3561/2/4 data sheet (DS20006181), by their titles.
//!
//! # Commands (SPI Serial Interface: Command Byte Structure, Fast Commands Description, Status Byte)
//! ```text
//! in:   device address (2 bits) │ register or fast command (4) │ kind (2) │ 0 …
//! out:  status ─────────────────────────────────────────────────│ data │ CRC
//! ```
//! Kinds: 00 fast command, 01 read one register, 10 write from a register on, 11 read from a register on. Fast
//! commands: 1010 start, 1011 standby, 1100 converter off, 1101 all off, 1110 reset. The device
//! address is 01 unless ordered otherwise. Status: 0 0 a1 a0 !a0, then low for: new data, registers
//! damaged, supply was off.
//!
//! # Reading with CRC (SPI Serial Interface: Securing Read Communications Through CRC-16 Checksum)
//! Polynomial 0x8005, seed 0, over status and data. This was checked against readings of a real chip
//! that a user has published.
//!
//! # Registers (Internal Registers)
//! | address | register | bits | after reset | used for |
//! |---|---|---|---|---|
//! | 0 | `ADCDATA` | 32 | 0 | channel and conversion (`DATA_FORMAT` 11) |
//! | 1 | `CONFIG0` | 8 | C0 | reference (R), clock, test currents, on |
//! | 2 | `CONFIG1` | 8 | 0C | prescaler, OSR (256) |
//! | 3 | `CONFIG2` | 8 | 8B | current, gain (1), chopping of the inputs |
//! | 4 | `CONFIG3` | 8 | 00 | continuous, data format, CRC on, calibration on |
//! | 5 | `IRQ` | 8 | 73 | pin low when ready and high otherwise, fast commands on, start pulse off |
//! | 6 | `MUX` | 8 | 01 | not used: the list takes its place |
//! | 7 | `SCAN` | 24 | 000000 | delay between inputs, list of inputs |
//! | 8 | `TIMER` | 24 | 000000 | delay between cycles |
//! | 9 | `OFFSETCAL` | 24 | 000000 | taken off |
//! | A | `GAINCAL` | 24 | 800000 | multiplied with, 800000 being 1 |
//! | D | `LOCK` | 8 | A5 | anything but A5 locks the registers |
//! | F | `CRCCFG` | 16 | 0000 | CRC of the registers while they are locked |
//!
//! # Times and ranges
//! | what | figure | section |
//! |---|---|---|
//! | data rate of one input | MCLK / (4 · prescaler · OSR) | ADC conversion and data rate; Digital Decimation Filter |
//! | range | ±VREF / gain, 2²³ counts; beyond it the format goes on, the converter need not | ADC Output Data Format |
//! | order of the list | by the bits of `SCAN`, from one end to the other | SCAN Mode |
//!
//! The order of the list is learned from the channel numbers that come with the conversions: it runs up or
//! down, and a cycle begins at that end.
//!
//! # What is noticed
//! Damaged answers (CRC), data that was read before (status), a supply that was off or registers that
//! were damaged while locked (status), a conversion that was missed: its cycle is not given. A device that was reset converts
//! nothing and sends no CRC; so one that is late, or whose answer is damaged, is asked for `CONFIG3`, which tells it. Not
//! noticed: a reset by who polls and has wired the pin, for whom there is nothing new from then on; `N`
//! conversions in a row that are missed in the midst of a cycle, since the chip does not count them; call
//! `restart` after a pause of your own. Commands are not protected on this chip; registers are read back after
//! they were written.
//!
//! # What was confirmed, and what was not
//! Nothing was tried with a chip. Commands, registers and fields agree with several published drivers; the CRC and
//! the status byte with readings of a real MCP3561R. Which way the list runs could not be confirmed, hence it is
//! learned; nor could the time that a reset takes (10 µs are given), nor how far beyond full scale a conversion
//! is good (it is taken for clipped there).

mod configuration;
mod driver;
#[cfg(feature = "devices")]
mod figures;
mod scan;
mod wire;

#[cfg(feature = "simulators")]
mod simulator;

pub use configuration::{Channel, Clock, Configuration, Gain, Oversampling, Reference};
pub use driver::{AsyncMcp3564, Mcp3564};
pub use wire::{Data, FastCommand, Register, Request, Status};

#[cfg(feature = "simulators")]
pub use simulator::SimulatedMcp3564;

/// Its entry among the devices.
#[cfg(feature = "devices")]
pub(crate) const DEVICE: crate::devices::Device = crate::devices::Device::converter(
    "mcp3564",
    "Microchip MCP3561, MCP3562 and MCP3564",
    crate::devices::Link::Spi,
    &figures::FIGURES,
);
