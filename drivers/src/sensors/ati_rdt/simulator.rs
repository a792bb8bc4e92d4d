//! A sensor that is not there: it answers as a Net F/T does, and a link that loses, repeats,
//! swaps and cuts.

use core::sync::atomic::Ordering;
use core::time::Duration;
use std::io;
use std::net::{ToSocketAddrs, UdpSocket};

use super::wire::{Command, Record, Request};
use crate::sensors::datagram_link::FaultPlan;
use crate::sensors::{Pace, Served, SimulatedSensor};

/// The device and its link without a socket: requests in, datagrams out.
pub type SimulatedNetFt = SimulatedSensor<NetFt>;

/// What is a Net F/T's own.
///
/// ```
/// use fingertip_drivers::sensors::FaultPlan;
/// use fingertip_drivers::sensors::ati_rdt::{Command, RecordPacket, Request, SimulatedNetFt};
///
/// let mut sensor = SimulatedNetFt::new(FaultPlan::default());
/// sensor.sample([0, 0, -5, 0, 0, 0]);
/// // Its zero is what it felt then; it streams two records.
/// sensor.request(&Request { command: Command::Bias, count: 0 }.emit());
/// sensor.request(&Request { command: Command::Stream, count: 2 }.emit());
/// for force in [-7, -8, -9] {
///     sensor.sample([0, 0, force, 0, 0, 0]);
/// }
/// let mut forces = Vec::new();
/// while let Some(datagram) = sensor.datagram() {
///     forces.push(RecordPacket::new_checked(&datagram)?.counts()[2]);
/// }
/// assert_eq!(forces, [-2, -3]);
/// # Ok::<(), fingertip_drivers::sensors::ati_rdt::WireError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct NetFt {
    left: Option<u32>,
    rdt_sequence: u32,
    ft_sequence: u32,
    bias: [i32; 6],
    counts: [i32; 6],
}

impl SimulatedSensor<NetFt> {
    /// A sensor at rest behind a link with faults.
    #[must_use]
    pub fn new(faults: FaultPlan) -> Self {
        Self::resting(faults, 0, NetFt::default())
    }

    /// Lets the record count begin at a number, to come near its wrap-around.
    #[must_use]
    pub const fn counting_from(mut self, rdt_sequence: u32) -> Self {
        self.device.rdt_sequence = rdt_sequence;
        self
    }

    /// Takes a request; bytes that are none are ignored, as the device does.
    pub fn request(&mut self, bytes: &[u8]) {
        let Ok(Request { command, count }) = Request::parse(bytes) else { return };
        match command {
            Command::Stop => self.streaming = false,
            Command::Stream | Command::StreamBuffered => {
                self.streaming = true;
                self.device.left = (count > 0).then_some(count);
            }
            Command::Bias => self.device.bias = self.device.counts,
        }
    }

    /// The sensor samples a load, in counts. While it streams, this sends a record.
    pub fn sample(&mut self, counts: [i32; 6]) {
        let device = &mut self.device;
        device.counts = counts;
        device.ft_sequence = device.ft_sequence.wrapping_add(1);
        if !self.streaming {
            return;
        }
        if let Some(left) = &mut device.left {
            *left = left.saturating_sub(1);
            self.streaming = *left > 0;
        }
        device.rdt_sequence = device.rdt_sequence.wrapping_add(1);
        let mut biased = counts;
        for (count, bias) in biased.iter_mut().zip(device.bias) {
            *count = count.saturating_sub(bias);
        }
        let record = Record {
            rdt_sequence: device.rdt_sequence,
            ft_sequence: device.ft_sequence,
            status: self.status,
            counts: biased,
        };
        self.send(&record.emit());
    }

    /// Number of the newest record. It counts those that the link then lost, too.
    #[must_use]
    pub const fn rdt_sequence(&self) -> u32 {
        self.device.rdt_sequence
    }
}

/// A [`SimulatedNetFt`] that serves on a UDP port in a thread of its own, until it is dropped.
pub type RdtServer = Served<SimulatedNetFt>;

impl Served<SimulatedNetFt> {
    /// Serves on an address (port 0 for any free one; the loopback interface unless you know what
    /// you do). `load` gives the counts of each sample by its number, which begins anew with each client;
    /// one is sent every `period`.
    ///
    /// # Errors
    /// If the address cannot be had.
    pub fn start(
        address: impl ToSocketAddrs,
        mut sensor: SimulatedNetFt,
        period: Duration,
        mut load: impl FnMut(u64) -> [i32; 6] + Send + 'static,
    ) -> io::Result<Self> {
        let socket = UdpSocket::bind(address)?;
        socket.set_nonblocking(true)?;
        let address = socket.local_addr()?;
        Self::by(address, "simulated Net F/T", move |stopped| {
            let mut client = None;
            let mut pace = Pace::new(period);
            let mut number = 0;
            while !stopped.load(Ordering::Relaxed) {
                let mut bytes = [0; 64];
                // The device serves one client: whoever asked last.
                while let Ok((length, from)) = socket.recv_from(&mut bytes) {
                    sensor.request(bytes.get(..length).unwrap_or_default());
                    if client.replace(from) != Some(from) {
                        number = 0;
                    }
                }
                if !pace.is_due() {
                    continue;
                }
                sensor.sample(load(number));
                number += 1;
                while let (Some(datagram), Some(client)) = (sensor.datagram(), client) {
                    match socket.send_to(&datagram, client) {
                        // A client that has gone, or is too slow, is no trouble of the sensor's.
                        Ok(_) | Err(_) => {}
                    }
                }
            }
            // What was asked before it was stopped is still heard.
            let mut bytes = [0; 64];
            while let Ok(length) = socket.recv(&mut bytes) {
                sensor.request(bytes.get(..length).unwrap_or_default());
            }
            sensor
        })
    }
}
