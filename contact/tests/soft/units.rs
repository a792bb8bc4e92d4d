//! Answers know no unit of force and no unit of length.

use fingertip_contact::{ContactModel, NoContact, Resolution, SoftFinger, SoftFingerSurface};
use fingertip_surfaces::testing::ball_of_triangles;
use fingertip_surfaces::{
    ActiveSurface, CappedCylinder, Capsule, Cone, Cylinder, CylinderEnds, Disk, Ellipsoid, EllipticCylinder,
    Frustum, Heightfield, Mesh, Offset, Paraboloid, Plane, Revolution, RoundedBox, Sphere, Superquadric,
    Torus,
};
use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;

use crate::wrenches::Random;

/// One of: a force through anywhere with any torque, one that presses flatly with more or less spin, and one
/// along the line through a point of the surface.
fn some_wrench(
    random: &mut Random,
    surface: &impl ActiveSurface<f64>,
    size: f64,
) -> (Vector3<f64>, Vector3<f64>) {
    let spin = random.log_uniform(1e-6, 3.0) * size;
    match random.uniform(0.0, 3.0) as u8 {
        0 => {
            let (through, force) = (random.direction() * random.uniform(0.0, size), random.direction());
            (force, through.cross(&force) + random.direction() * spin)
        }
        1 => {
            let (point, normal) = random.place(surface, size);
            let aside = random.direction().cross(&normal).normalize();
            let force = (aside - normal * random.log_uniform(1e-5, 0.3)).normalize();
            (force, point.cross(&force) + normal * spin)
        }
        _ => {
            let (point, normal) = random.place(surface, size);
            let force = random.force(&normal, 0.05, 1.0);
            (force, point.cross(&force))
        }
    }
}

/// The same fingertip and wrench in units of lengths and forces that are powers of two give the same answers: to
/// the last bit where the wrench is scaled first (`loose` is zero), to some units in the last place where that
/// would cost more than the contact.
fn check<T: Real, S: SoftFingerSurface<T>>(
    name: &str,
    shape: &dyn Fn(T) -> S,
    double: &impl ActiveSurface<f64>,
    [forces, lengths]: [i32; 2],
    [rounds, loose]: [u32; 2],
) {
    let model = SoftFinger::new(T::zero()).unwrap().without_friction_limit();
    let mut random = Random::new(29);
    let mut contacts = 0;
    let power = |power: i32| T::literal(2_f64.powi(power));
    let surface = shape(T::one());
    for (force_power, length_power) in
        [(forces, 0), (-forces, 0), (0, lengths), (0, -lengths), (forces, -lengths)]
    {
        let (unit, length) = (power(force_power), power(length_power));
        let scaled = shape(length);
        for _ in 0..rounds {
            let (force, torque) = some_wrench(&mut random, double, 0.012);
            let (force, torque) = (force.map(T::literal), torque.map(T::literal));
            let ours = model.resolve(&Wrench::on_fingertip(force, torque), &surface);
            let wrench = Wrench::on_fingertip(force * unit, torque * (unit * length));
            let theirs = model.resolve(&wrench, &scaled);
            let same = match (ours, theirs) {
                (Resolution::Contact(ours), Resolution::Contact(theirs)) => {
                    contacts += 1;
                    let flat = T::literal(f64::from(loose)) * T::EPSILON / ours.incidence();
                    let size = T::literal(0.012) + ours.point.amax();
                    (ours.point - theirs.point / length).amax() <= flat * size
                        && (ours.normal - theirs.normal).amax() <= flat
                        && (ours.spin_torque - theirs.spin_torque / (unit * length)).abs() <= flat * size
                        && ours.alternatives == theirs.alternatives
                }
                (
                    Resolution::NoContact(NoContact::Misses { closest }),
                    Resolution::NoContact(NoContact::Misses { closest: other }),
                ) => {
                    let size = T::literal(0.012 * f64::from(loose)) * T::EPSILON;
                    closest.zip(other).is_none_or(|(a, b)| (a.gap - b.gap / length).abs() <= size)
                        && closest.is_some() == other.is_some()
                }
                (Resolution::NoContact(ours), Resolution::NoContact(theirs)) => {
                    core::mem::discriminant(&ours) == core::mem::discriminant(&theirs)
                }
                _ => false,
            };
            assert!(same, "{name} {unit} {length} {force:?} {torque:?}: {ours:?} {theirs:?}");
        }
    }
    assert!(contacts > rounds, "{name}: {contacts} of {rounds}");
}

/// Shapes with their lengths times a unit.
mod shapes {
    use super::*;

    fn at<T: Real>(unit: T, x: f64, y: f64, z: f64) -> Vector3<T> {
        Vector3::new(x, y, z).map(T::literal) * unit
    }

    fn size<T: Real>(unit: T, x: f64) -> T {
        T::literal(x) * unit
    }

    pub(super) fn sphere<T: Real>(u: T) -> Sphere<T> {
        Sphere::new(at(u, 0.001, -0.002, 0.003), size(u, 0.011)).unwrap()
    }

    pub(super) fn ellipsoid<T: Real>(u: T) -> Ellipsoid<T> {
        Ellipsoid::new(at(u, 0.006, 0.008, 0.012)).unwrap()
    }

    pub(super) fn plane<T: Real>(u: T) -> Plane<T> {
        Plane::new(at(u, 0.001, 0.002, 0.005), at(T::one(), 0.1, 0.3, 1.0)).unwrap()
    }

    pub(super) fn disk<T: Real>(u: T) -> Disk<T> {
        Disk::new(at(u, 0.001, 0.002, 0.005), at(T::one(), 0.1, 0.3, 1.0), size(u, 0.012)).unwrap()
    }

    pub(super) fn cylinder<T: Real>(u: T) -> Cylinder<T> {
        Cylinder::new(at(u, 0.001, 0.002, -0.001), at(T::one(), 0.2, -0.4, 1.0), size(u, 0.009)).unwrap()
    }

    pub(super) fn elliptic_cylinder<T: Real>(u: T) -> EllipticCylinder<T> {
        let axes = [size(u, 0.007), size(u, 0.012)];
        EllipticCylinder::new(axes, CylinderEnds::Capped(size(u, 0.01))).unwrap()
    }

    pub(super) fn cone<T: Real>(u: T) -> Cone<T> {
        Cone::new(at(u, 0.001, -0.001, 0.008), at(T::one(), 0.1, 0.2, -1.0), T::literal(0.5)).unwrap()
    }

    pub(super) fn capsule<T: Real>(u: T) -> Capsule<T> {
        Capsule::new(at(u, 0.0, 0.001, 0.0), at(T::one(), 0.3, 0.1, 1.0), size(u, 0.007), size(u, 0.006))
            .unwrap()
    }

    pub(super) fn torus<T: Real>(u: T) -> Torus<T> {
        Torus::new(size(u, 0.010), size(u, 0.0035)).unwrap()
    }

    pub(super) fn superquadric<T: Real>(u: T) -> Superquadric<T> {
        Superquadric::new(at(u, 0.008, 0.010, 0.013), [0.7, 0.8].map(T::literal)).unwrap()
    }

    pub(super) fn rounded_box<T: Real>(u: T) -> RoundedBox<T> {
        RoundedBox::new(at(u, 0.008, 0.010, 0.013), size(u, 0.004)).unwrap()
    }

    pub(super) fn paraboloid<T: Real>(u: T) -> Paraboloid<T> {
        Paraboloid::new([size(u, 0.010), size(u, 0.015)]).unwrap()
    }

    pub(super) fn capped_cylinder<T: Real>(u: T) -> CappedCylinder<T> {
        let (centre, axis) = (at(u, 0.001, 0.0, -0.001), at(T::one(), 0.2, -0.4, 1.0));
        CappedCylinder::new(centre, axis, size(u, 0.009), size(u, 0.010)).unwrap()
    }

    pub(super) fn frustum<T: Real>(u: T) -> Frustum<T> {
        let (base, axis) = (at(u, 0.001, 0.0, -0.008), at(T::one(), 0.1, 0.2, 1.0));
        Frustum::new(base, axis, size(u, 0.010), size(u, 0.006), size(u, 0.016)).unwrap()
    }

    pub(super) fn revolution<T: Real>(u: T) -> impl SoftFingerSurface<T> {
        let profile = [[0.0, 0.0080], [0.004, 0.0080], [0.008, 0.0074], [0.012, 0.0052], [0.014, 0.0]];
        Revolution::from_profile(profile.map(|knot| knot.map(|x| size(u, x)))).unwrap()
    }

    pub(super) fn heightfield<T: Real>(u: T) -> Heightfield<T> {
        let at = |k: usize| 0.002 * k as f64 - 0.008;
        let height = |k: usize| -(at(k % 9).powi(2) / 0.020 + at(k / 9).powi(2) / 0.030);
        let heights = (0..81).map(|k| size(u, height(k))).collect();
        Heightfield::new([size(u, -0.008); 2], [size(u, 0.002); 2], 9, heights).unwrap()
    }

    pub(super) fn mesh<T: Real>(u: T) -> Mesh<T> {
        let (vertices, triangles) = ball_of_triangles::<T>(7, 9, None);
        let vertices: Vec<_> = vertices.iter().map(|v| v * size(u, 0.012)).collect();
        Mesh::new(&vertices, &triangles).unwrap()
    }

    pub(super) fn offset<T: Real>(u: T) -> Offset<T, Ellipsoid<T>> {
        Offset::new(ellipsoid(u), size(u, 0.002)).unwrap()
    }
}

macro_rules! units_test {
    ($($name:ident, $rounds:literal, $loose:literal;)*) => {$(
        #[test]
        fn $name() {
            let (name, sizes) = (stringify!($name), [$rounds, $loose]);
            check(name, &shapes::$name::<f64>, &shapes::$name(1.0_f64), [300, 30], sizes);
            check(name, &shapes::$name::<f32>, &shapes::$name(1.0_f64), [30, 12], sizes);
        }
    )*};
}

units_test! {
    sphere, 600, 0;
    ellipsoid, 600, 16;
    plane, 600, 0;
    disk, 600, 0;
    cylinder, 600, 0;
    elliptic_cylinder, 300, 16;
    cone, 600, 16;
    capsule, 300, 16;
    torus, 50, 0;
    superquadric, 50, 0;
    rounded_box, 150, 16;
    paraboloid, 150, 0;
    capped_cylinder, 300, 16;
    frustum, 300, 16;
    revolution, 50, 0;
    heightfield, 50, 0;
    mesh, 50, 0;
    offset, 50, 0;
}
