//! Whether a reading lies where the sensor was calibrated.

use nalgebra::{SMatrix, SVector, Vector6};
use thiserror::Error;

use crate::{Real, Wrench, WrenchSolver};

/// Where the readings of a calibration lay: an ellipsoid in the space of signals, at the surface of which the farthest of
/// them is.
///
/// A sensor that is fitted by more than a matrix means little beyond. The distance of a reading is Mahalanobis's,
/// `‖W (s − m)‖`, with `m` the mean of the calibration's signals and `WᵀW` the inverse of their covariance, scaled so
/// that the farthest of them has the distance 1 (`docs/theory/calibration.md#curved-sensors`).
///
/// ```
/// use fingertip_wrench::CalibratedRegion;
/// use nalgebra::{SMatrix, SVector};
///
/// // Signals within 2 V of zero.
/// let region = CalibratedRegion::new(SVector::zeros(), SMatrix::<f64, 6, 6>::from_diagonal_element(0.5))?;
/// let signals = SVector::from([2.4, 0.0, 0.0, 0.0, 0.0, 0.0]);
/// assert_eq!(region.distance(&signals), 1.2);
/// assert!(region.holds(&signals));
/// assert!(!region.holds(&(signals * 1.1)));
/// # Ok::<(), fingertip_wrench::BadRegion>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CalibratedRegion<T: Real, const N: usize> {
    centre: SVector<T, N>,
    whitening: SMatrix<T, N, N>,
}

/// A region whose numbers are none.
///
/// ```
/// use fingertip_wrench::CalibratedRegion;
/// use nalgebra::{SMatrix, SVector};
///
/// let whitening = SMatrix::<f64, 6, 6>::from_diagonal_element(f64::NAN);
/// let refused = CalibratedRegion::new(SVector::zeros(), whitening).unwrap_err();
/// assert_eq!(refused.to_string(), "a number of the region that was calibrated is not finite");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("a number of the region that was calibrated is not finite")]
pub struct BadRegion;

impl<T: Real, const N: usize> CalibratedRegion<T, N> {
    /// Beyond this distance a reading is taken for too far to be believed: a fifth more than the farthest reading of the
    /// calibration.
    pub const GREATEST: f64 = 1.2;

    /// From its centre, in signals, and the matrix that makes distances of signals, in 1/signal.
    ///
    /// # Errors
    /// [`BadRegion`].
    pub fn new(centre: SVector<T, N>, whitening: SMatrix<T, N, N>) -> Result<Self, BadRegion> {
        let sound = centre.iter().chain(&whitening).all(|x| x.is_number());
        if sound { Ok(Self { centre, whitening }) } else { Err(BadRegion) }
    }

    /// How far signals are from the centre; 1 is as far as the farthest of the calibration. NaN or infinite for signals that
    /// are not finite.
    #[inline]
    #[must_use]
    pub fn distance(&self, signals: &SVector<T, N>) -> T {
        (self.whitening * (signals - self.centre)).norm_squared().root()
    }

    /// Whether signals are near enough to those of the calibration: within [`GREATEST`](Self::GREATEST). `false` for signals
    /// that are not finite.
    #[inline]
    #[must_use]
    pub fn holds(&self, signals: &SVector<T, N>) -> bool {
        self.distance(signals) <= T::literal(Self::GREATEST)
    }
}

/// A solver that is believed within a region alone: beyond it the wrench is not finite, which every contact model answers
/// with its own reason.
///
/// ```
/// use fingertip_wrench::{CalibratedRegion, CurvedInverse, ProductTerm, WithinRegion, WrenchSolver};
/// use nalgebra::{SMatrix, Vector6};
///
/// let squares = [ProductTerm::of_two(0, 0, Vector6::x() * 0.1)];
/// let sensor = CurvedInverse::new(SMatrix::<f64, 6, 6>::identity(), squares)?;
/// let region = CalibratedRegion::new(Vector6::zeros(), SMatrix::identity())?;
/// let believed = WithinRegion::new(sensor, region);
/// assert_eq!(believed.solve(&Vector6::x()).force().x, 1.1);
/// assert!(!believed.solve(&(Vector6::x() * 1.3)).is_finite());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WithinRegion<S, T: Real, const N: usize> {
    solver: S,
    region: CalibratedRegion<T, N>,
}

impl<S, T: Real, const N: usize> WithinRegion<S, T, N> {
    /// Of a solver, and the region within which it is believed.
    pub const fn new(solver: S, region: CalibratedRegion<T, N>) -> Self {
        Self { solver, region }
    }

    /// The solver by itself.
    pub const fn solver(&self) -> &S {
        &self.solver
    }

    /// Where it is believed.
    #[must_use]
    pub const fn region(&self) -> &CalibratedRegion<T, N> {
        &self.region
    }
}

impl<S: WrenchSolver<T, N>, T: Real, const N: usize> WrenchSolver<T, N> for WithinRegion<S, T, N> {
    #[inline]
    fn solve(&self, signals: &SVector<T, N>) -> Wrench<T> {
        if self.region.holds(signals) {
            self.solver.solve(signals)
        } else {
            Wrench::from_components(&Vector6::repeat(T::zero() / T::zero()))
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{SMatrix, SVector, Vector2, Vector6};

    use super::{BadRegion, CalibratedRegion};
    use crate::Real;

    fn in_type<T: Real>() {
        // Half as long along the diagonal as across it.
        let whitening = SMatrix::<T, 2, 2>::new(T::literal(2.0), T::literal(2.0), T::literal(-1.0), T::one());
        let centre = Vector2::new(T::literal(3.0), T::literal(-1.0));
        let region = CalibratedRegion::new(centre, whitening).unwrap();
        for (away, distance) in
            [([1.0, 0.0], 5.0_f64.sqrt()), ([1.0, 1.0], 4.0), ([1.0, -1.0], 2.0), ([0.0, 0.0], 0.0)]
        {
            let found = region.distance(&(centre + Vector2::from(away.map(T::literal))));
            assert!((found.to_f64() - distance).abs() < 1e-6, "{away:?}: {found}");
        }
        let along = |share: f64| centre + Vector2::new(T::literal(share * 0.5), T::literal(-share * 0.5));
        assert!(region.holds(&along(1.19)) && !region.holds(&along(1.21)));
    }

    #[test]
    fn distances_are_those_of_the_whitened_signals() {
        in_type::<f64>();
        in_type::<f32>();
    }

    #[test]
    fn what_is_not_finite_is_held_by_none() {
        let region = CalibratedRegion::new(SVector::zeros(), SMatrix::<f64, 6, 6>::identity()).unwrap();
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, 1e300] {
            assert!(!region.holds(&Vector6::repeat(bad)), "{bad}");
            assert!(!region.holds(&(Vector6::x() * bad)), "{bad}");
        }
        assert!(region.holds(&Vector6::repeat(1e-320)));
        for bad in [f64::NAN, f64::INFINITY] {
            assert_eq!(CalibratedRegion::new(Vector6::repeat(bad), SMatrix::identity()), Err(BadRegion));
            assert_eq!(
                CalibratedRegion::new(Vector6::zeros(), SMatrix::<_, 6, 6>::repeat(bad)),
                Err(BadRegion)
            );
        }
    }
}
