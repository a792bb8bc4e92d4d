//! A feed with a clock, that can be connected anew.

use core::time::Duration;
use std::time::Instant;

use super::{Feed, Losses, Next, Reading, SensorError};

/// Opens the sensor, the first time and after it was lost.
pub(crate) type Open = Box<dyn FnMut() -> Result<Box<dyn Feed>, SensorError> + Send>;

/// What to do when nothing comes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StreamOptions {
    /// A sensor that is silent for so long is lost.
    pub(crate) silence: Duration,
    /// Whether to connect to a lost sensor anew, until it is there again.
    pub(crate) reconnect: bool,
}

/// What comes next.
#[derive(Clone, Debug)]
pub(crate) enum Event {
    /// A sample and its time \[s\].
    Sample(f64, Reading),
    /// A sample that cannot be used, and why.
    Fault(String),
    /// Nothing for the moment.
    Nothing,
    /// The connection was lost, and why; it is tried anew.
    Lost(String),
    /// The recording is over.
    End,
}

/// Samples with a time that goes on over reconnections.
pub(crate) struct Stream {
    open: Open,
    /// Nothing while the sensor is lost.
    feed: Option<Box<dyn Feed>>,
    options: StreamOptions,
    begun: Instant,
    /// When the last sample came, or the connection was opened.
    heard: Instant,
    /// What is added to the sensor's time, known with the first sample of a connection \[s\].
    offset: Option<f64>,
    /// Whether samples have come at all.
    any: bool,
    timed_by_arrival: bool,
    /// \[s\]
    last_arrival: f64,
    before: Losses,
    reconnections: u64,
}

/// How often a lost sensor is tried anew.
const RETRY: Duration = Duration::from_millis(300);
/// Least step between samples whose time is that of their arrival \[s\].
const TOGETHER: f64 = 1e-6;

impl Stream {
    /// Opens the sensor; its first sample is expected within the silence that is allowed.
    pub(crate) fn new(mut open: Open, options: StreamOptions) -> Result<Self, SensorError> {
        let feed = open()?;
        let now = Instant::now();
        Ok(Self {
            open,
            feed: Some(feed),
            options,
            begun: now,
            heard: now,
            offset: None,
            any: false,
            timed_by_arrival: false,
            last_arrival: 0.0,
            before: Losses::default(),
            reconnections: 0,
        })
    }

    /// Whether samples have the time of their arrival, since the sensor sends none.
    pub(crate) const fn is_timed_by_arrival(&self) -> bool {
        self.timed_by_arrival
    }

    /// What went missing so far.
    pub(crate) fn losses(&self) -> Losses {
        match &self.feed {
            Some(feed) => self.before.and(feed.losses()),
            None => self.before,
        }
    }

    /// How often the sensor was connected anew.
    pub(crate) const fn reconnections(&self) -> u64 {
        self.reconnections
    }

    /// The next sample, or what came in its place; waits for a fraction of a second.
    ///
    /// # Errors
    /// If the sensor is lost and is not to be connected anew.
    pub(crate) fn next(&mut self) -> Result<Event, SensorError> {
        let Some(feed) = &mut self.feed else { return self.reopen() };
        match feed.next() {
            Ok(Next::Reading(reading)) => {
                self.heard = Instant::now();
                Ok(Event::Sample(self.time(&reading), reading))
            }
            Ok(Next::Fault(why)) => {
                self.heard = Instant::now();
                Ok(Event::Fault(why))
            }
            Ok(Next::Silence) if self.heard.elapsed() > self.options.silence => {
                let seconds = self.options.silence.as_secs_f64();
                self.lose(SensorError::Silent { ever: self.any, seconds })
            }
            Ok(Next::Silence) => Ok(Event::Nothing),
            // A line that ends is a sensor that was unplugged; a recording has no connection to lose.
            Ok(Next::End) if self.options.reconnect => self.lose(SensorError::Closed),
            Ok(Next::End) => Ok(Event::End),
            Err(why) => self.lose(SensorError::Lost(Box::new(why))),
        }
    }

    fn lose(&mut self, why: SensorError) -> Result<Event, SensorError> {
        if !self.options.reconnect {
            return Err(why);
        }
        self.before = self.losses();
        self.feed = None;
        Ok(Event::Lost(why.to_string()))
    }

    fn reopen(&mut self) -> Result<Event, SensorError> {
        std::thread::sleep(RETRY);
        if let Ok(feed) = (self.open)() {
            self.feed = Some(feed);
            self.reconnections += 1;
            self.offset = None;
            self.heard = Instant::now();
        }
        Ok(Event::Nothing)
    }

    /// The sensor's own time, counted from the first sample; the arrival's where it has none. Behind a
    /// reconnection it goes on where the clock of this computer is by then.
    fn time(&mut self, reading: &Reading) -> f64 {
        if !self.any {
            self.any = true;
            self.begun = self.heard;
        }
        let arrival = self.heard.saturating_duration_since(self.begun).as_secs_f64();
        match reading.time {
            Some(time) => time + *self.offset.get_or_insert(arrival - time),
            None => {
                // Two samples in one piece of the line do arrive together, but were not taken together.
                let after = if self.timed_by_arrival { self.last_arrival + TOGETHER } else { 0.0 };
                self.timed_by_arrival = true;
                self.last_arrival = arrival.max(after);
                self.last_arrival
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use core::time::Duration;
    use std::time::Instant;

    use fingertip::wrench::Wrench;

    use super::super::{Feed, Losses, Next, Reading, SensorError};
    use super::{Event, Stream, StreamOptions};

    /// Gives what it is told to, then silence.
    struct Told(Vec<Result<Next, SensorError>>);

    impl Feed for Told {
        fn next(&mut self) -> Result<Next, SensorError> {
            if self.0.is_empty() { Ok(Next::Silence) } else { self.0.remove(0) }
        }
        fn losses(&self) -> Losses {
            Losses { lost: Some(1), late: 2, ..Losses::default() }
        }
    }

    fn told(silence: Duration, reconnect: bool, connections: Vec<Vec<Result<Next, SensorError>>>) -> Stream {
        let mut connections = connections.into_iter();
        let open = move || {
            let told = connections.next().ok_or(SensorError::Over)?;
            Ok(Box::new(Told(told)) as Box<dyn Feed>)
        };
        Stream::new(Box::new(open), StreamOptions { silence, reconnect }).unwrap()
    }

    const HOUR: Duration = Duration::from_secs(3600);

    fn reading(time: Option<f64>) -> Result<Next, SensorError> {
        Ok(Next::Reading(Reading { time, wrench: Wrench::zero(), volts: None }))
    }

    /// Gives some samples with times, then fails.
    struct Short(Vec<f64>);

    impl Feed for Short {
        fn next(&mut self) -> Result<Next, SensorError> {
            let time = self.0.pop().ok_or_else(|| SensorError::Source("unplugged".into()))?;
            Ok(Next::Reading(Reading { time: Some(time), wrench: Wrench::zero(), volts: None }))
        }
        fn losses(&self) -> Losses {
            Losses { lost: Some(3), ..Losses::default() }
        }
    }

    fn stream(reconnect: bool) -> Stream {
        let open = || Ok(Box::new(Short(vec![102.0, 101.0, 100.0])) as Box<dyn Feed>);
        Stream::new(Box::new(open), StreamOptions { silence: Duration::from_secs(1), reconnect }).unwrap()
    }

    #[test]
    fn time_counts_from_the_first_sample_and_a_lost_sensor_ends_it() {
        let mut stream = stream(false);
        for expected in [0.0, 1.0, 2.0] {
            assert!(matches!(stream.next(), Ok(Event::Sample(time, _)) if time == expected));
        }
        assert!(stream.next().unwrap_err().to_string().starts_with("unplugged; is the sensor on"));
    }

    #[test]
    fn a_sensor_that_comes_back_goes_on() {
        let mut stream = stream(true);
        let begun = Instant::now();
        let mut times = Vec::new();
        while times.len() < 6 {
            if let Event::Sample(time, _) = stream.next().unwrap() {
                times.push(time);
            }
        }
        assert_eq!(stream.reconnections(), 1);
        assert_eq!(stream.losses().lost, Some(6));
        // The second connection's clock starts anew, at the time that has passed here.
        assert!(times[3] >= 0.3 && times[3] <= begun.elapsed().as_secs_f64(), "{times:?}");
        assert!((times[5] - times[3] - 2.0).abs() < 1e-9);
    }

    #[test]
    fn silence_is_nothing_until_it_has_lasted() {
        let mut patient = told(HOUR, false, vec![vec![]]);
        assert!(matches!(patient.next(), Ok(Event::Nothing)));
        let mut hasty = told(Duration::ZERO, false, vec![vec![]]);
        assert_eq!(hasty.next().unwrap_err().to_string(), "the sensor sends nothing: no sample for 0 s");
        let brief = Duration::from_micros(1);
        let mut hasty = told(brief, false, vec![vec![reading(None)]]);
        assert!(matches!(hasty.next(), Ok(Event::Sample(..))));
        std::thread::sleep(2 * brief);
        assert_eq!(hasty.next().unwrap_err().to_string(), "the sensor fell silent: no sample for 0.000001 s");
    }

    #[test]
    fn faults_are_passed_on_and_count_as_a_sign_of_life() {
        let next = vec![Ok(Next::Fault("cut".to_owned())), reading(Some(1.0)), Ok(Next::End)];
        let mut stream = told(HOUR, false, vec![next]);
        // Each is heard now, and no earlier.
        let before = Instant::now();
        assert!(matches!(stream.next(), Ok(Event::Fault(why)) if why == "cut"));
        let between = Instant::now();
        assert!(stream.heard >= before && stream.heard <= between);
        assert!(matches!(stream.next(), Ok(Event::Sample(..))));
        assert!(stream.heard >= between);
        assert!(matches!(stream.next(), Ok(Event::End)));
    }

    #[test]
    fn samples_that_arrive_together_keep_their_order() {
        let mut stream = told(HOUR, false, vec![vec![reading(None), reading(None), reading(None)]]);
        assert!(!stream.is_timed_by_arrival());
        let mut times = Vec::new();
        for _ in 0..3 {
            let Ok(Event::Sample(time, _)) = stream.next() else { panic!("no sample") };
            times.push(time);
            // The clock stands still: all three come at one time.
            stream.heard = stream.begun;
        }
        assert!(stream.is_timed_by_arrival());
        assert!(times[0] == 0.0 && times[1] >= 1e-6 && times[2] - times[1] >= 0.999e-6, "{times:?}");
        // A clock that has gone on tells the time itself.
        let mut late = told(HOUR, false, vec![vec![reading(None), reading(None)]]);
        assert!(matches!(late.next(), Ok(Event::Sample(time, _)) if time == 0.0));
        if let Some(earlier) = late.begun.checked_sub(Duration::from_secs(100)) {
            late.begun = earlier;
            assert!(matches!(late.next(), Ok(Event::Sample(time, _)) if (100.0..3600.0).contains(&time)));
        }
    }

    #[test]
    fn what_is_lost_is_connected_anew_only_if_that_is_wanted() {
        let connections =
            || vec![vec![Ok(Next::End)], vec![reading(Some(7.0)), Err(SensorError::Source("pulled".into()))]];
        let mut once = told(HOUR, false, connections());
        assert!(matches!(once.next(), Ok(Event::End)));
        let mut again = told(HOUR, true, connections());
        assert_eq!((again.losses().lost, again.losses().late), (Some(1), 2));
        assert!(matches!(again.next(), Ok(Event::Lost(why)) if why == "the line was closed"));
        // Between connections what was lost before still counts.
        assert_eq!((again.losses().lost, again.losses().late, again.reconnections()), (Some(1), 2, 0));
        let before = Instant::now();
        assert!(matches!(again.next(), Ok(Event::Nothing)));
        assert_eq!((again.losses().lost, again.losses().late, again.reconnections()), (Some(2), 4, 1));
        // Its silence counts from here.
        assert!(again.heard >= before);
        assert!(matches!(again.next(), Ok(Event::Sample(..))));
        assert!(matches!(again.next(), Ok(Event::Lost(why)) if why.starts_with("pulled; is the sensor on")));
        // There is no third connection: it goes on trying.
        assert!(matches!(again.next(), Ok(Event::Nothing)));
        assert_eq!((again.losses().lost, again.reconnections()), (Some(2), 1));
        let none = || Err::<Box<dyn Feed>, _>(SensorError::Over);
        let options = StreamOptions { silence: HOUR, reconnect: true };
        assert!(matches!(Stream::new(Box::new(none), options), Err(SensorError::Over)));
    }
}
