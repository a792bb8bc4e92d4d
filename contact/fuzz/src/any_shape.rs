//! Makes a shape, a wrench and a line of any numbers, and checks what comes out.

use fingertip_contact::*;
use fingertip_surfaces::*;
use fingertip_wrench::{Line, Real, RigidTransform, Wrench};
use nalgebra::Vector3;

/// Hands out the numbers one after the other, from the start again at the end.
struct Numbers<'a, T> {
    all: &'a [T],
    next: usize,
}

impl<T: Real> Numbers<'_, T> {
    fn one(&mut self) -> T {
        let x = self.all[self.next % self.all.len()];
        self.next += 1;
        x
    }

    fn vector(&mut self) -> Vector3<T> {
        Vector3::new(self.one(), self.one(), self.one())
    }

    fn pair(&mut self) -> [T; 2] {
        [self.one(), self.one()]
    }
}

fn is_finite<T: Real>(v: &Vector3<T>) -> bool {
    v.iter().all(|x| x.is_number())
}

fn check<T: Real, S: ActiveSurface<T> + core::fmt::Debug>(surface: &S, numbers: &mut Numbers<'_, T>) {
    let model = PointContact::new(T::zero()).expect("zero is valid");
    let model = model.with_greatest_gap(numbers.one()).unwrap_or(model);
    let model = model.with_greatest_friction(numbers.one()).unwrap_or(model);
    let last = numbers.vector();
    for _ in 0..2 {
        let wrench = Wrench::on_fingertip(numbers.vector(), numbers.vector());
        match model.resolve_near(&wrench, surface, Some(&last)) {
            Resolution::Contact(contact) => {
                assert!(wrench.is_finite());
                assert!(
                    is_finite(&contact.point) && is_finite(&contact.normal),
                    "{surface:?} {wrench:?} {contact:?}"
                );
                assert!(contact.incidence() >= T::zero() && contact.incidence() <= T::one());
                assert!(contact.gap >= T::zero() && contact.gap.is_number());
            }
            Resolution::NoContact(NoContact::Misses {
                closest: Some(ClosestApproach { gap, point: closest, normal, .. }),
            }) => {
                assert!(gap >= T::zero() && gap.is_number(), "{surface:?} {wrench:?} {gap}");
                assert!(
                    is_finite(&closest) && is_finite(&normal),
                    "{surface:?} {wrench:?} {closest:?} {normal:?}"
                );
            }
            Resolution::NoContact(_) => {}
        }
        let mut count = 0;
        let _ = model.candidates(&wrench, surface, |_| count += 1);
        assert!(count < 1000);
    }
    // No promise on a line without a unit direction, but to return.
    let line = Line { point: numbers.vector(), direction: numbers.vector() };
    surface.crossings(&line, |_| ());
    let _ = surface.closest_approach(&line);
    let _ = surface.contains(&line.point);
    let normal = surface.normal(&line.point);
    assert!(!is_finite(&line.point) || is_finite(&normal), "{surface:?} {line:?} {normal:?}");
}

fn any_shape<T: Real>(kind: u8, all: &[T]) {
    let mut n = Numbers { all, next: 0 };
    macro_rules! on {
        ($shape:expr) => {
            if let Ok(shape) = $shape {
                check(&shape, &mut n);
            }
        };
    }
    match kind % 24 {
        0 => on!(Plane::new(n.vector(), n.vector())),
        1 => on!(Disk::new(n.vector(), n.vector(), n.one())),
        2 => on!(Rectangle::new(n.vector(), n.vector(), n.vector())),
        3 => on!(Sphere::new(n.vector(), n.one())),
        4 => on!(Sphere::new(n.vector(), n.one()).and_then(|sphere| SphericalCap::with_opening(
            sphere,
            n.vector(),
            n.one()
        ))),
        5 => on!(Ellipsoid::new(n.vector())),
        6 => on!(Cylinder::new(n.vector(), n.vector(), n.one())
            .map(|cylinder| cylinder.with_half_length(n.one()).unwrap_or(cylinder))),
        7 => on!(CappedCylinder::new(n.vector(), n.vector(), n.one(), n.one())),
        8 => on!(EllipticCylinder::new(n.pair(), CylinderEnds::Unbounded)),
        9 => on!(EllipticCylinder::new(n.pair(), CylinderEnds::Open(n.one()))),
        10 => on!(EllipticCylinder::new(n.pair(), CylinderEnds::Capped(n.one()))),
        11 => on!(Capsule::new(n.vector(), n.vector(), n.one(), n.one())),
        12 => {
            on!(Cone::new(n.vector(), n.vector(), n.one())
                .map(|cone| cone.with_depth(n.one()).unwrap_or(cone)))
        }
        13 => on!(Frustum::new(n.vector(), n.vector(), n.one(), n.one(), n.one())),
        14 => on!(Torus::new(n.one(), n.one())),
        15 => on!(Superquadric::new(n.vector(), n.pair())),
        16 => on!(RoundedBox::new(n.vector(), n.one())),
        17 => on!(Paraboloid::new(n.pair()).map(|dome| dome.with_depth(n.one()).unwrap_or(dome))),
        18 => on!(Revolution::from_profile([n.pair(), n.pair(), n.pair(), n.pair()])),
        19 => on!(Heightfield::new(n.pair(), n.pair(), 3, (0..9).map(|_| n.one()).collect())),
        20 => {
            let vertices: Vec<_> = (0..4).map(|_| n.vector()).collect();
            on!(Mesh::new(&vertices, &[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]));
        }
        21 => on!(RigidTransform::from_axis_angle(n.vector(), n.vector())
            .ok()
            .zip(Ellipsoid::new(n.vector()).ok())
            .map(|(pose, shape)| Posed::new(shape, pose))
            .ok_or(())),
        22 => on!(Sphere::new(n.vector(), n.one()).and_then(|a| Capsule::new(
            n.vector(),
            n.vector(),
            n.one(),
            n.one()
        )
        .map(|b| Compound::new(a, b)))),
        _ => on!(Torus::new(n.one(), n.one()).and_then(|torus| Offset::new(torus, n.one()))),
    }
}

/// Any bits as double-precision numbers.
pub(crate) fn check_f64(kind: u8, bits: &[u64]) {
    let numbers: Vec<f64> = bits.iter().map(|b| f64::from_bits(*b)).collect();
    any_shape(kind, &numbers);
}

/// Any bits as single-precision numbers.
pub(crate) fn check_f32(kind: u8, bits: &[u32]) {
    let numbers: Vec<f32> = bits.iter().map(|b| f32::from_bits(*b)).collect();
    any_shape(kind, &numbers);
}
