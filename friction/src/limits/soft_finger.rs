//! Friction of a soft finger: tangential force and spin torque share one limit.

use fingertip_wrench::{ContactForce, Real, stored};

use crate::bad_parameter::positive;
use crate::limits::cone::{Cone, hypot, rescaled};
use crate::{BadParameter, FrictionLimit, FrictionModel, PressureDistribution, SlipDirection, SlipMargin};

/// The elliptic soft-finger limit `|f_t|² + (τ/e)² ≤ (μ f_n)²` (Howe & Cutkosky 1996;
/// `docs/theory/friction.md#soft-finger-limit`).
///
/// The torque arm `e` is the greatest spin torque over the greatest tangential force: `3πa/16` for
/// Hertz pressure on a patch of radius `a`. The ellipse is up to 6.6 % too wide for the common
/// pressure distributions: use [`PowerLimit`], or [`conservative`](Self::conservative), where that
/// matters.
///
/// The margin is the signed distance in the norm `√(|δf_t|² + (δτ/e)² + δf_n²)`.
///
/// ```
/// use fingertip_friction::{FrictionLimit, SoftFingerLimit};
/// use fingertip_wrench::ContactForce;
/// use nalgebra::Vector3;
///
/// let tip = SoftFingerLimit::new(0.5, 3e-3)?; // μ, and greatest spin torque over greatest tangential force [m]
/// assert!(tip.holds(&ContactForce::new(2.0, Vector3::zeros(), 2.9e-3)));
/// assert!(!tip.holds(&ContactForce::new(2.0, Vector3::new(0.8, 0.0, 0.0), 2.9e-3)));
/// # Ok::<(), fingertip_friction::BadParameter>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SoftFingerLimit<T: Real> {
    cone: Cone<T>,
    arm: T,
}

/// The soft-finger limit `|f_t|^q + |τ/e|^q ≤ (μ f_n)^q`, within 1 % of the exact limit surface
/// with the exponent that [`PressureDistribution::limit_exponent`] gives
/// (`docs/theory/friction.md#power-limit`).
///
/// The margin is the signed distance in the norm `√((|δf_t|^q + |δτ/e|^q)^(2/q) + δf_n²)`, which
/// exceeds the Euclidean length of the same change by at most `2^(1/q−1/2)` (6 % at q = 1.72).
///
/// ```
/// use fingertip_friction::{FrictionLimit, PowerLimit, PressureDistribution};
/// use fingertip_wrench::ContactForce;
/// use nalgebra::Vector3;
///
/// let patch = PowerLimit::for_patch(0.5, 4e-3, PressureDistribution::Hertz)?;
/// assert!(patch.holds(&ContactForce::new(2.0, Vector3::new(0.6, 0.0, 0.0), 1e-3)));
/// # Ok::<(), fingertip_friction::BadParameter>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PowerLimit<T: Real> {
    cone: Cone<T>,
    arm: T,
    exponent: T,
}

impl<T: Real> SoftFingerLimit<T> {
    /// From the friction coefficient and the torque arm \[m\].
    ///
    /// # Errors
    /// [`BadParameter`] unless both are positive and finite.
    pub fn new(coefficient: T, arm: T) -> Result<Self, BadParameter> {
        Ok(Self { cone: Cone::new(coefficient)?, arm: positive(arm, "torque arm")? })
    }

    /// The ellipse shrunk until it lies inside the exact limit of every pressure distribution
    /// between uniform and Winkler: by 0.934 (`docs/theory/friction.md#soft-finger-limit`).
    ///
    /// # Errors
    /// [`BadParameter`] unless both are positive and finite.
    pub fn conservative(coefficient: T, arm: T) -> Result<Self, BadParameter> {
        Self::new(coefficient * T::literal(0.934), arm)
    }

    /// The friction coefficient μ.
    #[inline]
    #[must_use]
    pub const fn coefficient(&self) -> T {
        self.cone.coefficient
    }

    /// The torque arm e \[m\].
    #[inline]
    #[must_use]
    pub const fn arm(&self) -> T {
        self.arm
    }

    /// Tangential force and spin torque as one force \[N\].
    #[inline]
    fn load(&self, force: &ContactForce<T>) -> T {
        hypot(force.tangential_magnitude(), force.spin / self.arm)
    }

    #[inline]
    fn direction(&self, force: &ContactForce<T>) -> Option<SlipDirection<T>> {
        direction(force, self.arm, |share| share)
    }
}

impl<T: Real> PowerLimit<T> {
    /// From the friction coefficient, the torque arm \[m\] and the exponent q, from 1 (a rhombus)
    /// to 2 (the ellipse).
    ///
    /// # Errors
    /// [`BadParameter`] unless coefficient and arm are positive and finite and 1 ≤ q ≤ 2.
    pub fn new(coefficient: T, arm: T, exponent: T) -> Result<Self, BadParameter> {
        if !(exponent >= T::one() && exponent <= T::literal(2.0)) {
            return Err(BadParameter { parameter: "limit exponent", requirement: "between 1 and 2" });
        }
        Ok(Self { cone: Cone::new(coefficient)?, arm: positive(arm, "torque arm")?, exponent })
    }

    /// From the pressure distribution and the radius of the contact patch \[m\].
    ///
    /// # Errors
    /// [`BadParameter`] unless coefficient and radius are positive and finite, or where the
    /// distribution's exponent is out of range.
    pub fn for_patch(
        coefficient: T,
        radius: T,
        pressure: PressureDistribution,
    ) -> Result<Self, BadParameter> {
        let radius = positive(radius, "patch radius")?;
        let pressure = pressure.checked()?;
        let arm = T::literal(pressure.relative_arm()) * radius;
        Self::new(coefficient, arm, T::literal(pressure.limit_exponent()))
    }

    /// The friction coefficient μ.
    #[inline]
    #[must_use]
    pub const fn coefficient(&self) -> T {
        self.cone.coefficient
    }

    /// The torque arm e \[m\].
    #[inline]
    #[must_use]
    pub const fn arm(&self) -> T {
        self.arm
    }

    /// The exponent q.
    #[inline]
    #[must_use]
    pub const fn exponent(&self) -> T {
        self.exponent
    }

    /// Tangential force and spin torque as one force \[N\].
    #[inline]
    fn load(&self, force: &ContactForce<T>) -> T {
        let tangential = force.tangential_magnitude();
        let spin = (force.spin / self.arm).abs();
        let (greater, lesser) = if tangential >= spin { (tangential, spin) } else { (spin, tangential) };
        if !(lesser > T::zero()) || !greater.is_number() {
            return greater + lesser;
        }
        greater * (T::one() + (lesser / greater).power(self.exponent)).power(T::one() / self.exponent)
    }

    #[inline]
    fn direction(&self, force: &ContactForce<T>) -> Option<SlipDirection<T>> {
        direction(force, self.arm, |share| {
            if share > T::zero() { share.power(self.exponent - T::one()) } else { T::zero() }
        })
    }
}

/// What the limits share: a friction cone over their norm of tangential force and spin torque.
macro_rules! limit_on_cone {
    ($limit:ident) => {
        impl<T: Real> FrictionModel<T> for $limit<T> {
            #[inline]
            fn slip_margin(&self, force: &ContactForce<T>) -> SlipMargin<T> {
                self.cone.margin(self.load(force), force.normal)
            }

            #[inline]
            fn least_normal_force(&self, force: &ContactForce<T>, safety: T) -> T {
                self.cone.least_normal(self.load(force), safety)
            }
        }

        impl<T: Real> FrictionLimit<T> for $limit<T> {
            #[inline]
            fn normal_force_keeping(&self, force: &ContactForce<T>, margin: T) -> T {
                self.cone.normal_keeping(self.load(force), margin)
            }

            #[inline]
            fn project(&self, force: &ContactForce<T>) -> ContactForce<T> {
                rescaled(force, self.cone.project(self.load(force), force.normal))
            }

            #[inline]
            fn slip_direction(&self, force: &ContactForce<T>) -> Option<SlipDirection<T>> {
                self.direction(force)
            }
        }
    };
}

limit_on_cone!(SoftFingerLimit);
limit_on_cone!(PowerLimit);

/// The inward normal of a limit whose gradient in each of |f_t| and |τ|/e is `gradient(share of
/// the greater of the two)`.
#[inline]
pub(crate) fn direction<T: Real>(
    force: &ContactForce<T>,
    arm: T,
    gradient: impl Fn(T) -> T,
) -> Option<SlipDirection<T>> {
    let tangential = force.tangential_magnitude();
    let spin = (force.spin / arm).abs();
    let greatest = tangential.max(spin);
    if !(greatest > T::zero() && greatest.is_number() && force.is_finite()) {
        return None;
    }
    let sliding = gradient(tangential / greatest);
    let spinning = gradient(spin / greatest);
    let length = hypot(sliding, spinning);
    let velocity = if tangential > T::zero() {
        let scale = tangential.normalising_factor();
        force.tangential.vector() * scale * (-sliding / length / (tangential * scale))
    } else {
        force.tangential.vector()
    };
    let rate = (-spinning / length / arm).copysign(-force.spin);
    (velocity.iter().all(|x| x.is_number()) && rate.is_number())
        .then_some(SlipDirection { velocity, spin: rate })
}

stored! {
    SoftFingerLimit<T>, [T: Real],
    |model| { coefficient: T = model.coefficient(), #[serde(rename = "arm_m")] arm: T = model.arm() },
    Self::new(coefficient, arm)
}

stored! {
    PowerLimit<T>, [T: Real],
    |model| {
        coefficient: T = model.coefficient(),
        #[serde(rename = "arm_m")]
        arm: T = model.arm(),
        exponent: T = model.exponent(),
    },
    Self::new(coefficient, arm, exponent)
}
