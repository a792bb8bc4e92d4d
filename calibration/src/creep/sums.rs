//! Sums of products over some samples, from which shares of creep and what they leave follow.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// Of some samples: what loads explain (the columns of `x`), and for each gauge its signals and their averages.
#[derive(Clone)]
pub(super) struct Sums {
    /// `xᵀ x`
    loads: DMatrix<f64>,
    /// For each gauge `xᵀ z`, where `z` are the signal and its averages in columns.
    mixed: Vec<DMatrix<f64>>,
    /// For each gauge `zᵀ z`.
    own: Vec<DMatrix<f64>>,
}

/// What is found for one gauge.
pub(super) struct Shares {
    /// One for each average.
    pub(super) shares: DVector<f64>,
    /// What a unit of each column of the loads adds to the signal without creep.
    pub(super) sensitivities: DVector<f64>,
    /// Sum of the squares that are left.
    pub(super) left: f64,
    /// Variances of the shares, for residuals of variance 1.
    pub(super) variances: DVector<f64>,
}

impl Sums {
    /// Of columns that have no mean in any of the parts that have a zero of their own.
    pub(super) fn of(x: &DMatrix<f64>, signals: &DMatrix<f64>, averages: &[DMatrix<f64>]) -> Self {
        let gauges = 0..signals.ncols();
        let z = |gauge: usize| {
            let columns: Vec<DVector<f64>> = core::iter::once(signals)
                .chain(averages)
                .map(|matrix| matrix.column(gauge).into_owned())
                .collect();
            DMatrix::from_columns(&columns)
        };
        let columns: Vec<DMatrix<f64>> = gauges.map(z).collect();
        Self {
            loads: x.tr_mul(x),
            mixed: columns.iter().map(|z| x.tr_mul(z)).collect(),
            own: columns.iter().map(|z| z.tr_mul(z)).collect(),
        }
    }

    fn combined(&self, other: &Self, sign: f64) -> Self {
        let each =
            |a: &[DMatrix<f64>], b: &[DMatrix<f64>]| a.iter().zip(b).map(|(a, b)| a + b * sign).collect();
        Self {
            loads: &self.loads + &other.loads * sign,
            mixed: each(&self.mixed, &other.mixed),
            own: each(&self.own, &other.own),
        }
    }

    /// Of the samples of both.
    pub(super) fn with(&self, other: &Self) -> Self {
        self.combined(other, 1.0)
    }

    /// Of those samples that are not among the others.
    pub(super) fn without(&self, other: &Self) -> Self {
        self.combined(other, -1.0)
    }

    /// The shares of each gauge by least squares; `None` if they are not determined.
    pub(super) fn shares(&self) -> Option<Vec<Shares>> {
        let inverse = pseudo_inverse(&self.loads);
        let of_gauge = |(mixed, own): (&DMatrix<f64>, &DMatrix<f64>)| {
            let explained = &inverse * mixed;
            // What the loads leave of signal and averages.
            let left = own - mixed.tr_mul(&explained);
            let averages = left.nrows() - 1;
            let gram = left.view((1, 1), (averages, averages)).into_owned();
            let with_signal = left.view((1, 0), (averages, 1)).column(0).into_owned();
            let (shares, variances) = if averages == 0 {
                (DVector::zeros(0), DVector::zeros(0))
            } else {
                let factors = gram.cholesky()?;
                (factors.solve(&with_signal), factors.inverse().diagonal())
            };
            let mut of_columns = explained.column(0).into_owned();
            for (average, share) in shares.iter().enumerate() {
                of_columns -= explained.column(average + 1) * *share;
            }
            let squares = (left[(0, 0)] - with_signal.dot(&shares)).max(0.0);
            Some(Shares { shares, sensitivities: of_columns, left: squares, variances })
        };
        self.mixed.iter().zip(&self.own).map(of_gauge).collect()
    }

    /// Sum of the squares that shares found elsewhere leave here, gauge by gauge.
    pub(super) fn left_by(&self, found: &[Shares]) -> Vec<f64> {
        let of_gauge = |(found, (mixed, own)): (&Shares, (&DMatrix<f64>, &DMatrix<f64>))| {
            // Of `signal − averages · shares`, a combination of the columns of z.
            let mut combination = DVector::zeros(own.nrows());
            combination[0] = 1.0;
            combination.rows_mut(1, found.shares.len()).copy_from(&-&found.shares);
            let predicted = &found.sensitivities;
            let squares = combination.dot(&(own * &combination))
                - 2.0 * predicted.dot(&(mixed * &combination))
                + predicted.dot(&(&self.loads * predicted));
            squares.max(0.0)
        };
        found.iter().zip(self.mixed.iter().zip(&self.own)).map(of_gauge).collect()
    }
}

/// Of a symmetric matrix that may lack some directions.
fn pseudo_inverse(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    let SymmetricEigen { eigenvectors, eigenvalues } = SymmetricEigen::new(matrix.clone());
    let least = 1e-12 * eigenvalues.amax();
    let inverse = eigenvalues.map(|value| if value > least { value.recip() } else { 0.0 });
    &eigenvectors * DMatrix::from_diagonal(&inverse) * eigenvectors.transpose()
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;
    use rand::SeedableRng as _;

    use super::Sums;
    use crate::fit::testing::gaussian_matrix;

    #[test]
    fn sums_of_parts_are_those_of_the_whole() {
        let random = &mut rand_pcg::Pcg64Mcg::seed_from_u64(1);
        let [x, signals, averages] = [2, 3, 3].map(|columns| gaussian_matrix(random, 12, columns));
        let of = |first: usize, count: usize| {
            let rows = |matrix: &DMatrix<f64>| matrix.rows(first, count).into_owned();
            Sums::of(&rows(&x), &rows(&signals), &[rows(&averages)])
        };
        let shares = |sums: &Sums| -> Vec<f64> {
            sums.shares().unwrap().iter().flat_map(|found| [found.shares[0], found.left]).collect()
        };
        let (whole, first, second) = (of(0, 12), of(0, 5), of(5, 7));
        for (found, expected) in [(whole.without(&first), &second), (first.with(&second), &whole)] {
            let pairs = shares(&found).into_iter().zip(shares(expected));
            pairs.for_each(|(found, expected)| {
                assert!((found - expected).abs() < 1e-12, "{found} {expected}")
            });
        }
    }
}
