//! Random shapes, each with a place on it. The report of the benches shares this file.

use fingertip_surfaces::{
    CappedCylinder, Capsule, Cone, Cylinder, CylinderEnds, Ellipsoid, EllipticCylinder, Frustum, Knot,
    Paraboloid, Plane, Posed, Revolution, RoundedBox, Sphere, Superquadric, Torus,
};
use fingertip_wrench::{Real, RigidTransform};
use nalgebra::Vector3;

use crate::wrenches::Random;

/// A shape of about a size, a place on it (but for the rounding of its numbers) and the normal there.
pub(crate) trait Drawn: Sized {
    fn draw(random: &mut Random, size: f64) -> (Self, Vector3<f64>, Vector3<f64>);

    /// With the place on an edge or a tip, for shapes that have one.
    fn draw_edge(random: &mut Random, size: f64) -> Option<(Self, Vector3<f64>, Vector3<f64>)> {
        let _ = (random, size);
        None
    }
}

fn vector<T: Real>(v: Vector3<f64>) -> Vector3<T> {
    v.map(T::literal)
}

/// A point aside, or none.
fn aside(random: &mut Random, size: f64) -> Vector3<f64> {
    random.direction() * (random.uniform(-1.0, 3.0).max(0.0) * size)
}

/// An axis and a unit vector across it.
fn axes(random: &mut Random) -> (Vector3<f64>, Vector3<f64>) {
    let axis = if random.uniform(0.0, 1.0) < 0.3 { Vector3::z() } else { random.direction() };
    let any = random.direction();
    (axis, (any - axis * any.dot(&axis)).normalize())
}

impl<T: Real> Drawn for Plane<T> {
    fn draw(random: &mut Random, size: f64) -> (Self, Vector3<f64>, Vector3<f64>) {
        let (normal, across) = axes(random);
        let origin = aside(random, size);
        let surface = Self::new(vector(origin), vector(normal)).unwrap();
        (surface, origin + across * size, normal)
    }
}

impl<T: Real> Drawn for Sphere<T> {
    fn draw(random: &mut Random, size: f64) -> (Self, Vector3<f64>, Vector3<f64>) {
        let (centre, normal) = (aside(random, size), random.direction());
        (Self::new(vector(centre), T::literal(size)).unwrap(), centre + normal * size, normal)
    }
}

impl<T: Real> Drawn for Ellipsoid<T> {
    fn draw(random: &mut Random, size: f64) -> (Self, Vector3<f64>, Vector3<f64>) {
        let axes = Vector3::from_fn(|_, _| size * random.log_uniform(0.2, 1.0));
        let n = random.direction();
        let normal = n.component_div(&axes).normalize();
        (Self::new(vector(axes)).unwrap(), n.component_mul(&axes), normal)
    }
}

impl<T: Real> Drawn for Paraboloid<T> {
    fn draw(random: &mut Random, size: f64) -> (Self, Vector3<f64>, Vector3<f64>) {
        let [a, b] = [0; 2].map(|_| size * random.log_uniform(0.3, 1.0));
        let [x, y] = [0; 2].map(|_| size * random.uniform(-0.7, 0.7));
        let point = Vector3::new(x, y, -(x * x / a + y * y / b) / 2.0);
        (Self::new([a, b].map(T::literal)).unwrap(), point, Vector3::new(x / a, y / b, 1.0).normalize())
    }
}

impl<T: Real> Drawn for Cylinder<T> {
    fn draw(random: &mut Random, size: f64) -> (Self, Vector3<f64>, Vector3<f64>) {
        let (axis, out) = axes(random);
        let centre = aside(random, size);
        let surface = Self::new(vector(centre), vector(axis), T::literal(size)).unwrap();
        (surface, centre + out * size + axis * random.uniform(-2.0, 2.0) * size, out)
    }
}

impl<T: Real> Drawn for EllipticCylinder<T> {
    fn draw(random: &mut Random, size: f64) -> (Self, Vector3<f64>, Vector3<f64>) {
        let [a, b] = [size, size * random.log_uniform(0.3, 1.0)];
        let angle = random.uniform(0.0, core::f64::consts::TAU);
        let (x, y) = (angle.cos(), angle.sin());
        let half = size * random.uniform(0.5, 2.0);
        let ends = if random.uniform(0.0, 1.0) < 0.5 {
            CylinderEnds::Unbounded
        } else {
            CylinderEnds::Capped(T::literal(half))
        };
        let point = Vector3::new(x * a, y * b, random.uniform(-0.99, 0.99) * half);
        let surface = Self::new([a, b].map(T::literal), ends).unwrap();
        (surface, point, Vector3::new(x / a, y / b, 0.0).normalize())
    }
}

/// On the side or on an end, or on an edge.
fn on_solid(
    random: &mut Random,
    edge: bool,
    (axis, out): (Vector3<f64>, Vector3<f64>),
    base: Vector3<f64>,
    height: f64,
    [below, above]: [f64; 2],
) -> (Vector3<f64>, Vector3<f64>) {
    let side = (out + axis * ((below - above) / height)).normalize();
    let (end, radius, outward) = if random.uniform(0.0, 1.0) < 0.5 {
        (base, below, -axis)
    } else {
        (base + axis * height, above, axis)
    };
    let share = random.uniform(0.01, 0.99);
    if edge {
        (end + out * radius, (side * share + outward * (1.0 - share)).normalize())
    } else if random.uniform(0.0, 1.0) < 0.7 {
        (base + axis * (height * share) + out * (below + (above - below) * share), side)
    } else if radius > 0.0 {
        (end + out * (radius * share), outward)
    } else {
        (base + out * (below * share), -axis)
    }
}

fn capped_cylinder<T: Real>(
    random: &mut Random,
    size: f64,
    edge: bool,
) -> (CappedCylinder<T>, Vector3<f64>, Vector3<f64>) {
    let (axes, centre) = (axes(random), aside(random, size));
    let half = size * random.log_uniform(0.2, 2.0);
    let (point, normal) = on_solid(random, edge, axes, centre - axes.0 * half, half + half, [size; 2]);
    let [radius, half] = [size, half].map(T::literal);
    (CappedCylinder::new(vector(centre), vector(axes.0), radius, half).unwrap(), point, normal)
}

impl<T: Real> Drawn for CappedCylinder<T> {
    fn draw(random: &mut Random, size: f64) -> (Self, Vector3<f64>, Vector3<f64>) {
        capped_cylinder(random, size, false)
    }

    fn draw_edge(random: &mut Random, size: f64) -> Option<(Self, Vector3<f64>, Vector3<f64>)> {
        Some(capped_cylinder(random, size, true))
    }
}

fn frustum<T: Real>(random: &mut Random, size: f64, edge: bool) -> (Frustum<T>, Vector3<f64>, Vector3<f64>) {
    let (axes, base) = (axes(random), aside(random, size));
    let height = size * random.log_uniform(0.3, 3.0);
    let top = if random.uniform(0.0, 1.0) < 0.3 { 0.0 } else { size * random.uniform(0.1, 0.9) };
    let (point, normal) = on_solid(random, edge, axes, base, height, [size, top]);
    let [height, bottom, top] = [height, size, top].map(T::literal);
    (Frustum::new(vector(base), vector(axes.0), bottom, top, height).unwrap(), point, normal)
}

impl<T: Real> Drawn for Frustum<T> {
    fn draw(random: &mut Random, size: f64) -> (Self, Vector3<f64>, Vector3<f64>) {
        frustum(random, size, false)
    }

    fn draw_edge(random: &mut Random, size: f64) -> Option<(Self, Vector3<f64>, Vector3<f64>)> {
        Some(frustum(random, size, true))
    }
}

impl<T: Real> Drawn for Capsule<T> {
    fn draw(random: &mut Random, size: f64) -> (Self, Vector3<f64>, Vector3<f64>) {
        let ((axis, out), centre) = (axes(random), aside(random, size));
        let half = size * random.log_uniform(0.2, 2.0);
        let (from, normal) = if random.uniform(0.0, 1.0) < 0.5 {
            (axis * half * random.uniform(-0.99, 0.99), out)
        } else {
            let normal = random.direction();
            (axis * half.copysign(normal.dot(&axis)), normal)
        };
        let [half, radius] = [half, size].map(T::literal);
        let surface = Self::new(vector(centre), vector(axis), radius, half).unwrap();
        (surface, centre + from + normal * size, normal)
    }
}

fn cone<T: Real>(random: &mut Random, size: f64, tip: bool) -> (Cone<T>, Vector3<f64>, Vector3<f64>) {
    let ((axis, out), apex) = (axes(random), aside(random, size));
    let angle = T::literal(random.uniform(0.1, 1.4));
    let (sine, cosine) = angle.to_f64().sin_cos();
    let (away, normal) = if tip {
        (0.0, (-axis + out * random.uniform(0.0, 0.99) * cosine / sine).normalize())
    } else {
        (size * random.log_uniform(0.05, 1.0), out * cosine - axis * sine)
    };
    let point = apex + (axis * cosine + out * sine) * away;
    (Cone::new(vector(apex), vector(axis), angle).unwrap(), point, normal)
}

impl<T: Real> Drawn for Cone<T> {
    fn draw(random: &mut Random, size: f64) -> (Self, Vector3<f64>, Vector3<f64>) {
        cone(random, size, false)
    }

    fn draw_edge(random: &mut Random, size: f64) -> Option<(Self, Vector3<f64>, Vector3<f64>)> {
        Some(cone(random, size, true))
    }
}

impl<T: Real> Drawn for Torus<T> {
    fn draw(random: &mut Random, size: f64) -> (Self, Vector3<f64>, Vector3<f64>) {
        let share = random.log_uniform(0.05, 0.9);
        let (ring, tube) = (size / (1.0 + share), size * share / (1.0 + share));
        let angle = random.uniform(0.0, core::f64::consts::TAU);
        let out = Vector3::new(angle.cos(), angle.sin(), 0.0);
        let around = random.uniform(0.0, core::f64::consts::TAU);
        let normal = out * around.cos() + Vector3::z() * around.sin();
        let surface = Self::new(T::literal(ring), T::literal(tube)).unwrap();
        (surface, out * ring + normal * tube, normal)
    }
}

impl<T: Real> Drawn for RoundedBox<T> {
    fn draw(random: &mut Random, size: f64) -> (Self, Vector3<f64>, Vector3<f64>) {
        let half = Vector3::from_fn(|_, _| size * random.uniform(0.4, 1.0));
        let rounding = half.min() * random.uniform(0.1, 0.9);
        let core = half.map(|x| x - rounding);
        let mut normal = random.direction();
        for k in 0..3 {
            if random.uniform(0.0, 1.0) < 0.5 && normal.norm() > normal[k].abs() {
                normal[k] = 0.0;
            }
        }
        let normal = normal.normalize();
        let point = Vector3::from_fn(|k, _| {
            if normal[k] == 0.0 { core[k] * random.uniform(-0.99, 0.99) } else { core[k].copysign(normal[k]) }
        });
        (Self::new(vector(half), T::literal(rounding)).unwrap(), point + normal * rounding, normal)
    }
}

impl<T: Real> Drawn for Revolution<T, [Knot<T>; 2]> {
    fn draw(random: &mut Random, size: f64) -> (Self, Vector3<f64>, Vector3<f64>) {
        let [r0, r1] = [size * 0.5, size * random.uniform(0.1, 0.45)];
        let height = size * random.uniform(0.5, 1.5);
        let rise = (r1 * r1 - r0 * r0) / height;
        let z = height * random.uniform(0.05, 0.95);
        let angle = random.uniform(0.0, core::f64::consts::TAU);
        let out = Vector3::new(angle.cos(), angle.sin(), 0.0);
        let radius = (r0 * r0 + rise * z).sqrt();
        let profile = [[0.0, r0], [height, r1]].map(|point| point.map(T::literal));
        let normal = (out * radius - Vector3::z() * (rise / 2.0)).normalize();
        (Self::from_profile(profile).unwrap(), out * radius + Vector3::z() * z, normal)
    }
}

impl<T: Real> Drawn for Superquadric<T> {
    fn draw(random: &mut Random, size: f64) -> (Self, Vector3<f64>, Vector3<f64>) {
        let axes = Vector3::from_fn(|_, _| size * random.log_uniform(0.2, 1.0));
        let exponents = [0; 2].map(|_| random.uniform(0.2, 1.8));
        let surface = Superquadric::<f64>::new(axes, exponents).unwrap();
        // Onto it along the ray from the centre.
        let away = random.direction().component_mul(&axes);
        let line = fingertip_wrench::Line { point: Vector3::zeros(), direction: away.normalize() };
        let mut found = (away, away);
        fingertip_surfaces::ActiveSurface::crossings(&surface, &line, |crossing| {
            if crossing.along > 0.0 {
                found = (crossing.point, crossing.normal);
            }
        });
        let surface = Self::new(vector(axes), exponents.map(T::literal)).unwrap();
        (surface, found.0, found.1)
    }
}

/// A drawn shape somewhere else.
fn posed<T: Real, S>(
    random: &mut Random,
    size: f64,
    (surface, point, normal): (S, Vector3<f64>, Vector3<f64>),
) -> (Posed<T, S>, Vector3<f64>, Vector3<f64>) {
    let turn = random.direction() * random.uniform(0.0, 3.0);
    let pose = RigidTransform::from_axis_angle(vector::<T>(turn), vector(aside(random, size))).unwrap();
    let (rotation, origin) = (pose.rotation().map(Real::to_f64), pose.origin().map(Real::to_f64));
    (Posed::new(surface, pose), rotation * point + origin, (rotation * normal).normalize())
}

impl<T: Real, S: Drawn + Clone> Drawn for Posed<T, S> {
    fn draw(random: &mut Random, size: f64) -> (Self, Vector3<f64>, Vector3<f64>) {
        let drawn = S::draw(random, size);
        posed(random, size, drawn)
    }

    fn draw_edge(random: &mut Random, size: f64) -> Option<(Self, Vector3<f64>, Vector3<f64>)> {
        let drawn = S::draw_edge(random, size)?;
        Some(posed(random, size, drawn))
    }
}
