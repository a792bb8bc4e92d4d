//! The weighted least squares behind the fit of a motion.

use nalgebra::{SMatrix, SVector, Vector3, Vector6};

use super::regressor::{PARAMETERS, Parameters, Regressor, regressor};
use super::smoothed::{Smooth, moving_at};

/// The parameters, and the delay behind them.
pub(super) const UNKNOWNS: usize = PARAMETERS + 1;
/// By how much scores at later rows hang together, in rows of one time constant: noise behind the filter has the correlation
/// `(1 + x) e⁻ˣ` over `x` time constants.
const LAGS: usize = 24;

/// Fewer rows at rest tell nothing of its noise.
const LEAST_REST: usize = 30;

type Square = SMatrix<f64, UNKNOWNS, UNKNOWNS>;
type Unknowns = SVector<f64, UNKNOWNS>;

/// The rows that are fitted: one for each time constant.
pub(super) struct Rows<'a> {
    pub(super) smooth: &'a [Smooth],
    pub(super) chosen: Vec<usize>,
    /// Where the accelerometer sits \[m\].
    pub(super) place: Vector3<f64>,
    /// Step of the derivative by the delay \[s\].
    pub(super) step: f64,
    /// The sensor rests up to this time \[s\].
    pub(super) rest_ends: f64,
}

/// What is believed before: independent, each with a mean and a standard deviation, which is its scale as well.
#[derive(Clone, Copy)]
pub(super) struct Prior {
    pub(super) mean: Unknowns,
    pub(super) deviation: Unknowns,
}

/// One solution.
pub(super) struct Solved {
    pub(super) parameters: Parameters,
    /// By how much the delay is to be changed \[s\].
    pub(super) change: f64,
    /// Root mean square of what is left \[N, N·m\].
    pub(super) rms: Vector6<f64>,
    /// Standard deviation of what is left at rest \[N, N·m\], if the sensor rests for long enough.
    pub(super) at_rest: Option<Vector6<f64>>,
    /// Of the parameters, then the delay, in SI.
    pub(super) covariance: Square,
    /// Rows that had a motion.
    pub(super) rows: usize,
}

impl<'a> Rows<'a> {
    /// Rows at least `spacing` seconds apart, of which no more than `most`.
    pub(super) fn of(
        smooth: &'a [Smooth],
        place: Vector3<f64>,
        spacing: f64,
        rest_ends: f64,
        most: usize,
    ) -> Self {
        let (mut chosen, mut last) = (Vec::new(), f64::NEG_INFINITY);
        for (index, sample) in smooth.iter().enumerate() {
            if sample.settled && !(sample.time - last < 0.999 * spacing) {
                chosen.push(index);
                last = sample.time;
            }
        }
        let every = chosen.len().div_ceil(most.max(1)).max(1);
        Self {
            smooth,
            chosen: chosen.into_iter().step_by(every).collect(),
            place,
            step: 0.25 * spacing,
            rest_ends,
        }
    }

    /// What loads the sensor at a row if the inertial readings come so much later \[s\], and its measured wrench.
    pub(super) fn at(&self, index: usize, delay: f64) -> Option<(Regressor, Vector6<f64>)> {
        let sample = self.smooth.get(index)?;
        let moving = moving_at(self.smooth, sample.time + delay)?;
        Some((regressor(&moving, &self.place), sample.wrench))
    }

    /// As [`at`](Self::at), with the change of the load by the delay for parameters as they are.
    fn with_slope(
        &self,
        index: usize,
        delay: f64,
        parameters: &Parameters,
    ) -> Option<(SMatrix<f64, 6, UNKNOWNS>, Vector6<f64>)> {
        let (x, wrench) = self.at(index, delay)?;
        let (later, _) = self.at(index, delay + self.step)?;
        let (sooner, _) = self.at(index, delay - self.step)?;
        let slope = (later - sooner) * parameters / (2.0 * self.step);
        let mut all = SMatrix::<f64, 6, UNKNOWNS>::zeros();
        all.fixed_columns_mut::<PARAMETERS>(0).copy_from(&x);
        all.set_column(PARAMETERS, &slope);
        Some((all, wrench))
    }

    /// The most probable parameters, and the step of Gauss and Newton of the delay, about parameters and a delay that are
    /// nearly right; `deviations` are those of what is left of each component \[N, N·m\]. `None` if a number is not finite.
    ///
    /// The noise of the inertial unit is in the regressors, and would draw what it touches towards zero: what they vary by at
    /// rest is taken off the normal equations, `(Σ XᵀWX − n C) θ = Σ XᵀWy` (Fuller 1987, ch. 2), if the sensor rests.
    ///
    /// The covariance holds for noise that hangs together over rows and is unlike over the motion, by the sums of the
    /// products of scores over [`LAGS`] rows with Bartlett's weights (Newey & West 1987); what is believed before adds its own.
    /// It takes most of the time, and is that of what is believed alone unless `how_sure`.
    pub(super) fn solve(
        &self,
        delay: f64,
        about: &Parameters,
        deviations: &Vector6<f64>,
        prior: &Prior,
        how_sure: bool,
    ) -> Option<Solved> {
        let scale = prior.deviation;
        let weights = deviations.map(f64::recip);
        let (mut normal, mut right) = (Square::zeros(), Unknowns::zeros());
        let mut rows = Vec::with_capacity(self.chosen.len());
        let mut resting = 0;
        for index in &self.chosen {
            let Some((mut x, mut y)) = self.with_slope(*index, delay, about) else { continue };
            x.row_iter_mut().zip(weights.iter()).for_each(|(mut row, weight)| row *= *weight);
            x.column_iter_mut().zip(scale.iter()).for_each(|(mut column, scale)| column *= *scale);
            y.component_mul_assign(&weights);
            normal += x.tr_mul(&x);
            right += x.tr_mul(&y);
            let rests = self.smooth.get(*index).is_some_and(|sample| sample.time < self.rest_ends);
            resting += usize::from(rests);
            rows.push((x, y));
        }
        let mut of_unit = noise_of(rows.get(..resting).unwrap_or_default());
        // In units of its own deviation, what is believed before weighs one each.
        normal += Square::identity();
        right += prior.mean.component_div(&scale);
        // Where the sensor never does anything but rest, nothing would be left.
        let factor = match (normal - of_unit * rows.len() as f64).cholesky() {
            Some(factor) => factor,
            None => {
                of_unit = Square::zeros();
                normal.cholesky()?
            }
        };
        let scaled = factor.solve(&right);
        let mut squares = Vector6::zeros();
        let mut scores = Vec::with_capacity(rows.len());
        for (x, y) in &rows {
            let left = y - x * scaled;
            squares += left.component_mul(&left);
            scores.push(x.tr_mul(&left) + of_unit * scaled);
        }
        let at_rest = (resting >= LEAST_REST).then(|| {
            let left: Vec<Vector6<f64>> = rows.iter().take(resting).map(|(x, y)| y - x * scaled).collect();
            let mean = left.iter().sum::<Vector6<f64>>() / resting as f64;
            let squares: Vector6<f64> = left.iter().map(|left| (left - mean).map(|x| x * x)).sum();
            (squares / resting as f64).map(f64::sqrt).component_mul(deviations)
        });
        let rms = (squares / rows.len().max(1) as f64).map(f64::sqrt).component_mul(deviations);
        let inverse = factor.inverse();
        let scores = if how_sure { correlated(&scores) } else { Square::zeros() };
        let sandwich = inverse * (scores + Square::identity()) * inverse;
        let units = Square::from_diagonal(&scale);
        let found = scaled.component_mul(&scale);
        found.iter().all(|x| x.is_finite()).then(|| Solved {
            parameters: found.fixed_rows::<PARAMETERS>(0).into_owned(),
            change: found[PARAMETERS],
            rms,
            at_rest,
            covariance: units * sandwich * units,
            rows: rows.len(),
        })
    }
}

/// By how much the regressors of a row vary at rest, in the sense of `XᵀX`: nothing if the rest is too short to tell.
fn noise_of(resting: &[(SMatrix<f64, 6, UNKNOWNS>, Vector6<f64>)]) -> Square {
    if resting.len() < LEAST_REST {
        return Square::zeros();
    }
    let count = resting.len() as f64;
    let mean = resting.iter().fold(SMatrix::<f64, 6, UNKNOWNS>::zeros(), |sum, (x, _)| sum + x) / count;
    let squares = resting.iter().fold(Square::zeros(), |sum, (x, _)| {
        let off = x - mean;
        sum + off.tr_mul(&off)
    });
    squares / (count - 1.0)
}

/// Covariance of the sum of scores that hang together.
fn correlated(scores: &[Unknowns]) -> Square {
    let lags = LAGS.min(scores.len() / 10);
    let mut sum = Square::zeros();
    for lag in 0..=lags {
        let mut products = Square::zeros();
        for (one, other) in scores.iter().zip(scores.iter().skip(lag)) {
            products += one * other.transpose();
        }
        let weight = 1.0 - lag as f64 / (lags + 1) as f64;
        sum += if lag == 0 { products } else { (products + products.transpose()) * weight };
    }
    sum
}

#[cfg(test)]
mod tests {
    use rand::{RngExt as _, SeedableRng as _};

    use super::{LAGS, Square, Unknowns, correlated};

    /// Newey and West's covariance of a sum, by its definition: all pairs of rows, weighted by how far they are apart.
    #[test]
    fn scores_hang_together_with_their_neighbours() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(21);
        for rows in [1, 9, 10, 35, 400] {
            let scores: Vec<Unknowns> =
                (0..rows).map(|_| Unknowns::from_fn(|_, _| random.random_range(-1.0..1.0))).collect();
            let reach = LAGS.min(rows / 10) as f64 + 1.0;
            let mut expected = Square::zeros();
            for (t, one) in scores.iter().enumerate() {
                for (u, other) in scores.iter().enumerate() {
                    let weight = (1.0 - t.abs_diff(u) as f64 / reach).max(0.0);
                    expected += one * other.transpose() * weight;
                }
            }
            let error = (correlated(&scores) - expected).amax();
            assert!(error <= 1e-12 * expected.amax(), "{rows}: {error:e}");
        }
    }
}
