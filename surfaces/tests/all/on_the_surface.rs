//! Points exactly on a surface and on the bounds of what may touch.

use fingertip_surfaces::*;
use fingertip_wrench::{Line, RigidTransform};
use nalgebra::Vector3;

use crate::every_shape::{approach, crossings, v};

type Point = Vector3<f64>;

/// A closed shape, a point within it, and points of its surface.
fn closed() -> Vec<(&'static str, DynSurface<f64>, Point, Vec<Point>)> {
    let (o, z) = (Vector3::zeros(), Vector3::z());
    let at = v(1.0, -2.0, 0.5);
    let moved = |points: &[[f64; 3]]| points.iter().map(|p| at + Vector3::from(*p)).collect();
    let points = |points: &[[f64; 3]]| points.iter().map(|p| Vector3::from(*p)).collect();
    let pose = RigidTransform::from_parts(nalgebra::Rotation3::identity(), at);
    let unit = [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]];
    let sphere = Sphere::new(at, 1.0).unwrap();
    let turned = [[-1.0, 1.0], [1.0, 1.0]];
    vec![
        ("plane", Plane::new(at, z).unwrap().into(), at - z, moved(&[[0.0; 3], [5.0, 7.0, 0.0]])),
        ("sphere", sphere.into(), at, moved(&unit)),
        ("cap", SphericalCap::new(sphere, z, 0.0).unwrap().into(), at, moved(&unit)),
        ("ellipsoid", Ellipsoid::new(v(1.0, 1.0, 1.0)).unwrap().into(), o, points(&unit)),
        (
            "cylinder",
            Cylinder::new(at, z, 1.0).unwrap().into(),
            at + z * 9.0,
            moved(&[[1.0, 0.0, 0.0], [0.0, -1.0, 7.0]]),
        ),
        (
            "capped cylinder",
            CappedCylinder::new(at, z, 1.0, 2.0).unwrap().into(),
            at,
            moved(&[[1.0, 0.0, 0.0], [0.0, -1.0, 1.0], [0.5, 0.0, 2.0], [0.0, 0.25, -2.0]]),
        ),
        (
            "elliptic cylinder",
            EllipticCylinder::new([1.0, 0.5], CylinderEnds::Capped(2.0)).unwrap().into(),
            o,
            points(&[[1.0, 0.0, 1.0], [0.0, -0.5, 0.0], [0.5, 0.0, 2.0], [0.0, 0.25, -2.0]]),
        ),
        (
            "capsule",
            Capsule::new(at, z, 0.5, 1.0).unwrap().into(),
            at,
            moved(&[[0.5, 0.0, 0.0], [0.0, -0.5, 1.0], [0.0, 0.0, 1.5], [0.0, 0.0, -1.5]]),
        ),
        (
            "frustum",
            Frustum::new(at, z, 2.0, 1.0, 2.0).unwrap().into(),
            at + z,
            moved(&[[1.5, 0.0, 1.0], [0.0, 1.5, 0.0], [0.5, 0.0, 2.0], [0.0, 0.0, 0.0]]),
        ),
        ("torus", Torus::new(1.0, 0.5).unwrap().into(), v(1.0, 0.0, 0.0), {
            points(&[[1.5, 0.0, 0.0], [0.5, 0.0, 0.0], [1.0, 0.0, 0.5], [1.0, 0.0, -0.5]])
        }),
        ("superquadric", Superquadric::new(v(1.0, 1.0, 1.0), [0.5, 0.5]).unwrap().into(), o, points(&unit)),
        (
            "rounded box",
            RoundedBox::new(v(1.0, 1.0, 1.0), 0.25).unwrap().into(),
            o,
            points(&[[1.0, 0.0, 0.5], [0.0, -1.0, 0.0], [0.75, 0.25, 1.0]]),
        ),
        (
            "paraboloid",
            Paraboloid::new([1.0, 0.5]).unwrap().into(),
            -z,
            points(&[[0.0; 3], [1.0, 0.0, -0.5], [0.0, -1.0, -1.0]]),
        ),
        (
            "revolution",
            DynSurface::Revolution(Revolution::from_points(&turned).unwrap()),
            o,
            points(&[[1.0, 0.0, 0.5], [0.0, -1.0, 0.0], [0.25, 0.0, -1.0]]),
        ),
        ("posed", DynSurface::Posed(Box::new(Posed::new(Sphere::centred(1.0).unwrap().into(), pose))), at, {
            moved(&unit)
        }),
    ]
}

/// The inside is what is within, not the surface itself; a hair nearer to a point within is inside.
#[test]
fn the_surface_is_not_inside() {
    for (name, surface, within, points) in closed() {
        assert!(surface.contains(&within), "{name}");
        for point in points {
            assert!(!surface.contains(&point), "{name}: {point}");
            assert!(surface.contains(&point.lerp(&within, 1e-12)), "{name}: {point}");
            assert!(!surface.contains(&point.lerp(&within, -1e-12)), "{name}: {point}");
        }
    }
    let offset = Offset::new(Sphere::centred(1.0_f64).unwrap(), 0.5).unwrap();
    assert!(!offset.contains(&v(1.5, 0.0, 0.0)) && offset.contains(&v(1.5 - 1e-12, 0.0, 0.0)));
}

/// What may touch ends with its bounds, which belong to it: told of crossings and of lines that miss.
#[test]
fn bounds_belong_to_what_may_touch() {
    let at = v(1.0, -2.0, 0.5);
    let z = Vector3::z();
    // The first is on the bounds, the second beyond.
    let across = |surface: DynSurface<f64>, places: [Point; 2], direction: Point| {
        for (place, active) in places.iter().zip([true, false]) {
            let line = Line { point: place - direction, direction };
            let found = crossings(&surface, &line);
            let here: Vec<_> = found.iter().filter(|c| (c.point - place).norm() < 1e-8).collect();
            assert!(!here.is_empty(), "{surface:?} {place}");
            assert!(here.iter().all(|c| c.active == active), "{surface:?} {here:?}");
        }
    };
    let beyond = 1.0 + 1e-9;
    let [x, y] = [Vector3::x(), Vector3::y()];
    let disk = Disk::new(at, z, 2.0).unwrap();
    across(disk.into(), [at + x * 2.0, at + x * (2.0 * beyond)], -z);
    let rectangle = Rectangle::new(at, x * 2.0, y * 0.5).unwrap();
    across(rectangle.into(), [at + x * 2.0, at + x * (2.0 * beyond)], -z);
    across(rectangle.into(), [at - x * 2.0 - y * 0.5, at - y * (0.5 * beyond)], -z);
    let cap = SphericalCap::new(Sphere::new(at, 1.0).unwrap(), z, 0.0).unwrap();
    across(cap.into(), [at + x, at + x - z * 1e-9], -x);
    let cylinder = Cylinder::new(at, z, 1.0).unwrap().with_half_length(0.5).unwrap();
    across(cylinder.into(), [at + x + z * 0.5, at + x + z * (0.5 * beyond)], -x);
    across(cylinder.into(), [at + x - z * 0.5, at + x - z * (0.5 * beyond)], -x);
    let elliptic = EllipticCylinder::new([1.0, 2.0], CylinderEnds::Open(0.5)).unwrap();
    across(elliptic.into(), [x + z * 0.5, x + z * (0.5 * beyond)], -x);
    across(elliptic.into(), [x - z * 0.5, x - z * (0.5 * beyond)], -x);
    let cone = Cone::new(at, -z, core::f64::consts::FRAC_PI_4).unwrap().with_depth(1.0).unwrap();
    across(cone.into(), [at + x * (1.0 - 1e-12) - z * (1.0 - 1e-12), at + x * beyond - z * beyond], -x);
    let dome = Paraboloid::new([1.0, 1.0]).unwrap().with_depth(0.5).unwrap();
    across(dome.into(), [x - z * 0.5, x - z * (0.5 * beyond)], -x);
    let above = HalfSpace::new(at, z).unwrap();
    let trimmed = Trimmed::new(Sphere::new(at, 1.0).unwrap().into(), above);
    across(DynSurface::Trimmed(Box::new(trimmed)), [at + x, at + x - z * 1e-9], -x);
}

/// Of a line that misses, it is told whether the nearest place may touch.
#[test]
fn a_miss_is_over_what_may_touch_or_not() {
    let at = v(1.0, -2.0, 0.5);
    let [x, y, z] = [Vector3::x(), Vector3::y(), Vector3::z()];
    let region = HalfSpace::new(at + z * 0.5, z).unwrap();
    let sphere = Sphere::new(at, 1.0).unwrap();
    let moved = RigidTransform::from_parts(nalgebra::Rotation3::identity(), at);
    let posed = |shape: DynSurface<f64>| DynSurface::Posed(Box::new(Posed::new(shape, moved)));
    let surfaces: [DynSurface<f64>; 5] = [
        SphericalCap::new(sphere, z, 0.5).unwrap().into(),
        DynSurface::Trimmed(Box::new(Trimmed::new(sphere.into(), region))),
        Cylinder::new(at + z, z, 1.0).unwrap().with_half_length(0.5).unwrap().into(),
        posed(Cone::new(z, z, 0.5).unwrap().with_depth(0.5).unwrap().into()),
        posed(EllipticCylinder::new([1.0, 1.0], CylinderEnds::Open(0.5)).unwrap().into()),
    ];
    for (k, surface) in surfaces.into_iter().enumerate() {
        // Lines along y, each beside the shape at a height over `at`.
        for (height, active) in
            [(0.6, [true, true, true, false, false]), (0.4, [false, false, false, false, true])]
        {
            let aside = x * if k == 0 || k == 1 { 2.0 * (1.0_f64 - height * height).sqrt() } else { 3.0 };
            let up = z * if k == 0 || k == 1 { 2.0 * height } else { height };
            let found = approach(&surface, &Line { point: at + aside + up + y * 7.0, direction: y });
            if k != 3 {
                assert_eq!(found.active, active[k], "{surface:?} {height} {found:?}");
            }
        }
    }
    // A cone's nearest place lies deep or not.
    let cone = Cone::new(at, z, core::f64::consts::FRAC_PI_4).unwrap().with_depth(1.0).unwrap();
    for (deep, active) in [(0.9, true), (1.1, false)] {
        let place = at + (x + z) * deep;
        let found = approach(&cone, &Line { point: place + (x - z) * 0.5, direction: y });
        assert!((found.point - place).norm() < 1e-6, "{found:?} {place}");
        assert_eq!(found.active, active);
    }
    let disk = Disk::new(at, z, 1.0).unwrap();
    let rectangle = Rectangle::new(at, x, y).unwrap();
    for (aside, active) in [(1.0, true), (1.0 + 1e-9, false)] {
        let line = Line { point: at + x * aside + y * 5.0 + z * 0.25, direction: y };
        for found in [approach(&disk, &line), approach(&rectangle, &line)] {
            assert_eq!((found.gap, found.active), (0.25, active), "{found:?}");
            assert_eq!(found.point, at + x * aside);
        }
    }
}
