//! Sources for a control loop that must not wait.

use crate::{Sample, SourceError};

/// Gives samples of `V` (a [`Wrench`](fingertip_wrench::Wrench), or the raw signals of `N` channels) without waiting.
///
/// # For users
/// `nb::Error::WouldBlock` means that no sample has come since the last call. Nothing else is lost
/// by asking often.
///
/// # For implementers
/// The contract of [`Source`](crate::Source), except that a call
/// shall return at once. A device implements it if its transport allows it, over the same core, which does no I/O.
///
/// ```
/// use fingertip_drivers::converters::hx711::{Hx711, Mode, SimulatedHx711s};
/// use fingertip_drivers::converters::{Patience, SimulatedBench, WireFaults};
/// use fingertip_drivers::polled::NbSource;
/// use nalgebra::Vector1;
///
/// let bench = SimulatedBench::new(SimulatedHx711s::new(|_| [(1e-3, 0.0)]), WireFaults::default());
/// let (clock, data, delay) = (bench.clock(), bench.data(), bench.delay());
/// let mut chip = Hx711::new(clock, data, delay, Mode::A128, Patience::default());
/// chip.start()?;
/// // A loop of 1 kHz: the chip settles, and then gives a sample every 12.5 ms.
/// let mut given = Vec::new();
/// for turn in 0..200 {
///     bench.advance(1_000_000);
///     match NbSource::<f64, Vector1<f64>>::poll_sample(&mut chip) {
///         Ok(sample) => given.extend(sample.map(|_| turn)),
///         Err(nb::Error::WouldBlock) => {} // on with the last one
///         Err(nb::Error::Other(error)) => return Err(error.into()),
///     }
/// }
/// assert_eq!(given.len(), 9);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` gives no `{V}` with times of `{T}` without waiting",
    note = "a source of your own implements `NbSource`; one that waits is a `Source`"
)]
pub trait NbSource<T, V> {
    /// What can go wrong.
    type Error: SourceError;

    /// The next sample that is there already, or `None` at the end.
    ///
    /// # Errors
    /// `WouldBlock` if none is there yet; otherwise whatever keeps the source from giving one.
    fn poll_sample(&mut self) -> nb::Result<Option<Sample<T, V>>, Self::Error>;
}

impl<T, V, S: NbSource<T, V> + ?Sized> NbSource<T, V> for &mut S {
    type Error = S::Error;

    #[inline]
    fn poll_sample(&mut self) -> nb::Result<Option<Sample<T, V>>, Self::Error> {
        (**self).poll_sample()
    }
}
