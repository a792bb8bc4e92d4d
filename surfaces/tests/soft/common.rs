//! The shapes that everything is tried on.

use fingertip_surfaces::{
    Capsule, Cone, Cylinder, CylinderEnds, Ellipsoid, EllipticCylinder, Implicit, Paraboloid, Plane,
    RoundedBox, Sphere, Superquadric, Torus,
};
use fingertip_wrench::Real;
use nalgebra::Vector3;

use crate::pillow::Pillow;

pub(crate) fn sphere<T: Real>() -> Sphere<T> {
    Sphere::new(Vector3::new(T::literal(0.001), T::literal(-0.002), T::literal(0.003)), T::literal(0.013))
        .unwrap()
}

pub(crate) fn ellipsoid<T: Real>() -> Ellipsoid<T> {
    Ellipsoid::new(Vector3::new(T::literal(0.008), T::literal(0.011), T::literal(0.017))).unwrap()
}

pub(crate) fn plane<T: Real>() -> Plane<T> {
    let number = T::literal;
    Plane::new(
        Vector3::new(number(0.001), number(0.002), number(0.005)),
        Vector3::new(number(0.1), number(0.3), number(1.0)),
    )
    .unwrap()
}

pub(crate) fn cylinder<T: Real>() -> Cylinder<T> {
    let number = T::literal;
    Cylinder::new(
        Vector3::new(number(0.001), number(0.002), number(-0.001)),
        Vector3::new(number(0.2), number(-0.4), number(1.0)),
        number(0.009),
    )
    .unwrap()
}

pub(crate) fn elliptic_cylinder<T: Real>() -> EllipticCylinder<T> {
    EllipticCylinder::new([T::literal(0.007), T::literal(0.012)], CylinderEnds::Unbounded).unwrap()
}

pub(crate) fn cone<T: Real>() -> Cone<T> {
    let number = T::literal;
    Cone::new(
        Vector3::new(number(0.001), number(-0.001), number(0.004)),
        Vector3::new(number(0.1), number(0.2), number(-1.0)),
        number(0.5),
    )
    .unwrap()
}

pub(crate) fn capsule<T: Real>() -> Capsule<T> {
    let number = T::literal;
    Capsule::new(
        Vector3::zeros(),
        Vector3::new(number(0.3), number(0.1), number(1.0)),
        number(0.006),
        number(0.007),
    )
    .unwrap()
}

pub(crate) fn torus<T: Real>() -> Torus<T> {
    Torus::new(T::literal(0.010), T::literal(0.0035)).unwrap()
}

pub(crate) fn superquadric<T: Real>() -> Superquadric<T> {
    let number = T::literal;
    Superquadric::new(Vector3::new(number(0.008), number(0.010), number(0.013)), [number(0.7), number(0.8)])
        .unwrap()
}

pub(crate) fn rounded_box<T: Real>() -> RoundedBox<T> {
    let number = T::literal;
    RoundedBox::new(Vector3::new(number(0.008), number(0.010), number(0.013)), number(0.004)).unwrap()
}

pub(crate) fn paraboloid<T: Real>() -> Paraboloid<T> {
    Paraboloid::new([T::literal(0.010), T::literal(0.015)]).unwrap()
}

pub(crate) fn pillow<T: Real>() -> Implicit<Pillow> {
    Implicit::new::<T>(Pillow).unwrap()
}

/// A shape of the very numbers that one in single precision has.
pub(crate) trait Widen {
    type Double;
    fn widened(&self) -> Self::Double;
}

fn wide(v: Vector3<f32>) -> Vector3<f64> {
    v.map(f64::from)
}

impl Widen for Sphere<f32> {
    type Double = Sphere<f64>;
    fn widened(&self) -> Sphere<f64> {
        Sphere::new(wide(self.centre()), self.radius().into()).unwrap()
    }
}

impl Widen for Ellipsoid<f32> {
    type Double = Ellipsoid<f64>;
    fn widened(&self) -> Ellipsoid<f64> {
        Ellipsoid::new(wide(self.semi_axes())).unwrap()
    }
}

impl Widen for Paraboloid<f32> {
    type Double = Paraboloid<f64>;
    fn widened(&self) -> Paraboloid<f64> {
        Paraboloid::new(self.radii().map(f64::from)).unwrap()
    }
}

impl Widen for Superquadric<f32> {
    type Double = Superquadric<f64>;
    fn widened(&self) -> Superquadric<f64> {
        Superquadric::new(wide(self.semi_axes()), self.exponents().map(f64::from)).unwrap()
    }
}

impl Widen for Implicit<Pillow> {
    type Double = Self;
    fn widened(&self) -> Self {
        *self
    }
}
