//! The entry of OptoForce's sensors among the devices.

use super::{Configuration, Filter, OptoForceDecoder, Rate, SimulatedOptoForce};
use crate::devices::{
    Address, ConnectError, Device, DeviceOption, Entry, Link, OpenSensor, SerialSimulator, Simulator,
    open_line, streaming, wrong,
};
use crate::sensors::AxisCounts;

/// Where its counts per unit are to be had.
const REPORT: &str = "it stands in the sensor's sensitivity report";

pub(crate) const ENTRY: Entry = Entry {
    device: Device {
        name: "optoforce",
        title: "OptoForce USB",
        link: Link::Serial { baud: 1_000_000 },
        place: Some("/dev/ttyACM0"),
        options: &[
            DeviceOption::needed("counts_per_N", "100", REPORT),
            DeviceOption::needed("counts_per_Nm", "10000", REPORT),
            DeviceOption::new("rate_Hz", "1000", "sets its rate: 1000, 333, 100, 30 or 10"),
        ],
        converter: None,
        simulator: Some(Simulator::Serial(|_| SerialSimulator {
            device: SimulatedOptoForce::new(HEX).into(),
            options: "?counts_per_N=100&counts_per_Nm=10000".to_owned(),
        })),
    },
    open,
};

/// Those of a HEX.
const HEX: AxisCounts = AxisCounts::of_data_sheet(100.0, 10_000.0);

fn open(address: &Address) -> Result<OpenSensor, ConnectError> {
    let counts = AxisCounts::uniform(address.needed("counts_per_N")?, address.needed("counts_per_Nm")?)?;
    let rate = match address.whole::<u32>("rate_Hz")? {
        None => None,
        Some(1000) => Some(Rate::Hz1000),
        Some(333) => Some(Rate::Hz333),
        Some(100) => Some(Rate::Hz100),
        Some(30) => Some(Rate::Hz30),
        Some(10) => Some(Rate::Hz10),
        Some(other) => {
            let problem = "cannot be: the sensor has 1000, 333, 100, 30 and 10";
            return Err(wrong("rate_Hz", &other.to_string(), problem).into());
        }
    };
    let start = rate.map_or_else(Vec::new, |rate| {
        Configuration { rate, filter: Filter::None, zero: false }.emit().to_vec()
    });
    streaming(open_line(address)?, OptoForceDecoder::new(counts), &start, |decoder| Some(decoder.missing()))
}
