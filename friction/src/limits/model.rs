//! What every friction limit can tell.

use fingertip_wrench::{ContactForce, Real};
use nalgebra::Vector3;

/// How far a contact force is from slipping.
///
/// ```
/// use fingertip_friction::{Coulomb, FrictionModel, SlipMargin};
/// use fingertip_wrench::ContactForce;
/// use nalgebra::Vector3;
///
/// let force = ContactForce::new(2.0, Vector3::new(0.5, 0.0, 0.0), 0.0); // 2 N of push, 0.5 N sideways
/// let SlipMargin { newtons, utilisation } = Coulomb::new(0.5)?.slip_margin(&force);
/// assert!(newtons > 0.4 && utilisation < 1.0); // it holds
/// # Ok::<(), fingertip_friction::BadParameter>(())
/// ```
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

impl<T: Real> SlipMargin<T> {
    /// What a force that is not finite gets.
    pub(crate) fn unknown() -> Self {
        Self { newtons: -T::GREATEST, utilisation: T::GREATEST }
    }
}

/// Which way the fingertip slides over the object once it slips.
///
/// By maximum dissipation this is the inward normal of the limit surface in the space of
/// tangential force and spin torque. It is scaled so that `|velocity|² + (arm·spin)² = 1`, where
/// the arm is the model's ratio of the greatest spin torque to the greatest tangential force (zero
/// spin for a model without one).
///
/// ```
/// use fingertip_friction::{Coulomb, FrictionLimit};
/// use fingertip_wrench::ContactForce;
/// use nalgebra::Vector3;
///
/// let force = ContactForce::new(2.0, Vector3::new(0.5, 0.0, 0.0), 0.0); // 2 N of push, 0.5 N sideways
/// let slip = Coulomb::new(0.1)?.slip_direction(&force);
/// // Friction pulls the fingertip along x, so it slides against x.
/// assert!(slip.is_some_and(|slip| slip.velocity.x < 0.0 && slip.spin == 0.0));
/// # Ok::<(), fingertip_friction::BadParameter>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>"))
)]
pub struct SlipDirection<T: Real> {
    /// Direction of the sliding velocity of the fingertip relative to the object, in the frame of
    /// the contact force.
    pub velocity: Vector3<T>,
    /// Spin about the outward normal that goes with it \[1/m\].
    pub spin: T,
}

/// A limit that the contact force cannot pass without slipping.
///
/// # For users
/// Both calls are total: for a contact that does not press, the margin is negative (or zero) and
/// the utilisation saturates. Input that is not finite gives a margin of minus the largest number.
///
/// # For implementers
/// With the feature `testing`, `testing::model_laws` tries a model of your own.
///
/// ```
/// use fingertip_friction::{Coulomb, FrictionModel, SoftFingerLimit};
/// use fingertip_wrench::ContactForce;
/// use nalgebra::Vector3;
///
/// fn grip(limit: &dyn FrictionModel<f64>, force: &ContactForce<f64>) -> f64 {
///     limit.least_normal_force(force, 1.5)
/// }
///
/// let force = ContactForce::new(2.0, Vector3::new(0.5, 0.0, 0.0), 1e-3);
/// // A limit that knows the spin torque asks for more.
/// assert!(grip(&SoftFingerLimit::new(0.5, 3e-3)?, &force) > grip(&Coulomb::new(0.5)?, &force));
/// # Ok::<(), fingertip_friction::BadParameter>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is no friction model of `{T}`",
    note = "take a limit as `Coulomb`, or implement `FrictionModel`: `slip_margin` and `least_normal_force`; its scalar must be that of the contact force"
)]
pub trait FrictionModel<T: Real> {
    /// How far the force is from the limit.
    fn slip_margin(&self, force: &ContactForce<T>) -> SlipMargin<T>;

    /// The least normal force \[N\] that holds the tangential force and spin torque with a safety
    /// factor of at least `safety` on the friction limit; saturates at the largest number.
    fn least_normal_force(&self, force: &ContactForce<T>, safety: T) -> T;
}

/// A friction limit that knows its own shape: membership, factor of safety, projection and the
/// direction of slip.
///
/// # For implementers
/// [`project`](Self::project) must return a force inside the limit (to rounding), and the force
/// itself where it holds already; what is not finite, or cannot be held by any pressing force,
/// becomes no force.
///
/// ```
/// use fingertip_friction::{Coulomb, FrictionLimit};
/// use fingertip_wrench::ContactForce;
/// use nalgebra::Vector3;
///
/// let force = ContactForce::new(2.0, Vector3::new(0.5, 0.0, 0.0), 0.0); // 2 N of push, 0.5 N sideways
/// assert!(Coulomb::new(0.5)?.holds(&force) && !Coulomb::new(0.2)?.holds(&force));
/// # Ok::<(), fingertip_friction::BadParameter>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` does not know the shape of its friction limit in `{T}`",
    note = "a model of your own implements `FrictionLimit` beside `FrictionModel`: `normal_force_keeping`, `project` and `slip_direction`"
)]
pub trait FrictionLimit<T: Real>: FrictionModel<T> {
    /// `true` if the contact holds, the limit included.
    #[inline]
    fn holds(&self, force: &ContactForce<T>) -> bool {
        self.slip_margin(force).newtons >= T::zero()
    }

    /// How many times the tangential load could grow before it slips; saturates at the largest
    /// number without load, 0 without a pressing normal force.
    #[inline]
    fn factor_of_safety(&self, force: &ContactForce<T>) -> T {
        let used = self.slip_margin(force).utilisation;
        if used >= T::GREATEST {
            T::zero()
        } else if used > T::one() / T::GREATEST {
            (T::one() / used).min(T::GREATEST)
        } else {
            T::GREATEST
        }
    }

    /// The least normal force \[N\] at which the margin is at least `margin` newtons; saturates at
    /// the largest number. A negative margin counts as none.
    fn normal_force_keeping(&self, force: &ContactForce<T>, margin: T) -> T;

    /// The force of the limit nearest to `force`, in the norm of the margin.
    fn project(&self, force: &ContactForce<T>) -> ContactForce<T>;

    /// Which way it slides if it slips under this force; `None` without tangential load or where
    /// the force is not finite.
    fn slip_direction(&self, force: &ContactForce<T>) -> Option<SlipDirection<T>>;
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

impl<T: Real, M: FrictionLimit<T> + ?Sized> FrictionLimit<T> for &M {
    #[inline]
    fn normal_force_keeping(&self, force: &ContactForce<T>, margin: T) -> T {
        (**self).normal_force_keeping(force, margin)
    }

    #[inline]
    fn project(&self, force: &ContactForce<T>) -> ContactForce<T> {
        (**self).project(force)
    }

    #[inline]
    fn slip_direction(&self, force: &ContactForce<T>) -> Option<SlipDirection<T>> {
        (**self).slip_direction(force)
    }
}
