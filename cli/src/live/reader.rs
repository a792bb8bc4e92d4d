//! From the stream to what is shown, and to the hub that the bridges read from.

use std::time::Instant;

use fingertip::wrench::Wrench;
use fingertip_bridges::{Command, Felt, Health as Told, Publisher, Sample};
use fingertip_recordings::health::{Depth, HealthWatch};

use super::Shared;
use super::state::Health;
use crate::felt::{NoZero, Rest, SceneFeel};
use crate::health::{of_wrench, seen};
use crate::observe::Status;
use crate::sensor::{Event, SensorError, Stream};

/// How long a zero takes that is asked for while samples come \[s\].
const ZERO: f64 = 1.0;
/// Behind so many samples the health of the sensor is judged again.
const HEALTH_PERIOD: u64 = 2048;

/// Takes samples until it is asked to end.
pub(super) fn read(
    shared: &Shared,
    mut stream: Stream,
    rest: Rest,
    feel: Option<SceneFeel>,
) -> Result<(), SensorError> {
    let watch = HealthWatch::new(of_wrench(""), Depth::Brief);
    let mut reader = Reader { shared, publisher: shared.hub.publisher(), rest, fresh: None, feel, watch };
    let read = reader.run(&mut stream);
    shared.hub.close();
    read
}

struct Reader<'a> {
    shared: &'a Shared,
    publisher: Publisher,
    rest: Rest,
    /// A zero that is being taken, to stand in the place of the one before if it succeeds.
    fresh: Option<Rest>,
    feel: Option<SceneFeel>,
    watch: HealthWatch,
}

impl Reader<'_> {
    fn run(&mut self, stream: &mut Stream) -> Result<(), SensorError> {
        while !self.shared.stop.is_asked() {
            self.obey();
            match stream.next()? {
                Event::Sample(time, reading) => self.sample(time, &reading.wrench, stream)?,
                Event::Fault(why) => {
                    let (faults, lost) = {
                        let mut state = self.shared.state();
                        state.faults += 1;
                        state.last_fault = Some(why);
                        state.losses = stream.losses();
                        (state.faults, state.losses.lost)
                    };
                    self.publisher.tell(|status| (status.faults, status.lost) = (faults, lost));
                }
                Event::Nothing => {
                    let reconnections = stream.reconnections();
                    self.shared.state().reconnections = reconnections;
                    self.publisher.tell(|status| status.reconnections = reconnections);
                }
                Event::Lost(why) => {
                    self.shared.state().health = Health::Lost(why.clone());
                    self.publisher.tell(|status| status.health = Told::Lost(why));
                }
                Event::End => {
                    self.shared.state().health = Health::Ended;
                    self.publisher.tell(|status| status.health = Told::Ended);
                    return Ok(());
                }
            }
        }
        Ok(())
    }

    /// Does what was asked by a key or over a bridge.
    fn obey(&mut self) {
        match self.shared.hub.asked() {
            Some(Command::Tare) => self.fresh = Some(Rest::new(Some(ZERO))),
            Some(Command::Reset) => {
                if let Some(feel) = &mut self.feel {
                    feel.start_anew();
                }
                self.shared.state().forget();
            }
            None => {}
        }
    }

    /// The wrench less its zero; `None` while a zero is taken.
    fn zeroed(&mut self, time: f64, wrench: &Wrench<f64>) -> Result<Option<Wrench<f64>>, NoZero> {
        let Some(fresh) = &mut self.fresh else { return self.rest.take(time, wrench) };
        match fresh.take(time, wrench) {
            Ok(None) => Ok(None),
            Ok(Some(zeroed)) => {
                let value: [f64; 6] = (*fresh.zero()).into();
                if let Some(fresh) = self.fresh.take() {
                    self.rest = fresh;
                }
                self.publisher.tell(|status| {
                    status.zero.taken += 1;
                    status.zero.value = value;
                });
                Ok(Some(zeroed))
            }
            // Whoever asks for a zero at the wrong time does not end it for all.
            Err(why) => {
                self.fresh = None;
                let why = why.to_string();
                self.shared.state().last_fault = Some(why.clone());
                self.publisher.tell(|status| {
                    status.zero.failed += 1;
                    status.zero.why = why;
                });
                self.rest.take(time, wrench)
            }
        }
    }

    fn sample(&mut self, time: f64, wrench: &Wrench<f64>, stream: &Stream) -> Result<(), SensorError> {
        self.watch(time, wrench);
        let Some(wrench) = self.zeroed(time, wrench)? else {
            let was = core::mem::replace(&mut self.shared.state().health, Health::Resting);
            if was != Health::Resting {
                self.publisher.tell(|status| status.health = Told::Resting);
            }
            return Ok(());
        };
        let touch = match &mut self.feel {
            Some(feel) => {
                if let Some(noise) = self.rest.noise().filter(|_| feel.awaits_noise()) {
                    feel.know_noise(&noise);
                }
                feel.feel(time, &wrench)?
            }
            None => None,
        };
        let (was, lost, felt) = {
            let mut state = self.shared.state();
            let was = state.health.clone();
            state.sample(time, &wrench, touch, Instant::now());
            state.losses = stream.losses();
            let felt = touch
                .map(|touch| Felt::of(&touch, Status::of(&touch.resolution).word(), state.ellipse_now()));
            (was, state.losses.lost, felt)
        };
        self.publisher.publish(Sample::new(time, wrench, felt));
        if was != Health::Running {
            self.publisher.tell(|status| (status.health, status.lost) = (Told::Running, lost));
        }
        Ok(())
    }

    /// Looks at the health of the sensor, and every so often says what it sees.
    fn watch(&mut self, time: f64, wrench: &Wrench<f64>) {
        self.watch.add(Some(time), wrench.components().as_slice());
        if self.watch.samples().is_multiple_of(HEALTH_PERIOD) {
            let seen = seen(&self.watch.finish());
            let lost = {
                let mut state = self.shared.state();
                state.seen.clone_from(&seen);
                state.losses.lost
            };
            self.publisher.tell(|status| (status.seen, status.lost) = (seen, lost));
        }
    }
}

#[cfg(test)]
mod tests {
    use alloc::sync::Arc;
    use core::time::Duration;
    use std::path::Path;
    use std::sync::Mutex;

    use nalgebra::{Vector3, Vector6};

    use fingertip_bridges::{About, Command, Hub};
    use fingertip_scene::Scene;

    use super::super::state::State;
    use super::{Health, Rest, Sample, SceneFeel, SensorError, Shared, Stream, Wrench, read};
    use crate::sensor::{Feed, Losses, Next, Reading, StreamOptions};
    use crate::stop::Stop;

    /// Gives what it is told to, and asks for something at one of its samples.
    struct Told {
        samples: Vec<Next>,
        given: usize,
        shared: Arc<Shared>,
        ask_at: usize,
        ask: Command,
        /// How the bridges are told that the source is, before each sample.
        heard: Arc<Mutex<Vec<&'static str>>>,
    }

    impl Feed for Told {
        fn next(&mut self) -> Result<Next, SensorError> {
            self.heard.lock().unwrap().push(self.shared.hub.status().health.word());
            if self.given == self.ask_at {
                self.shared.hub.ask(self.ask);
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
        seen(samples, rest, tare_at, feel).0
    }

    /// That, what the hub gave, and how the source was in the end.
    fn seen(
        samples: Vec<Next>,
        rest: Option<f64>,
        tare_at: usize,
        feel: Option<SceneFeel>,
    ) -> (State, Vec<Sample>, fingertip_bridges::Status) {
        asked(samples, rest, (tare_at, Command::Tare), feel)
    }

    fn asked(
        samples: Vec<Next>,
        rest: Option<f64>,
        (ask_at, ask): (usize, Command),
        feel: Option<SceneFeel>,
    ) -> (State, Vec<Sample>, fingertip_bridges::Status) {
        heard(samples, rest, (ask_at, ask), feel, &Arc::default())
    }

    fn heard(
        samples: Vec<Next>,
        rest: Option<f64>,
        (ask_at, ask): (usize, Command),
        feel: Option<SceneFeel>,
        heard: &Arc<Mutex<Vec<&'static str>>>,
    ) -> (State, Vec<Sample>, fingertip_bridges::Status) {
        let shared = Arc::new(Shared {
            state: Mutex::new(State::new("test".to_owned())),
            stop: Stop::default(),
            hub: Hub::new(About::default()),
        });
        let mut feed = Some(Box::new(Told {
            samples,
            given: 0,
            shared: Arc::clone(&shared),
            ask_at,
            ask,
            heard: Arc::clone(heard),
        }) as Box<dyn Feed>);
        let options = StreamOptions { silence: Duration::from_secs(3600), reconnect: false };
        let stream = Stream::new(Box::new(move || feed.take().ok_or(SensorError::Over)), options).unwrap();
        let mut reader = shared.hub.subscribe();
        read(&shared, stream, Rest::new(rest), feel).unwrap();
        let mut given = Vec::new();
        let news = reader.wait(&mut given, Duration::ZERO);
        assert!(news.closed && news.missed == 0);
        (shared.state().clone(), given, shared.hub.status())
    }

    #[test]
    fn the_hub_is_given_what_is_shown() {
        let scene = crate::scene::load_or_simulated(Path::new("sim")).unwrap();
        let press = Wrench::from_force_at(&Vector3::new(0.013, 0.0, 0.0), Vector3::new(-2.0, 0.3, 0.0));
        let reading = |time: f64| Next::Reading(Reading { time: Some(time), wrench: press, volts: None });
        let samples = vec![reading(0.0), Next::Fault("cut".to_owned()), reading(0.001)];
        let (state, given, status) = seen(samples, None, usize::MAX, Some(SceneFeel::new(&scene, true)));
        assert_eq!(
            given.iter().map(|sample| (sample.number, sample.time)).collect::<Vec<_>>(),
            [(0, 0.0), (1, 0.001)]
        );
        let felt = given[1].felt.unwrap();
        let contact = felt.contact.unwrap();
        assert!((contact.point - Vector3::new(0.013, 0.0, 0.0)).norm() < 1e-12);
        assert!(
            (contact.normal_force - 2.0).abs() < 1e-12 && (contact.tangential_force.y - 0.3).abs() < 1e-12
        );
        assert_eq!((felt.status, given[1].wrench, felt.load), ("contact", press, press));
        let touch = state.touch.unwrap();
        assert_eq!((felt.margin, felt.slip), (touch.grip.flatten(), touch.slip));
        assert_eq!(
            (status.health, status.faults, status.lost),
            (fingertip_bridges::Health::Ended, 1, Some(2))
        );
    }

    /// Over the bridges, too, one sees when samples come and when a zero is taken.
    #[test]
    fn bridges_are_told_how_the_source_is() {
        let samples = || (0..6).map(|i| sample(f64::from(i), 1.0)).collect::<Vec<_>>();
        let told = |rest: Option<f64>, tare_at: usize| {
            let words = Arc::default();
            let (_, _, status) = heard(samples(), rest, (tare_at, Command::Tare), None, &words);
            let words = words.lock().unwrap().clone();
            (words, status.health.word())
        };
        let (words, end) = told(None, usize::MAX);
        assert_eq!((words[..2].to_vec(), end), (vec!["waiting", "running"], "ended"));
        assert!(words[1..].iter().all(|word| *word == "running"));
        let (words, _) = told(Some(2.0), usize::MAX);
        assert_eq!(words[..4], ["waiting", "resting", "resting", "running"]);
        // While it runs: asked for with the third sample, it is taken from the fourth on, for a second.
        let (words, _) = told(None, 2);
        assert_eq!(words[..6], ["waiting", "running", "running", "running", "resting", "running"]);
    }

    /// A sensor that was unplugged is said to be lost, to the view and over the bridges, until its samples come again.
    #[test]
    fn a_lost_sensor_is_told_of_until_it_is_back() {
        let shared = Arc::new(Shared {
            state: Mutex::new(State::new("test".to_owned())),
            stop: Stop::default(),
            hub: Hub::new(About::default()),
        });
        let how = |shared: &Shared| {
            let status = shared.hub.status();
            let state = shared.state();
            (state.health.clone(), status.health, state.reconnections, status.reconnections)
        };
        /// Samples, then an end; before each it looks how the source is.
        struct Looking<L>(u32, L);
        impl<L: FnMut(u32) + Send> Feed for Looking<L> {
            fn next(&mut self) -> Result<Next, SensorError> {
                self.1(self.0);
                self.0 += 1;
                Ok(if self.0 < 4 { sample(f64::from(self.0), 1.0) } else { Next::End })
            }
            fn losses(&self) -> Losses {
                Losses::default()
            }
        }
        let seen = Arc::new(Mutex::new(Vec::new()));
        let (of_feed, opened) = (Arc::clone(&shared), Arc::clone(&seen));
        let open = move || {
            let again = of_feed.hub.status().health.word() != "waiting";
            if again {
                opened.lock().unwrap().push(how(&of_feed));
            }
            let (shared, seen) = (Arc::clone(&of_feed), Arc::clone(&opened));
            let look = move |given: u32| {
                if again && given < 2 {
                    seen.lock().unwrap().push(how(&shared));
                    if given == 1 {
                        shared.stop.ask();
                    }
                }
            };
            Ok(Box::new(Looking(0, look)) as Box<dyn Feed>)
        };
        let options = StreamOptions { silence: Duration::from_secs(3600), reconnect: true };
        let stream = Stream::new(Box::new(open), options).unwrap();
        read(&shared, stream, Rest::new(None), None).unwrap();
        let seen = seen.lock().unwrap();
        let lost = "the line was closed".to_owned();
        let told = fingertip_bridges::Health::Lost(lost.clone());
        assert_eq!(seen[0], (Health::Lost(lost.clone()), told.clone(), 0, 0));
        assert_eq!(seen[1], (Health::Lost(lost), told, 1, 1));
        assert_eq!(seen[2], (Health::Running, fingertip_bridges::Health::Running, 1, 1));
    }

    #[test]
    fn a_zero_that_cannot_be_taken_leaves_the_one_before() {
        // At rest for a second, then, when a zero is asked for, no number for as long.
        let step = |k: u32| 0.1 * f64::from(k);
        let samples =
            (0..40).map(|k| sample(step(k), if (20..31).contains(&k) { f64::NAN } else { 3.0 })).collect();
        let (state, given, status) = seen(samples, Some(1.0), 20, None);
        assert_eq!((status.zero.taken, status.zero.failed), (0, 1));
        assert!(status.zero.why.contains("at rest") && state.last_fault.unwrap().contains("at rest"));
        assert_eq!(given.last().unwrap().wrench.force().x, 0.0);
        // One that can be is told.
        let samples = (0..40).map(|k| sample(step(k), 5.0)).collect();
        let (_, given, status) = seen(samples, None, 20, None);
        assert_eq!((status.zero.taken, status.zero.failed, status.zero.value), (1, 0, [5.0; 6]));
        assert_eq!((given[0].wrench.force().x, given.last().unwrap().wrench.force().x), (5.0, 0.0));
    }

    /// A filter goes on from the load before, unless it is asked to forget: then it starts at the next load.
    #[test]
    fn a_reset_begins_the_pipeline_and_the_scale_anew() {
        let scene = "version = 2\n[input]\nconvention = \"on_fingertip\"\nsample_rate_Hz = 1000.0\n[filter]\n\
                     kind = \"low_pass\"\ncutoff_Hz = 10.0\n[surface]\nshape = \"plane\"\n";
        let scene = Scene::from_text(scene).unwrap();
        let samples = || {
            let load = |k: u32| Vector3::new(0.0, 0.0, if k < 6 { -3.0 } else { -1.0 });
            let wrench = |k: u32| Wrench::from_force_at(&Vector3::new(0.001, 0.002, 0.0), load(k));
            let reading =
                |k: u32| Reading { time: Some(1e-3 * f64::from(k)), wrench: wrench(k), volts: None };
            (0..7).map(|k| Next::Reading(reading(k))).collect::<Vec<_>>()
        };
        let last = |ask: (usize, Command)| {
            let (state, given, _) = asked(samples(), None, ask, Some(SceneFeel::new(&scene, true)));
            (given.last().unwrap().felt.unwrap().load.force().z, state.greatest[0])
        };
        let (goes_on, greatest) = last((usize::MAX, Command::Reset));
        assert!(goes_on < -2.0 && greatest == 3.0, "{goes_on} {greatest}");
        // What is asked while the sixth is read is done before the seventh.
        assert_eq!(last((5, Command::Reset)), (-1.0, 1.0));
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

    /// A component that stands still while the others move is named, to the view and over the bridges.
    #[test]
    fn what_is_wrong_with_the_sensor_is_told() {
        let count = u32::try_from(super::HEALTH_PERIOD).unwrap();
        let moving = |k: u32, axis: usize| (f64::from(k) * (1.1 + axis as f64)).sin();
        let samples = |dead: usize| {
            let wrench =
                move |k| Vector6::from_fn(|axis, _| if axis == dead { 0.25 } else { moving(k, axis) });
            let reading = move |k| {
                let wrench = Wrench::from_components(&wrench(k));
                Next::Reading(Reading { time: Some(1e-3 * f64::from(k)), wrench, volts: None })
            };
            (0..count).map(reading).collect::<Vec<_>>()
        };
        let (state, _, status) = seen(samples(4), None, usize::MAX, None);
        assert!(state.seen.len() == 1 && state.seen[0].starts_with("ty "), "{:?}", state.seen);
        assert_eq!(status.seen, state.seen);
        let (state, _, status) = seen(samples(9), None, usize::MAX, None);
        assert!(state.seen.is_empty() && status.seen.is_empty(), "{:?}", state.seen);
    }

    #[test]
    fn faults_are_counted_and_the_last_is_kept() {
        let faults = ["one", "two"].map(|why| Next::Fault(why.to_owned()));
        let state = shown([vec![sample(0.0, 1.0)], faults.to_vec()].concat(), None, usize::MAX, None);
        assert_eq!((state.faults, state.last_fault.as_deref(), state.losses.lost), (2, Some("two"), Some(3)));
    }

    /// A scene that asks how noisy the sensor is learns it of the rest: a push above so many deviations is a contact.
    #[test]
    fn the_noise_of_a_rest_is_what_a_scene_asks_for() {
        let scene = "version = 2\n[input]\nconvention = \"on_fingertip\"\nrest_s = 1.0\n[surface]\n\
                     shape = \"plane\"\n[contact]\nleast_force_deviations = 5.0\n";
        let scene = Scene::from_text(scene).unwrap();
        // At rest ± 0.01 N in turn, then pushes of 0.2 N.
        let samples = || {
            let force = |k: u32| if k >= 20 { -0.2 } else { 0.01 * (1.0 - 2.0 * f64::from(k % 2)) };
            let wrench = |k: u32| Wrench::on_fingertip(Vector3::new(0.0, 0.0, force(k)), Vector3::zeros());
            let reading =
                |k: u32| Reading { time: Some(0.05 * f64::from(k)), wrench: wrench(k), volts: None };
            (0..22).map(|k| Next::Reading(reading(k))).collect::<Vec<_>>()
        };
        let status = |rest: Option<f64>| {
            let (_, given, _) = seen(samples(), rest, usize::MAX, Some(SceneFeel::new(&scene, true)));
            (given.len(), given.last().unwrap().felt.unwrap().status)
        };
        assert_eq!(status(Some(1.0)), (2, "contact"));
        // As long as nothing was at rest, nothing is known.
        let (samples, unknown) = status(None);
        assert!(samples == 22 && unknown != "contact", "{samples} {unknown}");
    }

    #[test]
    fn a_scene_makes_a_touch_of_a_sample() {
        let scene = crate::scene::load_or_simulated(Path::new("sim")).unwrap();
        let state = shown(vec![sample(0.0, -1.0)], None, usize::MAX, Some(SceneFeel::new(&scene, true)));
        assert!(state.touch.is_some());
        assert!(shown(vec![sample(0.0, -1.0)], None, usize::MAX, None).touch.is_none());
    }
}
