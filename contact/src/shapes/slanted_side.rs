//! The straight side of a cone, a frustum or a cylinder.

use fingertip_surfaces::ForceLine;
use fingertip_surfaces::numeric::vectors::{larger, largest};
use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;

use crate::model::flat;
use crate::{Search, SoftContact};

/// Whether rounding is multiplied by no more than 15, by `(1 + t/|f|)²/(p/|f|)²` for a force that presses with `p` and a spin
/// torque of which the turn of the normal makes a force `t`.
///
/// With `(1 + x)² ≤ 4/3 (1 + 3x²)` no root is needed.
#[inline(always)]
pub(super) fn is_steep<T: Real>(push: &ForceLine<T>, pressing: T, twist: T) -> bool {
    is_above(flat(), push, pressing, twist)
}

/// The same of another cosine.
#[inline(always)]
fn is_above<T: Real>(flat: T, push: &ForceLine<T>, pressing: T, twist: T) -> bool {
    let squared = push.squared() + twist * twist * T::literal(3.0);
    pressing * pressing >= flat * flat * squared
}

/// A straight side around an axis, unbounded, as far as it goes before the axis.
#[derive(Clone, Copy)]
pub(super) struct SlantedSide<T: Real> {
    /// A point of the axis, no farther from the tip than any contact asked for: next to a tip the way from elsewhere takes
    /// digits. And the axis, a unit vector.
    pub(super) origin: Vector3<T>,
    pub(super) axis: Vector3<T>,
    /// Around that point.
    pub(super) radius: T,
    /// The part of the outward normal along the axis, positive where the side narrows along it, and across.
    pub(super) sine: T,
    pub(super) cosine: T,
}

impl<T: Real> SlantedSide<T> {
    /// The soft-finger contact of a force that presses at no flat angle, under a spin torque that does not rule, and
    /// how far along the axis it is from the origin.
    ///
    /// `docs/theory/contact.md#straight-sides`: with the torque about the origin, `s` and `k` the sine and cosine of
    /// the slant, and `f_⊥`, `m_⊥` across the axis `a`,
    ///
    /// ```text
    /// v = s m_⊥ + k R f × a,   w = k m·a,   ρ = (w v − √(|v|² − w²) a × v)/|v|²
    /// n = k ρ + s a,   p = −f·n,   τ = −f·m/p,   ℓ = (m·(ρ × a) − R f·a)/p
    /// c = (R − s ℓ) ρ + k ℓ a
    /// ```
    ///
    /// Nothing small is divided by but `p` and `|v|`, and both are small only where the contact itself answers to
    /// rounding: where the force grazes, or next to the tip. `None` there, or where a square leaves the range.
    #[inline(always)]
    pub(super) fn steep_contact(&self, push: &ForceLine<T>) -> Option<(SoftContact<T>, T)> {
        self.contact_above(flat(), T::literal(0.06), push)
    }

    /// The same for a narrower type: where rounding is multiplied by no more than a million, half of the digits of double
    /// precision are left.
    #[inline(never)]
    pub(super) fn contact_for_narrower(&self, push: &ForceLine<T>) -> Option<(SoftContact<T>, T)> {
        self.contact_above(T::literal(1e-3), T::literal(1e-6), push)
    }

    /// Above a cosine of incidence, and above a share that is left under the root.
    #[inline(always)]
    fn contact_above(&self, flat: T, left: T, push: &ForceLine<T>) -> Option<(SoftContact<T>, T)> {
        let &Self { origin, axis, radius, sine, cosine } = self;
        let (f, m) = (push.force(), push.torque_about(&origin));
        let (rise, turning) = (f.dot(&axis), m.dot(&axis));
        let v = (m - axis * turning) * sine + f.cross(&axis) * (radius * cosine);
        let (w, aside) = (turning * cosine, turning * sine);
        let (squared, aside) = (v.norm_squared(), aside * aside);
        let root_squared = squared - w * w;
        // Not where the torque is all but along the side's normals, and the root loses digits.
        let wide = root_squared >= (squared + aside) * left;
        if !(wide & (squared >= T::LEAST_NORMAL) & (squared <= T::GREATEST)) {
            return None;
        }
        let inverse = T::one() / squared;
        let outward = (v * w - axis.cross(&v) * root_squared.root()) * inverse;
        let normal = outward * cosine + axis * sine;
        let pressing = -f.dot(&normal);
        let share = T::one() / pressing;
        let spin_torque = -f.dot(&push.torque()) * share;
        let along = (m.dot(&outward.cross(&axis)) - rise * radius) * share;
        let around = radius - along * sine;
        let height = along * cosine;
        // What rounding does is multiplied by no more than `(1 + |τ κ|/|f|)²/(f·n/|f|)²`, `κ` being the curvature.
        let is_steady = is_above(flat, push, pressing, spin_torque * (cosine / around));
        let point = origin + (outward * around + axis * height);
        // The part beyond the tip is no side. False for a NaN, too.
        let found = is_steady & (pressing > T::zero()) & (around > T::zero());
        found.then_some((SoftContact { point, normal, spin_torque, active: true }, height))
    }

    /// The soft-finger contact of any force that is tame, by the same formulas. How many digits it has is for whoever asks to
    /// look at.
    ///
    /// # Errors
    /// How the search ended: [`Search::Complete`] if no rounding of the wrench gives the side a contact, of which a pure force
    /// needs no proof, since it either hits or misses.
    #[inline(never)]
    pub(super) fn contact(&self, wrench: &Wrench<T>) -> Result<SoftContact<T>, Search<T>> {
        let &Self { origin, axis, radius, sine, cosine } = self;
        let (f, m) = (wrench.force(), wrench.torque_about(&origin));
        let (rise, turning) = (f.dot(&axis), m.dot(&axis));
        let v = (m - axis * turning) * sine + f.cross(&axis) * (radius * cosine);
        let w = turning * cosine;
        // Neither size nor torque is known to be near 1.
        let scale = larger(largest(&v), w.abs()).normalising_factor();
        let (v, w) = (v * scale, w * scale);
        let squared = v.norm_squared();
        let root_squared = squared - w * w;
        let root = root_squared.max(T::zero()).root();
        let outward = (v * w - axis.cross(&v) * root) * (T::one() / squared);
        let normal = outward * cosine + axis * sine;
        let pressing = -f.dot(&normal);
        let (power, share) = (f.dot(&wrench.torque()), T::one() / pressing);
        let along = (m.dot(&outward.cross(&axis)) - rise * radius) * share;
        let around = radius - along * sine;
        if (root_squared > T::zero()) & (pressing > T::zero()) & (around >= T::zero()) {
            let arm = outward * around + axis * (along * cosine);
            // Where the force grazes, `f·m/f·n` has the digits of `f·n`; what the force leaves of the torque has all.
            let grazes = pressing * pressing < f.norm_squared() * flat::<T>() * flat::<T>();
            let spin_torque = if grazes { normal.dot(&(m - arm.cross(&f))) } else { -power * share };
            return Ok(SoftContact { point: origin + arm, normal, spin_torque, active: true });
        }
        // Rounding of the torque about the origin, of the root's square, and of what turning the normal by it makes of the
        // force: `δ`, at most `4 (|v| + |w|) δ`, and `6 |f| δ` over the root.
        let (size, hair) = (largest(&f), T::literal(8.0) * T::EPSILON);
        let loose = hair * (largest(&m) + size * (largest(&origin) + radius));
        let pure = power.abs() <= loose * size * T::literal(3.0);
        let loose = loose * scale;
        let unsure = root_squared.abs() <= loose * T::literal(24.0);
        let pulls = pressing < -size * (hair * T::literal(4.0) + loose * T::literal(12.0) / root);
        let certain = !unsure & (pulls | (root_squared < T::zero()));
        Err(if certain | pure { Search::Complete } else { Search::Incomplete })
    }
}
