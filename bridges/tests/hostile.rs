//! What clients of ill will cost those who read as they should: not a sample.

#![allow(clippy::unwrap_used, reason = "helpers of tests, which may fail so")]

use core::time::Duration;
use std::io::{Read, Write};
use std::net::TcpStream;

use fingertip::wrench::Wrench;
use fingertip_bridges::web::{Options, Server, Tokens};
use fingertip_bridges::{About, Hub, Sample};
use nalgebra::Vector6;

/// Samples that are given in a millisecond: in two seconds, after which a reader is given up, far more than the hub keeps.
const AT_ONCE: u64 = 16;

/// A stream that is asked for and never read.
fn silent(server: &Server) -> TcpStream {
    let address = server.address();
    let query = server.watching().split('?').nth(1).unwrap().to_owned();
    let mut stream = TcpStream::connect(address).unwrap();
    let head = format!(
        "GET /samples?{query} HTTP/1.1\r\nHost: {address}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n\
         Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n"
    );
    stream.write_all(head.as_bytes()).unwrap();
    // As far as the end of the answer's head: it is served.
    stream.set_read_timeout(Some(Duration::from_secs(10))).unwrap();
    let mut head = Vec::new();
    while !head.ends_with(b"\r\n\r\n") {
        let mut byte = [0];
        stream.read_exact(&mut byte).unwrap();
        head.push(byte[0]);
    }
    assert!(head.starts_with(b"HTTP/1.1 101 "), "{}", String::from_utf8_lossy(&head));
    stream
}

#[test]
fn a_reader_that_reads_misses_nothing_for_those_that_never_do() {
    let hub = Hub::new(About::default());
    let listen = "127.0.0.1:0".parse().unwrap();
    let options = Options { listen, tokens: Tokens::random().unwrap(), commands: true, view: String::new() };
    let server = Server::start(&hub, options).unwrap();
    let (mut publisher, mut reader) = (hub.publisher(), hub.subscribe());
    let silent: Vec<TcpStream> = (0..12).map(|_| silent(&server)).collect();
    let strangers: Vec<TcpStream> =
        (0..200).filter_map(|_| TcpStream::connect(server.address()).ok()).collect();
    // Until their buffers are full and each of them has kept its thread of the server waiting as long as it may.
    let (mut given, mut taken, mut samples) = (0, 0, Vec::new());
    while server.counts().given_up < 12 {
        assert!(given < 1000 * 60 * AT_ONCE, "{:?}", server.counts());
        for _ in 0..AT_ONCE {
            let wrench = Wrench::from_components(&Vector6::repeat(given as f64));
            publisher.publish(Sample::new(given as f64 * 1e-3, wrench, None));
            given += 1;
        }
        std::thread::sleep(Duration::from_millis(1));
        publisher.flush();
        let news = reader.wait(&mut samples, Duration::ZERO);
        assert_eq!(news.missed, 0, "{taken} of {given} taken");
        assert!(samples.drain(..).all(|sample| {
            taken += 1;
            sample.number + 1 == taken
        }));
    }
    assert!(taken + AT_ONCE >= given, "{taken} of {given} taken");
    // All the rest had no room.
    let counts = server.counts();
    assert_eq!(counts.streams, 12);
    assert!(counts.refused >= 190 && !strangers.is_empty(), "{counts:?}");
    let address = server.address();
    drop((silent, server));
    // A server that has ended lets nobody in.
    assert!(TcpStream::connect_timeout(&address, Duration::from_millis(100)).is_err());
}
