//! A source of counts that becomes a source of strain.

use core::fmt::Debug;

use fingertip_wrench::Real;
use nalgebra::SVector;
use thiserror::Error;

use super::front_end::{BridgeFault, BridgeFrontEnd};
use crate::polled::NbSource;
use crate::{AsyncSource, Sample, Source, SourceError, SourceErrorKind};

/// Why there is no strain.
///
/// Its kind is that of the fault within it:
///
/// ```
/// use fingertip_drivers::bridge::{BridgeFault, BridgedError};
/// use fingertip_drivers::converters::ConverterFault;
/// use fingertip_drivers::{SourceError, SourceErrorKind};
///
/// let late = BridgedError::Source(ConverterFault::Timeout);
/// let broken = BridgedError::<ConverterFault>::from(BridgeFault::NoExcitation);
/// assert_eq!((late.kind(), broken.kind()), (SourceErrorKind::Timeout, SourceErrorKind::DeviceFault));
/// assert_eq!(broken.to_string(), "there is no excitation");
/// let told = "the converter did not become ready in time; is its clock running, and the pin wired?";
/// assert_eq!(late.to_string(), told);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum BridgedError<E> {
    /// The source of counts failed.
    #[error(transparent)]
    Source(E),
    /// The counts give none.
    #[error(transparent)]
    Bridge(#[from] BridgeFault),
}

impl<E: SourceError> SourceError for BridgedError<E> {
    fn kind(&self) -> SourceErrorKind {
        match self {
            Self::Source(error) => error.kind(),
            Self::Bridge(fault) => fault.kind(),
        }
    }
}

/// Strains \[m/m\] of `N` bridges from a source of the counts of `M` channels.
///
/// ```
/// use fingertip_drivers::Source;
/// use fingertip_drivers::bridge::{
///     BridgeChannel, BridgeCircuit, BridgeFrontEnd, Bridged, CountScale, Excitation,
/// };
/// use fingertip_drivers::converters::hx711::{Hx711, Mode, SimulatedHx711s};
/// use fingertip_drivers::converters::{Patience, SimulatedBench, WireFaults};
///
/// // A full bridge that gives 0.5 mV/V, at a chip.
/// let bench = SimulatedBench::new(SimulatedHx711s::new(|_| [(0.5e-3, 0.0)]), WireFaults::default());
/// let (clock, data, delay) = (bench.clock(), bench.data(), bench.delay());
/// let mut chip = Hx711::new(clock, data, delay, Mode::A128, Patience::default());
/// chip.start()?;
///
/// let scale = CountScale::bits24(Mode::A128.full_scale());
/// let bridge = BridgeChannel::new(0, BridgeCircuit::full(), 2.0, scale);
/// let front_end = BridgeFrontEnd::<f64, 1, 1>::new([bridge], Excitation::Reference)?;
/// let sample = Bridged::new(chip, front_end).next_sample()?.unwrap();
/// assert!((sample.value.x - 250e-6).abs() < 1e-9);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Bridged<S, T, const N: usize, const M: usize> {
    source: S,
    front_end: BridgeFrontEnd<T, N, M>,
}

impl<S, T: Real, const N: usize, const M: usize> Bridged<S, T, N, M> {
    /// Around a source.
    #[must_use]
    pub const fn new(source: S, front_end: BridgeFrontEnd<T, N, M>) -> Self {
        Self { source, front_end }
    }

    /// The source inside.
    #[must_use]
    pub const fn source(&self) -> &S {
        &self.source
    }

    /// The source inside, to configure or to restart it.
    #[must_use]
    pub const fn source_mut(&mut self) -> &mut S {
        &mut self.source
    }

    fn strained<E>(
        &self,
        sample: Option<Sample<T, SVector<T, M>>>,
    ) -> Result<Option<Sample<T, SVector<T, N>>>, BridgedError<E>> {
        let Some(Sample { time, value }) = sample else { return Ok(None) };
        Ok(Some(Sample { time, value: self.front_end.strain(&value)? }))
    }
}

impl<T: Real, S: Source<T, SVector<T, M>>, const N: usize, const M: usize> Source<T, SVector<T, N>>
    for Bridged<S, T, N, M>
{
    type Error = BridgedError<S::Error>;

    fn next_sample(&mut self) -> Result<Option<Sample<T, SVector<T, N>>>, Self::Error> {
        let sample = self.source.next_sample().map_err(BridgedError::Source)?;
        self.strained(sample)
    }
}

impl<T: Real, S: NbSource<T, SVector<T, M>>, const N: usize, const M: usize> NbSource<T, SVector<T, N>>
    for Bridged<S, T, N, M>
{
    type Error = BridgedError<S::Error>;

    fn poll_sample(&mut self) -> nb::Result<Option<Sample<T, SVector<T, N>>>, Self::Error> {
        let sample = self.source.poll_sample().map_err(|error| error.map(BridgedError::Source))?;
        self.strained(sample).map_err(nb::Error::Other)
    }
}

impl<T: Real, S: AsyncSource<T, SVector<T, M>>, const N: usize, const M: usize> AsyncSource<T, SVector<T, N>>
    for Bridged<S, T, N, M>
{
    type Error = BridgedError<S::Error>;

    async fn next_sample(&mut self) -> Result<Option<Sample<T, SVector<T, N>>>, Self::Error> {
        let sample = self.source.next_sample().await.map_err(BridgedError::Source)?;
        self.strained(sample)
    }
}
