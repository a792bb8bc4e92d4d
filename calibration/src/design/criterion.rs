//! What makes one sensor better than another.

use nalgebra::{Matrix6, SymmetricEigen, Vector6};

use super::ContactWeight;

/// What the optimiser minimises. All criteria are functions of `A = CᵀC`, with `C` the sensor
/// matrix normalised by the nominal loads, and all are positive and smaller for a better sensor.
///
/// ```
/// use fingertip_calibration::design::{Criterion, gram};
/// use fingertip_calibration::nalgebra::{Matrix6, Vector6};
///
/// // Six gauges, one for each axis, of which the first gives four times the signal of the others.
/// let mut rows: [Vector6<f64>; 6] = core::array::from_fn(|i| Matrix6::identity().column(i).into_owned());
/// rows[0] *= 4.0;
/// let first = gram(&rows, &Vector6::repeat(1.0));
/// assert!((Criterion::ConditionNumber.of(&first) - 4.0).abs() < 1e-9);
/// // A sensor that is nearly blind to an axis is worse.
/// rows[1] *= 0.01;
/// let worse = gram(&rows, &Vector6::repeat(1.0));
/// assert!(Criterion::Trace.of(&worse) > Criterion::Trace.of(&first));
/// ```
#[derive(Clone, Debug, PartialEq)]
#[allow(clippy::large_enum_variant, reason = "there is one for a whole search")]
pub enum Criterion {
    /// `N_c = σ_max/σ_min` (Bicchi & Dario 1987): how much relative errors of signals and matrix can
    /// grow. Indifferent to the size of the strains.
    ConditionNumber,
    /// `det(CᵀC)^{-1/12}`, the reciprocal of the geometric mean of the singular values
    /// (D-optimality): the volume of the error ellipsoid.
    LogDeterminant,
    /// `√(tr(CᵀC)⁻¹)` (A-optimality): rms error of all components together, in nominal loads per
    /// unit noise of a channel.
    Trace,
    /// `max_j √((CᵀC)⁻¹_jj)`: error of the worst component, in nominal loads per unit noise of a
    /// channel; its reciprocal is the sensitivity of the worst axis.
    WorstAxis,
    /// `√(tr(W(CᵀC)⁻¹))`: rms error of the contact position \[m per unit noise of a channel\] over
    /// the touches in `W` (L-optimality): what the user of a fingertip wants in the end.
    ContactError(ContactWeight),
}

/// The least eigenvalue of `A` that counts, relative to the largest: below it is rounding.
const LEAST_RATIO: f64 = 1e-15;

/// `CᵀC` for rows of signal per unit load, normalised by nominal loads.
#[must_use]
pub fn gram(rows: &[Vector6<f64>], nominal: &Vector6<f64>) -> Matrix6<f64> {
    let mut gram = Matrix6::zeros();
    for row in rows {
        let row = row.component_mul(nominal);
        for j in 0..6 {
            for i in 0..=j {
                gram[(i, j)] += row[i] * row[j];
            }
        }
    }
    gram.fill_lower_triangle_with_upper_triangle();
    gram
}

/// Eigenvalues and vectors of `A`, made positive.
struct Spectrum {
    values: Vector6<f64>,
    vectors: Matrix6<f64>,
}

impl Spectrum {
    /// `None` if the matrix is zero or not finite.
    fn new(gram: &Matrix6<f64>) -> Option<Self> {
        let scale = gram.diagonal().amax();
        if !(scale > 0.0 && scale.is_finite()) || gram.iter().any(|x| !x.is_finite()) {
            return None;
        }
        let eigen = SymmetricEigen::new(gram / scale);
        let least = eigen.eigenvalues.max() * LEAST_RATIO;
        let values = eigen.eigenvalues.map(|value| value.max(least) * scale);
        values.iter().all(|value| *value > 0.0 && value.is_finite()).then_some(())?;
        Some(Self { values, vectors: eigen.eigenvectors })
    }

    /// `V·diag(f(λ))·Vᵀ`.
    fn function(&self, f: impl Fn(f64) -> f64) -> Matrix6<f64> {
        self.with_values(&self.values.map(f))
    }

    fn with_values(&self, values: &Vector6<f64>) -> Matrix6<f64> {
        self.vectors * Matrix6::from_diagonal(values) * self.vectors.transpose()
    }
}

/// `log Σ e^{x_i}` and the shares `e^{x_i}/Σ`.
fn soft_maximum(x: &Vector6<f64>) -> (f64, Vector6<f64>) {
    let largest = x.max();
    let shares = x.map(|value| (value - largest).exp());
    let sum = shares.sum();
    (largest + sum.ln(), shares / sum)
}

impl Criterion {
    /// The criterion, infinite for a matrix that is zero or not finite. From `CᵀC` it cannot tell
    /// condition numbers above about 3·10⁷ from each other, which is enough for a search; what is
    /// reported of a design ([`Assessment`](super::Assessment)) is computed from `C` itself.
    #[must_use]
    pub fn of(&self, gram: &Matrix6<f64>) -> f64 {
        let Some(spectrum) = Spectrum::new(gram) else { return f64::INFINITY };
        let values = &spectrum.values;
        match self {
            Self::ConditionNumber => (values.max() / values.min()).sqrt(),
            Self::LogDeterminant => (-values.map(f64::ln).sum() / 12.0).exp(),
            Self::Trace => values.map(f64::recip).sum().sqrt(),
            Self::WorstAxis => spectrum.function(f64::recip).diagonal().max().sqrt(),
            Self::ContactError(weight) => {
                weight.matrix().component_mul(&spectrum.function(f64::recip)).sum().sqrt()
            }
        }
    }

    /// `true` if the criterion has creases, where a maximum changes hands.
    #[must_use]
    pub fn has_creases(&self) -> bool {
        matches!(self, Self::ConditionNumber | Self::WorstAxis)
    }

    /// The logarithm of the criterion with every maximum replaced by a `power`-norm, and its
    /// derivative with respect to `A` (symmetric). It is smooth, at least the criterion, and at most
    /// `log 6/power` above it for the condition number (half of that for the worst axis).
    ///
    /// `None` for a matrix that is zero or not finite.
    #[must_use]
    pub fn smoothed(&self, gram: &Matrix6<f64>, power: f64) -> Option<(f64, Matrix6<f64>)> {
        let spectrum = Spectrum::new(gram)?;
        let values = &spectrum.values;
        Some(match self {
            Self::ConditionNumber => {
                let logarithms = values.map(f64::ln);
                let (largest, top) = soft_maximum(&(logarithms * power));
                let (least, bottom) = soft_maximum(&(logarithms * -power));
                let slopes = (top - bottom).component_div(values) * 0.5;
                ((largest + least) / (2.0 * power), spectrum.with_values(&slopes))
            }
            Self::LogDeterminant => {
                (-values.map(f64::ln).sum() / 12.0, spectrum.function(|value| -1.0 / (12.0 * value)))
            }
            Self::Trace => {
                let trace = values.map(f64::recip).sum();
                (0.5 * trace.ln(), spectrum.function(|value| -0.5 / (value * value * trace)))
            }
            Self::WorstAxis => {
                let inverse = spectrum.function(f64::recip);
                let variances = inverse.diagonal();
                let (largest, shares) = soft_maximum(&(variances.map(f64::ln) * power));
                let weights = Matrix6::from_diagonal(&shares.component_div(&variances));
                (largest / (2.0 * power), inverse * weights * inverse * -0.5)
            }
            Self::ContactError(weight) => {
                let inverse = spectrum.function(f64::recip);
                let squared = weight.matrix().component_mul(&inverse).sum();
                (0.5 * squared.ln(), inverse * weight.matrix() * inverse * (-0.5 / squared))
            }
        })
    }

    /// Its name for tables.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::ConditionNumber => "condition number",
            Self::LogDeterminant => "geometric mean noise",
            Self::Trace => "rms noise",
            Self::WorstAxis => "noise of the worst axis",
            Self::ContactError(_) => "contact position error",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Criterion, gram};
    use crate::design::ContactWeight;
    use crate::linear::Singular;
    use crate::testing::Largest as _;
    use nalgebra::{DMatrix, Matrix6, Vector6};
    use proptest::prelude::*;

    fn criteria() -> Vec<Criterion> {
        let weight = ContactWeight::on_sphere(13e-3, 60_f64.to_radians(), 0.5, 1.0)
            .unwrap()
            .normalised(&Vector6::new(10.0, 10.0, 10.0, 0.1, 0.1, 0.1));
        vec![
            Criterion::ConditionNumber,
            Criterion::LogDeterminant,
            Criterion::Trace,
            Criterion::WorstAxis,
            Criterion::ContactError(weight),
        ]
    }

    fn rows(entries: &[f64]) -> Vec<Vector6<f64>> {
        entries.chunks(6).map(Vector6::from_column_slice).collect()
    }

    proptest! {
        #[test]
        fn agree_with_their_definitions(entries in proptest::collection::vec(-1.0..1.0_f64, 48)) {
            let rows = rows(&entries);
            let a = gram(&rows, &Vector6::repeat(1.0));
            let matrix = DMatrix::from_fn(8, 6, |i, j| rows[i][j]);
            let sigma = Singular::new(&matrix).unwrap().values;
            let condition = sigma[0] / sigma[5];
            prop_assume!(condition < 1e3);
            let inverse = a.try_inverse().unwrap();
            let close = |x: f64, y: f64| (x - y).abs() <= 1e-12 * condition * condition * y.abs();
            prop_assert!(close(Criterion::ConditionNumber.of(&a), condition));
            prop_assert!(close(Criterion::LogDeterminant.of(&a), a.determinant().powf(-1.0 / 12.0)));
            prop_assert!(close(Criterion::Trace.of(&a), inverse.trace().sqrt()));
            prop_assert!(close(Criterion::WorstAxis.of(&a), inverse.diagonal().max().sqrt()));
        }

        #[test]
        fn slopes_agree_with_differences(
            entries in proptest::collection::vec(-1.0..1.0_f64, 48),
            change in proptest::collection::vec(-1.0..1.0_f64, 48), power in 1.0..30.0_f64,
        ) {
            let base = gram(&rows(&entries), &Vector6::repeat(1.0));
            let direction = rows(&change).iter().fold(Matrix6::zeros(), |sum, row| sum + row * row.transpose());
            for criterion in criteria() {
                prop_assume!(Criterion::ConditionNumber.of(&base) < 30.0);
                let at = |t: f64| criterion.smoothed(&(base + direction * t), power).unwrap();
                let step = 1e-5;
                let difference = (at(step).0 - at(-step).0) / (2.0 * step);
                let slope = at(0.0).1.component_mul(&direction).sum();
                let size = at(0.0).1.largest() * direction.largest() * 36.0;
                prop_assert!((slope - difference).abs() <= 1e-4 * size.max(1e-3), "{criterion:?} {slope} {difference}");
            }
        }

        #[test]
        fn smoothed_lies_above_and_within_its_bound(
            entries in proptest::collection::vec(-1.0..1.0_f64, 36), power in 1.0..100.0_f64,
        ) {
            let a = gram(&rows(&entries), &Vector6::repeat(1.0));
            for criterion in criteria() {
                let (smoothed, true_value) = (criterion.smoothed(&a, power).unwrap().0, criterion.of(&a).ln());
                let slack = if criterion.has_creases() { 6.0_f64.ln() / power } else { 0.0 };
                prop_assert!(smoothed >= true_value - 1e-9 && smoothed <= true_value + slack + 1e-9);
            }
        }
    }

    #[test]
    fn scaling_changes_them_as_it_must() {
        let mut a = Matrix6::identity() * 3.0;
        a[(0, 1)] = 1.0;
        a[(1, 0)] = 1.0;
        for scale in [1e-200, 1.0, 1e200] {
            for criterion in criteria() {
                let (one, scaled) = (criterion.of(&a), criterion.of(&(a * scale)));
                let factor = if criterion == Criterion::ConditionNumber { 1.0 } else { scale.sqrt() };
                assert!((scaled * factor / one - 1.0).abs() < 1e-12, "{criterion:?}");
            }
        }
    }

    #[test]
    fn bad_matrices_are_infinitely_bad() {
        for bad in [Matrix6::zeros(), Matrix6::repeat(f64::NAN), Matrix6::repeat(f64::INFINITY)] {
            for criterion in criteria() {
                assert_eq!(criterion.of(&bad), f64::INFINITY);
                assert!(criterion.smoothed(&bad, 8.0).is_none());
            }
        }
        let rank_one = Matrix6::repeat(1.0);
        for criterion in criteria() {
            assert!(criterion.of(&rank_one) > 1e3);
            assert!(criterion.smoothed(&rank_one, 1000.0).unwrap().0.is_finite());
        }
    }
}
