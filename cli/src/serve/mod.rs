//! `fingertip simulate`: a simulated fingertip behind the protocol of a real sensor.

pub(crate) mod args;
mod load;
mod network;
mod serial;

use core::time::Duration;
use std::time::Instant;

use args::SimulateArguments;
use fingertip_drivers::devices::{ServeError, Simulator};
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

/// Whatever cannot be served.
fn fault(message: impl ToString) -> CliError {
    CliError::Simulate { message: message.to_string() }
}

pub(crate) fn run(arguments: &SimulateArguments) -> Result<(), CliError> {
    arguments.faults.check(arguments.serve)?;
    let rate = arguments.rate;
    if !(rate > 0.0 && rate <= 1e5) {
        return Err(CliError::option("--rate", rate, "must be above 0, up to 100000"));
    }
    let load = Load::new(arguments)?;
    let at = match arguments.duration.map(Duration::try_from_secs_f64).transpose() {
        Ok(duration) => duration.and_then(|duration| Instant::now().checked_add(duration)),
        Err(error) => return Err(fault(format!("--duration: {error}"))),
    };
    let end = End { stop: Stop::listen(), at };
    let said = match arguments.serve.simulator {
        Some(Simulator::Network(start)) => network::serve(start, arguments, load, &end),
        Some(Simulator::Serial(make)) => serial::serve(make(rate), arguments, load, &end),
        _ => Err(fault(format!("{} has no simulator that can be served", arguments.serve.name))),
    }?;
    print(&format!("\n{said}\n"))
}

impl From<ServeError> for CliError {
    fn from(error: ServeError) -> Self {
        fault(error)
    }
}

/// Says where the sensor can be found, as soon as it can be.
fn announce(arguments: &SimulateArguments, load: &Load, address: &str) -> Result<(), CliError> {
    let what = match &arguments.script {
        Some(path) => path.display().to_string(),
        None => format!("{:?}", arguments.scenario).to_lowercase(),
    };
    let name = arguments.serve.name;
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
