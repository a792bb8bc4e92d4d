//! Dry friction of a point contact.

use fingertip_wrench::{ContactForce, Real, stored};

use crate::limits::cone::{Cone, rescaled};
use crate::{BadParameter, FrictionLimit, FrictionModel, SlipDirection, SlipMargin};

/// Coulomb's cone `|f_t| ≤ μ f_n` (`docs/theory/friction.md#coulombs-cone`). The spin torque is not limited:
/// a point contact carries none.
///
/// The margin is the signed Euclidean distance of the contact force to the cone:
/// `(μ f_n − |f_t|)/√(1+μ²)`, and minus the length of the force where the apex is nearest.
///
/// ```
/// use fingertip_friction::{Coulomb, FrictionModel};
/// use fingertip_wrench::ContactForce;
/// use nalgebra::Vector3;
///
/// let force = ContactForce::new(2.0, Vector3::new(0.5, 0.0, 0.0), 0.0); // 2 N of push, 0.5 N sideways
/// let margin = Coulomb::new(0.5)?.slip_margin(&force);
/// assert!((margin.utilisation - 0.5_f64).abs() < 1e-12); // half of what friction holds is used
/// # Ok::<(), fingertip_friction::BadParameter>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coulomb<T: Real> {
    cone: Cone<T>,
}

impl<T: Real> Coulomb<T> {
    /// From the friction coefficient μ.
    ///
    /// # Errors
    /// [`BadParameter`] unless μ is positive and finite.
    pub fn new(coefficient: T) -> Result<Self, BadParameter> {
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
        let angle =
            self.cone.coefficient.arctangent() - force.tangential_magnitude().arctangent2(force.normal);
        if angle.is_number() { angle } else { -T::frac_pi_2() }
    }

    /// [`slip_margin`](FrictionModel::slip_margin) of many contacts at once, as columns, which the
    /// compiler vectorises: from normal forces \[N\] and the magnitudes of tangential forces \[N\], the
    /// margins \[N\] and utilisations. Of columns of different lengths, the shortest counts.
    ///
    /// The answers are those of [`margin_of`](Self::margin_of).
    #[inline(always)]
    pub fn slip_margins(&self, normal: &[T], tangential: &[T], newtons: &mut [T], utilisation: &mut [T]) {
        let answers = newtons.iter_mut().zip(utilisation);
        for ((&normal, &load), (newtons, utilisation)) in normal.iter().zip(tangential).zip(answers) {
            (*newtons, *utilisation) = self.margin_of(normal, load);
        }
    }

    /// [`slip_margin`](FrictionModel::slip_margin) without a branch, for loops over many contacts: from
    /// normal force \[N\] and magnitude of the tangential force \[N\], margin \[N\] and utilisation.
    ///
    /// The answers are the same, except for a negative normal force, which no contact has: it is answered
    /// like a force that is not finite.
    #[inline(always)]
    #[must_use]
    pub fn margin_of(&self, normal: T, load: T) -> (T, T) {
        let (margin, used, ordinary) = self.margin_in_contact(normal, load);
        let known = (normal >= T::zero()) & (load >= T::zero()) & (margin.abs() <= T::GREATEST);
        let idle = known & (load <= T::zero());
        let used = if known & ordinary & (normal > T::zero()) { used } else { T::GREATEST };
        (if known { margin } else { -T::GREATEST }, if idle { T::zero() } else { used })
    }

    /// Margin \[N\] and utilisation of a contact with a positive normal force, and whether they can be
    /// used: `false` where friction holds nothing or a number is out of range.
    /// [`margin_of`](Self::margin_of) answers those cases too.
    #[inline(always)]
    #[must_use]
    pub fn margin_in_contact(&self, normal: T, load: T) -> (T, T, bool) {
        let Cone { coefficient, cosine } = self.cone;
        let holding = coefficient * normal;
        let used = load / holding;
        // False for a quotient with zero, NaN or infinity in it, as NaN and infinity are not less.
        let ordinary = (holding <= T::GREATEST) & (used < T::GREATEST);
        ((holding - load) * cosine, used, ordinary)
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
        let velocity = -(force.tangential.vector() * scale) / (magnitude * scale);
        // Without a load the quotient is not a number.
        let known = force.is_finite() && velocity.iter().all(|x| x.is_number());
        known.then_some(SlipDirection { velocity, spin: T::zero() })
    }
}

stored! {
    Coulomb<T>, [T: Real],
    |model| { coefficient: T = model.coefficient() },
    Self::new(coefficient)
}

#[cfg(test)]
mod tests {
    use fingertip_wrench::{ContactForce, Real};
    use nalgebra::Vector3;
    use proptest::prelude::*;

    use super::Coulomb;
    use crate::FrictionModel;

    fn columns_say_what_samples_say<T: Real>(coefficient: f64, forces: &[(T, T)]) {
        let Ok(model) = Coulomb::new(T::literal(coefficient)) else { return };
        let (normal, tangential): (Vec<T>, Vec<T>) = forces.iter().copied().unzip();
        let (mut newtons, mut used) = (vec![T::one(); forces.len()], vec![T::one(); forces.len()]);
        model.slip_margins(&normal, &tangential, &mut newtons, &mut used);
        for (k, &(normal, tangential)) in forces.iter().enumerate() {
            let force = ContactForce::new(
                if normal >= T::zero() { normal } else { T::GREATEST + T::GREATEST },
                Vector3::new(tangential, T::zero(), T::zero()),
                T::zero(),
            );
            let one = model.slip_margin(&force);
            // The length of a vector along an axis is exact in the normal range; so is all the rest.
            assert!(
                (newtons[k] - one.newtons).abs() <= T::LEAST_NORMAL && used[k] == one.utilisation,
                "{normal} {tangential}: {} {} instead of {one:?}",
                newtons[k],
                used[k]
            );
        }
    }

    proptest! {
        #[test]
        fn columns_are_as_single_samples(
            coefficient in 1e-3..10.0,
            forces in prop::collection::vec((any::<f64>(), any::<f64>()), 1..40),
        ) {
            let ends = [(0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (f64::NAN, 1.0), (1.0, f64::NAN),
                (f64::INFINITY, 1.0), (1.0, f64::INFINITY), (-1.0, 1.0), (-0.0, 1.0), (-0.0, 0.0),
                (f64::MAX, f64::MAX), (1e-310, 1.0)];
            let forces: Vec<_> = forces.into_iter().chain(ends).map(|(n, t)| (n, t.abs())).collect();
            columns_say_what_samples_say::<f64>(coefficient, &forces);
            #[allow(clippy::cast_possible_truncation)]
            let single: Vec<_> = forces.iter().map(|&(n, t)| (n as f32, t as f32)).collect();
            columns_say_what_samples_say::<f32>(coefficient, &single);
        }
    }
}
