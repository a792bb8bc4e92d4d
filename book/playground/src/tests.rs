//! What a page would be told.

use crate::play::{Felt, Knobs, Play};
use crate::{gauges, shape};

const SHAPES: u32 = 7;

/// The page sets these by number.
const MODEL: u32 = 0;
const SPIN: u32 = 4;
const SIGN: u32 = 8;

fn three(play: &Play, place: Felt) -> [f64; 3] {
    let at = place as usize;
    [play.felt[at], play.felt[at + 1], play.felt[at + 2]]
}

fn apart(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

#[test]
fn every_shape_is_found_where_it_is_touched() {
    for number in 0..SHAPES {
        for model in 0..3 {
            let mut play = Play::default();
            assert!(play.set_shape(number) && play.knobs.set(MODEL, f64::from(model)));
            assert_eq!(play.touch(), 0, "shape {number}, model {model}");
            let error = apart(three(&play, Felt::Point), three(&play, Felt::True));
            assert!(error < 1e-7, "shape {number}, model {model}: {error} m");
            let [normal, tangential, ..] = play.felt[Felt::Parts as usize..] else { panic!("no parts") };
            assert!((normal - 2.0).abs() < 1e-6 && (tangential - 0.5).abs() < 1e-6, "{normal} {tangential}");
            assert!(play.felt[Felt::SemiAxes as usize] > 1e-6, "shape {number}, model {model}: no ellipse");
            assert!(play.felt[Felt::Instructions as usize] > 50.0, "shape {number}, model {model}: not counted");
            assert!(play.net.len() == (shape::ROWS + 1) * shape::COLUMNS * 3);
            assert!(play.net.iter().all(|number| number.is_finite()), "shape {number}");
        }
    }
    assert!(!Play::default().set_shape(SHAPES));
}

/// A spin torque moves the line off the contact, which only a soft finger knows: the offset is |τ| sin φ/|f| along the
/// tangent plane, times what the sphere adds.
#[test]
fn a_spin_torque_fools_a_point_contact_and_no_soft_finger() {
    let mut play = Play::default();
    assert!(play.knobs.set(SPIN, 2e-3));
    assert_eq!(play.touch(), 0);
    let fooled = apart(three(&play, Felt::Point), three(&play, Felt::True));
    assert!(fooled > 1e-4, "{fooled}");
    for model in [1.0, 2.0] {
        assert!(play.knobs.set(MODEL, model));
        assert_eq!(play.touch(), 0);
        let error = apart(three(&play, Felt::Point), three(&play, Felt::True));
        assert!(error < 1e-7, "{error}");
        assert!((play.felt[Felt::Parts as usize + 2] - 2e-3).abs() < 1e-8);
    }
}

#[test]
fn the_wrong_sign_puts_the_contact_on_the_far_side() {
    let mut play = Play::default();
    assert!(play.knobs.set(2, 0.0) && play.knobs.set(SIGN, -1.0));
    assert_eq!(play.touch(), 0);
    let far = apart(three(&play, Felt::Point), three(&play, Felt::True));
    assert!((far - 26e-3).abs() < 1e-9, "{far}");
}

#[test]
fn what_cannot_be_is_refused() {
    let mut play = Play::default();
    assert!(!play.knobs.set(9, 1.0) && !play.knobs.set(1, f64::NAN));
    assert!((play.knobs.normal - Knobs::default().normal).abs() < 1e-12);
    // Past the shape, and along no direction.
    assert!(!play.aim(&nalgebra::Vector3::new(0.1, 0.1, 0.1), &nalgebra::Vector3::x()));
    assert!(!play.aim(&nalgebra::Vector3::x(), &nalgebra::Vector3::zeros()));
    assert!(play.knobs.set(1, 0.001));
    assert_eq!(play.touch(), 3);
}

/// Three rosettes at the best angle, on a tube of the radius of the lever, have √2: none on a thin tube has less.
#[test]
fn condition_numbers_are_those_of_the_library() {
    let rosettes = gauges::condition(1, 19.79_f64.to_radians(), 0.0, 10e-3, 10e-3).unwrap_or(f64::NAN);
    assert!((rosettes - core::f64::consts::SQRT_2).abs() < 1e-3, "{rosettes}");
    assert!(gauges::condition(0, 14_f64.to_radians(), 10e-3, 5e-3, 10e-3).is_some_and(|number| number > 1.0));
    assert_eq!(gauges::condition(2, 0.3, 0.0, 10e-3, 10e-3), None);
    assert_eq!(gauges::condition(1, 0.3, 0.0, -1.0, 10e-3), None);
}
