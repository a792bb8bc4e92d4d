//! How the deflection of dynamic friction is carried over a step.

use fingertip_wrench::Real;
use nalgebra::SVector;

use super::bristle::clamped;

/// How the deflection is carried over one step of constant velocity.
///
/// All three keep `|z| ≤ F_s/σ₀`, do not let two states of the same law part (for α = 1), and are
/// passive, for every step length (`docs/theory/friction.md#integrators`).
pub trait Integrator: Copy {
    /// The new deflection. `step` is `hv`, `slide` is `hλ` with
    /// `λ = α σ₀|v|/g`, and `limit` is `g/σ₀`.
    fn advance<T: Real, const D: usize>(
        deflection: &SVector<T, D>,
        step: &SVector<T, D>,
        slide: T,
        limit: T,
    ) -> SVector<T, D>;
}

/// Exact for a constant velocity: `z⁺ = z e^{−λh} + v h φ₁(λh)`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Exponential;

/// Backward Euler: `z⁺ = (z + hv)/(1 + hλ)`. First order, without an exponential.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Implicit;

/// The rate-independent limit: elastic up to `g/σ₀`, then slides along (radial return).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ReturnMap;

impl Integrator for Exponential {
    #[inline]
    fn advance<T: Real, const D: usize>(
        deflection: &SVector<T, D>,
        step: &SVector<T, D>,
        slide: T,
        _limit: T,
    ) -> SVector<T, D> {
        // 1 − e^{−x}, and φ₁(x) = (1 − e^{−x})/x.
        let fall = -(-slide).exp_m1();
        let mean = if slide > T::LEAST_NORMAL { fall / slide } else { T::one() };
        let decay = T::one() - fall;
        deflection * decay + step * mean
    }
}

impl Integrator for Implicit {
    #[inline]
    fn advance<T: Real, const D: usize>(
        deflection: &SVector<T, D>,
        step: &SVector<T, D>,
        slide: T,
        _limit: T,
    ) -> SVector<T, D> {
        (deflection + step) / (T::one() + slide)
    }
}

impl Integrator for ReturnMap {
    #[inline]
    fn advance<T: Real, const D: usize>(
        deflection: &SVector<T, D>,
        step: &SVector<T, D>,
        _slide: T,
        limit: T,
    ) -> SVector<T, D> {
        let (moved, _) = clamped(deflection + step, limit);
        moved
    }
}
