//! Shapes whose level function is a distance.

use fingertip_wrench::Real;
use nalgebra::{Matrix2, Matrix3, Vector3};

use super::flat_ends::Face;
use crate::ActiveSurface;
use crate::numeric::vectors::{any_perpendicular, hypotenuse, length, unit_or};
use crate::{
    CappedCylinder, Capsule, Cone, Corner, Cylinder, Disk, Extent, Frustum, Level, Plane, Rectangle,
    RoundedBox, SignedDistance, SmoothSurface, Sphere, SphericalCap, Topology, Torus,
};

impl<T: Real> SmoothSurface<T> for Sphere<T> {
    #[inline]
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        let from_centre = point - self.centre();
        let distance = length(&from_centre);
        let normal = self.normal(point);
        Level {
            value: distance - self.radius(),
            gradient: normal,
            hessian: (Matrix3::identity() - normal * normal.transpose()) / distance,
        }
    }

    fn extent(&self) -> Extent<T> {
        Extent { centre: self.centre(), radius: self.radius() }
    }

    fn topology(&self) -> Topology {
        Topology::Convex
    }

    fn shape_operator(&self, point: &Vector3<T>) -> Matrix3<T> {
        let normal = self.normal(point);
        (Matrix3::identity() - normal * normal.transpose()) / self.radius()
    }

    #[inline]
    fn bend(&self, _point: &Vector3<T>, _normal: &Vector3<T>, _tangents: [&Vector3<T>; 2]) -> Matrix2<T> {
        Matrix2::from_diagonal_element(self.curvature())
    }
}

impl<T: Real> SmoothSurface<T> for SphericalCap<T> {
    #[inline]
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        self.sphere().level(point)
    }

    fn extent(&self) -> Extent<T> {
        self.sphere().extent()
    }

    fn topology(&self) -> Topology {
        Topology::Convex
    }

    fn shape_operator(&self, point: &Vector3<T>) -> Matrix3<T> {
        self.sphere().shape_operator(point)
    }
}

/// The extent of an unbounded plane is a ball of one metre around its point.
impl<T: Real> SmoothSurface<T> for Plane<T> {
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        let normal = self.normal(point);
        Level { value: normal.dot(&(point - self.point())), gradient: normal, hessian: Matrix3::zeros() }
    }

    fn extent(&self) -> Extent<T> {
        Extent { centre: self.point(), radius: T::one() }
    }

    fn topology(&self) -> Topology {
        Topology::Convex
    }
}

impl<T: Real> SmoothSurface<T> for Disk<T> {
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        self.plane().level(point)
    }

    fn extent(&self) -> Extent<T> {
        Extent { centre: self.plane().point(), radius: self.radius() }
    }

    fn topology(&self) -> Topology {
        Topology::Convex
    }
}

impl<T: Real> SmoothSurface<T> for Rectangle<T> {
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        self.plane().level(point)
    }

    fn extent(&self) -> Extent<T> {
        let [first, second] = self.half_edges();
        Extent { centre: self.plane().point(), radius: hypotenuse(length(&first), length(&second)) }
    }

    fn topology(&self) -> Topology {
        Topology::Convex
    }
}

impl<T: Real> SmoothSurface<T> for Cylinder<T> {
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        let axis = self.axis();
        let from_centre = point - self.centre();
        let across = from_centre - axis * from_centre.dot(&axis);
        let distance = length(&across);
        let normal = self.normal(point);
        let flat = Matrix3::identity() - normal * normal.transpose() - axis * axis.transpose();
        Level { value: distance - self.radius(), gradient: normal, hessian: flat / distance }
    }

    fn extent(&self) -> Extent<T> {
        Extent {
            centre: self.centre(),
            radius: self.half_length().map_or(self.radius(), |half| hypotenuse(half, self.radius())),
        }
    }

    fn topology(&self) -> Topology {
        Topology::Convex
    }
}

/// The extent of a cone is a ball of one metre around its apex.
impl<T: Real> SmoothSurface<T> for Cone<T> {
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        let axis = self.axis();
        let (sine, cosine) = (self.half_angle().sin(), self.half_angle().cos());
        let from_apex = point - self.apex();
        let height = from_apex.dot(&axis);
        let across = from_apex - axis * height;
        let radius = length(&across);
        let outward = unit_or(&across, || any_perpendicular(&axis));
        let flat = Matrix3::identity() - outward * outward.transpose() - axis * axis.transpose();
        let bend = cosine / radius;
        Level {
            value: radius * cosine - height * sine,
            gradient: outward * cosine - axis * sine,
            hessian: if bend.is_number() { flat * bend } else { Matrix3::zeros() },
        }
    }

    fn extent(&self) -> Extent<T> {
        Extent { centre: self.apex(), radius: T::one() }
    }

    fn topology(&self) -> Topology {
        Topology::Convex
    }

    fn corner(&self, _point: &Vector3<T>, _normal: &Vector3<T>) -> Option<Corner<T>> {
        Some(Corner::Tip)
    }
}

/// The level function is that of the side; the flat ends are not part of it, but of the curvature.
impl<T: Real> SmoothSurface<T> for Frustum<T> {
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        let axis = self.axis();
        let (taper, cosine) = (self.taper(), self.side_cosine());
        let from_base = point - self.base_centre();
        let height = from_base.dot(&axis);
        let across = from_base - axis * height;
        let radius = length(&across);
        let outward = unit_or(&across, || any_perpendicular(&axis));
        let flat = Matrix3::identity() - outward * outward.transpose() - axis * axis.transpose();
        let bend = cosine / radius;
        Level {
            value: (radius - self.base_radius() + taper * height) * cosine,
            gradient: (outward + axis * taper) * cosine,
            hessian: if bend.is_number() { flat * bend } else { Matrix3::zeros() },
        }
    }

    fn extent(&self) -> Extent<T> {
        let (centre, radius) = self.bounds();
        Extent { centre, radius }
    }

    fn topology(&self) -> Topology {
        Topology::Convex
    }

    fn shape_operator(&self, point: &Vector3<T>) -> Matrix3<T> {
        let level = self.level(point);
        Face::of(&self.axis(), &level, &self.normal(point)).shape_operator(&level)
    }

    fn bend(&self, point: &Vector3<T>, normal: &Vector3<T>, tangents: [&Vector3<T>; 2]) -> Matrix2<T> {
        let level = self.level(point);
        Face::of(&self.axis(), &level, normal).bend(&level, tangents)
    }

    /// On the rim of the nearer end.
    fn corner(&self, point: &Vector3<T>, normal: &Vector3<T>) -> Option<Corner<T>> {
        let axis = self.axis();
        let from_base = point - self.base_centre();
        let height = from_base.dot(&axis);
        let upper = height > self.height() * T::literal(0.5);
        let radius = if upper { self.top_radius() } else { self.base_radius() };
        if radius.is_zero() {
            return Some(Corner::Tip);
        }
        let outward = unit_or(&(from_base - axis * height), || any_perpendicular(&axis));
        Some(Corner::Edge { direction: axis.cross(&outward), bend: normal.dot(&outward) / radius })
    }
}

/// The level function is that of the side; the flat ends are not part of it, but of the curvature.
impl<T: Real> SmoothSurface<T> for CappedCylinder<T> {
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        self.solid().level(point)
    }

    fn extent(&self) -> Extent<T> {
        self.solid().extent()
    }

    fn topology(&self) -> Topology {
        Topology::Convex
    }

    fn shape_operator(&self, point: &Vector3<T>) -> Matrix3<T> {
        self.solid().shape_operator(point)
    }

    fn bend(&self, point: &Vector3<T>, normal: &Vector3<T>, tangents: [&Vector3<T>; 2]) -> Matrix2<T> {
        self.solid().bend(point, normal, tangents)
    }

    fn corner(&self, point: &Vector3<T>, normal: &Vector3<T>) -> Option<Corner<T>> {
        self.solid().corner(point, normal)
    }
}

impl<T: Real> SmoothSurface<T> for Capsule<T> {
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        let axis = self.axis();
        let from_centre = point - self.centre();
        let height = from_centre.dot(&axis);
        let clamped = height.min(self.half_length()).max(-self.half_length());
        let across = from_centre - axis * clamped;
        let distance = length(&across);
        let normal = unit_or(&across, || any_perpendicular(&axis));
        let mut flat = Matrix3::identity() - normal * normal.transpose();
        if height.abs() < self.half_length() {
            flat -= axis * axis.transpose();
        }
        Level { value: distance - self.radius(), gradient: normal, hessian: flat / distance }
    }

    fn extent(&self) -> Extent<T> {
        Extent { centre: self.centre(), radius: self.half_length() + self.radius() }
    }

    fn topology(&self) -> Topology {
        Topology::Convex
    }
}

impl<T: Real> SmoothSurface<T> for Torus<T> {
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        let radial = hypotenuse(point.x, point.y);
        let outward = unit_or(&Vector3::new(point.x, point.y, T::zero()), Vector3::x);
        let beyond = radial - self.ring_radius();
        let tube = hypotenuse(beyond, point.z);
        let normal = unit_or(&(outward * beyond + Vector3::z() * point.z), || outward);
        let around = Vector3::new(-outward.y, outward.x, T::zero());
        let along = around.cross(&normal);
        // Curvature across the tube, and around the ring.
        let hessian =
            along * along.transpose() / tube + around * around.transpose() * (normal.dot(&outward) / radial);
        Level { value: tube - self.tube_radius(), gradient: normal, hessian }
    }

    fn extent(&self) -> Extent<T> {
        Extent { centre: Vector3::zeros(), radius: self.ring_radius() + self.tube_radius() }
    }

    fn topology(&self) -> Topology {
        Topology::Closed { euler_characteristic: 0 }
    }
}

/// Flat faces, round edges and corners: the curvature jumps where they meet. With a rounding of
/// zero there is no normal at the edges.
impl<T: Real> SmoothSurface<T> for RoundedBox<T> {
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        let core = self.half_extents().map(|half| half - self.rounding());
        let beyond = point.abs() - core;
        let sign = point.map(|x| T::one().copysign(x));
        let outside = beyond.map(|x| x.max(T::zero()));
        let distance = length(&outside);
        if distance > T::zero() {
            let normal = (outside / distance).component_mul(&sign);
            let round =
                Matrix3::from_diagonal(&beyond.map(|x| if x > T::zero() { T::one() } else { T::zero() }));
            return Level {
                value: distance - self.rounding(),
                gradient: normal,
                hessian: (round - normal * normal.transpose()) / distance,
            };
        }
        let face = beyond.imax();
        let mut gradient = Vector3::zeros();
        gradient[face] = sign[face];
        Level { value: beyond[face] - self.rounding(), gradient, hessian: Matrix3::zeros() }
    }

    fn extent(&self) -> Extent<T> {
        Extent { centre: Vector3::zeros(), radius: length(&self.half_extents()) }
    }

    fn topology(&self) -> Topology {
        Topology::Convex
    }
}
