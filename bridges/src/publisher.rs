//! Who gives samples, and never waits.

use alloc::collections::VecDeque;

use crate::hub::KEPT;
use crate::{Hub, Sample, Status};

/// How often it is tried to get the hub while a reader copies: some microseconds in all.
const TRIES: u32 = 200;

/// Gives samples to a hub. It never waits for a reader: while one copies, samples are kept and given together with
/// the next one.
///
/// ```
/// use fingertip::wrench::Wrench;
/// use fingertip_bridges::{About, Health, Hub, Sample};
///
/// let hub = Hub::new(About::default());
/// let mut publisher = hub.publisher();
/// publisher.tell(|status| status.health = Health::Running);
/// publisher.publish(Sample::new(0.001, Wrench::zero(), None));
/// assert_eq!(hub.status().health, Health::Running);
/// ```
#[derive(Debug)]
pub struct Publisher {
    hub: Hub,
    kept: VecDeque<Sample>,
    /// Samples for which there was no room among those, before them.
    lost: u64,
}

impl Publisher {
    pub(crate) fn new(hub: Hub) -> Self {
        Self { hub, kept: VecDeque::with_capacity(KEPT), lost: 0 }
    }

    /// Gives a sample to all who read.
    pub fn publish(&mut self, sample: Sample) {
        if self.kept.len() >= KEPT {
            self.kept.pop_front();
            self.lost += 1;
        }
        self.kept.push_back(sample);
        self.flush();
    }

    /// Gives what was kept, if no reader copies just now. Call it when nothing comes for a while.
    pub fn flush(&mut self) {
        if self.kept.is_empty() {
            return;
        }
        for _ in 0..TRIES {
            if let Some(mut ring) = self.hub.0.try_ring() {
                ring.take(&mut self.lost, &mut self.kept);
                drop(ring);
                self.hub.0.grown.notify_all();
                return;
            }
            core::hint::spin_loop();
        }
    }

    /// Changes what is told of the source; readers hear of it if it is a change. This may wait for a reader that copies.
    pub fn tell(&mut self, change: impl FnOnce(&mut Status)) {
        let mut ring = self.hub.0.ring();
        ring.take(&mut self.lost, &mut self.kept);
        let before = ring.status.clone();
        change(&mut ring.status);
        if ring.status != before {
            ring.version += 1;
        }
        drop(ring);
        self.hub.0.grown.notify_all();
    }
}

#[cfg(test)]
mod tests {
    use core::time::Duration;
    use std::sync::mpsc;

    use fingertip::wrench::Wrench;

    use crate::hub::KEPT;
    use crate::{About, Hub, Sample};

    #[test]
    fn a_reader_that_copies_keeps_nobody_waiting_and_loses_nothing() {
        let hub = Hub::new(About::default());
        let mut reader = hub.subscribe();
        let mut publisher = hub.publisher();
        let (holding, held) = mpsc::channel();
        let (release, released) = mpsc::channel::<()>();
        let holder = hub.clone();
        let thread = std::thread::spawn(move || {
            let _ring = holder.0.ring();
            holding.send(()).unwrap();
            // Whoever waits for this reader has not given all samples by then.
            released.recv_timeout(Duration::from_mins(1)).unwrap();
        });
        held.recv().unwrap();
        (0..10).for_each(|k| publisher.publish(Sample::new(f64::from(k), Wrench::zero(), None)));
        release.send(()).unwrap();
        thread.join().unwrap();
        publisher.publish(Sample::new(10.0, Wrench::zero(), None));
        let mut samples = Vec::new();
        let news = reader.wait(&mut samples, Duration::ZERO);
        let times: Vec<f64> = samples.iter().map(|sample| sample.time).collect();
        assert_eq!((times, news.missed), ((0..=10).map(f64::from).collect(), 0));
    }
    #[test]
    fn what_there_was_no_room_for_is_counted_as_missed() {
        let hub = Hub::new(About::default());
        let (mut before, mut publisher) = (hub.subscribe(), hub.publisher());
        publisher.publish(Sample::new(-1.0, Wrench::zero(), None));
        {
            let _ring = hub.0.ring();
            (0..KEPT + 5).for_each(|k| publisher.publish(Sample::new(k as f64, Wrench::zero(), None)));
        }
        publisher.flush();
        let mut samples = Vec::new();
        // The first one, and five of those that were kept.
        assert_eq!(before.wait(&mut samples, Duration::ZERO).missed, 6);
        assert_eq!((samples[0].time, samples[0].number), (5.0, 6));
    }
}
