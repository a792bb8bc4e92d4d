//! How the source is, beside its samples.

/// How the source is.
///
/// ```
/// use fingertip_bridges::Health;
///
/// let health = Health::Lost("no record within 2s".to_owned());
/// assert_eq!((health.word(), Health::default().word()), ("lost", "waiting"));
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Health {
    /// No sample has come yet.
    #[default]
    Waiting,
    /// Samples come.
    Running,
    /// A zero is being taken: nothing may touch.
    Resting,
    /// The sensor was lost, and why; it is connected anew.
    Lost(String),
    /// The recording is over.
    Ended,
}

impl Health {
    /// One word for it.
    #[must_use]
    pub const fn word(&self) -> &'static str {
        match self {
            Self::Waiting => "waiting",
            Self::Running => "running",
            Self::Resting => "resting",
            Self::Lost(_) => "lost",
            Self::Ended => "ended",
        }
    }
}

/// The zeros that were asked for while it runs.
///
/// ```
/// use fingertip_bridges::{About, Hub};
///
/// // Who reads the sensor tells what a new zero takes off.
/// let hub = Hub::new(About::default());
/// hub.publisher().tell(|status| {
///     status.zero.taken += 1;
///     status.zero.value = [0.1, 0.0, -0.3, 0.0, 0.0, 0.0];
/// });
/// assert_eq!(hub.status().zero.value[2], -0.3);
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Zero {
    /// How many were taken.
    pub taken: u64,
    /// How many could not be.
    pub failed: u64,
    /// Why the last one that failed did.
    pub why: String,
    /// What the last one takes off \[N, N·m\].
    pub value: [f64; 6],
}

/// What is told when it changes.
///
/// ```
/// use core::time::Duration;
/// use fingertip_bridges::{About, Hub};
///
/// let hub = Hub::new(About::default());
/// let mut reader = hub.subscribe();
/// hub.publisher().tell(|status| status.reconnections += 1);
/// let news = reader.wait(&mut Vec::new(), Duration::from_secs(1));
/// assert_eq!(news.status.map(|status| status.reconnections), Some(1));
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Status {
    /// How the source is.
    pub health: Health,
    /// The zeros that were asked for.
    pub zero: Zero,
    /// Samples that went missing between sensor and this computer, where that can be told.
    pub lost: Option<u64>,
    /// Samples that could not be used.
    pub faults: u64,
    /// How often the sensor was connected anew.
    pub reconnections: u64,
    /// What is wrong with the sensor, as far as it was seen.
    pub seen: Vec<String>,
}
