//! Stretches over which a channel stays where its noise would not let it.

use fingertip_wrench::{ChannelFault, ChannelLimits, ChannelMonitor};

use super::watch::is_change;

/// A stretch over which a channel is at fault.
///
/// ```
/// use fingertip_recordings::health::{Depth, HealthWatch, Kind, WatchedChannel};
/// use fingertip_wrench::ChannelFault;
///
/// let mut watch = HealthWatch::new(vec![
///     WatchedChannel::new("v1", "counts", Kind::Signal),
///     WatchedChannel::new("v2", "counts", Kind::Signal),
/// ], Depth::Brief);
/// let mut state = 1_u32;
/// let mut noise = || {
///     state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
///     f64::from(state >> 25)
/// };
/// for i in 0..4000 {
///     let (first, second) = (noise(), noise());
///     // A wire of the second breaks after 3 s.
///     watch.add(Some(f64::from(i) * 1e-3), &[first, if i < 3000 { second } else { 50.0 }]);
/// }
/// let stretch = watch.finish().channels[1].stretches[0];
/// assert_eq!((stretch.fault, stretch.low, stretch.high), (ChannelFault::Stuck, 50.0, 50.0));
/// assert!((stretch.from - 3.0).abs() < 1e-9 && (stretch.to - 3.999).abs() < 1e-9);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct HeldStretch {
    /// When it began \[s\].
    pub from: f64,
    /// When it was last seen \[s\].
    pub to: f64,
    /// How many readings it has.
    pub readings: u64,
    /// The lowest reading in it.
    pub low: f64,
    /// The highest.
    pub high: f64,
    /// What is wrong.
    pub fault: ChannelFault,
}

/// Watches one channel, and keeps how often it was at fault and where first.
#[derive(Clone, Debug)]
pub(super) struct HeldWatch {
    monitor: ChannelMonitor<f64>,
    /// The first stretches.
    pub(super) stretches: Vec<HeldStretch>,
    /// Readings at fault, those of stretches that are not kept included.
    pub(super) readings: u64,
    /// Readings that are NaN or infinite.
    pub(super) not_finite: u64,
    /// Whether the stretch that was kept last goes on.
    goes_on: bool,
}

impl HeldWatch {
    /// So many stretches are kept.
    const MOST: usize = 16;
    /// So many readings are looked at together: few enough that mostly none of them needs a second look.
    const GLANCE: usize = 16;

    pub(super) fn new(limits: ChannelLimits<f64>) -> Self {
        let monitor = ChannelMonitor::new(limits);
        Self { monitor, stretches: Vec::new(), readings: 0, not_finite: 0, goes_on: false }
    }

    pub(super) const fn monitor(&self) -> &ChannelMonitor<f64> {
        &self.monitor
    }

    pub(super) fn interrupt(&mut self) {
        self.monitor.interrupt();
        self.goes_on = false;
    }

    /// Looks at readings that follow each other: when they came, the one before them and they themselves, how many channels
    /// change with each, and how long a sample lasts \[s\].
    pub(super) fn look(&mut self, times: &[f64], column: &[f64], changes: &[u32], pace: f64) {
        let Some((_, readings)) = column.split_first() else { return };
        let parts = readings.chunks(Self::GLANCE).zip(column.chunks(Self::GLANCE));
        let parts = parts.zip(times.chunks(Self::GLANCE)).zip(changes.chunks(Self::GLANCE));
        for (((readings, before), times), changes) in parts {
            if self.monitor.update_sound(readings) {
                self.goes_on = false;
                continue;
            }
            for (((time, reading), before), count) in times.iter().zip(readings).zip(before).zip(changes) {
                let own = u32::from(is_change(*reading, *before));
                self.add(*time, *reading, *count > own, pace);
            }
        }
    }

    /// Takes a reading, and how long a sample lasts \[s\].
    fn add(&mut self, time: f64, reading: f64, others_change: bool, pace: f64) {
        let fault = match self.monitor.update(reading, others_change) {
            None => return self.goes_on = false,
            Some(ChannelFault::NotFinite) => {
                self.not_finite += 1;
                return self.goes_on = false;
            }
            Some(fault) => fault,
        };
        if self.goes_on && self.stretches.last().is_some_and(|last| last.fault == fault) {
            self.readings += 1;
            if let Some(last) = self.stretches.last_mut() {
                (last.to, last.readings) = (time, last.readings + 1);
                (last.low, last.high) = (last.low.min(reading), last.high.max(reading));
            }
            return;
        }
        // What stays was at fault from its first reading on.
        let saturated = matches!(fault, ChannelFault::SaturatedLow | ChannelFault::SaturatedHigh);
        let readings = if saturated { 1 } else { u64::from(self.monitor.held()) };
        let [low, high] = if saturated { [reading, reading] } else { self.monitor.held_between() };
        self.readings += readings;
        self.goes_on = self.stretches.len() < Self::MOST;
        if self.goes_on {
            let from = time - pace * (readings - 1) as f64;
            self.stretches.push(HeldStretch { from, to: time, readings, low, high, fault });
        }
    }
}
