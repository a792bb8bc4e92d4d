//! The entry of WACOH's DynPick sensors among the devices.

use std::io;

use super::{DynPickDecoder, REQUEST, REQUEST_SENSITIVITIES, Sensitivities, SimulatedDynPick};
use crate::devices::{
    Address, ConnectError, Device, DeviceOption, Entry, Line, Link, OpenSensor, SerialSimulator, Simulator,
    asked, counts, open_line,
};
use crate::sensors::AxisCounts;

pub(crate) const ENTRY: Entry = Entry {
    device: Device {
        name: "dynpick",
        title: "WACOH DynPick",
        link: Link::Serial { baud: 921_600 },
        place: Some("/dev/ttyUSB0"),
        options: &[
            DeviceOption::new("counts_per_N", "24.9", "without it the sensor is asked"),
            DeviceOption::new("counts_per_Nm", "1664", "as counts_per_N"),
        ],
        converter: None,
        simulator: Some(Simulator::Serial(|_| SerialSimulator {
            device: SimulatedDynPick::new(WEF_6A200).into(),
            options: String::new(),
        })),
    },
    open,
};

/// Those of the WEF-6A200.
const WEF_6A200: AxisCounts = AxisCounts::of_data_sheet(40.0, 1640.0);

fn open(address: &Address) -> Result<OpenSensor, ConnectError> {
    let mut line = open_line(address)?;
    let counts = match counts(address)? {
        Some(counts) => counts,
        None => {
            let answer = ask(&mut *line, &[REQUEST_SENSITIVITIES]).map_err(ConnectError::Ask)?;
            Sensitivities::parse(&answer).map_err(ConnectError::Sensitivities)?.counts()
        }
    };
    Ok(asked(line, DynPickDecoder::new(counts), vec![REQUEST], |decoder| Some(decoder.missing())))
}

/// Sends a request and reads one line of text, as far as it comes in time.
fn ask(line: &mut dyn Line, request: &[u8]) -> io::Result<Vec<u8>> {
    line.write_all(request)?;
    let mut answer = Vec::new();
    let mut byte = [0];
    while answer.len() < 200 && answer.last() != Some(&b'\n') {
        match line.read(&mut byte) {
            Ok(0) => break,
            Ok(_) => answer.extend(byte),
            Err(error) if matches!(error.kind(), io::ErrorKind::TimedOut | io::ErrorKind::WouldBlock) => {
                break;
            }
            Err(error) => return Err(error),
        }
    }
    Ok(answer)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::devices::line_tests::Told;

    #[test]
    fn an_answer_is_a_line_of_text_or_as_much_as_comes() {
        use io::ErrorKind::{BrokenPipe, PermissionDenied, TimedOut, WouldBlock};
        let answer = |says: &[u8], then| ask(&mut Told { says: says.to_vec(), then }, b"p");
        assert_eq!(answer(b"24.9,24.9\nmore", PermissionDenied).unwrap(), b"24.9,24.9\n");
        for silent in [TimedOut, WouldBlock] {
            assert_eq!(answer(b"24.9", silent).unwrap(), b"24.9");
            assert_eq!(answer(b"", silent).unwrap(), b"");
        }
        // A device that never ends its line is cut short.
        assert_eq!(answer(&[b'7'; 500], PermissionDenied).unwrap(), [b'7'; 200]);
        assert_eq!(answer(b"24", PermissionDenied).unwrap_err().kind(), PermissionDenied);
        assert_eq!(answer(b"24", BrokenPipe).unwrap_err().kind(), BrokenPipe);
    }
}
