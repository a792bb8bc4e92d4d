//! Point contact: typed outcomes, and the failures of other libraries that do not happen here.

use fingertip_contact::*;
use fingertip_surfaces::*;
use fingertip_wrench::{Real, RigidTransform, Wrench};
use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

pub(crate) fn v(x: f64, y: f64, z: f64) -> Vector3<f64> {
    Vector3::new(x, y, z)
}

pub(crate) fn model() -> PointContact<f64> {
    PointContact::new(0.0).unwrap()
}

pub(crate) fn tip() -> Sphere<f64> {
    Sphere::centred(0.013).unwrap()
}

/// A force at a point of the surface, resolved: the contact must be that point.
pub(crate) fn assert_found(
    surface: &impl ActiveSurface<f64>,
    point: Vector3<f64>,
    force: Vector3<f64>,
) -> Contact<f64> {
    let found = model().resolve(&Wrench::from_force_at(&point, force), surface);
    let contact = *found.contact().unwrap_or_else(|| panic!("{found:?}"));
    assert!((contact.point - point).norm() < 1e-14, "{contact:?} instead of {point:?}");
    contact
}

#[test]
fn pushes_are_found_on_plane_sphere_and_cylinder() {
    let contact = assert_found(&tip(), v(0.0, 0.0, 0.013), v(0.1, -0.2, -2.0));
    assert!((contact.normal_force() - 2.0).abs() < 1e-14);
    assert!((contact.tangential_force() - v(0.1, -0.2, 0.0)).norm() < 1e-15);
    assert_eq!((contact.gap, contact.alternatives, contact.spin_torque), (0.0, 0, 0.0));

    let plane = Plane::new(v(0.0, 0.0, 0.02), v(0.0, 0.0, 1.0)).unwrap();
    assert_found(&plane, v(0.004, -0.003, 0.02), v(0.5, 0.5, -1.0));

    let cylinder = Cylinder::new(v(0.0, 0.0, 0.01), v(0.0, 1.0, 0.0), 0.008).unwrap();
    assert_found(&cylinder, v(0.008, 0.03, 0.01), v(-1.0, 0.3, 0.2));
}

#[test]
fn force_times_torque_exactly_zero() {
    // Peers divide f·m by its size to get a sign.
    let point = v(0.0, 0.013, 0.0);
    let wrench: Wrench<f64> = Wrench::from_force_at(&point, v(0.0, -1.0, 0.0));
    assert_eq!(wrench.force().dot(&wrench.torque()), 0.0);
    assert_found(&tip(), point, v(0.0, -1.0, 0.0));
}

#[test]
fn force_times_torque_tiny() {
    let point = v(0.0, 0.0, 0.013);
    for spin in [1e-300, 1e-30, 1e-12, -1e-12] {
        let force = v(0.3, 0.0, -1.0);
        let wrench = Wrench::on_fingertip(force, point.cross(&force) + force * spin);
        let found = model().resolve(&wrench, &tip());
        assert!((found.contact().unwrap().point - point).norm() < 1e-14, "{found:?}");
    }
}

#[test]
fn zero_force_is_below_the_threshold() {
    for torque in [Vector3::zeros(), v(0.0, 0.1, 0.0)] {
        let found = model().resolve(&Wrench::on_fingertip(Vector3::zeros(), torque), &tip());
        assert_eq!(found, Resolution::NoContact(NoContact::BelowThreshold { force: 0.0 }));
    }
    let careful = PointContact::new(0.1).unwrap();
    let found = careful.resolve(&Wrench::from_force_at(&v(0.0, 0.0, 0.013), v(0.0, 0.0, -0.05)), &tip());
    assert_eq!(found, Resolution::NoContact(NoContact::BelowThreshold { force: 0.05 }));
}

#[test]
fn forces_over_the_whole_range() {
    let point = v(0.003, -0.004, 0.012);
    let sphere = Sphere::centred(0.013).unwrap();
    for magnitude in [1e-160, 1e-300, 1e-12, 1.0, 1e12, 1e160, 1e300] {
        let force = -point.normalize() * magnitude + v(0.2, 0.1, 0.0) * magnitude;
        assert_found(&sphere, point, force);
    }
}

#[test]
fn line_through_the_centre() {
    for direction in [v(1.0, 0.0, 0.0), v(0.0, -1.0, 0.0), v(0.36, 0.48, 0.8)] {
        let found = model().resolve(&Wrench::on_fingertip(direction, Vector3::zeros()), &tip());
        let contact = found.contact().unwrap();
        assert!((contact.point + direction * 0.013).norm() < 1e-15);
        assert!((contact.incidence() - 1.0).abs() < 1e-15);
    }
}

#[test]
fn line_parallel_to_a_cylinders_axis() {
    let open = Cylinder::new(Vector3::zeros(), Vector3::z(), 0.01).unwrap().with_half_length(0.02).unwrap();
    for x in [0.0, 0.004, 0.0099, 0.015] {
        let wrench = Wrench::from_force_at(&v(x, 0.0, 0.0), v(0.0, 0.0, -1.0));
        let Resolution::NoContact(NoContact::Misses {
            closest: Some(ClosestApproach { gap, point: closest, .. }),
        }) = model().resolve(&wrench, &open)
        else {
            panic!("a parallel line crosses nothing");
        };
        assert!((gap - (x - 0.01).abs()).abs() < 1e-17);
        assert!((closest.xy().norm() - 0.01).abs() < 1e-17);
    }
    // With ends, the same lines meet an end.
    let capped = CappedCylinder::new(Vector3::zeros(), Vector3::z(), 0.01, 0.02).unwrap();
    assert_found(&capped, v(0.004, 0.0, 0.02), v(0.0, 0.0, -1.0));
}

#[test]
fn sphere_given_as_an_ellipsoid() {
    let ball = Ellipsoid::new(v(0.013, 0.013, 0.013)).unwrap();
    for k in 0..100 {
        let angle = f64::from(k) * 0.7;
        let point = v(angle.cos() * 0.6, angle.sin() * 0.6, 0.8) * 0.013;
        let force = -point.normalize() + v(0.3, -0.1, 0.2);
        let a = assert_found(&ball, point, force);
        let b = assert_found(&tip(), point, force);
        assert!((a.normal - b.normal).norm() < 1e-14);
    }
    // Missing lines too, where all axes of the shadow are equal.
    let wrench = Wrench::from_force_at(&v(0.02, 0.0, 0.0), v(0.0, 0.0, -1.0));
    let Resolution::NoContact(NoContact::Misses { closest: Some(ClosestApproach { gap, .. }) }) =
        model().resolve(&wrench, &ball)
    else {
        panic!("the line misses");
    };
    assert!((gap - 0.007).abs() < 1e-16);
}

#[test]
fn pulling_is_a_reason_not_an_antipode() {
    // A plane is crossed once: pulling there.
    let plane = Plane::new(Vector3::zeros(), Vector3::z()).unwrap();
    let found = model().resolve(&Wrench::from_force_at(&v(0.01, 0.0, 0.0), v(0.0, 0.0, 1.0)), &plane);
    assert_eq!(found, Resolution::NoContact(NoContact::OnlyPulling { point: v(0.01, 0.0, 0.0) }));
    // On a dome, the line enters through the opening, where nothing can touch.
    let dome = SphericalCap::new(tip(), Vector3::z(), 0.0).unwrap();
    let found = model().resolve(&Wrench::from_force_at(&v(0.0, 0.0, 0.013), v(0.0, 0.0, 1.0)), &dome);
    assert!(matches!(found, Resolution::NoContact(NoContact::OnlyPulling { .. })), "{found:?}");
}

#[test]
fn outside_the_active_region() {
    let disk = Disk::new(Vector3::zeros(), Vector3::z(), 0.01).unwrap();
    let found = model().resolve(&Wrench::from_force_at(&v(0.02, 0.0, 0.0), v(0.0, 0.0, -1.0)), &disk);
    assert_eq!(found, Resolution::NoContact(NoContact::OutsideActiveRegion { point: v(0.02, 0.0, 0.0) }));
}

#[test]
fn near_miss_gives_point_and_gap() {
    let wrench = Wrench::from_force_at(&v(0.0131, 0.0, 0.005), v(0.0, 0.0, -1.0));
    let Resolution::NoContact(NoContact::Misses {
        closest: Some(ClosestApproach { gap, point: closest, normal, .. }),
    }) = model().resolve(&wrench, &tip())
    else {
        panic!("the line misses");
    };
    assert!((gap - 0.0001).abs() < 1e-16);
    assert!((closest - v(0.013, 0.0, 0.0)).norm() < 1e-16 && (normal - v(1.0, 0.0, 0.0)).norm() < 1e-15);
    let tolerant = model().with_greatest_gap(0.0002).unwrap();
    let contact = *tolerant.resolve(&wrench, &tip()).contact().unwrap();
    assert_eq!((contact.gap, contact.point, contact.incidence()), (gap, closest, 0.0));
}

#[test]
fn a_miss_by_one_ulp_is_not_nan() {
    fn check<T: Real>() {
        let sphere = Sphere::centred(T::one()).unwrap();
        let model = PointContact::new(T::zero()).unwrap();
        for ulps in -3_i32..=3 {
            let x = T::one() + T::EPSILON * T::literal(f64::from(ulps));
            let wrench = Wrench::from_force_at(
                &Vector3::new(x, T::zero(), T::zero()),
                Vector3::new(T::zero(), T::zero(), -T::one()),
            );
            let point = match model.resolve(&wrench, &sphere) {
                Resolution::Contact(contact) => contact.point,
                Resolution::NoContact(NoContact::Misses {
                    closest: Some(ClosestApproach { point: closest, .. }),
                }) => closest,
                other => panic!("{other:?}"),
            };
            let error = (point - Vector3::x()).amax();
            assert!(error <= (T::EPSILON * T::literal(8.0)).root(), "{ulps} ulps: {point:?}");
        }
    }
    check::<f32>();
    check::<f64>();
}

/// By rounding, a line through the edge of a closed shape may leave it there without having entered: that is
/// a miss by a hair, not a contact that pulls.
#[test]
fn an_edge_is_pressed_or_missed_by_a_hair() {
    fn check<T: Real>() {
        let z = Vector3::z();
        let shaft = CappedCylinder::new(Vector3::zeros(), z, T::one(), T::literal(0.5)).unwrap();
        let stump = Frustum::new(z * T::literal(-0.5), z, T::literal(1.5), T::one(), T::one()).unwrap();
        let block = RoundedBox::new(v(0.8, 0.6, 0.5).map(T::literal), T::zero()).unwrap();
        let model = PointContact::new(T::zero()).unwrap();
        let mut random = Pcg64Mcg::seed_from_u64(31);
        let (mut pressed, mut missed) = (0, 0);
        for k in 0..20_000 {
            let angle = random.random_range(0.0..core::f64::consts::TAU);
            let round = v(angle.cos(), angle.sin(), 0.5);
            let straight = v(0.8, random.random_range(-0.6..0.6), 0.5);
            let edge = if k % 3 == 0 { straight } else { round }.map(T::literal);
            let push = Vector3::from_fn(|_, _| T::literal(random.random_range(-1.0..1.0)));
            let wrench = Wrench::from_force_at(&edge, push);
            let found = match k % 3 {
                0 => model.resolve(&wrench, &block),
                1 => model.resolve(&wrench, &shaft),
                _ => model.resolve(&wrench, &stump),
            };
            match found {
                Resolution::Contact(contact) => {
                    let pull = push.dot(&contact.normal) / push.norm();
                    assert!(pull <= T::EPSILON * T::literal(64.0), "{wrench:?} {contact:?}");
                    if k % 3 == 0 {
                        // Of a face that the point lies on.
                        let half = v(0.8, 0.6, 0.5).map(T::literal).dot(&contact.normal.abs());
                        let off = (contact.point.dot(&contact.normal) - half).abs();
                        assert!(off <= T::EPSILON * T::literal(64.0), "{wrench:?} {contact:?}");
                    }
                    pressed += 1;
                }
                Resolution::NoContact(NoContact::Misses {
                    closest: Some(ClosestApproach { gap, point: closest, .. }),
                }) => {
                    // The torque rounds the line by a few of its last places at size 1.5.
                    let hair = T::EPSILON * T::literal(32.0);
                    assert!(gap <= hair && (closest - edge).norm() <= hair.root(), "{wrench:?} {found:?}");
                    missed += 1;
                }
                other => panic!("{wrench:?} {other:?}"),
            }
        }
        assert!(pressed > 10_000 && missed > 500, "{pressed} {missed}");
    }
    check::<f32>();
    check::<f64>();
}

#[test]
fn equatorial_push_without_torque() {
    // Through the centre, from the side: m = 0.
    let found = model().resolve(&Wrench::on_fingertip(v(-1.0, 0.0, 0.0), Vector3::zeros()), &tip());
    assert_eq!(found.contact().unwrap().point, v(0.013, 0.0, 0.0));
}

#[test]
fn newton_millimetres_given_as_newton_metres_are_not_guessed() {
    // A torque a thousand times too large puts the line of action where it says: metres away.
    let force = v(-1.0, 0.2, 0.0);
    let torque = v(0.013, 0.0, 0.0).cross(&force) + v(0.0, 0.01, 0.0).cross(&force);
    let found = model().resolve(&Wrench::on_fingertip(force, torque * 1000.0), &tip());
    let Resolution::NoContact(NoContact::Misses { closest: Some(ClosestApproach { gap, .. }) }) = found
    else {
        panic!("{found:?}")
    };
    assert!(gap > 1.0, "{gap}");
}

#[test]
fn not_finite_is_said() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for place in 0..6 {
            let mut parts = [0.0, 0.0, -1.0, 0.001, 0.0, 0.0];
            parts[place] = bad;
            let found = model().resolve(&Wrench::from_components(&parts.into()), &tip());
            assert_eq!(found, Resolution::NoContact(NoContact::NotFinite));
        }
    }
}

#[test]
fn thresholds_are_validated() {
    for bad in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(PointContact::new(bad).is_err());
        assert!(model().with_greatest_gap(bad).is_err());
        assert!(model().with_greatest_friction(bad).is_err());
    }
}

/// The derivative of the contact point agrees with finite differences on a posed ellipsoid.
#[test]
fn sensitivity_agrees_with_finite_differences() {
    let pose = RigidTransform::from_axis_angle(v(0.3, -0.5, 0.2), v(0.01, 0.02, 0.03)).unwrap();
    let surface = Posed::new(Ellipsoid::new(v(0.02, 0.015, 0.01)).unwrap(), pose);
    let point = pose.transform_point(&(v(0.02 * 0.36, 0.015 * 0.48, 0.01 * 0.8)));
    let force = -surface.normal(&point) * 3.0 + v(0.5, -0.4, 0.3);
    // With a pitch.
    let base = Wrench::on_fingertip(force, point.cross(&force) + force * 1e-3);
    let contact = *model().resolve(&base, &surface).contact().unwrap();
    let derivative = contact.sensitivity(&base).unwrap();
    for k in 0..6 {
        let step = if k < 3 { 1e-5 } else { 1e-7 };
        let shifted = |sign: f64| {
            let mut parts = base.components();
            parts[k] += sign * step;
            model().resolve(&Wrench::from_components(&parts), &surface).contact().unwrap().point
        };
        let difference = (shifted(1.0) - shifted(-1.0)) / (2.0 * step);
        let error = (difference - derivative.column(k)).norm() / derivative.column(k).norm();
        assert!(error < 1e-7, "component {k}: {error:e}");
    }
    let covariance = contact.covariance(&base, &nalgebra::Matrix6::identity()).unwrap();
    assert!((covariance * contact.normal).norm() < 1e-12 * covariance.norm());
}
