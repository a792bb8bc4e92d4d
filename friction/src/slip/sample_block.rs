//! Samples that wait until they span enough time.

use fingertip_wrench::Real;

/// Samples not yet taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Block<T> {
    pub(super) normal: T,
    pub(super) tangential: T,
    /// How many different ones.
    pub(super) count: T,
    /// Time since the last taken, that of unusable samples included \[s\].
    pub(super) elapsed: T,
}

impl<T: Real> Block<T> {
    pub(super) fn empty() -> Self {
        Self { normal: T::zero(), tangential: T::zero(), count: T::zero(), elapsed: T::zero() }
    }

    /// No sample waits, and no time: what waits has taken time.
    #[inline]
    pub(super) fn is_empty(&self) -> bool {
        self.elapsed <= T::zero()
    }
}
