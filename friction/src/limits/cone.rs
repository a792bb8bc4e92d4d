//! A friction cone `ρ ≤ μN` in the plane of tangential load ρ and normal force N.
//!
//! Whatever norm measures the tangential load, the distance of (load, N) to the cone in the norm
//! `√(ρ(δ)² + δN²)` is the plane distance below: a step that changes the load by `ρ(δ)` changes
//! its norm by no more than that, and a step along the load itself by just that.

use fingertip_wrench::{ContactForce, Real, scaled_length};

use crate::bad_parameter::positive;
use crate::{BadParameter, SlipMargin};

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cone<T> {
    /// μ.
    pub(crate) coefficient: T,
    /// `1/√(1+μ²)`: the cosine of the friction angle.
    pub(crate) cosine: T,
}

impl<T: Real> Cone<T> {
    pub(crate) fn new(coefficient: T) -> Result<Self, BadParameter> {
        let coefficient = positive(coefficient, "friction coefficient")?;
        // 1/hypot(1, μ), without overflow for a large μ.
        let cosine = if coefficient <= T::one() {
            T::one() / (T::one() + coefficient * coefficient).root()
        } else {
            let inverse = T::one() / coefficient;
            inverse / (T::one() + inverse * inverse).root()
        };
        Ok(Self { coefficient, cosine })
    }

    /// `load` is not negative, or NaN.
    #[inline]
    pub(crate) fn margin(&self, load: T, normal: T) -> SlipMargin<T> {
        let holding = self.coefficient * normal;
        let newtons = (holding - load) * self.cosine;
        let used = load / holding;
        if holding > T::zero() && newtons.is_number() {
            SlipMargin { newtons, utilisation: if used < T::GREATEST { used } else { T::GREATEST } }
        } else {
            self.margin_out_of_contact(load, normal)
        }
    }

    /// Where friction holds nothing, the contact not pressing or so little that the product with μ is
    /// zero; and where a number is out of range.
    #[cold]
    #[inline(never)]
    fn margin_out_of_contact(&self, load: T, normal: T) -> SlipMargin<T> {
        if self.coefficient * normal > T::zero() {
            // Where the ratio is not a number, the margin is not one either.
            return SlipMargin::unknown();
        }
        let newtons = if self.coefficient * load <= -normal {
            // The apex is nearest.
            -scaled_length(load, normal, T::zero())
        } else {
            (self.coefficient * normal - load) * self.cosine
        };
        let utilisation = if load <= T::zero() && normal >= T::zero() { T::zero() } else { T::GREATEST };
        if newtons.is_number() { SlipMargin { newtons, utilisation } } else { SlipMargin::unknown() }
    }

    #[inline]
    pub(crate) fn least_normal(&self, load: T, safety: T) -> T {
        // Divide first: the product may overflow where the result does not.
        saturated(load * (safety / self.coefficient))
    }

    #[inline]
    pub(crate) fn normal_keeping(&self, load: T, margin: T) -> T {
        saturated((load + margin.max(T::zero()) / self.cosine) / self.coefficient)
    }

    /// The factor for the tangential load and the normal force of the nearest point.
    #[inline]
    pub(crate) fn project(&self, load: T, normal: T) -> Option<(T, T)> {
        if !(load.is_number() && normal.is_number()) || self.coefficient * load <= -normal {
            return None;
        }
        if load <= self.coefficient * normal {
            return Some((T::one(), normal));
        }
        let nearest = (self.coefficient * load + normal) * self.cosine * self.cosine;
        let factor = self.coefficient * (nearest / load);
        (nearest.is_number() && factor.is_number()).then_some((factor.min(T::one()), nearest))
    }
}

#[inline]
pub(crate) fn saturated<T: Real>(force: T) -> T {
    if force.is_number() { force.max(T::zero()) } else { T::GREATEST }
}

/// `√(a² + b²)` without over- or underflow between.
#[inline]
pub(crate) fn hypot<T: Real>(a: T, b: T) -> T {
    let squared = a * a + b * b;
    // Above the least normal number, what a square has lost by underflow is below the rounding of the sum.
    if squared >= T::LEAST_NORMAL && squared <= T::GREATEST {
        squared.root()
    } else {
        scaled_length(a, b, T::zero())
    }
}

/// The force with its tangential load times `factor` and another normal force.
#[inline]
pub(crate) fn rescaled<T: Real>(force: &ContactForce<T>, target: Option<(T, T)>) -> ContactForce<T> {
    match target {
        Some((factor, normal)) => {
            ContactForce { normal, tangential: force.tangential.scaled(factor), spin: force.spin * factor }
        }
        None => ContactForce::zero(),
    }
}
