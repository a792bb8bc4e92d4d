//! What a device puts into the list.

use super::address::Address;
use super::connect::ConnectError;
use super::device::Device;
use super::opened::OpenSensor;

/// A sensor that an address can name, and what opens it.
pub(crate) struct Entry {
    /// The device.
    pub(crate) device: Device,
    /// Opens one, and lets it stream.
    pub(crate) open: fn(&Address) -> Result<OpenSensor, ConnectError>,
}
