//! Random contacts on any shape.

use fingertip_surfaces::{
    ActiveSurface, Capsule, Cone, Cylinder, CylinderEnds, Ellipsoid, EllipticCylinder, Implicit,
    ImplicitBounds, ImplicitSurface, Paraboloid, Plane, RoundedBox, SmoothImplicit, Sphere, Superquadric,
    Topology, Torus,
};
use fingertip_wrench::{Line, Real, Wrench};
use nalgebra::{Matrix3, Vector3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

pub(crate) struct Random(pub(crate) Pcg64Mcg);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(Pcg64Mcg::seed_from_u64(seed))
    }

    pub(crate) fn uniform(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.random::<f64>()
    }

    pub(crate) fn log_uniform(&mut self, low: f64, high: f64) -> f64 {
        self.uniform(low.ln(), high.ln()).exp()
    }

    pub(crate) fn sign(&mut self) -> f64 {
        if self.0.random::<bool>() { 1.0 } else { -1.0 }
    }

    pub(crate) fn direction(&mut self) -> Vector3<f64> {
        let z = self.uniform(-1.0, 1.0);
        let angle = self.uniform(0.0, core::f64::consts::TAU);
        let r = (1.0 - z * z).sqrt();
        Vector3::new(r * angle.cos(), r * angle.sin(), z)
    }

    pub(crate) fn normal(&mut self) -> f64 {
        let (u, v) = (1.0 - self.0.random::<f64>(), self.0.random::<f64>());
        (-2.0 * u.ln()).sqrt() * (core::f64::consts::TAU * v).cos()
    }

    /// A point of the surface within a ball around the origin, with its normal.
    pub(crate) fn place<S: ActiveSurface<f64>>(
        &mut self,
        surface: &S,
        reach: f64,
    ) -> (Vector3<f64>, Vector3<f64>) {
        loop {
            let point = self.direction() * self.uniform(0.0, reach);
            let line = Line { point, direction: self.direction() };
            let mut seen = Vec::new();
            surface.crossings(&line, |c| {
                if c.point.norm() <= reach * 1.8 && c.active {
                    seen.push((c.point, c.normal));
                }
            });
            if !seen.is_empty() {
                return seen[self.0.random_range(0..seen.len())];
            }
        }
    }

    /// A force that presses on a normal, with an incidence of at least `least`.
    pub(crate) fn force(&mut self, normal: &Vector3<f64>, least: f64, magnitude: f64) -> Vector3<f64> {
        loop {
            let direction = self.direction();
            if -direction.dot(normal) >= least {
                return direction * magnitude;
            }
        }
    }
}

/// A wrench with the contact that it came from.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Case {
    pub(crate) wrench: Wrench<f64>,
    pub(crate) point: Vector3<f64>,
    pub(crate) normal: Vector3<f64>,
    pub(crate) spin: f64,
    pub(crate) incidence: f64,
}

impl Case {
    pub(crate) fn new(point: Vector3<f64>, normal: Vector3<f64>, force: Vector3<f64>, spin: f64) -> Self {
        Self {
            wrench: Wrench::on_fingertip(force, point.cross(&force) + normal * spin),
            point,
            normal,
            spin,
            incidence: -force.dot(&normal) / force.norm(),
        }
    }

    /// With a relative spin torque between the bounds, in units of force times size.
    pub(crate) fn random<S: ActiveSurface<f64>>(
        random: &mut Random,
        surface: &S,
        size: f64,
        spins: [f64; 2],
        magnitude: f64,
    ) -> Self {
        let (point, normal) = random.place(surface, size);
        let force = random.force(&normal, 0.05, magnitude);
        let spin = random.sign() * random.log_uniform(spins[0], spins[1]) * magnitude * size;
        Self::new(point, normal, force, spin)
    }
}

/// `x⁴/a⁴ + y⁴/b⁴ + z⁴/c⁴ + (x² + y² + z²)/d² = 1`: convex, with analytic second derivatives.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pillow;

impl<T: Real> ImplicitSurface<T> for Pillow {
    fn value(&self, p: &Vector3<T>) -> T {
        let q = p.component_mul(p) * T::literal(1e4);
        (q.norm_squared() + q.sum() * T::literal(0.5) - T::one()) * T::literal(0.5)
    }

    fn gradient(&self, p: &Vector3<T>) -> Vector3<T> {
        let q = p * T::literal(100.0);
        (q.map(|x| x * x * x) * T::literal(2.0) + q * T::literal(0.5)) * T::literal(100.0)
    }

    fn bounds(&self) -> ImplicitBounds<T> {
        ImplicitBounds { centre: Vector3::zeros(), radius: T::literal(0.0121), steepest: T::literal(420.0) }
    }
}

impl<T: Real> SmoothImplicit<T> for Pillow {
    fn hessian(&self, p: &Vector3<T>) -> Matrix3<T> {
        let q = p * T::literal(100.0);
        Matrix3::from_diagonal(&q.map(|x| (x * x * T::literal(6.0) + T::literal(0.5)) * T::literal(1e4)))
    }

    fn topology(&self) -> Topology {
        Topology::Convex
    }
}

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
