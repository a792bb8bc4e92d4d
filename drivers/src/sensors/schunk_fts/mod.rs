//! SCHUNK FTS force/torque sensors over Ethernet: datagrams of samples on UDP port
//! [`UDP_PORT`], commands over TCP port [`TCP_PORT`].
//!
//! Layers, each usable alone and without I/O: the wire format ([`Packet`], [`FtsSample`],
//! [`Command`], [`CommandAnswer`]) and the [`FtsReceiver`], which tells news from repetitions, counts
//! what was lost and refuses samples whose status is not clean. With the feature `std` a `FtsClient` puts them on
//! sockets; with `simulation` a `SimulatedFts` and its `FtsServer` are the other end.
//!
//! After the manufacturer's own published client and dummy. Of the status, bit 0 (ready) and bit 1
//! (data invalid) are known from there; every other bit is taken for a fault. Reading and setting
//! parameters is not here.

#[cfg(feature = "std")]
mod client;
#[cfg(feature = "devices")]
pub(crate) mod device;
mod receiver;
#[cfg(feature = "simulators")]
mod simulator;
mod wire;

pub use receiver::{FtsFault, FtsReceiver};
pub use wire::{Command, CommandAnswer, FtsSample, FtsWireError, Packet, TCP_PORT, UDP_PORT, emit_packet};

#[cfg(feature = "std")]
pub use client::{FtsClient, FtsClientError};
#[cfg(feature = "simulators")]
pub use simulator::{Fts, FtsServer, SimulatedFts};
