//! The singular values of the grasp map, and the wrenches that go with them.

use fingertip_wrench::Real;
use fingertip_wrench::numeric::jacobi::{column_norm, orthogonalise};
use nalgebra::{Matrix6, Matrix6x4, Vector6};

use crate::triangle::add_row;

/// `A = Σ σ_i v_i u_iᵀ`: the part of it that lives in the space of wrenches.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spectrum<T: Real> {
    pub(crate) values: Vector6<T>,
    pub(crate) directions: Matrix6<T>,
}

impl<T: Real> Spectrum<T> {
    /// From the blocks of the map. `Aᵀ = QR` by Givens rotations, a row at a time, and then one-sided Jacobi on `R`:
    /// small values are right to rounding errors of the greatest, as those of `A Aᵀ` would not be.
    pub(crate) fn new(blocks: impl Iterator<Item = Matrix6x4<T>>) -> Self {
        let mut triangle = Matrix6::<T>::zeros();
        for block in blocks {
            for column in block.column_iter() {
                add_row(&mut triangle, column.transpose(), |_, _, _| ());
            }
        }
        let mut directions = Matrix6::identity();
        orthogonalise(&mut triangle, |turn, p, q| turn.apply(&mut directions, p, q));
        let values = Vector6::from_fn(|j, _| column_norm(&triangle, j));
        Self { values, directions }
    }

    /// Below this a singular value counts as zero: half the digits of the greatest, since places of contacts are
    /// never known better.
    pub(crate) fn threshold(&self) -> T {
        self.values.amax() * T::EPSILON.root()
    }

    /// How many wrenches the grasp can bear.
    pub(crate) fn rank(&self) -> usize {
        let threshold = self.threshold();
        self.values.iter().filter(|value| **value > threshold).count()
    }

    /// `(A Aᵀ)⁺ wrench`.
    pub(crate) fn pseudo_solve(&self, wrench: &Vector6<T>) -> Vector6<T> {
        let threshold = self.threshold();
        let mut sum = Vector6::zeros();
        for (value, direction) in self.values.iter().zip(self.directions.column_iter()) {
            if *value > threshold {
                sum += direction * (direction.dot(wrench) / *value / *value);
            }
        }
        sum
    }
}
