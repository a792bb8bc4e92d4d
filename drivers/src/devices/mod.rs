//! What devices there are, and how a user writes where one is: one list, which the command's help, its servers of
//! simulated sensors and the tables of the documentation read.
//!
//! Each device has its entry beside its code. An [`Address`] names a device and where it is; [`open`] opens a
//! sensor, and [`Device::simulator`] is the sensor without hardware.
//!
//! ```
//! use fingertip_drivers::devices::{Address, devices};
//!
//! let address = Address::parse("ati://192.168.1.1?rate_Hz=7000", devices())?;
//! assert_eq!(address.device().title, "ATI Net F/T, Axia");
//! let error = Address::parse("ati://192.168.1.1?rate=7000", devices()).unwrap_err();
//! assert!(error.to_string().contains("knows no “rate”"));
//! # Ok::<(), fingertip_drivers::devices::AddressError>(())
//! ```

mod address;
mod connect;
mod device;
mod entry;
mod line;
mod list;
mod losses;
mod opened;
mod simulator;
mod timed;

pub use address::{Address, AddressError};
pub use connect::ConnectError;
pub use device::{Device, DeviceOption, Link};
pub use list::{devices, open};
pub use losses::Losses;
pub use opened::{OpenSensor, SensorFault};
pub use simulator::{NetworkSimulator, SerialSimulator, ServeError, Served, Serving, Simulator};

pub(crate) use address::wrong;
pub(crate) use connect::{REPLY, WAIT, counts, counts_per_unit};
pub(crate) use entry::Entry;
#[cfg(test)]
pub(crate) use line::tests as line_tests;
pub(crate) use line::{Line, asked, open_line, streaming};
pub(crate) use opened::{Opened, source};
pub(crate) use timed::Timed;
