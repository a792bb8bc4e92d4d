//! Sensors on a network.

use alloc::sync::Arc;
use core::sync::atomic::{AtomicU64, Ordering};
use core::time::Duration;
use std::thread;

use fingertip_drivers::devices::{NetworkSimulator, ServeError, Serving};

use super::args::SimulateArguments;
use super::load::Load;
use super::{End, announce, fault, tally};
use crate::error::CliError;

/// How often it looks whether it is to end.
const NAP: Duration = Duration::from_millis(5);

pub(super) fn serve(
    start: fn(Serving) -> Result<NetworkSimulator, ServeError>,
    arguments: &SimulateArguments,
    load: Load,
    end: &End,
) -> Result<String, CliError> {
    let taken = Arc::new(AtomicU64::new(0));
    let (samples, mut playing) = (Arc::clone(&taken), load.clone());
    let simulator = start(Serving {
        listen: arguments.listen,
        port: arguments.port,
        http_port: arguments.http_port,
        udp_port: arguments.udp_port,
        faults: arguments.faults.of_datagrams(arguments.seed),
        rate: arguments.rate,
        // 0 begins the scenario anew.
        load: Box::new(move |number| {
            if number == 0 {
                playing.restart();
            }
            let wrench = playing.next();
            samples.store(playing.samples(), Ordering::Relaxed);
            wrench.components().into()
        }),
    })?;
    announce(arguments, &load, simulator.address())?;
    while !end.has_come() {
        thread::sleep(NAP);
    }
    let died = || fault("the server died; this is a fault of ours, please report it");
    let served = simulator.stop().ok_or_else(died)?;
    let injected = served.injected;
    let faults = format!(
        "{} lost on purpose, {} repeated, {} late, {} cut",
        injected.lost, injected.duplicates, injected.late, injected.corrupt
    );
    Ok(tally(taken.load(Ordering::Relaxed), served.sent, &faults))
}
