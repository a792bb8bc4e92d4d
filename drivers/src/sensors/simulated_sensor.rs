//! What simulated sensors that send datagrams have in common.

use alloc::vec::Vec;

use crate::sensors::LinkStatistics;
use crate::sensors::datagram_link::{DatagramLink, FaultPlan};

/// A sensor that is not there, and its link, without sockets: requests and loads in, datagrams out. `Device` is
/// what is its own: its numbering, its zero, its load.
///
/// ```
/// use fingertip_drivers::sensors::FaultPlan;
/// use fingertip_drivers::sensors::ati_rdt::{Command, Record, RecordPacket, Request, SimulatedNetFt};
///
/// let mut sensor = SimulatedNetFt::new(FaultPlan::default());
/// sensor.request(&Request { command: Command::Stream, count: 0 }.emit());
/// // From now on it reports a fault.
/// sensor.set_status(0x8000_0001);
/// sensor.sample([0; 6]);
/// let datagram = sensor.datagram().unwrap();
/// assert_eq!(Record::parse(&RecordPacket::new_checked(&datagram)?).status, 0x8000_0001);
/// # Ok::<(), fingertip_drivers::sensors::ati_rdt::WireError>(())
/// ```
#[derive(Clone, Debug)]
pub struct SimulatedSensor<Device> {
    link: DatagramLink,
    pub(crate) streaming: bool,
    pub(crate) status: u32,
    pub(crate) device: Device,
    sent: u64,
}

impl<Device> SimulatedSensor<Device> {
    /// Not streaming, behind a link with faults.
    pub(crate) fn resting(faults: FaultPlan, status: u32, device: Device) -> Self {
        Self { link: DatagramLink::new(faults), streaming: false, status, device, sent: 0 }
    }

    /// Puts a datagram on the link.
    pub(crate) fn send(&mut self, datagram: &[u8]) {
        self.sent += 1;
        self.link.send(datagram);
    }

    /// Sets the status of all samples from now on.
    pub const fn set_status(&mut self, status: u32) {
        self.status = status;
    }

    /// Whether datagrams are being sent.
    #[must_use]
    pub const fn is_streaming(&self) -> bool {
        self.streaming
    }

    /// How many datagrams were put on the link, those that it lost among them.
    #[must_use]
    pub const fn sent(&self) -> u64 {
        self.sent
    }

    /// The next datagram that arrives at the other end.
    pub fn datagram(&mut self) -> Option<Vec<u8>> {
        self.link.receive()
    }

    /// What was done to the datagrams so far: `received` stays zero.
    #[must_use]
    pub const fn injected(&self) -> &LinkStatistics {
        self.link.injected()
    }
}
