//! How the deflection of dynamic friction is carried over a step.

use fingertip_wrench::Real;
use nalgebra::SVector;

use super::bristle::clamped;

/// How the deflection is carried over one step of constant velocity.
///
/// All three keep `|z| ≤ F_s/σ₀`, do not let two states of the same law part (for α = 1), and are
/// passive, for every step length (`docs/theory/friction.md#integrators`).
///
/// ```
/// use fingertip_friction::{Advanced, Bristle, Dahl, Integrator};
/// use fingertip_wrench::Real;
/// use nalgebra::{SVector, Vector1};
///
/// /// The trapezoidal rule, which is of second order.
/// #[derive(Clone, Copy)]
/// struct Trapezoid;
/// impl Integrator for Trapezoid {
///     fn advance<T: Real, const D: usize>(
///         deflection: &SVector<T, D>, step: &SVector<T, D>, slide: T, _limit: T,
///     ) -> Advanced<T, D> {
///         let half = slide * T::literal(0.5);
///         let end = (deflection * (T::one() - half) + step) / (T::one() + half);
///         Advanced { end, mean: (deflection + end) * T::literal(0.5) }
///     }
/// }
///
/// let mut friction = Bristle::<f64, _, 1, Trapezoid>::with_method(Dahl::new(1e5, 0.5)?);
/// friction.set_load(2.0);
/// let slid = (0..1000).map(|_| friction.step(&Vector1::new(0.01), 1e-4)).last().unwrap();
/// assert!((slid.end[0] - 1.0).abs() < 1e-9); // Coulomb's 0.5 times 2 N
/// # Ok::<(), fingertip_friction::BadParameter>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` does not integrate bristles",
    note = "take `Exponential`, `Implicit` or `ReturnMap`, or implement `Integrator::advance`"
)]
pub trait Integrator: Copy {
    /// The new deflection, and the mean deflection over the step. `step` is `hv`, `slide` is `hλ` with
    /// `λ = α σ₀|v|/g`, and `limit` is `g/σ₀`.
    fn advance<T: Real, const D: usize>(
        deflection: &SVector<T, D>,
        step: &SVector<T, D>,
        slide: T,
        limit: T,
    ) -> Advanced<T, D>;
}

/// What an [`Integrator`] makes of a deflection.
///
/// ```
/// use fingertip_friction::{Exponential, Integrator};
/// use nalgebra::Vector1;
///
/// // Far below the limit bristles bend by as much as the surfaces move: 1 µm, on average half of it.
/// let advanced = Exponential::advance(&Vector1::zeros(), &Vector1::new(1e-6_f64), 0.0, 1.0);
/// assert!((advanced.end[0] - 1e-6).abs() < 1e-20);
/// assert!((advanced.mean[0] - 0.5e-6).abs() < 1e-20);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Advanced<T: Real, const D: usize> {
    /// The deflection at the end of the step \[m\].
    pub end: SVector<T, D>,
    /// Its mean over the step \[m\]. It is the one with which the law's own balance holds over the step,
    /// `end − start = hv − hλ·mean`, while nothing is clamped.
    pub mean: SVector<T, D>,
}

/// Exact for a constant velocity and a constant `α`: `z⁺ = z e^{−λh} + v h φ₁(λh)`, and the mean
/// `z φ₁(λh) + v h φ₂(λh)`.
///
/// ```
/// use fingertip_friction::{Bristle, Dahl, Exponential};
/// use nalgebra::Vector1;
///
/// let mut friction = Bristle::<f64, _, 1, Exponential>::with_method(Dahl::new(1e5, 0.5)?);
/// friction.set_load(2.0);
/// for _ in 0..1000 {
///     assert!(friction.step(&Vector1::new(0.01), 1e-4).end[0] <= 1.0 + 1e-9);
/// }
/// # Ok::<(), fingertip_friction::BadParameter>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Exponential;

/// Backward Euler: `z⁺ = (z + hv)/(1 + hλ)`. First order, without an exponential. The mean that goes with it is `z⁺`.
///
/// ```
/// use fingertip_friction::{Bristle, Dahl, Implicit};
/// use nalgebra::Vector1;
///
/// let mut friction = Bristle::<f64, _, 1, Implicit>::with_method(Dahl::new(1e5, 0.5)?);
/// friction.set_load(2.0);
/// for _ in 0..1000 {
///     assert!(friction.step(&Vector1::new(0.01), 1e-4).end[0] <= 1.0 + 1e-9);
/// }
/// # Ok::<(), fingertip_friction::BadParameter>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Implicit;

/// The rate-independent limit: elastic up to `g/σ₀`, then slides along (radial return). The mean is taken for
/// `z⁺`: in this limit the deflection arrives at once.
///
/// ```
/// use fingertip_friction::{Bristle, Dahl, ReturnMap};
/// use nalgebra::Vector1;
///
/// let mut friction = Bristle::<f64, _, 1, ReturnMap>::with_method(Dahl::new(1e5, 0.5)?);
/// friction.set_load(2.0);
/// for _ in 0..1000 {
///     assert!(friction.step(&Vector1::new(0.01), 1e-4).end[0] <= 1.0 + 1e-9);
/// }
/// # Ok::<(), fingertip_friction::BadParameter>(())
/// ```
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
    ) -> Advanced<T, D> {
        // 1 − e^{−x}, and φ₁(x) = (1 − e^{−x})/x.
        let fall = -(-slide).exponential_less_one();
        let mean = if slide > T::LEAST_NORMAL { fall / slide } else { T::one() };
        let decay = T::one() - fall;
        Advanced {
            end: deflection * decay + step * mean,
            mean: deflection * mean + step * second(slide, mean),
        }
    }
}

impl Integrator for Implicit {
    #[inline]
    fn advance<T: Real, const D: usize>(
        deflection: &SVector<T, D>,
        step: &SVector<T, D>,
        slide: T,
        _limit: T,
    ) -> Advanced<T, D> {
        let end = (deflection + step) / (T::one() + slide);
        Advanced { end, mean: end }
    }
}

impl Integrator for ReturnMap {
    #[inline]
    fn advance<T: Real, const D: usize>(
        deflection: &SVector<T, D>,
        step: &SVector<T, D>,
        _slide: T,
        limit: T,
    ) -> Advanced<T, D> {
        let (moved, _) = clamped(deflection + step, limit);
        Advanced { end: moved, mean: moved }
    }
}

/// `φ₂(x) = (1 − φ₁(x))/x`, from `φ₁(x)`; by its series where that cancels.
#[inline]
fn second<T: Real>(x: T, first: T) -> T {
    if x > T::literal(1.0 / 64.0) {
        return (T::one() - first) / x;
    }
    let terms = [-1.0 / 5040.0, 1.0 / 720.0, -1.0 / 120.0, 1.0 / 24.0, -1.0 / 6.0, 0.5];
    terms.iter().fold(T::zero(), |sum, term| sum * x + T::literal(*term))
}
