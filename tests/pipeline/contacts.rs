//! Contacts that are known, found again: signals in, touch out.

use fingertip::Fingertip;
use fingertip::contact::{PointContact, Resolution};
use fingertip::friction::Coulomb;
use fingertip::surfaces::Sphere;
use fingertip::wrench::{GaussianElimination, Real, Wrench};
use nalgebra::{Vector3, Vector6};
use proptest::prelude::*;

use crate::paper_sensor;

const RADIUS: f64 = 13e-3;

/// A contact on the sphere: outward normal, and a force that presses on it.
fn contact() -> impl Strategy<Value = (Vector3<f64>, Vector3<f64>)> {
    let direction = prop::array::uniform3(-1.0..1.0_f64)
        .prop_map(Vector3::from)
        .prop_filter("has a direction", |v| v.norm() > 0.1);
    (direction.clone(), direction, 0.0..0.9_f64, 0.1..30.0_f64).prop_map(
        |(normal, other, friction, pressing)| {
            let normal = normal.normalize();
            let across = other.cross(&normal);
            let tangent = if across.norm() > 1e-3 { across.normalize() } else { Vector3::zeros() };
            (normal, -normal * pressing + tangent * (friction * pressing))
        },
    )
}

fn check_contact_is_found_again<T: Real>(normal: &Vector3<f64>, force: &Vector3<f64>) {
    let sensor = paper_sensor::<T>();
    let mut fingertip = Fingertip::builder()
        .solver(GaussianElimination::new(&sensor).unwrap())
        .contact(Sphere::centred(T::literal(RADIUS)).unwrap(), PointContact::new(T::literal(0.05)).unwrap())
        .friction(Coulomb::new(T::one()).unwrap())
        .build();
    let truth: Wrench<f64> = Wrench::from_force_at(&(normal * RADIUS), *force);
    let truth = truth.components().map(T::literal);
    let signals = sensor.signals(&Wrench::from_components(&truth));
    let touch = fingertip.sense(&signals, T::literal(1e-3));
    let contact = touch.resolution.into_result().expect("a pressing force is a contact");
    // The layout's condition number is 4.8 for normalised loads; a contact at |f_t| < 0.9 f_n
    // is seen at a cosine above 0.74. A factor of 200 on epsilon covers their product with the
    // few dozen roundings of the way.
    let tolerance = T::EPSILON.to_f64() * 200.0;
    let point = contact.point.map(Real::to_f64);
    assert!((point - normal * RADIUS).norm() < tolerance * RADIUS, "{point} instead of {}", normal * RADIUS);
    let found = contact.contact_force();
    assert!((found.normal.to_f64() + force.dot(normal)).abs() < tolerance * force.norm());
    let margin = touch.grip.expect("a contact has a margin").newtons.to_f64();
    let tangential = (force - normal * force.dot(normal)).norm();
    let expected = (-force.dot(normal) - tangential) / 2.0_f64.sqrt();
    assert!((margin - expected).abs() < tolerance * force.norm());
}

proptest! {
    #[test]
    fn a_contact_is_found_again((normal, force) in contact()) {
        check_contact_is_found_again::<f64>(&normal, &force);
        check_contact_is_found_again::<f32>(&normal, &force);
    }

    #[test]
    fn any_bits_as_signals_give_an_answer_without_nan(bits in prop::array::uniform6(any::<u32>())) {
        let mut fingertip = Fingertip::builder()
            .solver(GaussianElimination::new(&paper_sensor::<f32>()).unwrap())
            .contact(Sphere::centred(RADIUS as f32).unwrap(), PointContact::new(0.0).unwrap())
            .friction(Coulomb::new(0.5).unwrap())
            .build();
        let touch = fingertip.sense(&Vector6::from(bits.map(f32::from_bits)), 1e-3);
        if let Resolution::Contact(contact) = touch.resolution {
            prop_assert!(contact.point.iter().all(|x| x.is_finite()));
            prop_assert!((0.0..=1.0).contains(&contact.incidence()));
            let margin = touch.grip.unwrap();
            prop_assert!(!margin.newtons.is_nan() && !margin.utilisation.is_nan());
        }
    }
}
