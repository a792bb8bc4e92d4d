//! One contact's share of the cone program.

use fingertip_wrench::Real;
use nalgebra::{Matrix6x4, Vector4, Vector6};

use crate::grip::cone::tail;
use crate::grip::interior::Interior;
use crate::grip::kernels::add_pull;

/// A half-space `normal·y ≤ bound` of a contact's forces.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row<T: Real> {
    pub(crate) normal: Vector4<T>,
    pub(crate) bound: T,
    /// Whether its normal is that of the row before, the other way: both are one direction to a step.
    pub(crate) opposite: bool,
}

/// What a contact can give: columns of the grasp map, what its normal force costs, half-spaces.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Block<T: Real, const ROWS: usize> {
    pub(crate) map: Matrix6x4<T>,
    pub(crate) cost: T,
    pub(crate) rows: [Option<Row<T>>; ROWS],
}

/// What an iterate misses of a block's equations.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Residual<T: Real, const ROWS: usize> {
    /// Of the dual: `Gᵀprice − mapᵀν − z + cost τ`.
    pub(crate) dual: Vector4<T>,
    /// Of the half-spaces: `slack + normal·y − bound τ`.
    pub(crate) rows: [T; ROWS],
}

impl<T: Real, const ROWS: usize> Residual<T, ROWS> {
    pub(crate) fn none() -> Self {
        Self { dual: Vector4::zeros(), rows: [T::zero(); ROWS] }
    }
}

impl<T: Real, const ROWS: usize> Block<T, ROWS> {
    /// The rows that are there, with what belongs to them.
    #[inline]
    pub(crate) fn with<'a, A>(&'a self, other: &'a [A; ROWS]) -> impl Iterator<Item = (&'a Row<T>, &'a A)> {
        self.rows.iter().zip(other).filter_map(|(row, a)| row.as_ref().map(|row| (row, a)))
    }

    /// How many rows there are.
    pub(crate) fn count(&self) -> usize {
        self.rows.iter().flatten().count()
    }

    /// `Σ bound·price`.
    #[inline]
    pub(crate) fn priced(&self, at: &Interior<T, ROWS>) -> T {
        self.with(&at.rows).fold(T::zero(), |sum, (row, pair)| sum + row.bound * pair.price)
    }

    /// `Gᵀprice − mapᵀν`, from `−ν`: what the dual cone must hold, but for the cost.
    #[inline]
    pub(crate) fn pull(&self, at: &Interior<T, ROWS>, against: &Vector6<T>) -> Vector4<T> {
        let mut pull = Vector4::zeros();
        add_pull(&self.map, against, &mut pull);
        self.with(&at.rows).fold(pull, |sum, (row, pair)| sum + row.normal * pair.price)
    }

    /// What is missing of the equations, from `−ν`.
    #[inline]
    pub(crate) fn residual(&self, at: &Interior<T, ROWS>, against: &Vector6<T>, tau: T) -> Residual<T, ROWS> {
        let mut dual = self.pull(at, against) - at.z;
        dual.x += self.cost * tau;
        let mut rows = [T::zero(); ROWS];
        for (residual, (row, pair)) in rows.iter_mut().zip(self.rows.iter().zip(&at.rows)) {
            if let Some(row) = row {
                *residual = row.normal.dot(&at.y) + pair.slack - row.bound * tau;
            }
        }
        Residual { dual, rows }
    }

    /// By how much the pull leaves the dual cone: no more than this and rounding.
    #[inline]
    pub(crate) fn violation(&self, pull: &Vector4<T>) -> T {
        (tail(pull) - pull.x).max(T::zero())
    }
}
