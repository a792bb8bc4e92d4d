//! A sensor that is not there: it answers commands and sends datagrams, over a link with faults.

use alloc::vec::Vec;
use core::net::SocketAddr;
use core::sync::atomic::Ordering;
use core::time::Duration;
use std::io::{self, Read, Write};
use std::net::{TcpListener, TcpStream, ToSocketAddrs, UdpSocket};

use super::wire::{Command, CommandAnswer, FtsSample, emit_packet};
use crate::sensors::datagram_link::FaultPlan;
use crate::sensors::{Pace, Served, SimulatedSensor};

/// The device and its link without sockets: commands and loads in, answers and datagrams out. One sample goes
/// into a datagram.
pub type SimulatedFts = SimulatedSensor<Fts>;

/// What is an FTS's own.
///
/// ```
/// use fingertip_drivers::sensors::FaultPlan;
/// use fingertip_drivers::sensors::schunk_fts::{Command, Packet, SimulatedFts};
///
/// let mut sensor = SimulatedFts::new(FaultPlan::default());
/// sensor.sample([0.0, 0.0, -1.0, 0.0, 0.0, 0.0]);
/// // Its zero is what it felt then.
/// sensor.command(&Command::Tare.emit(1)).unwrap();
/// sensor.command(&Command::StartUdp.emit(2)).unwrap();
/// sensor.sample([0.0, 0.0, -3.0, 0.0, 0.0, 0.0]);
/// let datagram = sensor.datagram().unwrap();
/// let sample = Packet::new_checked(&datagram)?.samples().next().unwrap();
/// assert_eq!(sample.components[2], -2.0);
/// # Ok::<(), fingertip_drivers::sensors::schunk_fts::FtsWireError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Fts {
    counter: u16,
    id: u8,
    zero: [f32; 6],
    components: [f32; 6],
}

impl SimulatedSensor<Fts> {
    /// A sensor at rest behind a link with faults.
    #[must_use]
    pub fn new(faults: FaultPlan) -> Self {
        Self::resting(faults, FtsSample::READY, Fts::default())
    }

    /// Lets the datagrams' count begin at a number, to come near its wrap-around.
    #[must_use]
    pub const fn counting_from(mut self, counter: u16) -> Self {
        self.device.counter = counter;
        self
    }

    /// Takes a command and answers it; bytes that are none are ignored.
    pub fn command(&mut self, bytes: &[u8]) -> Option<[u8; CommandAnswer::LENGTH]> {
        let (counter, command) = Command::parse(bytes).ok()?;
        match command {
            Command::Tare => self.device.zero = self.device.components,
            Command::ResetTare => self.device.zero = [0.0; 6],
            Command::StartUdp => self.streaming = true,
            Command::StopUdp => self.streaming = false,
        }
        Some(CommandAnswer { command, error: 0 }.emit(counter))
    }

    /// The sensor samples a load \[N, N·m\]. While it streams, this sends a datagram.
    pub fn sample(&mut self, components: [f32; 6]) {
        self.device.components = components;
        if !self.streaming {
            return;
        }
        let Fts { counter, id, zero, .. } = self.device;
        let mut zeroed = components;
        for (component, zero) in zeroed.iter_mut().zip(zero) {
            *component -= zero;
        }
        let sample = FtsSample { status: self.status, components: zeroed };
        let mut datagram = [0; 7 + FtsSample::LENGTH];
        if emit_packet(counter, id, &[sample], &mut datagram).is_some() {
            self.send(&datagram);
        }
        (self.device.counter, self.device.id) = (counter.wrapping_add(1), id.wrapping_add(1));
    }
}

/// A [`SimulatedFts`] that serves one client at a time, in a thread of its own, until it is dropped.
pub type FtsServer = Served<SimulatedFts>;

impl Served<SimulatedFts> {
    /// Takes commands at an address (port 0 for any free one; the loopback interface unless you know what you
    /// do) and sends datagrams to the client's address and the port `client_port`. `load` gives the
    /// components of each sample by its number, which begins anew with each client; one is taken every
    /// `period`.
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
            let mut client: Option<Client> = None;
            let mut pace = Pace::new(period);
            let mut number = 0;
            while !stopped.load(Ordering::Relaxed) {
                if let Ok((stream, from)) = listener.accept()
                    && stream.set_nonblocking(true).is_ok()
                {
                    let samples_to = SocketAddr::new(from.ip(), client_port);
                    client = Some(Client { stream, samples_to, heard: Vec::new() });
                    (sensor.streaming, number) = (false, 0);
                    pace.restart();
                }
                // One that has gone is no trouble of the sensor's.
                if client.as_mut().is_some_and(|client| client.talk(&mut sensor).is_err()) {
                    (client, sensor.streaming) = (None, false);
                }
                if !pace.is_due() {
                    continue;
                }
                sensor.sample(load(number));
                number += 1;
                while let Some(datagram) = sensor.datagram() {
                    if let Some(Client { samples_to, .. }) = &client {
                        let _ = socket.send_to(&datagram, samples_to);
                    }
                }
            }
            sensor
        })
    }
}

/// Who is connected.
struct Client {
    stream: TcpStream,
    samples_to: SocketAddr,
    /// The beginning of a command whose rest is still to come.
    heard: Vec<u8>,
}

impl Client {
    /// Takes what it says, and answers. Bytes that are no command are passed over.
    fn talk(&mut self, sensor: &mut SimulatedFts) -> io::Result<()> {
        let mut bytes = [0; 256];
        match self.stream.read(&mut bytes) {
            Ok(0) => return Err(io::ErrorKind::UnexpectedEof.into()),
            Ok(length) => self.heard.extend_from_slice(bytes.get(..length).unwrap_or_default()),
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => return Ok(()),
            Err(error) => return Err(error),
        }
        while let Some(frame) = self.heard.first_chunk::<{ Command::LENGTH }>() {
            let understood = match sensor.command(frame) {
                Some(answer) => {
                    self.stream.write_all(&answer)?;
                    Command::LENGTH
                }
                None => 1,
            };
            self.heard.drain(..understood);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use alloc::sync::Arc;
    use core::sync::atomic::AtomicU64;

    use super::*;
    use crate::sensors::schunk_fts::Packet;

    /// Counter, id and first component of the datagrams that wait.
    fn sent(sensor: &mut SimulatedFts) -> Vec<(u16, f32)> {
        let datagrams = core::iter::from_fn(|| sensor.datagram());
        datagrams
            .map(|datagram| {
                let packet = Packet::new_checked(&datagram).unwrap();
                (packet.counter(), packet.samples().next().unwrap().components[0])
            })
            .collect()
    }

    #[test]
    fn it_sends_from_start_to_stop_above_its_zero_and_counts_what_it_sends() {
        let mut sensor = SimulatedFts::new(FaultPlan::default()).counting_from(u16::MAX);
        let mut step = |commands: &[Command], x: f32| {
            for command in commands {
                let answer = sensor.command(&command.emit(7)).unwrap();
                assert_eq!(
                    CommandAnswer::parse(&answer),
                    Ok((7, CommandAnswer { command: *command, error: 0 }))
                );
            }
            sensor.sample([x; 6]);
            sent(&mut sensor)
        };
        assert_eq!(step(&[], 1.0), []);
        assert_eq!(step(&[Command::StartUdp], 2.0), [(u16::MAX, 2.0)]);
        // The zero is the load of the sample before.
        assert_eq!(step(&[Command::Tare], 5.0), [(0, 3.0)]);
        assert_eq!(step(&[Command::StopUdp], 6.0), []);
        assert_eq!(step(&[Command::StartUdp, Command::ResetTare], 7.0), [(1, 7.0)]);
        assert_eq!(sensor.command(b"not one"), None);
    }

    /// A server, and how often its sensor sampled, and how often as the first of a client.
    fn watched() -> (FtsServer, Arc<[AtomicU64; 2]>) {
        let counts = Arc::new([AtomicU64::new(0), AtomicU64::new(0)]);
        let seen = Arc::clone(&counts);
        let load = move |number: u64| {
            seen[0].fetch_add(1, Ordering::Relaxed);
            seen[1].fetch_add(u64::from(number == 0), Ordering::Relaxed);
            [number as f32; 6]
        };
        let sensor = SimulatedFts::new(FaultPlan::default());
        // Nobody listens at the port of discarded datagrams.
        (FtsServer::start("127.0.0.1:0", 9, sensor, Duration::from_micros(100), load).unwrap(), counts)
    }

    /// Waits until a count is so far; a minute is more than any machine takes.
    fn wait_for(count: &AtomicU64, least: u64) {
        for _ in 0..60_000 {
            if count.load(Ordering::Relaxed) >= least {
                return;
            }
            std::thread::sleep(Duration::from_millis(1));
        }
        panic!("{} of {least}", count.load(Ordering::Relaxed));
    }

    fn started(server: &FtsServer) -> TcpStream {
        let mut client = TcpStream::connect(server.address()).unwrap();
        client.write_all(&Command::StartUdp.emit(0)).unwrap();
        let mut answer = [0; CommandAnswer::LENGTH];
        client.read_exact(&mut answer).unwrap();
        client
    }

    #[test]
    fn a_new_client_finds_the_sensor_silent_and_its_samples_at_the_first() {
        let (server, counts) = watched();
        let held = started(&server);
        wait_for(&counts[0], counts[0].load(Ordering::Relaxed) + 3);
        let before = counts[1].load(Ordering::Relaxed);
        let _silent = TcpStream::connect(server.address()).unwrap();
        wait_for(&counts[1], before + 1);
        assert!(!server.stop().unwrap().is_streaming());
        drop(held);
    }

    #[test]
    fn nothing_is_sent_to_a_client_that_has_gone() {
        for stays in [true, false] {
            let (server, counts) = watched();
            let client = Some(started(&server)).filter(|_| stays);
            wait_for(&counts[0], counts[0].load(Ordering::Relaxed) + 3);
            assert_eq!(server.stop().unwrap().is_streaming(), stays);
            drop(client);
        }
    }
}
