//! Channels that are saturated, clipped or stuck.

use super::quiet_noise::QuietNoise;
use crate::numeric::normal::normal_distribution;
use crate::{ChannelFault, ChannelLimits, Real, Resolution};

/// Watches the raw readings of a channel for ends of its range, and for readings that stay where noise would not let
/// them: at a plateau, wherever in the numeric range an amplifier clips, or at whatever a broken wire gives.
///
/// It learns the step of the converter and the noise of the channel, so that there is nothing to set. Readings *stay*
/// while they lie within two neighbouring steps. Noise of `σ` steps keeps a reading there with probability
/// `Φ(1/σ) − Φ(−1/σ)` at most; what stays for so long that this happens by chance once in 10¹² readings, while other
/// channels change, is a fault. A channel whose noise is smaller than 0.6 steps stays where it is when nothing moves:
/// such a one is never accused. Nor is one before its noise is known, which takes some hundred readings.
/// See `docs/theory/wrench.md#the-health-of-a-channel`.
///
/// ```
/// use fingertip_wrench::{ChannelFault, ChannelLimits, ChannelMonitor};
///
/// // Counts with a noise of some steps, whose amplifier clips at 880.
/// let mut monitor = ChannelMonitor::<f64>::new(ChannelLimits::none());
/// let mut last = None;
/// for i in 0..2000_i32 {
///     let noise = f64::from(i.wrapping_mul(7919) % 11) - 5.0;
///     let load = if i < 1000 { 500.0 } else { f64::from(i) };
///     last = monitor.update((load + noise).min(880.0), true);
/// }
/// assert_eq!(last, Some(ChannelFault::PlateauHigh));
/// assert!(monitor.held() > 800);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChannelMonitor<T: Real> {
    limits: ChannelLimits<T>,
    resolution: Resolution<T>,
    noise: QuietNoise<T>,
    /// Readings that stay: between which values, how many, and during how many of them another channel changed.
    low: T,
    high: T,
    held: u32,
    witnessed: u32,
    least: T,
    greatest: T,
    /// How many readings may stay; none while that is not known.
    patience: Option<u32>,
    readings: u32,
}

impl<T: Real> ChannelMonitor<T> {
    /// −ln of how often a sound channel may stay by chance: once in 10¹² readings.
    const RARE: f64 = 27.6;
    /// Variance of one reading in squared steps, rounding included, below which a resting channel may stay.
    const COARSE: f64 = 0.45;
    /// Fewer readings than this never stay for too long.
    const FEWEST: f64 = 8.0;
    /// The noise is looked at again behind so many readings.
    const PERIOD: u32 = 32;

    /// Of a channel with this linear range.
    #[must_use]
    pub fn new(limits: ChannelLimits<T>) -> Self {
        Self {
            limits,
            resolution: Resolution::default(),
            noise: QuietNoise::new(),
            low: T::zero(),
            high: T::zero(),
            held: 0,
            witnessed: 0,
            least: T::GREATEST,
            greatest: -T::GREATEST,
            patience: None,
            readings: 0,
        }
    }

    /// Takes a raw reading, and whether another channel changed since the reading before; gives its fault.
    pub fn update(&mut self, reading: T, others_change: bool) -> Option<ChannelFault> {
        if !reading.is_number() {
            self.interrupt();
            return Some(ChannelFault::NotFinite);
        }
        self.resolution.add(reading);
        let hold = self.hold();
        self.noise.add(reading, hold);
        self.readings = self.readings.saturating_add(1);
        if self.readings.is_multiple_of(Self::PERIOD) {
            self.patience = self.patience();
        }
        self.least = if reading < self.least { reading } else { self.least };
        self.greatest = if reading > self.greatest { reading } else { self.greatest };
        let low = if reading < self.low { reading } else { self.low };
        let high = if reading > self.high { reading } else { self.high };
        if self.held > 0 && high - low <= hold {
            (self.low, self.high) = (low, high);
            self.held = self.held.saturating_add(1);
            self.witnessed = self.witnessed.saturating_add(u32::from(others_change));
        } else {
            (self.low, self.high, self.held, self.witnessed) = (reading, reading, 1, 0);
        }
        self.limits.fault(reading).or_else(|| self.stays(hold))
    }

    /// Takes raw readings that follow each other, as [`update`](Self::update) would one by one, if it sees at a glance that
    /// none of them is at fault: each is finite, within the linear range, and so far from the one before that it cannot
    /// stay. `false`, and none is taken, where each has to be looked at. For recordings, in less than half the time.
    ///
    /// ```
    /// use fingertip_wrench::{ChannelFault, ChannelLimits, ChannelMonitor};
    ///
    /// let mut monitor = ChannelMonitor::<f64>::new(ChannelLimits::none());
    /// monitor.update(0.0, true);
    /// monitor.update(0.001, true); // a step of the converter, for all that is known
    /// assert!(monitor.update_sound(&[0.5, 0.3, 0.7]));
    /// assert!(!monitor.update_sound(&[0.5, f64::NAN]));
    /// assert_eq!(monitor.update(f64::NAN, true), Some(ChannelFault::NotFinite));
    /// ```
    #[must_use]
    pub fn update_sound(&mut self, readings: &[T]) -> bool {
        let Some((mut last, far)) = self.resolution.tells_up_to() else { return readings.is_empty() };
        let (mut least, mut greatest, mut sound) = (T::GREATEST, -T::GREATEST, true);
        for reading in readings {
            let change = (*reading - last).abs();
            // A NaN is neither.
            sound &= (change > far) & (change <= T::GREATEST);
            least = if *reading < least { *reading } else { least };
            greatest = if *reading > greatest { *reading } else { greatest };
            last = *reading;
        }
        if readings.is_empty() || !sound || self.limits.fault(least).or(self.limits.fault(greatest)).is_some()
        {
            return readings.is_empty();
        }
        let hold = self.hold();
        let mut rest = readings;
        while !rest.is_empty() {
            let left = self.noise.left().min((Self::PERIOD - self.readings % Self::PERIOD) as usize);
            let (taken, others) = rest.split_at(left.min(rest.len()));
            self.resolution.add_far(taken);
            self.noise.add_all(taken, hold);
            self.readings = self.readings.saturating_add(u32::try_from(taken.len()).unwrap_or(u32::MAX));
            if self.readings.is_multiple_of(Self::PERIOD) {
                self.patience = self.patience();
            }
            rest = others;
        }
        self.least = if least < self.least { least } else { self.least };
        self.greatest = if greatest > self.greatest { greatest } else { self.greatest };
        (self.low, self.high, self.held, self.witnessed) = (last, last, 1, 0);
        true
    }

    /// Readings are missing here: what stayed before says nothing of what comes.
    pub fn interrupt(&mut self) {
        self.held = 0;
        self.noise.interrupt();
    }

    /// How many readings up to now lie within two neighbouring steps.
    #[must_use]
    pub const fn held(&self) -> u32 {
        self.held
    }

    /// The values between which they lie.
    #[must_use]
    pub const fn held_between(&self) -> [T; 2] {
        [self.low, self.high]
    }

    /// The step of the converter, if it shows.
    #[must_use]
    pub fn step(&self) -> Option<T> {
        self.resolution.step()
    }

    /// Standard deviation of a reading at rest, as its changes from reading to reading have it; `None` until some
    /// hundred readings have told it.
    #[must_use]
    pub fn noise(&self) -> Option<T> {
        self.noise.variance().map(Real::root)
    }

    /// What is no motion: a step, and a half for its rounding.
    fn hold(&self) -> T {
        self.resolution.step().unwrap_or_else(T::zero) * T::literal(1.5)
    }

    /// How many readings may stay by chance.
    fn patience(&self) -> Option<u32> {
        let variance = self.noise.variance()?.to_f64();
        let Some(step) = self.resolution.step() else {
            return self.resolution.is_known().then_some(Self::FEWEST as u32);
        };
        let steps = variance / (step.to_f64() * step.to_f64());
        if !(steps >= Self::COARSE) {
            return None;
        }
        // Rounding adds a twelfth of a squared step.
        let deviation = libm::sqrt(steps - 1.0 / 12.0);
        let share = 1.0 - 2.0 * normal_distribution(-1.0 / deviation);
        let readings = Self::RARE / -libm::log(share);
        Some(readings.clamp(Self::FEWEST, 1e9) as u32)
    }

    fn stays(&self, hold: T) -> Option<ChannelFault> {
        // Half of the time another channel changed: what all hold is a buffer that was read again.
        let is_short = self.patience.is_none_or(|patience| self.held <= patience);
        if is_short || self.witnessed < self.held / 2 {
            return None;
        }
        let is_highest = self.greatest - self.high <= hold;
        let is_lowest = self.low - self.least <= hold;
        Some(match (is_lowest, is_highest) {
            (false, true) => ChannelFault::PlateauHigh,
            (true, false) => ChannelFault::PlateauLow,
            _ => ChannelFault::Stuck,
        })
    }
}
