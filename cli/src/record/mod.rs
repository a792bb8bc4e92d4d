//! `fingertip record`: a sensor into a file.

pub(crate) mod args;
mod drawing;
mod output;

use core::time::Duration;
use std::time::{Instant, SystemTime, UNIX_EPOCH};

use indicatif::ProgressBar;

use args::RecordArguments;
use fingertip_bridges::About;
use output::{Numbered, Output, Row};

use crate::about::about;
use crate::error::CliError;
use crate::felt::{NoZero, Rest, SceneFeel};
use crate::output::{Outputs, printable};
use crate::recording_file::Kind;
use crate::scene::{load_or_simulated, warn_of_doubts};
use crate::sensor::{self, Event, Reading, SensorError, Stream, StreamOptions};
use crate::stop::Stop;
use crate::table::{count, number, short};
use crate::verbosity::is_quiet;

/// How often the terminal is told how far it is.
const NEWS: Duration = Duration::from_millis(500);
/// How many faults are printed one by one.
const FAULTS_SHOWN: u64 = 3;

pub(crate) fn run(arguments: &RecordArguments) -> Result<(), CliError> {
    let fault = |error: SensorError| CliError::sensor(&arguments.address, error);
    Kind::of(&arguments.output)?;
    let overwrite = arguments.overwrite.or(arguments.force);
    let outputs = Outputs::guard(overwrite, "recording", &arguments.scene, [&arguments.output])?;
    let limits =
        [("duration", arguments.duration), ("tare", arguments.tare), ("silence", Some(arguments.silence))];
    for (name, limit) in limits {
        if limit.is_some_and(|limit| !(limit > 0.0 && limit < 1e9)) {
            let option = format!("--{name}");
            return Err(CliError::Option { option, problem: "must be a number of seconds above 0" });
        }
    }
    let scene = arguments.scene.as_deref().map(load_or_simulated).transpose()?;
    scene.iter().try_for_each(|scene| outputs.spare(scene.files()))?;
    scene.iter().for_each(warn_of_doubts);
    let about = about(&arguments.address.to_string(), scene.as_ref());
    let mut feel = scene.map(|scene| SceneFeel::new(&scene, arguments.tare.is_some()));
    let stop = Stop::listen();
    let address = arguments.address.clone();
    let options =
        StreamOptions { silence: Duration::from_secs_f64(arguments.silence), reconnect: arguments.reconnect };
    let mut stream = Stream::new(Box::new(move || sensor::open(&address)), options).map_err(fault)?;
    let mut recording = Recording::new(arguments, &outputs, about);
    // The first sample says what there is to be written: until then no file is made.
    let mut ended = Ok(());
    while !stop.is_asked() && !recording.is_full() {
        match stream.next() {
            Ok(Event::Sample(time, reading)) => {
                if let Err(error) = recording.take(time, &reading, feel.as_mut()) {
                    ended = Err(error);
                    break;
                }
            }
            Ok(Event::Fault(why)) => {
                if let Some(warning) = recording.fault(&why) {
                    recording.warn(&warning);
                }
            }
            Ok(Event::Nothing) => {}
            Ok(Event::Lost(why)) => recording.warn(&format!("{}: {why}; connecting anew", arguments.address)),
            Ok(Event::End) => {
                ended = Err(fault(recording.ended(SensorError::Closed)));
                break;
            }
            Err(why) => {
                ended = Err(fault(recording.ended(why)));
                break;
            }
        }
        recording.news();
    }
    // Whatever happened: what is there is a whole file.
    let summary = recording.finish(&stream)?;
    match (ended, summary) {
        (ended, Some(summary)) => {
            outputs.tell(&summary)?;
            ended
        }
        (Ok(()), None) => Err(fault(SensorError::NoSample)),
        (ended, None) => ended,
    }
}

struct Recording<'a> {
    arguments: &'a RecordArguments,
    outputs: &'a Outputs,
    about: About,
    output: Option<Output>,
    rest: Rest,
    /// What is added to times \[s\].
    epoch: f64,
    samples: u64,
    contacts: u64,
    not_finite: u64,
    backward: u64,
    faults: u64,
    first: Option<f64>,
    last: f64,
    is_quiet: bool,
    /// On the standard error, if that is a terminal.
    news: Option<ProgressBar>,
    told: Instant,
}

impl<'a> Recording<'a> {
    fn new(arguments: &'a RecordArguments, outputs: &'a Outputs, about: About) -> Self {
        let is_quiet = is_quiet();
        Self {
            arguments,
            outputs,
            about,
            is_quiet,
            output: None,
            rest: Rest::new(arguments.tare),
            epoch: 0.0,
            samples: 0,
            contacts: 0,
            not_finite: 0,
            backward: 0,
            faults: 0,
            first: None,
            last: f64::NEG_INFINITY,
            news: (!is_quiet).then(ProgressBar::new_spinner),
            told: Instant::now(),
        }
    }

    /// How long it is \[s\].
    fn length(&self) -> f64 {
        self.first.map_or(0.0, |first| self.last - first)
    }

    fn is_full(&self) -> bool {
        self.arguments.samples.is_some_and(|samples| self.samples >= samples)
            || self.arguments.duration.is_some_and(|duration| self.length() >= duration)
    }

    fn take(&mut self, time: f64, reading: &Reading, feel: Option<&mut SceneFeel>) -> Result<(), CliError> {
        if !reading.wrench.is_finite() {
            self.not_finite += 1;
            return Ok(());
        }
        let fault = |error: NoZero| CliError::sensor(&self.arguments.address, error);
        let Some(wrench) = self.rest.take(time, &reading.wrench).map_err(fault)? else { return Ok(()) };
        if time <= self.last {
            // Two samples that arrive at once where only the arrival tells the time: both are kept.
            self.backward += 1;
        }
        let touch = match feel {
            Some(feel) => feel.feel(time, &wrench).map_err(fault)?,
            None => None,
        };
        let contact = touch.as_ref().and_then(output::contact);
        if self.output.is_none() {
            if self.arguments.unix_time {
                let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
                self.epoch = now.as_secs_f64() - time;
            }
            let has_volts = reading.volts.is_some();
            self.output = Some(Output::create(self.arguments, self.outputs, has_volts, &self.about)?);
        }
        let Some(output) = &mut self.output else { return Ok(()) };
        // Whole nanoseconds, as MCAP has them: so both formats hold the same.
        let written = ((time + self.epoch) * 1e9).round() / 1e9;
        let touch = touch.as_ref().map(|touch| Numbered { number: self.samples, time, touch });
        let row = Row { time: written, wrench: &wrench, volts: reading.volts.as_ref(), contact, touch };
        output.write(&row)?;
        self.samples += 1;
        self.contacts += u64::from(contact.is_some());
        self.first.get_or_insert(time);
        self.last = self.last.max(time);
        Ok(())
    }

    /// That the sensor ended, and when.
    fn ended(&self, why: SensorError) -> SensorError {
        if self.samples == 0 {
            return why;
        }
        SensorError::Ended { why: Box::new(why), samples: self.samples, seconds: short(self.length()) }
    }

    /// Counts a fault, and gives what is to be said of it.
    fn fault(&mut self, why: &str) -> Option<String> {
        self.faults += 1;
        let last = if self.faults == FAULTS_SHOWN { " (further ones are only counted)" } else { "" };
        (self.faults <= FAULTS_SHOWN && !self.is_quiet).then(|| format!("{why}{last}"))
    }

    /// Prints a warning, above the line of news.
    fn warn(&self, what: &str) {
        let print = || eprintln!("warning: {}", printable(what));
        match &self.news {
            Some(news) => news.suspend(print),
            None => print(),
        }
    }

    fn news(&mut self) {
        let Some(news) = &self.news else { return };
        if self.told.elapsed() > NEWS {
            self.told = Instant::now();
            news.set_message(self.so_far());
            news.tick();
        }
    }

    /// What there is so far, and what to do or not to do.
    fn so_far(&self) -> String {
        let state = if self.rest.is_resting() { "taking the zero: do not touch" } else { "Ctrl-C ends it" };
        format!("{} samples, {} s ({state})", count(self.samples), short(self.length()))
    }

    /// Finishes the file, and says what is in it; `None` if there is none. The line of news goes with the recording.
    fn finish(mut self, stream: &Stream) -> Result<Option<String>, CliError> {
        let Some(output) = self.output.take() else { return Ok(None) };
        output.finish()?;
        let mut text = format!("{} samples in {} s", count(self.samples), short(self.length()));
        if self.length() > 0.0 {
            text.push_str(&format!(" ({} samples/s)", short((self.samples - 1) as f64 / self.length())));
        }
        if self.arguments.scene.is_some() {
            text.push_str(&format!(", {} with a contact", count(self.contacts)));
        }
        text.push_str(&format!("\nLink: {}\n", sensor::losses_said(&stream.losses())));
        let mut note = |happened: bool, what: String| {
            if happened {
                text.push_str(&what);
                text.push('\n');
            }
        };
        note(
            self.faults > 0,
            format!("Samples that the sensor marked as bad or that were damaged: {}", count(self.faults)),
        );
        note(
            self.not_finite > 0,
            format!("Samples that are not finite, left out: {}", count(self.not_finite)),
        );
        note(
            self.backward > 0,
            format!("Samples whose time is not after that of the one before: {}", count(self.backward)),
        );
        note(stream.reconnections() > 0, format!("Connected anew {} times", stream.reconnections()));
        note(
            stream.is_timed_by_arrival(),
            "Times are those of arrival at this computer: the sensor sends none".to_owned(),
        );
        if self.arguments.tare.is_some() {
            let zero: Vec<String> = self.rest.zero().iter().map(|component| number(*component)).collect();
            note(true, format!("Zero taken off [N, N·m]: {}", zero.join(", ")));
        }
        text.push_str(&self.outputs.written());
        Ok(Some(text))
    }
}

#[cfg(test)]
mod tests;
