//! Where the readings of a calibration lay.

use fingertip_wrench::{CalibratedRegion, Real};
use nalgebra::{DMatrix, DVector, SMatrix, SVector};
use serde::{Deserialize, Serialize};

use crate::file::{FileError, rows};

/// Where the signals of a calibration lay, as it is kept in a file: see
/// [`CalibratedRegion`], which tells of one reading how far it is from there.
///
/// Distances are Mahalanobis's, by the covariance of the signals, in which a direction that was hardly used counts as a
/// thirtieth of the most used one.
///
/// ```
/// use fingertip_calibration::curve::Region;
/// use fingertip_calibration::nalgebra::DMatrix;
///
/// let signals = DMatrix::from_row_slice(4, 2, &[2.0, 0.0, -2.0, 0.0, 0.0, 1.0, 0.0, -1.0]);
/// let region = Region::of(&signals).unwrap();
/// assert!((region.distance(&[2.0, 0.0]) - 1.0).abs() < 1e-12);
/// assert!((region.distance(&[4.0, 0.0]) - 2.0).abs() < 1e-12);
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Region {
    /// The mean of the signals.
    pub centre: Vec<f64>,
    /// What makes distances of signals \[1/signal\]: one row and one column for each gauge.
    #[serde(with = "rows")]
    pub whitening: DMatrix<f64>,
}

/// Eigenvalues of the correlations below this share of the greatest are taken for it.
const LEAST_SHARE: f64 = 1e-3;

impl Region {
    /// Of signals, samples × gauges, at least one of which is not the mean of all. `None` if none is, or if one is not
    /// finite.
    #[must_use]
    pub fn of(signals: &DMatrix<f64>) -> Option<Self> {
        let samples = signals.nrows() as f64;
        let centre = signals.row_mean().transpose();
        let mut away = signals.clone();
        away.row_iter_mut().for_each(|mut row| row -= centre.transpose());
        // A gauge that never changes has no size of its own.
        let sizes: Vec<f64> = away.column_iter().map(|column| column.norm() / samples.sqrt()).collect();
        let greatest = sizes.iter().copied().fold(0.0, f64::max);
        if !(greatest > 0.0 && sizes.iter().sum::<f64>().is_finite()) {
            return None;
        }
        let sizes: Vec<f64> = sizes.iter().map(|size| if *size > 0.0 { *size } else { greatest }).collect();
        away.column_iter_mut().zip(&sizes).for_each(|(mut column, size)| column /= *size);
        let eigen = (away.tr_mul(&away) / samples).symmetric_eigen();
        let least = LEAST_SHARE * eigen.eigenvalues.max();
        let mut whitening = eigen.eigenvectors.transpose();
        for (mut row, value) in whitening.row_iter_mut().zip(&eigen.eigenvalues) {
            row /= value.max(least).sqrt();
        }
        let farthest = (&away * whitening.transpose()).row_iter().map(|row| row.norm()).fold(0.0, f64::max);
        for (mut column, size) in whitening.column_iter_mut().zip(&sizes) {
            column /= farthest * *size;
        }
        whitening
            .iter()
            .all(|x| x.is_finite())
            .then(|| Self { centre: centre.as_slice().to_vec(), whitening })
    }

    /// How far signals are from the centre; 1 is as far as the farthest of the calibration. NaN for signals of another
    /// number of gauges.
    #[must_use]
    pub fn distance(&self, signals: &[f64]) -> f64 {
        if signals.len() != self.centre.len() || self.whitening.ncols() != signals.len() {
            return f64::NAN;
        }
        let away = DVector::from_fn(signals.len(), |i, _| signals[i] - self.centre[i]);
        (&self.whitening * away).norm()
    }

    /// In scalar type `T`, for the hot path.
    ///
    /// # Errors
    /// [`FileError::WrongGauges`] if it is not of `N` gauges, [`FileError::NotFinite`] if a number is none in that type.
    pub fn in_type<T: Real, const N: usize>(&self) -> Result<CalibratedRegion<T, N>, FileError> {
        if self.centre.len() != N || self.whitening.shape() != (N, N) {
            return Err(FileError::WrongGauges { found: self.centre.len(), expected: N });
        }
        let centre = SVector::from_fn(|i, _| T::literal(self.centre[i]));
        let whitening = SMatrix::from_fn(|i, j| T::literal(self.whitening[(i, j)]));
        CalibratedRegion::new(centre, whitening)
            .map_err(|_| FileError::NotFinite { field: "region".to_owned() })
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, SVector};
    use rand::SeedableRng as _;

    use super::Region;
    use crate::fit::testing::{gaussian_matrix, sensor};

    #[test]
    fn the_farthest_is_at_one_whatever_the_units_and_the_cross_talk() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(19);
        for unit in [1e-9, 1.0, 1e12] {
            let signals = gaussian_matrix(&mut random, 200, 6) * sensor(&mut random, 6, 7) * unit
                + gaussian_matrix(&mut random, 200, 7) * (1e-3 * unit);
            let region = Region::of(&signals).unwrap();
            let row = |i: usize| signals.row(i).iter().copied().collect::<Vec<f64>>();
            let farthest = (0..200).map(|i| region.distance(&row(i))).fold(0.0, f64::max);
            assert!((farthest - 1.0).abs() < 1e-9, "{farthest}");
            assert!(region.distance(&region.centre) < 1e-9);
            let typed = region.in_type::<f64, 7>().unwrap();
            for i in 0..200 {
                let by_type = typed.distance(&SVector::from_iterator(row(i)));
                assert!((by_type - region.distance(&row(i))).abs() < 1e-9);
            }
            assert!(region.in_type::<f64, 6>().is_err());
        }
    }

    /// Mahalanobis's, by the inverse of the covariance: along what gauges have in common a signal is less far than across it.
    #[test]
    fn distances_go_by_the_covariance() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(29);
        let mixed = DMatrix::from_row_slice(3, 3, &[1.0, 0.9, 0.5, 0.0, 0.3, 0.2, 0.0, 0.0, 0.4]);
        let signals = gaussian_matrix(&mut random, 300, 3) * mixed;
        let region = Region::of(&signals).unwrap();
        let centre = signals.row_mean();
        let mut away = signals.clone();
        away.row_iter_mut().for_each(|mut row| row -= &centre);
        let inverse = (away.tr_mul(&away) / 300.0).try_inverse().unwrap();
        let expected = |i: usize| (away.row(i) * &inverse * away.row(i).transpose())[(0, 0)].sqrt();
        let farthest = (0..300).map(expected).fold(0.0, f64::max);
        for i in 0..300 {
            let found = region.distance(&signals.row(i).iter().copied().collect::<Vec<_>>());
            assert!((found - expected(i) / farthest).abs() < 1e-9, "{found} {}", expected(i) / farthest);
        }
    }

    /// Of gauges that read in units of their own, each counts by its own size.
    #[test]
    fn the_unit_of_a_single_gauge_is_nothing() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(23);
        let signals = gaussian_matrix(&mut random, 100, 6) * sensor(&mut random, 6, 6);
        let mut others = signals.clone();
        let units = [1.0, 1e-8, 1e6, 1.0, 1e-3, 1e9];
        others.column_iter_mut().zip(units).for_each(|(mut column, unit)| column *= unit);
        let (region, of_others) = (Region::of(&signals).unwrap(), Region::of(&others).unwrap());
        for i in 0..100 {
            let row = |table: &DMatrix<f64>| table.row(i).iter().map(|x| 0.5 * x).collect::<Vec<f64>>();
            let (distance, other) = (region.distance(&row(&signals)), of_others.distance(&row(&others)));
            assert!((distance - other).abs() < 1e-9, "{distance} {other}");
        }
    }

    /// Seven gauges of a sensor of six components: what no load does, noise and drift do, and is not refused for it.
    #[test]
    fn a_direction_that_no_load_uses_is_not_narrow() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(20);
        let matrix = sensor(&mut random, 6, 7);
        let signals = gaussian_matrix(&mut random, 200, 6) * &matrix;
        let region = Region::of(&signals).unwrap();
        let unused = crate::linear::Singular::new(&matrix.clone().insert_row(6, 0.0)).unwrap();
        let direction = unused.right.column(6);
        assert!((&matrix * direction).amax() < 1e-9);
        // A twentieth of the typical signal.
        let drift: Vec<f64> = direction.iter().map(|x| 0.05 * x).collect();
        assert!(region.distance(&drift) < 0.8, "{}", region.distance(&drift));
    }

    #[test]
    fn nothing_is_no_region() {
        assert_eq!(Region::of(&DMatrix::zeros(5, 6)), None);
        assert_eq!(Region::of(&DMatrix::from_element(5, 6, f64::NAN)), None);
        assert_eq!(Region::of(&DMatrix::from_element(5, 6, f64::MAX)), None);
        let mut one_dead = DMatrix::from_fn(5, 2, |i, _| i as f64);
        one_dead.column_mut(1).fill(3.0);
        let region = Region::of(&one_dead).unwrap();
        assert!((region.distance(&[4.0, 3.0]) - 1.0).abs() < 1e-12);
        assert!(region.distance(&[1.0]).is_nan());
    }
}
