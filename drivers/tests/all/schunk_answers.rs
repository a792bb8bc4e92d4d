//! The client of a SCHUNK FTS against a server whose bytes are written here.
#![cfg(all(feature = "schunk-fts", feature = "ati-rdt", feature = "simulators"))]

use core::net::SocketAddr;
use std::io::{Read, Write};
use std::net::{TcpListener, UdpSocket};
use std::thread::JoinHandle;

use fingertip_drivers::sensors::schunk_fts::{Command, FtsClient, FtsClientError, FtsWireError};
use fingertip_drivers::{Source, SourceError, SourceErrorKind};
use fingertip_wrench::Wrench;

use super::patience::{PATIENCE, unused_port};

/// Takes one client, answers its first command with `answer`, sends datagrams to its port, acknowledges a stop and
/// gives all that it heard.
fn serve(answer: Vec<u8>, port: u16, datagrams: Vec<Vec<u8>>) -> (SocketAddr, JoinHandle<Vec<u8>>) {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap();
    let server = std::thread::spawn(move || {
        let (mut stream, _) = listener.accept().unwrap();
        let mut heard = vec![0; 7];
        stream.read_exact(&mut heard).unwrap();
        stream.write_all(&answer).unwrap();
        let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
        for datagram in datagrams {
            socket.send_to(&datagram, ("127.0.0.1", port)).unwrap();
        }
        let mut stop = [0; 7];
        if stream.read_exact(&mut stop).is_ok() {
            heard.extend(stop);
            // It may be gone by now.
            let _ = stream.write_all(&[0xFF, 0xFF, 2, 0, 2, 0, 0x41, 0]);
        }
        heard
    });
    (address, server)
}

fn connected(answer: &[u8]) -> Result<FtsClient, FtsClientError> {
    let port = unused_port();
    let (address, _) = serve(answer.to_vec(), port, Vec::new());
    FtsClient::connect(address, ("127.0.0.1", port), PATIENCE)
}

#[test]
fn an_answer_must_be_that_of_the_command() {
    let error = connected(&[0xFF, 0xFF, 1, 0, 2, 0, 0x12, 0]).unwrap_err();
    assert!(
        matches!(error, FtsClientError::OtherAnswer { sent: Command::StartUdp, found: Command::Tare }),
        "{error}"
    );
    assert_eq!(error.kind(), SourceErrorKind::Corrupt);
    let error = connected(&[0xFF, 0xFF, 1, 0, 2, 0, 0x40, 5]).unwrap_err();
    assert!(matches!(error, FtsClientError::Refused { command: Command::StartUdp, error: 5 }), "{error}");
    assert_eq!(error.kind(), SourceErrorKind::Unsupported);
    let error = connected(&[0xFF, 0xFE, 1, 0, 2, 0, 0x40, 0]).unwrap_err();
    assert!(matches!(error, FtsClientError::Corrupt(FtsWireError::Header)), "{error}");
}

/// A datagram with two samples whose first component is a number.
fn datagram(counter: u8, numbers: [f32; 2]) -> Vec<u8> {
    let mut bytes = vec![0xFF, 0xFF, counter, 0, 57, 0, counter];
    for number in numbers {
        bytes.extend([1, 0, 0, 0]);
        bytes.extend(number.to_le_bytes());
        bytes.extend([0; 20]);
    }
    bytes
}

#[test]
fn samples_are_given_in_turn_at_the_times_of_their_count() {
    let datagrams = || {
        vec![
            datagram(10, [1.0, 2.0]),
            datagram(11, [3.0, 4.0]),
            // One that was lost, one that comes twice, and one that is late.
            datagram(13, [7.0, 8.0]),
            datagram(13, [7.0, 8.0]),
            datagram(12, [5.0, 6.0]),
            datagram(14, [9.0, 10.0]),
        ]
    };
    let port = unused_port();
    let (address, server) = serve(vec![0xFF, 0xFF, 1, 0, 2, 0, 0x40, 0], port, datagrams());
    let mut client = FtsClient::connect(address, ("127.0.0.1", port), PATIENCE).unwrap().timed_by(2000.0);
    for (number, halves) in [(1.0, 0), (2.0, 1), (3.0, 2), (4.0, 3), (7.0, 6), (8.0, 7), (9.0, 8), (10.0, 9)]
    {
        let sample = Source::<f64, Wrench<f64>>::next_sample(&mut client).unwrap().unwrap();
        assert_eq!((sample.value.force().x, sample.time), (number, Some(f64::from(halves) * 0.5e-3)));
    }
    let statistics = *client.statistics();
    assert_eq!((statistics.received, statistics.lost), (6, 0));
    assert_eq!((statistics.late, statistics.duplicates), (1, 1));
    drop(client);
    // Start and stop, counted from 1.
    assert_eq!(
        server.join().unwrap(),
        [0xFF, 0xFF, 1, 0, 1, 0, 0x40, 0xFF, 0xFF, 2, 0, 1, 0, 0x41],
        "what the client says"
    );
    // Rates that are none give no times.
    for rate in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let port = unused_port();
        let (address, _) = serve(vec![0xFF, 0xFF, 1, 0, 2, 0, 0x40, 0], port, datagrams());
        let mut client = FtsClient::connect(address, ("127.0.0.1", port), PATIENCE).unwrap().timed_by(rate);
        assert_eq!(Source::<f64, Wrench<f64>>::next_sample(&mut client).unwrap().unwrap().time, None);
    }
}
