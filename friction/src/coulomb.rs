//! Dry friction of a point contact.

use fingertip_wrench::{ContactForce, Real};
use thiserror::Error;

use crate::{FrictionModel, SlipMargin};

/// Coulomb's cone `|f_t| ≤ μ f_n` (theory 5). The spin torque is not limited: a point contact
/// carries none.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(
        try_from = "Parts<T>",
        into = "Parts<T>",
        bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>")
    )
)]
pub struct Coulomb<T: Real> {
    coefficient: T,
    /// `1/√(1+μ²)`: the cosine of the friction angle.
    cosine: T,
}

/// A parameter of a friction model is out of range.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("the {parameter} of a friction model must be {requirement}")]
pub struct BadFriction {
    /// Which parameter.
    pub parameter: &'static str,
    /// What it must be.
    pub requirement: &'static str,
}

impl<T: Real> Coulomb<T> {
    /// From the friction coefficient μ.
    ///
    /// # Errors
    /// [`BadFriction`] unless μ is positive and finite.
    pub fn new(coefficient: T) -> Result<Self, BadFriction> {
        if !(coefficient > T::zero() && coefficient.is_number()) {
            return Err(BadFriction {
                parameter: "friction coefficient",
                requirement: "positive and finite",
            });
        }
        // 1/hypot(1, μ), without overflow for a large μ.
        let cosine = if coefficient <= T::one() {
            T::one() / (T::one() + coefficient * coefficient).root()
        } else {
            let inverse = T::one() / coefficient;
            inverse / (T::one() + inverse * inverse).root()
        };
        Ok(Self { coefficient, cosine })
    }

    /// The friction coefficient μ.
    #[inline]
    #[must_use]
    pub const fn coefficient(&self) -> T {
        self.coefficient
    }
}

impl<T: Real> FrictionModel<T> for Coulomb<T> {
    /// `(μ f_n − |f_t|)/√(1+μ²)`: inside the cone the Euclidean distance of the contact force to
    /// its surface; outside never more than that distance.
    #[inline]
    fn slip_margin(&self, force: &ContactForce<T>) -> SlipMargin<T> {
        let tangential = force.tangential_magnitude();
        let holding = self.coefficient * force.normal;
        let newtons = (holding - tangential) * self.cosine;
        let utilisation = if tangential <= T::zero() && force.normal >= T::zero() {
            T::zero()
        } else if holding > T::zero() {
            (tangential / holding).min(T::GREATEST)
        } else {
            T::GREATEST
        };
        if newtons.is_number() && utilisation.is_number() {
            SlipMargin { newtons, utilisation }
        } else {
            SlipMargin { newtons: -T::GREATEST, utilisation: T::GREATEST }
        }
    }

    #[inline]
    fn least_normal_force(&self, force: &ContactForce<T>, safety: T) -> T {
        let needed = force.tangential_magnitude() * safety / self.coefficient;
        if needed.is_number() { needed } else { T::GREATEST }
    }
}

/// How the model is written in a file; reading one validates it again.
#[cfg(feature = "serde")]
#[derive(serde::Serialize, serde::Deserialize)]
struct Parts<T> {
    coefficient: T,
}

#[cfg(feature = "serde")]
impl<T: Real> From<Coulomb<T>> for Parts<T> {
    fn from(model: Coulomb<T>) -> Self {
        Self { coefficient: model.coefficient }
    }
}

#[cfg(feature = "serde")]
impl<T: Real> TryFrom<Parts<T>> for Coulomb<T> {
    type Error = BadFriction;
    fn try_from(parts: Parts<T>) -> Result<Self, BadFriction> {
        Self::new(parts.coefficient)
    }
}
