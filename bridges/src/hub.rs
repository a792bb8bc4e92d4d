//! Where samples go through: written by one, read by many, and never a reason for the writer to wait.

use alloc::collections::VecDeque;
use alloc::sync::Arc;
use core::sync::atomic::{AtomicBool, Ordering};
use core::time::Duration;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use thiserror::Error;

use crate::{About, Health, Publisher, Sample, Status, Subscription};

/// Samples that are kept for readers: four seconds at 1 kHz.
pub(crate) const KEPT: usize = 4096;

/// What can be asked of the sensor.
///
/// ```
/// use fingertip_bridges::{About, Command, Hub};
///
/// let hub = Hub::new(About::default());
/// // A page asks for a new zero, twice; who reads the sensor hears of it once.
/// hub.ask(Command::Tare);
/// hub.ask(Command::Tare);
/// assert_eq!((hub.asked(), hub.asked()), (Some(Command::Tare), None));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Command {
    /// A new zero, of the mean over the next second, in which nothing may touch.
    Tare,
    /// To forget: the last contact, what detectors remember, the trail.
    Reset,
}

/// Why there is no new zero.
///
/// ```
/// use core::time::Duration;
/// use fingertip_bridges::{About, Hub, NoZero};
///
/// let hub = Hub::new(About::default());
/// hub.close();
/// let refused = hub.tare(Duration::from_secs(2)).unwrap_err();
/// assert_eq!(
///     (&refused, refused.to_string().as_str()),
///     (&NoZero::Ended, "no new zero: the stream has ended")
/// );
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum NoZero {
    /// The samples gave none; the zero before is kept.
    #[error("no new zero, the one before is kept: {0}")]
    Failed(String),
    /// It was not taken in time.
    #[error("no new zero within {0} s; is the sensor streaming?")]
    Late(u64),
    /// The stream has ended.
    #[error("no new zero: the stream has ended")]
    Ended,
}

/// What the hub keeps.
#[derive(Debug, Default)]
pub(crate) struct Ring {
    /// The last ones.
    pub(crate) samples: VecDeque<Sample>,
    /// The number of the next sample.
    pub(crate) next: u64,
    pub(crate) status: Status,
    /// Counts changes of the status.
    pub(crate) version: u64,
    pub(crate) closed: bool,
}

impl Ring {
    /// Takes samples over, and the count of those that are lost before them.
    pub(crate) fn take(&mut self, lost: &mut u64, kept: &mut VecDeque<Sample>) {
        if *lost > 0 {
            // What stays here follows one upon another.
            self.samples.clear();
            self.next += core::mem::take(lost);
        }
        for mut sample in kept.drain(..) {
            sample.number = self.next;
            self.next += 1;
            if self.samples.len() >= KEPT {
                self.samples.pop_front();
            }
            self.samples.push_back(sample);
        }
    }
}

#[derive(Debug)]
pub(crate) struct Shared {
    ring: Mutex<Ring>,
    /// Told of every sample and change.
    pub(crate) grown: Condvar,
    tare: AtomicBool,
    reset: AtomicBool,
    about: About,
}

impl Shared {
    pub(crate) fn ring(&self) -> MutexGuard<'_, Ring> {
        // What a reader that died left is whole: it writes nothing.
        self.ring.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The ring, unless somebody has it just now.
    pub(crate) fn try_ring(&self) -> Option<MutexGuard<'_, Ring>> {
        use std::sync::TryLockError;
        match self.ring.try_lock() {
            Ok(ring) => Some(ring),
            Err(TryLockError::Poisoned(poisoned)) => Some(poisoned.into_inner()),
            Err(TryLockError::WouldBlock) => None,
        }
    }
}

/// The hub; a clone is the same one.
///
/// ```
/// use core::time::Duration;
/// use fingertip::wrench::Wrench;
/// use fingertip_bridges::{About, Hub, Sample};
///
/// let hub = Hub::new(About::default());
/// // Two readers, each at its own pace.
/// let (mut quick, mut slow) = (hub.subscribe(), hub.subscribe());
/// let (mut publisher, mut samples) = (hub.publisher(), Vec::new());
/// for number in 0..3 {
///     publisher.publish(Sample::new(f64::from(number) * 1e-3, Wrench::zero(), None));
///     quick.wait(&mut samples, Duration::from_secs(1));
/// }
/// assert_eq!(samples.len(), 3);
/// samples.clear();
/// slow.wait(&mut samples, Duration::from_secs(1));
/// assert_eq!(samples.len(), 3);
/// ```
#[derive(Clone, Debug)]
pub struct Hub(pub(crate) Arc<Shared>);

impl Hub {
    /// A hub for one stream.
    #[must_use]
    pub fn new(about: About) -> Self {
        let ring = Ring { samples: VecDeque::with_capacity(KEPT), ..Ring::default() };
        let (tare, reset) = (AtomicBool::new(false), AtomicBool::new(false));
        Self(Arc::new(Shared { ring: Mutex::new(ring), grown: Condvar::new(), tare, reset, about }))
    }

    /// What does not change from sample to sample.
    #[must_use]
    pub fn about(&self) -> &About {
        &self.0.about
    }

    /// Who gives samples. There shall be one; two would mix theirs.
    #[must_use]
    pub fn publisher(&self) -> Publisher {
        Publisher::new(self.clone())
    }

    /// Reads from now on.
    #[must_use]
    pub fn subscribe(&self) -> Subscription {
        let next = self.0.ring().next;
        Subscription::new(self.clone(), next)
    }

    /// How the source is.
    #[must_use]
    pub fn status(&self) -> Status {
        self.0.ring().status.clone()
    }

    /// Asks something of the sensor. What is asked twice before it is done is done once.
    pub fn ask(&self, command: Command) {
        match command {
            Command::Tare => self.0.tare.store(true, Ordering::Relaxed),
            Command::Reset => self.0.reset.store(true, Ordering::Relaxed),
        }
    }

    /// What was asked; each is given once.
    pub fn asked(&self) -> Option<Command> {
        let taken = |flag: &AtomicBool| flag.load(Ordering::Relaxed) && flag.swap(false, Ordering::Relaxed);
        if taken(&self.0.tare) {
            return Some(Command::Tare);
        }
        taken(&self.0.reset).then_some(Command::Reset)
    }

    /// Asks for a new zero, and waits for it: what it takes off \[N, N·m\].
    ///
    /// # Errors
    /// [`NoZero`].
    pub fn tare(&self, patience: Duration) -> Result<[f64; 6], NoZero> {
        let mut ring = self.0.ring();
        let before = (ring.status.zero.taken, ring.status.zero.failed);
        self.ask(Command::Tare);
        let begun = Instant::now();
        loop {
            let zero = &ring.status.zero;
            if zero.taken > before.0 {
                return Ok(zero.value);
            }
            if zero.failed > before.1 {
                return Err(NoZero::Failed(zero.why.clone()));
            }
            if ring.closed || ring.status.health == Health::Ended {
                return Err(NoZero::Ended);
            }
            let left = patience.saturating_sub(begun.elapsed());
            if left.is_zero() {
                return Err(NoZero::Late(patience.as_secs()));
            }
            ring = self.0.grown.wait_timeout(ring, left).unwrap_or_else(PoisonError::into_inner).0;
        }
    }

    /// Ends it: readers are told.
    pub fn close(&self) {
        self.0.ring().closed = true;
        self.0.grown.notify_all();
    }

    /// Whether it has ended.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.0.ring().closed
    }
}

#[cfg(test)]
mod tests {
    use core::time::Duration;

    use super::{Command, Hub, NoZero};
    use crate::{About, Health};

    #[test]
    fn what_is_asked_is_given_once() {
        let hub = Hub::new(About::default());
        assert_eq!(hub.asked(), None);
        for command in [Command::Reset, Command::Tare, Command::Tare] {
            hub.ask(command);
        }
        assert_eq!(
            [hub.asked(), hub.asked(), hub.asked()],
            [Some(Command::Tare), Some(Command::Reset), None]
        );
    }

    #[test]
    fn a_zero_is_waited_for_and_told() {
        let answer = |change: fn(&mut crate::Status)| {
            let hub = Hub::new(About::default());
            let asking = hub.clone();
            let asker = std::thread::spawn(move || asking.tare(Duration::from_secs(10)));
            while hub.asked() != Some(Command::Tare) {
                std::thread::yield_now();
            }
            hub.publisher().tell(change);
            asker.join().unwrap()
        };
        let zero = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
        let taken =
            answer(|status| (status.zero.taken, status.zero.value) = (1, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]));
        assert_eq!(taken, Ok(zero));
        let failed = answer(|status| (status.zero.failed, status.zero.why) = (1, "noise".to_owned()));
        assert_eq!(failed.unwrap_err().to_string(), "no new zero, the one before is kept: noise");
        assert_eq!(answer(|status| status.health = Health::Ended), Err(NoZero::Ended));
        let hub = Hub::new(About::default());
        assert_eq!(hub.tare(Duration::from_millis(5)), Err(NoZero::Late(0)));
        hub.close();
        assert_eq!(hub.tare(Duration::from_secs(9)), Err(NoZero::Ended));
    }
}
