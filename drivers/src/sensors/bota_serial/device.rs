//! The entry of Bota Systems' sensors among the devices.

use super::{BotaDecoder, SimulatedBota};
use crate::devices::{
    Address, ConnectError, Device, DeviceOption, Entry, Link, OpenSensor, SerialSimulator, Simulator, Timed,
    open_line, streaming,
};

pub(crate) const ENTRY: Entry = Entry {
    device: Device {
        name: "bota",
        title: "Bota Systems serial",
        link: Link::Serial { baud: 460_800 },
        place: Some("/dev/ttyUSB0"),
        options: &[DeviceOption::new(
            "rate_Hz",
            "800",
            "as it is set: lost samples are counted by their times",
        )],
        converter: None,
        simulator: Some(Simulator::Serial(|rate| SerialSimulator {
            device: SimulatedBota::new(rate).into(),
            options: format!("?rate_Hz={rate}"),
        })),
    },
    open,
};

fn open(address: &Address) -> Result<OpenSensor, ConnectError> {
    let rate = address.positive("rate_Hz")?;
    let sensor = streaming(open_line(address)?, BotaDecoder::new(), &[], |_| None)?;
    Ok(match rate {
        Some(rate) => OpenSensor::new(Timed::new(sensor, rate)),
        None => sensor,
    })
}
