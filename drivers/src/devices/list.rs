//! The list of devices.

use super::address::Address;
use super::connect::ConnectError;
use super::device::Device;
use super::entry::Entry;
use super::opened::OpenSensor;
use crate::{converters, sensors};

/// Sensors on a wire, in the order of the help.
const SENSORS: [&Entry; 9] = [
    &sensors::ati_rdt::device::NET_FT,
    &sensors::ati_rdt::device::ONROBOT,
    &sensors::schunk_fts::device::ENTRY,
    &sensors::bota_serial::device::ENTRY,
    &sensors::robotous::device::SERIAL,
    &sensors::robotous::device::CAN,
    &sensors::dynpick::device::ENTRY,
    &sensors::optoforce::device::ENTRY,
    &sensors::resense::device::ENTRY,
];

/// Converters, which firmware opens.
const CONVERTERS: [&Device; 5] = [
    &converters::ads131m::DEVICE,
    &converters::ads1256::DEVICE,
    &converters::mcp3564::DEVICE,
    &converters::hx711::DEVICE,
    &converters::nau7802::DEVICE,
];

/// Both, as the one list that it is for those who read it.
const DEVICES: [&Device; SENSORS.len() + CONVERTERS.len()] = {
    let mut all = [CONVERTERS[0]; SENSORS.len() + CONVERTERS.len()];
    let mut number = 0;
    while number < all.len() {
        all[number] =
            if number < SENSORS.len() { &SENSORS[number].device } else { CONVERTERS[number - SENSORS.len()] };
        number += 1;
    }
    all
};

/// All devices: sensors on a wire in the order of the help, then converters.
#[must_use]
pub const fn devices() -> &'static [&'static Device] {
    &DEVICES
}

/// Opens the sensor at an address and lets it stream. No zero is set in any sensor.
///
/// # Errors
/// [`ConnectError`].
pub fn open(address: &Address) -> Result<OpenSensor, ConnectError> {
    let name = address.device().name;
    let entry = SENSORS.iter().find(|entry| entry.device.name == name);
    (entry.ok_or(ConnectError::NotHere { name })?.open)(address)
}
