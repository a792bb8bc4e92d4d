//! `fingertip live`: what a fingertip feels, in the terminal.

pub(crate) mod args;
mod forces;
mod map;
mod slip;
mod state;
mod view;

use alloc::sync::Arc;
use core::sync::atomic::{AtomicBool, Ordering};
use core::time::Duration;
use std::io::{self, IsTerminal};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Instant;

use args::LiveArguments;
use ratatui::DefaultTerminal;
use ratatui::crossterm::event::{self, Event as Input, KeyCode, KeyEventKind, KeyModifiers};
use state::{Health, State};

use crate::calibrated::Calibration;
use crate::error::CliError;
use crate::felt::{Rest, SceneFeel};
use crate::health::{of_wrench, seen};
use crate::output::printable;
use crate::scene;
use crate::sensor::{self, Calibrating, Event, GaugesOf, SensorError, Stream, StreamOptions};
use crate::stop::Stop;
use fingertip::wrench::Wrench;
use fingertip_recordings::health::{Depth, HealthWatch};
use fingertip_scene::{Limit, Scene};

/// How long a zero takes that is asked for by a key \[s\].
const ZERO: f64 = 1.0;
/// Behind so many samples the health of the sensor is judged again.
const HEALTH_PERIOD: u64 = 2048;

/// What the reader of samples and the view share.
struct Shared {
    state: Mutex<State>,
    stop: Stop,
    tare: AtomicBool,
}

impl Shared {
    fn state(&self) -> MutexGuard<'_, State> {
        // What a thread that died left is still good enough to be shown.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

pub(crate) fn run(arguments: &LiveArguments) -> Result<(), CliError> {
    if !io::stdout().is_terminal() {
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
    let scene_file = arguments.scene.as_deref().unwrap_or(Path::new("sim"));
    let calibration = match &arguments.calibration {
        // What a device reports are wrenches already.
        Some(_) if !simulated && arguments.replay.is_none() => return Err(fault(SensorError::NotGauges)),
        Some(path) => Some(Calibration::read(path)?),
        None if simulated || arguments.replay.is_some() => {
            let of_scene = scene.as_ref().and_then(Scene::calibration).cloned();
            of_scene.map(|file| Calibration::of_scene(file, scene_file))
        }
        None => None,
    };
    if let Some(celsius) = arguments.celsius.filter(|_| calibration.is_none()) {
        let needs = "is for readings of gauges, with --calibration or [sensor] of the scene";
        return Err(CliError::option("--celsius", celsius, needs));
    }
    let celsius = arguments.celsius.or_else(|| scene.as_ref().and_then(Scene::celsius));
    if scene.as_ref().is_some_and(|scene| scene.carried().is_some()) {
        eprintln!("note: the weight of [payload] is not taken off: nothing tells how a live sensor lies");
    }
    if scene.as_ref().is_some_and(Scene::awaits_noise) && calibration.is_some() {
        eprintln!(
            "note: nothing tells the noise of gauges live, which the scene asks for: no force is a contact until a \
                   zero is taken (key t)"
        );
    }
    // The rest of gauges is taken of their readings.
    let rest = Rest::new(seconds.filter(|_| calibration.is_none()));
    let feel = scene.map(|scene| SceneFeel::new(&scene, true));
    // Before the terminal is taken, so that what is wrong is said in plain lines.
    let gauges = calibration.as_ref().map(|calibration| Calibrating { calibration, rest: seconds, celsius });
    let stream = open(arguments, gauges, named.as_deref())?;
    let shared =
        Arc::new(Shared { state: Mutex::new(state), stop: Stop::listen(), tare: AtomicBool::new(false) });
    let reading = Arc::clone(&shared);
    let reader = thread::Builder::new().name("samples".to_owned()).spawn(move || {
        let read = read(&reading, stream, rest, feel);
        if read.is_err() {
            // The view ends with it, and it is said when the terminal is as it was.
            reading.stop.ask();
        }
        read
    });
    let reader = reader.map_err(|error| fault(SensorError::Thread(error)))?;

    let shown = ratatui::try_init().and_then(|terminal| show(terminal, &shared, arguments.frames));
    ratatui::restore();
    shared.stop.ask();
    let read = reader.join().unwrap_or(Err(SensorError::Died));
    for fault in &shared.state().seen {
        eprintln!("warning: {}", printable(fault));
    }
    shown.map_err(CliError::Terminal)?;
    read.map_err(fault)
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

/// Takes samples until it is asked to end.
fn read(
    shared: &Shared,
    mut stream: Stream,
    mut rest: Rest,
    mut feel: Option<SceneFeel>,
) -> Result<(), SensorError> {
    let mut watch = HealthWatch::new(of_wrench(""), Depth::Brief);
    while !shared.stop.is_asked() {
        if shared.tare.swap(false, Ordering::Relaxed) {
            rest = Rest::new(Some(ZERO));
        }
        match stream.next()? {
            Event::Sample(time, reading) => {
                match rest.take(time, watched(&mut watch, shared, time, &reading.wrench))? {
                    Some(wrench) => {
                        let touch = match &mut feel {
                            Some(feel) => {
                                if let Some(noise) = rest.noise().filter(|_| feel.awaits_noise()) {
                                    feel.know_noise(&noise);
                                }
                                feel.feel(time, &wrench)?
                            }
                            None => None,
                        };
                        let mut state = shared.state();
                        state.sample(time, &wrench, touch, Instant::now());
                        state.losses = stream.losses();
                    }
                    None => shared.state().health = Health::Resting,
                }
            }
            Event::Fault(why) => {
                let mut state = shared.state();
                state.faults += 1;
                state.last_fault = Some(why);
                state.losses = stream.losses();
            }
            Event::Nothing => shared.state().reconnections = stream.reconnections(),
            Event::Lost(why) => shared.state().health = Health::Lost(why),
            Event::End => {
                shared.state().health = Health::Ended;
                return Ok(());
            }
        }
    }
    Ok(())
}

/// Looks at the health of the sensor, and every so often says what it sees.
fn watched<'a>(
    watch: &mut HealthWatch,
    shared: &Shared,
    time: f64,
    wrench: &'a Wrench<f64>,
) -> &'a Wrench<f64> {
    watch.add(Some(time), wrench.components().as_slice());
    if watch.samples().is_multiple_of(HEALTH_PERIOD) {
        let seen = seen(&watch.finish());
        shared.state().seen = seen;
    }
    wrench
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
                    KeyCode::Char('t') => shared.tare.store(true, Ordering::Relaxed),
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
    use alloc::sync::Arc;
    use core::sync::atomic::{AtomicBool, Ordering};
    use core::time::Duration;
    use std::path::Path;
    use std::sync::Mutex;

    use nalgebra::Vector6;

    use super::{Health, Rest, Shared, State, Stop, Stream, StreamOptions, Wrench, read};
    use crate::felt::SceneFeel;
    use crate::sensor::{Feed, Losses, Next, Reading, SensorError};

    /// Gives what it is told to, and asks for something at one of its samples.
    struct Told {
        samples: Vec<Next>,
        given: usize,
        shared: Arc<Shared>,
        tare_at: usize,
    }

    impl Feed for Told {
        fn next(&mut self) -> Result<Next, SensorError> {
            if self.given == self.tare_at {
                self.shared.tare.store(true, Ordering::Relaxed);
            }
            self.given += 1;
            Ok(self.samples.get(self.given - 1).cloned().unwrap_or(Next::End))
        }
        fn losses(&self) -> Losses {
            Losses { lost: Some(self.given as u64), ..Losses::default() }
        }
    }

    fn sample(time: f64, value: f64) -> Next {
        let wrench = Wrench::from_components(&Vector6::repeat(value));
        Next::Reading(Reading { time: Some(time), wrench, volts: None })
    }

    /// What the view has to show when the samples have been read.
    fn shown(samples: Vec<Next>, rest: Option<f64>, tare_at: usize, feel: Option<SceneFeel>) -> State {
        let shared = Arc::new(Shared {
            state: Mutex::new(State::new("test".to_owned())),
            stop: Stop::default(),
            tare: AtomicBool::new(false),
        });
        let mut feed =
            Some(Box::new(Told { samples, given: 0, shared: Arc::clone(&shared), tare_at }) as Box<dyn Feed>);
        let options = StreamOptions { silence: Duration::from_secs(3600), reconnect: false };
        let stream = Stream::new(Box::new(move || feed.take().ok_or(SensorError::Over)), options).unwrap();
        read(&shared, stream, Rest::new(rest), feel).unwrap();
        shared.state().clone()
    }

    #[test]
    fn samples_are_shown_less_their_zero() {
        let samples = |count: u32| (0..count).map(|i| sample(f64::from(i), f64::from(i))).collect::<Vec<_>>();
        let state = shown(samples(5), None, usize::MAX, None);
        assert_eq!((state.samples, state.time, state.losses.lost), (5, 4.0, Some(5)));
        assert_eq!(state.wrench.unwrap().force().x, 4.0);
        assert_eq!(state.health, Health::Ended);
        // A rest of two seconds holds the samples at 0 s and 1 s.
        let state = shown(samples(5), Some(2.0), usize::MAX, None);
        assert_eq!((state.samples, state.wrench.unwrap().force().x), (3, 3.5));
        // A zero is asked for while the third sample comes: what comes in the second behind it is not shown.
        let mut close = samples(3);
        close.extend((0..40).map(|i| sample(3.0 + 0.1 * f64::from(i), 7.0)));
        let state = shown(close, None, 2, None);
        assert_eq!((state.samples, state.wrench.unwrap().force().x), (3 + 30, 0.0));
    }

    #[test]
    fn faults_are_counted_and_the_last_is_kept() {
        let faults = ["one", "two"].map(|why| Next::Fault(why.to_owned()));
        let state = shown([vec![sample(0.0, 1.0)], faults.to_vec()].concat(), None, usize::MAX, None);
        assert_eq!((state.faults, state.last_fault.as_deref(), state.losses.lost), (2, Some("two"), Some(3)));
    }

    #[test]
    fn a_scene_makes_a_touch_of_a_sample() {
        let scene = crate::scene::load_or_simulated(Path::new("sim")).unwrap();
        let state = shown(vec![sample(0.0, -1.0)], None, usize::MAX, Some(SceneFeel::new(&scene, true)));
        assert!(state.touch.is_some());
        assert!(shown(vec![sample(0.0, -1.0)], None, usize::MAX, None).touch.is_none());
    }
}
