//! The part of a sphere that may touch.

use fingertip_contact::*;
use fingertip_surfaces::*;
use fingertip_wrench::{Line, Wrench};
use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};

fn within(sphere: Sphere<f64>, pole: Vector3<f64>, half_angle: f64) -> SphericalCap<f64> {
    SphericalCap::new(sphere, pole, half_angle.cos()).unwrap()
}

#[test]
fn a_push_past_the_rim_is_outside_and_one_within_is_a_contact() {
    let sphere = Sphere::centred(0.013).unwrap();
    let cap = within(sphere, Vector3::x(), 100_f64.to_radians());
    let model = PointContact::new(0.1).unwrap();
    for (angle, inside) in [(0.0_f64, true), (60.0, true), (99.0, true), (101.0, false), (170.0, false)] {
        let normal = Vector3::new(angle.to_radians().cos(), angle.to_radians().sin(), 0.0);
        let wrench = Wrench::from_force_at(&(normal * 0.013), -normal);
        match model.resolve(&wrench, &cap) {
            Resolution::Contact(contact) => {
                assert!(inside, "{angle}");
                assert!((contact.point - normal * 0.013).norm() < 1e-12);
            }
            // The line enters outside the cap, and leaves, pulling, on it.
            Resolution::NoContact(NoContact::OutsideActiveRegion { .. } | NoContact::OnlyPulling { .. }) => {
                assert!(!inside, "{angle}");
            }
            Resolution::NoContact(other) => panic!("{angle}: {other}"),
        }
        assert!(model.resolve(&wrench, &SphericalCap::from(sphere)).contact().is_some(), "{angle}");
    }
}

#[test]
fn what_is_active_is_what_lies_within_the_angle() {
    let sphere = Sphere::new(Vector3::new(0.001, -0.002, 0.003), 0.01).unwrap();
    let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(3);
    let mut direction = || Vector3::from_fn(|_, _| random.random_range(-1.0..1.0_f64)).normalize();
    let mut active = [0, 0];
    for _ in 0..2000 {
        let (pole, normal) = (direction(), direction());
        let half_angle: f64 = 1.2;
        let cap = within(sphere, pole, half_angle);
        let expected = normal.angle(&pole) <= half_angle;
        active[usize::from(expected)] += 1;
        // A line through the point, along its normal, and one that passes above it.
        let point = sphere.centre() + normal * 0.01;
        let line = Line { point, direction: normal };
        let mut seen = Vec::new();
        cap.crossings(&line, |crossing| seen.push((crossing.normal, crossing.active)));
        assert_eq!(seen.len(), 2);
        for (normal, active) in seen {
            assert_eq!(active, normal.angle(&pole) <= half_angle);
        }
        let aside = normal.cross(&direction()).normalize();
        let above = Line { point: point + normal * 0.005, direction: aside };
        let approach = cap.closest_approach(&above).unwrap();
        assert_eq!(approach.active, expected);
        assert!((approach.normal - normal).norm() < 1e-9);
        assert!((cap.normal(&point) - normal).norm() < 1e-9);
        // The whole, and a cap of half a turn, leave nothing out: not even the antipode.
        for all in [SphericalCap::from(sphere), within(sphere, pole, core::f64::consts::PI)] {
            let line = Line { point: sphere.centre(), direction: pole };
            all.crossings(&line, |crossing| assert!(crossing.active, "{:?}", crossing.normal));
            assert!(all.closest_approach(&above).unwrap().active);
            assert_eq!((all.least_cosine(), all.active_fraction()), (-1.0, 1.0));
        }
        assert_eq!(cap.sphere().radius(), 0.01);
    }
    assert!(active.iter().all(|times| *times > 300), "{active:?}");
}
