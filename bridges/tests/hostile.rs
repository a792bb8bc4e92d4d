//! What clients of ill will cost the one who samples: giving a sample takes no longer for them.

#![allow(clippy::unwrap_used, reason = "helpers of tests, which may fail so")]

use core::time::Duration;
use std::io::{Read, Write};
use std::net::TcpStream;
use std::time::Instant;

use fingertip::wrench::Wrench;
use fingertip_bridges::web::{Options, Server, Tokens};
use fingertip_bridges::{About, Hub, Sample};
use nalgebra::Vector6;

const PERIOD: Duration = Duration::from_millis(1);

/// How long giving each of so many samples takes, at 1 kHz; the median, what all but one in a hundred take, and the most.
fn given(hub: &Hub, count: u32) -> [Duration; 3] {
    let mut publisher = hub.publisher();
    let begun = Instant::now();
    let mut durations: Vec<Duration> = (0..count)
        .map(|number| {
            std::thread::sleep((PERIOD * number).saturating_sub(begun.elapsed()));
            let wrench = Wrench::from_components(&Vector6::repeat(f64::from(number)));
            let sample = Sample::new(f64::from(number) * 1e-3, wrench, None);
            let before = Instant::now();
            publisher.publish(sample);
            before.elapsed()
        })
        .collect();
    durations.sort();
    let at = |share: f64| durations[(share * (durations.len() - 1) as f64) as usize];
    [at(0.5), at(0.99), at(1.0)]
}

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
fn giving_a_sample_never_waits_for_a_reader() {
    let hub = Hub::new(About::default());
    let listen = "127.0.0.1:0".parse().unwrap();
    let options = Options { listen, tokens: Tokens::random().unwrap(), commands: true, view: String::new() };
    let server = Server::start(&hub, options).unwrap();
    let calm = given(&hub, 1000);
    let silent: Vec<TcpStream> = (0..12).map(|_| silent(&server)).collect();
    let strangers: Vec<TcpStream> =
        (0..200).filter_map(|_| TcpStream::connect(server.address()).ok()).collect();
    // All the rest has no room.
    let loud = given(&hub, 4000);
    println!("giving a sample: calm {calm:?}, under attack {loud:?} (median, 99 %, most)");
    let [median, most_of_them, _] = loud;
    assert!(median < Duration::from_micros(500) && most_of_them < Duration::from_millis(1), "{loud:?}");
    let counts = server.counts();
    assert_eq!(counts.streams, 12);
    assert!(counts.refused >= 190 && !strangers.is_empty(), "{counts:?}");
    let address = server.address();
    drop((silent, server));
    // A server that has ended lets nobody in.
    assert!(TcpStream::connect_timeout(&address, Duration::from_millis(100)).is_err());
}
