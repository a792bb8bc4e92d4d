//! What a detector does with the evidence of slip.

/// A test for a change of the mean, from zero, of a sequence of unit variance.
pub(crate) trait ChangeTest<T> {
    /// Takes one sample, unless it is NaN, and tells whether the mean has grown.
    fn add(&mut self, sample: T) -> bool;

    /// Forgets all samples.
    fn reset(&mut self);
}
