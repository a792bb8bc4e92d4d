//! Who reads samples, at a pace of one's own.

use core::time::Duration;
use std::sync::PoisonError;
use std::time::Instant;

use crate::{Hub, Sample, Status};

/// Most samples that are copied at once, so that the hub is held for microseconds.
const AT_ONCE: usize = 256;

/// Reads from a hub.
///
/// ```
/// use core::time::Duration;
/// use fingertip::wrench::Wrench;
/// use fingertip_bridges::{About, Hub, Sample};
///
/// let hub = Hub::new(About::default());
/// let (mut reader, mut publisher, mut samples) = (hub.subscribe(), hub.publisher(), Vec::new());
/// // Nobody reads for five seconds at 1 kHz: the oldest samples are gone.
/// for number in 0..5000 {
///     publisher.publish(Sample::new(f64::from(number) * 1e-3, Wrench::zero(), None));
/// }
/// reader.wait(&mut samples, Duration::from_secs(1));
/// assert_eq!((reader.missed(), samples[0].number), (904, 904));
/// ```
#[derive(Debug)]
pub struct Subscription {
    hub: Hub,
    next: u64,
    missed: u64,
    version: Option<u64>,
}

/// What came beside samples.
///
/// ```
/// use core::time::Duration;
/// use fingertip_bridges::{About, Health, Hub};
///
/// let hub = Hub::new(About::default());
/// let mut reader = hub.subscribe();
/// // The first call says how the source is.
/// let news = reader.wait(&mut Vec::new(), Duration::from_secs(1));
/// assert_eq!(news.status.map(|status| status.health), Some(Health::Waiting));
/// hub.close();
/// assert!(reader.wait(&mut Vec::new(), Duration::from_secs(1)).closed);
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct News {
    /// Samples that were gone before they were read, since the last call.
    pub missed: u64,
    /// How the source is, if that has changed; with the first call in any case.
    pub status: Option<Status>,
    /// There will be no more.
    pub closed: bool,
}

impl Subscription {
    pub(crate) const fn new(hub: Hub, next: u64) -> Self {
        Self { hub, next, missed: 0, version: None }
    }

    /// Appends the samples that have come, 256 at most; waits for one, or for a change, for no longer than it is told.
    pub fn wait(&mut self, samples: &mut Vec<Sample>, patience: Duration) -> News {
        let begun = Instant::now();
        let mut ring = self.hub.0.ring();
        loop {
            let changed = self.version != Some(ring.version);
            if ring.next > self.next || changed || ring.closed {
                break;
            }
            let left = patience.saturating_sub(begun.elapsed());
            if left.is_zero() {
                return News::default();
            }
            ring = self.hub.0.grown.wait_timeout(ring, left).unwrap_or_else(PoisonError::into_inner).0;
        }
        let mut news = News { closed: ring.closed, ..News::default() };
        let oldest = ring.next - ring.samples.len() as u64;
        news.missed = oldest.saturating_sub(self.next);
        self.missed += news.missed;
        self.next = self.next.max(oldest);
        let from = usize::try_from(self.next - oldest).unwrap_or(usize::MAX).min(ring.samples.len());
        let before = samples.len();
        samples.extend(ring.samples.range(from..).take(AT_ONCE));
        self.next += (samples.len() - before) as u64;
        if self.version.replace(ring.version) != Some(ring.version) {
            news.status = Some(ring.status.clone());
        }
        news
    }

    /// Samples that were gone before they were read, in all.
    #[must_use]
    pub const fn missed(&self) -> u64 {
        self.missed
    }
}

#[cfg(test)]
mod tests {
    use core::time::Duration;

    use fingertip::wrench::Wrench;

    use super::AT_ONCE;
    use crate::hub::KEPT;
    use crate::{About, Health, Hub, Sample};

    fn sample(time: usize) -> Sample {
        Sample::new(time as f64, Wrench::zero(), None)
    }

    #[test]
    fn a_slow_reader_is_told_what_it_missed_and_another_misses_nothing() {
        let hub = Hub::new(About::default());
        let (mut slow, mut quick) = (hub.subscribe(), hub.subscribe());
        let mut publisher = hub.publisher();
        let (mut read, mut late) = (Vec::new(), Vec::new());
        for time in 0..KEPT + 1000 {
            publisher.publish(sample(time));
            assert_eq!(quick.wait(&mut read, Duration::ZERO).missed, 0);
        }
        let times = |samples: &[Sample]| samples.iter().map(|s| (s.number, s.time)).collect::<Vec<_>>();
        let all: Vec<(u64, f64)> = (0..KEPT + 1000).map(|k| (k as u64, k as f64)).collect();
        assert_eq!(times(&read), all);
        assert_eq!(slow.wait(&mut late, Duration::ZERO).missed, 1000);
        assert_eq!(times(&late), all[1000..1000 + AT_ONCE]);
        while late.len() < KEPT {
            assert_eq!(slow.wait(&mut late, Duration::ZERO).missed, 0);
        }
        assert_eq!((times(&late), slow.missed()), (all[1000..].to_vec(), 1000));
        // Who comes later reads from then on.
        assert_eq!(hub.subscribe().wait(&mut read, Duration::ZERO).missed, 0);
        assert_eq!(read.len(), KEPT + 1000);
        // However many have passed, no more are kept.
        assert_eq!(hub.0.ring().samples.len(), KEPT);
        assert_eq!(hub.0.ring().samples.capacity(), KEPT);
    }

    #[test]
    fn changes_are_told_once_and_the_end_to_all() {
        let hub = Hub::new(About::default());
        let mut reader = hub.subscribe();
        let mut samples = Vec::new();
        let mut told = || reader.wait(&mut samples, Duration::from_millis(1));
        assert_eq!(told().status.unwrap().health, Health::Waiting);
        assert_eq!(told().status, None);
        let mut publisher = hub.publisher();
        publisher.tell(|status| status.health = Health::Running);
        assert_eq!(told().status.unwrap().health, Health::Running);
        publisher.tell(|status| status.health = Health::Running);
        assert_eq!(told().status, None);
        hub.close();
        assert!(told().closed && hub.is_closed());
    }

    #[test]
    fn a_reader_that_waits_is_woken() {
        let hub = Hub::new(About::default());
        let mut reader = hub.subscribe();
        let mut samples = Vec::new();
        reader.wait(&mut samples, Duration::ZERO);
        let mut publisher = hub.publisher();
        let thread = std::thread::spawn(move || {
            reader.wait(&mut samples, Duration::from_secs(60));
            samples
        });
        publisher.publish(sample(7));
        assert_eq!(thread.join().unwrap()[0].time, 7.0);
    }
}
