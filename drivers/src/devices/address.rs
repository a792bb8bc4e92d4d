//! The address of a device: which it is, where, and what it does not say of itself.

use core::fmt;
use core::str::FromStr;

use thiserror::Error;

use super::device::{Device, Link};

/// What is wrong with an address. Each message names what the user wrote.
///
/// ```
/// use fingertip_drivers::devices::{Address, devices};
///
/// let told = |address| Address::parse(address, devices()).unwrap_err().to_string();
/// assert_eq!(told("bota"), "where is the sensor? For example bota:///dev/ttyUSB0");
/// assert_eq!(told("ati+tcp://192.168.1.1"), "ati has its own transport; leave out +tcp");
/// ```
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum AddressError {
    /// It begins with no device.
    #[error("“{scheme}” is no protocol that is known; use one of: {known}")]
    Unknown {
        /// What it begins with.
        scheme: String,
        /// The devices that have addresses.
        known: String,
    },
    /// The device cannot be reached over TCP in place of a serial port.
    #[error("{name} has its own transport; leave out +tcp")]
    NotSerial {
        /// The device.
        name: &'static str,
    },
    /// It names no place.
    #[error("where is the sensor? For example {example}")]
    NoPlace {
        /// An address.
        example: String,
    },
    /// A part behind the question mark is no option.
    #[error("“{found}” must be written KEY=VALUE")]
    NoOption {
        /// The part.
        found: String,
    },
    /// The device has no such option.
    #[error("{name} knows no “{key}”; known are: {known}")]
    UnknownOption {
        /// The device.
        name: &'static str,
        /// The option.
        key: String,
        /// Its options.
        known: String,
    },
    /// An option has a value that it cannot have.
    #[error("{key}={found} {problem}")]
    Value {
        /// The option.
        key: String,
        /// Its value.
        found: String,
        /// What is wrong.
        problem: &'static str,
    },
    /// An option without which the device cannot be used is not there.
    #[error("{key} is needed: {meaning}; add ?{key}={example} to the address")]
    Needed {
        /// The option.
        key: &'static str,
        /// What it says.
        meaning: &'static str,
        /// A value.
        example: &'static str,
    },
    /// One of two options that belong together is not there.
    #[error("{first} and {second} belong together; state both")]
    Apart {
        /// The one.
        first: &'static str,
        /// The other.
        second: &'static str,
    },
}

/// An address, taken apart: `NAME://PLACE?KEY=VALUE&…`, or `NAME+tcp://HOST:PORT` for a serial device over TCP.
///
/// ```
/// use fingertip_drivers::devices::{Address, devices};
///
/// let address = Address::parse("dynpick:///dev/ttyUSB0?counts_per_N=24.9&counts_per_Nm=1664", devices())?;
/// assert_eq!((address.device().name, address.place()), ("dynpick", "/dev/ttyUSB0"));
/// assert_eq!(address.positive("counts_per_N")?, Some(24.9));
/// assert_eq!(address.option("baud"), None);
/// # Ok::<(), fingertip_drivers::devices::AddressError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Address {
    text: String,
    device: &'static Device,
    over_tcp: bool,
    place: String,
    options: Vec<(String, String)>,
}

impl Address {
    /// Takes an address of one of these devices apart; the last of options of one name counts.
    ///
    /// # Errors
    /// [`AddressError`].
    pub fn parse(text: &str, devices: &[&'static Device]) -> Result<Self, AddressError> {
        let (main, query) = text.split_once('?').unwrap_or((text, ""));
        let (scheme, place) = main.split_once("://").unwrap_or((main, ""));
        let (scheme, over_tcp) = match scheme.strip_suffix("+tcp") {
            Some(scheme) => (scheme, true),
            None => (scheme, false),
        };
        let addressed = || devices.iter().copied().filter(|device| device.place.is_some());
        let Some(device) = addressed().find(|device| scheme.eq_ignore_ascii_case(device.name)) else {
            let known = joined(addressed().map(|device| device.name));
            return Err(AddressError::Unknown { scheme: scheme.to_owned(), known });
        };
        let name = device.name;
        if over_tcp && !matches!(device.link, Link::Serial { .. }) {
            return Err(AddressError::NotSerial { name });
        }
        let mut options = Vec::new();
        for option in query.split('&').filter(|option| !option.is_empty()) {
            let (key, value) =
                option.split_once('=').ok_or_else(|| AddressError::NoOption { found: option.to_owned() })?;
            if !device.all_options().any(|option| option.key == key) {
                let known = joined(device.all_options().map(|option| option.key));
                return Err(AddressError::UnknownOption { name, key: key.to_owned(), known });
            }
            options.push((key.to_owned(), value.to_owned()));
        }
        let place = if place.is_empty() && device.link == Link::Ethernet { "127.0.0.1" } else { place };
        if let Some(example) = device.link.example(over_tcp).filter(|_| place.is_empty()) {
            return Err(AddressError::NoPlace { example: format!("{name}{example}") });
        }
        Ok(Self { text: text.to_owned(), device, over_tcp, place: place.to_owned(), options })
    }

    /// Which device it names.
    #[must_use]
    pub const fn device(&self) -> &'static Device {
        self.device
    }

    /// Whether it names TCP in place of a serial port.
    #[must_use]
    pub const fn is_over_tcp(&self) -> bool {
        self.over_tcp
    }

    /// Host with or without port, or the path of a port, or the name of an interface; empty if it has none.
    #[must_use]
    pub fn place(&self) -> &str {
        &self.place
    }

    /// The value of an option.
    #[must_use]
    pub fn option(&self, key: &str) -> Option<&str> {
        self.options.iter().rev().find(|(name, _)| name == key).map(|(_, value)| value.as_str())
    }

    /// A number above zero.
    ///
    /// # Errors
    /// [`AddressError::Value`].
    pub fn positive(&self, key: &str) -> Result<Option<f64>, AddressError> {
        let Some(text) = self.option(key) else { return Ok(None) };
        match text.parse::<f64>() {
            Ok(number) if number.is_finite() && number > 0.0 => Ok(Some(number)),
            Ok(number) if number.is_finite() => Err(wrong(key, text, "must be above 0")),
            _ => Err(wrong(key, text, "is not a number")),
        }
    }

    /// A whole number.
    ///
    /// # Errors
    /// [`AddressError::Value`].
    pub fn whole<N: FromStr>(&self, key: &str) -> Result<Option<N>, AddressError> {
        let parse =
            |text: &str| text.parse().map_err(|_| wrong(key, text, "is not a whole number that fits"));
        self.option(key).map(parse).transpose()
    }

    /// A number above zero without which the sensor's bytes mean nothing.
    pub(crate) fn needed(&self, key: &'static str) -> Result<f64, AddressError> {
        self.positive(key)?.ok_or_else(|| self.missing(key))
    }

    /// That an option is not there.
    pub(crate) fn missing(&self, key: &'static str) -> AddressError {
        let option = self.device.options.iter().find(|option| option.key == key);
        let (meaning, example) = option.map_or(("", ""), |option| (option.meaning, option.example));
        AddressError::Needed { key, meaning, example }
    }

    /// Host and port.
    pub(crate) fn host(&self, port: u16) -> String {
        let has_port = match self.place.rsplit_once(':') {
            // An IPv6 address has colons of its own, and brackets if it has a port.
            Some((host, port)) => port.parse::<u16>().is_ok() && (!host.contains(':') || host.ends_with(']')),
            None => false,
        };
        if has_port { self.place.clone() } else { format!("{}:{port}", self.place) }
    }

    /// The host without its port.
    pub(crate) fn host_only(&self) -> String {
        let with_port = self.host(0);
        with_port.rsplit_once(':').map_or(with_port.clone(), |(host, _)| host.to_owned())
    }
}

impl fmt::Display for Address {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(&self.text)
    }
}

/// An option whose value it cannot have.
pub(crate) fn wrong(key: &str, found: &str, problem: &'static str) -> AddressError {
    AddressError::Value { key: key.to_owned(), found: found.to_owned(), problem }
}

fn joined<'a>(names: impl Iterator<Item = &'a str>) -> String {
    names.collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::super::{Link, devices};
    use super::Address;

    fn parse(text: &str) -> Result<Address, String> {
        Address::parse(text, devices()).map_err(|error| error.to_string())
    }

    #[test]
    fn addresses_are_taken_apart() {
        let address = parse("ati://10.0.0.2:5000?counts_per_N=1e6&rate_Hz=7000").unwrap();
        assert_eq!((address.device().name, address.host(49152)), ("ati", "10.0.0.2:5000".to_owned()));
        assert_eq!(address.positive("counts_per_N"), Ok(Some(1e6)));
        assert_eq!(address.positive("counts_per_Nm"), Ok(None));
        let hosts =
            [("ati", "127.0.0.1:1"), ("ati://tip.local", "tip.local:1"), ("ati://[::1]:9", "[::1]:9")];
        for (text, host) in hosts {
            assert_eq!(parse(text).unwrap().host(1), host);
        }
        let serial = parse("bota+tcp://127.0.0.1:7").unwrap();
        assert!(serial.is_over_tcp() && serial.place() == "127.0.0.1:7");
        assert_eq!(parse("bota:///dev/ttyUSB0").unwrap().place(), "/dev/ttyUSB0");
    }

    #[test]
    fn what_is_wrong_is_named() {
        for (text, expected) in [
            ("atti://x", "no protocol"),
            // A converter has no address.
            ("ads131m://x", "no protocol"),
            ("bota", "where is the sensor"),
            ("bota+tcp", "For example bota+tcp://127.0.0.1:4000"),
            ("robotous+can", "where is the sensor? For example robotous+can://can0"),
            ("robotous+can+tcp://x", "leave out +tcp"),
            ("ati+tcp://x", "leave out +tcp"),
            ("ati://x?counts=3", "knows no “counts”"),
            ("ati://x?baud=3", "knows no “baud”"),
            ("ati://x?rate_Hz", "KEY=VALUE"),
        ] {
            let error = parse(text).unwrap_err();
            assert!(error.contains(expected), "{error}");
        }
        let address = parse("ati://x?rate_Hz=-1&http=99999").unwrap();
        assert!(address.positive("rate_Hz").unwrap_err().to_string().contains("above 0"));
        assert!(address.whole::<u16>("http").unwrap_err().to_string().contains("99999"));
        assert!(address.needed("counts_per_N").unwrap_err().to_string().contains("?counts_per_N="));
    }

    #[test]
    fn hosts_have_the_port_that_is_given_or_the_usual_one() {
        for (place, with, without) in [
            ("tip.local", "tip.local:7", "tip.local"),
            ("tip.local:80", "tip.local:80", "tip.local"),
            ("tip.local:none", "tip.local:none:7", "tip.local:none"),
            ("[::1]:80", "[::1]:80", "[::1]"),
            ("[::1]", "[::1]:7", "[::1]"),
            ("fe80::1", "fe80::1:7", "fe80::1"),
        ] {
            let address = parse(&format!("ati://{place}")).unwrap();
            assert_eq!((address.host(7), address.host_only()), (with.to_owned(), without.to_owned()));
            assert_eq!(address.to_string(), format!("ati://{place}"));
        }
    }

    #[test]
    fn every_device_has_its_place() {
        for device in devices().iter().filter(|device| device.place.is_some()) {
            let (name, is_serial) = (device.name, matches!(device.link, Link::Serial { .. }));
            match device.link {
                Link::Ethernet => assert_eq!(parse(name).unwrap().place(), "127.0.0.1"),
                _ => assert!(parse(name).unwrap_err().contains(&format!("For example {name}"))),
            }
            for option in device.all_options() {
                let text = format!("{}://there?{}=3", name.to_uppercase(), option.key);
                let address = parse(&text).unwrap();
                assert_eq!((address.device().name, address.place()), (name, "there"));
                assert_eq!((address.option(option.key), address.is_over_tcp()), (Some("3"), false));
            }
            let over_tcp = parse(&format!("{name}+tcp://there"));
            assert_eq!(over_tcp.is_ok_and(|address| address.is_over_tcp()), is_serial, "{name}");
        }
    }

    #[test]
    fn numbers_of_an_address_are_numbers() {
        let address = parse("ati://x?rate_Hz=5&rate_Hz=7&&counts_per_N=0&counts_per_Nm=inf&http=80").unwrap();
        // The last one counts.
        assert_eq!(address.positive("rate_Hz"), Ok(Some(7.0)));
        assert_eq!(address.needed("rate_Hz"), Ok(7.0));
        let wrong = |key| address.positive(key).unwrap_err().to_string();
        assert!(wrong("counts_per_N").contains("counts_per_N=0 must be above 0"));
        assert!(wrong("counts_per_Nm").contains("counts_per_Nm=inf is not a number"));
        assert_eq!(address.whole::<u16>("http"), Ok(Some(80)));
        assert_eq!(address.whole::<u16>("seed"), Ok(None));
        assert_eq!(address.positive("seed"), Ok(None));
    }
}
