//! The time of a bench.

use core::future::Future;
use core::pin::Pin;
use core::task::{Context, Poll};

use super::{SimulatedBench, SimulatedDevice};

/// The delay of a [`SimulatedBench`].
///
/// ```
/// use embedded_hal::delay::DelayNs;
/// use fingertip_drivers::converters::ads131m::SimulatedAds131m;
/// use fingertip_drivers::converters::{SimulatedBench, SimulatedDevice, WireFaults};
///
/// let bench = SimulatedBench::new(SimulatedAds131m::new(|_| [0.15; 2]), WireFaults::default());
/// bench.delay().delay_ms(1);
/// assert_eq!((bench.now(), bench.with(|chip| chip.conversions())), (1_000_000, 4));
/// ```
#[derive(Clone, Debug)]
pub struct SimulatedDelay<D>(pub(super) SimulatedBench<D>);

impl<D: SimulatedDevice> embedded_hal::delay::DelayNs for SimulatedDelay<D> {
    fn delay_ns(&mut self, nanoseconds: u32) {
        self.0.advance(u64::from(nanoseconds));
    }
}

/// Time goes on by a microsecond each time that it is asked for, so that other futures are asked, too.
struct Pause<'a, D> {
    bench: &'a SimulatedBench<D>,
    until: u64,
}

impl<D: SimulatedDevice> Future for Pause<'_, D> {
    type Output = ();

    fn poll(self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<()> {
        let now = self.bench.now();
        if now >= self.until {
            return Poll::Ready(());
        }
        self.bench.advance((self.until - now).min(1000));
        context.waker().wake_by_ref();
        Poll::Pending
    }
}

impl<D: SimulatedDevice> embedded_hal_async::delay::DelayNs for SimulatedDelay<D> {
    async fn delay_ns(&mut self, nanoseconds: u32) {
        Pause { bench: &self.0, until: self.0.now() + u64::from(nanoseconds) }.await;
    }
}
