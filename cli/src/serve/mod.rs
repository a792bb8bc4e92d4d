//! `fingertip simulate`: a simulated fingertip behind the protocol of a real sensor.

pub(crate) mod args;
mod ati;
mod frames;
mod load;
mod schunk;
mod serial;

use core::time::Duration;
use std::io::{self, Write};
use std::thread;
use std::time::Instant;

use args::{Device, SimulateArguments};
use clap::ValueEnum;
use load::Load;

use crate::error::CliError;
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

/// Steps of a period that are due, as the clock goes on.
pub(super) struct Pace {
    period: Duration,
    next: Instant,
}

/// A server that was stopped for so long goes on from now, and sends no burst.
const LONGEST_BURST: Duration = Duration::from_millis(100);

impl Pace {
    pub(super) fn new(period: Duration) -> Self {
        Self { period, next: Instant::now() }
    }

    /// Begins anew.
    pub(super) fn restart(&mut self) {
        self.next = Instant::now();
    }

    /// Whether a step is due; if not, waits a little.
    pub(super) fn is_due(&mut self) -> bool {
        let now = Instant::now();
        if now < self.next {
            thread::sleep((self.next - now).min(Duration::from_millis(1)));
            return false;
        }
        self.next += self.period;
        if now > self.next + LONGEST_BURST {
            self.next = now;
        }
        true
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
    say(&format!("\n{said}\n"))
}

/// Says where the sensor can be found, as soon as it can be.
fn announce(arguments: &SimulateArguments, load: &Load, address: &str) -> Result<(), CliError> {
    let what = match &arguments.script {
        Some(path) => path.display().to_string(),
        None => format!("{:?}", arguments.scenario).to_lowercase(),
    };
    let name =
        arguments.serve.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned());
    say(&format!(
        "Simulated sensor {name}: {} samples/s, {what} ({} s, begun anew by each client, then repeated)\nAddress: \
         {address}\nTry: fingertip live --scene sim '{address}'\nCtrl-C ends it.\n",
        short(arguments.rate),
        short(load.duration())
    ))
}

fn say(text: &str) -> Result<(), CliError> {
    let mut stdout = io::stdout();
    stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()).map_err(CliError::stdout)
}

/// What was done to frames or datagrams.
fn tally(samples: u64, sent: u64, faults: &str) -> String {
    format!("{} samples, {} sent; {faults}", count(samples), count(sent))
}
