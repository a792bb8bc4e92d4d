//! ATI Net F/T and Axia over Ethernet: raw data transfer (RDT) in UDP datagrams. OnRobot
//! (OptoForce) EtherDAQ sensors speak the same.
//!
//! Three layers, each usable alone: the wire format ([`Request`], [`RecordPacket`], [`Record`],
//! `no_std`), the [`Receiver`] that tells news from repetitions and counts what was lost
//! (`no_std`, no I/O), and the `RdtClient` over a UDP socket (feature `std`). With the feature
//! `simulation` a `SimulatedNetFt` answers requests as the device does and injects faults.
//!
//! From the manufacturer's manual 9620-05-NET FT, section "UDP Interface Using RDT". What a
//! sensor's numbers mean stands on its page `netftapi2.xml`: read it with `Configuration` (feature
//! `std`), or ask for it with `RdtClient::configuration`. Not here: setting the configuration, CAN and
//! EtherNet/IP.

#[cfg(feature = "devices")]
pub(crate) mod device;
#[cfg(feature = "devices")]
mod page_server;
mod receiver;
mod wire;

#[cfg(feature = "std")]
mod client;
#[cfg(feature = "std")]
mod configuration;
#[cfg(feature = "std")]
mod deadline;
#[cfg(feature = "simulators")]
mod simulator;

pub use receiver::{CountsPerUnit, RdtError, Receiver};
pub use wire::{Command, Record, RecordPacket, Request, WireError, records};

#[cfg(feature = "simulators")]
pub use crate::sensors::datagram_link::FaultPlan;
#[cfg(feature = "std")]
pub use client::{ClientError, RdtClient};
#[cfg(feature = "std")]
pub use configuration::{Configuration, ConfigurationError};
#[cfg(feature = "simulators")]
pub use simulator::{NetFt, RdtServer, SimulatedNetFt};
