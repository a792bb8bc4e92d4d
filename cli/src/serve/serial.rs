//! Serial protocols, over a pseudo-terminal or TCP.

use core::time::Duration;
use std::io::{self, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::thread;

use fingertip_drivers::sensors::bota_serial::SimulatedBota;
use fingertip_drivers::sensors::dynpick::SimulatedDynPick;
use fingertip_drivers::sensors::line::{LineFaults, SerialDevice, SimulatedSerial};
use fingertip_drivers::sensors::optoforce::SimulatedOptoForce;
use fingertip_drivers::sensors::resense::SimulatedResense;
use fingertip_drivers::sensors::robotous::SimulatedRft;
use fingertip_drivers::sensors::{AxisCounts, Pace};

use super::args::{Carrier, Device, SimulateArguments};
use super::load::Load;
use super::{End, announce, cannot_bind, fault, tally};
use crate::error::CliError;

/// The sensor's end of the line.
trait Outlet {
    /// Reads what the client sent, if there is a client; `None` if there is not.
    fn hear(&mut self, bytes: &mut [u8]) -> Option<usize>;
    /// Sends bytes. What a slow client does not take is lost, as on a wire.
    fn send(&mut self, bytes: &[u8]);
}

/// Counts per newton and newton metre of the devices that send counts: those of the Robotous RFT60, a
/// DynPick WEF-6A200, and an OptoForce HEX.
const ROBOTOUS: [f64; 2] = [50.0, 2000.0];
const DYNPICK: [f64; 2] = [40.0, 1640.0];
const OPTOFORCE: [f64; 2] = [100.0, 10_000.0];
/// Range of the Resense sensor \[N, N·m\].
const RESENSE: [f64; 2] = [200.0, 10.0];

/// A device, and what its address must say behind its question mark.
fn simulated(device: Device, rate: f64) -> Result<(Box<dyn SerialDevice>, String), CliError> {
    let counts = |[force, torque]: [f64; 2]| AxisCounts::uniform(force, torque).map_err(fault);
    Ok(match device {
        Device::Bota => (Box::new(SimulatedBota::new(rate)), format!("?rate_Hz={rate}")),
        Device::Robotous => (Box::new(SimulatedRft::new(counts(ROBOTOUS)?)), String::new()),
        Device::Dynpick => (Box::new(SimulatedDynPick::new(counts(DYNPICK)?)), String::new()),
        Device::Optoforce => {
            let [force, torque] = OPTOFORCE;
            let options = format!("?counts_per_N={force}&counts_per_Nm={torque}");
            (Box::new(SimulatedOptoForce::new(counts(OPTOFORCE)?)), options)
        }
        Device::Resense => {
            let [force, torque] = RESENSE;
            let options = format!("?greatest_N={force}&greatest_Nm={torque}");
            (Box::new(SimulatedResense::streaming()), options)
        }
        Device::Ati | Device::Schunk => return Err(fault("this device has no serial line")),
    })
}

pub(super) fn serve(
    arguments: &SimulateArguments,
    period: Duration,
    mut load: Load,
    end: &End,
) -> Result<String, CliError> {
    let device = arguments.serve;
    let name = format!("{device:?}").to_lowercase();
    let (simulated, options) = simulated(device, arguments.rate)?;
    let (mut outlet, address): (Box<dyn Outlet>, String) = match arguments.over {
        Carrier::Tcp => {
            let port = arguments.port.unwrap_or(0);
            let listener = TcpListener::bind((arguments.listen, port)).map_err(cannot_bind("TCP", port))?;
            listener.set_nonblocking(true).map_err(fault)?;
            let address = format!("{name}+tcp://{}{options}", listener.local_addr().map_err(fault)?);
            (Box::new(Tcp { listener, client: None }), address)
        }
        Carrier::Pty => {
            let (pty, path) = pseudo_terminal()?;
            (pty, format!("{name}://{path}{options}"))
        }
    };
    announce(arguments, &load, &address)?;
    let faults = &arguments.faults;
    let faults = LineFaults {
        bit_flip: faults.bit_flip,
        lost_byte: faults.lost_byte,
        lost_frame: faults.loss,
        noise: faults.garbage,
        seed: arguments.seed,
    };
    let mut sensor = SimulatedSerial::new(simulated, faults);
    let mut pace = Pace::new(period);
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
