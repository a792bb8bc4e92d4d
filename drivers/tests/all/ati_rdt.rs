//! The RDT receiver and client against the simulated sensor.
#![cfg(all(feature = "ati-rdt", feature = "simulators"))]

use alloc::sync::Arc;
use core::cell::RefCell;
use core::sync::atomic::{AtomicU64, Ordering};
use core::time::Duration;
use std::sync::{Mutex, MutexGuard};

use fingertip_drivers::middleware::{OnLoss, Supervised, SupervisedError, Watched};
use fingertip_drivers::sensors::ati_rdt::{
    ClientError, Command, Configuration, CountsPerUnit, FaultPlan, RdtClient, RdtError, RdtServer, Receiver,
    Record, Request, SimulatedNetFt, records,
};
use fingertip_drivers::{Source, SourceError, SourceErrorKind};

use super::patience::{PATIENCE, SILENCE, patiently};

fn counts() -> CountsPerUnit<f64> {
    CountsPerUnit::million().unwrap()
}

/// The load of the sample of that number: the number itself can be read from it.
fn load(number: i32) -> [i32; 6] {
    [number, -number, number / 2, 7, -8, 9]
}

fn start() -> [u8; 8] {
    Request { command: Command::Stream, count: 0 }.emit()
}

#[test]
fn a_million_records_over_a_bad_link_give_nothing_wrong_and_every_loss_is_counted() {
    let faults = FaultPlan { loss: 0.01, duplication: 0.01, reorder: 0.01, truncation: 0.001, seed: 11 };
    // It wraps around on the way.
    let mut sensor = SimulatedNetFt::new(faults).counting_from(u32::MAX - 300_000);
    sensor.request(&start());
    let mut receiver = Receiver::new(counts());
    let (mut last, mut given) = (-1.0, 0_u64);
    let mut first = None;
    let samples = 1_000_000;
    for number in 0..samples {
        sensor.sample(load(number));
        while let Some(datagram) = sensor.datagram() {
            let Ok(packets) = records(&datagram) else {
                receiver.note_corrupt();
                continue;
            };
            for packet in packets {
                let Some(wrench) = receiver.accept(&Record::parse(&packet)).unwrap() else { continue };
                let seen = (wrench.force().x * 1e6).round();
                // Newer than all before, and whole.
                assert!(seen > last);
                assert_eq!(wrench.force().y, -wrench.force().x);
                assert_eq!(receiver.index() as f64, seen - *first.get_or_insert(seen));
                (last, given) = (seen, given + 1);
            }
        }
    }
    let (found, injected) = (receiver.statistics(), sensor.injected());
    println!("{found:?}\n{injected:?}");
    assert_eq!(found.corrupt, injected.corrupt);
    // A record that was cut is lost, too.
    assert_eq!(found.lost, injected.lost + injected.corrupt);
    assert_eq!((found.duplicates, found.late), (injected.duplicates, injected.late));
    assert_eq!((found.doubtful, found.restarts), (0, 0));
    assert_eq!(given + found.late + found.lost, samples as u64);
}

#[test]
fn over_a_socket_nothing_is_lost_and_the_sensor_is_stopped_at_the_end() {
    let sensor = SimulatedNetFt::new(FaultPlan::default());
    let taken = Arc::new(AtomicU64::new(0));
    let counter = Arc::clone(&taken);
    let counted = move |number| {
        counter.store(number, Ordering::Relaxed);
        load(number as i32)
    };
    let server = RdtServer::start("127.0.0.1:0", sensor, Duration::from_millis(5), counted).unwrap();
    let mut client = RdtClient::connect(server.address(), counts(), PATIENCE).unwrap().timed_by(200.0);
    let mut last: Option<(f64, f64)> = None;
    for _ in 0..60 {
        let sample = client.next_sample().unwrap().unwrap();
        let (time, number) = (sample.time.unwrap(), (sample.value.force().x * 1e6).round());
        if let Some((last_time, last_number)) = last {
            assert_eq!(number, last_number + 1.0);
            assert!((time - last_time - 5e-3).abs() < 1e-12);
        }
        last = Some((time, number));
    }
    assert_eq!((client.statistics().received, client.statistics().lost), (60, 0));
    // The newest one, when some more were sent: each of them is given or passed over.
    let last = last.unwrap().1 as u64;
    let mut watched = Watched::new(client, Some(5e-3));
    while taken.load(Ordering::Relaxed) < last + 5 {
        std::thread::sleep(Duration::from_millis(1));
    }
    let latest = loop {
        match watched.latest(0.0) {
            Ok(latest) => break latest.unwrap(),
            Err(nb::Error::WouldBlock) => std::thread::yield_now(),
            Err(nb::Error::Other(error)) => panic!("{error}"),
        }
    };
    let (newest, counts) = ((latest.sample.value.force().x * 1e6).round() as u64, watched.counts());
    assert!(newest > last);
    assert_eq!((counts.given + counts.passed_over, counts.missing), (newest - last, 0));
    drop(watched);
    assert!(!server.stop().unwrap().is_streaming());
}

#[test]
fn faults_of_the_sensor_and_silence_are_errors_of_their_kinds() {
    let mut sensor = SimulatedNetFt::new(FaultPlan::default());
    sensor.set_status(0x8000_0001);
    let server = RdtServer::start("127.0.0.1:0", sensor, Duration::from_millis(1), |_| [0; 6]).unwrap();
    let mut client = RdtClient::connect(server.address(), counts(), PATIENCE).unwrap();
    let error = client.next_sample().unwrap_err();
    assert!(matches!(error, ClientError::Rdt(RdtError::Status { status: 0x8000_0001, .. })), "{error}");
    assert_eq!(error.kind(), SourceErrorKind::DeviceFault);
    // A port where nobody serves: bound, so that nobody else can have it, but never answered.
    let silent = std::net::UdpSocket::bind("127.0.0.1:0").unwrap();
    let mut client = RdtClient::connect(silent.local_addr().unwrap(), counts(), SILENCE).unwrap();
    let error = client.next_sample().unwrap_err();
    assert_eq!(error.kind(), SourceErrorKind::Timeout, "{error}");
    assert!(CountsPerUnit::new(0.0, 1.0).is_err() && CountsPerUnit::new(1.0, f64::NAN).is_err());
}

#[test]
fn the_sensor_is_biased_only_on_request() {
    let mut sensor = SimulatedNetFt::new(FaultPlan::default());
    sensor.request(&Request { command: Command::Stream, count: 2 }.emit());
    sensor.sample([5; 6]);
    let first = sensor.datagram().unwrap();
    sensor.request(&Request { command: Command::Bias, count: 0 }.emit());
    sensor.sample([6; 6]);
    let second = sensor.datagram().unwrap();
    let counts_of = |datagram: &[u8]| records(datagram).unwrap().next().unwrap().counts();
    assert_eq!((counts_of(&first), counts_of(&second)), ([5; 6], [1; 6]));
    // Two were asked for.
    sensor.sample([7; 6]);
    assert_eq!((sensor.datagram(), sensor.is_streaming()), (None, false));
}

#[test]
fn the_configuration_is_asked_for_over_http() {
    use std::io::{Read, Write};
    let listener = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap();
    let server = std::thread::spawn(move || {
        let (mut stream, _) = listener.accept().unwrap();
        let mut request = [0; 31];
        stream.read_exact(&mut request).unwrap();
        assert!(request.starts_with(b"GET /netftapi2.xml HTTP/1.0\r\n"));
        let page =
            "<netft><scfgfu>N</scfgfu><scfgtu>Nmm</scfgtu><cfgcpf>1000</cfgcpf><cfgcpt>50</cfgcpt></netft>";
        write!(stream, "HTTP/1.0 200 OK\r\n\r\n{page}").unwrap();
    });
    let configuration = RdtClient::<f64>::configuration(address, PATIENCE).unwrap();
    server.join().unwrap();
    assert_eq!((configuration.counts_per_newton, configuration.rate), (1000.0, None));
    assert!((configuration.counts_per_newton_metre - 50_000.0).abs() < 1e-9);
}

#[test]
fn a_sensor_that_falls_silent_is_asked_again_or_given_up_by_choice() {
    // It is silent while somebody holds this.
    let speech = Arc::new(Mutex::new(()));
    let held = Arc::clone(&speech);
    let sensor = SimulatedNetFt::new(FaultPlan::default());
    let server = RdtServer::start("127.0.0.1:0", sensor, Duration::from_millis(2), move |_| {
        drop(held.lock());
        load(7)
    })
    .unwrap();
    let connect = |_| RdtClient::<f64>::connect(server.address(), counts(), SILENCE);
    let silence = RefCell::new(None::<MutexGuard<'_, ()>>);
    let ask_again = |attempt| {
        if attempt == 3 {
            silence.take();
        }
        connect(attempt)
    };
    let mut again = Supervised::new(ask_again, OnLoss::Reconnect { attempts: 1000 }).unwrap();
    let mut stops = Supervised::new(connect, OnLoss::FailStop).unwrap();
    // The sensor serves whoever asked last.
    assert_eq!(patiently(&mut stops).value.force().x, 7e-6);
    *silence.borrow_mut() = Some(speech.lock().unwrap());
    while stops.next_sample().is_ok() {}
    assert!(matches!(stops.next_sample(), Err(SupervisedError::Stopped)));
    // What reached its socket before the other one asked is given first.
    while again.losses() == 0 {
        assert_eq!(again.next_sample().unwrap().unwrap().value.force().x, 7e-6);
    }
    assert!(again.losses() > 3 && again.reconnections() == again.losses());
    // It stays stopped until it is told to go on, though the sensor speaks again.
    assert!(matches!(stops.next_sample(), Err(SupervisedError::Stopped)));
    stops.resume().unwrap();
    assert_eq!(patiently(&mut stops).value.force().x, 7e-6);
}

#[test]
fn a_rate_that_is_none_is_not_taken_for_one() {
    let rate = |text: &str| {
        let page = format!(
            "<scfgfu>N</scfgfu><scfgtu>Nm</scfgtu><cfgcpf>1</cfgcpf><cfgcpt>1</cfgcpt><comrdtrate>{text}</comrdtrate>"
        );
        Configuration::parse(&page).unwrap().rate
    };
    assert_eq!((rate("0"), rate("-1"), rate("7000")), (None, None, Some(7000.0)));
}

#[test]
fn datagrams_that_are_cut_are_errors_and_counted() {
    let sensor = SimulatedNetFt::new(FaultPlan { truncation: 1.0, seed: 5, ..FaultPlan::default() });
    let server =
        RdtServer::start("127.0.0.1:0", sensor, Duration::from_millis(1), |number| load(number as i32))
            .unwrap();
    let mut client = RdtClient::connect(server.address(), counts(), PATIENCE).unwrap();
    for count in 1..=3 {
        let error = client.next_sample().unwrap_err();
        assert_eq!(error.kind(), SourceErrorKind::Corrupt, "{error}");
        assert_eq!((client.statistics().corrupt, client.statistics().received), (count, 0));
    }
}

#[test]
fn a_rate_that_cannot_be_gives_no_times() {
    let sensor = SimulatedNetFt::new(FaultPlan::default());
    let server = RdtServer::start("127.0.0.1:0", sensor, Duration::from_millis(1), |_| [0; 6]).unwrap();
    for rate in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let mut client = RdtClient::connect(server.address(), counts(), PATIENCE).unwrap().timed_by(rate);
        assert_eq!(client.next_sample().unwrap().unwrap().time, None, "{rate}");
    }
}

/// A simulator, and where its page is.
fn simulator_with_page() -> (fingertip_drivers::devices::NetworkSimulator, core::net::SocketAddr) {
    use fingertip_drivers::devices::{Serving, Simulator, devices};

    let device = devices().iter().find(|device| device.name == "ati").unwrap();
    let Some(Simulator::Network(start)) = device.simulator else { panic!() };
    let simulator = start(Serving {
        listen: [127, 0, 0, 1].into(),
        port: Some(0),
        http_port: 0,
        udp_port: 0,
        faults: FaultPlan::default(),
        rate: 100.0,
        load: Box::new(|_| [0.0; 6]),
    })
    .unwrap();
    let http = simulator.address().rsplit_once("http=").unwrap().1.parse().unwrap();
    (simulator, ([127, 0, 0, 1], http).into())
}

/// All that is answered to a request, until the connection is closed.
fn answer_to(page: core::net::SocketAddr, pieces: &[&[u8]], pause: Duration) -> Vec<u8> {
    use std::io::{Read as _, Write as _};

    let mut stream = std::net::TcpStream::connect(page).unwrap();
    stream.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
    for piece in pieces {
        // It may have been closed meanwhile.
        if stream.write_all(piece).is_err() {
            break;
        }
        std::thread::sleep(pause);
    }
    let mut answer = Vec::new();
    let _ = stream.read_to_end(&mut answer);
    answer
}

/// Somebody who asks and says no more does not keep others from the page.
#[test]
fn half_open_connections_do_not_block_the_page() {
    let (_simulator, page) = simulator_with_page();
    let idle: Vec<_> = (0..20).map(|_| std::net::TcpStream::connect(page).unwrap()).collect();
    // Twenty in a row would take ten seconds.
    let configuration = RdtClient::<f64>::configuration(page, Duration::from_secs(5)).unwrap();
    assert_eq!(configuration.counts_per_newton, 1e6);
    drop(idle);
}

/// More than are answered at a time are turned away at once; when these are given up, the page is there again.
#[test]
fn the_page_outlives_a_crowd_that_says_nothing() {
    let (_simulator, page) = simulator_with_page();
    let crowd: Vec<_> = (0..200).map(|_| std::net::TcpStream::connect(page).unwrap()).collect();
    let begun = std::time::Instant::now();
    loop {
        match RdtClient::<f64>::configuration(page, Duration::from_secs(5)) {
            Ok(configuration) => break assert_eq!(configuration.counts_per_newton, 1e6),
            Err(error) => assert!(begun.elapsed() < Duration::from_secs(60), "{error}"),
        }
    }
    drop(crowd);
}

/// What is no request for the page is refused by its reason, and what drips is given up, as a whole and not byte by byte.
#[test]
fn the_page_refuses_what_is_no_request_for_it() {
    let (_simulator, page) = simulator_with_page();
    let asked = |pieces: &[&[u8]], pause| answer_to(page, pieces, Duration::from_millis(pause));
    let begins = |answer: &[u8], with: &str| {
        assert!(answer.starts_with(with.as_bytes()), "{with}: {}", String::from_utf8_lossy(answer));
    };
    begins(&asked(&[b"GET /netftapi2.xml HTTP/1.0\r\n\r\n"], 0), "HTTP/1.0 200 OK\r\n");
    begins(&asked(&[b"GET /netft", b"api2.xml HTTP/1.0\r", b"\n\r\n"], 20), "HTTP/1.0 200 OK\r\n");
    begins(&asked(&[b"GET /other HTTP/1.0\r\n\r\n"], 0), "HTTP/1.0 404 ");
    begins(&asked(&[b"DELETE /netftapi2.xml HTTP/1.0\r\n\r\n"], 0), "HTTP/1.0 405 ");
    begins(&asked(&[&[b'x'; 30_000]], 0), "HTTP/1.0 431 ");
    begins(&asked(&[&[0x16, 3, 1, 0, 5, b'\r', b'\n', b'\r', b'\n']], 0), "HTTP/1.0 405 ");
    // Each byte comes soon after the last one, and the whole never.
    let drips: Vec<&[u8]> = core::iter::repeat_n(&b"G"[..], 100).collect();
    assert_eq!(String::from_utf8_lossy(&asked(&drips, 20)), "");
    // Nothing of this keeps the next one from the page.
    assert!(RdtClient::<f64>::configuration(page, Duration::from_secs(5)).is_ok());
}

/// All of a page must have come in time, however often a little of it comes.
#[test]
fn a_page_that_drips_is_given_up() {
    use std::io::Write as _;

    let listener = std::net::TcpListener::bind(("127.0.0.1", 0)).unwrap();
    let address = listener.local_addr().unwrap();
    let server = std::thread::spawn(move || {
        let (mut stream, _) = listener.accept().unwrap();
        // It goes on until nobody listens.
        while stream.write_all(b"<").is_ok() {
            std::thread::sleep(Duration::from_millis(20));
        }
    });
    let error = RdtClient::<f64>::configuration(address, Duration::from_millis(200)).unwrap_err();
    assert!(matches!(error, ClientError::Page(_)) && error.to_string().starts_with("HTTP: "), "{error}");
    server.join().unwrap();
}
