//! By how much a point is outside, with the digits that single precision has lost.

use dashu_float::FBig;
use dashu_float::round::mode::HalfEven;
use fingertip_surfaces::*;
use fingertip_wrench::{Line, Real};
use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use crate::every_shape::{approach, crossings, l};

fn residual<T: Real>(surface: &impl ActiveSurface<T>, point: &Vector3<T>) -> T {
    surface.shortcuts().surface_residual(point)
}

/// Of a point beside the surface, rounded to single precision, against where a line through it in double
/// precision, along the normal, meets the very shape.
fn told_to_the_last_digit(
    name: &str,
    narrow: &impl ActiveSurface<f32>,
    exact: &impl ActiveSurface<f64>,
    size: f64,
    allowed: f64,
) {
    let mut random = Pcg64Mcg::seed_from_u64(31);
    let (mut tried, mut far) = (0, 0);
    while tried < 400 {
        let mut any = || Vector3::from_fn(|_, _| random.random_range(-1.0..1.0));
        let line = Line { point: any() * (size * 0.4), direction: any().normalize() };
        for crossing in crossings(exact, &line).iter().filter(|c| c.active) {
            // A few units in the last place, so that the curvature does not tell.
            let beside = crossing.point + any() * (size * 4e-7);
            let point = beside.map(|x| x as f32);
            if crossing.point.norm() > 2.0 * size {
                continue;
            }
            let wide = point.map(f64::from);
            let straight = Line { point: wide, direction: crossing.normal };
            let met = crossings(exact, &straight);
            let Some(nearest) = met.iter().min_by(|a, b| a.along.abs().total_cmp(&b.along.abs())) else {
                continue;
            };
            // An edge has two sides.
            if nearest.normal.dot(&crossing.normal) < 0.999 {
                continue;
            }
            tried += 1;
            let found = f64::from(residual(narrow, &point));
            let outside = -nearest.along;
            assert!((found - outside).abs() <= allowed * size, "{name} {point:?}: {found:e} {outside:e}");
            far += i32::from(outside.abs() > 5e-8 * size);
        }
    }
    assert!(far > 50, "{name}: {far}");
}

/// A shape in both precisions, by the numbers that single precision stores.
macro_rules! told {
    ($size:expr, $name:expr, $make:expr) => {
        told!($size, $name, 2e-11, $make)
    };
    ($size:expr, $name:expr, $allowed:expr, $make:expr) => {{
        fn make<T: Real>(k: T) -> impl ActiveSurface<T> {
            let make: fn(T) -> _ = $make;
            make(k)
        }
        for k in [1.0_f32, 9.765_625e-4, 1024.0] {
            let size: f64 = $size;
            told_to_the_last_digit($name, &make(k), &make(f64::from(k)), size * f64::from(k), $allowed);
        }
    }};
}

fn at<T: Real>(k: T) -> Vector3<T> {
    Vector3::new(l(0.25), l(-0.5), l(0.125)) * k
}

#[test]
fn of_round_shapes() {
    told!(1.5, "sphere", |k| Sphere::new(at(k), k).unwrap());
    told!(1.5, "cap", |k| SphericalCap::new(Sphere::new(at(k), k).unwrap(), Vector3::z(), l(-0.5)).unwrap());
    told!(1.0, "ellipsoid", |k| Ellipsoid::new(Vector3::new(l(1.0), l(0.5), l(0.75)) * k).unwrap());
    told!(1.0, "cylinder", |k| Cylinder::new(at(k), Vector3::x(), k * l(0.5)).unwrap());
    told!(1.0, "capsule", |k| Capsule::new(at(k), Vector3::y(), k * l(0.25), k * l(0.5)).unwrap());
    told!(1.0, "paraboloid", |k| Paraboloid::new([k, k * l(0.5)]).unwrap());
    told!(1.0, "superquadric", |k| {
        Superquadric::new(Vector3::new(l(1.0), l(0.5), l(0.75)) * k, [l(0.5), l(0.75)]).unwrap()
    });
    // Its normal is not of length 1 to more digits than it has.
    told!(1.0, "offset", 4e-8, |k| Offset::new(Sphere::new(at(k), k * l(0.5)).unwrap(), k * l(0.25))
        .unwrap());
}

#[test]
fn of_shapes_with_ends_and_flats() {
    told!(1.0, "plane", |k| Plane::new(at(k), Vector3::z()).unwrap());
    told!(1.0, "disk", |k| Disk::new(at(k), Vector3::y(), k).unwrap());
    told!(1.0, "rectangle", |k| Rectangle::new(at(k), Vector3::x() * k, Vector3::y() * k).unwrap());
    told!(1.0, "capped cylinder", |k| {
        CappedCylinder::new(at(k), Vector3::y(), k * l(0.5), k * l(0.25)).unwrap()
    });
    told!(1.0, "frustum", |k| Frustum::new(at(k), Vector3::z(), k * l(0.75), k * l(0.25), k).unwrap());
    for ends in [CylinderEnds::Unbounded, CylinderEnds::Open(0.5), CylinderEnds::Capped(0.5)] {
        let [narrow, exact] = [[1.0, 0.5], [0.5, 1.0]];
        for axes in [narrow, exact] {
            let of = EllipticCylinder::new(axes, ends).unwrap();
            let ends = match ends {
                CylinderEnds::Unbounded => CylinderEnds::Unbounded,
                CylinderEnds::Open(half) => CylinderEnds::Open(half as f32),
                CylinderEnds::Capped(half) => CylinderEnds::Capped(half as f32),
            };
            let narrow = EllipticCylinder::new(axes.map(|a| a as f32), ends).unwrap();
            told_to_the_last_digit("elliptic cylinder", &narrow, &of, 1.0, 2e-11);
        }
    }
    told!(1.5, "box", |k| RoundedBox::new(Vector3::new(k, k * l(0.5), k * l(0.75)), k - k).unwrap());
    told!(1.5, "rounded box", |k| {
        RoundedBox::new(Vector3::new(k, k * l(0.5), k * l(0.75)), k * l(0.25)).unwrap()
    });
    told!(1.0, "cone", |k| Cone::new(at(k), Vector3::z(), l(0.5)).unwrap());
    told!(1.0, "revolution", |k| {
        let points =
            [[-0.7, 0.1], [-0.3, 0.5], [0.2, 0.6], [0.8, 0.3]].map(|p| p.map(|x: f32| k * l(f64::from(x))));
        Revolution::from_profile(points).unwrap()
    });
    told!(1.0, "revolution of points", |k| {
        let points =
            [[-0.7, 0.1], [-0.3, 0.5], [0.2, 0.6], [0.8, 0.3]].map(|p| p.map(|x: f32| k * l(f64::from(x))));
        Revolution::from_points(&points).unwrap()
    });
}

#[test]
fn a_line_that_touches_is_at_the_surface() {
    let sphere = Sphere::new(at(1.0_f32), 1.0).unwrap();
    let line = Line { point: at(1.0) + Vector3::x(), direction: Vector3::z() };
    let found = approach(&sphere, &line);
    assert_eq!((found.gap, residual(&sphere, &found.point)), (0.0, 0.0));
    // At a tip there is no telling.
    let cone = Cone::new(at(1.0_f32), Vector3::z(), 0.5).unwrap();
    let ball = Revolution::from_profile([[0.0_f32, 0.0], [1.0, 1.0]]).unwrap();
    assert_eq!((residual(&cone, &at(1.0)), residual(&ball, &Vector3::zeros())), (0.0, 0.0));
}

/// What a revolution is near a height, by its own numbers, is the same in both precisions.
#[test]
fn parts_of_a_revolution_are_told_to_the_last_digit() {
    let points = [[-0.7_f32, 0.1], [-0.3, 0.5], [0.2, 0.6], [0.8, 0.3]];
    let narrow = Revolution::from_points(&points).unwrap();
    let exact = Revolution::from_points(&points.map(|p| p.map(f64::from))).unwrap();
    for k in -9..=10 {
        let z = f32::from(k as i8) * 0.1;
        let found = [narrow.local_surface_at(z), exact.local_surface_at(f64::from(z))];
        let [Some(one), Some(other)] = found.map(numbers) else { panic!("{z}") };
        assert!(
            one.iter().zip(&other).all(|(a, b)| a == b || (a - b).abs() < 1e-13),
            "{z} {one:?} {other:?}"
        );
        // And is where the surface is.
        let [origin, radius, slope, t0, t1, w0, w1, low, high] = other;
        let z = f64::from(z);
        if z > -0.7 && z < 0.8 {
            assert!(low <= z && z <= high, "{z} {other:?}");
            let d = z - origin;
            let squared = radius * radius + d * (slope + (t1 - t0) * d / (w1 - w0));
            let line = Line { point: Vector3::z() * z, direction: Vector3::x() };
            let rho = crossings(&exact, &line)[1].along;
            assert!((rho * rho - squared).abs() < 1e-14, "{z} {rho} {other:?}");
        }
    }
}

fn numbers(local: Option<LocalSurface>) -> Option<[f64; 9]> {
    match local? {
        LocalSurface::Turned { origin, radius, slope, turn, width, between } => {
            let [[t0, t1], [w0, w1], [low, high]] = [turn, width, between];
            Some([origin, radius, slope, t0, t1, w0, w1, low, high])
        }
        _ => None,
    }
}

/// The height of a point over a superquadric to first order, in 300 bits.
fn height(point: [f64; 3], axes: [f64; 3], [e1, e2]: [f64; 2]) -> f64 {
    type Exact = FBig<HalfEven, 2>;
    let exact = |x: f64| Exact::try_from(x).unwrap().with_precision(300).value();
    let two = exact(2.0);
    let [outer, inner] = [e1, e2].map(|e| &two / exact(e));
    let gauge = |p: [Exact; 3]| {
        let [x, y, z] =
            [0, 1, 2].map(|k| if p[k] < exact(0.0) { -&p[k] } else { p[k].clone() } / exact(axes[k]));
        let power = |x: &Exact, p: &Exact| if *x == exact(0.0) { exact(0.0) } else { x.powf(p) };
        let plane = power(&x, &inner) + power(&y, &inner);
        (power(&plane, &(&outer / &inner)) + power(&z, &outer)).powf(&(exact(1.0) / &outer))
    };
    let value = gauge(point.map(exact));
    // Differences over 1e-20 tell the gradient to 20 digits.
    let stride = exact(1e-20);
    let slope = |k: usize| {
        let mut there = point.map(exact);
        there[k] += &stride;
        ((gauge(there) - &value) / &stride).to_f64().value()
    };
    let steepness = Vector3::from([0, 1, 2].map(slope)).norm();
    (value - exact(1.0)).to_f64().value() / steepness
}

/// Of a superquadric the height is known to all digits that double precision has for it.
#[test]
fn of_a_superquadric_in_double_precision_all_digits_are_known() {
    let axes = [1.0, 0.5, 0.75];
    let mut random = Pcg64Mcg::seed_from_u64(37);
    let mut told = 0;
    for exponents in [[0.5, 0.75], [0.1, 0.3], [1.0, 1.0], [1.9, 0.2], [0.3, 1.7], [1.0, 2.0]] {
        let body = Superquadric::new(axes.into(), exponents).unwrap();
        for _ in 0..30 {
            let any = Vector3::<f64>::from_fn(|_, _| random.random_range(-1.0..1.0));
            let line = Line { point: Vector3::zeros(), direction: any.normalize() };
            for crossing in crossings(&body, &line) {
                let truth = height(crossing.point.into(), axes, exponents);
                let found = residual(&body, &crossing.point);
                assert!(
                    (found - truth).abs() <= 1e-12 * truth.abs() + 1e-29,
                    "{found:e} {truth:e} {exponents:?}"
                );
                told += i32::from(truth != 0.0);
            }
        }
    }
    assert!(told > 300, "{told}");
}
