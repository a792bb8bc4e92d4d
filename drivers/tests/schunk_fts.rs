//! The receiver of SCHUNK's datagrams over a bad link.
#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests")]
#![cfg(all(feature = "schunk-fts", feature = "simulation"))]

use fingertip_drivers::schunk_fts::{FtsReceiver, FtsSample, Packet, emit_packet};
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
