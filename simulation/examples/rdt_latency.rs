//! Records at 100 000 a second over the loopback interface, each followed from the datagram to the
//! contact: `cargo run --release -p fingertip-simulation --example rdt_latency`
//!
//! One thread sends and notes when; the other receives through the client, resolves the contact on a
//! sphere with a friction margin, and notes when that is done. On a machine with one free core the two
//! take turns and the figures mean little: there, `--one-thread` sends each record and receives it at once,
//! so that nobody waits for a turn. `--poll` receives without blocking.

extern crate alloc;

use alloc::sync::Arc;
use core::error::Error;
use core::sync::atomic::{AtomicU64, Ordering};
use core::time::Duration;
use std::net::UdpSocket;
use std::time::Instant;

use fingertip::Fingertip;
use fingertip::contact::PointContact;
use fingertip::friction::Coulomb;
use fingertip::surfaces::Sphere;
use fingertip_drivers::Source;
use fingertip_drivers::polled::NbSource;
use fingertip_drivers::sensors::LinkStatistics;
use fingertip_drivers::sensors::ati_rdt::{ClientError, CountsPerUnit, RdtClient, Record};

const RECORDS: u32 = 500_000;
const RATE: f64 = 100_000.0;

fn main() -> Result<(), Box<dyn Error>> {
    let polled = std::env::args().any(|argument| argument == "--poll");
    let begin = Instant::now();
    let now = move || u64::try_from(begin.elapsed().as_nanos()).unwrap_or(u64::MAX);
    let sensor = UdpSocket::bind("127.0.0.1:0")?;
    let mut client: RdtClient<f64> =
        RdtClient::connect(sensor.local_addr()?, CountsPerUnit::million()?, Duration::from_millis(500))?;
    let mut request = [0; 8];
    let (_, address) = sensor.recv_from(&mut request)?;
    sensor.connect(address)?;
    let mut fingertip = Fingertip::builder()
        .contact(Sphere::centred(13e-3)?, PointContact::new(0.1)?)
        .friction(Coulomb::new(0.6)?)
        .build();
    if std::env::args().any(|argument| argument == "--one-thread") {
        let mut latencies = Vec::new();
        let start = Instant::now();
        for number in 0..RECORDS {
            while start.elapsed().as_secs_f64() < f64::from(number) / RATE {
                core::hint::spin_loop();
            }
            let before = now();
            sensor.send(&record(number).emit())?;
            let wrench = client.next_sample()?.ok_or("the sensor is gone")?.value;
            let touch = fingertip.sense_wrench(wrench, 1.0 / RATE);
            touch.resolution.into_result().map_err(|reason| format!("no contact: {reason:?}"))?;
            latencies.push(now().saturating_sub(before));
        }
        let rate = f64::from(RECORDS) / start.elapsed().as_secs_f64();
        say("one thread", rate, &mut latencies, client.statistics());
        return Ok(());
    }
    let sent: Arc<Vec<AtomicU64>> = Arc::new((0..RECORDS).map(|_| AtomicU64::new(0)).collect());
    let note = Arc::clone(&sent);
    let sender = std::thread::spawn(move || -> std::io::Result<f64> {
        let start = Instant::now();
        for (number, place) in (0_u32..).zip(note.iter()) {
            let due = f64::from(number) / RATE;
            while start.elapsed().as_secs_f64() < due {
                core::hint::spin_loop();
            }
            let record = record(number).emit();
            place.store(now(), Ordering::Release);
            sensor.send(&record)?;
        }
        Ok(f64::from(RECORDS) / start.elapsed().as_secs_f64())
    });
    let mut latencies = Vec::with_capacity(sent.len());
    let mut contacts = 0_u32;
    while client.statistics().received < u64::from(RECORDS) {
        let next = if polled {
            match client.poll_sample() {
                Ok(sample) => Ok(sample),
                Err(nb::Error::WouldBlock) if sender.is_finished() => break,
                Err(nb::Error::WouldBlock) => continue,
                Err(nb::Error::Other(error)) => Err(error),
            }
        } else {
            client.next_sample()
        };
        let wrench = match next {
            Ok(Some(sample)) => sample.value,
            Err(ClientError::Timeout { .. }) | Ok(None) => break,
            Err(error) => return Err(error.into()),
        };
        let touch = fingertip.sense_wrench(wrench, 1.0 / RATE);
        contacts += u32::from(touch.resolution.into_result().is_ok());
        let index = usize::try_from(client.statistics().received + client.statistics().lost - 1)?;
        if let Some(time) = sent.get(index) {
            latencies.push(now().saturating_sub(time.load(Ordering::Acquire)));
        }
    }
    let rate = sender.join().map_err(|_| "the sender died")??;
    say(if polled { "polled" } else { "blocking" }, rate, &mut latencies, client.statistics());
    println!("{contacts} contacts");
    Ok(())
}

/// 0.5 N along x and 2 N against z, moving about.
fn record(number: u32) -> Record {
    let x = 500_000 + i32::try_from(number % 1000).unwrap_or(0);
    let counts = [x, 0, -2_000_000, 0, 6_500, 0];
    Record { rdt_sequence: number + 1, ft_sequence: number, status: 0, counts }
}

/// Prints the rate and the quantiles of latencies \[ns\].
fn say(how: &str, rate: f64, latencies: &mut [u64], statistics: &LinkStatistics) {
    latencies.sort_unstable();
    let quantile = |share: f64| {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an index")]
        let index = ((latencies.len() as f64 - 1.0).max(0.0) * share) as usize;
        latencies.get(index).map_or(f64::NAN, |nanoseconds| *nanoseconds as f64 * 1e-3)
    };
    println!(
        "{how}: {rate:.0} records/s sent; {} received, {} lost; datagram to contact: median {:.1} µs, 99 % {:.1} µs, \
         99.9 % {:.1} µs, worst {:.1} µs",
        statistics.received,
        u64::from(RECORDS) - statistics.received,
        quantile(0.5),
        quantile(0.99),
        quantile(0.999),
        quantile(1.0),
    );
}
