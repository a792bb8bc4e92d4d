//! How uncertain a calibration is.

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use super::rows;

/// How uncertain the normalised matrix and one reading are.
///
/// Most fits have a covariance that is a Kronecker product: that of entries `(i, j)` and `(k, l)` of the matrix is
/// `signals[i][k] · loads[j][l]` (`docs/theory/calibration.md#least-squares`; the classical result for
/// multi-response regression). Where errors differ from sample to sample, where a drift was fitted too, and where a
/// matrix was mended by touches, it is none: then [`entries`](Self::entries) holds all of it, and a file that has it
/// is of version 2.
///
/// ```
/// use fingertip_calibration::file::Covariance;
/// use fingertip_calibration::nalgebra::{DMatrix, DVector};
///
/// // Two gauges of 1 mV; four nominal loads on each of three axes.
/// let covariance = Covariance::product(
///     DMatrix::from_diagonal_element(2, 2, 1e-6),
///     DMatrix::from_diagonal_element(3, 3, 0.25),
/// );
/// // An entry is known to half a millivolt, and of two entries of one gauge one says nothing of the other.
/// assert!((covariance.between((0, 1), (0, 1)).ok_or("beyond")?.sqrt() - 0.5e-3).abs() < 1e-12);
/// assert_eq!(covariance.between((0, 1), (0, 2)), Some(0.0));
/// // Under twice the nominal load of an axis that is wrong by a millivolt.
/// let of_signals = covariance.of_signals(&DVector::from_vec(vec![2.0, 0.0, 0.0]));
/// assert!((of_signals[(0, 0)].sqrt() - 1e-3).abs() < 1e-12);
/// # Ok::<(), &str>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Covariance {
    /// Covariance of the gauges' residuals, N × N, signal²: that of one reading.
    #[serde(with = "rows")]
    pub signals: DMatrix<f64>,
    /// Inverse of the sum of load·loadᵀ over the calibration, loads in nominal loads; where there are
    /// [`entries`](Self::entries), what makes the product come near to them.
    #[serde(with = "rows")]
    pub loads: DMatrix<f64>,
    /// Covariance of all entries of the normalised matrix, signal², taken row by row: row and column
    /// `i · axes + j` are of entry `(i, j)`, gauge i under the nominal load of axis j. `None` where it is the product.
    #[serde(default, skip_serializing_if = "Option::is_none", with = "rows::optional")]
    pub entries: Option<DMatrix<f64>>,
}

impl Covariance {
    /// A covariance that is a Kronecker product.
    #[must_use]
    pub const fn product(signals: DMatrix<f64>, loads: DMatrix<f64>) -> Self {
        Self { signals, loads, entries: None }
    }

    /// A covariance that is none, of entries row by row, N·axes squared; `loads` is its mean over the gauges, in
    /// units of the mean variance of a reading.
    #[must_use]
    pub fn of_entries(signals: DMatrix<f64>, entries: DMatrix<f64>) -> Self {
        let gauges = signals.nrows();
        let axes = entries.nrows() / gauges.max(1);
        let scale = signals.trace();
        let loads = DMatrix::from_fn(axes, axes, |j, l| {
            let sum: f64 = (0..gauges).map(|i| entries[(i * axes + j, i * axes + l)]).sum();
            if scale > 0.0 { sum / scale } else { 0.0 }
        });
        Self { signals, loads, entries: Some(entries) }
    }

    /// Covariance of two entries of the normalised matrix, each as (gauge, axis) \[signal²\]; `None` beyond the
    /// matrix.
    #[must_use]
    pub fn between(&self, (i, j): (usize, usize), (k, l): (usize, usize)) -> Option<f64> {
        let axes = self.loads.nrows();
        let product = || Some(self.signals.get((i, k))? * self.loads.get((j, l))?);
        match &self.entries {
            Some(_) if j >= axes || l >= axes => None,
            Some(entries) => entries.get((i * axes + j, k * axes + l)).copied(),
            None => product(),
        }
    }

    /// All entries, row by row, whether they are a product or not.
    #[must_use]
    pub fn all(&self) -> DMatrix<f64> {
        self.entries.clone().unwrap_or_else(|| self.signals.kronecker(&self.loads))
    }

    /// Covariance of the signals `C · load` by the error of the matrix C, N × N \[signal²\], of a load in nominal
    /// loads: `Σ_jl load_j load_l cov(C_ij, C_kl)`. It is the same in every reading of that load, so no mean over
    /// readings makes it less. Zeros for a load of the wrong length.
    #[must_use]
    pub fn of_signals(&self, load: &DVector<f64>) -> DMatrix<f64> {
        let (gauges, axes) = (self.signals.nrows(), self.loads.nrows());
        if load.len() != axes {
            return DMatrix::zeros(gauges, gauges);
        }
        match &self.entries {
            None => &self.signals * load.dot(&(&self.loads * load)),
            Some(entries) => DMatrix::from_fn(gauges, gauges, |i, k| {
                let block = entries.view((i * axes, k * axes), (axes, axes));
                load.dot(&(block * load))
            }),
        }
    }
}

/// Covariance of the entries of `C = B⁺`, row by row, from that of the entries of B, row by row, to first order: that of
/// `dC = −C dB C + (1 − C B) dBᵀ CᵀC`, the derivative of the pseudo-inverse of a matrix whose rows are independent (Golub &
/// Pereyra 1973, equation 4.12).
///
/// `inverse` is C, and the covariance of B's size squared.
pub(crate) fn of_pseudo_inverse(
    matrix: &DMatrix<f64>,
    inverse: &DMatrix<f64>,
    covariance: &DMatrix<f64>,
) -> DMatrix<f64> {
    let (rows, columns) = matrix.shape();
    let across = DMatrix::identity(columns, columns) - inverse * matrix;
    let gram = inverse.tr_mul(inverse);
    // Entry (i, j) of C by entry (p, q) of B, both row by row.
    let slope = DMatrix::from_fn(columns * rows, rows * columns, |out, by| {
        let ((i, j), (p, q)) = ((out / rows, out % rows), (by / columns, by % columns));
        across[(i, q)] * gram[(p, j)] - inverse[(i, p)] * inverse[(q, j)]
    });
    &slope * covariance * slope.transpose()
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};
    use rand::SeedableRng as _;
    use rand_pcg::Pcg64Mcg;

    use super::{Covariance, of_pseudo_inverse};
    use crate::fit::testing::gaussian_matrix;
    use crate::linear::pseudo_inverse;
    use crate::testing::Largest as _;

    fn positive(random: &mut Pcg64Mcg, size: usize) -> DMatrix<f64> {
        let root = gaussian_matrix(random, size, size);
        &root * root.transpose()
    }

    /// Against draws of the product itself: Σ load load cov, entry by entry.
    #[test]
    fn a_product_and_its_entries_say_the_same() {
        let random = &mut Pcg64Mcg::seed_from_u64(1);
        let product = Covariance::product(positive(random, 7), positive(random, 6));
        let whole = Covariance::of_entries(product.signals.clone(), product.all());
        assert!((&whole.loads - &product.loads).largest() < 1e-13 * product.loads.amax());
        let load = DVector::from_fn(6, |i, _| 0.3 * i as f64 - 0.7);
        let (a, b) = (product.of_signals(&load), whole.of_signals(&load));
        assert!((&a - &b).largest() < 1e-12 * a.amax());
        let mut sum = 0.0;
        for (j, l) in (0..6).flat_map(|j| (0..6).map(move |l| (j, l))) {
            let plain = product.signals[(2, 5)] * product.loads[(j, l)];
            for either in [&product, &whole] {
                let found = either.between((2, j), (5, l)).unwrap();
                assert!((found - plain).abs() < 1e-13 * plain.abs(), "{found} {plain}");
            }
            sum += load[j] * load[l] * plain;
        }
        assert!((sum - a[(2, 5)]).abs() < 1e-12 * a.amax());
        for either in [&product, &whole] {
            assert_eq!(either.between((7, 0), (0, 0)), None);
            assert_eq!(either.between((0, 6), (0, 0)), None);
            assert_eq!(either.between((0, 0), (0, 6)), None);
            assert_eq!(either.of_signals(&DVector::zeros(5)), DMatrix::zeros(7, 7));
        }
    }

    /// Against small differences of the pseudo-inverse.
    #[test]
    fn errors_of_a_matrix_are_carried_to_its_inverse() {
        let random = &mut Pcg64Mcg::seed_from_u64(2);
        for gauges in [6, 7, 9] {
            let matrix = gaussian_matrix(random, 6, gauges);
            let inverse = pseudo_inverse(&matrix).unwrap();
            for (entry, partner) in [(0, 0), (5, 11), (6 * gauges - 1, 3)] {
                let mut covariance = DMatrix::zeros(6 * gauges, 6 * gauges);
                covariance[(entry, partner)] = 1.0;
                let found = of_pseudo_inverse(&matrix, &inverse, &covariance);
                let slope = |entry: usize| {
                    let step = 1e-6;
                    let moved = |by: f64| {
                        let mut moved = matrix.clone();
                        moved[(entry / gauges, entry % gauges)] += by;
                        pseudo_inverse(&moved).unwrap()
                    };
                    let slope = (moved(step) - moved(-step)) / (2.0 * step);
                    DVector::from_iterator(6 * gauges, slope.transpose().iter().copied())
                };
                let expected = slope(entry) * slope(partner).transpose();
                assert!((found - &expected).largest() < 1e-6 * expected.amax(), "{gauges} {entry}");
            }
        }
    }
}
