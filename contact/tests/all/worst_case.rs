//! Worst cases of a contact through a skin, against closed forms.

use fingertip_contact::*;
use fingertip_surfaces::*;
use fingertip_wrench::Wrench;
use nalgebra::{Vector3, Vector6};

const STIFFNESS: f64 = 2000.0;
const RADIUS: f64 = 0.013;

/// Pressed squarely, a sphere under a skin of springs: `δ = N/k`.
fn pressed_squarely() -> ContactJacobian<f64> {
    let sphere = Sphere::centred(RADIUS).unwrap();
    let skin = LinearStiffness::new(STIFFNESS, RADIUS).unwrap();
    let model = CompliantPointContact::new(PointContact::new(0.0).unwrap(), skin);
    let wrench = Wrench::on_fingertip(Vector3::new(0.0, 0.0, -2.0), Vector3::zeros());
    let found = model.resolve_indented(&wrench, &sphere, None).unwrap();
    assert!((found.contact.point - Vector3::z() * (RADIUS - 2.0 / STIFFNESS)).norm() < 1e-15);
    model.jacobian(&found, &wrench, &sphere).unwrap()
}

/// An error of the pressing force alone moves the contact along the normal, by `dN/k`, and no other way.
#[test]
fn a_skin_lets_the_contact_sink() {
    let jacobian = pressed_squarely();
    let worst = jacobian.worst_case(&Vector6::new(0.0, 0.0, 0.1, 0.0, 0.0, 0.0));
    let sinks = 0.1 / STIFFNESS;
    assert!((worst.distance / sinks - 1.0).abs() < 1e-12, "{worst:?}");
    assert!((worst.components - Vector3::z() * sinks).norm() < 1e-12 * sinks, "{worst:?}");
    assert!((worst.normal_force - 0.1).abs() < 1e-15 && worst.spin_torque == 0.0);
}

/// With an error of a torque, which moves the line of action by `dm/f`, the two are square to each other.
#[test]
fn sinking_and_sliding_add_as_squares() {
    let jacobian = pressed_squarely();
    let worst = jacobian.worst_case(&Vector6::new(0.0, 0.0, 0.1, 0.0, 2e-4, 0.0));
    let (sinks, slides) = (0.1 / STIFFNESS, 2e-4 / 2.0);
    assert!((worst.distance / sinks.hypot(slides) - 1.0).abs() < 1e-12, "{worst:?}");
    assert!((worst.components - Vector3::new(slides, 0.0, sinks)).norm() < 1e-12 * slides, "{worst:?}");
}

/// The sign of an error does not matter, and what is not a number is not passed over.
#[test]
fn errors_without_sign_and_without_a_value() {
    let jacobian = pressed_squarely();
    let errors = Vector6::new(0.01, 0.02, 0.1, 1e-4, 2e-4, 3e-4);
    assert_eq!(jacobian.worst_case(&errors), jacobian.worst_case(&-errors));
    for axis in 0..6 {
        let mut errors = errors;
        errors[axis] = f64::NAN;
        assert!(jacobian.worst_case(&errors).distance.is_nan(), "{axis}");
    }
}
