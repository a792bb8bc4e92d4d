//! How noisy the six components of a wrench are, by what a fit to poses leaves, and how sure that makes the fit.

use nalgebra::{DMatrix, DVector, Matrix6, SymmetricEigen, Vector6};

use super::products::{Derivatives, Products};
use super::quadratic::{Symmetric, variance_of_form};

/// The greatest step from the variance of one component to the next, as a logarithm: a deviation of ten times.
const GREATEST_STEP: f64 = 4.6;
/// So much of the square of a step is laid to chance, in its mean: by trials, between unlike components that count alike and
/// alike ones that do not.
const BY_CHANCE: f64 = 2.0;
/// The least part of a component's noise that is not in the other components, as a variance.
const LEAST_OWN: f64 = 0.05;

/// Covariance of a wrench's noise and how it moves what was fitted.
///
/// What is fitted moves by `Σ P_iᵀ e_i` with the errors `e_i` of the wrenches, and what is left of pose i is
/// `r_i = e_i − D_i Σ P_jᵀ e_j`, with `D_i` the derivatives of its predicted wrench. So the products that are left,
/// `S = Σ r_i r_iᵀ`, have a mean that is linear in the covariance Σ of the errors,
/// `n Σ − H Σ − Σ Hᵀ + Σ_i D_i (Σ_j P_jᵀ Σ P_j) D_iᵀ`, `H = Σ_i D_i P_iᵀ`, which is solved for Σ (Rao 1970): components may be
/// as different and as correlated as they like.
pub(super) struct PoseNoise {
    /// Of the errors, each in the unit that makes the mean of its squares one.
    covariance: Matrix6<f64>,
    /// From a form of the errors' covariance to the form of what is left that has its mean.
    unbiased: DMatrix<f64>,
    /// Degrees of freedom behind each component.
    freedom: Vector6<f64>,
    by: Derivatives,
    /// What the doubt of the weights of the components adds: of each, the changes of the moves, and the variance of their
    /// factor.
    besides: Vec<(Products, f64)>,
    /// The units.
    units: Vector6<f64>,
}

impl PoseNoise {
    /// Of what is left of each pose, the derivatives of its wrench by the parameters, and those of the parameters by
    /// its wrench (each 6 × parameters). Where what is left does not tell the components apart, all forces are taken for
    /// alike and apart from each other, and all torques.
    pub(super) fn new(
        left: &[Vector6<f64>],
        slopes: &[DMatrix<f64>],
        moves: &[DMatrix<f64>],
        besides: impl IntoIterator<Item = Besides>,
    ) -> Self {
        let count = left.len() as f64;
        let squares = left.iter().fold(Vector6::zeros(), |sum, r| sum + r.component_mul(r)) / count;
        // Forces and torques have units of their own.
        let units = squares.map(|mean| if mean > 0.0 { mean.sqrt() } else { 1.0 });
        let inverse = units.map(|unit| 1.0 / unit);
        let slopes: Vec<_> = slopes.iter().map(|by| in_units(by, &inverse)).collect();
        let moves: Vec<_> = moves.iter().map(|by| in_units(by, &units)).collect();
        let products = left.iter().fold(Matrix6::zeros(), |sum, r| {
            let r = r.component_mul(&inverse);
            sum + r * r.transpose()
        });
        let by = Derivatives::of(&slopes, &moves);
        let (own, carried) = (by.taken_up(), by.slopes.between_those_around(&by.moves));
        let mean = |covariance: &Matrix6<f64>| {
            let twice = own * covariance;
            covariance * count - twice - twice.transpose() + carried(covariance)
        };
        let freedom = own.diagonal().map(|own| (count - own).max(f64::MIN_POSITIVE));
        let unbiased = Symmetric::matrix_of(mean)
            .try_inverse()
            .filter(|inverse| inverse.iter().all(|x| (x * count).abs() < 1e3))
            .map_or_else(|| alike(&freedom, &units), |inverse| inverse.transpose());
        let found = Symmetric::applied(&unbiased.transpose(), &products);
        let covariance = positive(&found, &products, &freedom);
        let in_these_units = |besides: Besides| {
            let changes: Vec<_> = besides.changes.iter().map(|by| in_units(by, &units)).collect();
            (Products::of(&changes), besides.variance)
        };
        let besides = besides.into_iter().map(in_these_units).collect();
        Self { covariance, unbiased, freedom, by, besides, units }
    }

    /// What each component should count in a fit, by its noise beside that of the two others of its kind; and what is not
    /// sure of that.
    ///
    /// Few poses tell each variance but roughly: with ν degrees of freedom its logarithm has the variance 2/ν. So of the three
    /// logarithms, in order, each step to the next is drawn together by the share of it that chance alone may give (as James &
    /// Stein 1961): components that are alike count alike, those that are clearly unlike nearly by what was found.
    pub(super) fn weights(&self) -> (Vector6<f64>, Vec<Doubt>) {
        let (mut weights, mut doubts) = (Vector6::from_element(1.0), Vec::new());
        let variances = self.covariance.diagonal().component_mul(&self.units).component_mul(&self.units);
        for first in [0, 3] {
            let mut order = [first, first + 1, first + 2];
            order.sort_by(|a, b| variances[*a].total_cmp(&variances[*b]));
            let mut logs = Vector6::zeros();
            for (quiet, noisy) in [(1, 2), (2, 1)] {
                // So many of the three are on the quiet side of the step.
                let (below, above) = (order[quiet - 1], order[quiet]);
                let step = (variances[above] / variances[below]).ln().min(GREATEST_STEP);
                let by_chance = 2.0 / self.freedom[below] + 2.0 / self.freedom[above];
                let kept = 1.0 - BY_CHANCE * by_chance / (step * step);
                // Where nothing is left of a component, nothing is known of its noise.
                if !(kept > 0.0 && step.is_finite()) {
                    continue;
                }
                let mut direction = Vector6::zeros();
                for (place, component) in order.into_iter().enumerate() {
                    direction[component] =
                        if place < quiet { f64::from(noisy) / 3.0 } else { -(quiet as f64) / 3.0 };
                }
                logs += direction * (kept * step);
                doubts.push(Doubt { direction, variance: by_chance * kept * kept });
            }
            for component in order {
                weights[component] = logs[component].exp();
            }
        }
        (weights, doubts)
    }

    /// Standard deviation of a combination of the parameters, and the degrees of freedom behind it: `2 v²/Var(v)` of its
    /// variance v (Satterthwaite 1946), a form of what is left.
    pub(super) fn of(&self, combination: &DVector<f64>) -> (f64, f64) {
        let squares = combination * combination.transpose();
        let form = self.by.moves.between(&squares);
        let mut variance = form.dot(&self.covariance);
        let of_left = Symmetric::applied(&self.unbiased, &form);
        let uncertain = variance_of_form(&of_left, &self.covariance, &self.by);
        let freedom =
            if uncertain > 0.0 { 2.0 * variance * variance / uncertain } else { self.freedom.sum() };
        for (changes, of_weight) in &self.besides {
            variance += 2.0 * of_weight * changes.between(&squares).dot(&self.covariance);
        }
        (variance.max(0.0).sqrt(), freedom)
    }
}

/// What is not sure of the weights of components.
pub(super) struct Doubt {
    /// By how much the logarithm of each weight would change.
    pub(super) direction: Vector6<f64>,
    /// Variance of the factor of that.
    pub(super) variance: f64,
}

/// How the fit moves with the weights of components: what that adds to the variances, twice as by itself, since the weights
/// are those for which the fit seems surest (Kackar & Harville 1984; Kenward & Roger 1997).
pub(super) struct Besides {
    /// Changes of the derivatives of the parameters by the wrenches, along the direction of a doubt.
    pub(super) changes: Vec<DMatrix<f64>>,
    /// Variance of the factor of that.
    pub(super) variance: f64,
}

/// Rows in other units.
fn in_units(by: &DMatrix<f64>, units: &Vector6<f64>) -> DMatrix<f64> {
    let mut by = by.clone();
    by.row_iter_mut().zip(units.iter()).for_each(|(mut row, unit)| row *= *unit);
    by
}

/// The form of what is left where all forces are as noisy, and all torques, and nothing is correlated.
fn alike(freedom: &Vector6<f64>, units: &Vector6<f64>) -> DMatrix<f64> {
    Symmetric::matrix_of(|form| {
        Matrix6::from_fn(|a, b| {
            if a != b {
                return 0.0;
            }
            let kind = 3 * (a / 3)..3 * (a / 3) + 3;
            let of_kind: f64 = kind.clone().map(|b| form[(b, b)] / units[b].powi(2)).sum();
            units[a].powi(2) * of_kind / kind.map(|b| freedom[b]).sum::<f64>()
        })
    })
}

/// The nearest covariance of which every component keeps some noise of its own, by its correlations.
fn positive(found: &Matrix6<f64>, products: &Matrix6<f64>, freedom: &Vector6<f64>) -> Matrix6<f64> {
    // Where others leave so much of a component that its own noise does not show.
    let least = products.diagonal().component_div(freedom) * LEAST_OWN;
    let deviations = found.diagonal().zip_map(&least, f64::max).map(f64::sqrt);
    let of = |a: usize, b: usize| deviations[a] * deviations[b];
    let mut correlations =
        Matrix6::from_fn(|a, b| if a != b && of(a, b) > 0.0 { found[(a, b)] / of(a, b) } else { 0.0 });
    correlations.fill_diagonal(1.0);
    let mut eigen = SymmetricEigen::new(correlations);
    eigen.eigenvalues.apply(|value| *value = value.max(LEAST_OWN));
    let kept = eigen.recompose();
    Matrix6::from_fn(|a, b| kept[(a, b)] * of(a, b) / (kept[(a, a)] * kept[(b, b)]).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    impl PoseNoise {
        fn variances(&self) -> Vector6<f64> {
            self.covariance.diagonal().component_mul(&self.units).component_mul(&self.units)
        }
    }

    /// Where what is left does not tell the components apart, forces share theirs and torques theirs: a pose that is fitted
    /// exactly in Fx says nothing of the noise of Fx.
    #[test]
    fn components_that_are_not_told_apart_are_alike_in_threes() {
        // One parameter that follows Fx alone, of one pose: nothing is left of that.
        let only_first = [DMatrix::from_fn(6, 1, |row, _| if row == 0 { 1.0 } else { 0.0 })];
        let left = [Vector6::new(0.0, 2.0, 4.0, 0.1, 0.2, 0.4)];
        let noise = PoseNoise::new(&left, &only_first, &only_first, []);
        // Two degrees of freedom of three forces, three of three torques.
        let (force, torque) = ((4.0 + 16.0) / 2.0, (0.01 + 0.04 + 0.16) / 3.0);
        for (component, expected) in [force, force, force, torque, torque, torque].into_iter().enumerate() {
            let found = noise.variances()[component];
            assert!((found / expected - 1.0).abs() < 1e-12, "{component}: {found} {expected}");
        }
        // Nothing says that any counts more than others.
        let (weights, doubts) = noise.weights();
        assert!(weights == Vector6::from_element(1.0) && doubts.is_empty(), "{weights}");
        // The parameter has the noise of a force, and the degrees of freedom of the two that are left.
        let (deviation, freedom) = noise.of(&DVector::from_element(1, 1.0));
        assert!((deviation - force.sqrt()).abs() < 1e-12, "{deviation}");
        assert!((freedom - 2.0).abs() < 1e-12, "{freedom}");
    }

    /// Two poses that leave of every component what they show: each has its own.
    #[test]
    fn components_that_are_told_apart_have_their_own() {
        let nothing = [DMatrix::zeros(6, 1), DMatrix::zeros(6, 1)];
        let left = [Vector6::new(1.0, 2.0, 3.0, 4.0, 5.0, 6.0), Vector6::new(-1.0, 0.0, 3.0, 0.0, 5.0, 2.0)];
        let noise = PoseNoise::new(&left, &nothing, &nothing, []);
        let expected = [1.0, 2.0, 9.0, 8.0, 25.0, 20.0];
        assert!((noise.variances() - Vector6::from(expected)).amax() < 1e-12, "{}", noise.variances());
    }

    /// Twelve poses with three parameters, whose moves are those of a fit in which the components do not count alike.
    fn fitted(counts: &Vector6<f64>) -> (Vec<DMatrix<f64>>, Vec<DMatrix<f64>>) {
        let slope = |i: usize| DMatrix::from_fn(6, 3, |a, k| ((7 * i + 3 * a + 5 * k) as f64).sin());
        let slopes: Vec<_> = (0..12).map(slope).collect();
        let weighted: Vec<_> = slopes.iter().map(|slope| in_units(slope, counts)).collect();
        let gram = slopes.iter().zip(&weighted).fold(DMatrix::zeros(3, 3), |sum, (d, w)| sum + d.tr_mul(w));
        let inverse = gram.try_inverse().unwrap();
        let moves = weighted.iter().map(|weighted| weighted * &inverse).collect();
        (slopes, moves)
    }

    fn left(slopes: &[DMatrix<f64>], moves: &[DMatrix<f64>], errors: &[Vector6<f64>]) -> Vec<Vector6<f64>> {
        let moved =
            moves.iter().zip(errors).fold(DVector::zeros(3), |sum, (by, error)| sum + by.tr_mul(error));
        slopes.iter().zip(errors).map(|(slope, error)| error - slope * &moved).collect()
    }

    /// Errors of independent sources, each by itself, leave products whose sum is the mean of what noise leaves: the form
    /// of that gives the form of the noise, whatever its covariance.
    #[test]
    fn a_form_of_what_is_left_has_the_mean_of_the_form_of_the_noise() {
        let counts = Vector6::new(1.0, 0.3, 2.0, 0.7, 1.5, 1.0);
        let (slopes, moves) = fitted(&counts);
        let noise = PoseNoise::new(&vec![Vector6::from_element(1.0); 12], &slopes, &moves, []);
        let root = Matrix6::from_fn(|a, b| if a == b { 1.0 + a as f64 } else { ((a + 4 * b) as f64).cos() });
        let mut mean = Matrix6::zeros();
        for (pose, source) in (0..12).flat_map(|pose| (0..6).map(move |source| (pose, source))) {
            let mut errors = vec![Vector6::zeros(); 12];
            errors[pose] = root.column(source).into_owned();
            for left in left(&slopes, &moves, &errors) {
                mean += left * left.transpose();
            }
        }
        let form = Matrix6::from_fn(|a, b| ((a * b + a + b) as f64).sin());
        let found = Symmetric::applied(&noise.unbiased, &form).dot(&mean);
        let expected = form.dot(&(root * root.transpose()));
        assert!((found / expected - 1.0).abs() < 1e-10, "{found} {expected}");
    }

    /// The variance of a form, by the covariance of all that is left written out.
    #[test]
    fn the_variance_of_a_form_is_that_of_all_that_is_left() {
        let (slopes, moves) = fitted(&Vector6::new(1.0, 0.3, 2.0, 0.7, 1.5, 1.0));
        let root = Matrix6::from_fn(|a, b| if a == b { 1.0 + a as f64 } else { ((a + 4 * b) as f64).cos() });
        let covariance = root * root.transpose();
        let form = Matrix6::from_fn(|a, b| ((a * b + a + b) as f64).sin());
        let mut all = DMatrix::zeros(72, 72);
        for (pose, source) in (0..12).flat_map(|pose| (0..6).map(move |source| (pose, source))) {
            let mut errors = vec![Vector6::zeros(); 12];
            errors[pose] = root.column(source).into_owned();
            let left = left(&slopes, &moves, &errors);
            let left = DVector::from_iterator(72, left.iter().flat_map(|one| one.iter().copied()));
            all += &left * left.transpose();
        }
        let mut forms = DMatrix::zeros(72, 72);
        (0..12).for_each(|pose| forms.view_mut((6 * pose, 6 * pose), (6, 6)).copy_from(&form));
        let of_left = forms * all;
        let expected = 2.0 * (&of_left * &of_left).trace();
        let found = variance_of_form(&form, &covariance, &Derivatives::of(&slopes, &moves));
        assert!((found / expected - 1.0).abs() < 1e-10, "{found} {expected}");
    }

    /// Forces of which one is ten times as noisy count less for it, and no more surely than sixty poses tell.
    #[test]
    fn noisy_components_count_less() {
        let nothing = vec![DMatrix::zeros(6, 1); 60];
        let error = |i: usize, a: usize| (i as f64 * (0.9 + 0.37 * a as f64)).sin();
        let left: Vec<_> = (0..60)
            .map(|i| Vector6::from_fn(|a, _| if a == 1 { 10.0 * error(i, a) } else { error(i, a) }))
            .collect();
        let (weights, doubts) = PoseNoise::new(&left, &nothing, &nothing, []).weights();
        for (a, weight) in weights.iter().enumerate() {
            // The mean of three logarithms is that of the noise of 10^(2/3).
            let expected = if a == 1 { 10_f64.powf(-4.0 / 3.0) } else { 10_f64.powf(2.0 / 3.0) };
            let expected = if a < 3 { expected } else { 1.0 };
            assert!((weight / expected - 1.0).abs() < 0.2, "{a}: {weight} {expected}");
        }
        // One step, between the two quiet ones and the other, of sixty degrees of freedom on each side.
        assert_eq!(doubts.len(), 1);
        assert!((doubts[0].direction - Vector6::new(1.0, -2.0, 1.0, 0.0, 0.0, 0.0) / 3.0).amax() < 1e-12);
        assert!(doubts[0].variance < 4.0 / 60.0 && doubts[0].variance > 3.0 / 60.0, "{}", doubts[0].variance);
    }

    /// A component of no noise has none beside others either, and spoils no other.
    #[test]
    fn a_component_without_noise_is_no_trouble() {
        let mut found = Matrix6::from_fn(|a, b| if a == b { 4.0 } else { 1.0 });
        found.fill_row(2, 0.0);
        found.fill_column(2, 0.0);
        let kept = positive(&found, &found, &Vector6::repeat(3.0));
        assert!((kept - found).amax() < 1e-12, "{kept}");
    }
}
