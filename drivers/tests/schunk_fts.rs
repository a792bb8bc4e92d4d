//! The receiver of SCHUNK's datagrams over a bad link.
#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests")]
#![cfg(all(feature = "schunk-fts", feature = "simulation"))]

use fingertip_drivers::schunk_fts::{Command, CommandAnswer, FtsReceiver, FtsSample, Packet, emit_packet};
use fingertip_wrench::Wrench;
use rand::{RngExt, SeedableRng};

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

/// A sensor that answers one command and sends three datagrams, the second one lost.
#[test]
fn a_client_starts_the_sensor_and_takes_its_samples() {
    use core::time::Duration;
    use std::io::{Read, Write};
    use std::net::{TcpListener, UdpSocket};

    use fingertip_drivers::schunk_fts::{FtsClient, FtsClientError};
    use fingertip_drivers::{SourceError, SourceErrorKind, WrenchSource};

    let commands = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = commands.local_addr().unwrap();
    let free = UdpSocket::bind("127.0.0.1:0").unwrap().local_addr().unwrap();
    let sensor = std::thread::spawn(move || {
        let mut heard = Vec::new();
        for error in [7, 0] {
            let (mut stream, _) = commands.accept().unwrap();
            let mut bytes = [0; Command::LENGTH];
            stream.read_exact(&mut bytes).unwrap();
            let (counter, command) = Command::parse(&bytes).unwrap();
            stream.write_all(&CommandAnswer { command, error }.emit(counter)).unwrap();
            heard.push(command);
            if error > 0 {
                continue;
            }
            let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
            for (counter, status) in [(5_u8, 1), (7, 1), (8, 3)] {
                let components = [f32::from(counter), 0.0, 0.0, 0.0, 0.0, 0.5];
                let mut datagram = [0; 100];
                let samples = [FtsSample { status, components }];
                let length = emit_packet(u16::from(counter), 0, &samples, &mut datagram).unwrap();
                socket.send_to(&datagram[..length], free).unwrap();
            }
            // Until it is told to stop.
            stream.read_exact(&mut bytes).unwrap();
            heard.push(Command::parse(&bytes).unwrap().1);
        }
        heard
    });
    let wait = Duration::from_secs(5);
    let refused = FtsClient::<f64>::connect(address, free, wait).unwrap_err();
    assert!(matches!(refused, FtsClientError::Refused { command: Command::StartUdp, error: 7 }), "{refused}");
    let mut client = FtsClient::<f64>::connect(address, free, wait).unwrap().timed_by(1000.0);
    let first = client.next_wrench().unwrap().unwrap();
    let second = client.next_wrench().unwrap().unwrap();
    assert_eq!((first.value.force().x, second.value.force().x), (5.0, 7.0));
    // The time goes on over the one that is lost.
    assert!((second.time.unwrap() - first.time.unwrap() - 2e-3).abs() < 1e-12);
    assert_eq!(client.next_wrench().unwrap_err().kind(), SourceErrorKind::DeviceFault);
    assert_eq!((client.statistics().received, client.statistics().lost), (3, 1));
    drop(client);
    assert_eq!(sensor.join().unwrap(), [Command::StartUdp, Command::StartUdp, Command::StopUdp]);
}
