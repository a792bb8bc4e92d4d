//! What the tests of several crates share. Not published.
#![allow(clippy::panic, clippy::expect_used)]

extern crate alloc;

mod block_on;
pub mod drawn;
pub mod mcap;
mod moving_body;
mod recordings;
mod unchanged;
mod worst;

pub use block_on::block_on;
pub use moving_body::{Moved, MovingBody};
pub use recordings::{recording, recording_text};
pub use unchanged::Unchanged;
pub use worst::Worst;
