//! Where samples come from.

use core::fmt::Debug;

use fingertip_wrench::{Real, Wrench};
use nalgebra::SVector;

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

/// The error of a source, apart from the traits so that one type can be a source of several
/// things with one error.
pub trait ErrorType {
    /// What can go wrong.
    type Error: SourceError;
}

impl<S: ErrorType + ?Sized> ErrorType for &mut S {
    type Error = S::Error;
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

/// Gives the raw signals of `N` channels, one sample at a time: converters, recordings of volts,
/// the simulated fingertip.
///
/// # For users
/// `while let Some(sample) = source.next_signals()? { … }`. A sample that comes is sound: a source
/// answers a corrupt one with an error, never with old or made-up numbers. After an error the next
/// call tries the next sample.
///
/// # For implementers
/// `next_signals` shall return every sample once, in the order in which they were taken, and
/// `Ok(None)` only when there will never be another one. Channels are in the unit that the source
/// documents (volts or counts), without tare.
pub trait SignalSource<T: Real, const N: usize>: ErrorType {
    /// The next sample, or `None` at the end.
    ///
    /// # Errors
    /// Whatever keeps the source from giving a sound sample.
    fn next_signals(&mut self) -> Result<Option<Sample<T, SVector<T, N>>>, Self::Error>;
}

/// Gives wrenches, one sample at a time: force/torque sensors and recordings of them.
///
/// The same contract as [`SignalSource`]; the wrench is the load on the fingertip \[N, N·m\] in
/// the sensor frame.
pub trait WrenchSource<T: Real>: ErrorType {
    /// The next sample, or `None` at the end.
    ///
    /// # Errors
    /// Whatever keeps the source from giving a sound sample.
    fn next_wrench(&mut self) -> Result<Option<Sample<T, Wrench<T>>>, Self::Error>;
}

impl<T: Real, const N: usize, S: SignalSource<T, N> + ?Sized> SignalSource<T, N> for &mut S {
    #[inline]
    fn next_signals(&mut self) -> Result<Option<Sample<T, SVector<T, N>>>, Self::Error> {
        (**self).next_signals()
    }
}

impl<T: Real, S: WrenchSource<T> + ?Sized> WrenchSource<T> for &mut S {
    #[inline]
    fn next_wrench(&mut self) -> Result<Option<Sample<T, Wrench<T>>>, Self::Error> {
        (**self).next_wrench()
    }
}
