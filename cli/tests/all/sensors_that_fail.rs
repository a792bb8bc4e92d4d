//! `fingertip record` of sensors that go, say nothing, or refuse.

#[cfg(unix)]
use std::fs::File;

use crate::common::{Contacts, Folder};

/// A sensor that goes while it is recorded is an error that says when; what came before is a whole file.
#[test]
fn a_sensor_that_goes_is_an_error() {
    use fingertip_drivers::sensors::bota_serial::Frame;
    use std::io::Write as _;

    let folder = Folder::new();
    let listener = std::net::TcpListener::bind(("127.0.0.1", 0)).unwrap();
    let address = format!("bota+tcp://{}", listener.local_addr().unwrap());
    let sensor = std::thread::spawn(move || {
        let (mut line, _) = listener.accept().unwrap();
        for number in 0..40_u32 {
            let frame = Frame { components: [1.0; 6], microseconds: number * 2500, ..Frame::default() };
            line.write_all(&frame.emit()).unwrap();
        }
    });
    let output = folder.run(&["record", &address, "-o", "a.csv", "--silence", "60"]);
    sensor.join().unwrap();
    let error = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{error}");
    let expected =
        "the line was closed 0.0975 s after the first sample, behind 40 samples, which are recorded";
    assert!(error.contains(expected), "{error}");
    assert_eq!(Contacts::parse(&folder.read("a.csv")).len(), 40);
}

/// Samples that the sensor marks as bad are left out: the first ones are said, unless nothing is to be, and all are counted.
#[test]
fn samples_that_are_marked_as_bad_are_said_and_counted() {
    use fingertip_drivers::sensors::bota_serial::Frame;
    use std::io::Write as _;

    let folder = Folder::new();
    for (more, said) in [(&[][..], 3), (&["--quiet"], 0)] {
        let listener = std::net::TcpListener::bind(("127.0.0.1", 0)).unwrap();
        let address = format!("bota+tcp://{}", listener.local_addr().unwrap());
        let sensor = std::thread::spawn(move || {
            let (mut line, _) = listener.accept().unwrap();
            for number in 0..40_u32 {
                let status = if (10..15).contains(&number) { 2 } else { 0 };
                let microseconds = number * 2500;
                let frame = Frame { status, components: [1.0; 6], microseconds, ..Frame::default() };
                line.write_all(&frame.emit()).unwrap();
            }
            // Until who reads it has enough.
            let _ = std::io::Read::read(&mut line, &mut [0]);
        });
        let record = ["record", &address, "-o", "a.csv", "--samples", "35", "--silence", "60", "--force"];
        let output = folder.run(&[&record[..], more].concat());
        sensor.join().unwrap();
        let [out, error] = [output.stdout, output.stderr].map(|text| String::from_utf8(text).unwrap());
        assert!(output.status.success(), "{error}");
        assert_eq!(error.matches("warning: ").count(), said, "{error}");
        assert_eq!(error.contains(" (further ones are only counted)\n"), said > 0, "{error}");
        let counted = "Samples that the sensor marked as bad or that were damaged: 5\n";
        assert_eq!(out.contains(counted), said > 0, "{out}");
        assert_eq!(Contacts::parse(&folder.read("a.csv")).len(), 35);
    }
}

/// One that goes before it said anything left no recording to speak of.
#[test]
fn a_sensor_that_says_nothing_is_an_error() {
    let folder = Folder::new();
    let listener = std::net::TcpListener::bind(("127.0.0.1", 0)).unwrap();
    let address = format!("bota+tcp://{}", listener.local_addr().unwrap());
    let sensor = std::thread::spawn(move || drop(listener.accept().unwrap()));
    let error = folder.fail(1, &["record", &address, "-o", "a.csv", "--silence", "60"]);
    sensor.join().unwrap();
    assert!(error.contains("the line was closed") && !error.contains("after the first sample"), "{error}");
}

/// A pseudo-terminal that is pulled out is a sensor that goes, not an error of the system in its own words.
#[test]
#[cfg(unix)]
fn a_pseudo_terminal_that_is_pulled_is_an_error() {
    use fingertip_drivers::sensors::bota_serial::Frame;
    use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
    use std::io::Write as _;

    let folder = Folder::new();
    // Closed in programs that are begun from here: one that held this end, too, would see nothing pulled.
    let sensor = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC).unwrap();
    grantpt(&sensor).unwrap();
    unlockpt(&sensor).unwrap();
    let address = format!("bota://{}", ptsname(&sensor, Vec::new()).unwrap().to_str().unwrap());
    let mut sensor = File::from(sensor);
    let start = std::time::Instant::now();
    let silence = core::time::Duration::from_mins(10);
    let mut child = folder
        .command(&["record", &address, "-o", "a.csv", "--silence", &silence.as_secs().to_string()])
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    // What is sent before somebody listens is lost with the flush of whoever opens the line.
    let mut number = 0_u32;
    while !folder.has_begun("a.csv") && child.try_wait().unwrap().is_none() {
        let frame = Frame { components: [1.0; 6], microseconds: number * 2500, ..Frame::default() };
        sensor.write_all(&frame.emit()).unwrap();
        number += 1;
        std::thread::sleep(core::time::Duration::from_millis(2));
    }
    drop(sensor);
    let output = child.wait_with_output().unwrap();
    assert!(start.elapsed() < silence, "it waited for what cannot come");
    let error = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{error}");
    let samples = Contacts::parse(&folder.read("a.csv")).len();
    let expected = format!("s after the first sample, behind {samples} samples, which are recorded");
    assert!(samples > 0 && error.contains(&expected), "{error}");
    // And not that it fell silent.
    assert!(error.contains("the line was closed"), "{error}");
    assert!(!error.contains("Custom {") && !error.contains("os error 5"), "{error}");
}

/// What an Ethernet sensor of ATI is asked first is a page: what is wrong with that is said of it.
#[test]
fn a_page_that_is_refused_is_said_as_http() {
    use std::io::{Read as _, Write as _};

    let folder = Folder::new();
    let record =
        |port: u16| folder.fail(1, &["record", &format!("ati://127.0.0.1?http={port}"), "-o", "a.csv"]);
    let error = record(crate::common::unused_port());
    assert!(error.contains("HTTP: Connection refused") && !error.contains("UDP socket"), "{error}");
    for (answer, expected) in [
        ("HTTP/1.0 404 Not Found\r\n\r\n<html>none</html>", "HTTP: the sensor answers \"404 Not Found\""),
        ("HTTP/1.1 503 Busy\r\n\r\n<cfgcpf>1</cfgcpf>", "HTTP: the sensor answers \"503 Busy\""),
        ("HTTP/1.0 200 OK\r\n\r\n<netft></netft>", "configuration of the sensor"),
    ] {
        let listener = std::net::TcpListener::bind(("127.0.0.1", 0)).unwrap();
        let port = listener.local_addr().unwrap().port();
        let server = std::thread::spawn(move || {
            let (mut stream, _) = listener.accept().unwrap();
            let mut asked = [0; 64];
            let _ = stream.read(&mut asked);
            stream.write_all(answer.as_bytes()).unwrap();
        });
        let error = record(port);
        server.join().unwrap();
        assert!(error.contains(expected), "{error}");
    }
}
