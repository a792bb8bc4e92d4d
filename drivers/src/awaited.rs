//! Sources for a task of an asynchronous executor.

use crate::{Sample, SourceError};

/// Gives samples of `V` (a [`Wrench`](fingertip_wrench::Wrench), or the raw signals of `N` channels) in a task.
///
/// # For implementers
/// The contract of [`Source`](crate::Source). A call that is
/// dropped before it is done shall lose no sample that a later call could give.
#[allow(async_fn_in_trait, reason = "as in embedded-hal-async: executors of microcontrollers need no Send")]
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
