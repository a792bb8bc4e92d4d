//! What the gauges say: where they sit, the sensor matrix, and which one lies.

mod calibrated_region;
mod consistency;
pub(crate) mod false_alarm;
pub mod gauge_layout;
mod sensor_matrix;

pub use calibrated_region::{BadRegion, CalibratedRegion, WithinRegion};
pub use consistency::{BadCheck, ConsistencyCheck, DriftMonitor, Fault, Verdict};
pub use sensor_matrix::{SensorMatrix, SensorMatrixError};
