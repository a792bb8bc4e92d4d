//! Least squares of a stream, in bounded memory.

use nalgebra::DMatrix;

use super::factors::Factors;

/// Rows gathered before they are folded in: few enough to stay in the nearest cache.
const BLOCK: usize = 128;

/// The triangular factor of all the rows `[x | y]` that were pushed: what least squares of `y`
/// (responses) on `x` (regressors) needs of them, and nothing else.
///
/// Rows are folded in by Householder reflections against the triangle (Golub & Van Loan, *Matrix
/// Computations*, updating a QR factorisation), so that no normal equations are formed and the
/// answer is as accurate as that of a QR factorisation of all rows at once. Memory is that of one
/// block of rows and one triangle, whatever the number of rows.
///
/// Pushing rows in another order, or merging the accumulators of several sessions with
/// [`merge`](Self::merge), gives the same answer up to rounding.
///
/// ```
/// use fingertip_calibration::linear::Triangular;
///
/// // Two sessions of 10 000 samples each: a force of 2 N/V, beside a zero. No sample is kept.
/// let (mut morning, mut evening) = (Triangular::new(2, 1), Triangular::new(2, 1));
/// for i in 0..10_000 {
///     let volts = f64::from(i % 101) * 0.01;
///     morning.push(&[1.0, volts], &[2.0 * volts - 0.1]);
///     evening.push(&[1.0, -volts], &[-2.0 * volts - 0.1]);
/// }
/// assert!(morning.merge(&evening) && morning.samples() == 20_000);
/// // A reading that is no number is refused and counted.
/// assert!(!morning.push(&[1.0, f64::NAN], &[0.0]) && morning.refused() == 1);
/// let found = morning.factors().coefficients()?;
/// assert!((found[0] + 0.1).abs() < 1e-12 && (found[1] - 2.0).abs() < 1e-12);
/// # Ok::<(), fingertip_calibration::linear::Unobserved>(())
/// ```
#[derive(Clone, Debug)]
pub struct Triangular {
    regressors: usize,
    responses: usize,
    /// Upper triangle of `[R11 R12; 0 R22]`, column by column.
    triangle: DMatrix<f64>,
    /// Pending rows, column by column.
    block: Vec<f64>,
    pending: usize,
    samples: u64,
    refused: u64,
}

impl Triangular {
    /// For rows with these numbers of regressors and responses.
    #[must_use]
    pub fn new(regressors: usize, responses: usize) -> Self {
        let columns = regressors + responses;
        Self {
            regressors,
            responses,
            triangle: DMatrix::zeros(columns, columns),
            block: vec![0.0; columns * BLOCK],
            pending: 0,
            samples: 0,
            refused: 0,
        }
    }

    /// Takes one sample; `false`, and the sample is left out and counted, if a slice has the wrong
    /// length or an entry is not finite.
    pub fn push(&mut self, x: &[f64], y: &[f64]) -> bool {
        self.push_weighted(x, y, 1.0)
    }

    /// Takes one sample whose variance is `1/weight` of that of a sample of weight 1. A weight of
    /// zero leaves the sample out.
    pub fn push_weighted(&mut self, x: &[f64], y: &[f64], weight: f64) -> bool {
        let fits = x.len() == self.regressors && y.len() == self.responses;
        // A NaN or an infinity among the entries survives in their sum; a finite sum of huge
        // entries may overflow, which refuses them as well.
        let witness: f64 = x.iter().sum::<f64>() + y.iter().sum::<f64>() + weight;
        if !fits || !witness.is_finite() || !(weight >= 0.0) {
            self.refused += 1;
            return false;
        }
        if weight > 0.0 {
            let factor = if weight == 1.0 { 1.0 } else { weight.sqrt() };
            let slots = self.block.iter_mut().skip(self.pending).step_by(BLOCK);
            for (slot, value) in slots.zip(x.iter().chain(y)) {
                *slot = value * factor;
            }
            self.pending += 1;
            self.samples += 1;
            if self.pending == BLOCK {
                self.fold();
            }
        }
        true
    }

    /// How many samples were taken.
    #[must_use]
    pub const fn samples(&self) -> u64 {
        self.samples
    }

    /// How many samples were refused because a number was not finite or a slice had the wrong
    /// length.
    #[must_use]
    pub const fn refused(&self) -> u64 {
        self.refused
    }

    /// Adds the samples of another session; `false` if it counts other columns.
    pub fn merge(&mut self, other: &Self) -> bool {
        if (self.regressors, self.responses) != (other.regressors, other.responses) {
            return false;
        }
        let samples = self.samples + other.samples;
        let mut other = other.clone();
        other.fold();
        for i in 0..other.triangle.nrows() {
            let row: Vec<f64> = other.triangle.row(i).iter().copied().collect();
            let (x, y) = row.split_at(self.regressors);
            self.push(x, y);
        }
        self.samples = samples;
        self.refused += other.refused;
        true
    }

    /// The factors after every sample so far.
    #[must_use]
    pub fn factors(&mut self) -> Factors {
        self.fold();
        let (k, m) = (self.regressors, self.responses);
        Factors {
            regressors: self.triangle.view((0, 0), (k, k)).into_owned(),
            projected: self.triangle.view((0, k), (k, m)).into_owned(),
            residual: self.triangle.view((k, k), (m, m)).into_owned(),
            samples: self.samples,
        }
    }

    /// Folds the pending rows into the triangle.
    fn fold(&mut self) {
        let rows = self.pending;
        if rows == 0 {
            return;
        }
        let columns = self.regressors + self.responses;
        for j in 0..columns {
            let (head, tail) = self.block.split_at_mut((j + 1) * BLOCK);
            let pivot_column = &mut head[j * BLOCK..j * BLOCK + rows];
            let alpha = self.triangle[(j, j)];
            let below = pivot_column.iter().fold(alpha.abs(), |most, x| most.max(x.abs()));
            if !(below > 0.0) {
                continue;
            }
            // Scaled by the largest entry, so that squares neither overflow nor vanish.
            let scale = 1.0 / below;
            let usable = scale.is_finite();
            if usable {
                pivot_column.iter_mut().for_each(|x| *x *= scale);
            } else {
                pivot_column.iter_mut().for_each(|x| *x /= below);
            }
            let alpha = alpha / below;
            let norm = (alpha * alpha + dot(pivot_column, pivot_column)).sqrt();
            // The reflector is [head; pivot_column], its first entry chosen not to cancel.
            let beta = if alpha > 0.0 { -norm } else { norm };
            let first = alpha - beta;
            let tau = -1.0 / (beta * first);
            self.triangle[(j, j)] = beta * below;
            for (offset, column) in tail.chunks_exact_mut(BLOCK).enumerate() {
                let column = &mut column[..rows];
                let top = &mut self.triangle[(j, j + 1 + offset)];
                let step = tau * (first * *top + dot(pivot_column, column));
                *top -= step * first;
                for (x, v) in column.iter_mut().zip(pivot_column.iter()) {
                    *x -= step * v;
                }
            }
        }
        self.pending = 0;
    }
}

/// Dot product in eight interleaved sums, which the compiler turns into vector instructions.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (a_chunks, a_rest) = a.as_chunks::<8>();
    let (b_chunks, b_rest) = b.as_chunks::<8>();
    let mut sums = [0.0; 8];
    for (x, y) in a_chunks.iter().zip(b_chunks) {
        for ((sum, x), y) in sums.iter_mut().zip(x).zip(y) {
            *sum += x * y;
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(x, y)| x * y).sum();
    sums.iter().sum::<f64>() + rest
}

#[cfg(test)]
mod tests {
    use super::Triangular;
    use crate::testing::Largest as _;
    use nalgebra::{DMatrix, DVector};
    use proptest::prelude::*;
    use rand::SeedableRng as _;

    fn random(seed: u64, rows: usize, columns: usize) -> DMatrix<f64> {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(seed);
        DMatrix::from_fn(rows, columns, |_, _| random.random_range(-1.0..1.0))
    }

    fn push_all(triangular: &mut Triangular, x: &DMatrix<f64>, y: &DMatrix<f64>) {
        for (x, y) in x.row_iter().zip(y.row_iter()) {
            let (x, y): (Vec<f64>, Vec<f64>) = (x.iter().copied().collect(), y.iter().copied().collect());
            assert!(triangular.push(&x, &y));
        }
    }

    #[test]
    fn a_weight_of_zero_leaves_a_sample_out_and_one_below_is_refused() {
        let (x, y) = (random(5, 8, 2), random(6, 8, 1));
        let (mut with, mut without) = (Triangular::new(2, 1), Triangular::new(2, 1));
        push_all(&mut with, &x, &y);
        push_all(&mut without, &x, &y);
        assert!(with.push_weighted(&[1e6, -1e6], &[1e9], 0.0) && with.refused() == 0);
        assert!(!with.push_weighted(&[1.0, 1.0], &[1.0], -1.0) && with.refused() == 1);
        assert_eq!(with.factors().coefficients().unwrap(), without.factors().coefficients().unwrap());
    }

    proptest! {
        /// Against nalgebra's QR of all rows at once, and against the definition of the residual.
        #[test]
        fn stream_equals_one_factorisation(seed in any::<u64>(), rows in 10..700_usize, scale in -140..140_i32) {
            let scale = 10_f64.powi(scale);
            let (x, y) = (random(seed, rows, 5) * scale, random(!seed, rows, 3));
            let mut triangular = Triangular::new(5, 3);
            push_all(&mut triangular, &x, &y);
            let factors = triangular.factors();
            let theta = factors.coefficients().unwrap();
            let qr = x.clone().qr();
            let direct = qr.r().solve_upper_triangular(&(qr.q().transpose() * &y)).unwrap();
            prop_assert!((&theta - &direct).largest() <= 1e-12 * direct.largest());
            let residual = &y - &x * &theta;
            let covariance = residual.transpose() * &residual / (rows - 5) as f64;
            prop_assert!((factors.residual_covariance().unwrap() - covariance).largest() < 1e-13);
            let gram = (&x / scale).transpose() * (&x / scale);
            let product = gram * factors.inverse_gram().unwrap() * scale * scale;
            prop_assert!((product - DMatrix::identity(5, 5)).largest() < 1e-10);
        }

        #[test]
        fn sessions_merge(seed in any::<u64>(), split in 0..300_usize) {
            let (x, y) = (random(seed, 300, 4), random(!seed, 300, 2));
            let mut whole = Triangular::new(4, 2);
            push_all(&mut whole, &x, &y);
            let (mut first, mut second) = (Triangular::new(4, 2), Triangular::new(4, 2));
            push_all(&mut first, &x.rows(0, split).into(), &y.rows(0, split).into());
            push_all(&mut second, &x.rows(split, 300 - split).into(), &y.rows(split, 300 - split).into());
            prop_assert!(first.merge(&second));
            let (a, b) = (first.factors(), whole.factors());
            prop_assert_eq!(a.samples, 300);
            prop_assert!((a.coefficients().unwrap() - b.coefficients().unwrap()).largest() < 1e-12);
            let difference = a.residual_covariance().unwrap() - b.residual_covariance().unwrap();
            prop_assert!(difference.largest() < 1e-13);
        }
    }

    #[test]
    fn weights_are_repetitions() {
        let (x, y) = (random(1, 40, 3), random(2, 40, 1));
        let (mut weighted, mut repeated) = (Triangular::new(3, 1), Triangular::new(3, 1));
        for i in 0..40 {
            let (a, b) = (x.row(i).iter().copied().collect::<Vec<_>>(), [y[(i, 0)]]);
            weighted.push_weighted(&a, &b, (i % 4) as f64);
            for _ in 0..i % 4 {
                repeated.push(&a, &b);
            }
        }
        let difference =
            weighted.factors().coefficients().unwrap() - repeated.factors().coefficients().unwrap();
        assert!(difference.largest() < 1e-14);
    }

    #[test]
    fn unobserved_directions_are_named() {
        let mut triangular = Triangular::new(3, 1);
        for i in 0..50 {
            let t = f64::from(i);
            triangular.push(&[t, 2e6 * t, t.sin()], &[t]);
        }
        let mut error = triangular.factors().coefficients().unwrap_err();
        assert_eq!(error.directions.ncols(), 1);
        error.names = vec!["Fx".into(), "Fy".into(), "Fz".into()];
        let text = error.to_string();
        assert!(text.contains("0.71 Fx") && text.contains("0.71 Fy") && !text.contains("Fz"), "{text}");
        let mut empty = Triangular::new(3, 1);
        assert_eq!(empty.factors().coefficients().unwrap_err().directions.ncols(), 3);
    }

    #[test]
    fn refusals_of_sessions_add_up_and_asking_changes_nothing() {
        let mut sessions = [Triangular::new(2, 1), Triangular::new(2, 1)];
        for (session, refused) in sessions.iter_mut().zip([2, 3]) {
            push_all(session, &random(7, 5, 2), &random(8, 5, 1));
            (0..refused).for_each(|_| assert!(!session.push(&[f64::NAN, 0.0], &[0.0])));
        }
        let [mut first, second] = sessions;
        assert!(first.merge(&second) && !first.merge(&Triangular::new(1, 1)));
        assert_eq!((first.samples(), first.refused()), (10, 5));
        let factors = first.factors();
        assert_eq!(factors.regressors, first.factors().regressors);
        assert_eq!(factors.projected, first.factors().projected);
    }

    #[test]
    fn extremes_are_refused_or_survived() {
        let mut triangular = Triangular::new(2, 1);
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert!(!triangular.push(&[1.0, bad], &[1.0]));
            assert!(!triangular.push(&[1.0, 1.0], &[bad]));
            assert!(!triangular.push_weighted(&[1.0, 1.0], &[1.0], bad));
        }
        assert!(!triangular.push(&[1.0], &[1.0]));
        assert!(!triangular.push_weighted(&[1.0, 1.0], &[1.0], -1.0));
        assert_eq!((triangular.samples(), triangular.refused()), (0, 11));
        // Subnormal and huge columns side by side.
        for i in 0..20 {
            let t = f64::from(i);
            triangular.push(&[1e-310 * (1.0 + t), 1e300 * t.sin()], &[3.0 * (1.0 + t) + t.sin()]);
        }
        let theta = triangular.factors().coefficients().unwrap();
        assert!((theta[(1, 0)] * 1e300 - 1.0).abs() < 1e-12, "{theta}");
    }

    /// Error against conditioning: QR loses digits as the condition number, not as its square.
    #[test]
    fn conditioning_costs_its_first_power() {
        let x = random(7, 200, 6);
        let truth = DVector::from_fn(6, |i, _| 1.0 + i as f64);
        for power in [3, 6, 10] {
            // Nearly dependent columns: the last is the first plus a little of itself.
            let mut x = x.clone();
            let close = x.column(0) + x.column(5) * 10_f64.powi(-power);
            x.set_column(5, &close);
            let y = &x * &truth;
            let mut triangular = Triangular::new(6, 1);
            push_all(&mut triangular, &x, &DMatrix::from_column_slice(200, 1, y.as_slice()));
            let theta = triangular.factors().coefficients().unwrap();
            let error = (theta.column(0) - &truth).largest();
            assert!(error < 100.0 * f64::EPSILON * 10_f64.powi(power), "{power}: {error:e}");
        }
    }
}
