//! What every friction limit can tell.

use fingertip_wrench::{ContactForce, Real};

/// How far a contact force is from slipping.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SlipMargin<T> {
    /// Signed distance to the friction limit \[N\], positive while the contact holds: the least
    /// change of the contact force, in the norm that the model states, that makes it slip.
    pub newtons: T,
    /// How much of the limit is used: 0 without tangential load, 1 at slip. The largest number of
    /// the type where there is no normal force to hold the load.
    pub utilisation: T,
}

/// A limit that the contact force cannot pass without slipping.
///
/// # For users
/// Both calls are total: for a contact that does not press, the margin is negative (or zero) and
/// the utilisation saturates. Input that is not finite gives a margin of minus the largest number.
pub trait FrictionModel<T: Real> {
    /// How far the force is from the limit.
    fn slip_margin(&self, force: &ContactForce<T>) -> SlipMargin<T>;

    /// The least normal force \[N\] that holds the tangential force and spin torque with a safety
    /// factor of at least `safety` on the friction limit; saturates at the largest number.
    fn least_normal_force(&self, force: &ContactForce<T>, safety: T) -> T;
}

impl<T: Real, M: FrictionModel<T> + ?Sized> FrictionModel<T> for &M {
    #[inline]
    fn slip_margin(&self, force: &ContactForce<T>) -> SlipMargin<T> {
        (**self).slip_margin(force)
    }

    #[inline]
    fn least_normal_force(&self, force: &ContactForce<T>, safety: T) -> T {
        (**self).least_normal_force(force, safety)
    }
}
