//! Channels that are saturated or stuck.

use nalgebra::SVector;
use thiserror::Error;

use crate::Real;
use crate::stored;

/// What is wrong with a channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum ChannelFault {
    /// NaN or infinite.
    NotFinite,
    /// At or below the lower end of its linear range.
    SaturatedLow,
    /// At or above the upper end of its linear range.
    SaturatedHigh,
    /// Stays at one value, the lowest it ever had, while others move: an amplifier at its limit,
    /// wherever in the converter's range that limit is.
    PlateauLow,
    /// Stays at one value, the highest it ever had, while others move.
    PlateauHigh,
    /// Stays at one value, none of its extremes, while others move: a broken wire or a stale buffer.
    Stuck,
}

/// The linear range of each channel, in the unit of the raw readings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChannelLimits<T: Real, const N: usize> {
    least: SVector<T, N>,
    greatest: SVector<T, N>,
}

/// Limits or steps that cannot be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum BadLimits {
    /// The lower limit is not below the upper one, or a limit is NaN.
    #[error("the lower limit of channel {channel} is not below its upper limit")]
    Empty {
        /// Which channel, counted from 0.
        channel: usize,
    },
    /// A tolerance is negative or not finite, or fewer than two equal readings are asked for.
    #[error("the tolerance of channel {channel} is negative or not finite, or the run shorter than 2")]
    BadTolerance {
        /// Which channel, counted from 0.
        channel: usize,
    },
}

impl<T: Real, const N: usize> ChannelLimits<T, N> {
    /// From the lowest and highest readings that are still linear. Infinite limits mean none.
    ///
    /// # Errors
    /// [`BadLimits::Empty`].
    pub fn new(least: SVector<T, N>, greatest: SVector<T, N>) -> Result<Self, BadLimits> {
        match (0..N).find(|channel| !(least[*channel] < greatest[*channel])) {
            Some(channel) => Err(BadLimits::Empty { channel }),
            None => Ok(Self { least, greatest }),
        }
    }

    /// No limits.
    #[must_use]
    pub fn none() -> Self {
        let infinite = T::one() / T::zero();
        Self { least: SVector::repeat(-infinite), greatest: SVector::repeat(infinite) }
    }

    /// The fault of one channel's reading, if any; `None` for a channel that is not there.
    #[inline]
    #[must_use]
    pub fn fault(&self, raw: &SVector<T, N>, channel: usize) -> Option<ChannelFault> {
        let reading = *raw.get(channel)?;
        if !reading.is_number() {
            Some(ChannelFault::NotFinite)
        } else if reading <= self.least[channel] {
            Some(ChannelFault::SaturatedLow)
        } else if reading >= self.greatest[channel] {
            Some(ChannelFault::SaturatedHigh)
        } else {
            None
        }
    }
}

/// Watches raw readings for channels that are saturated or stuck.
///
/// Besides known [`ChannelLimits`] it finds the ones nobody wrote down: a channel that repeats its
/// reading while others move by more than their own tolerance is stuck, and if that reading is the
/// highest or lowest the channel ever had, it is on a plateau. A sensor on which nothing moves is at
/// rest, not stuck.
///
/// ```
/// use fingertip_wrench::{ChannelFault, ChannelLimits, ChannelMonitor};
/// use nalgebra::SVector;
///
/// // Counts of a 10-bit converter; the amplifier of channel 1 clips at 880.
/// let step = SVector::repeat(0.5);
/// let mut monitor = ChannelMonitor::<f64, 6>::new(ChannelLimits::none(), step, 8)?;
/// let mut faults = [None; 6];
/// for i in 0..100 {
///     let load = f64::from(i) * 10.0;
///     let mut counts = SVector::<f64, 6>::from_fn(|channel, _| load * (channel as f64 + 1.0) * 0.1);
///     counts[1] = (load + 500.0).min(880.0);
///     faults = monitor.update(&counts);
/// }
/// assert_eq!(faults[1], Some(ChannelFault::PlateauHigh));
/// assert_eq!(faults[0], None);
/// # Ok::<(), fingertip_wrench::BadLimits>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChannelMonitor<T: Real, const N: usize> {
    limits: ChannelLimits<T, N>,
    tolerance: SVector<T, N>,
    run: u16,
    /// The reading that each channel's run began with.
    held: SVector<T, N>,
    /// Readings since each channel last moved during which some other channel moved.
    still: [u16; N],
    least: SVector<T, N>,
    greatest: SVector<T, N>,
}

impl<T: Real, const N: usize> ChannelMonitor<T, N> {
    /// With known limits, the change of each channel that does not count as motion (below half a
    /// step of the converter, or zero), and how many readings a channel may stay the same while
    /// others move.
    ///
    /// A sound channel whose readings repeat with probability `p` (coarse steps, little noise) stays
    /// the same over `run` readings with probability `p^run`: choose the run by the false alarms
    /// that you can bear.
    ///
    /// # Errors
    /// [`BadLimits::BadTolerance`].
    pub fn new(limits: ChannelLimits<T, N>, tolerance: SVector<T, N>, run: u16) -> Result<Self, BadLimits> {
        let valid = |x: &T| *x >= T::zero() && x.is_number();
        let bad = tolerance.iter().position(|x| !valid(x)).or((run < 2).then_some(0));
        if let Some(channel) = bad {
            return Err(BadLimits::BadTolerance { channel });
        }
        Ok(Self {
            limits,
            tolerance,
            run,
            // NaN: the first reading always counts as motion.
            held: SVector::repeat(T::zero() / T::zero()),
            still: [0; N],
            least: SVector::repeat(T::GREATEST),
            greatest: SVector::repeat(-T::GREATEST),
        })
    }

    /// Takes one raw reading and gives the fault of each channel.
    pub fn update(&mut self, raw: &SVector<T, N>) -> [Option<ChannelFault>; N] {
        let mut moved = [false; N];
        for (channel, moved) in moved.iter_mut().enumerate() {
            let reading = raw[channel];
            // Negated so that NaN counts as motion, before and after.
            *moved = !((reading - self.held[channel]).abs() <= self.tolerance[channel]);
            if reading.is_number() {
                self.least[channel] = self.least[channel].min(reading);
                self.greatest[channel] = self.greatest[channel].max(reading);
            }
        }
        let any = moved.iter().any(|moved| *moved);
        for channel in 0..N {
            if moved[channel] {
                self.held[channel] = raw[channel];
                self.still[channel] = 0;
            } else if any {
                self.still[channel] = self.still[channel].saturating_add(1);
            }
        }
        core::array::from_fn(|channel| self.limits.fault(raw, channel).or_else(|| self.stuck(raw, channel)))
    }

    fn stuck(&self, raw: &SVector<T, N>, channel: usize) -> Option<ChannelFault> {
        if self.still[channel].saturating_add(1) < self.run {
            return None;
        }
        let tolerance = self.tolerance[channel];
        let high = self.greatest[channel] - raw[channel] <= tolerance;
        let low = raw[channel] - self.least[channel] <= tolerance;
        Some(match (low, high) {
            (false, true) => ChannelFault::PlateauHigh,
            (true, false) => ChannelFault::PlateauLow,
            // A channel that never moved is stuck.
            _ => ChannelFault::Stuck,
        })
    }
}

stored! {
    ChannelLimits<T, N>, [T: Real, const N: usize],
    |limits| { least: SVector<T, N> = limits.least, greatest: SVector<T, N> = limits.greatest },
    Self::new(least, greatest)
}
