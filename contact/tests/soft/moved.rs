//! A shape that knows its own place answers as the same shape about the origin, moved there.

use fingertip_contact::{ContactModel, NoContact, Resolution, SoftFinger, SoftFingerSurface};
use fingertip_surfaces::*;
use fingertip_test_support::Worst;
use fingertip_wrench::{RigidTransform, Wrench};
use nalgebra::Vector3;

use crate::common;
use crate::wrenches::{Case, Random};

const ORIGIN: Vector3<f64> = Vector3::new(0.004, -0.003, 0.006);

/// From the frame of the shape about the origin, whose third axis is its own.
fn pose() -> RigidTransform<f64> {
    RigidTransform::from_axis_angle(Vector3::new(0.7, -0.4, 0.3), ORIGIN).unwrap()
}

/// Wrenches of contacts with much and little spin torque, and forces along any line, some of which miss, meet
/// what is not active, or only pull. All kinds of answers that `kinds` names come up.
fn same<A, B>(name: &str, at_origin: A, moved: &B, kinds: &[&str])
where
    A: SoftFingerSurface<f64> + ActiveSurface<f64>,
    B: SoftFingerSurface<f64> + ActiveSurface<f64>,
{
    let model = SoftFinger::new(0.0).unwrap().without_friction_limit();
    let posed = Posed::new(at_origin, pose());
    let (mut random, mut worst, mut seen) = (Random::new(171), Worst::new(), Vec::new());
    for round in 0..3000 {
        let wrench = if round % 3 == 0 {
            let through = ORIGIN + random.direction() * random.uniform(0.0, 0.02);
            Wrench::from_force_at(&through, random.direction())
        } else if round % 3 == 1 {
            Wrench::on_fingertip(random.direction(), random.direction() * random.log_uniform(1e-4, 0.1))
        } else {
            Case::random(&mut random, &posed, 0.02, [1e-6, 1.0], 1.0).wrench
        };
        let (ours, theirs) = (model.resolve(&wrench, moved), model.resolve(&wrench, &posed));
        let kind = match (ours, theirs) {
            (Resolution::Contact(ours), Resolution::Contact(theirs)) => {
                // A flat angle and a spin torque multiply rounding.
                let loose = 1.0 / ours.incidence().powi(2) + ours.spin_torque.abs() / 0.01;
                worst.see((ours.point - theirs.point).norm() / loose);
                assert!((ours.normal - theirs.normal).norm() < 1e-11 * loose, "{name} {ours:?} {theirs:?}");
                assert!((ours.spin_torque - theirs.spin_torque).abs() < 1e-13 * loose, "{ours:?} {theirs:?}");
                assert_eq!(ours.alternatives, theirs.alternatives, "{name} {wrench:?}");
                "contact"
            }
            (Resolution::NoContact(ours), Resolution::NoContact(theirs)) => {
                let near = |a: Vector3<f64>, b: Vector3<f64>| {
                    assert!(
                        (a - b).norm() < 1e-8 * (1.0 + a.norm()),
                        "{name} {ours:?} {theirs:?} {wrench:?}"
                    );
                };
                match (ours, theirs) {
                    (
                        NoContact::OutsideActiveRegion { point },
                        NoContact::OutsideActiveRegion { point: other },
                    ) => {
                        near(point, other);
                        "outside"
                    }
                    (NoContact::OnlyPulling { point }, NoContact::OnlyPulling { point: other }) => {
                        near(point, other);
                        "pulls"
                    }
                    (NoContact::Misses { closest }, NoContact::Misses { closest: other }) => {
                        assert_eq!(closest.is_some(), other.is_some(), "{name}");
                        if let Some((one, two)) = closest.zip(other) {
                            assert!(
                                (one.gap - two.gap).abs() < 1e-9,
                                "{name} {ours:?} {theirs:?} {wrench:?}"
                            );
                        }
                        "misses"
                    }
                    (NoContact::Ambiguous { .. }, NoContact::Ambiguous { .. }) => "ambiguous",
                    (NoContact::Unresolved, NoContact::Unresolved) => "unresolved",
                    (ours, theirs) => panic!("{name}: {ours:?} and {theirs:?} {wrench:?}"),
                }
            }
            (ours, theirs) => {
                // Whether a pure force that misses has, by rounding, a spin torque that holds it, is rounding.
                let mut misses = round % 3 == 0;
                posed.crossings(&wrench.line_of_action().unwrap().line, |_| misses = false);
                assert!(misses, "{name}: {ours:?} and {theirs:?} {wrench:?}");
                "rounding"
            }
        };
        if !seen.contains(&kind) {
            seen.push(kind);
        }
    }
    let worst = worst.get();
    println!("{name}: {worst:.1e} m apart, {seen:?}");
    assert!(worst < 1e-13, "{name} {worst:e}");
    for kind in kinds {
        assert!(seen.contains(kind), "{name}: no {kind} in {seen:?}");
    }
}

#[test]
fn shapes_with_a_place_of_their_own() {
    let (z, none) = (Vector3::z(), Vector3::zeros());
    let at = |height: f64| pose().transform_point(&(z * height));
    let axis = pose().rotate(&z);
    same(
        "plane",
        Plane::new(z * 0.005, z).unwrap(),
        &Plane::new(at(0.005), axis).unwrap(),
        &["contact", "pulls"],
    );
    let sphere = |centre| Sphere::new(centre, 0.013).unwrap();
    same("sphere", sphere(z * 0.002), &sphere(at(0.002)), &["contact", "ambiguous"]);
    let cap = |sphere, pole| SphericalCap::new(sphere, pole, 0.2).unwrap();
    same("cap", cap(sphere(none), z), &cap(sphere(at(0.0)), axis), &["contact", "outside"]);
    let cylinder = |centre, axis| Cylinder::new(centre, axis, 0.009).unwrap();
    let cut = |centre, axis| cylinder(centre, axis).with_half_length(0.008).unwrap();
    same("cylinder", cylinder(none, z), &cylinder(at(0.3), axis), &["contact", "misses"]);
    same("cut cylinder", cut(z * 0.002, z), &cut(at(0.002), axis), &["contact", "misses", "outside"]);
    let capped = |centre, axis| CappedCylinder::new(centre, axis, 0.009, 0.008).unwrap();
    same("capped cylinder", capped(z * 0.002, z), &capped(at(0.002), axis), &["contact", "misses"]);
    let capsule = |centre, axis| Capsule::new(centre, axis, 0.007, 0.006).unwrap();
    same("capsule", capsule(z * 0.002, z), &capsule(at(0.002), axis), &["contact", "misses"]);
    let cone = |apex, axis| Cone::new(apex, axis, 0.5).unwrap();
    same("cone", cone(z * 0.01, -z), &cone(at(0.01), -axis), &["contact", "misses"]);
    let frustum = |base, axis, top| Frustum::new(base, axis, 0.010, top, 0.016).unwrap();
    same("frustum", frustum(-z * 0.008, z, 0.006), &frustum(at(-0.008), axis, 0.006), &["contact", "misses"]);
    same("spike", frustum(-z * 0.008, z, 0.0), &frustum(at(-0.008), axis, 0.0), &["contact", "misses"]);
    let disk = |centre, axis| Disk::new(centre, axis, 0.012).unwrap();
    same("disk", disk(z * 0.002, z), &disk(at(0.002), axis), &["contact", "outside", "pulls"]);
    let edges = [Vector3::x() * 0.012, Vector3::y() * 0.008];
    let [first, second] = edges.map(|edge| pose().rotate(&edge));
    let straight = Rectangle::new(z * 0.002, edges[0], edges[1]).unwrap();
    let turned = Rectangle::new(at(0.002), first, second).unwrap();
    same("rectangle", straight, &turned, &["contact", "outside", "pulls"]);
}

/// Through the sum of all, in a frame of its own.
#[test]
fn a_pose_of_a_pose_is_one_pose() {
    let back = Posed::new(common::ellipsoid::<f64>(), pose().inverse());
    let again = Posed::new(back, pose());
    let model = SoftFinger::new(0.0).unwrap().without_friction_limit();
    let (plain, mut random) = (common::ellipsoid::<f64>(), Random::new(172));
    for _ in 0..500 {
        let wrench = Case::random(&mut random, &plain, 0.017, [1e-6, 1.0], 1.0).wrench;
        let (one, other) = (model.resolve(&wrench, &plain), model.resolve(&wrench, &again));
        let (one, other) = (one.contact().unwrap().point, other.contact().unwrap().point);
        assert!((one - other).norm() < 1e-11, "{wrench:?} {one} {other}");
    }
}

/// On a face of a posed box, however large the spin torque, is the contact of the posed plane of that face, which is known to
/// the last digit: turning a wrench rounds it, and a face answers to that by as much as the spin torque is large.
#[test]
fn faces_of_posed_boxes_are_as_exact_as_planes() {
    let (model, mut random) = (SoftFinger::new(0.0).unwrap().without_friction_limit(), Random::new(173));
    let (body, mut ruled) = (Posed::new(common::rounded_box::<f64>(), pose()), 0);
    let (half, rounding) = (body.inner().half_extents(), body.inner().rounding());
    for round in 0..3000 {
        let mut normal = Vector3::zeros();
        normal[round % 3] = random.sign();
        let place = half.zip_map(&normal, |half, n: f64| {
            if n == 0.0 { (half - rounding) * random.uniform(-0.9, 0.9) } else { half * n }
        });
        let plane = Posed::new(Plane::new(place.component_mul(&normal.abs()), normal).unwrap(), pose());
        let (point, outward) = (pose().transform_point(&place), pose().rotate(&normal));
        let force = random.force(&outward, 0.35, 1.0);
        let spin = random.sign() * random.log_uniform(1e-6, 100.0);
        let wrench = Wrench::on_fingertip(force, point.cross(&force) + outward * spin);
        let [found, exact] = [model.resolve(&wrench, &body), model.resolve(&wrench, &plane)]
            .map(|found| found.into_result().unwrap());
        assert!((found.point - exact.point).norm() < 2e-17, "{found:?} {exact:?} {wrench:?}");
        ruled += usize::from(spin.abs() > 0.1);
    }
    assert!(ruled > 500, "{ruled}");
}
