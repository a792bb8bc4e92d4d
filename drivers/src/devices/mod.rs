//! What devices there are, and how a user writes where one is: one list, which the command's help, its servers of
//! simulated sensors and the tables of the documentation read.
//!
//! Each device has its entry beside its code. An [`Address`] names an entry and where its device is;
//! [`Address::open`] opens a sensor, and [`Device::simulator`] is the sensor without hardware.
//!
//! ```
//! use fingertip_drivers::devices::{Address, devices};
//!
//! let address = Address::parse("ati://192.168.1.1?rate_Hz=7000", devices())?;
//! assert_eq!(address.device().title, "ATI Net F/T, Axia");
//! let error = Address::parse("ati://192.168.1.1?rate=7000", devices()).unwrap_err();
//! assert!(error.to_string().contains("knows no “rate”"));
//! # Ok::<(), fingertip_drivers::devices::AddressError>(())
//! ```

mod address;
mod connect;
mod line;
mod losses;
mod opened;
mod simulator;
mod timed;

pub use address::{Address, AddressError};
pub use connect::ConnectError;
pub use losses::Losses;
pub use opened::{OpenSensor, SensorFault};
pub use simulator::{NetworkSimulator, SerialSimulator, ServeError, Served, Serving, Simulator};

pub(crate) use address::wrong;
pub(crate) use connect::{REPLY, WAIT, counts, counts_per_unit};
#[cfg(test)]
pub(crate) use line::tests as line_tests;
pub(crate) use line::{Line, asked, open_line, streaming};
pub(crate) use opened::{Opened, source};
pub(crate) use timed::Timed;

use crate::{converters, sensors};

/// What a device is connected by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Link {
    /// Ethernet: the place of an address is a host with or without port.
    Ethernet,
    /// A serial port, or TCP in its place.
    Serial {
        /// Baud rate as delivered.
        baud: u32,
    },
    /// A CAN interface of Linux.
    Can,
    /// SPI, over the traits of `embedded-hal`.
    Spi,
    /// I²C, over the traits of `embedded-hal`.
    I2c,
    /// Pins, over the traits of `embedded-hal`.
    Pins,
    /// Nothing: it is in this program.
    Program,
}

impl Link {
    /// What an address must name where it names no place; `None` if it need not.
    pub(super) const fn example(self, over_tcp: bool) -> Option<&'static str> {
        match self {
            _ if over_tcp => Some("+tcp://127.0.0.1:4000"),
            Self::Serial { .. } => Some(":///dev/ttyUSB0"),
            Self::Can => Some("://can0"),
            _ => None,
        }
    }
}

/// What an address can say of a device behind its question mark.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DeviceOption {
    /// Its name, with its unit.
    pub key: &'static str,
    /// A value, for examples.
    pub example: &'static str,
    /// What it says, and what holds without it.
    pub meaning: &'static str,
    /// Whether the device cannot be opened without it.
    pub needed: bool,
}

impl DeviceOption {
    /// One that may be left out.
    #[must_use]
    pub const fn new(key: &'static str, example: &'static str, meaning: &'static str) -> Self {
        Self { key, example, meaning, needed: false }
    }

    /// One without which the device cannot be opened.
    #[must_use]
    pub const fn needed(key: &'static str, example: &'static str, meaning: &'static str) -> Self {
        Self { key, example, meaning, needed: true }
    }
}

/// The entry of a device.
#[derive(Clone, Copy, Debug)]
pub struct Device {
    /// The name by which an address begins, and that of its feature for a converter.
    pub name: &'static str,
    /// Maker and model.
    pub title: &'static str,
    /// What it is connected by.
    pub link: Link,
    /// Where one may be, as the place of an address; nothing for a device that has no address.
    pub place: Option<&'static str>,
    /// What its address can say, but for the baud rate that all serial devices have.
    pub options: &'static [DeviceOption],
    /// How it is simulated.
    pub simulator: Option<Simulator>,
    /// Opens it; nothing for what is opened elsewhere.
    pub(crate) open: Option<Open>,
}

/// What opens a device at an address.
pub(crate) type Open = fn(&Address) -> Result<OpenSensor, ConnectError>;

impl Device {
    /// A device that the one who lists it opens, at an address that is its name.
    #[must_use]
    pub const fn in_program(
        name: &'static str,
        title: &'static str,
        options: &'static [DeviceOption],
    ) -> Self {
        Self { name, title, link: Link::Program, place: Some(""), options, simulator: None, open: None }
    }

    /// A converter, which firmware opens over the traits of `embedded-hal`.
    pub(crate) const fn converter(name: &'static str, title: &'static str, link: Link) -> Self {
        let simulator = Some(Simulator::OnABench);
        Self { name, title, link, place: None, options: &[], simulator, open: None }
    }

    /// An address as a user may write it, with the options that are needed; `None` for a device without one.
    #[must_use]
    pub fn example(&self) -> Option<String> {
        let place = self.place?;
        let mut text = String::from(self.name);
        if !place.is_empty() {
            text += "://";
            text += place;
        }
        for (number, option) in self.options.iter().filter(|option| option.needed).enumerate() {
            text += if number == 0 { "?" } else { "&" };
            text += option.key;
            text += "=";
            text += option.example;
        }
        Some(text)
    }

    /// All that its address can say.
    pub fn all_options(&self) -> impl Iterator<Item = DeviceOption> {
        let baud =
            DeviceOption::new("baud", "115200", "baud rate; without it that of the sensor as delivered");
        let serial = matches!(self.link, Link::Serial { .. });
        self.options.iter().copied().chain(serial.then_some(baud))
    }
}

/// All devices: sensors on a wire in the order of the help, then converters.
#[must_use]
pub const fn devices() -> &'static [&'static Device] {
    &[
        &sensors::ati_rdt::device::NET_FT,
        &sensors::ati_rdt::device::ONROBOT,
        &sensors::schunk_fts::device::DEVICE,
        &sensors::bota_serial::device::DEVICE,
        &sensors::robotous::device::SERIAL,
        &sensors::robotous::device::CAN,
        &sensors::dynpick::device::DEVICE,
        &sensors::optoforce::device::DEVICE,
        &sensors::resense::device::DEVICE,
        &converters::ads131m::DEVICE,
        &converters::ads1256::DEVICE,
        &converters::mcp3564::DEVICE,
        &converters::hx711::DEVICE,
        &converters::nau7802::DEVICE,
    ]
}
