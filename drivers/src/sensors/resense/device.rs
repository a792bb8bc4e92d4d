//! The entry of Resense's sensors among the devices.

use super::{Limits, ResenseDecoder, SimulatedResense};
use crate::devices::{
    Address, AddressError, ConnectError, Device, DeviceOption, Entry, Link, OpenSensor, SerialSimulator,
    Simulator, asked, open_line, streaming, wrong,
};

/// What the range is for.
const RANGE: &str =
    "readings beyond it show that the line is out of step; take the sensor's range with reserve";

pub(crate) const ENTRY: Entry = Entry {
    device: Device {
        name: "resense",
        title: "Resense HEX",
        link: Link::Serial { baud: 2_000_000 },
        place: Some("/dev/ttyUSB0"),
        options: &[
            DeviceOption::needed("greatest_N", "200", RANGE),
            DeviceOption::needed("greatest_Nm", "10", RANGE),
            DeviceOption::new(
                "request",
                "3A0A",
                "asks for each reading with these bytes; without it lost readings cannot be noticed",
            ),
        ],
        converter: None,
        simulator: Some(Simulator::Serial(|_| SerialSimulator {
            device: SimulatedResense::streaming().into(),
            options: "?greatest_N=200&greatest_Nm=10".to_owned(),
        })),
    },
    open,
};

fn open(address: &Address) -> Result<OpenSensor, ConnectError> {
    #[expect(clippy::cast_possible_truncation, reason = "a limit")]
    let limits = Limits {
        force: address.needed("greatest_N")? as f32,
        torque: address.needed("greatest_Nm")? as f32,
        temperature: [-40.0, 125.0],
        temperature_step: 5.0,
    };
    let decoder = ResenseDecoder::new(limits);
    let request = address.option("request").map(bytes).transpose()?;
    let line = open_line(address)?;
    match request {
        Some(request) => Ok(asked(line, decoder, request, |_| None)),
        None => streaming(line, decoder, &[], |_| None),
    }
}

/// Bytes from hexadecimal digits.
fn bytes(digits: &str) -> Result<Vec<u8>, AddressError> {
    let wrong = || wrong("request", digits, "must be hexadecimal digits, two for each byte");
    let (pairs, rest) = digits.as_bytes().as_chunks::<2>();
    if pairs.is_empty() || !rest.is_empty() {
        return Err(wrong());
    }
    let digit = |byte: u8| char::from(byte).to_digit(16).and_then(|digit| u8::try_from(digit).ok());
    let byte = |[high, low]: &[u8; 2]| Some(digit(*high)? << 4 | digit(*low)?);
    pairs.iter().map(|pair| byte(pair).ok_or_else(wrong)).collect()
}

#[cfg(test)]
mod tests {
    use super::bytes;

    #[test]
    fn bytes_are_pairs_of_hexadecimal_digits() {
        assert_eq!(bytes("3A0a00ff"), Ok(vec![0x3a, 0x0a, 0x00, 0xff]));
        for wrong in ["", "3", "3A0", "3G", "ä", "+1"] {
            assert!(bytes(wrong).is_err(), "{wrong}");
        }
    }
}
