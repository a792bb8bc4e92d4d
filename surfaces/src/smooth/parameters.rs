//! How shapes change with their sizes.

use fingertip_wrench::Real;
use nalgebra::{Matrix3, Vector3};

use crate::{Cylinder, Ellipsoid, GeometrySensitivity, ShapeParameters, SmoothSurface, Sphere};

/// The radius.
impl<T: Real> ShapeParameters<T, 1> for Sphere<T> {
    fn sensitivities(&self, _point: &Vector3<T>) -> [GeometrySensitivity<T>; 1] {
        [GeometrySensitivity::offset()]
    }
}

/// The radius.
impl<T: Real> ShapeParameters<T, 1> for Cylinder<T> {
    fn sensitivities(&self, _point: &Vector3<T>) -> [GeometrySensitivity<T>; 1] {
        [GeometrySensitivity::offset()]
    }
}

/// The three semi-axes. With the level function `S = (|A⁻¹ r|² − 1)/2`:
/// `∂S/∂a_i = −r_i²/a_i³`, `∂g/∂a_i = −2 r_i/a_i³ e_i`.
impl<T: Real> ShapeParameters<T, 3> for Ellipsoid<T> {
    fn sensitivities(&self, point: &Vector3<T>) -> [GeometrySensitivity<T>; 3] {
        let a = self.semi_axes();
        let squares = a.map(|x| T::one() / (x * x));
        let gradient = point.component_mul(&squares);
        let hessian = Matrix3::from_diagonal(&squares);
        [0, 1, 2].map(|i| {
            let mut turned = Vector3::zeros();
            turned[i] = -(gradient[i] + gradient[i]) / a[i];
            GeometrySensitivity::of_level(-gradient[i] * point[i] / a[i], &turned, &gradient, &hessian)
        })
    }
}

/// Moving and turning: what every surface has in common. Columns of the result are displacement
/// and tilt for the three translations, then the three rotations about `pivot`.
impl<T: Real> GeometrySensitivity<T> {
    /// How the surface changes at a point with the six rigid motions: translations along the axes
    /// of the sensor frame, rotations about them through `pivot`.
    #[must_use]
    pub fn rigid_motions<S: SmoothSurface<T>>(
        surface: &S,
        point: &Vector3<T>,
        pivot: &Vector3<T>,
    ) -> [Self; 6] {
        let normal = surface.normal(point);
        let bend = surface.shape_operator(point);
        let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
        [0, 1, 2, 3, 4, 5].map(|i| match axes.get(i) {
            Some(axis) => Self::translation(axis, &normal, &bend),
            None => Self::rotation(&axes[i % 3], pivot, point, &normal, &bend),
        })
    }
}
