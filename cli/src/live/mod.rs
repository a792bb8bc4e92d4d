//! `fingertip live`: what a fingertip feels, in the terminal.

pub(crate) mod args;
mod bridges;
mod forces;
mod map;
mod reader;
mod slip;
mod state;
mod view;

use alloc::sync::Arc;
use core::time::Duration;
use std::io::{self, IsTerminal};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Instant;

use args::LiveArguments;
use bridges::Bridges;
use fingertip_bridges::{Command, Hub};
use ratatui::DefaultTerminal;
use ratatui::crossterm::event::{self, Event as Input, KeyCode, KeyEventKind, KeyModifiers};
use state::State;

use crate::about::about;
use crate::calibrated::Calibration;
use crate::error::CliError;
use crate::felt::{Rest, SceneFeel};
use crate::output::{print, printable, read_once};
use crate::scene;
use crate::sensor::{self, Calibrating, GaugesOf, SensorError, Stream, StreamOptions};
use crate::stop::Stop;
use fingertip_scene::{Limit, Scene};

/// What the reader of samples, the view and the bridges share.
struct Shared {
    state: Mutex<State>,
    stop: Stop,
    /// Where every sample goes, and where a zero is asked for.
    hub: Hub,
}

impl Shared {
    fn state(&self) -> MutexGuard<'_, State> {
        // What a thread that died left is still good enough to be shown.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

pub(crate) fn run(arguments: &LiveArguments) -> Result<(), CliError> {
    let has_view = io::stdout().is_terminal();
    if !has_view && !arguments.bridges.any() {
        return Err(CliError::Terminal(io::Error::other("the standard output is none")));
    }
    let source = match &arguments.replay {
        Some(path) => path.display().to_string(),
        None => arguments.address.to_string(),
    };
    let fault = |error: SensorError| CliError::sensor(&source, error);
    if !(arguments.frames > 0.0 && arguments.frames <= 1000.0) {
        return Err(CliError::option("--frames", arguments.frames, "must be above 0, up to 1000"));
    }
    if let Some(tare) = arguments.tare.filter(|tare| !(*tare > 0.0 && tare.is_finite())) {
        return Err(CliError::option("--tare", tare, "must be a number of seconds above 0"));
    }
    let inputs = [&arguments.replay, &arguments.calibration, &arguments.scene];
    read_once(inputs.into_iter().flatten().map(PathBuf::as_path))?;
    let simulated = arguments.replay.is_none() && sensor::is_simulated(&arguments.address);
    let scene = arguments.scene.clone().or_else(|| simulated.then(|| PathBuf::from("sim")));
    let scene = scene.as_deref().map(scene::load_or_simulated).transpose()?;

    let mut state = State::new(source.clone());
    if let Some(scene) = &scene {
        state.projection = Some(*scene.projection());
        state.coefficient = scene.limit().map(Limit::coefficient);
        state.watches_slip = scene.watches_for_slip();
    }
    let named = scene.as_ref().and_then(|scene| scene.sensor_name().map(str::to_owned));
    let seconds = arguments.tare.or_else(|| scene.as_ref().and_then(Scene::rest));
    let calibration = calibration(arguments, simulated, scene.as_ref(), &source)?;
    let celsius = arguments.celsius.or_else(|| scene.as_ref().and_then(Scene::celsius));
    if let Some(scene) = &scene {
        scene::warn_of_doubts(scene);
        note_what_is_left_out(scene, calibration.is_some());
    }
    let hub = Hub::new(about(&source, scene.as_ref()));
    let mut bridges = Bridges::start(&arguments.bridges, &hub, scene.as_ref())?;
    state.served = bridges.addresses().to_vec();
    // The rest of gauges is taken of their readings.
    let rest = Rest::new(seconds.filter(|_| calibration.is_none()));
    let feel = scene.map(|scene| SceneFeel::new(&scene, true));
    // Before the terminal is taken, so that what is wrong is said in plain lines.
    let gauges = calibration.as_ref().map(|calibration| Calibrating { calibration, rest: seconds, celsius });
    let stream = open(arguments, gauges, named.as_deref())?;
    print(&bridges.addresses().iter().map(|line| format!("{line}\n")).collect::<String>())?;
    let shared = Arc::new(Shared { state: Mutex::new(state), stop: Stop::listen(), hub });
    let reading = Arc::clone(&shared);
    let reader = thread::Builder::new().name("samples".to_owned()).spawn(move || {
        let read = reader::read(&reading, stream, rest, feel);
        if read.is_err() {
            // The view ends with it, and it is said when the terminal is as it was.
            reading.stop.ask();
        }
        read
    });
    let reader = reader.map_err(|error| fault(SensorError::Thread(error)))?;

    let shown = if has_view {
        let shown = ratatui::try_init().and_then(|terminal| show(terminal, &shared, arguments.frames));
        ratatui::restore();
        shown
    } else {
        wait(&shared);
        Ok(())
    };
    shared.stop.ask();
    let read = reader.join().unwrap_or(Err(SensorError::Died));
    bridges.end().iter().for_each(|line| eprintln!("note: {line}"));
    for fault in &shared.state().seen {
        eprintln!("warning: {}", printable(fault));
    }
    shown.map_err(CliError::Terminal)?;
    read.map_err(fault)
}

/// What turns readings of gauges into wrenches, where it is such that come.
fn calibration<'a>(
    arguments: &'a LiveArguments,
    simulated: bool,
    scene: Option<&Scene>,
    source: &str,
) -> Result<Option<Calibration<'a>>, CliError> {
    let scene_file = arguments.scene.as_deref().unwrap_or(Path::new("sim"));
    let calibration = match &arguments.calibration {
        // What a device reports are wrenches already.
        Some(_) if !simulated && arguments.replay.is_none() => {
            return Err(CliError::sensor(source, SensorError::NotGauges));
        }
        Some(path) => Some(Calibration::read(path)?),
        None if simulated || arguments.replay.is_some() => {
            let of_scene = scene.and_then(Scene::calibration).cloned();
            of_scene.map(|file| Calibration::of_scene(file, scene_file))
        }
        None => None,
    };
    if let Some(celsius) = arguments.celsius.filter(|_| calibration.is_none()) {
        let needs = "is for readings of gauges, with --calibration or [sensor] of the scene";
        return Err(CliError::option("--celsius", celsius, needs));
    }
    Ok(calibration)
}

/// Says what of a scene does not count live.
fn note_what_is_left_out(scene: &Scene, of_gauges: bool) {
    if scene.carried().is_some() {
        eprintln!(
            "note: the weight of [payload] is not taken off: nothing tells how a live sensor lies or moves"
        );
    }
    if scene.array_places().is_some() {
        eprintln!("note: [fusion] is left out: no live sensor gives the readings of an array");
    }
    if scene.awaits_noise() && of_gauges {
        eprintln!(
            "note: nothing tells the noise of gauges live, which the scene asks for: no force is a contact until a \
                   zero is taken (key t)"
        );
    }
}

/// Opens the source. `how` gauges become wrenches, and `named` is their sensor by the scene.
fn open(
    arguments: &LiveArguments,
    how: Option<Calibrating<'_>>,
    named: Option<&str>,
) -> Result<Stream, CliError> {
    let LiveArguments { address, replay, speed, sensor, .. } = arguments;
    let place = replay.as_ref().map_or_else(|| address.to_string(), |path| path.display().to_string());
    let fault = |error: SensorError| CliError::sensor(&place, error);
    let mut options = StreamOptions { silence: Duration::from_secs(2), reconnect: false };
    let once = match (how, replay) {
        (None, None) => {
            options.reconnect = !arguments.no_reconnect;
            let address = address.clone();
            return Stream::new(Box::new(move || sensor::open(&address)), options).map_err(fault);
        }
        (None, Some(path)) => sensor::replay(path, sensor.as_deref().unwrap_or(""), *speed)?,
        (Some(how), replay) => {
            let gauges = match replay {
                Some(path) => {
                    GaugesOf::Recording { path, sensor: sensor.as_deref().or(named), speed: *speed }
                }
                None => GaugesOf::Simulated(address),
            };
            let mut notes = Vec::new();
            let feed = sensor::calibrated(gauges, &how, &mut notes)?;
            notes.iter().for_each(|note| eprintln!("note: {note}"));
            feed
        }
    };
    let mut first = Some(once);
    let again = move || first.take().ok_or(SensorError::Over);
    Stream::new(Box::new(again), options).map_err(fault)
}

/// Without a terminal: until it is asked to end, or there are no more samples.
fn wait(shared: &Shared) {
    while !shared.stop.is_asked() && !shared.hub.is_closed() {
        thread::sleep(Duration::from_millis(20));
    }
}

/// Draws until the user has seen enough.
fn show(mut terminal: DefaultTerminal, shared: &Shared, frames: f64) -> io::Result<()> {
    let period = Duration::from_secs_f64(1.0 / frames);
    let mut held: Option<State> = None;
    while !shared.stop.is_asked() {
        let state = match &held {
            Some(held) => held.clone(),
            None => {
                let mut state = shared.state();
                state.refresh();
                state.clone()
            }
        };
        terminal.draw(|frame| view::draw(frame, &state, held.is_some()))?;
        let drawn = Instant::now();
        loop {
            let left = period.saturating_sub(drawn.elapsed());
            if !event::poll(left)? {
                break;
            }
            match event::read()? {
                Input::Key(key) if key.kind != KeyEventKind::Release => match key.code {
                    KeyCode::Char('q') | KeyCode::Esc => return Ok(()),
                    KeyCode::Char('c') if key.modifiers.contains(KeyModifiers::CONTROL) => return Ok(()),
                    KeyCode::Char(' ') => held = if held.is_some() { None } else { Some(state.clone()) },
                    KeyCode::Char('t') => shared.hub.ask(Command::Tare),
                    KeyCode::Char('r') => shared.state().forget(),
                    _ => {}
                },
                // Drawn anew at once.
                Input::Resize(..) => break,
                _ => {}
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use core::time::Duration;
    use std::net::TcpListener;
    use std::sync::Mutex;
    use std::thread;

    use clap::Parser as _;
    use fingertip_bridges::{About, Hub};

    use super::state::State;
    use super::{LiveArguments, Shared, Stop, open, wait};
    use crate::args::{Arguments, Command};
    use crate::sensor::Event;

    fn arguments(given: &[&str]) -> LiveArguments {
        match Arguments::parse_from([&["fingertip", "live"], given].concat()).command {
            Command::Live(arguments) => arguments,
            _ => panic!("another command"),
        }
    }

    /// Without a view it goes on until the samples end, or somebody asks it to.
    #[test]
    fn without_a_view_it_waits_for_the_end() {
        let ends: [fn(&Shared); 2] = [|shared| shared.hub.close(), |shared| shared.stop.ask()];
        for end in ends {
            let shared = Shared {
                state: Mutex::new(State::new("test".to_owned())),
                stop: Stop::default(),
                hub: Hub::new(About::default()),
            };
            thread::scope(|scope| {
                let waiting = scope.spawn(|| wait(&shared));
                thread::sleep(Duration::from_millis(50));
                assert!(!waiting.is_finished(), "it ended while samples came");
                end(&shared);
                waiting.join().unwrap();
            });
        }
    }

    /// A device hangs up: it is looked for again, unless that is not wanted. Nor is a recording that is over.
    #[test]
    fn a_sensor_that_is_lost_is_looked_for_again() {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = format!("bota+tcp://{}", listener.local_addr().unwrap());
        for (more, looked_for) in [(&[][..], true), (&["--no-reconnect"], false)] {
            let arguments = arguments(&[&[address.as_str()], more].concat());
            let mut stream = open(&arguments, None, None).unwrap();
            drop(listener.accept().unwrap());
            let event = loop {
                match stream.next() {
                    Ok(Event::Nothing) => {}
                    event => break event,
                }
            };
            match event {
                Ok(Event::Lost(why)) => assert!(looked_for, "{why}"),
                Ok(Event::End) | Err(_) => assert!(!looked_for),
                Ok(other) => panic!("{other:?}"),
            }
        }
    }
}
