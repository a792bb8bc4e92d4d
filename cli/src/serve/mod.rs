//! `fingertip simulate`: a simulated fingertip behind the protocol of a real sensor.

pub(crate) mod args;
mod ati;
mod load;
mod schunk;
mod serial;

use alloc::sync::Arc;
use core::sync::atomic::{AtomicU64, Ordering};
use core::time::Duration;
use std::io;
use std::time::Instant;

use args::{Device, SimulateArguments};
use clap::ValueEnum;
use fingertip_drivers::sensors::SimulatedSensor;
use load::Load;

use crate::error::CliError;
use crate::output::print;
use crate::stop::Stop;
use crate::table::{count, short};

/// When to end.
pub(super) struct End {
    stop: Stop,
    at: Option<Instant>,
}

impl End {
    pub(super) fn has_come(&self) -> bool {
        self.stop.is_asked() || self.at.is_some_and(|at| Instant::now() >= at)
    }
}

/// How often a server that answers in a thread of its own looks whether it is to end.
const NAP: Duration = Duration::from_millis(5);

/// The load as a server in a thread of its own takes it; how many samples it took can be asked from outside.
struct Played {
    load: Load,
    samples: Arc<AtomicU64>,
}

impl Played {
    fn new(load: Load) -> (Self, Arc<AtomicU64>) {
        let samples = Arc::default();
        (Self { load, samples: Arc::clone(&samples) }, samples)
    }

    /// The components of a sample by its number; 0 begins the scenario anew.
    fn next(&mut self, number: u64) -> [f64; 6] {
        if number == 0 {
            self.load.restart();
        }
        let wrench = self.load.next();
        self.samples.store(self.load.samples(), Ordering::Relaxed);
        wrench.components().into()
    }
}

/// Whatever cannot be served.
fn fault(message: impl ToString) -> CliError {
    CliError::Simulate { message: message.to_string() }
}

pub(crate) fn run(arguments: &SimulateArguments) -> Result<(), CliError> {
    arguments.faults.check(arguments.serve).map_err(fault)?;
    let period = Some(arguments.rate).filter(|rate| *rate > 0.0 && *rate <= 1e5);
    let period =
        period.ok_or_else(|| fault(format!("--rate {} must be above 0, up to 100000", arguments.rate)))?;
    let period = Duration::from_secs_f64(1.0 / period);
    let load = Load::new(arguments)?;
    let at = match arguments.duration.map(Duration::try_from_secs_f64).transpose() {
        Ok(duration) => duration.and_then(|duration| Instant::now().checked_add(duration)),
        Err(error) => return Err(fault(format!("--duration: {error}"))),
    };
    let end = End { stop: Stop::listen(), at };
    let said = match arguments.serve {
        Device::Ati => ati::serve(arguments, period, load, &end),
        Device::Schunk => schunk::serve(arguments, period, load, &end),
        _ => serial::serve(arguments, period, load, &end),
    }?;
    print(&format!("\n{said}\n"))
}

fn cannot_bind(transport: &str, port: u16) -> impl Fn(io::Error) -> CliError {
    move |error| {
        fault(format!(
            "cannot serve on {transport} port {port}: {error}; choose another --port, 0 for any free one"
        ))
    }
}

fn died() -> CliError {
    fault("the server died; this is a fault of ours, please report it")
}

/// Says where the sensor can be found, as soon as it can be.
fn announce(arguments: &SimulateArguments, load: &Load, address: &str) -> Result<(), CliError> {
    let what = match &arguments.script {
        Some(path) => path.display().to_string(),
        None => format!("{:?}", arguments.scenario).to_lowercase(),
    };
    let name =
        arguments.serve.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned());
    print(&format!(
        "Simulated sensor {name}: {} samples/s, {what} ({} s, begun anew by each client, then repeated)\nAddress: \
         {address}\nTry: fingertip live --scene sim '{address}'\nCtrl-C ends it.\n",
        short(arguments.rate),
        short(load.duration())
    ))
}

/// What was done to frames or datagrams.
fn tally(samples: u64, sent: u64, faults: &str) -> String {
    format!("{} samples, {} sent; {faults}", count(samples), count(sent))
}

fn tally_datagrams<Device>(samples: &AtomicU64, sensor: &SimulatedSensor<Device>) -> String {
    let injected = sensor.injected();
    tally(
        samples.load(Ordering::Relaxed),
        sensor.sent(),
        &format!(
            "{} lost on purpose, {} repeated, {} late, {} cut",
            injected.lost, injected.duplicates, injected.late, injected.corrupt
        ),
    )
}
