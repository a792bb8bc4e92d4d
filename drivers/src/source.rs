//! Where samples come from.

use core::fmt::Debug;

/// What kind of thing went wrong, common to all sources.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum SourceErrorKind {
    /// The bus, socket or file failed.
    Transport,
    /// No sample came in time.
    Timeout,
    /// A sample came whose checksum, framing or text is wrong.
    Corrupt,
    /// The device says that its reading is beyond its range.
    Overload,
    /// The device reports a fault of its own.
    DeviceFault,
    /// The device or file does not have what is asked of it.
    Unsupported,
    /// Anything else.
    Other,
}

/// An error of a source: whatever it is, it can say its kind, so that generic code can decide
/// whether to try again.
pub trait SourceError: Debug {
    /// What kind of error this is.
    fn kind(&self) -> SourceErrorKind;
}

impl SourceError for core::convert::Infallible {
    fn kind(&self) -> SourceErrorKind {
        match *self {}
    }
}

/// One sample and when it was taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample<T, V> {
    /// Time of the sample \[s\] on the clock of the device, the file or the script; `None` where
    /// there is none. Never the time at which a library function happened to run.
    pub time: Option<T>,
    /// What was sampled.
    pub value: V,
}

/// Gives samples of `V`, one at a time: the raw signals of `N` channels (an `SVector<T, N>`: converters, recordings
/// of volts, the simulated fingertip) or wrenches (a [`Wrench`](fingertip_wrench::Wrench): force/torque sensors and
/// recordings of them).
///
/// # For users
/// `while let Some(sample) = source.next_sample()? { … }`. A sample that comes is sound: a source
/// answers a corrupt one with an error, never with old or made-up numbers. After an error the next
/// call tries the next sample. Wrenches are the load on the fingertip \[N, N·m\] in the sensor frame; channels are in
/// the unit that the source documents (volts or counts), without tare.
///
/// # For implementers
/// `next_sample` shall return every sample once, in the order in which they were taken, and
/// `Ok(None)` only when there will never be another one.
pub trait Source<T, V> {
    /// What can go wrong.
    type Error: SourceError;

    /// The next sample, or `None` at the end.
    ///
    /// # Errors
    /// Whatever keeps the source from giving a sound sample.
    fn next_sample(&mut self) -> Result<Option<Sample<T, V>>, Self::Error>;
}

impl<T, V, S: Source<T, V> + ?Sized> Source<T, V> for &mut S {
    type Error = S::Error;

    #[inline]
    fn next_sample(&mut self) -> Result<Option<Sample<T, V>>, Self::Error> {
        (**self).next_sample()
    }
}
