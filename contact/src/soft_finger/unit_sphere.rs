//! The closed form that every ellipsoid reduces to.

use fingertip_surfaces::ForceLine;
use fingertip_surfaces::numeric::twofold::{Twofold, dot};
use fingertip_wrench::Real;
use nalgebra::Vector3;

use crate::model::flat;

/// The soft-finger contact of a wrench `(f, m)` about the centre of the unit sphere:
/// `m = k c + c × f`, `|c| = 1`, `f·c < 0`.
///
/// Bicchi, Salisbury & Brock (1990, 1993) found `k` as the root of a quadratic and `c` as a
/// rational function with `k` in its denominator, which loses half of the digits by `|k| = 1e-8`
/// and all of them at zero. With the second unknown `h = f·c = (f·m)/k` the same solution is
/// (`docs/theory/contact.md#central-quadrics`)
///
/// ```text
/// σ = |m|² − |f|²,  ρ = √(σ² + 4(f·m)²)
/// σ ≥ 0:  k² = (σ + ρ)/2,  h = (f·m)/k          σ < 0:  h² = (ρ − σ)/2,  k = (f·m)/h
/// c = (k m + f × m + h f) / (k² + |f|²),        h < 0,        k² + |f|² = (ρ + |m|² + |f|²)/2
/// ```
///
/// which divides by nothing that is small: a spin torque of zero is an ordinary case.
pub(crate) struct OnUnitSphere<T: Real> {
    /// `k`.
    pub(crate) spin: T,
    /// `|h|`.
    along: T,
    /// `c` times `k² + |f|²`, and the reciprocal of that.
    stretched: Vector3<T>,
    inverse: T,
    /// `|m|² + |f|²`.
    squares: T,
    /// The line of action passes the sphere by or touches it.
    misses: bool,
}

/// The two unknowns of a contact on the unit sphere, and on the quadrics `rᵀDr = 1` with ones and noughts in `D`.
pub(crate) struct Parted<T: Real> {
    /// `k`.
    pub(crate) spin: T,
    /// `|h|`.
    pub(crate) along: T,
    /// Of what the place is stretched by, `k² det D + fᵀDf`.
    pub(crate) inverse: T,
    /// `mᵀ adj(D) m + fᵀDf`.
    pub(crate) squares: T,
    /// The line of action passes the quadric by or touches it.
    pub(crate) misses: bool,
}

impl<T: Real> Parted<T> {
    /// With `fᵀDf` and `mᵀ adj(D) m`, `σ` apart from them, `f·m` and `det D`
    /// (`docs/theory/contact.md#central-quadrics`).
    #[inline(always)]
    pub(crate) fn new([force, torque]: [T; 2], sigma: T, power: T, determinant: T) -> Self {
        let half = T::literal(0.5);
        let (squares, twice) = (force + torque, (power + power) * determinant);
        let root = (sigma * sigma + twice * twice).root();
        // k² det D + fᵀDf = (ρ + mᵀ adj(D) m + fᵀDf)/2, which does not wait for k.
        let inverse = T::one() / ((root + squares) * half);
        let larger = ((root + sigma.abs()) * half).root();
        let smaller = power.abs() / larger;
        let misses = sigma >= T::zero();
        // Without a branch, which no one could predict. No spin torque bends a line back to a cylinder, det D = 0.
        let (spin, along) = if misses { (larger, smaller * determinant) } else { (smaller, larger) };
        Self { spin: spin.copysign(-power), along, inverse, squares, misses }
    }
}

/// Whether fourth powers are in range, and the force presses at no so flat an angle that rounding errors grow more than
/// threefold. False for a NaN.
#[inline(always)]
pub(crate) fn is_steep<T: Real>(squares: T, along: T, force_squared: T) -> bool {
    let fourth = squares * squares;
    let in_range = (fourth >= ForceLine::least_squared()) & (fourth <= T::GREATEST);
    in_range & (along * along >= flat::<T>().whole_power(2) * force_squared)
}

impl<T: Real> OnUnitSphere<T> {
    /// For a force and a torque of which the larger is tame, so that fourth powers stay in range; it
    /// must not be zero, and the force must not be. `force` is `|f|²`, `power` is `f·m`, which may
    /// be known better than from the two vectors.
    // Called, it costs as much again as it computes, for what it returns does not fit into registers.
    #[inline(always)]
    pub(crate) fn new(f: &Vector3<T>, m: &Vector3<T>, force: T, power: T) -> Self {
        let torque = m.norm_squared();
        Self::with_difference(f, m, [force, torque], torque - force, power)
    }

    /// The same from numbers with twice the digits. Where the force grazes `|m|` is nearly `|f|`: what rounding leaves of
    /// the digits of `σ` is divided by the square of the cosine of incidence, and all else keeps its own.
    #[inline(never)]
    pub(crate) fn finely(f: [Twofold<T>; 3], m: [Twofold<T>; 3], power: Twofold<T>) -> Self {
        let (force, torque) = (dot(f, f), dot(m, m));
        let (f, m) = (Vector3::from(f.map(Twofold::value)), Vector3::from(m.map(Twofold::value)));
        let squares = [force.value(), torque.value()];
        Self::with_difference(&f, &m, squares, torque.minus(force).value(), power.value())
    }

    /// With `|f|²` and `|m|²`, and `σ` apart from them.
    #[inline(always)]
    fn with_difference(f: &Vector3<T>, m: &Vector3<T>, [force, torque]: [T; 2], sigma: T, power: T) -> Self {
        let Parted { spin, along, inverse, squares, misses } =
            Parted::new([force, torque], sigma, power, T::one());
        let stretched = m * spin + f.cross(m) - f * along;
        Self { spin, along, stretched, inverse, squares, misses }
    }

    /// The same in the range that a shortcut is for: `None` where fourth powers over- or underflow,
    /// where the force presses at so flat an angle that rounding errors grow more than threefold, and
    /// where a number is NaN.
    #[inline(always)]
    pub(crate) fn steep(f: &Vector3<T>, m: &Vector3<T>, force: T, power: T) -> Option<Self> {
        let solved = Self::new(f, m, force, power);
        is_steep(solved.squares, solved.along, force).then_some(solved)
    }

    /// `c`: point and normal at once.
    #[inline(always)]
    pub(crate) fn point(&self) -> Vector3<T> {
        self.stretched * self.inverse
    }

    /// The pair of points that a pure force whose line misses could only graze, with equal and
    /// opposite spin torques; the same point twice if the line touches.
    ///
    /// The sign of `f·m` tells one point of the pair from the other. Half a unit in the last place of
    /// every component of the wrench changes `f·m` by up to `ε|f||m|`, and the sum of its products
    /// rounds about as much: below four times `ε`, that of the type in which the wrench was told, the cosine of incidence
    /// is zero for all that the numbers say. `whole` is that `|h|` of which the cosine would be 1: `|f|` on the sphere itself.
    ///
    /// # Errors
    /// The pair, where it is one.
    #[inline(always)]
    pub(crate) fn unless_grazing(
        self,
        f: &Vector3<T>,
        m: &Vector3<T>,
        whole: T,
        epsilon: T,
    ) -> Result<Self, [Vector3<T>; 2]> {
        let presses = self.along > epsilon * T::literal(4.0) * whole;
        if self.misses && !presses { Err(self.pair(f, m)) } else { Ok(self) }
    }

    #[cold]
    fn pair(&self, f: &Vector3<T>, m: &Vector3<T>) -> [Vector3<T>; 2] {
        let (cross, along) = (f.cross(m), m * self.spin);
        [(cross + along) * self.inverse, (cross - along) * self.inverse]
    }
}
