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

/// Pressed at an angle, with every number of the wrench at fault: the distance is that of the worst of the 64
/// corners of the box, the coordinates are each that of their own worst corner.
#[test]
fn it_is_the_worst_corner_of_the_box() {
    let egg = Ellipsoid::new(Vector3::new(0.008, 0.011, 0.017)).unwrap();
    let skin = LinearStiffness::new(STIFFNESS, RADIUS).unwrap();
    let model = CompliantSoftFinger::new(SoftFinger::new(0.0).unwrap(), skin);
    for (force, torque) in [
        (Vector3::new(0.4, -0.7, -1.5), Vector3::new(0.004, 0.003, -0.002)),
        (Vector3::new(-1.2, 0.3, 0.8), Vector3::new(-0.001, 0.002, 0.004)),
    ] {
        let wrench = Wrench::on_fingertip(force, torque);
        let found = model.resolve_indented(&wrench, &egg, None).unwrap();
        let jacobian = model.jacobian(&found, &egg).unwrap();
        for stressed in 0..7 {
            let mut errors = Vector6::new(0.01, 0.02, 0.015, 1e-4, 2e-4, 3e-4);
            // And with one error that is far greater than the others.
            if stressed < 6 {
                errors[stressed] *= 30.0;
            }
            let worst = jacobian.worst_case(&errors);
            let (mut far, mut components, mut local) = (0.0_f64, Vector3::zeros(), Vector6::zeros());
            for corner in 0..64_u8 {
                let error =
                    Vector6::from_fn(|i, _| if corner >> i & 1 == 1 { errors[i] } else { -errors[i] });
                let moved: Vector3<f64> = jacobian.point() * error;
                far = far.max(moved.norm());
                components = components.sup(&moved);
                local = local.sup(&(jacobian.local() * error));
            }
            assert!((worst.distance / far - 1.0).abs() < 1e-12, "{worst:?} {far}");
            assert!((worst.components - components).norm() < 1e-12 * far, "{worst:?} {components}");
            assert!((worst.normal_force / local[2] - 1.0).abs() < 1e-12);
            assert!((worst.spin_torque / local[5] - 1.0).abs() < 1e-12);
        }
    }
}
