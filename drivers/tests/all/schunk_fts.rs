//! The receiver of SCHUNK's datagrams over a bad link.
#![cfg(all(feature = "schunk-fts", feature = "simulators"))]

use core::cell::Cell;
use core::net::SocketAddr;
use core::time::Duration;
use std::io;

use fingertip_drivers::middleware::{OnLoss, Supervised, SupervisedError};
use fingertip_drivers::polled::NbSource;
use fingertip_drivers::sensors::FaultPlan;
use fingertip_drivers::sensors::schunk_fts::{
    FtsClient, FtsClientError, FtsReceiver, FtsSample, FtsServer, Packet, SimulatedFts, emit_packet,
};
use fingertip_drivers::{Source, SourceError, SourceErrorKind};
use fingertip_wrench::Wrench;
use rand::{RngExt, SeedableRng};

use super::patience::{PATIENCE, SILENCE, patiently, unused_port};

#[test]
fn a_million_samples_over_a_bad_link_give_nothing_wrong_and_every_loss_is_counted() {
    let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(17);
    let mut receiver = FtsReceiver::default();
    let (mut lost, mut repeated, mut late, mut cut, mut given, mut last) =
        (0_u64, 0_u64, 0_u64, 0_u64, 0_u64, -1.0);
    let (mut bytes, mut held) = ([0; 512], None::<Vec<u8>>);
    let packets = 250_000_u32;
    for number in 0..packets {
        let sample = |of: u32| {
            let x = (4 * number + of) as f32;
            FtsSample { status: FtsSample::READY, components: [x, -x, 1.0, 2.0, x, 3.0] }
        };
        let length = emit_packet(
            number as u16,
            number as u8,
            &[sample(0), sample(1), sample(2), sample(3)],
            &mut bytes,
        )
        .unwrap();
        let datagram = bytes[..length].to_vec();
        let mut link = Vec::new();
        // The first and the last ones arrive.
        let calm = number == 0 || number > packets - 3;
        match random.random::<f64>() {
            _ if calm => link.push(datagram),
            chance if chance < 0.01 => lost += 1,
            chance if chance < 0.02 => {
                repeated += 1;
                link.extend([datagram.clone(), datagram]);
            }
            chance if chance < 0.03 && held.is_none() => {
                held = Some(datagram);
                continue;
            }
            chance if chance > 0.999 => {
                cut += 1;
                link.push(datagram[..random.random_range(0..length)].to_vec());
            }
            _ => link.push(datagram),
        }
        // Held back behind one that arrives whole.
        if link.last().is_some_and(|datagram| datagram.len() == length) {
            late += u64::from(held.is_some());
            link.extend(held.take());
        }
        for datagram in link {
            let Ok(packet) = Packet::new_checked(&datagram) else {
                receiver.note_corrupt();
                continue;
            };
            for wrench in receiver.accept::<f64>(&packet).into_iter().flatten() {
                let wrench: Wrench<f64> = wrench.unwrap();
                assert!(
                    wrench.force().x > last
                        && wrench.torque().y == wrench.force().x
                        && wrench.force().y == -wrench.force().x
                );
                (given, last) = (given + 1, wrench.force().x);
            }
        }
    }
    let found = receiver.statistics();
    println!("{found:?}");
    assert_eq!((found.lost, found.duplicates, found.late, found.corrupt), (lost + cut, repeated, late, cut));
    assert_eq!((found.doubtful, found.restarts), (0, 0));
    assert_eq!(given, 4 * (u64::from(packets) - lost - cut - late));
    assert_eq!(receiver.index(), u64::from(packets) - 1);
}

#[test]
fn a_sample_whose_status_is_not_clean_is_a_fault() {
    let mut bytes = [0; 64];
    for (number, status) in [0, 2, 3, 0x8000_0001].into_iter().enumerate() {
        let sample = FtsSample { status, components: [0.0; 6] };
        let length = emit_packet(number as u16, 0, &[sample], &mut bytes).unwrap();
        let mut receiver = FtsReceiver::default();
        let packet = Packet::new_checked(&bytes[..length]).unwrap();
        let fault = receiver.accept::<f64>(&packet).unwrap().next().unwrap().unwrap_err();
        assert_eq!(fault.status, status);
    }
}

fn load(number: u64) -> [f32; 6] {
    let x = number as f32;
    [x, -x, 1.0, 2.0, x, 3.0]
}

/// A server, and the address for datagrams that it sends to.
fn served(sensor: SimulatedFts) -> (FtsServer, SocketAddr) {
    let port = unused_port();
    let server = FtsServer::start("127.0.0.1:0", port, sensor, Duration::from_millis(2), load).unwrap();
    (server, nobody_at(port))
}

fn nobody_at(port: u16) -> SocketAddr {
    SocketAddr::from(([127, 0, 0, 1], port))
}

#[test]
fn over_sockets_nothing_is_lost_and_the_sensor_is_stopped_at_the_end() {
    // The datagrams' count wraps around on the way.
    let (server, local) = served(SimulatedFts::new(FaultPlan::default()).counting_from(65_500));
    let mut client = FtsClient::connect(server.address(), local, PATIENCE).unwrap();
    let next =
        |client: &mut FtsClient| Source::<f64, Wrench<f64>>::next_sample(client).unwrap().unwrap().value;
    let first = next(&mut client).force().x;
    for number in 1..60 {
        assert_eq!(next(&mut client).force().x, first + f64::from(number));
    }
    assert_eq!((client.statistics().received, client.statistics().lost), (60, 0));
    // The zero is set only on request.
    client.tare().unwrap();
    // What was sent before comes first.
    let tared = (0..10_000).any(|_| next(&mut client).force().z == 0.0);
    client.reset_tare().unwrap();
    let reset = (0..10_000).any(|_| next(&mut client).force().z == 1.0);
    assert!(tared && reset);
    // Polled: as many as come, and none that is waited for.
    let mut blocked = 0;
    let mut last = next(&mut client).force().x;
    let mut polled = 0;
    while polled < 20 || blocked == 0 {
        match NbSource::<f64, Wrench<f64>>::poll_sample(&mut client) {
            Ok(sample) => {
                let x = sample.unwrap().value.force().x;
                assert_eq!(x, last + 1.0);
                (last, polled) = (x, polled + 1);
            }
            Err(nb::Error::WouldBlock) => {
                blocked += 1;
                std::thread::sleep(Duration::from_micros(300));
            }
            Err(nb::Error::Other(error)) => panic!("{error}"),
        }
    }
    drop(client);
    assert!(!server.stop().unwrap().is_streaming());
}

#[test]
fn faults_silence_and_strangers_are_told_apart() {
    let mut sensor = SimulatedFts::new(FaultPlan { truncation: 1.0, ..FaultPlan::default() });
    sensor.set_status(0x10);
    let (server, local) = served(sensor);
    let mut client = FtsClient::connect(server.address(), local, PATIENCE).unwrap();
    let kind = |client: &mut FtsClient| Source::<f64, Wrench<f64>>::next_sample(client).unwrap_err().kind();
    assert_eq!(kind(&mut client), SourceErrorKind::Corrupt);
    assert!(client.statistics().corrupt > 0);
    drop((client, server));
    let mut sensor = SimulatedFts::new(FaultPlan::default());
    sensor.set_status(0x10);
    let (server, local) = served(sensor);
    let mut client = FtsClient::connect(server.address(), local, PATIENCE).unwrap();
    assert_eq!(kind(&mut client), SourceErrorKind::DeviceFault);
    drop((client, server));
    // Nobody there.
    let error = FtsClient::connect(nobody_at(unused_port()), "127.0.0.1:0", PATIENCE).unwrap_err();
    assert_eq!(error.kind(), SourceErrorKind::Transport, "{error}");
}

/// Whether an answer did not come in time.
fn is_late(error: &FtsClientError) -> bool {
    let FtsClientError::Socket(error) = error else { return false };
    matches!(error.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut)
}

#[test]
fn a_sensor_that_goes_away_is_found_again_or_the_end_by_choice() {
    let (server, local) = served(SimulatedFts::new(FaultPlan::default()));
    let address = std::sync::Mutex::new(server.address());
    // A server answers at once, but a busy machine may not let it: only that is tried again, with twice the time.
    let (served_there, attempts) = (Cell::new(true), 9);
    let connect = |attempt: u32| {
        let connected = FtsClient::connect(*address.lock().unwrap(), local, SILENCE * (1 << attempt));
        if let Err(error) = &connected {
            assert!(is_late(error) || !served_there.get(), "{error}");
        }
        connected
    };
    let mut source = Supervised::new(connect, OnLoss::Reconnect { attempts }).unwrap();
    let next = |source: &mut dyn Source<f64, Wrench<f64>, Error = SupervisedError<FtsClientError>>| {
        source.next_sample().map(|sample| sample.unwrap().value.force().z)
    };
    assert_eq!(next(&mut source).unwrap(), 1.0);
    drop(server);
    // It comes back at another port, as a sensor does at another address.
    let server = FtsServer::start(
        "127.0.0.1:0",
        local.port(),
        SimulatedFts::new(FaultPlan::default()),
        Duration::from_millis(2),
        load,
    )
    .unwrap();
    *address.lock().unwrap() = server.address();
    // What was in the socket's buffer before is given, too.
    while source.reconnections() == 0 {
        assert_eq!(next(&mut source).unwrap(), 1.0);
    }
    assert_eq!(next(&mut source).unwrap(), 1.0);
    drop(source);
    let tried =
        (0..attempts).find_map(|tried| Supervised::new(move |_| connect(tried), OnLoss::FailStop).ok());
    let mut stops = tried.unwrap();
    assert_eq!(patiently(&mut stops).value.force().z, 1.0);
    drop(server);
    let error = loop {
        if let Err(error) = next(&mut stops) {
            break error;
        }
    };
    assert!(matches!(error, SupervisedError::Lost(_)));
    assert!(matches!(next(&mut stops), Err(SupervisedError::Stopped)));
    *address.lock().unwrap() = nobody_at(unused_port());
    served_there.set(false);
    assert!(stops.resume().is_err());
    assert!(matches!(next(&mut stops), Err(SupervisedError::Stopped)));
}
