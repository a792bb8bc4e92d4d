//! What is taken off the readings before they are signals.

use nalgebra::SVector;

use crate::Real;

/// Turns raw readings into the signals of `N` gauges: takes off what is not load.
///
/// The raw reading is a type of its own, since some compensations take more than the gauges (a
/// dummy gauge, a temperature).
pub trait Compensation<T: Real, const N: usize> {
    /// One raw reading.
    type Raw;

    /// The signals of the gauges, from one raw reading.
    fn compensate(&self, raw: &Self::Raw) -> SVector<T, N>;
}

/// Readings that are signals already. Costs nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Uncompensated;

impl<T: Real, const N: usize> Compensation<T, N> for Uncompensated {
    type Raw = SVector<T, N>;

    #[inline]
    fn compensate(&self, raw: &SVector<T, N>) -> SVector<T, N> {
        *raw
    }
}
