//! What a device is known by: its name, its link, what its address can say.

use super::simulator::Simulator;
use crate::converters::ConverterFigures;

/// What a device is connected by.
///
/// ```
/// use fingertip_drivers::devices::{Link, devices};
///
/// let on_ethernet: Vec<_> =
///     devices().iter().filter(|device| device.link == Link::Ethernet).map(|device| device.name).collect();
/// assert_eq!(on_ethernet, ["ati", "onrobot", "schunk"]);
/// ```
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
///
/// ```
/// use fingertip_drivers::devices::devices;
///
/// let dynpick = devices().iter().find(|device| device.name == "dynpick").unwrap();
/// let keys: Vec<_> = dynpick.all_options().map(|option| option.key).collect();
/// assert_eq!(keys, ["counts_per_N", "counts_per_Nm", "baud"]);
/// ```
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

/// What is known of a kind of device beforehand.
///
/// ```
/// use fingertip_drivers::devices::devices;
///
/// // What a help text has to say of a sensor.
/// let resense = devices().iter().find(|device| device.name == "resense").unwrap();
/// assert_eq!(resense.title, "Resense HEX");
/// let example = resense.example().unwrap();
/// assert_eq!(example, "resense:///dev/ttyUSB0?greatest_N=200&greatest_Nm=10");
/// ```
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
    /// What it can be set to, if it is a converter.
    pub converter: Option<&'static ConverterFigures>,
}

impl Device {
    /// A device that the one who lists it opens, at an address that is its name.
    #[must_use]
    pub const fn in_program(
        name: &'static str,
        title: &'static str,
        options: &'static [DeviceOption],
    ) -> Self {
        Self { name, title, link: Link::Program, place: Some(""), options, simulator: None, converter: None }
    }

    /// A converter, which firmware opens over the traits of `embedded-hal`.
    pub(crate) const fn converter(
        name: &'static str,
        title: &'static str,
        link: Link,
        figures: &'static ConverterFigures,
    ) -> Self {
        let simulator = Some(Simulator::OnABench);
        Self { name, title, link, place: None, options: &[], simulator, converter: Some(figures) }
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
