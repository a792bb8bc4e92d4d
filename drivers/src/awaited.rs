//! Sources for a task of an asynchronous executor.

use fingertip_wrench::{Real, Wrench};
use nalgebra::SVector;

use crate::{ErrorType, Sample};

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
