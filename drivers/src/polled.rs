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
