//! What smooth shapes say of their level functions, against differences; and of their extent.

use fingertip_surfaces::*;
use fingertip_test_support::Worst;
use fingertip_wrench::{Line, RigidTransform};
use nalgebra::{Matrix2, Matrix3, Vector3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

fn v(x: f64, y: f64, z: f64) -> Vector3<f64> {
    Vector3::new(x, y, z)
}

/// Points of the surface with their normals, where lines near a point meet it.
fn places(surface: &DynSurface<f64>, about: &Vector3<f64>, reach: f64) -> Vec<Crossing<f64>> {
    let mut random = Pcg64Mcg::seed_from_u64(5);
    let mut places = Vec::new();
    for _ in 0..400 {
        let mut any = || Vector3::from_fn(|_, _| random.random_range(-1.0..1.0));
        let line = Line { point: about + any() * (reach * 0.7), direction: any().normalize() };
        surface.crossings(&line, |c| {
            if c.active && (c.point - about).norm() < reach && c.normal.dot(&line.direction).abs() > 0.2 {
                places.push(c);
            }
        });
    }
    places
}

/// Fourth-order central differences along the three axes.
fn slope<const N: usize>(
    f: impl Fn(&Vector3<f64>) -> nalgebra::SVector<f64, N>,
    at: &Vector3<f64>,
    step: f64,
) -> nalgebra::SMatrix<f64, N, 3> {
    nalgebra::SMatrix::<f64, N, 3>::from_columns(&[0, 1, 2].map(|k| {
        let by = |steps: f64| f(&(at + Vector3::ith(k, steps * step)));
        ((by(1.0) - by(-1.0)) * 8.0 - (by(2.0) - by(-2.0))) / (12.0 * step)
    }))
}

/// On the surface and beside it, level, gradient and Hessian belong together; on it, level and normal,
/// curvature and bend. `share` of the places at least: where curvature jumps, and on flat ends, which have
/// no level function, differences mean nothing.
fn level_is_consistent(
    name: &str,
    surface: &DynSurface<f64>,
    about: &Vector3<f64>,
    reach: f64,
    share: f64,
) -> bool {
    let (mut good, mut flawed, mut all) = (0_u32, 0_u32, 0_u32);
    for Crossing { point, normal, .. } in places(surface, about, reach) {
        all += 1;
        let level = surface.level(&point);
        let (outward, steepness) = level.normal().unwrap();
        if (outward - normal).norm() > 1e-6 {
            continue;
        }
        assert!(level.value.abs() <= 1e-12 * steepness * reach, "{name}: {} at {point}", level.value);
        let mut consistent = true;
        for beside in [0.0, 0.1, -0.05] {
            let at = point + normal * (beside * reach);
            let level = surface.level(&at);
            let gradient = slope(|p| [surface.level(p).value].into(), &at, 1e-3 * reach);
            let hessian = slope(|p| surface.level(p).gradient, &at, 1e-3 * reach);
            let scale = level.gradient.norm();
            consistent &= (gradient.transpose() - level.gradient).norm() < 1e-6 * scale;
            consistent &=
                (hessian - level.hessian).norm() * reach < 1e-4 * (scale + level.hessian.norm() * reach);
            let turned = level.hessian - level.hessian.transpose();
            assert!(turned.norm() <= 1e-14 * level.hessian.norm(), "{name}");
        }
        good += u32::from(consistent);
        let operator = surface.shape_operator(&point);
        assert!((operator * normal).norm() * reach < 1e-10, "{name}");
        let e1 = normal.cross(&v(0.3, -0.5, 0.8)).normalize();
        let e2 = normal.cross(&e1);
        let bend = surface.bend(&point, &normal, [&e1, &e2]);
        let expected = Matrix2::new(
            e1.dot(&(operator * e1)),
            e1.dot(&(operator * e2)),
            e2.dot(&(operator * e1)),
            e2.dot(&(operator * e2)),
        );
        assert!(
            (bend - expected).norm() <= 1e-9 * (operator.norm() + 1.0 / reach),
            "{name} {bend} {expected}"
        );
        let by_differences = shape_operator_by_differences(surface, &point, 1e-4 * reach);
        let off = (operator - by_differences).norm();
        flawed += u32::from(off > 1e-3 * (operator.norm() + 1.0 / reach));
    }
    println!("{name:20} {good} of {all} consistent, {flawed} where the curvature jumps");
    all > 60
        && f64::from(good) >= share * f64::from(all)
        && f64::from(flawed) <= (1.0 - share) * f64::from(all)
}

/// The ball of a bounded shape holds its active points, and is filled to a good part.
fn extent_holds(
    name: &str,
    surface: &DynSurface<f64>,
    about: &Vector3<f64>,
    reach: f64,
    filled: f64,
) -> bool {
    let Extent { centre, radius } = surface.extent();
    let distances = places(surface, about, reach).into_iter().map(|c| (c.point - centre).norm() / radius);
    let farthest = Worst::of(distances).get();
    println!("{name:20} fills {farthest} of its extent");
    farthest <= 1.0 + 1e-12 && farthest >= filled
}

fn pose() -> RigidTransform<f64> {
    RigidTransform::from_axis_angle(v(1.0, 0.4, -0.3), v(0.1, 0.2, -0.2)).unwrap()
}

type Shape = (&'static str, DynSurface<f64>, f64, Option<f64>);

/// Shape, share of the places that are smooth, how much of the extent a bounded one fills.
fn shapes() -> Vec<Shape> {
    let centre = v(0.1, -0.2, 0.15);
    let axis = v(0.2, -0.4, 1.0);
    let posed = Posed::new(Ellipsoid::new(v(0.8, 0.6, 1.0)).unwrap().into(), pose());
    let region = HalfSpace::new(v(0.0, 0.0, 0.1), v(0.0, 0.3, 1.0)).unwrap();
    let trimmed = Trimmed::new(Ellipsoid::new(v(0.8, 0.6, 1.0)).unwrap().into(), region);
    let profile = [[0.0, 0.8], [0.4, 0.8], [0.8, 0.74], [1.2, 0.52], [1.4, 0.0]];
    vec![
        ("plane", Plane::new(centre, axis).unwrap().into(), 1.0, None),
        ("disk", Disk::new(centre, axis, 0.9).unwrap().into(), 1.0, Some(0.9)),
        (
            "rectangle",
            Rectangle::new(centre, v(0.8, 0.0, 0.0), v(0.0, 0.3, 0.4)).unwrap().into(),
            1.0,
            Some(0.6),
        ),
        ("sphere", Sphere::new(centre, 0.9).unwrap().into(), 1.0, Some(0.999)),
        (
            "spherical cap",
            SphericalCap::new(Sphere::new(centre, 0.9).unwrap(), axis, -0.2).unwrap().into(),
            1.0,
            Some(0.9),
        ),
        ("ellipsoid", Ellipsoid::new(v(0.8, 0.6, 1.0)).unwrap().into(), 1.0, Some(0.95)),
        ("cylinder", Cylinder::new(centre, axis, 0.7).unwrap().into(), 1.0, None),
        (
            "open cylinder",
            Cylinder::new(centre, axis, 0.7).unwrap().with_half_length(0.5).unwrap().into(),
            1.0,
            Some(0.9),
        ),
        ("capped cylinder", CappedCylinder::new(centre, axis, 0.7, 0.5).unwrap().into(), 0.4, Some(0.95)),
        (
            "elliptic cylinder",
            EllipticCylinder::new([0.9, 0.6], CylinderEnds::Unbounded).unwrap().into(),
            1.0,
            None,
        ),
        (
            "open ell. cyl.",
            EllipticCylinder::new([0.9, 0.6], CylinderEnds::Open(0.6)).unwrap().into(),
            1.0,
            Some(0.9),
        ),
        (
            "closed ell. cyl.",
            EllipticCylinder::new([0.9, 0.6], CylinderEnds::Capped(0.6)).unwrap().into(),
            0.4,
            Some(0.9),
        ),
        ("capsule", Capsule::new(centre, axis, 0.5, 0.4).unwrap().into(), 0.95, Some(0.95)),
        ("cone", Cone::new(centre, -axis, 0.6).unwrap().into(), 0.9, None),
        ("frustum", Frustum::new(centre - axis * 0.4, axis, 0.6, 0.3, 0.9).unwrap().into(), 0.4, Some(0.95)),
        ("torus", Torus::new(0.7, 0.3).unwrap().into(), 1.0, Some(0.99)),
        ("superquadric", Superquadric::new(v(0.8, 0.6, 0.9), [0.8, 0.9]).unwrap().into(), 0.8, Some(0.6)),
        ("rounded box", RoundedBox::new(v(0.8, 0.6, 0.7), 0.2).unwrap().into(), 0.8, Some(0.8)),
        ("paraboloid", Paraboloid::new([0.6, 0.9]).unwrap().into(), 1.0, None),
        ("revolution", DynSurface::Revolution(Revolution::from_points(&profile).unwrap()), 0.4, Some(0.8)),
        ("posed", DynSurface::Posed(Box::new(posed)), 1.0, Some(0.95)),
        ("trimmed", DynSurface::Trimmed(Box::new(trimmed)), 1.0, Some(0.8)),
    ]
}

#[test]
fn levels_gradients_and_hessians_belong_together() {
    let about = v(0.1, -0.1, 0.2);
    let mut all = shapes();
    all.retain(|(name, surface, share, _)| !level_is_consistent(name, surface, &about, 1.6, share * 0.97));
    let broken: Vec<_> = all.iter().map(|(name, ..)| *name).collect();
    assert!(broken.is_empty(), "{broken:?}");
}

#[test]
fn extents_hold_their_shapes() {
    let about = v(0.1, -0.1, 0.2);
    let mut all = shapes();
    all.retain(|(name, surface, _, filled)| {
        filled.is_some_and(|filled| !extent_holds(name, surface, &about, 5.0, filled))
    });
    let broken: Vec<_> = all.iter().map(|(name, ..)| *name).collect();
    assert!(broken.is_empty(), "{broken:?}");
}

/// Of shapes whose level function is that of the whole, the inside is where it is negative.
#[test]
fn the_inside_is_where_the_level_is_negative() {
    let mut random = Pcg64Mcg::seed_from_u64(6);
    let whole = [
        "plane",
        "sphere",
        "ellipsoid",
        "cylinder",
        "elliptic cylinder",
        "capsule",
        "cone",
        "torus",
        "superquadric",
        "rounded box",
        "paraboloid",
        "posed",
    ];
    for (name, surface, ..) in shapes().into_iter().filter(|(name, ..)| whole.contains(name)) {
        let (mut inside, mut outside) = (0, 0);
        for _ in 0..2000 {
            let point = v(0.1, -0.1, 0.2) + Vector3::from_fn(|_, _| random.random_range(-1.2..1.2));
            let expected = surface.level(&point).value < 0.0;
            assert_eq!(surface.contains(&point), expected, "{name}: {point}");
            *(if expected { &mut inside } else { &mut outside }) += 1;
        }
        assert!(inside > 100 && outside > 100, "{name}: {inside} {outside}");
    }
}

/// Steepness and curvature of a level function of any scale: those of `k(|x|² − R²)`.
#[test]
fn a_level_of_any_scale() {
    let point = v(0.6, 0.0, 0.8);
    for exponent in [-150, -20, 0, 20, 150] {
        let k = 10_f64.powi(exponent);
        let level =
            Level { value: 0.0, gradient: point * (2.0 * k), hessian: Matrix3::identity() * (2.0 * k) };
        let (normal, steepness) = level.normal().unwrap();
        assert!((normal - point).norm() < 1e-15 && (steepness / (2.0 * k) - 1.0).abs() < 1e-15);
        let flat = Matrix3::identity() - point * point.transpose();
        assert!((level.shape_operator() - flat).norm() < 1e-14, "{exponent}");
    }
    for gradient in [Vector3::zeros(), v(0.0, f64::NAN, 1.0), v(f64::INFINITY, 0.0, 0.0)] {
        let level = Level { value: 0.0, gradient, hessian: Matrix3::identity() };
        assert!(level.normal().is_none());
        assert_eq!(level.shape_operator(), Matrix3::zeros());
    }
}

/// In the middle of the tube any side is as near; next to it the nearest is told, as close as a number can be.
#[test]
fn the_middle_of_a_tube_has_a_normal() {
    let torus: Torus<f64> = Torus::new(1.0, 0.25).unwrap();
    for place in [Vector3::x(), -Vector3::y(), Vector3::zeros()] {
        assert!((torus.normal(&place).norm() - 1.0).abs() < 1e-15, "{place:?}");
    }
    for off in [1e-3, 1e-10, 1e-17, 1e-200, f64::MIN_POSITIVE] {
        let normal = torus.normal(&Vector3::new(1.0, 0.0, off));
        assert!((normal - Vector3::z()).amax() < 1e-12, "{off}: {normal:?}");
    }
}
