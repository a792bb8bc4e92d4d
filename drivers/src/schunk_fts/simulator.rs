//! A sensor that is not there: it answers commands and sends datagrams, over a link with faults.

use core::net::SocketAddr;
use core::sync::atomic::Ordering;
use core::time::Duration;
use std::io::{self, Read, Write};
use std::net::{TcpListener, TcpStream, ToSocketAddrs, UdpSocket};
use std::time::Instant;

use super::wire::{Command, CommandAnswer, FtsSample, emit_packet};
use crate::LinkStatistics;
use crate::Served;
use crate::datagram_link::{DatagramLink, FaultPlan};

/// The device and its link without sockets: commands and loads in, answers and datagrams out. One sample goes
/// into a datagram.
#[derive(Clone, Debug)]
pub struct SimulatedFts {
    link: DatagramLink,
    streaming: bool,
    counter: u16,
    id: u8,
    status: u32,
    zero: [f32; 6],
    components: [f32; 6],
}

impl SimulatedFts {
    /// A sensor at rest behind a link with faults.
    #[must_use]
    pub fn new(faults: FaultPlan) -> Self {
        Self {
            link: DatagramLink::new(faults),
            streaming: false,
            counter: 0,
            id: 0,
            status: FtsSample::READY,
            zero: [0.0; 6],
            components: [0.0; 6],
        }
    }

    /// Lets the datagrams' count begin at a number, to come near its wrap-around.
    #[must_use]
    pub const fn counting_from(mut self, counter: u16) -> Self {
        self.counter = counter;
        self
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

    /// Takes a command and answers it; bytes that are none are ignored.
    pub fn command(&mut self, bytes: &[u8]) -> Option<[u8; CommandAnswer::LENGTH]> {
        let (counter, command) = Command::parse(bytes).ok()?;
        match command {
            Command::Tare => self.zero = self.components,
            Command::ResetTare => self.zero = [0.0; 6],
            Command::StartUdp => self.streaming = true,
            Command::StopUdp => self.streaming = false,
        }
        Some(CommandAnswer { command, error: 0 }.emit(counter))
    }

    /// The sensor samples a load \[N, N·m\]. While it streams, this sends a datagram.
    pub fn sample(&mut self, components: [f32; 6]) {
        self.components = components;
        if !self.streaming {
            return;
        }
        let mut zeroed = components;
        for (component, zero) in zeroed.iter_mut().zip(self.zero) {
            *component -= zero;
        }
        let sample = FtsSample { status: self.status, components: zeroed };
        let mut datagram = [0; 7 + FtsSample::LENGTH];
        if emit_packet(self.counter, self.id, &[sample], &mut datagram).is_some() {
            self.link.send(&datagram);
        }
        (self.counter, self.id) = (self.counter.wrapping_add(1), self.id.wrapping_add(1));
    }

    /// The next datagram on the link.
    pub fn datagram(&mut self) -> Option<Vec<u8>> {
        self.link.receive()
    }

    /// What was done to the datagrams so far: `received` stays zero.
    #[must_use]
    pub const fn injected(&self) -> &LinkStatistics {
        self.link.injected()
    }
}

/// A [`SimulatedFts`] that serves one client at a time, in a thread of its own, until it is dropped.
pub type FtsServer = Served<SimulatedFts>;

impl Served<SimulatedFts> {
    /// Takes commands at an address (port 0 for any free one; the loopback interface unless you know what you
    /// do) and sends datagrams to the client's address and the port `client_port`. `load` gives the
    /// components of each sample by its number; one is taken every `period`.
    ///
    /// # Errors
    /// If the address cannot be had.
    pub fn start(
        address: impl ToSocketAddrs,
        client_port: u16,
        mut sensor: SimulatedFts,
        period: Duration,
        mut load: impl FnMut(u64) -> [f32; 6] + Send + 'static,
    ) -> io::Result<Self> {
        let listener = TcpListener::bind(address)?;
        listener.set_nonblocking(true)?;
        let address = listener.local_addr()?;
        let socket = UdpSocket::bind((address.ip(), 0))?;
        Self::by(address, "simulated FTS", move |stopped| {
            let mut client: Option<(TcpStream, SocketAddr)> = None;
            let mut next = Instant::now();
            let mut number = 0;
            while !stopped.load(Ordering::Relaxed) {
                if let Ok((stream, from)) = listener.accept()
                    && stream.set_nonblocking(true).is_ok()
                {
                    client = Some((stream, SocketAddr::new(from.ip(), client_port)));
                }
                if let Some((stream, _)) = &mut client {
                    let mut bytes = [0; Command::LENGTH];
                    match stream.read(&mut bytes) {
                        // Commands are short enough to come in one piece over a loopback.
                        Ok(length) if length > 0 => {
                            if let Some(answer) = sensor.command(bytes.get(..length).unwrap_or_default()) {
                                // A client that has gone is no trouble of the sensor's.
                                let _ = stream.write_all(&answer);
                            }
                        }
                        Ok(_) => client = None,
                        Err(_) => {}
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
                while let Some(datagram) = sensor.datagram() {
                    if let Some((_, to)) = &client {
                        let _ = socket.send_to(&datagram, to);
                    }
                }
            }
            sensor
        })
    }
}
