//! Waiting for a converter, never without end.

use core::convert::Infallible;
use core::future::Future;
use core::pin::pin;
use core::task::Poll;

use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{ErrorType, InputPin};
use embedded_hal_async::digital::Wait;

/// How long to wait for a converter.
///
/// ```
/// use fingertip_drivers::converters::Patience;
///
/// // For a converter of 1 kHz: some of its periods, looked at every 10 µs.
/// assert_eq!(Patience { limit: 5000, pause: 10 }.looks(), 501);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Patience {
    /// Longest wait \[µs\]: some periods of the converter.
    pub limit: u32,
    /// Pause between two looks at the pin or at the device \[µs\], at least 1.
    pub pause: u32,
}

impl Patience {
    /// How many looks fit in, at least one.
    #[must_use]
    pub const fn looks(self) -> u32 {
        (self.limit / if self.pause == 0 { 1 } else { self.pause }).saturating_add(1)
    }
}

impl Default for Patience {
    /// A second, looked at every 20 µs: enough for all converters here, the slowest at 2.5 Hz.
    fn default() -> Self {
        Self { limit: 1_000_000, pause: 20 }
    }
}

/// In place of a "ready" pin that is not wired: it always says that it may be worth asking.
///
/// ```
/// use fingertip_drivers::converters::ads131m::{Ads131m, Configuration, SimulatedAds131m};
/// use fingertip_drivers::converters::{Patience, SimulatedBench, Unwired, WireFaults};
///
/// let bench = SimulatedBench::new(SimulatedAds131m::new(|_| [0.15; 2]), WireFaults::default());
/// let mut converter = Ads131m::new(bench.spi(), Unwired, bench.delay(), Patience::default());
/// converter.configure(&Configuration::<2>::default())?;
/// assert_eq!(converter.read()?.counts, [1_048_576; 2]);
/// // It was asked over the bus until it had one.
/// assert!(converter.statistics().stale > 0);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Unwired;

impl ErrorType for Unwired {
    type Error = Infallible;
}

impl InputPin for Unwired {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        Ok(false)
    }

    fn is_low(&mut self) -> Result<bool, Infallible> {
        Ok(true)
    }
}

impl Wait for Unwired {
    /// Never comes: nothing makes the pin go high.
    async fn wait_for_high(&mut self) -> Result<(), Infallible> {
        core::future::pending().await
    }

    async fn wait_for_low(&mut self) -> Result<(), Infallible> {
        Ok(())
    }

    async fn wait_for_rising_edge(&mut self) -> Result<(), Infallible> {
        core::future::pending().await
    }

    async fn wait_for_falling_edge(&mut self) -> Result<(), Infallible> {
        core::future::pending().await
    }

    async fn wait_for_any_edge(&mut self) -> Result<(), Infallible> {
        core::future::pending().await
    }
}

/// Whether the pin goes low in time.
pub(crate) fn ready_in_time<P: InputPin>(
    pin: &mut P,
    delay: &mut impl DelayNs,
    patience: Patience,
) -> Result<bool, P::Error> {
    for _ in 0..patience.looks() {
        if pin.is_low()? {
            return Ok(true);
        }
        delay.delay_us(patience.pause.max(1));
    }
    pin.is_low()
}

/// Whether the pin goes low in time: the pin and the delay are awaited together.
pub(crate) async fn ready_in_time_async<P: Wait>(
    pin: &mut P,
    delay: &mut impl embedded_hal_async::delay::DelayNs,
    patience: Patience,
) -> Result<bool, P::Error> {
    let mut ready = pin!(pin.wait_for_low());
    let mut late = pin!(delay.delay_us(patience.limit.max(1)));
    core::future::poll_fn(|context| {
        if let Poll::Ready(result) = ready.as_mut().poll(context) {
            return Poll::Ready(result.map(|()| true));
        }
        late.as_mut().poll(context).map(|()| Ok(false))
    })
    .await
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_is_always_one_look_and_never_one_too_many() {
        for (limit, pause, looks) in [(0, 0, 1), (100, 10, 11), (u32::MAX, 0, u32::MAX), (5, u32::MAX, 1)] {
            assert_eq!(Patience { limit, pause }.looks(), looks);
        }
    }
}
