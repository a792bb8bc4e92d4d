//! Freedoms that are known because the contacts were made for them: almost without friction, so that each resists one
//! motion only, and placed so that a slide, a turn or a screw is what is left.

use fingertip_hand::{Grasp, GraspContact};
use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use crate::support::{TestHand, vector};

/// Ten contacts near a place that resist all but one motion: its velocity and angular velocity at the place. The first
/// `on_axis` of them are on the line through the place.
fn leaving(
    rng: &mut Pcg64Mcg,
    place: Vector3<f64>,
    velocity: Vector3<f64>,
    turning: Vector3<f64>,
    on_axis: usize,
) -> Grasp<f64, 10, TestHand> {
    let mut contacts = [None; 10];
    for (i, contact) in contacts.iter_mut().enumerate() {
        let away =
            if i < on_axis { turning.normalize() * (0.03 - 0.05 * i as f64) } else { vector(rng) * 0.04 };
        let moves = velocity + turning.cross(&away);
        let normal = loop {
            let any = vector(rng);
            let normal = any - moves * (any.dot(&moves) / moves.norm_squared().max(1e-300));
            if normal.norm() > 0.2 {
                break normal;
            }
        };
        *contact = GraspContact::point(place + away, normal, 1e-13).ok();
    }
    Grasp::new(contacts)
}

/// What is said, of either sign of the direction.
fn words(along: Vector3<f64>, say: impl Fn(String) -> String) -> [String; 2] {
    [along, -along].map(|v| {
        let [x, y, z] = v.map(|x| x + 0.0).into();
        say(format!("({x:.3}, {y:.3}, {z:.3})"))
    })
}

/// The one freedom, its motion compared with what it must be.
fn only(grasp: &Grasp<f64, 10, TestHand>, velocity: Vector3<f64>, turning: Vector3<f64>) -> String {
    assert_eq!(grasp.rank(), 5);
    let freedoms = grasp.freedoms();
    assert_eq!(freedoms.iter().flatten().count(), 1);
    let freedom = freedoms[0].unwrap();
    let scale = freedom.velocity.dot(&velocity) + freedom.turning.dot(&turning);
    let scale = scale / (velocity.norm_squared() + turning.norm_squared());
    assert!((freedom.velocity - velocity * scale).norm() < 1e-7 * scale.abs() * velocity.norm().max(0.1));
    assert!((freedom.turning - turning * scale).norm() < 1e-7 * scale.abs() * turning.norm().max(1.0));
    freedom.to_string()
}

#[test]
fn what_slides_is_said_to_slide() {
    let mut rng = Pcg64Mcg::seed_from_u64(61);
    for _ in 0..50 {
        let (place, along) = (vector(&mut rng) * 0.2, vector(&mut rng).normalize());
        let grasp = leaving(&mut rng, place, along, Vector3::zeros(), 0);
        let said = only(&grasp, along, Vector3::zeros());
        assert!(words(along, |v| format!("sliding along {v}")).contains(&said), "{said} {along}");
    }
}

#[test]
fn what_turns_is_said_to_turn_about_its_line() {
    let mut rng = Pcg64Mcg::seed_from_u64(62);
    for index in 0..80 {
        let (place, axis) = (vector(&mut rng) * 0.2, vector(&mut rng).normalize());
        // With so many contacts on the line.
        let on = index % 4;
        let grasp = leaving(&mut rng, place, Vector3::zeros(), axis, on);
        let said = only(&grasp, place.cross(&axis), axis);
        // The point of the line that is nearest to the centre.
        let nearest = place + axis * axis.dot(&(grasp.centre() - place));
        let [x, y, z] = nearest.into();
        let expected = words(axis, |v| match on {
            1 => format!("turning about the line through contact 0 along {v}"),
            2 => "turning about the line through contacts 0 and 1".to_owned(),
            _ => format!("turning about the line through ({x:.3}, {y:.3}, {z:.3}) m along {v}"),
        });
        let zeros = |s: &String| s.replace("-0.000", "0.000");
        assert!(expected.iter().map(zeros).any(|e| e == zeros(&said)), "{said} {expected:?}");
    }
}

#[test]
fn a_screw_is_said_with_its_pitch() {
    let mut rng = Pcg64Mcg::seed_from_u64(63);
    for _ in 0..80 {
        let (place, axis) = (vector(&mut rng) * 0.2, vector(&mut rng).normalize());
        let pitch = rng.random_range(0.002..0.05) * if rng.random_range(0..2) == 0 { 1.0 } else { -1.0 };
        let grasp = leaving(&mut rng, place, axis * pitch, axis, 0);
        let said = only(&grasp, axis * pitch + place.cross(&axis), axis);
        let nearest = place + axis * axis.dot(&(grasp.centre() - place));
        let [x, y, z] = nearest.into();
        let expected = words(axis, |v| {
            format!(
                "turning about the line through ({x:.3}, {y:.3}, {z:.3}) m along {v} and sliding {pitch:.4} m for each radian"
            )
        });
        let zeros = |s: &String| s.replace("-0.000", "0.000");
        assert!(expected.iter().map(zeros).any(|e| e == zeros(&said)), "{said} {expected:?}");
    }
}
