//! The superquadric.

use crate::uncertainty::geometry::stretched;
use fingertip_surfaces::numeric::vectors::wide;
use fingertip_surfaces::{LocalSurface, SmoothSurface, Superquadric};
use fingertip_wrench::Real;
use nalgebra::Vector3;

use crate::soft_finger::closed_form::soft_finger;
use crate::{GeometrySensitivity, newton_soft_contacts};

soft_finger!(
    Superquadric,
    |shape, wrench, last, visit| newton_soft_contacts(shape, wrench, last, visit),
    patch | shape,
    _ | {
        // Of a shape in double precision there is no more to be had.
        let narrow = T::EPSILON.to_f64() > f64::EPSILON;
        let double =
            narrow.then(|| Superquadric::new(wide(&shape.semi_axes()), shape.exponents().map(Real::to_f64)));
        double.and_then(Result::ok).map(LocalSurface::Superquadric)
    },
    sizes | shape,
    size,
    point | of_superquadric(shape, point).get(size).copied()
);

/// The three semi-axes (its exponents are chosen, not measured). As for any level function of `x/a`:
/// `∂S/∂a_i = −g_i x_i/a_i`, `∂g/∂a_i = −(g_i + x_i H) e_i/a_i`.
fn of_superquadric<T: Real>(shape: &Superquadric<T>, point: &Vector3<T>) -> [GeometrySensitivity<T>; 3] {
    [0, 1, 2].map(|i| stretched(&shape.level(point), point, i, shape.semi_axes()[i]))
}
