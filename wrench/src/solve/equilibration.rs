//! Rows and columns brought to the same size, without a rounding error.

use nalgebra::{Matrix6, Vector6};

use crate::Real;

/// A matrix `row · A · column` whose rows have their largest entry in \[1, 2), after the columns
/// had.
///
/// The scales are powers of two for binary types, so that scaling changes no digit of a solution
/// and a pivot can be compared with 1.
pub(crate) struct Equilibrated<T: Real> {
    pub(crate) matrix: Matrix6<T>,
    pub(crate) row: Vector6<T>,
    pub(crate) column: Vector6<T>,
}

impl<T: Real> Equilibrated<T> {
    pub(crate) fn new(original: &Matrix6<T>) -> Self {
        let mut matrix = *original;
        let (mut row, mut column) = (Vector6::zeros(), Vector6::zeros());
        for (mut entries, scale) in matrix.column_iter_mut().zip(column.iter_mut()) {
            *scale = entries.amax().normalising_factor();
            entries *= *scale;
        }
        for (mut entries, scale) in matrix.row_iter_mut().zip(row.iter_mut()) {
            *scale = entries.amax().normalising_factor();
            entries *= *scale;
        }
        Self { matrix, row, column }
    }
}
