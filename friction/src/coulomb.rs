//! Dry friction of a point contact.

use fingertip_wrench::{ContactForce, Real};
use thiserror::Error;

use crate::cone::{Cone, rescaled};
use crate::stored::stored;
use crate::{FrictionLimit, FrictionModel, SlipDirection, SlipMargin};

/// Coulomb's cone `|f_t| ≤ μ f_n` (theory 5). The spin torque is not limited: a point contact
/// carries none.
///
/// The margin is the signed Euclidean distance of the contact force to the cone:
/// `(μ f_n − |f_t|)/√(1+μ²)`, and minus the length of the force where the apex is nearest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coulomb<T: Real> {
    cone: Cone<T>,
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
        Ok(Self { cone: Cone::new(coefficient)? })
    }

    /// The friction coefficient μ.
    #[inline]
    #[must_use]
    pub const fn coefficient(&self) -> T {
        self.cone.coefficient
    }

    /// The friction angle minus the angle of the force \[rad\]: how far the force may still tilt.
    /// Minus π/2 for a force that is not finite.
    #[inline]
    #[must_use]
    pub fn angle_margin(&self, force: &ContactForce<T>) -> T {
        let angle = self.cone.coefficient.atan() - force.tangential_magnitude().atan2(force.normal);
        if angle.is_number() { angle } else { -T::frac_pi_2() }
    }
}

impl<T: Real> FrictionModel<T> for Coulomb<T> {
    #[inline]
    fn slip_margin(&self, force: &ContactForce<T>) -> SlipMargin<T> {
        self.cone.margin(force.tangential_magnitude(), force.normal)
    }

    #[inline]
    fn least_normal_force(&self, force: &ContactForce<T>, safety: T) -> T {
        self.cone.least_normal(force.tangential_magnitude(), safety)
    }
}

impl<T: Real> FrictionLimit<T> for Coulomb<T> {
    #[inline]
    fn normal_force_keeping(&self, force: &ContactForce<T>, margin: T) -> T {
        self.cone.normal_keeping(force.tangential_magnitude(), margin)
    }

    /// The spin torque is set to zero: a point contact carries none.
    #[inline]
    fn project(&self, force: &ContactForce<T>) -> ContactForce<T> {
        let target = self.cone.project(force.tangential_magnitude(), force.normal);
        ContactForce { spin: T::zero(), ..rescaled(force, target) }
    }

    #[inline]
    fn slip_direction(&self, force: &ContactForce<T>) -> Option<SlipDirection<T>> {
        let magnitude = force.tangential_magnitude();
        let scale = magnitude.normalising_factor();
        let velocity = -(force.tangential * scale) / (magnitude * scale);
        velocity.iter().all(|x| x.is_number()).then_some(SlipDirection { velocity, spin: T::zero() })
    }
}

stored! {
    Coulomb<T>, [T: Real],
    |model| { coefficient: T = model.coefficient() },
    Self::new(coefficient)
}
