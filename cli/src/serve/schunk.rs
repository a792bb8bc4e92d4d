//! SCHUNK FTS: commands over TCP, samples over UDP.

use core::net::SocketAddr;
use core::time::Duration;
use std::io::{self, Read, Write};
use std::net::{TcpListener, TcpStream, UdpSocket};

use fingertip_drivers::schunk_fts::{Command, CommandAnswer, FtsSample, emit_packet};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use super::args::SimulateArguments;
use super::load::Load;
use super::{End, Pace, announce, fault, tally};
use crate::error::CliError;

/// Samples in one datagram.
const BATCH: usize = 1;

struct Client {
    stream: TcpStream,
    /// Where its samples go.
    samples_to: SocketAddr,
    heard: Vec<u8>,
    streaming: bool,
}

pub(super) fn serve(
    arguments: &SimulateArguments,
    period: Duration,
    mut load: Load,
    end: &End,
) -> Result<String, CliError> {
    let port = arguments.port.unwrap_or(0);
    let listener = TcpListener::bind((arguments.listen, port)).map_err(|error| {
        fault(format!("cannot serve on TCP port {port}: {error}; choose another --port, 0 for any free one"))
    })?;
    listener.set_nonblocking(true).map_err(fault)?;
    let socket = UdpSocket::bind((arguments.listen, 0)).map_err(fault)?;
    socket.set_nonblocking(true).map_err(fault)?;
    let address = listener.local_addr().map_err(fault)?;
    announce(
        arguments,
        &load,
        &format!("schunk://{address}?udp={}&rate_Hz={}", arguments.udp_port, arguments.rate),
    )?;
    let mut random = Pcg64Mcg::seed_from_u64(arguments.seed);
    let (mut sent, mut lost) = (0, 0);
    let mut client: Option<Client> = None;
    let mut pace = Pace::new(period);
    let mut zero = [0.0; 6];
    let mut counter: u16 = 0;
    while !end.has_come() {
        if let Ok((stream, from)) = listener.accept()
            && stream.set_nonblocking(true).is_ok()
        {
            let samples_to = SocketAddr::new(from.ip(), arguments.udp_port);
            client = Some(Client { stream, samples_to, heard: Vec::new(), streaming: false });
        }
        let mut tare = None;
        if let Some(talking) = &mut client {
            match talking.commands() {
                Ok(commands) => {
                    for command in commands {
                        match command {
                            Command::StartUdp => {
                                load.restart();
                                pace.restart();
                            }
                            Command::Tare => tare = Some(true),
                            Command::ResetTare => tare = Some(false),
                            _ => {}
                        }
                    }
                }
                // It has gone.
                Err(_) => client = None,
            }
        }
        if !pace.is_due() {
            continue;
        }
        let now: [f64; 6] = load.next().components().into();
        match tare {
            Some(true) => zero = now,
            Some(false) => zero = [0.0; 6],
            None => {}
        }
        let Some(Client { samples_to, streaming: true, .. }) = &client else { continue };
        #[expect(clippy::cast_possible_truncation, reason = "the sensor sends single precision")]
        let components = core::array::from_fn(|axis| {
            (now.get(axis).unwrap_or(&0.0) - zero.get(axis).unwrap_or(&0.0)) as f32
        });
        counter = counter.wrapping_add(1);
        if random.random::<f64>() < arguments.faults.loss {
            lost += 1;
            continue;
        }
        let sample = FtsSample { status: FtsSample::READY, components };
        let mut bytes = [0; 64];
        let length = emit_packet(counter, 0, &[sample; BATCH], &mut bytes).unwrap_or(0);
        // A client that does not listen is no trouble of the sensor's.
        let _ = socket.send_to(bytes.get(..length).unwrap_or_default(), samples_to);
        sent += 1;
    }
    Ok(tally(load.samples(), sent, &format!("{lost} lost on purpose")))
}

impl Client {
    /// Hears and answers commands.
    fn commands(&mut self) -> io::Result<Vec<Command>> {
        let mut bytes = [0; 256];
        match self.stream.read(&mut bytes) {
            Ok(0) => return Err(io::ErrorKind::UnexpectedEof.into()),
            Ok(length) => self.heard.extend_from_slice(bytes.get(..length).unwrap_or_default()),
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => {}
            Err(error) => return Err(error),
        }
        let mut commands = Vec::new();
        while let Some(frame) = self.heard.first_chunk::<{ Command::LENGTH }>() {
            match Command::parse(frame) {
                Ok((counter, command)) => {
                    match command {
                        Command::StartUdp => self.streaming = true,
                        Command::StopUdp => self.streaming = false,
                        _ => {}
                    }
                    commands.push(command);
                    self.stream.write_all(&CommandAnswer { command, error: 0 }.emit(counter))?;
                    self.heard.drain(..Command::LENGTH);
                }
                Err(_) => {
                    self.heard.drain(..1);
                }
            }
        }
        Ok(commands)
    }
}
