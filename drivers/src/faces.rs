//! The other ways to wait: not at all, and in a task.
//!
//! [`WrenchSource`](crate::WrenchSource) blocks. The traits here are the same contract for a control
//! loop that must not wait, and for an asynchronous executor. A device implements those that its
//! transport allows, over one core that does no I/O.

use fingertip_wrench::{Real, Wrench};
use nalgebra::SVector;

use crate::{ErrorType, Sample};

/// Gives wrenches without waiting.
///
/// # For users
/// `nb::Error::WouldBlock` means that no sample has come since the last call. Nothing else is lost
/// by asking often.
///
/// # For implementers
/// The contract of [`WrenchSource`](crate::WrenchSource), except that a call shall return at once.
pub trait NbWrenchSource<T: Real>: ErrorType {
    /// The next sample that is there already, or `None` at the end.
    ///
    /// # Errors
    /// `WouldBlock` if none is there yet; otherwise whatever keeps the source from giving one.
    fn poll_wrench(&mut self) -> nb::Result<Option<Sample<T, Wrench<T>>>, Self::Error>;
}

/// Gives the raw signals of `N` channels without waiting: see [`NbWrenchSource`].
pub trait NbSignalSource<T: Real, const N: usize>: ErrorType {
    /// The next sample that is there already, or `None` at the end.
    ///
    /// # Errors
    /// `WouldBlock` if none is there yet; otherwise whatever keeps the source from giving one.
    fn poll_signals(&mut self) -> nb::Result<Option<Sample<T, SVector<T, N>>>, Self::Error>;
}

/// Gives wrenches in a task.
///
/// # For implementers
/// The contract of [`WrenchSource`](crate::WrenchSource). A call that is dropped before it is done
/// shall lose no sample that a later call could give.
#[allow(async_fn_in_trait, reason = "as in embedded-hal-async: executors of microcontrollers need no Send")]
pub trait AsyncWrenchSource<T: Real>: ErrorType {
    /// The next sample, or `None` at the end.
    ///
    /// # Errors
    /// Whatever keeps the source from giving a sound sample.
    async fn next_wrench(&mut self) -> Result<Option<Sample<T, Wrench<T>>>, Self::Error>;
}

/// Gives the raw signals of `N` channels in a task: see [`AsyncWrenchSource`].
#[allow(async_fn_in_trait, reason = "as in embedded-hal-async: executors of microcontrollers need no Send")]
pub trait AsyncSignalSource<T: Real, const N: usize>: ErrorType {
    /// The next sample, or `None` at the end.
    ///
    /// # Errors
    /// Whatever keeps the source from giving a sound sample.
    async fn next_signals(&mut self) -> Result<Option<Sample<T, SVector<T, N>>>, Self::Error>;
}

impl<T: Real, S: NbWrenchSource<T> + ?Sized> NbWrenchSource<T> for &mut S {
    #[inline]
    fn poll_wrench(&mut self) -> nb::Result<Option<Sample<T, Wrench<T>>>, Self::Error> {
        (**self).poll_wrench()
    }
}

impl<T: Real, const N: usize, S: NbSignalSource<T, N> + ?Sized> NbSignalSource<T, N> for &mut S {
    #[inline]
    fn poll_signals(&mut self) -> nb::Result<Option<Sample<T, SVector<T, N>>>, Self::Error> {
        (**self).poll_signals()
    }
}

impl<T: Real, S: AsyncWrenchSource<T> + ?Sized> AsyncWrenchSource<T> for &mut S {
    #[inline]
    async fn next_wrench(&mut self) -> Result<Option<Sample<T, Wrench<T>>>, Self::Error> {
        (**self).next_wrench().await
    }
}

impl<T: Real, const N: usize, S: AsyncSignalSource<T, N> + ?Sized> AsyncSignalSource<T, N> for &mut S {
    #[inline]
    async fn next_signals(&mut self) -> Result<Option<Sample<T, SVector<T, N>>>, Self::Error> {
        (**self).next_signals().await
    }
}
