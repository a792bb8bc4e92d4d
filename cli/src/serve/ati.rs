//! ATI Net F/T: records over UDP, the page of the configuration over HTTP.

use alloc::sync::Arc;
use core::sync::atomic::{AtomicU64, Ordering};
use core::time::Duration;
use std::io::{self, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::thread;

use fingertip_drivers::ati_rdt::{Configuration, FaultPlan, RdtClient, RdtServer, SimulatedNetFt};

use super::args::SimulateArguments;
use super::load::Load;
use super::{End, announce, fault, tally};
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
    let faults = &arguments.faults;
    let plan = FaultPlan {
        loss: faults.loss,
        duplication: faults.duplicate,
        reorder: faults.reorder,
        truncation: faults.truncate,
        seed: arguments.seed,
    };
    let port = arguments.port.unwrap_or(RdtClient::<f64>::PORT);
    let samples = Arc::new(AtomicU64::new(0));
    let counted = Arc::clone(&samples);
    let mut playing = load.clone();
    let server =
        RdtServer::start((arguments.listen, port), SimulatedNetFt::new(plan), period, move |number| {
            if number == 0 {
                playing.restart();
            }
            counted.store(playing.samples(), Ordering::Relaxed);
            let mut counts = [0; 6];
            for (count, component) in counts.iter_mut().zip(playing.next().components().iter()) {
                *count = rounded(component * COUNTS);
            }
            counts
        })
        .map_err(|error| {
            fault(format!(
                "cannot serve on UDP port {port}: {error}; choose another --port, 0 for any free one"
            ))
        })?;
    let address = server.address();
    announce(arguments, &load, &format!("ati://{address}?http={http}"))?;
    while !end.has_come() {
        match pages.accept() {
            // A client that does not take its page is no trouble of the sensor's.
            Ok((stream, _)) => drop(answer(stream, &configuration)),
            Err(_) => thread::sleep(Duration::from_millis(5)),
        }
    }
    let sensor =
        server.stop().ok_or_else(|| fault("the server died; this is a fault of ours, please report it"))?;
    let injected = sensor.injected();
    let samples = samples.load(Ordering::Relaxed);
    Ok(tally(
        samples,
        u64::from(sensor.rdt_sequence()),
        &format!(
            "{} lost on purpose, {} repeated, {} late, {} cut",
            injected.lost, injected.duplicates, injected.late, injected.corrupt
        ),
    ))
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
