//! The entries of Robotous sensors among the devices.

use super::{Request, RobotousDecoder, SimulatedRft};
use crate::devices::{
    Address, ConnectError, Device, DeviceOption, Entry, Link, SerialSimulator, Simulator, counts, open_line,
    streaming,
};
use crate::sensors::AxisCounts;

const COUNTS: [DeviceOption; 2] = [
    DeviceOption::new("counts_per_N", "50", "without it that of the RFT60"),
    DeviceOption::new("counts_per_Nm", "2000", "as counts_per_N"),
];

pub(crate) const SERIAL: Entry = Entry {
    device: Device {
        name: "robotous",
        title: "Robotous RFT",
        link: Link::Serial { baud: 115_200 },
        place: Some("/dev/ttyUSB0"),
        options: &COUNTS,
        converter: None,
        simulator: Some(Simulator::Serial(|_| SerialSimulator {
            device: SimulatedRft::new(RFT60).into(),
            options: String::new(),
        })),
    },
    open: |address| {
        let decoder = RobotousDecoder::new(stated_counts(address)?);
        streaming(open_line(address)?, decoder, &Request::Stream.emit_serial(), |_| None)
    },
};

/// What the identifiers are.
const IDENTIFIER: &str = "the identifier as the sensor is set, hexadecimal";

pub(crate) const CAN: Entry = Entry {
    device: Device {
        name: "robotous+can",
        title: "Robotous RFT on CAN (Linux)",
        link: Link::Can,
        place: Some("can0"),
        options: &[
            DeviceOption::needed("first", "1", IDENTIFIER),
            DeviceOption::needed("second", "2", IDENTIFIER),
            DeviceOption::needed("request", "64", IDENTIFIER),
            COUNTS[0],
            COUNTS[1],
        ],
        converter: None,
        simulator: Some(Simulator::OnABus),
    },
    #[cfg(target_os = "linux")]
    open: |address| super::socketcan::open(address, stated_counts(address)?),
    #[cfg(not(target_os = "linux"))]
    open: |_| Err(ConnectError::NoCan),
};

/// Those of the RFT60.
const RFT60: AxisCounts = AxisCounts::of_data_sheet(50.0, 2000.0);

/// Counts of the RFT60 unless others are stated.
fn stated_counts(address: &Address) -> Result<AxisCounts, ConnectError> {
    Ok(counts(address)?.unwrap_or(RFT60))
}
