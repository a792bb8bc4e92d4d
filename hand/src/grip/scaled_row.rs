//! A half-space of a contact in the scaled space of its cone.

use fingertip_wrench::Real;
use nalgebra::Vector4;

/// A half-space in the scaled space; all zero where there is none, with a slack and a price of one.
#[derive(Clone, Copy, Debug)]
pub(super) struct ScaledRow<T: Real> {
    /// `Fᵀ normal`.
    pub(super) normal: Vector4<T>,
    pub(super) bound: T,
    pub(super) slack: T,
    pub(super) price: T,
    /// `1/slack`, and `D = price/slack`.
    pub(super) inverse_slack: T,
    pub(super) stiffness: T,
    pub(super) residual: T,
    /// What is asked of the complementarity, `price dσ + slack dλ`.
    pub(super) target: T,
    /// `dσ` and `dλ`.
    pub(super) slack_along: T,
    pub(super) price_along: T,
}

impl<T: Real> ScaledRow<T> {
    pub(super) fn none() -> Self {
        let (zero, one) = (T::zero(), T::one());
        Self {
            normal: Vector4::zeros(),
            bound: zero,
            slack: one,
            price: one,
            inverse_slack: zero,
            stiffness: zero,
            residual: zero,
            target: zero,
            slack_along: zero,
            price_along: zero,
        }
    }
}
