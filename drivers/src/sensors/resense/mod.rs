//! Resense (Wittenstein) HEX force/torque sensors on a serial line (2 000 000 baud, 8N1).
//!
//! Two layers without I/O: the wire format ([`Reading`]) and the [`ResenseDecoder`], to be put on a
//! sensor of the module [`line`](crate::sensors::line).
//!
//! **The format has neither a mark where a reading begins nor a checksum**: 28 bytes, seven numbers,
//! again and again. After one lost byte all readings would be wrong, and after four the numbers would
//! even look right, one place along. So the decoder never guesses: it takes the first byte after
//! [`restart`](crate::sensors::line::LineDecoder::restart) for the beginning, and once a reading is impossible
//! (not finite, beyond the limits that you state, a temperature that jumps) it gives errors until it is
//! restarted. Restart it when the line has been silent, or before you ask for a reading. Bytes damaged
//! such that the numbers stay possible cannot be noticed; state how much they can change from one reading to
//! the next, and what goes unnoticed is off by no more.
//!
//! **Losses of whole readings cannot be noticed** while the sensor streams, nor can repetitions and swaps, since
//! readings have neither number nor time. [`LineStatistics`](crate::sensors::line::LineStatistics) counts what was refused
//! and never claims that nothing was lost. To know, ask for each reading, and count the answers that do not come;
//! on the command line that is `?request=` in the sensor's address.
//!
//! How a reading is asked for differs between versions of the electronics and could not be confirmed
//! from a public source; it is left to the user.

mod decoder;
#[cfg(feature = "devices")]
pub(crate) mod device;
#[cfg(feature = "simulators")]
mod simulator;
mod wire;

pub use decoder::{Limits, ResenseDecoder, ResenseFault};
#[cfg(feature = "simulators")]
pub use simulator::SimulatedResense;
pub use wire::Reading;
