//! From counts of a converter to strain: Wheatstone bridges with strain gauges.
//!
//! ```text
//! counts ──▶ volts per volt of excitation ──▶ relative change of resistance ──▶ strain
//!       CountScale                      BridgeCircuit                  gauge factor
//! ```
//!
//! * [`BridgeCircuit`]: quarter, half and full bridges, with their exact, non-linear relation between
//!   change of resistance and output.
//! * [`BridgeChannel`]: one bridge at one input of the converter.
//! * [`BridgeFrontEnd`]: all bridges of a fingertip. [`strain`](BridgeFrontEnd::strain) is what the hot path
//!   needs; [`strain_with_bounds`](BridgeFrontEnd::strain_with_bounds) says besides how far off it may be,
//!   and which channels are at an end of the range.
//! * [`Bridged`]: a source of counts that becomes a source of strain. With
//!   [`Solved`](crate::middleware::Solved) and a calibration it becomes a source of wrenches.
//!
//! The zero of a bridge is not in here: a bridge at rest is out of balance by more than it is loaded
//! later, and by how much is for the tare to say.

mod channel;
mod circuit;
mod front_end;
mod source;

pub use channel::{BridgeChannel, CountScale, Excitation};
pub use circuit::{BadPoissonRatio, BridgeCircuit};
pub use front_end::{BridgeFault, BridgeFrontEnd, BridgeFrontEndError, Strains};
pub use source::{Bridged, BridgedError};
