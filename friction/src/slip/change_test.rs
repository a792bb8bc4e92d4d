//! What a detector does with the evidence of slip.

use fingertip_wrench::Real;

use super::followed_lines::State;

/// A test for a change of the mean, from zero, of a sequence of unit variance.
pub(crate) trait ChangeTest<T: Real> {
    /// What it takes of a sample.
    type Evidence: Copy;
    /// What a sample says that repeats the one before.
    const NOTHING: fn() -> Self::Evidence;

    /// What the standardised innovations of the ratio and of the force say.
    fn evidence(state: &mut State<T>, innovations: &(T, T)) -> Self::Evidence;

    /// Takes one sample, unless it is NaN, and tells whether the mean has grown.
    fn take(&mut self, evidence: Self::Evidence) -> bool;

    /// Starts anew, as after an alarm, a gap, or at a new contact. What it knows of the noise may stay.
    fn restart(&mut self);
}

/// For a test of the fall alone that [`RatioTracker`](super::ratio_tracker::RatioTracker) has standardised.
macro_rules! test_of_falls {
    ($test:ty, [$($parameters:tt)*]) => {
        impl<$($parameters)*> ChangeTest<T> for $test {
            type Evidence = T;
            const NOTHING: fn() -> T = T::zero;

            #[inline(always)]
            fn evidence(state: &mut State<T>, innovations: &(T, T)) -> T {
                state.fall(innovations)
            }

            #[inline]
            fn take(&mut self, fall: T) -> bool {
                self.add(fall)
            }

            #[inline]
            fn restart(&mut self) {
                self.reset();
            }
        }
    };
}
pub(super) use test_of_falls;
