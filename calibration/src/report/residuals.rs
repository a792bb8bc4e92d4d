//! Residuals of a fit of which samples are taken out one after the other.

use alloc::borrow::Cow;

use nalgebra::{DMatrix, DVector};

use crate::fit::{Fit, least_squares};

/// Removing a sample whose residual is so many deviations of the others leaves rounding in theirs.
const OUTSHINES: f64 = 1e8;
/// Nor can a sample be taken out of a fit that so little but itself determines.
const LEAST_FREE: f64 = 1e-6;
/// Of more samples than these, only those that stand out most are followed.
const FOLLOWED: usize = 4096;
/// The sum of squares over all samples must not lose more digits than this in going down.
const LEAST_SQUARES_LEFT: f64 = 1e-6;

/// The residuals of a least-squares fit, of which samples can be taken out one after the other: as fitting anew does, by
/// the deletion formulas of Cook & Weisberg 1982.
///
/// Of a large table the samples with the largest residuals and leverages are followed, and of all others bounds: what
/// taking out a sample d does to another one i is at most `√(hᵢ h_d) |r_d| / (1 − h_d)`, since `h_id² ≤ hᵢ h_d`.
pub(super) struct Residuals {
    /// Samples of the table that were fitted, and those of them that are out.
    all: Vec<usize>,
    gone: Vec<usize>,
    /// Which samples of the table are followed.
    rows: Vec<usize>,
    is_out: Vec<bool>,
    /// Their rows of the design and residuals, each times the root of its weight.
    design: DMatrix<f64>,
    residuals: DMatrix<f64>,
    /// How much a sample determines its own prediction, from 0 to 1.
    leverage: DVector<f64>,
    inverse_gram: DMatrix<f64>,
    /// What rounding leaves of an exact fit, for each response.
    floors: Vec<f64>,
    /// Where not all are followed.
    others: Option<Others>,
}

/// What is known of the samples that are not followed.
struct Others {
    /// Sums of the squares of each response, over all samples that are left.
    squares: Vec<f64>,
    /// Bounds of their residuals, for each response, and of their leverages.
    residual: Vec<f64>,
    leverage: f64,
    /// Nothing was taken out yet: none of them stands out more than the most extreme that is followed.
    fresh: bool,
}

impl Residuals {
    /// Of these rows; `None` if they are too few, or do not determine the fit.
    pub(super) fn of(
        design: &DMatrix<f64>,
        responses: &DMatrix<f64>,
        weights: Option<&[f64]>,
        rows: Vec<usize>,
    ) -> Option<Self> {
        Self::following(design, responses, weights, rows, FOLLOWED, None)
    }

    /// Of all rows, whose least-squares fit is this.
    pub(super) fn of_fit(
        design: &DMatrix<f64>,
        responses: &DMatrix<f64>,
        weights: Option<&[f64]>,
        fit: &Fit,
    ) -> Option<Self> {
        let rows = (0..design.nrows()).collect();
        Self::following(design, responses, weights, rows, FOLLOWED, Some(fit))
    }

    fn following(
        design: &DMatrix<f64>,
        responses: &DMatrix<f64>,
        weights: Option<&[f64]>,
        rows: Vec<usize>,
        most: usize,
        fit: Option<&Fit>,
    ) -> Option<Self> {
        if rows.len() < design.ncols() + 3 {
            return None;
        }
        let whole = rows.len() == design.nrows();
        let of = |matrix| {
            if whole { Cow::Borrowed(matrix) } else { Cow::Owned(DMatrix::select_rows(matrix, &rows)) }
        };
        let (mut x, y): (Cow<'_, DMatrix<f64>>, Cow<'_, DMatrix<f64>>) = (of(design), of(responses));
        let kept: Option<Vec<f64>> = weights.map(|w| rows.iter().map(|i| w[*i]).collect());
        let anew = match fit {
            Some(_) => None,
            None => Some(least_squares(&x, &y, kept.as_deref()).ok()?),
        };
        let fit = fit.or(anew.as_ref())?;
        let mut residuals = &*y - &*x * &fit.coefficients;
        for (row, weight) in kept.iter().flatten().enumerate() {
            x.to_mut().row_mut(row).scale_mut(weight.sqrt());
            residuals.row_mut(row).scale_mut(weight.sqrt());
        }
        let leverage = leverages(&x, &fit.inverse_gram);
        let floors = y.column_iter().map(|column| f64::EPSILON * rows.len() as f64 * column.amax()).collect();
        let inverse_gram = fit.inverse_gram.clone();
        let all = Self {
            is_out: vec![false; rows.len()],
            gone: Vec::new(),
            all: Vec::new(),
            rows,
            design: DMatrix::zeros(0, x.ncols()),
            residuals,
            leverage,
            inverse_gram,
            floors,
            others: None,
        };
        if all.rows.len() > most {
            return Some(all.of_the_largest(most, &x));
        }
        Some(Self { all: all.rows.clone(), design: x.into_owned(), ..all })
    }

    /// Follows about so many that stand out most, whose rows of the design are taken from `design`.
    fn of_the_largest(self, most: usize, design: &DMatrix<f64>) -> Self {
        let each = most / (self.floors.len() + 1);
        let mut is_followed = vec![false; self.rows.len()];
        // What the sample at this rank has, beyond which all are followed; `with` those that have as much.
        let mut cut = |values: &[f64], with: bool| {
            let mut sorted = values.to_vec();
            let (_, least, _) = sorted.select_nth_unstable_by(each, |a, b| b.total_cmp(a));
            let least = *least;
            let of_those = |value: f64| value > least || with && value == least;
            values.iter().zip(&mut is_followed).for_each(|(value, is)| *is |= of_those(*value));
            least
        };
        // All have the same where a constant is fitted.
        let leverage = cut(self.leverage.as_slice(), false);
        let of_response = |column: nalgebra::DVectorView<'_, f64>| -> Vec<f64> {
            let free = self.leverage.iter().map(|leverage| (1.0 - leverage).max(f64::MIN_POSITIVE));
            column.iter().zip(free).map(|(residual, free)| residual * residual / free).collect()
        };
        // A residual is less than it is in deviations of its own.
        let residual =
            self.residuals.column_iter().map(|column| cut(&of_response(column), true).sqrt()).collect();
        let squares = self.residuals.column_iter().map(|column| column.norm_squared()).collect();
        let followed: Vec<usize> = (0..self.rows.len()).filter(|row| is_followed[*row]).collect();
        Self {
            rows: followed.iter().map(|row| self.rows[*row]).collect(),
            is_out: vec![false; followed.len()],
            all: self.rows,
            design: design.select_rows(&followed),
            residuals: self.residuals.select_rows(&followed),
            leverage: self.leverage.select_rows(&followed),
            others: Some(Others { squares, residual, leverage, fresh: true }),
            ..self
        }
    }

    /// Which sample of the table a row is.
    pub(super) fn sample(&self, row: usize) -> usize {
        self.rows[row]
    }

    pub(super) fn left(&self) -> usize {
        self.all.len() - self.gone.len()
    }

    pub(super) fn remaining(&self) -> Vec<usize> {
        self.all.iter().copied().filter(|sample| !self.gone.contains(sample)).collect()
    }

    pub(super) fn freedom(&self) -> f64 {
        self.left() as f64 - self.design.ncols() as f64
    }

    /// Of a response, the variance of what is left.
    fn variance(&self, response: usize) -> f64 {
        if let Some(others) = &self.others {
            return others.squares[response] / self.freedom();
        }
        let residuals = self.residuals.column(response);
        let squares = residuals.iter().zip(&self.is_out);
        squares.map(|(x, out)| if *out { 0.0 } else { x * x }).sum::<f64>() / self.freedom()
    }

    /// The externally studentised residual of a sample whose residual in deviations of its own is this.
    fn external(&self, internal: f64) -> f64 {
        let rest = (self.freedom() - internal * internal).max(f64::MIN_POSITIVE);
        internal * ((self.freedom() - 1.0) / rest).sqrt()
    }

    /// Row, response and externally studentised residual of the sample that stands out most.
    pub(super) fn most_extreme(&self) -> Option<(usize, usize, f64)> {
        if self.left() < self.design.ncols() + 3 {
            return None;
        }
        let mut best: Option<(usize, usize, f64)> = None;
        for (j, floor) in self.floors.iter().enumerate() {
            let variance = self.variance(j);
            if !(variance.sqrt() > *floor) {
                continue;
            }
            for (i, residual) in self.residuals.column(j).iter().enumerate() {
                let free = 1.0 - self.leverage[i];
                if self.is_out[i] || !(free > 1e-9) {
                    continue;
                }
                let external = self.external(residual / (variance * free).sqrt());
                if best.is_none_or(|(_, _, t)| external.abs() > t.abs()) {
                    best = Some((i, j, external));
                }
            }
        }
        best
    }

    /// Whether none of those that are not followed can stand out more than this.
    pub(super) fn is_sure_of(&self, most: f64) -> bool {
        let Some(others) = self.others.as_ref().filter(|others| !others.fresh) else { return true };
        let free = 1.0 - others.leverage;
        free > 0.0
            && self.floors.iter().enumerate().all(|(j, floor)| {
                let variance = self.variance(j);
                let internal = others.residual[j] / (variance * free).sqrt();
                !(variance.sqrt() > *floor) || self.external(internal) <= most.abs()
            })
    }

    /// Takes a sample out; `false` if the others would be left with rounding and must be fitted anew.
    pub(super) fn remove(&mut self, row: usize) -> bool {
        let (leverage, free) = (self.leverage[row], 1.0 - self.leverage[row]);
        let direction = &self.inverse_gram * self.design.row(row).transpose();
        let shared = &self.design * &direction / free;
        self.leverage += shared.component_mul(&shared) * free;
        self.inverse_gram += &direction * direction.transpose() / free;
        let own = self.residuals.row(row).into_owned();
        self.residuals.ger(1.0, &shared, &own.transpose(), 1.0);
        self.is_out[row] = true;
        self.gone.push(self.rows[row]);
        let mut keeps_digits = true;
        if let Some(others) = &mut self.others {
            for ((squares, bound), own) in others.squares.iter_mut().zip(&mut others.residual).zip(own.iter())
            {
                let less = *squares - own * own / free;
                keeps_digits &= less >= LEAST_SQUARES_LEFT * *squares;
                *squares = less;
                *bound += (others.leverage * leverage).sqrt() * own.abs() / free;
            }
            others.leverage *= 1.0 + leverage / free;
            others.fresh = false;
        }
        keeps_digits
            && free > LEAST_FREE
            && (0..own.len())
                .all(|j| own[j].abs() <= OUTSHINES * (self.variance(j) * free).sqrt().max(self.floors[j]))
    }
}

/// How much each sample determines its own prediction: the diagonal of `X G Xᵀ`, in blocks that stay in the cache.
fn leverages(design: &DMatrix<f64>, inverse_gram: &DMatrix<f64>) -> DVector<f64> {
    const BLOCK: usize = 4096;
    let mut leverages = DVector::zeros(design.nrows());
    for start in (0..design.nrows()).step_by(BLOCK) {
        let length = BLOCK.min(design.nrows() - start);
        let rows = design.rows(start, length);
        let of_rows = (rows * inverse_gram).component_mul(&rows).column_sum();
        leverages.rows_mut(start, length).copy_from(&of_rows);
    }
    leverages
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;
    use rand::SeedableRng as _;

    use super::Residuals;
    use crate::fit::least_squares;
    use crate::fit::testing::{gaussian_matrix, sensor};

    /// As said: by fitting anew without those that are out.
    fn by_fitting_anew(x: &DMatrix<f64>, y: &DMatrix<f64>, weights: &[f64]) -> Vec<(usize, usize, f64)> {
        let mut left: Vec<usize> = (0..x.nrows()).collect();
        let mut order = Vec::new();
        for _ in 0..(x.nrows() / 5).min(30) {
            let of = |matrix: &DMatrix<f64>| matrix.select_rows(&left);
            let kept: Vec<f64> = left.iter().map(|i| weights[*i]).collect();
            let fit = least_squares(&of(x), &of(y), Some(&kept)).unwrap();
            let residuals = of(y) - of(x) * &fit.coefficients;
            let freedom = (left.len() - x.ncols()) as f64;
            let mut best = (0, 0, 0.0_f64);
            for (place, i) in left.iter().enumerate() {
                let leverage = weights[*i] * (x.row(*i) * &fit.inverse_gram * x.row(*i).transpose())[(0, 0)];
                for j in 0..y.ncols() {
                    let scale = (fit.residual_covariance[(j, j)] * (1.0 - leverage)).sqrt();
                    let internal = residuals[(place, j)] * weights[*i].sqrt() / scale;
                    let rest = (freedom - internal * internal).max(f64::MIN_POSITIVE);
                    let external = internal * ((freedom - 1.0) / rest).sqrt();
                    if external.abs() > best.2 {
                        best = (*i, j, external.abs());
                    }
                }
            }
            left.retain(|i| *i != best.0);
            order.push(best);
        }
        order
    }

    #[test]
    fn taking_out_is_fitting_anew() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(6);
        // Ever larger outliers, up to those that outshine the others.
        let sizes = [0.0, 10.0, 1e4, 1e9, 1e13];
        // All of them followed, and few.
        for (size, most) in sizes.into_iter().flat_map(|size| [(size, 60), (size, 12), (size, 4)]) {
            let mut design = gaussian_matrix(&mut random, 60, 4);
            // One that its own prediction depends on, nearly.
            design.row_mut(7).scale_mut(1e3);
            let mut responses = &design * sensor(&mut random, 4, 3) + gaussian_matrix(&mut random, 60, 3);
            responses[(20, 1)] += size;
            responses[(31, 1)] -= 0.5 * size;
            let weights: Vec<f64> = (0..60).map(|i| 0.5 + f64::from(i % 3)).collect();
            let expected = by_fitting_anew(&design, &responses, &weights);
            let of = |rows: Vec<usize>| {
                Residuals::following(&design, &responses, Some(&weights), rows, most, None).unwrap()
            };
            let mut residuals = of((0..60).collect());
            for (index, response, t) in expected {
                let (mut row, mut found_response, mut found) = residuals.most_extreme().unwrap();
                if !residuals.is_sure_of(found) {
                    residuals = of(residuals.remaining());
                    (row, found_response, found) = residuals.most_extreme().unwrap();
                    assert!(residuals.is_sure_of(found) && most < 60);
                }
                assert_eq!((residuals.sample(row), found_response), (index, response), "{size} {most}");
                // One that is the whole deviation has a residual of rounding beside it.
                let alike = (found.abs() / t - 1.0).abs() < 1e-6 || (found.abs() > 1e6 && t > 1e6);
                assert!(alike, "{size}: {found} for {t}");
                if !residuals.remove(row) {
                    residuals = of(residuals.remaining());
                }
            }
        }
    }

    /// One that clearly stands out is found among the few that are followed, without another fit; and what nobody has
    /// followed is not vouched for.
    #[test]
    fn what_stands_out_is_sure_without_fitting_anew() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(11);
        let design = gaussian_matrix(&mut random, 400, 4);
        let mut responses = &design * sensor(&mut random, 4, 3) + gaussian_matrix(&mut random, 400, 3);
        for (row, response, size) in [(20, 1, 40.0), (31, 2, 30.0), (77, 0, -20.0)] {
            responses[(row, response)] += size;
        }
        let mut residuals =
            Residuals::following(&design, &responses, None, (0..400).collect(), 100, None).unwrap();
        for expected in [20, 31, 77] {
            let (row, _, found) = residuals.most_extreme().unwrap();
            assert_eq!(residuals.sample(row), expected);
            assert!(residuals.is_sure_of(found) && residuals.is_sure_of(-found), "{expected}: {found}");
            assert!(residuals.remove(row));
        }
        // Of noise alone the others may be as large.
        assert!(!residuals.is_sure_of(0.1));
        // A response that is exact has nothing that stands out.
        let exact = DMatrix::from_fn(400, 3, |i, j| if j == 2 { design[(i, 0)] } else { responses[(i, j)] });
        let mut residuals =
            Residuals::following(&design, &exact, None, (0..400).collect(), 100, None).unwrap();
        let (row, _, _) = residuals.most_extreme().unwrap();
        residuals.remove(row);
        let (_, _, found) = residuals.most_extreme().unwrap();
        assert!(residuals.is_sure_of(found), "{found}");
    }

    /// With fewer than three degrees of freedom whatever is left is shared among all, and names none.
    #[test]
    fn nothing_stands_out_of_too_few() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(12);
        let mut of = |samples: usize| {
            let design = gaussian_matrix(&mut random, samples, 4);
            let responses = &design * sensor(&mut random, 4, 3) + gaussian_matrix(&mut random, samples, 3);
            Residuals::following(&design, &responses, None, (0..samples).collect(), samples, None)
        };
        assert!(of(6).is_none());
        let mut residuals = of(8).unwrap();
        for left in [8, 7] {
            assert_eq!(residuals.left(), left);
            let (row, _, _) = residuals.most_extreme().unwrap();
            assert!(residuals.remove(row));
        }
        assert!(residuals.left() == 6 && residuals.most_extreme().is_none());
    }
}
