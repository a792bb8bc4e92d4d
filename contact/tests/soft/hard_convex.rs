//! Convex bodies on which Newton's method has a hard time: flat ones, needles, and boxes with sharp edges.

use fingertip_contact::{ContactModel, NoContact, Resolution, SoftContact, SoftFinger, SoftFingerSurface};
use fingertip_surfaces::{ActiveSurface, Ellipsoid, RoundedBox, Superquadric};
use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;

use crate::wrenches::Random;

const SPINS: [f64; 9] = [1e-3, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 100.0, 1e4];

/// Of wrenches through the body with a spin torque of any size, every one has a contact. How many are not found;
/// those that are solve the equations as well as the type does.
fn lost<T: Real, S: SoftFingerSurface<T>>(
    surface: &S,
    count: usize,
    normal_of: impl Fn(&Vector3<f64>) -> Vector3<f64>,
) -> usize {
    let model = SoftFinger::new(T::zero()).unwrap().without_friction_limit();
    let (mut random, mut lost) = (Random::new(201), 0);
    for spin in SPINS {
        for k in 0..count {
            let (through, force, any) = (random.direction() * 0.01, random.direction(), random.direction());
            let axis = if k % 3 == 0 { (any.cross(&force) + force * 1e-3).normalize() } else { any };
            let torque = through.cross(&force) + axis * (spin * 0.01);
            let narrow = Wrench::on_fingertip(force.map(T::literal), torque.map(T::literal));
            match model.resolve(&narrow, surface) {
                Resolution::Contact(contact) => {
                    let [f, m] = [narrow.force(), narrow.torque()].map(|v| v.map(Real::to_f64));
                    let [c, n] = [contact.point, contact.normal].map(|v| v.map(Real::to_f64));
                    let rest = m - c.cross(&f) - n * contact.spin_torque.to_f64();
                    let hair = 64.0 * T::EPSILON.to_f64();
                    assert!(f.dot(&n) < 0.0, "{narrow:?} {contact:?}");
                    // The normal is that of a place that is known to some last digits.
                    let near = (0..20).map(|_| normal_of(&(c + random.direction() * (hair * 0.02))) - n);
                    let known = 8.0 * near.map(|off| off.norm()).fold(4.0 * hair, f64::max);
                    let off = (normal_of(&c) - n).norm();
                    assert!(off <= known, "{off:e} {known:e} {narrow:?} {contact:?}");
                    let allowed = hair * (0.02 + m.norm()) + known * contact.spin_torque.to_f64().abs();
                    assert!(rest.norm() < allowed, "{spin} {narrow:?} {contact:?}");
                }
                Resolution::NoContact(NoContact::Unresolved) => lost += 1,
                Resolution::NoContact(reason) => panic!("{reason:?} {spin} {narrow:?}"),
            }
        }
    }
    lost
}

#[test]
fn no_contact_is_lost_in_double_precision() {
    for axes in [[0.0008, 0.011, 0.017], [0.0008, 0.0011, 0.017]] {
        let body = Ellipsoid::new(Vector3::from(axes)).unwrap();
        assert_eq!(lost::<f64, _>(&body, 60, |c| body.normal(c)), 0, "{axes:?}");
    }
    for exponents in [[0.1, 0.1], [0.3, 0.2]] {
        let body = Superquadric::new(Vector3::new(0.008, 0.010, 0.013), exponents).unwrap();
        assert_eq!(lost::<f64, _>(&body, 60, |c| body.normal(c)), 0, "{exponents:?}");
    }
    for rounding in [1e-4, 1e-3, 5e-3] {
        let body = RoundedBox::new(Vector3::new(0.008, 0.010, 0.013), rounding).unwrap();
        assert_eq!(lost::<f64, _>(&body, 200, |c| body.normal(c)), 0, "{rounding:?}");
    }
}

/// A contact next to a seam, where the curvature jumps and Newton's method goes to and fro: none was found.
#[test]
fn a_contact_next_to_a_seam_is_found() {
    let half = Vector3::new(3.9436754e-6, 6.7888222e-6, 3.5719047e-6);
    let body = RoundedBox::new(half, 2.8495626e-6).unwrap();
    let force = Vector3::new(-3_680_734_470.959_839_f64, -3_719_912_254.627_693, -5_474_700_485.281_036);
    let torque = Vector3::new(43_112.481_132_392_81, 9_968_229.912_222_939, -7_012_491.391_812_064);
    let mut found = Vec::new();
    let search =
        body.soft_contacts(&Wrench::on_fingertip(force, torque), None, |contact| found.push(contact));
    let [contact] = found[..] else { panic!("{search:?} {found:?}") };
    let SoftContact { point, normal, spin_torque, .. } = contact;
    let rest = torque - point.cross(&force) - normal * spin_torque;
    assert!(rest.norm() < 1e-12 * torque.norm() && force.dot(&normal) < 0.0, "{contact:?} {rest:?}");
    assert!((normal - body.normal(&point)).norm() < 1e-12, "{contact:?}");
}

/// On the sharp edges of a box single precision has too few digits for all of them.
#[test]
fn few_contacts_are_lost_in_single_precision() {
    for (exponents, most) in [([0.1, 0.1], 24), ([0.3, 0.2], 8), ([0.7, 0.8], 0)] {
        let body = Superquadric::new(Vector3::new(0.008, 0.010, 0.013), exponents).unwrap();
        let exact = Superquadric::new(body.semi_axes().cast(), exponents.map(f64::from)).unwrap();
        let lost = lost::<f32, _>(&body, 150, |c| exact.normal(c));
        println!("{exponents:?}: {lost} of {} lost", 150 * SPINS.len());
        assert!(lost <= most, "{exponents:?} {lost}");
    }
}

/// A pure force beside a body misses it, and it is said by how much.
#[test]
fn a_pure_force_beside_a_body_misses() {
    let body = Superquadric::new(Vector3::new(0.008, 0.010, 0.013), [0.7, 0.8]).unwrap();
    let model = SoftFinger::new(0.0).unwrap().without_friction_limit();
    for (through, force, gap) in [
        ([0.009, 0.0, 0.0], [0.0, 0.0, -2.0], 0.001),
        ([0.0, 0.0125, 0.0], [0.0, 0.0, 1.5], 0.0025),
        ([0.0, 0.0, -0.015], [-1.0, 0.0, 0.0], 0.002_f64),
    ] {
        let wrench = Wrench::from_force_at(&Vector3::from(through), Vector3::from(force));
        match model.resolve(&wrench, &body) {
            Resolution::NoContact(NoContact::Misses { closest: Some(closest) }) => {
                assert!((closest.gap - gap).abs() < 1e-12, "{closest:?}");
            }
            other => panic!("{other:?}"),
        }
    }
}
