//! A source of counts that becomes a source of strain.

use core::fmt::Debug;

use fingertip_wrench::Real;
use nalgebra::SVector;
use thiserror::Error;

use super::front_end::{BridgeFault, BridgeFrontEnd};
use crate::polled::NbSource;
use crate::{AsyncSource, Sample, Source, SourceError, SourceErrorKind};

/// Why there is no strain.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum BridgedError<E> {
    /// The source of counts failed.
    #[error("{0:?}")]
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
