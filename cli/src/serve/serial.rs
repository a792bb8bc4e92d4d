//! Serial protocols, over a pseudo-terminal or TCP.

use core::time::Duration;
use std::io::{self, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::thread;

use fingertip_drivers::devices::{SerialSimulator, ServeError};
use fingertip_drivers::sensors::Pace;
use fingertip_drivers::sensors::line::SimulatedSerial;

use super::args::{Carrier, SimulateArguments};
use super::load::Load;
use super::{End, announce, fault, tally};
use crate::error::CliError;

/// The sensor's end of the line.
trait Outlet {
    /// Reads what the client sent, if there is a client; `None` if there is not.
    fn hear(&mut self, bytes: &mut [u8]) -> Option<usize>;
    /// Sends bytes. What a slow client does not take is lost, as on a wire.
    fn send(&mut self, bytes: &[u8]);
}

/// Opens the sensor's end of the line, and says the address of the other one.
fn outlet(arguments: &SimulateArguments, options: &str) -> Result<(Box<dyn Outlet>, String), CliError> {
    let name = arguments.serve.name;
    Ok(match arguments.over {
        Carrier::Tcp => {
            let port = arguments.port.unwrap_or(0);
            let listener = TcpListener::bind((arguments.listen, port))
                .map_err(|source| ServeError::Port { transport: "TCP", port, source })?;
            listener.set_nonblocking(true).map_err(fault)?;
            let address = format!("{name}+tcp://{}{options}", listener.local_addr().map_err(fault)?);
            (Box::new(Tcp { listener, client: None }), address)
        }
        Carrier::Pty => {
            let (pty, path) = pseudo_terminal()?;
            (pty, format!("{name}://{path}{options}"))
        }
    })
}

pub(super) fn serve(
    simulated: SerialSimulator,
    arguments: &SimulateArguments,
    mut load: Load,
    end: &End,
) -> Result<String, CliError> {
    let (mut outlet, address) = outlet(arguments, &simulated.options)?;
    announce(arguments, &load, &address)?;
    let faults = arguments.faults.of_frames(arguments.seed);
    let mut sensor = SimulatedSerial::new(simulated.device, faults);
    let mut pace = Pace::new(Duration::from_secs_f64(arguments.rate.recip()));
    let mut has_client = false;
    let (mut heard, mut said) = ([0; 256], Vec::new());
    while !end.has_come() {
        let Some(length) = outlet.hear(&mut heard) else {
            has_client = false;
            thread::sleep(Duration::from_millis(2));
            continue;
        };
        if !has_client {
            has_client = true;
            load.restart();
            pace.restart();
            sensor.switch_off_and_on();
        }
        sensor.write_all(heard.get(..length).unwrap_or_default()).map_err(fault)?;
        if !pace.is_due() {
            continue;
        }
        sensor.sample(load.next().components().into());
        said.clear();
        sensor.read_to_end(&mut said).map_err(fault)?;
        if !said.is_empty() {
            outlet.send(&said);
        }
    }
    let line = sensor.line();
    Ok(tally(load.samples(), line.sent(), &format!("{} damaged or lost on purpose", line.damaged())))
}

struct Tcp {
    listener: TcpListener,
    client: Option<TcpStream>,
}

impl Outlet for Tcp {
    fn hear(&mut self, bytes: &mut [u8]) -> Option<usize> {
        if self.client.is_none() {
            let (stream, _) = self.listener.accept().ok()?;
            stream.set_nonblocking(true).ok()?;
            stream.set_nodelay(true).ok()?;
            self.client = Some(stream);
        }
        match self.client.as_mut()?.read(bytes) {
            Ok(length) if length > 0 => Some(length),
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => Some(0),
            Ok(_) | Err(_) => {
                self.client = None;
                None
            }
        }
    }

    fn send(&mut self, bytes: &[u8]) {
        if let Some(client) = &mut self.client {
            // If it has gone, that is noticed when it is read from.
            let _ = client.write(bytes);
        }
    }
}

#[cfg(not(unix))]
fn pseudo_terminal() -> Result<(Box<dyn Outlet>, String), CliError> {
    Err(fault("this system has no pseudo-terminals; use --over tcp"))
}

#[cfg(unix)]
fn pseudo_terminal() -> Result<(Box<dyn Outlet>, String), CliError> {
    use serialport::{SerialPort, TTYPort};

    /// The sensor's end; the client opens the other one.
    struct Pty(TTYPort);

    impl Outlet for Pty {
        fn hear(&mut self, bytes: &mut [u8]) -> Option<usize> {
            match self.0.read(bytes) {
                Ok(length) => Some(length),
                Err(error) if matches!(error.kind(), io::ErrorKind::TimedOut | io::ErrorKind::WouldBlock) => {
                    Some(0)
                }
                // Nobody has the other end open.
                Err(_) => None,
            }
        }

        fn send(&mut self, bytes: &[u8]) {
            let _ = self.0.write(bytes);
        }
    }

    let cannot = |error: serialport::Error| fault(format!("no pseudo-terminal: {error}; use --over tcp"));
    let (mut sensor, client) = TTYPort::pair().map_err(cannot)?;
    sensor.set_timeout(Duration::ZERO).map_err(cannot)?;
    let path = client.name().ok_or_else(|| fault("the pseudo-terminal has no path; use --over tcp"))?;
    Ok((Box::new(Pty(sensor)), path))
}
