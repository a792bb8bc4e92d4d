//! Where the true contact on a sphere can be, whatever the size of the errors.

use fingertip_wrench::{Real, Wrench};

use crate::Sphere;

/// How large errors may be.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ErrorBudget<T: Real> {
    /// Greatest error of the force, in any direction \[N\].
    pub force: T,
    /// Greatest error of the torque about the origin of the sensor frame \[N·m\]. The greatest spin
    /// torque of the true contact may be added, since a point contact neglects it.
    pub torque: T,
    /// Greatest error of the surface's size: of a radius, or how far the true surface may lie
    /// outside or inside its model \[m\].
    pub size: T,
    /// Greatest error of the surface's position \[m\].
    pub position: T,
}

impl<T: Real> ErrorBudget<T> {
    pub(super) fn is_valid(&self) -> bool {
        let sum = self.force + self.torque + self.size + self.position;
        let least = self.force.min(self.torque).min(self.size).min(self.position);
        least >= T::zero() && sum.is_number()
    }
}

/// Distance \[m\] within which the true contact lies from the one that
/// [`PointContact`](crate::PointContact) reports on a sphere (or from the closest point, if the
/// line misses), however large the errors within the budget: through grazing too, where the error
/// grows as `√(2Rε)` and every linear bound fails.
///
/// With the foot point's distance `P'` from the centre, `η = ε_R + ε_o` and
/// `ε = (ε_m + (R + η) ε_f)/|f'|` (torque error about the centre):
///
/// ```text
/// t_hi = √((R+η)² − max(P'−ε, 0)²),  t_lo = √(max((R−η)² − (P'+ε)², 0)),  τ = (R+ε_R) ε_f/|f'| + ε_o
/// P' < R, w' = √(R²−P'²):  a = max(|w'−t_hi|, |w'−t_lo|)             if t_lo > τ
///                          a = max(|w'−t_hi|, w' + min(t_hi, τ))     else,   bound = hypot(a, ε)
/// P' ≥ R:                  bound = hypot(t_hi, P' − R + ε)
/// ```
///
/// Proof. With the true contact `c` and true load `f, m = c × f`, the measured axis passes `c` at
/// the distance `|f' × (δm − c × δf)|/|f'|² ≤ ε`, exactly. `c` lies in the shell `R ± η` around
/// the model's centre, so its coordinate `−t` along the axis has `t` in `[t_lo, t_hi]` if it lies
/// on the side that the measured force enters. It presses against the *true* force; if the two
/// differ it may lie past the measured silhouette, but there the angle between them is at most
/// `asin(ε_f/|f'|)`, so no further than `τ`. ∎ (Theory 2.3.)
///
/// `None` if the budget is not valid, if it allows for any direction of the force
/// (`ε_f ≥ |f'|`), if the wrench is not finite, or if the line passes further from the sphere than
/// the budget can explain: then this is no contact on this sphere.
#[must_use]
pub fn sphere_bound<T: Real>(sphere: &Sphere<T>, wrench: &Wrench<T>, budget: &ErrorBudget<T>) -> Option<T> {
    if !budget.is_valid() {
        return None;
    }
    let centre = sphere.centre();
    let about_centre = Wrench::<T>::on_fingertip(wrench.force(), wrench.torque_about(&centre));
    let axis = about_centre.line_of_action().ok()?;
    if !(budget.force < axis.force) {
        return None;
    }
    // In radii.
    let (radius, unit) = (T::one(), T::one() / sphere.radius());
    let centre_scale = centre.amax().normalising_factor();
    let distance = (centre * centre_scale).norm_squared().root() / centre_scale;
    // The budget's torque is about the origin of the sensor frame; about the centre it is larger.
    let torque = (budget.torque + distance * budget.force) / axis.force * unit;
    let turn = budget.force / axis.force;
    let (size, position) = (budget.size * unit, budget.position * unit);
    let eta = size + position;
    // Rounding of the foot point and of what follows.
    let epsilon = torque + (radius + eta) * turn + T::EPSILON * T::literal(16.0);
    let foot = axis.line.point * unit;
    let foot_scale = foot.amax().normalising_factor();
    let p = (foot * foot_scale).norm_squared().root() / foot_scale;
    let (outer, inner) = (radius + eta, radius - eta);
    let nearest = (p - epsilon).max(T::zero());
    if !(nearest <= outer) {
        return None;
    }
    let high = ((outer - nearest) * (outer + nearest)).root();
    let furthest = p + epsilon;
    let low = ((inner - furthest) * (inner + furthest)).max(T::zero()).root();
    let past = (radius + size) * turn + position;
    let hypot = |x: T, y: T| (x * x + y * y).root();
    let bound = if p < radius {
        let half_chord = ((radius - p) * (radius + p)).root();
        let far = (half_chord - high).abs();
        let near =
            if low > past && furthest < inner { (half_chord - low).abs() } else { half_chord + high.min(past) };
        hypot(far.max(near), epsilon)
    } else {
        hypot(high, p - radius + epsilon)
    };
    let bound = bound * sphere.radius() * (T::one() + T::EPSILON * T::literal(16.0));
    bound.is_number().then_some(bound)
}
