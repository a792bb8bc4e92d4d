//! A sensor that is not there: it answers as a Net F/T does, and a link that loses, repeats,
//! swaps and cuts.

use core::sync::atomic::Ordering;
use core::time::Duration;
use std::io;
use std::net::{ToSocketAddrs, UdpSocket};
use std::time::Instant;

use super::wire::{Command, Record, Request};
use crate::LinkStatistics;
use crate::Served;
use crate::datagram_link::{DatagramLink, FaultPlan};

/// The device and its link without a socket: requests in, datagrams out.
#[derive(Clone, Debug)]
pub struct SimulatedNetFt {
    link: DatagramLink,
    streaming: bool,
    left: Option<u32>,
    rdt_sequence: u32,
    ft_sequence: u32,
    status: u32,
    bias: [i32; 6],
    counts: [i32; 6],
}

impl SimulatedNetFt {
    /// A sensor at rest behind a link with faults.
    #[must_use]
    pub fn new(faults: FaultPlan) -> Self {
        Self {
            link: DatagramLink::new(faults),
            streaming: false,
            left: None,
            rdt_sequence: 0,
            ft_sequence: 0,
            status: 0,
            bias: [0; 6],
            counts: [0; 6],
        }
    }

    /// Lets the record count begin at a number, to come near its wrap-around.
    #[must_use]
    pub const fn counting_from(mut self, rdt_sequence: u32) -> Self {
        self.rdt_sequence = rdt_sequence;
        self
    }

    /// Sets the status word of all records from now on.
    pub const fn set_status(&mut self, status: u32) {
        self.status = status;
    }

    /// Takes a request; bytes that are none are ignored, as the device does.
    pub fn request(&mut self, bytes: &[u8]) {
        let Ok(Request { command, count }) = Request::parse(bytes) else { return };
        match command {
            Command::Stop => self.streaming = false,
            Command::Stream | Command::StreamBuffered => {
                self.streaming = true;
                self.left = (count > 0).then_some(count);
            }
            Command::Bias => self.bias = self.counts,
        }
    }

    /// Whether records are being sent.
    #[must_use]
    pub const fn is_streaming(&self) -> bool {
        self.streaming
    }

    /// The sensor samples a load, in counts. While it streams, this sends a record.
    pub fn sample(&mut self, counts: [i32; 6]) {
        self.counts = counts;
        self.ft_sequence = self.ft_sequence.wrapping_add(1);
        if !self.streaming {
            return;
        }
        if let Some(left) = &mut self.left {
            *left = left.saturating_sub(1);
            self.streaming = *left > 0;
        }
        self.rdt_sequence = self.rdt_sequence.wrapping_add(1);
        let mut biased = counts;
        for (count, bias) in biased.iter_mut().zip(self.bias) {
            *count = count.saturating_sub(bias);
        }
        let record = Record {
            rdt_sequence: self.rdt_sequence,
            ft_sequence: self.ft_sequence,
            status: self.status,
            counts: biased,
        };
        self.link.send(&record.emit());
    }

    /// Number of the newest record. It counts those that the link then lost, too.
    #[must_use]
    pub const fn rdt_sequence(&self) -> u32 {
        self.rdt_sequence
    }

    /// The next datagram on the link.
    pub fn datagram(&mut self) -> Option<Vec<u8>> {
        self.link.receive()
    }

    /// What was done to the records so far: `received` stays zero.
    #[must_use]
    pub const fn injected(&self) -> &LinkStatistics {
        self.link.injected()
    }
}

/// A [`SimulatedNetFt`] that serves on a UDP port in a thread of its own, until it is dropped.
pub type RdtServer = Served<SimulatedNetFt>;

impl Served<SimulatedNetFt> {
    /// Serves on an address (port 0 for any free one; the loopback interface unless you know what
    /// you do). `load` gives the counts of each sample by its number, which begins anew with each client; one is sent every `period`.
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
            let mut next = Instant::now();
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
                let now = Instant::now();
                if now < next {
                    std::thread::sleep((next - now).min(Duration::from_millis(1)));
                    continue;
                }
                next += period;
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
