//! Sources for a control loop that must not wait.
//!
//! The contract is that of [`WrenchSource`](crate::WrenchSource) and [`SignalSource`](crate::SignalSource). A
//! device implements these traits if its transport allows it, over the same core, which does no I/O.

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
