//! What a stream of samples tells of a least-squares problem.

use nalgebra::DMatrix;

use super::Singular;

/// What a [`Triangular`](super::Triangular) knows: `Σ x xᵀ = R11ᵀ R11`, `Σ x yᵀ = R11ᵀ R12`, and the residuals'
/// `Σ r rᵀ = R22ᵀ R22`.
///
/// ```
/// use fingertip_calibration::linear::{Factors, Triangular};
///
/// let mut triangular = Triangular::new(2, 1);
/// for volts in [0.0, 1.0, 2.0, 3.0] {
///     triangular.push(&[1.0, volts], &[0.5 + 3.0 * volts]);
/// }
/// let factors: Factors = triangular.factors();
/// let line = factors.coefficients()?;
/// assert!((line[0] - 0.5).abs() < 1e-12 && (line[1] - 3.0).abs() < 1e-12);
/// // (Σ x xᵀ)⁻¹ of these: 4, 6; 6, 14.
/// assert!((factors.inverse_gram()?[(1, 1)] - 0.2).abs() < 1e-12);
/// # Ok::<(), fingertip_calibration::linear::Unobserved>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Factors {
    /// R11, upper triangular, regressors × regressors.
    pub regressors: DMatrix<f64>,
    /// R12, regressors × responses.
    pub projected: DMatrix<f64>,
    /// R22, upper triangular, responses × responses.
    pub residual: DMatrix<f64>,
    /// How many samples stand behind them.
    pub samples: u64,
}

/// R11 with columns of unit norm, its inverse, and the norms.
struct Equilibrated {
    scaled: DMatrix<f64>,
    inverse: DMatrix<f64>,
    norms: Vec<f64>,
}

/// The regressors do not determine the coefficients.
///
/// ```
/// use fingertip_calibration::linear::{Triangular, Unobserved};
///
/// // Two gauges that always read the same cannot be told apart.
/// let mut triangular = Triangular::new(2, 1);
/// for volts in [1.0, 2.0, 3.0] {
///     triangular.push(&[volts, volts], &[3.0 * volts]);
/// }
/// let unobserved: Unobserved = triangular.factors().coefficients().unwrap_err();
/// // What was never seen is their difference.
/// let direction = unobserved.directions.column(0);
/// assert!((direction[0] + direction[1]).abs() < 1e-9 * direction.norm());
/// ```
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("the loads leave {} of {regressors} directions unobserved: {}", directions.ncols(), describe(directions, names))]
pub struct Unobserved {
    /// How many regressors there are.
    pub regressors: usize,
    /// An orthonormal basis of the unobserved combinations, one per column, of regressors scaled to
    /// unit size.
    pub directions: DMatrix<f64>,
    /// Names of the regressors, if known.
    pub names: Vec<String>,
}

impl Unobserved {
    /// The combinations in words.
    pub(crate) fn described(&self) -> String {
        describe(&self.directions, &self.names)
    }

    /// The first of the names with half of the largest part in any of them, or more.
    pub(crate) fn leading(&self) -> Option<&str> {
        let part = |name: usize| self.directions.row(name).amax();
        let most = self.directions.amax();
        (0..self.directions.nrows())
            .find(|name| part(*name) >= 0.5 * most)
            .and_then(|name| self.names.get(name))
            .map(String::as_str)
    }
}

/// "0.71 Fx − 0.71 Ty; Tz".
fn describe(directions: &DMatrix<f64>, names: &[String]) -> String {
    let one = |column: nalgebra::DVectorView<'_, f64>| {
        let mut terms = Vec::new();
        for (i, value) in column.iter().enumerate() {
            if value.abs() > 0.05 {
                let name = names.get(i).cloned().unwrap_or_else(|| format!("x{i}"));
                terms.push(if value.abs() > 0.999 { name } else { format!("{value:+.2} {name}") });
            }
        }
        terms.join(" ")
    };
    directions.column_iter().map(one).collect::<Vec<_>>().join("; ")
}

impl Factors {
    /// The least-squares coefficients, regressors × responses: `y ≈ xᵀ Θ`.
    ///
    /// # Errors
    /// [`Unobserved`] if the regressors are linearly dependent to working precision.
    pub fn coefficients(&self) -> Result<DMatrix<f64>, Unobserved> {
        let Equilibrated { scaled, norms, .. } = self.equilibrated()?;
        let mut coefficients = self.projected.clone();
        if !scaled.solve_upper_triangular_mut(&mut coefficients) {
            return Err(self.unobserved(usize::MAX));
        }
        for (mut row, norm) in coefficients.row_iter_mut().zip(&norms) {
            row /= *norm;
        }
        Ok(coefficients)
    }

    /// `(Σ x xᵀ)⁻¹`.
    ///
    /// # Errors
    /// [`Unobserved`].
    pub fn inverse_gram(&self) -> Result<DMatrix<f64>, Unobserved> {
        let root = self.inverse_root()?;
        Ok(&root * root.transpose())
    }

    /// `R11⁻¹`, upper triangular: `R11⁻¹ R11⁻ᵀ = (Σ x xᵀ)⁻¹`.
    ///
    /// # Errors
    /// [`Unobserved`].
    pub fn inverse_root(&self) -> Result<DMatrix<f64>, Unobserved> {
        let Equilibrated { mut inverse, norms, .. } = self.equilibrated()?;
        for (mut row, norm) in inverse.row_iter_mut().zip(&norms) {
            row /= *norm;
        }
        Ok(inverse)
    }

    /// Covariance of the responses' residuals, `R22ᵀR22 / (n − k)`; `None` without a degree of
    /// freedom to spare.
    #[must_use]
    pub fn residual_covariance(&self) -> Option<DMatrix<f64>> {
        let freedom = self.samples.checked_sub(self.regressors.nrows() as u64).filter(|f| *f > 0)?;
        Some(self.residual.transpose() * &self.residual / freedom as f64)
    }

    /// Condition number of the regressors, each scaled to unit size; infinite if they are dependent.
    #[must_use]
    pub fn condition_number(&self) -> f64 {
        self.singular().map_or(f64::INFINITY, |singular| singular.condition_number())
    }

    /// R11 with columns of unit norm, if they are independent.
    fn equilibrated(&self) -> Result<Equilibrated, Unobserved> {
        let (scaled, norms) = self.scaled();
        let size = scaled.nrows();
        let mut inverse = DMatrix::identity(size, size);
        let solved = scaled.solve_upper_triangular_mut(&mut inverse);
        // Frobenius norms bound the condition number from above, so that the singular values, which cost many
        // times as much, are only asked where the rank is in doubt.
        let condition = scaled.norm() * inverse.norm();
        if solved && condition * (size as f64) * f64::EPSILON < 1.0 {
            return Ok(Equilibrated { scaled, inverse, norms });
        }
        let rank = Singular::new(&scaled).map_or(0, |singular| singular.rank());
        if rank < size || !solved {
            return Err(self.unobserved(rank));
        }
        Ok(Equilibrated { scaled, inverse, norms })
    }

    fn scaled(&self) -> (DMatrix<f64>, Vec<f64>) {
        let mut scaled = self.regressors.clone();
        let mut norms = Vec::with_capacity(scaled.ncols());
        for mut column in scaled.column_iter_mut() {
            let largest = column.amax();
            let norm = if largest > 0.0 { column.map(|x| x / largest).norm() * largest } else { 1.0 };
            column.apply(|x| *x /= norm);
            norms.push(norm);
        }
        (scaled, norms)
    }

    fn singular(&self) -> Option<Singular> {
        Singular::new(&self.scaled().0)
    }

    fn unobserved(&self, rank: usize) -> Unobserved {
        let count = self.regressors.ncols();
        let directions = match self.singular() {
            Some(singular) => {
                let rank = rank.min(singular.rank()).min(count.saturating_sub(1));
                singular.right.columns(rank, count - rank).into_owned()
            }
            None => DMatrix::identity(count, count),
        };
        Unobserved { regressors: count, directions, names: Vec::new() }
    }
}
