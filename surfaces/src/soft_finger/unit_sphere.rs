//! The closed form that every ellipsoid reduces to.

use fingertip_wrench::Real;
use nalgebra::Vector3;

/// What a wrench does to the unit sphere.
pub(crate) enum OnUnitSphere<T: Real> {
    /// It presses here (a unit vector, point and normal at once), with this spin torque.
    Contact { point: Vector3<T>, spin: T },
    /// A pure force whose line misses the sphere: it could only graze these two points, with equal
    /// and opposite spin torques. A line that touches gives the same point twice.
    Grazing([Vector3<T>; 2]),
}

/// The soft-finger contact of the wrench `(f, m)` about the centre of the unit sphere:
/// `m = k c + c × f`, `|c| = 1`, `f·c < 0`.
///
/// Bicchi, Salisbury & Brock (1990, 1993) found `k` as the root of a quadratic and `c` as a
/// rational function with `k` in its denominator, which loses half of the digits by `|k| = 1e-8`
/// and all of them at zero. With the second unknown `h = f·c = (f·m)/k` the same solution is
/// (theory 3.2)
///
/// ```text
/// σ = |m|² − |f|²,  ρ = √(σ² + 4(f·m)²)
/// σ ≥ 0:  k² = (σ + ρ)/2,  h = (f·m)/k          σ < 0:  h² = (ρ − σ)/2,  k = (f·m)/h
/// c = (k m + f × m + h f) / (k² + |f|²),        h < 0,        k² + |f|² = (ρ + |m|² + |f|²)/2
/// ```
///
/// which divides by nothing that is small: a spin torque of zero is an ordinary case.
///
/// The larger of `|f|` and `|m|` must be tame, so that fourth powers stay in range. It must not be
/// zero, and the force must not be.
#[inline(always)]
pub(crate) fn on_unit_sphere<T: Real>(f: &Vector3<T>, m: &Vector3<T>) -> OnUnitSphere<T> {
    on_unit_sphere_with_power(f, m, f.dot(m))
}

/// The same with `f·m` from where it is known better than from the two vectors.
// Called, it costs as much again as it computes, for what it returns does not fit into registers.
#[inline(always)]
pub(crate) fn on_unit_sphere_with_power<T: Real>(
    f: &Vector3<T>,
    m: &Vector3<T>,
    power: T,
) -> OnUnitSphere<T> {
    let half = T::literal(0.5);
    let (cross, squares) = (f.cross(m), f.norm_squared() + m.norm_squared());
    // (|m| − |f|)(|m| + |f|) component by component: no worse than the inputs themselves.
    let sigma = (m.x - f.x) * (m.x + f.x) + (m.y - f.y) * (m.y + f.y) + (m.z - f.z) * (m.z + f.z);
    let root = (sigma * sigma + T::literal(4.0) * power * power).root();
    // k² + |f|² = (ρ + |m|² + |f|²)/2, which does not wait for k.
    let inverse = T::one() / ((root + squares) * half);
    let larger = ((root + sigma.abs()) * half).root();
    let smaller = power / larger;
    let (spin, along) = if sigma < T::zero() {
        (-smaller, -larger)
    } else if power.is_zero() {
        return grazing(&cross, &(m * larger), inverse);
    } else if power > T::zero() {
        (-larger, -smaller)
    } else {
        (larger, smaller)
    };
    OnUnitSphere::Contact { point: (m * spin + cross + f * along) * inverse, spin }
}

#[cold]
fn grazing<T: Real>(cross: &Vector3<T>, along_m: &Vector3<T>, inverse: T) -> OnUnitSphere<T> {
    OnUnitSphere::Grazing([(cross + along_m) * inverse, (cross - along_m) * inverse])
}
