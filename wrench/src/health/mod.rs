//! What one channel shows of its own health, reading by reading and without heap.

mod allan;
mod channel_limits;
mod channel_monitor;
mod quiet_noise;
mod resolution;

pub use allan::AllanVariance;
pub use channel_limits::{BadLimits, ChannelFault, ChannelLimits};
pub use channel_monitor::ChannelMonitor;
pub use resolution::Resolution;
