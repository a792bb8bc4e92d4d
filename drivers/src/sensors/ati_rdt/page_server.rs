//! The page of a simulated sensor, over HTTP.

use core::sync::atomic::Ordering;
use core::time::Duration;
use std::io::{self, Write};
use std::net::{Shutdown, TcpListener, TcpStream, ToSocketAddrs};
use std::thread;

use super::Configuration;
use super::deadline::Deadline;
use crate::sensors::Served;

/// How often it looks whether somebody asks.
const NAP: Duration = Duration::from_millis(5);
/// So many clients are answered at a time.
const MOST: usize = 64;
/// How long one may take to ask.
const PATIENCE: Duration = Duration::from_millis(500);
/// The longest request \[bytes\].
const LONGEST: usize = 8192;

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
    let end = Deadline::within(PATIENCE);
    stream.set_write_timeout(Some(PATIENCE))?;
    let mut request = Vec::new();
    while !is_whole(&request) && request.len() < LONGEST {
        if end.read(&mut stream, &mut request)? == 0 {
            break;
        }
    }
    stream.write_all(reply(&request, configuration).as_bytes())?;
    // What is closed with bytes unread is reset, and takes the answer with it.
    stream.shutdown(Shutdown::Write)?;
    let mut rest = Vec::new();
    while rest.len() < 8 * LONGEST && end.read(&mut stream, &mut rest)? > 0 {}
    Ok(())
}

fn is_whole(request: &[u8]) -> bool {
    request.windows(4).any(|end| end == b"\r\n\r\n")
}

/// What is answered to a request, or to what there is of one.
fn reply(request: &[u8], configuration: &Configuration) -> String {
    let line = request.split(|byte| *byte == b'\r').next().unwrap_or_default();
    let mut words = line.split(|byte| *byte == b' ').filter(|word| !word.is_empty());
    let (method, path) = (words.next().unwrap_or_default(), words.next().unwrap_or_default());
    let refused =
        |status: &str| format!("HTTP/1.0 {status}\r\nContent-Length: 0\r\nConnection: close\r\n\r\n");
    if !is_whole(request) {
        refused(if request.len() < LONGEST {
            "400 Bad Request"
        } else {
            "431 Request Header Fields Too Large"
        })
    } else if method != b"GET" {
        refused("405 Method Not Allowed\r\nAllow: GET")
    } else if path.split(|byte| *byte == b'?').next() != Some(b"/netftapi2.xml") {
        refused("404 Not Found")
    } else {
        configuration.page()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_page_is_given_and_what_else_is_asked_is_refused_by_its_reason() {
        let page = "<cfgcpf>7</cfgcpf><cfgcpt>9</cfgcpt><scfgfu>N</scfgfu><scfgtu>Nm</scfgtu>";
        let configuration = Configuration::parse(page).unwrap();
        let long = format!("GET /netftapi2.xml HTTP/1.0\r\nCookie: {}", "x".repeat(LONGEST));
        for (request, status) in [
            ("GET /netftapi2.xml HTTP/1.0\r\n\r\n", "200 OK"),
            ("GET /netftapi2.xml?index=0 HTTP/1.1\r\nHost: sensor\r\n\r\n", "200 OK"),
            ("GET /netftapi2.xml\r\n\r\n", "200 OK"),
            ("GET /netftapi2.xml.bak HTTP/1.0\r\n\r\n", "404 Not Found"),
            ("GET / HTTP/1.0\r\n\r\n", "404 Not Found"),
            ("GET\r\n\r\n", "404 Not Found"),
            ("POST /netftapi2.xml HTTP/1.0\r\n\r\n", "405 Method Not Allowed\r\nAllow: GET"),
            ("GETTER /netftapi2.xml HTTP/1.0\r\n\r\n", "405 Method Not Allowed"),
            ("\r\n\r\n", "405 Method Not Allowed"),
            ("", "400 Bad Request"),
            ("GET /netftapi2.xml HTTP/1.0\r\n", "400 Bad Request"),
            (&long, "431 Request Header Fields Too Large"),
        ] {
            let told = reply(request.as_bytes(), &configuration);
            assert!(told.starts_with(&format!("HTTP/1.0 {status}\r\n")), "{request:.60}: {told}");
            assert_eq!(told.contains("<cfgcpf>7<"), status == "200 OK", "{request:.60}: {told}");
        }
    }
}
