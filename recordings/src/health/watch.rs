//! Takes samples as they come, and says what they show of the sensor.

use super::block::Block;
use super::held::HeldWatch;
use super::lines;
use super::pending::Pending;
use super::report::{ChannelHealth, Excursion, Health, Rate};
use super::rest::{self, Quiet};
use super::spectrum::{Mean, Spectra};
use super::trace::Trace;
use super::{Drift, Noise, WatchedChannel, channel_judge, coupling, sensor_judge, zero_steps};
use crate::Timing;
use crate::time_watch::Step;

/// What a transform leaves of readings that are all the same, in their own size, and far more than that.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Whether a reading is another than the one before; NaN always is.
pub(super) fn is_change(reading: f64, before: f64) -> bool {
    let same = reading == before;
    !same
}

/// How much is looked at.
///
/// ```
/// use fingertip_recordings::health::{Depth, HealthWatch, Kind, WatchedChannel};
///
/// let spectrum = |depth| {
///     let mut watch = HealthWatch::new(vec![WatchedChannel::new("v1", "V", Kind::Signal)], depth);
///     for i in 0..8000_u32 {
///         watch.add(Some(f64::from(i) * 1e-3), &[f64::from(i.wrapping_mul(2_654_435_769) >> 16)]);
///     }
///     watch.finish().channels[0].spectrum.clone()
/// };
/// assert!(spectrum(Depth::Brief).is_empty());
/// // Up to half of the 1000 samples a second.
/// let (frequency, _) = *spectrum(Depth::Full).last().unwrap();
/// assert!((frequency - 500.0).abs() < 1.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Depth {
    /// What costs little: all but spectra, noise in common, and the Allan deviation of means of some readings.
    Brief,
    /// Everything.
    Full,
}

/// Watches the channels of one or several sensors that are read together.
///
/// ```
/// use fingertip_recordings::health::{Depth, HealthWatch, Kind, WatchedChannel, What};
///
/// let channels = ["v1", "v2", "v3"].map(|name| WatchedChannel::new(name, "V", Kind::Signal)).to_vec();
/// let mut state = 1_u32;
/// let mut noise = || {
///     state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
///     f64::from(state >> 25)
/// };
/// // Readings without times, 1000 a second.
/// let mut watch = HealthWatch::new(channels, Depth::Brief).with_rate(1000.0);
/// for _ in 0..4000 {
///     // The second gauge is thirty times as noisy as its neighbours.
///     watch.add(None, &[noise(), 30.0 * noise(), noise()]);
/// }
/// let noisy = watch.finish().findings.into_iter().find(|finding| finding.what == What::Noisy).unwrap();
/// assert_eq!(noisy.channels, ["v2"]);
/// ```
#[derive(Clone, Debug)]
pub struct HealthWatch {
    channels: Vec<WatchedChannel>,
    timing: Timing,
    /// Samples a second, where there are no times.
    stated_rate: Option<f64>,
    trace: Trace,
    held: Vec<HeldWatch>,
    spectra: Option<Spectra>,
    /// Samples that neither the trace nor `held` have seen: together they cost less than one by one.
    pending: Pending,
    held_rows: u64,
    samples: u64,
}

impl HealthWatch {
    /// Blocks that are kept at most; an eighth for a brief look.
    const BLOCKS: usize = 2048;
    /// Parts of the recording in the course of a channel.
    const COURSE: usize = 512;

    /// Of these channels.
    #[must_use]
    pub fn new(channels: Vec<WatchedChannel>, depth: Depth) -> Self {
        let mut pairs = Vec::new();
        for (i, first) in channels.iter().enumerate() {
            let with = channels.iter().enumerate().skip(i);
            let compared =
                with.filter(|(_, second)| first.is_neighbour_of(second) && !first.kind.is_of_wrench());
            pairs.extend(compared.map(|(j, _)| (i, j)).filter(|_| depth == Depth::Full));
        }
        let count = channels.len();
        Self {
            held: channels.iter().map(|channel| HeldWatch::new(channel.limits)).collect(),
            channels,
            timing: Timing::default(),
            stated_rate: None,
            trace: match depth {
                Depth::Full => Trace::new(count, pairs, Self::BLOCKS),
                Depth::Brief => Trace::brief(count, pairs, Self::BLOCKS / 8),
            },
            spectra: (depth == Depth::Full).then(|| Spectra::new(count)),
            pending: Pending::new(count),
            held_rows: 0,
            samples: 0,
        }
    }

    /// The same, of samples without times that come so often \[1/s\].
    #[must_use]
    pub fn with_rate(self, rate: f64) -> Self {
        Self { stated_rate: Some(rate).filter(|rate| *rate > 0.0 && rate.is_finite()), ..self }
    }

    /// How many samples it has taken.
    #[must_use]
    pub const fn samples(&self) -> u64 {
        self.samples
    }

    /// Takes a sample: its time \[s\], if it has one, and a reading of each channel. What is not finite is counted and left
    /// out, and so is a sample whose time does not advance.
    pub fn add(&mut self, time: Option<f64>, readings: &[f64]) {
        let step = time.and_then(|time| self.timing.judge(time));
        match step {
            Some(Step::Same) => return,
            Some(Step::Backward) => return self.interrupt(),
            Some(Step::Gap(_)) => self.interrupt(),
            _ => {}
        }
        let time = time.unwrap_or(self.samples as f64 * self.pace());
        if let Some(spectra) = &mut self.spectra {
            spectra.add(self.samples, readings);
        }
        self.pending.push(time, readings);
        self.samples += 1;
        if self.pending.is_full() {
            self.look();
        }
    }

    /// Looks at the samples that wait.
    fn look(&mut self) {
        if self.pending.is_empty() {
            return;
        }
        let pace = self.pace();
        let (times, pending) = (self.pending.times(), &self.pending);
        // How many channels change with each sample.
        let mut changes = [0_u32; Pending::MOST];
        let changes = changes.get_mut(..times.len()).unwrap_or_default();
        for column in pending.columns() {
            for ((count, before), reading) in changes.iter_mut().zip(column).zip(column.iter().skip(1)) {
                *count += u32::from(is_change(*reading, *before));
            }
        }
        if !self.held.is_empty() {
            // The first of all is no repetition.
            let first = usize::from(self.samples == times.len() as u64);
            self.held_rows += changes.iter().skip(first).filter(|count| **count == 0).count() as u64;
        }
        for (held, column) in self.held.iter_mut().zip(pending.columns()) {
            held.look(times, column, changes, pace);
        }
        self.trace.look(pending);
        self.pending.clear();
    }

    /// Readings are missing here.
    fn interrupt(&mut self) {
        self.look();
        self.trace.interrupt();
        self.held.iter_mut().for_each(HeldWatch::interrupt);
        if let Some(spectra) = &mut self.spectra {
            spectra.interrupt();
        }
    }

    /// How long a sample lasts \[s\]; 1 where nothing tells.
    fn pace(&self) -> f64 {
        self.timing.step().or(self.stated_rate.map(f64::recip)).unwrap_or(1.0)
    }

    /// What was seen so far. Costs some milliseconds; samples can be added thereafter.
    #[must_use]
    pub fn finish(&self) -> Health {
        if !self.pending.is_empty() {
            let mut whole = self.clone();
            whole.look();
            return whole.finish();
        }
        let quiet: Vec<Quiet> = self
            .held
            .iter()
            .enumerate()
            .map(|(channel, held)| Quiet::of(&self.trace, channel, held.monitor().step()))
            .collect();
        let rests = rest::rests(&self.trace, &quiet);
        let longest = rests.iter().max_by_key(|rest| rest.len()).cloned().unwrap_or_default();
        let resting: &[Block] = self.trace.blocks.get(longest).unwrap_or_default();
        let at_rest: usize = rests.iter().map(ExactSizeIterator::len).sum();
        let mut health = Health {
            samples: self.samples,
            rate: self.rate(),
            rest: rest::samples(resting).map(|(_, times)| [times.start, times.end]),
            rest_share: at_rest as f64 / self.trace.blocks.len().max(1) as f64,
            channels: (0..self.channels.len()).filter_map(|channel| self.channel(channel, resting)).collect(),
            steps: self.steps(&quiet),
            // The changes of the first block begin before the rest.
            couplings: coupling::of(resting.get(1..).unwrap_or_default(), self.trace.pairs()),
            findings: Vec::new(),
        };
        let mut findings = sensor_judge::findings(&health);
        findings.extend(channel_judge::findings(&health));
        findings.sort_by_key(|finding| core::cmp::Reverse(finding.level));
        health.findings = findings;
        health
    }

    fn rate(&self) -> Rate {
        Rate {
            rate: self.timing.rate().or(self.stated_rate),
            jitter: self.timing.jitter(),
            gaps: self.timing.gaps(),
            longest_gap: self.timing.longest_gap(),
            missing: self.timing.missing(),
            not_advancing: self.timing.repeats() + self.timing.backward(),
            held: self.held_rows,
        }
    }

    /// Zero steps, sensor by sensor.
    fn steps(&self, quiet: &[Quiet]) -> Vec<zero_steps::ZeroStep> {
        let mut steps = Vec::new();
        let own = || self.channels.iter().enumerate().filter(|(_, channel)| !channel.is_derived);
        for (number, channel) in own() {
            let beside = || own().filter(|(_, other)| other.is_beside(channel)).map(|(other, _)| other);
            // Once for all that are beside each other.
            if beside().next() == Some(number) {
                let members: Vec<usize> = beside().collect();
                steps.extend(zero_steps::find(&self.trace, quiet, &members));
            }
        }
        steps.sort_by_key(|step| step.sample);
        steps
    }

    fn channel(&self, number: usize, resting: &[Block]) -> Option<ChannelHealth> {
        let (watched, held) = (self.channels.get(number)?, self.held.get(number)?);
        let mut health = ChannelHealth::of(watched);
        let cells = || self.trace.blocks.iter().filter_map(|block| block.cells.get(number));
        let least = cells().map(|cell| cell.least).fold(f64::INFINITY, f64::min);
        let greatest = cells().map(|cell| cell.greatest).fold(f64::NEG_INFINITY, f64::max);
        health.range = (least <= greatest).then_some([least, greatest]);
        health.step = held.monitor().step();
        health.quiet_noise = held.monitor().noise();
        health.stretches.clone_from(&held.stretches);
        (health.at_fault, health.not_finite) = (held.readings, held.not_finite);
        health.course = self.course(number);
        let (span, times) = rest::samples(resting).unwrap_or_default();
        health.noise = Noise::of(resting, number, self.trace.octave());
        health.drift = Drift::of(resting, number, times.end - times.start);
        if let (Some(spectra), Some(rate)) = (&self.spectra, self.timing.rate().or(self.stated_rate))
            && let Some(mean) = spectra.mean(number, span.start, span.end)
        {
            let Mean { powers, stretches, is_of_span } = mean;
            health.lines = lines::find(&powers, stretches, rate);
            // Loads have lines of their own, and rounding has some that the sensor has not: a channel that never moves has
            // nothing else.
            let rounding = ROUNDING * least.abs().max(greatest.abs());
            health.lines.retain(|line| (is_of_span || !line.name.is_empty()) && line.rms > rounding);
            health.spectrum_at_rest = is_of_span;
            let width = rate / Spectra::LENGTH as f64;
            let density = |(bin, power): (usize, &f64)| (bin as f64 * width, (power / rate).sqrt());
            health.spectrum = powers.iter().enumerate().skip(1).map(density).collect();
        }
        Some(health)
    }

    fn course(&self, number: usize) -> Vec<Excursion> {
        let length = self.trace.blocks.len().div_ceil(Self::COURSE).max(1);
        let part = |blocks: &[Block]| {
            let cells = || blocks.iter().filter_map(|block| block.cells.get(number));
            let count: f64 = cells().map(|cell| f64::from(cell.count)).sum();
            let (first, last) = (blocks.first()?, blocks.last()?);
            (count > 0.0).then(|| Excursion {
                time: 0.5 * (first.time + last.time),
                least: cells().map(|cell| cell.least).fold(f64::INFINITY, f64::min),
                mean: cells().map(|cell| cell.mean * f64::from(cell.count)).sum::<f64>() / count,
                greatest: cells().map(|cell| cell.greatest).fold(f64::NEG_INFINITY, f64::max),
            })
        };
        self.trace.blocks.chunks(length).filter_map(part).collect()
    }
}
