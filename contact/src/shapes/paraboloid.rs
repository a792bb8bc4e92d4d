//! The paraboloid.

#[cfg(feature = "batch")]
use core::hint::select_unpredictable;

#[cfg(feature = "batch")]
use fingertip_surfaces::{Entry, ForceLine};
use fingertip_surfaces::{Paraboloid, SmoothSurface};
use fingertip_wrench::Real;
use nalgebra::Vector3;

use crate::soft_finger::closed_form::soft_finger;
use crate::{GeometrySensitivity, SoftContact, newton_soft_contacts};

soft_finger!(
    Paraboloid,
    |shape, wrench, last, visit| {
        newton_soft_contacts(shape, wrench, last, |contact| {
            let active = shape.depth().is_none_or(|depth| -contact.point.z <= depth);
            visit(SoftContact { active, ..contact });
        })
    },
    sizes | shape,
    size,
    point | of_paraboloid(shape, point).get(size).copied()
);

/// The two radii of curvature at the vertex. With `S = z + (x²/a + y²/b)/2`:
/// `∂S/∂a = −x²/2a²`, `∂g/∂a = −x/a² e₁`.
fn of_paraboloid<T: Real>(shape: &Paraboloid<T>, point: &Vector3<T>) -> [GeometrySensitivity<T>; 2] {
    let level = shape.level(point);
    let radii = shape.radii();
    [0, 1].map(|i| {
        let slope = -level.gradient[i] / radii[i];
        let mut turned = Vector3::zeros();
        turned[i] = slope;
        let value = slope * point[i] * T::literal(0.5);
        GeometrySensitivity::of_level(value, &turned, &level.gradient, &level.hessian)
    })
}

#[cfg(feature = "batch")]
crate::batch::each::entering!(Paraboloid, |paraboloid, push| Some(entry_of_paraboloid(paraboloid, push)));

/// Where the line of a force enters: with its foot `s` and the force `f`, the lesser root of
/// `a t² + 2 b t + c = 0` for the place `s + t f`, at which `a t + b`, the slope of the level function along it, is negative.
#[cfg(feature = "batch")]
#[inline(always)]
fn entry_of_paraboloid<T: Real>(shape: &Paraboloid<T>, push: &ForceLine<T>) -> Entry<T> {
    let ([ka, kb], f) = (shape.curvatures(), push.force());
    let s = f.cross(&push.torque()) * (T::one() / push.squared());
    let (ax, ay) = (f.x * ka, f.y * kb);
    let (a, b) = (f.x * ax + f.y * ay, s.x * ax + s.y * ay + f.z);
    let c = s.x * s.x * ka + s.y * s.y * kb + s.z + s.z;
    let root = (b * b - a * c).root();
    // Without cancellation.
    let (up, sum) = (b > T::zero(), b.abs() + root);
    let along = select_unpredictable(up, -sum, c) / select_unpredictable(up, a, sum);
    let point = s + f * along;
    let gradient = Vector3::new(point.x * ka, point.y * kb, T::one());
    let steepness = gradient.norm_squared();
    Entry {
        point,
        normal: gradient * (T::one() / steepness.root()),
        incidence_squared: root * root / (steepness * push.squared()),
        parts: None,
        active: -point.z <= shape.depth().unwrap_or(T::GREATEST),
    }
}
