//! Sums over poses of products of their derivatives.

use nalgebra::{Const, DMatrix, Dyn, Matrix6, OMatrix, SMatrix, SVector};

/// Products of two derivatives of each pose, A and B, each 6 × parameters, summed over the poses: every entry with every
/// other. All sums `Σ_i A_iᵀ F B_i` and `Σ_i A_i M B_iᵀ` follow from it, however many poses there are.
pub(super) struct Products {
    /// One row for every two components, one column for every two parameters, of A the sooner.
    all: OMatrix<f64, Const<36>, Dyn>,
    parameters: usize,
}

impl Products {
    /// Of the derivatives of each pose with themselves.
    pub(super) fn of(derivatives: &[DMatrix<f64>]) -> Self {
        let all = side_by_side(derivatives);
        Self::of_columns(&all, &all)
    }

    /// Of two matrices with a column a pose.
    fn of_columns(left: &DMatrix<f64>, right: &DMatrix<f64>) -> Self {
        let by_entry = left * right.transpose();
        let parameters = by_entry.nrows() / 6;
        let mut all = OMatrix::<f64, Const<36>, Dyn>::zeros(parameters * parameters);
        for (place, mut column) in all.column_iter_mut().enumerate() {
            let (a, b) = (place % parameters, place / parameters);
            column.copy_from_slice(by_entry.fixed_view::<6, 6>(6 * a, 6 * b).into_owned().as_slice());
        }
        Self { all, parameters }
    }

    pub(super) fn parameters(&self) -> usize {
        self.parameters
    }

    /// `Σ_i A_iᵀ F B_i`.
    pub(super) fn around(&self, form: &Matrix6<f64>) -> DMatrix<f64> {
        let form = entries(form);
        let all = self.all.column_iter().map(|column| column.dot(&form));
        DMatrix::from_iterator(self.parameters, self.parameters, all)
    }

    /// `Σ_i A_i M B_iᵀ`.
    pub(super) fn between(&self, matrix: &DMatrix<f64>) -> Matrix6<f64> {
        let all = self.all.column_iter().zip(matrix.iter());
        let sum = all.fold(SVector::<f64, 36>::zeros(), |sum, (column, factor)| sum + column * *factor);
        Matrix6::from_column_slice(sum.as_slice())
    }

    /// `Σ_i A_i (Σ_j C_jᵀ F E_j) B_iᵀ` of the products of others, C and E, as a function of F.
    pub(super) fn between_those_around(
        &self,
        others: &Self,
    ) -> impl Fn(&Matrix6<f64>) -> Matrix6<f64> + use<> {
        let map: SMatrix<f64, 36, 36> = &self.all * others.all.transpose();
        move |form| Matrix6::from_column_slice((map * entries(form)).as_slice())
    }
}

/// All entries, column by column.
fn entries(form: &Matrix6<f64>) -> SVector<f64, 36> {
    SVector::from_column_slice(form.as_slice())
}

/// One column a pose, of all entries of its derivatives.
fn side_by_side(of: &[DMatrix<f64>]) -> DMatrix<f64> {
    let mut all = DMatrix::zeros(of.first().map_or(0, DMatrix::len), of.len());
    all.column_iter_mut().zip(of).for_each(|(mut column, one)| column.copy_from_slice(one.as_slice()));
    all
}

/// The derivatives of a fit to poses: `D_i` of the wrench of a pose by the parameters, and `P_i` of the parameters by its wrench.
pub(super) struct Derivatives {
    pub(super) poses: f64,
    /// `D` with `D`.
    pub(super) slopes: Products,
    /// `P` with `P`.
    pub(super) moves: Products,
    /// `P` with `D`.
    pub(super) across: Products,
}

impl Derivatives {
    pub(super) fn of(slopes: &[DMatrix<f64>], moves: &[DMatrix<f64>]) -> Self {
        let (d, p) = (side_by_side(slopes), side_by_side(moves));
        Self {
            poses: moves.len() as f64,
            slopes: Products::of_columns(&d, &d),
            moves: Products::of_columns(&p, &p),
            across: Products::of_columns(&p, &d),
        }
    }

    /// `H = Σ_i D_i P_iᵀ`: how much of the errors the fit takes up.
    pub(super) fn taken_up(&self) -> Matrix6<f64> {
        let size = self.across.parameters;
        self.across.between(&DMatrix::identity(size, size)).transpose()
    }
}
