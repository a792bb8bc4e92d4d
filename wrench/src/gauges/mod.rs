//! What the gauges say: where they sit, the sensor matrix, and channels that are at fault.

mod channels;
mod consistency;
pub(crate) mod false_alarm;
pub mod gauge_layout;
mod sensor_matrix;

pub use channels::{BadLimits, ChannelFault, ChannelLimits, ChannelMonitor};
pub use consistency::{BadCheck, ConsistencyCheck, DriftMonitor, Fault, Verdict};
pub use sensor_matrix::{SensorMatrix, SensorMatrixError};
