//! The entry of the simulated fingertip among the devices.

use fingertip_drivers::devices::{Device, DeviceOption};

/// The simulated fingertip, at the address `sim`. Whoever lists it opens it, as a [`SimulatedFingertip`](crate::SimulatedFingertip) that plays
/// the [`standard_session`](crate::standard_session).
///
/// ```
/// assert_eq!(fingertip_simulation::DEVICE.example().as_deref(), Some("sim"));
/// ```
pub const DEVICE: Device = Device::in_program(
    "sim",
    "the simulated fingertip, in this process",
    &[
        DeviceOption::new("seed", "1", "of its noise"),
        DeviceOption::new("rate_Hz", "1000", "samples a second"),
    ],
);
