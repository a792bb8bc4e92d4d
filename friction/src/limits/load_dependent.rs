//! A soft finger whose contact patch grows with the load.

use fingertip_wrench::{ContactForce, Real, stored};

use crate::bad_parameter::{not_negative, positive};
use crate::limits::cone::{Cone, hypot, rescaled, saturated};
use crate::limits::soft_finger::direction;
use crate::{BadParameter, FrictionLimit, FrictionModel, SlipDirection, SlipMargin};

/// The elliptic soft-finger limit `|f_t|² + (τ/e(f_n))² ≤ (μ f_n)²` whose torque arm grows with
/// the normal force as the patch does, `e = e₀ (f_n/N₀)^γ` (a = c·N^γ; Hertz γ = 1/3, rubber less:
/// Xydas & Kao 1999; `docs/theory/friction.md#load-dependent-limit`).
///
/// The set of forces that hold is **not convex** (the mid-point of two holding forces may slip) and
/// not a cone, so no distance is 1-Lipschitz and exact at once. The margin here is certified: while
/// the contact holds, no change of the contact force shorter than it (in the norm
/// `√(|δf_t|² + (δτ/e)² + δf_n²)` with `e` at the present normal force) makes it slip. Outside, it
/// is minus the distance to the cone with the present arm.
///
/// ```
/// use fingertip_friction::LoadDependentLimit;
///
/// // The arm is 3 mm at 1 N, and grows with the cube root of the force, as an elastic patch does.
/// let limit = LoadDependentLimit::new(0.5, 3e-3, 1.0, 1.0 / 3.0)?;
/// assert!((limit.arm_at(8.0) - 6e-3_f64).abs() < 1e-6);
/// # Ok::<(), fingertip_friction::BadParameter>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadDependentLimit<T: Real> {
    cone: Cone<T>,
    arm: T,
    reference: T,
    growth: T,
}

impl<T: Real> LoadDependentLimit<T> {
    /// From the friction coefficient, the torque arm \[m\] at the reference normal force \[N\], and
    /// the growth exponent γ of the patch.
    ///
    /// # Errors
    /// [`BadParameter`] unless the first three are positive and finite and 0 ≤ γ ≤ 1.
    pub fn new(coefficient: T, arm: T, reference: T, growth: T) -> Result<Self, BadParameter> {
        if !(not_negative(growth, "growth exponent")? <= T::one()) {
            return Err(BadParameter { parameter: "growth exponent", requirement: "at most 1" });
        }
        Ok(Self {
            cone: Cone::new(coefficient)?,
            arm: positive(arm, "torque arm")?,
            reference: positive(reference, "reference normal force")?,
            growth,
        })
    }

    /// The friction coefficient μ.
    #[inline]
    #[must_use]
    pub const fn coefficient(&self) -> T {
        self.cone.coefficient
    }

    /// The torque arm \[m\] at a normal force; the least normal number where it does not press.
    #[inline]
    #[must_use]
    pub fn arm_at(&self, normal: T) -> T {
        if !(normal > T::zero()) {
            return T::LEAST_NORMAL;
        }
        (self.arm * (normal / self.reference).power(self.growth)).clamp(T::LEAST_NORMAL, T::GREATEST)
    }

    #[inline]
    fn load(&self, force: &ContactForce<T>, normal: T) -> T {
        hypot(force.tangential_magnitude(), force.spin / self.arm_at(normal))
    }

    /// The least normal force with `μN ≥ safety·load(N) + allowance`. The left side grows with N
    /// and the right falls, so that bisection in the logarithm finds it.
    fn least_with(&self, force: &ContactForce<T>, safety: T, allowance: T) -> T {
        let mu = self.cone.coefficient;
        let enough = |normal: T| {
            let needed = safety * self.load(force, normal) + allowance;
            mu * normal >= needed
        };
        let floor = saturated((safety * force.tangential_magnitude() + allowance) / mu);
        if !(floor < T::GREATEST) || !force.spin.is_number() {
            return T::GREATEST;
        }
        if floor > T::zero() && enough(floor) {
            return floor;
        }
        if !(safety * force.spin.abs() > T::zero()) {
            return floor;
        }
        let two = T::literal(2.0);
        let mut high = floor.max(T::LEAST_NORMAL);
        // The norm only falls, so that the answer lies within the doublings the type has room for.
        for _ in 0..2200 {
            if enough(high) {
                break;
            }
            high *= two;
            if !high.is_number() {
                return T::GREATEST;
            }
        }
        let mut low = (high / two).max(floor);
        for _ in 0..64 {
            let middle = low + (high - low) / two;
            if middle <= low || middle >= high {
                break;
            }
            if enough(middle) {
                high = middle;
            } else {
                low = middle;
            }
        }
        high
    }
}

impl<T: Real> FrictionModel<T> for LoadDependentLimit<T> {
    /// Inside: bisection for the greatest radius that is certain to hold.
    fn slip_margin(&self, force: &ContactForce<T>) -> SlipMargin<T> {
        let normal = force.normal;
        let load = self.load(force, normal);
        let frozen = self.cone.margin(load, normal);
        if !(frozen.newtons > T::zero()) || self.growth.is_zero() {
            return frozen;
        }
        // Worst case over a ball of radius δ: the normal force falls by ν ≤ δ and the load grows
        // by √(δ²−ν²). It holds if μ(N−ν) ≥ κ(δ)(ρ + √(δ²−ν²)) for all ν, whose worst ν gives
        // μN − κρ ≥ δ√(μ² + κ²).
        let mu = self.cone.coefficient;
        let certain = |margin: T| {
            let shrunk = (normal / (normal - margin)).power(self.growth);
            mu * normal - shrunk * load >= margin * hypot(mu, shrunk)
        };
        // The frozen margin is an upper bound (κ ≥ 1); bisect below it.
        let (mut low, mut high) = (T::zero(), frozen.newtons);
        if certain(high) {
            return SlipMargin { newtons: high, ..frozen };
        }
        for _ in 0..40 {
            let middle = low + (high - low) * T::literal(0.5);
            if certain(middle) {
                low = middle;
            } else {
                high = middle;
            }
        }
        SlipMargin { newtons: low, ..frozen }
    }

    fn least_normal_force(&self, force: &ContactForce<T>, safety: T) -> T {
        if !(safety > T::zero()) {
            return if safety.is_number() { T::zero() } else { T::GREATEST };
        }
        self.least_with(force, safety, T::zero())
    }
}

impl<T: Real> FrictionLimit<T> for LoadDependentLimit<T> {
    /// With the arm at the normal force sought.
    fn normal_force_keeping(&self, force: &ContactForce<T>, margin: T) -> T {
        let margin = margin.max(T::zero());
        let kept = |normal: T| self.slip_margin(&ContactForce { normal, ..*force }).newtons >= margin;
        let least = self.least_with(force, T::one(), margin / self.cone.cosine);
        if kept(least) || !(least < T::GREATEST) {
            return least;
        }
        // The certified margin is a little less than the frozen one, or just as great but for rounding: raise by twice
        // as much each time until it is kept, then halve what was too much.
        let raised = |raise: T| saturated(least + least * raise + T::LEAST_NORMAL);
        let mut raise = T::EPSILON;
        for _ in 0..64 {
            if kept(raised(raise)) {
                break;
            }
            raise += raise;
        }
        let (mut low, mut high) = (raise * T::literal(0.5), raise);
        for _ in 0..12 {
            let middle = (low + high) * T::literal(0.5);
            if kept(raised(middle)) {
                high = middle;
            } else {
                low = middle;
            }
        }
        raised(high)
    }

    /// With the arm at the present normal force; inside to rounding, since outside the normal
    /// force of the projection is greater, and so is its arm.
    fn project(&self, force: &ContactForce<T>) -> ContactForce<T> {
        rescaled(force, self.cone.project(self.load(force, force.normal), force.normal))
    }

    fn slip_direction(&self, force: &ContactForce<T>) -> Option<SlipDirection<T>> {
        direction(force, self.arm_at(force.normal), |share| share)
    }
}

stored! {
    LoadDependentLimit<T>, [T: Real],
    |model| {
        coefficient: T = model.cone.coefficient,
        #[serde(rename = "arm_m")]
        arm: T = model.arm,
        #[serde(rename = "reference_N")]
        reference: T = model.reference,
        growth: T = model.growth,
    },
    Self::new(coefficient, arm, reference, growth)
}
