//! Which contacts the short ways of searches answer: what they leave takes ten times as long.

use fingertip_contact::{SoftContact, SoftFingerSurface};
use fingertip_surfaces::{ForceLine, RoundedBox, SmoothSurface, Superquadric};
use fingertip_wrench::Wrench;
use nalgebra::Vector3;

use crate::wrenches::Random;

/// A press within 60° of the normal, with a spin torque of up to so much of the force; where the force is `Wrench`'s.
fn press(random: &mut Random, point: &Vector3<f64>, normal: &Vector3<f64>, lever: f64) -> Wrench<f64> {
    let force = random.force(normal, 0.5, 1.0);
    let spin = random.uniform(-lever, lever) * force.norm();
    Wrench::on_fingertip(force, point.cross(&force) + normal * spin)
}

/// What the short way finds is the touch.
fn is_at(found: &SoftContact<f64>, point: &Vector3<f64>, size: f64) {
    assert!((found.point - point).norm() < 1e-9 * size, "{found:?} {point}");
}

/// Also of boxy ones, of which one contact in twenty is where neither the place nor the normal on the ellipsoid leads, and of
/// pure forces that pass the ellipsoid by.
#[test]
fn steep_presses_on_superquadrics_take_the_short_way() {
    let mut random = Random::new(71);
    let size = 0.0338;
    for exponents in [[0.5, 0.7], [0.3, 0.3], [1.3, 0.8]] {
        let shape = Superquadric::new(Vector3::new(0.013, 0.0104, 0.0169), exponents).unwrap();
        for lever in [0.03 * size, 0.0] {
            let mut answered = 0;
            for _ in 0..2000 {
                // Off the planes of two axes, where second derivatives are infinite.
                let away = random.direction().map(|x| x.abs().max(0.05).copysign(x)) * 0.01;
                let point = away / (1.0 + shape.level(&away).value);
                let normal = shape.level(&point).gradient.normalize();
                let wrench = press(&mut random, &point, &normal, lever);
                let push = ForceLine::new(&wrench, ForceLine::least_squared()).unwrap();
                let Some(found) = shape.sole_soft_contact(&push) else { continue };
                is_at(&found, &point, size);
                answered += 1;
            }
            assert!(answered >= 1995, "{exponents:?} {lever}: {answered} of 2000");
        }
    }
}

/// Also of flat ones, on which the face that the force presses on most is often another one than that which it comes through;
/// and in columns but for the few with two parts behind the face.
#[test]
fn steep_presses_on_rounded_boxes_take_the_short_way() {
    let mut random = Random::new(72);
    let (half, rounding) = (Vector3::new(0.013, 0.0091, 0.0052), 0.002);
    let shape = RoundedBox::new(half, rounding).unwrap();
    let core = half.map(|half| half - rounding);
    let [mut answered, mut together] = [0; 2];
    for k in 0..6000 {
        let mut away = half.map(|half| random.uniform(-half, half));
        away[k % 3] = half[k % 3].copysign(away[k % 3]);
        let inside = away.zip_map(&core, |x, core: f64| x.clamp(-core, core));
        let normal = (away - inside).normalize();
        let point = inside + normal * rounding;
        let wrench = press(&mut random, &point, &normal, 0.0015);
        let push = ForceLine::new(&wrench, ForceLine::least_squared()).unwrap();
        let (one, column) = (shape.sole_soft_contact(&push), shape.sole_soft_contacts_in_columns()(&push));
        if let Some(found) = &one {
            is_at(found, &point, 0.026);
            answered += 1;
        }
        if column.is_some() {
            assert_eq!(one, column);
            together += 1;
        }
    }
    assert!(answered >= 5940 && together >= 5400, "{answered}, in columns {together}, of 6000");
}
