//! The page of a simulated sensor, over HTTP.

use core::sync::atomic::Ordering;
use core::time::Duration;
use std::io::{self, Read, Write};
use std::net::{TcpListener, TcpStream, ToSocketAddrs};
use std::thread;
use std::time::Instant;

use super::Configuration;
use crate::sensors::Served;

/// How often it looks whether somebody asks.
const NAP: Duration = Duration::from_millis(5);
/// So many clients are answered at a time.
const MOST: usize = 64;
/// How long one may take to ask.
const PATIENCE: Duration = Duration::from_millis(500);

/// Serves the page of a configuration at an address, until it is dropped.
pub(super) fn serve_page(
    address: impl ToSocketAddrs,
    configuration: Configuration,
) -> io::Result<Served<()>> {
    let listener = TcpListener::bind(address)?;
    listener.set_nonblocking(true)?;
    let address = listener.local_addr()?;
    Served::by(address, "simulated page", move |stopped| {
        let mut answering: Vec<thread::JoinHandle<()>> = Vec::new();
        while !stopped.load(Ordering::Relaxed) {
            answering.retain(|answer| !answer.is_finished());
            match listener.accept() {
                // Beyond so many the connection is closed at once.
                Ok((stream, _)) if answering.len() < MOST => {
                    // A client that does not take its page is no trouble of the sensor's, nor of another client's.
                    let answer = move || drop(answer(stream, &configuration));
                    answering.extend(thread::Builder::new().spawn(answer).ok());
                }
                Ok(_) => {}
                Err(_) => thread::sleep(NAP),
            }
        }
    })
}

fn answer(mut stream: TcpStream, configuration: &Configuration) -> io::Result<()> {
    stream.set_nonblocking(false)?;
    let end = Instant::now() + PATIENCE;
    stream.set_write_timeout(Some(PATIENCE))?;
    let mut request = Vec::new();
    let mut bytes = [0; 512];
    while !request.windows(4).any(|end| end == b"\r\n\r\n") && request.len() < 8192 {
        let left = end.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return Err(io::ErrorKind::TimedOut.into());
        }
        stream.set_read_timeout(Some(left))?;
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
