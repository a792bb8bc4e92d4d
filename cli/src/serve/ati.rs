//! ATI Net F/T: records over UDP, the page of the configuration over HTTP.

use core::time::Duration;
use std::io::{self, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::thread;

use fingertip_drivers::sensors::ati_rdt::{Configuration, RdtClient, RdtServer, SimulatedNetFt};

use super::args::SimulateArguments;
use super::load::Load;
use super::{End, NAP, Played, announce, cannot_bind, died, fault, tally_datagrams};
use crate::error::CliError;

/// Counts per newton and per newton metre, as most sensors are delivered.
const COUNTS: f64 = 1e6;

pub(super) fn serve(
    arguments: &SimulateArguments,
    period: Duration,
    load: Load,
    end: &End,
) -> Result<String, CliError> {
    let configuration = Configuration {
        counts_per_newton: COUNTS,
        counts_per_newton_metre: COUNTS,
        rate: Some(arguments.rate),
    };
    let pages = TcpListener::bind((arguments.listen, arguments.http_port)).map_err(|error| {
        fault(format!(
            "cannot serve on TCP port {}: {error}; choose another --http-port",
            arguments.http_port
        ))
    })?;
    pages.set_nonblocking(true).map_err(fault)?;
    let http = pages.local_addr().map_err(fault)?.port();
    let port = arguments.port.unwrap_or(RdtClient::<f64>::PORT);
    let (mut played, samples) = Played::new(load.clone());
    let server = RdtServer::start(
        (arguments.listen, port),
        SimulatedNetFt::new(arguments.faults.of_datagrams(arguments.seed)),
        period,
        move |number| played.next(number).map(|component| rounded(component * COUNTS)),
    )
    .map_err(cannot_bind("UDP", port))?;
    let address = server.address();
    announce(arguments, &load, &format!("ati://{address}?http={http}"))?;
    while !end.has_come() {
        match pages.accept() {
            // A client that does not take its page is no trouble of the sensor's.
            Ok((stream, _)) => drop(answer(stream, &configuration)),
            Err(_) => thread::sleep(NAP),
        }
    }
    let sensor = server.stop().ok_or_else(died)?;
    Ok(tally_datagrams(&samples, &sensor))
}

#[expect(clippy::cast_possible_truncation, reason = "saturates, as a converter does")]
fn rounded(counts: f64) -> i32 {
    counts.round() as i32
}

fn answer(mut stream: TcpStream, configuration: &Configuration) -> io::Result<()> {
    stream.set_nonblocking(false)?;
    stream.set_read_timeout(Some(Duration::from_millis(500)))?;
    stream.set_write_timeout(Some(Duration::from_millis(500)))?;
    let mut request = Vec::new();
    let mut bytes = [0; 512];
    while !request.windows(4).any(|end| end == b"\r\n\r\n") && request.len() < 8192 {
        match stream.read(&mut bytes)? {
            0 => break,
            length => request.extend_from_slice(bytes.get(..length).unwrap_or_default()),
        }
    }
    if request.starts_with(b"GET /netftapi2.xml") {
        stream.write_all(configuration.page().as_bytes())
    } else {
        stream.write_all(b"HTTP/1.0 404 Not Found\r\nContent-Length: 0\r\nConnection: close\r\n\r\n")
    }
}
