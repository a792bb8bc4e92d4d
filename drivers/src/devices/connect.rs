//! Why a sensor cannot be opened, and what opening one has in common.

use core::time::Duration;
use std::io;

use thiserror::Error;

use super::{Address, AddressError};
use crate::sensors::ati_rdt::{ClientError, RdtError};
use crate::sensors::dynpick::SensitivitiesError;
use crate::sensors::schunk_fts::FtsClientError;
use crate::sensors::{AxisCounts, BadAxisCounts};

/// How long a sensor waits for bytes or datagrams.
pub(crate) const WAIT: Duration = Duration::from_millis(200);
/// How long a sensor may take to answer.
pub(crate) const REPLY: Duration = Duration::from_secs(2);

/// Why a sensor cannot be opened.
///
/// ```
/// use fingertip_drivers::devices::{Address, devices, open};
///
/// let address = Address::parse("bota+tcp://127.0.0.1:1", devices())?;
/// let told = open(&address).unwrap_err().to_string();
/// assert!(told.starts_with("cannot connect to 127.0.0.1:1: "), "{told}");
/// assert!(told.ends_with("; is the sensor's server running there?"));
/// # Ok::<(), fingertip_drivers::devices::AddressError>(())
/// ```
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ConnectError {
    /// The address lacks something, or says what cannot be.
    #[error(transparent)]
    Address(#[from] AddressError),
    /// Counts per unit that cannot be.
    #[error(transparent)]
    Counts(#[from] BadAxisCounts),
    /// Counts per unit that cannot be.
    #[error(transparent)]
    RdtCounts(#[from] RdtError),
    /// The serial port cannot be opened.
    #[error(
        "cannot open {place} at {baud} baud: {source}; is the sensor plugged in, does nothing else use it, and may \
         you read it (group dialout)?"
    )]
    Port {
        /// The port.
        place: String,
        /// Its baud rate.
        baud: u32,
        /// Why not.
        source: serialport::Error,
    },
    /// The connection in place of a serial port cannot be made.
    #[error("cannot connect to {place}: {source}; is the sensor's server running there?")]
    Tcp {
        /// Host and port.
        place: String,
        /// Why not.
        source: io::Error,
    },
    /// The CAN interface cannot be opened.
    #[error("cannot open {place}: {source}; is the interface there and up (ip link set {place} up)?")]
    Can {
        /// The interface.
        place: String,
        /// Why not.
        source: io::Error,
    },
    /// The sensor cannot be told to stream.
    #[error("cannot tell the sensor to start: {0}")]
    Start(String),
    /// The page of an ATI sensor tells nothing that can be used.
    #[error(
        "cannot read the sensor's counts per newton from http://{page}/netftapi2.xml: {source}; state them in the \
         address: ?counts_per_N=1e6&counts_per_Nm=1e6"
    )]
    Page {
        /// Host and port.
        page: String,
        /// Why not.
        source: ClientError,
    },
    /// An ATI or OnRobot sensor cannot be reached.
    #[error("cannot reach {host}: {source}; check the address and the network")]
    Rdt {
        /// Host and port.
        host: String,
        /// Why not.
        source: ClientError,
    },
    /// A SCHUNK sensor cannot be started.
    #[error(
        "cannot start {host}, with samples to UDP port {port} here: {source}; check the address and the ports"
    )]
    Fts {
        /// Host and port.
        host: String,
        /// The local port.
        port: u16,
        /// Why not.
        source: FtsClientError,
    },
    /// A DynPick cannot be asked for its sensitivities.
    #[error("cannot ask for the sensitivities: {0}")]
    Ask(io::Error),
    /// A DynPick does not tell its sensitivities.
    #[error(
        "the sensor does not tell its sensitivities ({0}); state them from its data sheet: \
         ?counts_per_N=24.9&counts_per_Nm=1664"
    )]
    Sensitivities(SensitivitiesError),
    /// CAN elsewhere than on Linux.
    #[error("CAN can be spoken on Linux only (SocketCAN)")]
    NoCan,
    /// It is not opened by its address alone.
    #[error("{name} is not opened by an address")]
    NotHere {
        /// The device.
        name: &'static str,
    },
}

/// Both of two options that belong together, or none.
pub(crate) fn counts_per_unit(address: &Address) -> Result<Option<[f64; 2]>, AddressError> {
    let (first, second) = ("counts_per_N", "counts_per_Nm");
    match (address.positive(first)?, address.positive(second)?) {
        (Some(force), Some(torque)) => Ok(Some([force, torque])),
        (None, None) => Ok(None),
        _ => Err(AddressError::Apart { first, second }),
    }
}

/// Counts per unit that the address states.
pub(crate) fn counts(address: &Address) -> Result<Option<AxisCounts>, ConnectError> {
    let uniform = |[force, torque]: [f64; 2]| AxisCounts::uniform(force, torque);
    Ok(counts_per_unit(address)?.map(uniform).transpose()?)
}

#[cfg(test)]
mod tests {
    use super::super::{Address, devices, open};
    use super::counts;
    use crate::sensors::AxisCounts;

    fn parse(text: &str) -> Address {
        Address::parse(text, devices()).unwrap()
    }

    #[test]
    fn what_an_address_lacks_or_has_too_much_is_named() {
        for (address, expected) in [
            ("robotous:///dev/null?counts_per_N=5", "belong together"),
            ("ati://127.0.0.1:9?counts_per_N=5", "belong together"),
            ("dynpick:///no/such?counts_per_N=5&counts_per_Nm=7", "cannot open /no/such at 921600 baud"),
            ("dynpick:///no/such", "cannot open /no/such at 921600 baud"),
            ("robotous:///no/such", "cannot open /no/such at 115200 baud"),
            ("bota:///no/such?baud=9600", "cannot open /no/such at 9600 baud"),
            ("bota:///no/such?rate_Hz=0", "rate_Hz=0 must be above 0"),
            ("optoforce:///no/such?counts_per_N=5", "counts_per_Nm is needed"),
            ("optoforce:///no/such?counts_per_N=5&counts_per_Nm=5&rate_Hz=50", "1000, 333, 100, 30 and 10"),
            ("optoforce:///no/such?counts_per_N=5&counts_per_Nm=5&rate_Hz=333", "at 1000000 baud"),
            ("resense:///no/such?greatest_N=5", "greatest_Nm is needed"),
            ("resense:///no/such?greatest_N=5&greatest_Nm=1&request=3", "two for each byte"),
            ("resense:///no/such?greatest_N=5&greatest_Nm=1", "at 2000000 baud"),
            ("bota+tcp://127.0.0.1:1", "cannot connect to 127.0.0.1:1"),
        ] {
            let error = open(&parse(address)).err().unwrap().to_string();
            assert!(error.contains(expected), "{address}: {error}");
        }
        let both = parse("robotous:///x?counts_per_N=5&counts_per_Nm=7");
        assert_eq!(counts(&both).unwrap(), Some(AxisCounts::uniform(5.0, 7.0).unwrap()));
    }
}
