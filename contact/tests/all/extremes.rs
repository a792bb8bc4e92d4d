//! Forces that press squarely, and shapes of extreme size.

use fingertip_contact::{ContactModel, PointContact};
use fingertip_surfaces::{Ellipsoid, ForceLine, Shortcuts, Sphere};
use fingertip_wrench::Wrench;
use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// In double precision, by the vectors: where a single-precision force enters, and its parts there.
fn by_vectors(force: &Vector3<f64>, torque: &Vector3<f64>, radius: f64) -> [f64; 2] {
    let square = force.norm_squared();
    let foot = force.cross(torque) / square;
    let point = foot - force * ((radius * radius - foot.norm_squared()) / square).sqrt();
    [-force.dot(&point) / radius, force.cross(&point).norm() / radius]
}

/// However squarely a force presses, its small tangential part has all its digits.
#[test]
fn parts_of_the_force_are_known_to_the_last_digits() {
    let mut random = Pcg64Mcg::seed_from_u64(12);
    let radius = 0.013_f32;
    let (sphere, model) = (Sphere::centred(radius).unwrap(), PointContact::new(0.0_f32).unwrap());
    for _ in 0..20_000 {
        let mut any = || Vector3::<f64>::from_fn(|_, _| random.random_range(-1.0..1.0));
        let (force, arm) = (any(), any());
        let sine = 10.0_f64.powf(random.random_range(-9.0..-0.05));
        let strength = 10.0_f64.powf(random.random_range(-5.0..5.0));
        let force = (force.normalize() * strength).map(|x| x as f32);
        let wide = force.map(f64::from);
        let arm = wide.cross(&arm).cross(&wide).normalize() * (sine * f64::from(radius));
        let torque = arm.cross(&wide).map(|x| x as f32);
        let wrench = Wrench::on_fingertip(force, torque);
        let push = ForceLine::new(&wrench, ForceLine::least_squared()).unwrap();
        let parts = sphere.sole_entry(&push).unwrap().parts.unwrap();
        let wanted = by_vectors(&wide, &torque.map(f64::from), f64::from(radius));
        let eps = f64::from(f32::EPSILON);
        // A part of the torque along the force, from its rounding, cancels in the cross product.
        let off = |found: f32, wanted: f64| (f64::from(found) - wanted).abs() / wanted;
        assert!(off(parts.tangential, wanted[1]) <= 16.0 * eps, "{wrench:?}: {parts:?} {wanted:?}");
        // Of the cosine the digits that the sine takes are lost.
        let cosine_squared = 1.0 - sine * sine;
        let allowed = 16.0 * eps / cosine_squared;
        assert!(off(parts.normal, wanted[0]) <= allowed, "{wrench:?}: {parts:?} {wanted:?}");
        let (resolution, felt) = model.feel_near(&wrench, &sphere, None);
        let (contact, felt) = (resolution.into_result().unwrap(), felt.unwrap());
        let (afterwards, newtons) = (contact.contact_force(), allowed * strength);
        assert!(f64::from((felt.normal - afterwards.normal).abs()) <= newtons);
        assert!(f64::from((felt.tangential.vector() - afterwards.tangential.vector()).norm()) <= newtons);
        assert!(f64::from((felt.tangential_magnitude() - felt.tangential.norm()).abs()) <= newtons);
    }
}

/// Neither the square of a length nor of a curvature is a number here.
#[test]
fn sizes_beyond_the_range_of_squares() {
    let model = PointContact::new(0.0).unwrap();
    for size in [1e-170, 1e170] {
        let ellipsoid = Ellipsoid::new(Vector3::new(2.0, 3.0, 1.0) * size).unwrap();
        for force in [1e-100, 1.0, 1e93] {
            let push = Wrench::on_fingertip(Vector3::z() * -force, Vector3::zeros());
            let contact = *model.resolve(&push, &ellipsoid).contact().unwrap();
            assert!((contact.point / size - Vector3::z()).norm() < 1e-15);
            assert!((contact.normal - Vector3::z()).norm() < 1e-15);
        }
    }
}
