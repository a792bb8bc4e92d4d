//! Which candidates explain most, one after another.

use nalgebra::{DMatrix, DVector};

/// Rows that a choice is made by, and rows that it is tried on.
pub(super) struct Split {
    pub(super) known: Rows,
    pub(super) tried: Rows,
}

/// Regressors that are always there, candidates and responses, row by row.
pub(super) struct Rows {
    pub(super) base: DMatrix<f64>,
    pub(super) candidates: DMatrix<f64>,
    pub(super) responses: DMatrix<f64>,
}

impl Rows {
    pub(super) fn select(&self, rows: &[usize]) -> Self {
        Self {
            base: self.base.select_rows(rows),
            candidates: self.candidates.select_rows(rows),
            responses: self.responses.select_rows(rows),
        }
    }

    /// Takes off what a direction of unit length among the known rows explains: `shares` of it in the candidates and in
    /// the responses.
    fn take_off(&mut self, direction: &DVector<f64>, shares: &Shares) {
        self.candidates.ger(-1.0, direction, &shares.candidates, 1.0);
        self.responses.ger(-1.0, direction, &shares.responses, 1.0);
    }
}

/// How much of a direction is in each column.
struct Shares {
    candidates: DVector<f64>,
    responses: DVector<f64>,
}

/// What a choice came to: the candidates in the order in which they were taken, and the sum of squares of what is left
/// of the responses in the rows that were tried, with none, one, two … of them.
pub(super) struct Taken {
    pub(super) order: Vec<usize>,
    pub(super) left: Vec<f64>,
}

/// A column of which less than this is not explained by those taken before, is.
const LEAST_NEW: f64 = 1e-4;

/// Forward selection by orthogonal least squares (Chen, Billings & Luo 1989; for several responses Chen, Cowan & Grant
/// 1991): at each step the candidate is taken that leaves the least sum of squares of all responses, up to `most`.
///
/// The rows that are tried take part in no decision and in no sum; what the steps would predict of them is taken off
/// alike, so that [`Taken::left`] is the error of a least-squares fit to the known rows. `None` if the regressors that
/// are always there are dependent.
pub(super) fn forward(mut split: Split, most: usize) -> Option<Taken> {
    let of_all: Vec<f64> = split.known.candidates.column_iter().map(|column| column.norm_squared()).collect();
    for column in 0..split.known.base.ncols() {
        let mut known = split.known.base.column(column).into_owned();
        let mut tried = split.tried.base.column(column).into_owned();
        let size = known.norm();
        // Those before are orthonormal already; twice is enough (Kahan and Parlett, in Parlett 1980).
        for _ in 0..2 {
            let shares = split.known.base.columns(0, column).tr_mul(&known);
            known -= split.known.base.columns(0, column) * &shares;
            tried -= split.tried.base.columns(0, column) * &shares;
        }
        let left = known.norm();
        if !(left > LEAST_NEW * LEAST_NEW * size) {
            return None;
        }
        known /= left;
        tried /= left;
        split.explain(&known, &tried);
        split.known.base.set_column(column, &known);
        split.tried.base.set_column(column, &tried);
    }
    let mut taken = Taken { order: Vec::new(), left: vec![split.tried.responses.norm_squared()] };
    // Kept up to date from step to step: what is left of each candidate, and how much of it is in the responses.
    let mut sizes: Vec<f64> =
        split.known.candidates.column_iter().map(|column| column.norm_squared()).collect();
    let mut projected = split.known.candidates.tr_mul(&split.known.responses);
    while taken.order.len() < most {
        let gain = |candidate: usize| {
            let is_new = sizes[candidate] > LEAST_NEW * LEAST_NEW * of_all[candidate];
            is_new.then(|| (projected.row(candidate).norm_squared() / sizes[candidate], candidate))
        };
        let best = (0..split.known.candidates.ncols())
            .filter(|candidate| !taken.order.contains(candidate))
            .filter_map(gain)
            .max_by(|a, b| a.0.total_cmp(&b.0));
        let Some((_, candidate)) = best else { break };
        let size = split.known.candidates.column(candidate).norm();
        let known = split.known.candidates.column(candidate) / size;
        let tried = split.tried.candidates.column(candidate) / size;
        let shares = split.explain(&known, &tried);
        projected.ger(-1.0, &shares.candidates, &shares.responses, 1.0);
        sizes.iter_mut().zip(&shares.candidates).for_each(|(size, share)| *size -= share * share);
        taken.order.push(candidate);
        taken.left.push(split.tried.responses.norm_squared());
    }
    Some(taken)
}

impl Split {
    /// Takes off what a direction explains: of unit length among the known rows, and what it is in those tried.
    fn explain(&mut self, known: &DVector<f64>, tried: &DVector<f64>) -> Shares {
        let shares = Shares {
            candidates: self.known.candidates.tr_mul(known),
            responses: self.known.responses.tr_mul(known),
        };
        self.known.take_off(known, &shares);
        self.tried.take_off(tried, &shares);
        shares
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;
    use rand::SeedableRng as _;

    use super::{Rows, Split, forward};
    use crate::fit::least_squares;
    use crate::fit::testing::gaussian_matrix;

    fn rows(random: &mut rand_pcg::Pcg64Mcg, samples: usize) -> Rows {
        let base = gaussian_matrix(random, samples, 3);
        let candidates = gaussian_matrix(random, samples, 12);
        let truth = gaussian_matrix(random, 3, 2);
        let second = DMatrix::from_fn(samples, 2, |i, j| {
            0.5 * candidates[(i, 4)] - (0.2 + j as f64) * candidates[(i, 9)]
        });
        let responses = &base * truth + second + gaussian_matrix(random, samples, 2) * 0.01;
        Rows { base, candidates, responses }
    }

    #[test]
    fn those_that_are_there_are_taken_first_and_what_is_left_is_the_error_of_the_fit() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(5);
        let all = rows(&mut random, 80);
        let (known, tried): (Vec<usize>, Vec<usize>) = (0..80).partition(|i| i % 4 != 1);
        let split = || Split { known: all.select(&known), tried: all.select(&tried) };
        let taken = forward(split(), 5).unwrap();
        assert_eq!(taken.order.len(), 5);
        assert_eq!(
            {
                let mut first = taken.order[..2].to_vec();
                first.sort_unstable();
                first
            },
            [4, 9]
        );
        for count in 0..=5 {
            let regressors = |rows: &Rows| {
                let chosen = rows.candidates.select_columns(&taken.order[..count]);
                let mut all = rows.base.clone().resize_horizontally(3 + count, 0.0);
                all.columns_mut(3, count).copy_from(&chosen);
                all
            };
            let Split { known, tried } = split();
            let fit = least_squares(&regressors(&known), &known.responses, None).unwrap();
            let left = (&tried.responses - regressors(&tried) * fit.coefficients).norm_squared();
            assert!((taken.left[count] / left - 1.0).abs() < 1e-9, "{count}: {} {left}", taken.left[count]);
        }
    }

    #[test]
    fn what_is_there_already_is_not_taken() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(6);
        let mut all = rows(&mut random, 30);
        let mixed = all.base.column(0) + all.base.column(2);
        (0..12).for_each(|column| all.candidates.set_column(column, &mixed));
        let every: Vec<usize> = (0..30).collect();
        let split = Split { known: all.select(&every), tried: all.select(&every) };
        assert!(forward(split, 5).unwrap().order.is_empty());
        let twice = all.base.column(1).into_owned();
        all.base.set_column(2, &twice);
        let split = Split { known: all.select(&every), tried: all.select(&every) };
        assert!(forward(split, 5).is_none());
        // Nor is a regressor of nothing one.
        all.base.fill_column(2, 0.0);
        let split = Split { known: all.select(&every), tried: all.select(&every) };
        assert!(forward(split, 5).is_none());
    }
}
