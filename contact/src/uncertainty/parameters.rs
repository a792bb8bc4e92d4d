//! How shapes change with their sizes.

use fingertip_wrench::Real;
use nalgebra::Vector3;

use crate::{GeometrySensitivity, ShapeParameters};
use fingertip_surfaces::numeric::vectors::unit_or;
use fingertip_surfaces::{
    ActiveSurface, CappedCylinder, Capsule, Cone, Cylinder, Disk, Ellipsoid, EllipticCylinder, Frustum,
    Level, Offset, Paraboloid, Plane, Posed, Rectangle, RoundedBox, SignedDistance, SmoothSurface, Sphere,
    SphericalCap, Superquadric, Torus, Trimmed,
};

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

/// The radius.
impl<T: Real> ShapeParameters<T, 1> for SphericalCap<T> {
    fn sensitivities(&self, point: &Vector3<T>) -> [GeometrySensitivity<T>; 1] {
        self.sphere().sensitivities(point)
    }
}

/// Its height along its normal.
impl<T: Real> ShapeParameters<T, 1> for Plane<T> {
    fn sensitivities(&self, _point: &Vector3<T>) -> [GeometrySensitivity<T>; 1] {
        [GeometrySensitivity::offset()]
    }
}

/// Its height along its normal.
impl<T: Real> ShapeParameters<T, 1> for Disk<T> {
    fn sensitivities(&self, _point: &Vector3<T>) -> [GeometrySensitivity<T>; 1] {
        [GeometrySensitivity::offset()]
    }
}

/// Its height along its normal.
impl<T: Real> ShapeParameters<T, 1> for Rectangle<T> {
    fn sensitivities(&self, _point: &Vector3<T>) -> [GeometrySensitivity<T>; 1] {
        [GeometrySensitivity::offset()]
    }
}

/// The distance.
impl<T: Real, S: SignedDistance<T>> ShapeParameters<T, 1> for Offset<T, S> {
    fn sensitivities(&self, _point: &Vector3<T>) -> [GeometrySensitivity<T>; 1] {
        [GeometrySensitivity::offset()]
    }
}

/// Those of the whole shape.
impl<T: Real, S: ShapeParameters<T, P>, R, const P: usize> ShapeParameters<T, P> for Trimmed<S, R> {
    fn sensitivities(&self, point: &Vector3<T>) -> [GeometrySensitivity<T>; P] {
        self.inner().sensitivities(point)
    }
}

/// Those of the shape, wherever it is. (How well its place is known is a matter of
/// [`GeometryUncertainty`](crate::GeometryUncertainty).)
impl<T: Real, S: ShapeParameters<T, P>, const P: usize> ShapeParameters<T, P> for Posed<T, S> {
    fn sensitivities(&self, point: &Vector3<T>) -> [GeometrySensitivity<T>; P] {
        let pose = self.sensor_from_shape();
        let inside = pose.rotation().tr_mul(&(point - pose.origin()));
        self.inner()
            .sensitivities(&inside)
            .map(|change| GeometrySensitivity { tilt: pose.rotation() * change.tilt, ..change })
    }
}

/// The half angle, per radian. With the level function `S = r cos α − h sin α` of the distance `r`
/// from the axis and the depth `h` under the apex.
impl<T: Real> ShapeParameters<T, 1> for Cone<T> {
    fn sensitivities(&self, point: &Vector3<T>) -> [GeometrySensitivity<T>; 1] {
        let level = self.level(point);
        let (sine, cosine) = self.half_angle().sin_cos();
        let from_apex = point - self.apex();
        let depth = from_apex.dot(&self.axis());
        // ρ = (g + a sin α)/cos α.
        let outward = (level.gradient + self.axis() * sine) / cosine;
        let value = -(from_apex.dot(&outward) * sine + depth * cosine);
        let turned = -(outward * sine + self.axis() * cosine);
        [GeometrySensitivity::of_level(value, &turned, &level.gradient, &level.hessian)]
    }
}

/// Half length, then radius. A longer capsule moves its ends and leaves its side.
impl<T: Real> ShapeParameters<T, 2> for Capsule<T> {
    fn sensitivities(&self, point: &Vector3<T>) -> [GeometrySensitivity<T>; 2] {
        let axis = self.axis();
        let height = (point - self.centre()).dot(&axis);
        let longer = if height.abs() > self.half_length() {
            let outward = axis * T::one().copysign(height);
            GeometrySensitivity::translation(&outward, &self.normal(point), &self.shape_operator(point))
        } else {
            GeometrySensitivity::none()
        };
        [longer, GeometrySensitivity::offset()]
    }
}

/// Half length, then radius; each moves the faces that it bounds.
impl<T: Real> ShapeParameters<T, 2> for CappedCylinder<T> {
    fn sensitivities(&self, point: &Vector3<T>) -> [GeometrySensitivity<T>; 2] {
        if self.normal(point).dot(&self.axis()).abs() > T::literal(0.5) {
            [GeometrySensitivity::offset(), GeometrySensitivity::none()]
        } else {
            [GeometrySensitivity::none(), GeometrySensitivity::offset()]
        }
    }
}

/// Height, base radius, top radius. With the level function `S = r − R + (R − R′) z/h` of the
/// distance `r` from the axis and the height `z` over the base.
impl<T: Real> ShapeParameters<T, 3> for Frustum<T> {
    fn sensitivities(&self, point: &Vector3<T>) -> [GeometrySensitivity<T>; 3] {
        let (axis, taper, height) = (self.axis(), self.taper(), self.height());
        let above = (point - self.base_centre()).dot(&axis);
        let level = self.level(point);
        // Which of the three faces is the outermost here.
        if above - height > level.value || -above > level.value {
            let top = if above > height * T::literal(0.5) {
                GeometrySensitivity::offset()
            } else {
                GeometrySensitivity::none()
            };
            return [top, GeometrySensitivity::none(), GeometrySensitivity::none()];
        }
        let steep = T::one() / self.side_cosine();
        let (gradient, hessian) = (level.gradient * steep, level.hessian * steep);
        let share = above / height;
        let of =
            |value: T, slope: T| GeometrySensitivity::of_level(value, &(axis * slope), &gradient, &hessian);
        let one = T::one();
        [of(-taper * share, -taper / height), of(share - one, one / height), of(-share, -one / height)]
    }
}

/// The radius of the ring, then that of the tube. A larger ring moves each section of the tube
/// outward.
impl<T: Real> ShapeParameters<T, 2> for Torus<T> {
    fn sensitivities(&self, point: &Vector3<T>) -> [GeometrySensitivity<T>; 2] {
        let normal = self.normal(point);
        let outward = unit_or(&Vector3::new(point.x, point.y, T::zero()), Vector3::x);
        let level = self.level(point);
        // The derivative across the tube; that around the ring stays out.
        let around = Vector3::new(-outward.y, outward.x, T::zero());
        let along = around.cross(&normal);
        let turned = -along * (along.dot(&outward) / self.tube_radius());
        let ring = GeometrySensitivity::of_level(-normal.dot(&outward), &turned, &normal, &level.hessian);
        [ring, GeometrySensitivity::offset()]
    }
}

/// The two radii of curvature at the vertex. With `S = z + (x²/a + y²/b)/2`:
/// `∂S/∂a = −x²/2a²`, `∂g/∂a = −x/a² e₁`.
impl<T: Real> ShapeParameters<T, 2> for Paraboloid<T> {
    fn sensitivities(&self, point: &Vector3<T>) -> [GeometrySensitivity<T>; 2] {
        let level = self.level(point);
        let radii = self.radii();
        [0, 1].map(|i| {
            let slope = -level.gradient[i] / radii[i];
            let mut turned = Vector3::zeros();
            turned[i] = slope;
            let value = slope * point[i] * T::literal(0.5);
            GeometrySensitivity::of_level(value, &turned, &level.gradient, &level.hessian)
        })
    }
}

/// The three half extents, then the rounding: a half extent moves a face with the edges and corners at
/// its rim; a rounding moves edges and corners inward as it grows.
impl<T: Real> ShapeParameters<T, 4> for RoundedBox<T> {
    fn sensitivities(&self, point: &Vector3<T>) -> [GeometrySensitivity<T>; 4] {
        let level = self.level(point);
        let sign = point.map(|x| T::one().copysign(x));
        let n = level.gradient;
        let of =
            |value: T, turned: Vector3<T>| GeometrySensitivity::of_level(value, &turned, &n, &level.hessian);
        let wider = |i: usize| {
            let mut moved = Vector3::zeros();
            moved[i] = sign[i];
            of(-n.dot(&moved), -(level.hessian * moved))
        };
        [wider(0), wider(1), wider(2), of(n.dot(&sign) - T::one(), level.hessian * sign)]
    }
}

/// The three semi-axes (its exponents are chosen, not measured). As for any level function of `x/a`:
/// `∂S/∂a_i = −g_i x_i/a_i`, `∂g/∂a_i = −(g_i + x_i H) e_i/a_i`.
impl<T: Real> ShapeParameters<T, 3> for Superquadric<T> {
    fn sensitivities(&self, point: &Vector3<T>) -> [GeometrySensitivity<T>; 3] {
        [0, 1, 2].map(|i| stretched(&self.level(point), point, i, self.semi_axes()[i]))
    }
}

/// The three semi-axes.
impl<T: Real> ShapeParameters<T, 3> for Ellipsoid<T> {
    fn sensitivities(&self, point: &Vector3<T>) -> [GeometrySensitivity<T>; 3] {
        [0, 1, 2].map(|i| stretched(&self.level(point), point, i, self.semi_axes()[i]))
    }
}

/// The two semi-axes; on a flat end they change nothing.
impl<T: Real> ShapeParameters<T, 2> for EllipticCylinder<T> {
    fn sensitivities(&self, point: &Vector3<T>) -> [GeometrySensitivity<T>; 2] {
        if self.normal(point).z.abs() > T::literal(0.5) {
            return [GeometrySensitivity::none(); 2];
        }
        [0, 1].map(|i| stretched(&self.level(point), point, i, self.semi_axes()[i]))
    }
}

/// Of a level function of the coordinates over the semi-axes, by one of these.
fn stretched<T: Real>(
    level: &Level<T>,
    point: &Vector3<T>,
    axis: usize,
    length: T,
) -> GeometrySensitivity<T> {
    let mut turned = level.hessian.column(axis) * (-point[axis] / length);
    turned[axis] -= level.gradient[axis] / length;
    let value = -level.gradient[axis] * point[axis] / length;
    GeometrySensitivity::of_level(value, &turned, &level.gradient, &level.hessian)
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
