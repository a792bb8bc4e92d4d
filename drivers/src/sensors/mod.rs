//! Force/torque sensors on a wire: over Ethernet, a serial line or CAN.
//!
//! Each has a module and a feature of its own, and with the feature `simulators` a simulator that speaks its
//! protocol.

#[cfg(feature = "ati-rdt")]
pub mod ati_rdt;
#[cfg(any(feature = "robotous", feature = "dynpick", feature = "optoforce"))]
mod axis_counts;
#[cfg(feature = "bota-serial")]
pub mod bota_serial;
#[cfg(all(feature = "simulators", any(feature = "ati-rdt", feature = "schunk-fts")))]
mod datagram_link;
#[cfg(all(feature = "std", any(feature = "ati-rdt", feature = "schunk-fts")))]
mod datagram_socket;
#[cfg(feature = "dynpick")]
pub mod dynpick;
pub mod line;
#[cfg(feature = "optoforce")]
pub mod optoforce;
#[cfg(feature = "simulators")]
mod pace;
#[cfg(feature = "resense")]
pub mod resense;
#[cfg(feature = "robotous")]
pub mod robotous;
#[cfg(feature = "schunk-fts")]
pub mod schunk_fts;
#[cfg(any(feature = "ati-rdt", feature = "schunk-fts"))]
mod sequence_watch;
#[cfg(all(feature = "simulators", any(feature = "ati-rdt", feature = "schunk-fts")))]
mod served;
#[cfg(all(feature = "simulators", any(feature = "ati-rdt", feature = "schunk-fts")))]
mod simulated_sensor;

#[cfg(any(feature = "robotous", feature = "dynpick", feature = "optoforce"))]
pub use axis_counts::{AxisCounts, BadAxisCounts};
#[cfg(all(feature = "simulators", any(feature = "ati-rdt", feature = "schunk-fts")))]
pub use datagram_link::FaultPlan;
#[cfg(feature = "simulators")]
pub use pace::Pace;
#[cfg(any(feature = "ati-rdt", feature = "schunk-fts"))]
pub use sequence_watch::{Arrival, LinkStatistics, SequenceWatch};
#[cfg(all(feature = "simulators", any(feature = "ati-rdt", feature = "schunk-fts")))]
pub use served::Served;
#[cfg(all(feature = "simulators", any(feature = "ati-rdt", feature = "schunk-fts")))]
pub use simulated_sensor::SimulatedSensor;
