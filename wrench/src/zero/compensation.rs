//! What is taken off readings and wrenches since it is no load of a contact.

use crate::Real;
use nalgebra::SVector;

/// Takes off what is not load: of the readings of `N` gauges zero and drift, which leaves signals
/// (`V` is an `SVector<T, N>`); of a wrench what hangs on the sensor all the time, which leaves contact (`V` is a
/// [`Wrench`](crate::Wrench)).
///
/// The raw reading is a type of its own, since some compensations take more than what they correct: a
/// dummy gauge, a temperature, the motion of the sensor.
///
/// ```
/// use fingertip_wrench::Compensation;
/// use nalgebra::Vector6;
///
/// /// Readings that grow with the supply of the bridges, which is read beside them.
/// struct Ratiometric {
///     nominal: f64,
/// }
/// impl Compensation<Vector6<f64>> for Ratiometric {
///     type Raw = (Vector6<f64>, f64);
///
///     fn compensate(&self, (readings, supply): &Self::Raw) -> Vector6<f64> {
///         readings * (self.nominal / supply)
///     }
/// }
/// let signals = Ratiometric { nominal: 5.0 }.compensate(&(Vector6::repeat(0.4), 4.0));
/// assert_eq!(signals, Vector6::repeat(0.5));
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` takes nothing off `{V}`",
    note = "a zero is for as many signals as the solver takes: give a `Tare` or a `DummyGauge` of them to `.zero(…)`"
)]
pub trait Compensation<V> {
    /// One raw reading.
    type Raw;

    /// What is left of one raw reading.
    fn compensate(&self, raw: &Self::Raw) -> V;
}

/// Readings that are signals already. Costs nothing.
///
/// ```
/// use fingertip_wrench::{Compensation, Uncompensated};
/// use nalgebra::Vector6;
///
/// let signals = Vector6::new(0.1, 0.2, 0.3, 0.4, 0.5, 0.6);
/// assert_eq!(Uncompensated.compensate(&signals), signals);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Uncompensated;

impl<T: Real, const N: usize> Compensation<SVector<T, N>> for Uncompensated {
    type Raw = SVector<T, N>;

    #[inline]
    fn compensate(&self, raw: &SVector<T, N>) -> SVector<T, N> {
        *raw
    }
}
