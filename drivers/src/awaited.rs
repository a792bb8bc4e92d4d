//! Sources for a task of an asynchronous executor.

use crate::{Sample, SourceError};

/// Gives samples of `V` (a [`Wrench`](fingertip_wrench::Wrench), or the raw signals of `N` channels) in a task.
///
/// # For implementers
/// The contract of [`Source`](crate::Source). A call that is
/// dropped before it is done shall lose no sample that a later call could give.
///
/// Generic code, for a sensor on a line as for a converter:
///
/// ```
/// use fingertip_drivers::AsyncSource;
/// use fingertip_drivers::converters::hx711::{AsyncHx711, Mode, SimulatedHx711s};
/// use fingertip_drivers::converters::{Patience, SimulatedBench, WireFaults};
/// use nalgebra::Vector2;
///
/// /// The mean of some samples.
/// async fn mean<S: AsyncSource<f64, Vector2<f64>>>(
///     source: &mut S,
///     samples: u32,
/// ) -> Result<Vector2<f64>, S::Error> {
///     let mut sum = Vector2::zeros();
///     for _ in 0..samples {
///         sum += source.next_sample().await?.map_or(Vector2::zeros(), |sample| sample.value);
///     }
///     Ok(sum / f64::from(samples))
/// }
///
/// # use fingertip_test_support::block_on;
/// let bench =
///     SimulatedBench::new(SimulatedHx711s::new(|_| [(1e-3, 0.0), (-1e-3, 0.0)]), WireFaults::default());
/// let (clock, data, delay) = (bench.clock(), bench.data(), bench.delay());
/// let mut chips = AsyncHx711::new(clock, data, delay, bench.delay(), Mode::A128, Patience::default());
/// block_on(chips.start())?;
/// assert_eq!(block_on(mean(&mut chips, 10))?, Vector2::new(2_147_484.0, -2_147_484.0));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[allow(async_fn_in_trait, reason = "as in embedded-hal-async: executors of microcontrollers need no Send")]
#[diagnostic::on_unimplemented(
    message = "`{Self}` gives no `{V}` with times of `{T}` to a task",
    note = "a source of your own implements `AsyncSource`; one that blocks is a `Source`"
)]
pub trait AsyncSource<T, V> {
    /// What can go wrong.
    type Error: SourceError;

    /// The next sample, or `None` at the end.
    ///
    /// # Errors
    /// Whatever keeps the source from giving a sound sample.
    async fn next_sample(&mut self) -> Result<Option<Sample<T, V>>, Self::Error>;
}

impl<T, V, S: AsyncSource<T, V> + ?Sized> AsyncSource<T, V> for &mut S {
    type Error = S::Error;

    #[inline]
    async fn next_sample(&mut self) -> Result<Option<Sample<T, V>>, Self::Error> {
        (**self).next_sample().await
    }
}
