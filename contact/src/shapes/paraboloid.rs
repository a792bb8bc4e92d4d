//! The paraboloid.

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
