//! How noisy the six components of a wrench are, by what a fit to poses leaves, and how sure that makes the fit.

use nalgebra::{DMatrix, DVector, Matrix6, Vector6};

/// Noise of each component and how it moves what was fitted.
///
/// What is fitted moves by `Σ P_iᵀ e_i` with the errors `e_i` of the wrenches, and what is left of pose i is
/// `r_i = e_i − D_i Σ P_jᵀ e_j`, with `D_i` the derivatives of its predicted wrench. So the squares that are left of
/// component a have the mean `Σ_b M_ab σ_b²`,
/// `M_ab = δ_ab (n − 2 Σ_i (D_i P_iᵀ)_aa) + Σ_ij (D_i P_jᵀ)_ab²`, which is solved for the variances (Rao 1970): components may
/// be as different as they like. They are taken for independent.
pub(super) struct PoseNoise {
    variances: Vector6<f64>,
    /// Variances of the squares that are left of each component.
    shares: Matrix6<f64>,
    squares: Vector6<f64>,
    /// Degrees of freedom behind each of these.
    freedom: Vector6<f64>,
    /// `Σ_j p_ja p_jaᵀ` of each component a.
    moves: Vec<DMatrix<f64>>,
}

impl PoseNoise {
    /// Of what is left of each pose, the derivatives of its wrench by the parameters, and those of the parameters by
    /// its wrench (each 6 × parameters). Where the squares do not tell the components apart, all forces are taken for
    /// alike, and all torques.
    pub(super) fn new(left: &[Vector6<f64>], slopes: &[DMatrix<f64>], moves: &[DMatrix<f64>]) -> Self {
        let squared = |list: &[DMatrix<f64>], row: usize| {
            let k = list.first().map_or(0, DMatrix::ncols);
            list.iter().fold(DMatrix::zeros(k, k), |sum, one| sum + one.row(row).tr_mul(&one.row(row)))
        };
        let of_slopes: Vec<_> = (0..6).map(|row| squared(slopes, row)).collect();
        let of_moves: Vec<_> = (0..6).map(|row| squared(moves, row)).collect();
        let own =
            |row: usize| -> f64 { slopes.iter().zip(moves).map(|(d, p)| d.row(row).dot(&p.row(row))).sum() };
        let count = left.len() as f64;
        let squares = left.iter().fold(Vector6::zeros(), |sum, r| sum + r.component_mul(r));
        let mean = Matrix6::from_fn(|a, b| {
            let alone = if a == b { count - 2.0 * own(a) } else { 0.0 };
            alone + of_slopes[a].dot(&of_moves[b])
        });
        let freedom = Vector6::from_fn(|a, _| (count - own(a)).max(f64::MIN_POSITIVE));
        let apart = mean.try_inverse().filter(|inverse| inverse.iter().all(|x| x.is_finite()));
        // All forces together, and all torques.
        let alike = Matrix6::from_fn(|a, b| {
            if a / 3 == b / 3 { 1.0 / freedom.fixed_rows::<3>(3 * (a / 3)).sum() } else { 0.0 }
        });
        let shares = apart.unwrap_or(alike);
        // Where others leave so much of a component that its own noise does not show.
        let least = Vector6::from_fn(|a, _| 0.05 * squares[a] / mean[(a, a)].max(f64::MIN_POSITIVE));
        let variances = (shares * squares).zip_map(&least, f64::max);
        Self { variances, shares, squares, freedom, moves: of_moves }
    }

    /// Standard deviation of a combination of the parameters, and the degrees of freedom behind it: `2 v²/Var(v)` of its
    /// variance v (Satterthwaite 1946), which is a sum of the squares that are left, taken for independent.
    pub(super) fn of(&self, combination: &DVector<f64>) -> (f64, f64) {
        let weights = Vector6::from_fn(|a, _| combination.dot(&(&self.moves[a] * combination)));
        let variance = weights.dot(&self.variances);
        let by_squares = self.shares.tr_mul(&weights).component_mul(&self.squares);
        let uncertain = by_squares.component_mul(&by_squares).component_div(&self.freedom).sum();
        let freedom = if uncertain > 0.0 { variance * variance / uncertain } else { self.freedom.sum() };
        (variance.max(0.0).sqrt(), freedom)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where the squares do not tell the components apart, forces share theirs and torques theirs: a pose that is fitted
    /// exactly in Fx says nothing of the noise of Fx.
    #[test]
    fn components_that_are_not_told_apart_are_alike_in_threes() {
        // One parameter that follows Fx alone, of one pose: nothing is left of that.
        let only_first = DMatrix::from_fn(6, 1, |row, _| if row == 0 { 1.0 } else { 0.0 });
        let left = [Vector6::new(0.0, 2.0, 4.0, 0.1, 0.2, 0.4)];
        let noise =
            PoseNoise::new(&left, core::slice::from_ref(&only_first), core::slice::from_ref(&only_first));
        // Two degrees of freedom of three forces, three of three torques.
        let (force, torque) = ((4.0 + 16.0) / 2.0, (0.01 + 0.04 + 0.16) / 3.0);
        for (component, expected) in [force, force, force, torque, torque, torque].into_iter().enumerate() {
            let found = noise.variances[component];
            assert!((found / expected - 1.0).abs() < 1e-12, "{component}: {found} {expected}");
        }
        // The parameter has the noise of a force, and the degrees of freedom of two that are left.
        let (deviation, freedom) = noise.of(&DVector::from_element(1, 1.0));
        assert!((deviation - force.sqrt()).abs() < 1e-12, "{deviation}");
        // 2 v²/Var(v) of v = (4 + 16)/2, each square with its one degree: 100/(2² + 8²).
        assert!((freedom - 100.0 / 68.0).abs() < 1e-12, "{freedom}");
    }

    /// Two poses that leave of every component what they show: each has its own.
    #[test]
    fn components_that_are_told_apart_have_their_own() {
        let nothing = DMatrix::zeros(6, 1);
        let left = [Vector6::new(1.0, 2.0, 3.0, 4.0, 5.0, 6.0), Vector6::new(-1.0, 0.0, 3.0, 0.0, 5.0, 2.0)];
        let noise = PoseNoise::new(&left, &[nothing.clone(), nothing.clone()], &[nothing.clone(), nothing]);
        let expected = [1.0, 2.0, 9.0, 8.0, 25.0, 20.0];
        assert!((noise.variances - Vector6::from(expected)).amax() < 1e-12, "{}", noise.variances);
    }
}
