//! A line of a bench.

use core::convert::Infallible;
use core::task::Poll;

use embedded_hal::digital::{self, InputPin};
use embedded_hal_async::digital::Wait;

use super::{Inner, SimulatedBench, SimulatedDevice};

/// A line that a device on a [`SimulatedBench`] drives, to be looked at or waited for.
///
/// ```
/// use embedded_hal::digital::InputPin;
/// use fingertip_drivers::converters::ads131m::SimulatedAds131m;
/// use fingertip_drivers::converters::{SimulatedBench, WireFaults};
///
/// let bench = SimulatedBench::new(SimulatedAds131m::new(|_| [0.15; 2]), WireFaults::default());
/// let mut ready = bench.ready();
/// assert!(ready.is_high()?);
/// // After a period, 0.25 ms, a conversion is there.
/// bench.advance(250_000);
/// assert!(ready.is_low()?);
/// # Ok::<(), core::convert::Infallible>(())
/// ```
#[derive(Clone, Debug)]
pub struct SimulatedLine<D> {
    bench: SimulatedBench<D>,
    is_high: fn(&mut Inner<D>, usize) -> bool,
    index: usize,
}

impl<D: SimulatedDevice> SimulatedLine<D> {
    /// The line of that index, whose level is read from the bench.
    pub(crate) const fn new(
        bench: SimulatedBench<D>,
        is_high: fn(&mut Inner<D>, usize) -> bool,
        index: usize,
    ) -> Self {
        Self { bench, is_high, index }
    }

    fn level(&self) -> bool {
        (self.is_high)(&mut self.bench.lock(), self.index)
    }

    /// Each time that a task looks in vain, a microsecond goes by.
    async fn until(&self, high: bool) {
        core::future::poll_fn(|context| {
            if self.level() == high {
                return Poll::Ready(());
            }
            self.bench.advance(1000);
            context.waker().wake_by_ref();
            Poll::Pending
        })
        .await;
    }
}

impl<D> digital::ErrorType for SimulatedLine<D> {
    type Error = Infallible;
}

impl<D: SimulatedDevice> InputPin for SimulatedLine<D> {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        Ok(self.level())
    }

    fn is_low(&mut self) -> Result<bool, Infallible> {
        Ok(!self.level())
    }
}

impl<D: SimulatedDevice> Wait for SimulatedLine<D> {
    async fn wait_for_high(&mut self) -> Result<(), Infallible> {
        self.until(true).await;
        Ok(())
    }

    async fn wait_for_low(&mut self) -> Result<(), Infallible> {
        self.until(false).await;
        Ok(())
    }

    async fn wait_for_rising_edge(&mut self) -> Result<(), Infallible> {
        self.until(false).await;
        self.until(true).await;
        Ok(())
    }

    async fn wait_for_falling_edge(&mut self) -> Result<(), Infallible> {
        self.until(true).await;
        self.until(false).await;
        Ok(())
    }

    async fn wait_for_any_edge(&mut self) -> Result<(), Infallible> {
        let now = self.level();
        self.until(!now).await;
        Ok(())
    }
}
