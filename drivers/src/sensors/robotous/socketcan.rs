//! A sensor on a CAN interface of Linux.

use fingertip_wrench::Wrench;
use socketcan::embedded_can::{ExtendedId, Id, StandardId};
use socketcan::{CanFilter, CanSocket, Socket, SocketOptions};

use super::{CanAssembler, CanSensor, CanSensorError, Request};
use crate::devices::{
    Address, AddressError, ConnectError, Losses, OpenSensor, Opened, SensorFault, WAIT, wrong,
};
use crate::polled::NbSource;
use crate::sensors::AxisCounts;
use crate::{Sample, SourceError, SourceErrorKind};

/// Opens a sensor and lets it stream.
pub(super) fn open(address: &Address, counts: AxisCounts) -> Result<OpenSensor, ConnectError> {
    let [first, second, requests] = ["first", "second", "request"].map(|key| identifier(address, key));
    let (first, second, requests) = (first?, second?, requests?);
    let place = address.place();
    let open = || {
        let socket = CanSocket::open(place)?;
        // Others that talk on the bus must not keep the user from being heard.
        socket.set_filters(&[first, second].map(exactly))?;
        socket.set_read_timeout(WAIT)?;
        socket.set_write_timeout(WAIT)?;
        Ok(socket)
    };
    let socket = open().map_err(|source| ConnectError::Can { place: place.to_owned(), source })?;
    let mut sensor = CanSensor::new(socket, CanAssembler::new(counts, first, second), requests);
    sensor.request(Request::Stream).map_err(|error| ConnectError::Start(said(&error)))?;
    Ok(OpenSensor::new(OnSocket(sensor)))
}

/// A socket says in words what failed, where a bus in general has but a kind.
fn said(error: &CanSensorError<socketcan::Error>) -> String {
    match error {
        CanSensorError::Bus(error) => format!("the CAN bus failed: {error}"),
        other => other.to_string(),
    }
}

/// An identifier of the address, hexadecimal: of 11 bits with up to three digits, of 29 with more.
fn identifier(address: &Address, key: &'static str) -> Result<Id, AddressError> {
    let digits = address.option(key).ok_or_else(|| address.missing(key))?;
    let number = u32::from_str_radix(digits, 16).ok();
    let id = number.and_then(|number| match u16::try_from(number).ok().filter(|_| digits.len() <= 3) {
        Some(number) => StandardId::new(number).map(Id::Standard),
        None => ExtendedId::new(number).map(Id::Extended),
    });
    id.ok_or_else(|| wrong(key, digits, "is no CAN identifier in hexadecimal digits"))
}

/// A filter that lets one identifier pass, in its own format.
fn exactly(id: Id) -> CanFilter {
    /// Marks a frame with an identifier of 29 bits, and all its bits.
    const EXTENDED: u32 = 1 << 31;
    let number = match id {
        Id::Standard(id) => u32::from(id.as_raw()),
        Id::Extended(id) => id.as_raw() | EXTENDED,
    };
    CanFilter::new(number, EXTENDED | ExtendedId::MAX.as_raw())
}

struct OnSocket(CanSensor<CanSocket, f64>);

impl Opened for OnSocket {
    fn next(&mut self) -> Result<Option<Sample<f64, Wrench<f64>>>, SensorFault> {
        self.0.poll_sample().map_err(|error| match error {
            nb::Error::WouldBlock => SensorFault::of_kind(SourceErrorKind::Timeout, "no frame came in time"),
            nb::Error::Other(CanSensorError::Sensor(fault)) => SensorFault::new(fault),
            nb::Error::Other(error) => SensorFault::of_kind(error.kind(), said(&error)),
        })
    }

    /// The sensor does not number its readings: what is known is only which came in part.
    fn losses(&self) -> Losses {
        let statistics = self.0.statistics();
        Losses { corrupt: statistics.halves + statistics.others, ..Losses::default() }
    }
}

#[cfg(test)]
mod tests {
    use super::{CanSensorError, Id, exactly, identifier, said};
    use crate::devices::{Address, devices, open};

    fn parse(text: &str) -> Address {
        Address::parse(text, devices()).unwrap()
    }

    #[test]
    fn what_is_wrong_is_named() {
        for (address, expected) in [
            ("robotous+can://can0?first=1&second=2", "request is needed"),
            ("robotous+can://can0?first=1&second=800&request=64", "second=800 is no CAN identifier"),
            ("robotous+can://can0?first=20000000&second=2&request=64", "no CAN identifier"),
            ("robotous+can://no-such-bus?first=1&second=2&request=64", "cannot open no-such-bus"),
        ] {
            let error = open(&parse(address)).unwrap_err().to_string();
            assert!(error.contains(expected), "{error}");
        }
    }

    #[test]
    fn what_fails_on_the_bus_is_said_in_words() {
        let down = std::io::Error::from_raw_os_error(100);
        let told = said(&CanSensorError::Bus(down.into()));
        assert_eq!(told, "the CAN bus failed: Network is down (os error 100)");
    }

    #[test]
    fn three_digits_are_eleven_bits_and_more_are_twenty_nine() {
        let of = |digits: &str| {
            identifier(&parse(&format!("robotous+can://can0?first={digits}")), "first").map(|id| match id {
                Id::Standard(id) => (u32::from(id.as_raw()), false),
                Id::Extended(id) => (id.as_raw(), true),
            })
        };
        assert_eq!((of("64"), of("7ff"), of("0")), (Ok((0x64, false)), Ok((0x7ff, false)), Ok((0, false))));
        assert_eq!((of("0064"), of("1fffffff")), (Ok((0x64, true)), Ok((0x1fff_ffff, true))));
        assert!(of("800").is_err() && of("20000000").is_err() && of("xyz").is_err());
        // A filter compares all bits, and the mark of the longer format.
        for (digits, number) in [("64", 0x64_u32), ("0064", 0x8000_0064)] {
            let address = parse(&format!("robotous+can://can0?first={digits}"));
            let filter = format!("{:?}", exactly(identifier(&address, "first").unwrap()));
            let expected = format!("{:?}", socketcan::CanFilter::new(number, 0x9fff_ffff));
            assert_eq!(filter, expected);
        }
    }
}
