//! The address of a sensor: protocol, place, and what the sensor does not say of itself.

use core::fmt;
use core::str::FromStr;

/// What an address can look like, for help texts.
pub(crate) const EXAMPLES: &str = "\
Addresses of sensors: PROTOCOL://PLACE?KEY=VALUE&…

  ati://192.168.1.1           ATI Net F/T, Axia; asks its page over HTTP for
                              counts and rate (?http=80 is the port), or
                              ?counts_per_N=1e6&counts_per_Nm=1e6&rate_Hz=7000
  onrobot://192.168.1.1       OnRobot (OptoForce) EtherDAQ; ?rate_Hz=
  schunk://192.168.0.100      SCHUNK FTS; ?rate_Hz=8000&udp=54843 (local port)
  bota:///dev/ttyUSB0         Bota Systems serial; ?rate_Hz=800 (as it is set)
                              lets lost samples be counted by their times
  robotous:///dev/ttyUSB0     Robotous RFT; ?counts_per_N=50&counts_per_Nm=2000
  robotous+can://can0         the same on CAN (Linux); ?first=&second=&request=
                              are needed: its identifiers, hexadecimal
  dynpick:///dev/ttyUSB0      WACOH DynPick; asks for its sensitivities, or
                              ?counts_per_N=24.9&counts_per_Nm=1664
  optoforce:///dev/ttyACM0    OptoForce USB; ?counts_per_N=&counts_per_Nm= are
                              needed, ?rate_Hz=1000 sets its rate
  resense:///dev/ttyUSB0      Resense HEX; ?greatest_N=&greatest_Nm= are needed:
                              its range with reserve; ?request=3A0A asks for
                              each reading with these bytes: without it lost
                              readings cannot be noticed, and are not counted
  sim                         the simulated fingertip; ?seed=1&rate_Hz=1000

Serial protocols take ?baud=, and speak over TCP with +tcp, such as
bota+tcp://10.0.0.7:4000. Put an address with ? or & in quotes. Where a sensor
sends no time, samples have that of their arrival.";

/// An address, taken apart.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Address {
    text: String,
    pub(super) protocol: Protocol,
    /// A serial protocol over TCP.
    pub(super) over_tcp: bool,
    /// Host with or without port, or the path of a device; empty if it is not given.
    pub(super) place: String,
    options: Vec<(String, String)>,
}

/// What is spoken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Protocol {
    Ati,
    OnRobot,
    Schunk,
    Bota,
    Robotous,
    RobotousCan,
    DynPick,
    OptoForce,
    Resense,
    Simulated,
}

impl Protocol {
    const ALL: [(&'static str, Self, &'static [&'static str]); 10] = [
        ("ati", Self::Ati, &["counts_per_N", "counts_per_Nm", "rate_Hz", "http"]),
        ("onrobot", Self::OnRobot, &["rate_Hz"]),
        ("schunk", Self::Schunk, &["rate_Hz", "udp"]),
        ("bota", Self::Bota, &["baud", "rate_Hz"]),
        ("robotous", Self::Robotous, &["baud", "counts_per_N", "counts_per_Nm"]),
        ("robotous+can", Self::RobotousCan, &["first", "second", "request", "counts_per_N", "counts_per_Nm"]),
        ("dynpick", Self::DynPick, &["baud", "counts_per_N", "counts_per_Nm"]),
        ("optoforce", Self::OptoForce, &["baud", "counts_per_N", "counts_per_Nm", "rate_Hz"]),
        ("resense", Self::Resense, &["baud", "greatest_N", "greatest_Nm", "request"]),
        ("sim", Self::Simulated, &["seed", "rate_Hz"]),
    ];

    pub(super) const fn is_serial(self) -> bool {
        matches!(self, Self::Bota | Self::Robotous | Self::DynPick | Self::OptoForce | Self::Resense)
    }
}

impl FromStr for Address {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (main, query) = text.split_once('?').unwrap_or((text, ""));
        let (scheme, place) = main.split_once("://").unwrap_or((main, ""));
        let (scheme, over_tcp) = match scheme.strip_suffix("+tcp") {
            Some(scheme) => (scheme, true),
            None => (scheme, false),
        };
        let known = Protocol::ALL.into_iter().find(|(name, ..)| scheme.eq_ignore_ascii_case(name));
        let Some((name, protocol, keys)) = known else {
            let names: Vec<&str> = Protocol::ALL.iter().map(|(name, ..)| *name).collect();
            return Err(format!("“{scheme}” is no protocol that is known; use one of: {}", names.join(", ")));
        };
        if over_tcp && !protocol.is_serial() {
            return Err(format!("{name} has its own transport; leave out +tcp"));
        }
        let mut options = Vec::new();
        for option in query.split('&').filter(|option| !option.is_empty()) {
            let (key, value) =
                option.split_once('=').ok_or_else(|| format!("“{option}” must be written KEY=VALUE"))?;
            if !keys.contains(&key) {
                return Err(format!("{name} knows no “{key}”; known are: {}", keys.join(", ")));
            }
            options.push((key.to_owned(), value.to_owned()));
        }
        let place =
            if place.is_empty() && matches!(protocol, Protocol::Ati | Protocol::OnRobot | Protocol::Schunk) {
                "127.0.0.1"
            } else {
                place
            };
        let example = match protocol {
            Protocol::RobotousCan => Some("://can0"),
            _ if over_tcp => Some("+tcp://127.0.0.1:4000"),
            _ if protocol.is_serial() => Some(":///dev/ttyUSB0"),
            _ => None,
        };
        if let Some(example) = example.filter(|_| place.is_empty()) {
            return Err(format!("where is the sensor? For example {name}{example}"));
        }
        Ok(Self { text: text.to_owned(), protocol, over_tcp, place: place.to_owned(), options })
    }
}

impl fmt::Display for Address {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(&self.text)
    }
}

impl Address {
    /// Whether it is the simulated fingertip in this process.
    pub(crate) fn is_simulated(&self) -> bool {
        self.protocol == Protocol::Simulated
    }

    pub(super) fn option(&self, key: &str) -> Option<&str> {
        self.options.iter().rev().find(|(name, _)| name == key).map(|(_, value)| value.as_str())
    }

    /// A number of the address.
    pub(super) fn number(&self, key: &str) -> Result<Option<f64>, String> {
        let parse = |text: &str| match text.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ => Err(format!("{key}={text} is not a number")),
        };
        self.option(key).map(parse).transpose()
    }

    /// A number above zero.
    pub(super) fn positive(&self, key: &str) -> Result<Option<f64>, String> {
        match self.number(key)? {
            Some(number) if !(number > 0.0) => Err(format!("{key}={number} must be above 0")),
            other => Ok(other),
        }
    }

    /// A number without which the sensor's bytes mean nothing.
    pub(super) fn needed(&self, key: &str, what: &str) -> Result<f64, String> {
        self.positive(key)?.ok_or_else(|| format!("{key} is needed: {what}; add ?{key}=… to the address"))
    }

    pub(super) fn whole<N: FromStr>(&self, key: &str) -> Result<Option<N>, String> {
        let parse =
            |text: &str| text.parse().map_err(|_| format!("{key}={text} is not a whole number that fits"));
        self.option(key).map(parse).transpose()
    }

    /// Host and port.
    pub(super) fn host(&self, port: u16) -> String {
        let has_port = match self.place.rsplit_once(':') {
            // An IPv6 address has colons of its own, and brackets if it has a port.
            Some((host, port)) => port.parse::<u16>().is_ok() && (!host.contains(':') || host.ends_with(']')),
            None => false,
        };
        if has_port { self.place.clone() } else { format!("{}:{port}", self.place) }
    }

    /// The host without its port.
    pub(super) fn host_only(&self) -> String {
        let with_port = self.host(0);
        with_port.rsplit_once(':').map_or(with_port.clone(), |(host, _)| host.to_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::{Address, Protocol};

    #[test]
    fn addresses_are_taken_apart() {
        let address: Address = "ati://10.0.0.2:5000?counts_per_N=1e6&rate_Hz=7000".parse().unwrap();
        assert_eq!((address.protocol, address.host(49152)), (Protocol::Ati, "10.0.0.2:5000".to_owned()));
        assert_eq!(address.positive("counts_per_N"), Ok(Some(1e6)));
        assert_eq!(address.positive("counts_per_Nm"), Ok(None));
        let hosts =
            [("ati", "127.0.0.1:1"), ("ati://tip.local", "tip.local:1"), ("ati://[::1]:9", "[::1]:9")];
        for (text, host) in hosts {
            assert_eq!(text.parse::<Address>().unwrap().host(1), host);
        }
        let serial: Address = "bota+tcp://127.0.0.1:7".parse().unwrap();
        assert!(serial.over_tcp && serial.place == "127.0.0.1:7");
        assert_eq!("bota:///dev/ttyUSB0".parse::<Address>().unwrap().place, "/dev/ttyUSB0");
    }

    #[test]
    fn what_is_wrong_is_named() {
        for (text, expected) in [
            ("atti://x", "no protocol"),
            ("bota", "where is the sensor"),
            ("robotous+can", "where is the sensor? For example robotous+can://can0"),
            ("robotous+can+tcp://x", "leave out +tcp"),
            ("ati+tcp://x", "leave out +tcp"),
            ("ati://x?counts=3", "knows no “counts”"),
            ("ati://x?rate_Hz", "KEY=VALUE"),
        ] {
            let error = text.parse::<Address>().unwrap_err();
            assert!(error.contains(expected), "{error}");
        }
        let address: Address = "ati://x?rate_Hz=-1&http=99999".parse().unwrap();
        assert!(address.positive("rate_Hz").unwrap_err().contains("above 0"));
        assert!(address.whole::<u16>("http").unwrap_err().contains("99999"));
        assert!(address.needed("counts_per_N", "what").unwrap_err().contains("?counts_per_N="));
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
            let address: Address = format!("ati://{place}").parse().unwrap();
            assert_eq!((address.host(7), address.host_only()), (with.to_owned(), without.to_owned()));
            assert_eq!(address.to_string(), format!("ati://{place}"));
        }
    }

    #[test]
    fn every_protocol_has_its_place() {
        for (name, protocol, options) in Protocol::ALL {
            let is_network = matches!(protocol, Protocol::Ati | Protocol::OnRobot | Protocol::Schunk);
            let bare = name.parse::<Address>();
            match protocol {
                Protocol::Simulated => assert_eq!(bare.unwrap().place, ""),
                _ if is_network => assert_eq!(bare.unwrap().place, "127.0.0.1"),
                _ => assert!(bare.unwrap_err().contains(&format!("For example {name}"))),
            }
            let address: Address =
                format!("{}://there?{}=3", name.to_uppercase(), options[0]).parse().unwrap();
            assert_eq!(
                (address.protocol, address.place.as_str(), address.over_tcp),
                (protocol, "there", false)
            );
            assert_eq!(address.option(options[0]), Some("3"));
            assert_eq!(address.is_simulated(), name == "sim");
            let over_tcp = format!("{name}+tcp://there").parse::<Address>();
            let is_serial = ["bota", "robotous", "dynpick", "optoforce", "resense"].contains(&name);
            assert_eq!(over_tcp.is_ok_and(|address| address.over_tcp), is_serial, "{name}");
            assert_eq!(protocol.is_serial(), is_serial);
        }
        let error = "bota+tcp".parse::<Address>().unwrap_err();
        assert!(error.contains("For example bota+tcp://127.0.0.1:4000"), "{error}");
    }

    #[test]
    fn numbers_of_an_address_are_numbers() {
        let address: Address =
            "ati://x?rate_Hz=5&rate_Hz=7&&counts_per_N=0&counts_per_Nm=inf&http=80".parse().unwrap();
        // The last one counts.
        assert_eq!(address.positive("rate_Hz"), Ok(Some(7.0)));
        assert_eq!(address.needed("rate_Hz", ""), Ok(7.0));
        assert_eq!(address.number("counts_per_N"), Ok(Some(0.0)));
        assert!(address.positive("counts_per_N").unwrap_err().contains("counts_per_N=0 must be above 0"));
        assert!(address.number("counts_per_Nm").unwrap_err().contains("counts_per_Nm=inf is not a number"));
        assert_eq!(address.whole::<u16>("http"), Ok(Some(80)));
        assert_eq!(address.whole::<u16>("seed"), Ok(None));
        assert_eq!(address.number("seed"), Ok(None));
    }
}
