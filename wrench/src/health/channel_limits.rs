//! The linear range of a channel, and what can be wrong with a reading.

use thiserror::Error;

use crate::Real;
use crate::stored;

/// What is wrong with a channel.
///
/// ```
/// use fingertip_wrench::{ChannelFault, ChannelLimits, ChannelMonitor};
///
/// let mut monitor = ChannelMonitor::new(ChannelLimits::new(0.0, 1023.0)?);
/// assert_eq!(monitor.update(1023.0, true), Some(ChannelFault::SaturatedHigh));
/// // A wire breaks after a thousand counts that had noise.
/// let mut last = None;
/// for i in 0..2000_i32 {
///     let noise = f64::from(i.wrapping_mul(7919) % 11) - 5.0;
///     last = monitor.update(if i < 1000 { 500.0 + noise } else { 500.0 }, true);
/// }
/// assert_eq!(last, Some(ChannelFault::Stuck));
/// # Ok::<(), fingertip_wrench::BadLimits>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum ChannelFault {
    /// NaN or infinite.
    NotFinite,
    /// At or below the lower end of its linear range.
    SaturatedLow,
    /// At or above the upper end of its linear range.
    SaturatedHigh,
    /// Stays at one value, the lowest it ever had, while others change: an amplifier at its limit, wherever in the
    /// converter's range that limit is.
    PlateauLow,
    /// Stays at one value, the highest it ever had, while others change.
    PlateauHigh,
    /// Stays at one value, none of its extremes, while others change: a broken wire or a stale buffer.
    Stuck,
}

/// The linear range of a channel, in the unit of its raw readings.
///
/// ```
/// use fingertip_wrench::{ChannelFault, ChannelLimits};
///
/// // An amplifier between rails of ±10 V is linear up to half a volt from them.
/// let limits = ChannelLimits::new(-9.5, 9.5)?;
/// assert_eq!(limits.fault(3.0), None);
/// assert_eq!(limits.fault(9.7), Some(ChannelFault::SaturatedHigh));
/// # Ok::<(), fingertip_wrench::BadLimits>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChannelLimits<T: Real> {
    least: T,
    greatest: T,
}

/// Limits that cannot be used.
///
/// ```
/// use fingertip_wrench::ChannelLimits;
///
/// let refused = ChannelLimits::new(9.5, -9.5).unwrap_err();
/// assert_eq!(refused.to_string(), "the lower limit of a channel is not below its upper limit");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum BadLimits {
    /// The lower limit is not below the upper one, or a limit is NaN.
    #[error("the lower limit of a channel is not below its upper limit")]
    Empty,
}

impl<T: Real> ChannelLimits<T> {
    /// From the lowest and highest readings that are still linear. Infinite limits mean none.
    ///
    /// # Errors
    /// [`BadLimits::Empty`].
    pub fn new(least: T, greatest: T) -> Result<Self, BadLimits> {
        if least < greatest { Ok(Self { least, greatest }) } else { Err(BadLimits::Empty) }
    }

    /// No limits.
    #[must_use]
    pub fn none() -> Self {
        let infinite = T::one() / T::zero();
        Self { least: -infinite, greatest: infinite }
    }

    /// The fault of a reading, if any.
    #[inline]
    #[must_use]
    pub fn fault(&self, reading: T) -> Option<ChannelFault> {
        if !reading.is_number() {
            Some(ChannelFault::NotFinite)
        } else if reading <= self.least {
            Some(ChannelFault::SaturatedLow)
        } else if reading >= self.greatest {
            Some(ChannelFault::SaturatedHigh)
        } else {
            None
        }
    }
}

stored! {
    ChannelLimits<T>, [T: Real],
    |limits| { least: T = limits.least, greatest: T = limits.greatest },
    Self::new(least, greatest)
}
