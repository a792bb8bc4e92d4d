//! The superquadric.

use crate::uncertainty::geometry::stretched;
use fingertip_surfaces::numeric::vectors::wide;
use fingertip_surfaces::{LocalSurface, SmoothSurface, Superquadric};
use fingertip_wrench::Real;

use crate::newton_soft_contacts;
use crate::soft_finger::closed_form::soft_finger;

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
    // The three semi-axes (its exponents are chosen, not measured). As for any level function of `x/a`:
    // `∂S/∂a_i = −g_i x_i/a_i`, `∂g/∂a_i = −(g_i + x_i H) e_i/a_i`.
    sizes | shape,
    size,
    point | (size < 3).then(|| stretched(&shape.level(point), point, size, shape.semi_axes()[size]))
);
