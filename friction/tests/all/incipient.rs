//! Incipient slip on springs whose stiffness is known at every place.

use fingertip_friction::{ForceNoise, IncipientSlip, NormalForceGate, SlipVerdict};
use fingertip_wrench::ContactForce;
use nalgebra::Vector3;
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

const WINDOW: f64 = 4e-6;
const SHARE: f64 = 0.65;
const STEP: f64 = 1e-8;
const START: f64 = 0.26 * WINDOW;

fn new() -> IncipientSlip<f64> {
    let gate = NormalForceGate::from_noise(&ForceNoise::isotropic(0.01).unwrap());
    IncipientSlip::new(gate, WINDOW).unwrap().with_warning_share(SHARE).unwrap()
}

fn direction() -> Vector3<f64> {
    Vector3::new(2.0, -1.0, 2.0) / 3.0
}

/// On its way, past the first quarter of a window, in which it counts as at rest.
fn started(stiffness: f64) -> IncipientSlip<f64> {
    let mut detector = new();
    sample(&mut detector, 0.0, 0.0);
    sample(&mut detector, START, stiffness * START);
    detector
}

/// A sample at the way `x` with the resistance `force`.
fn sample(detector: &mut IncipientSlip<f64>, x: f64, force: f64) -> SlipVerdict {
    let load = ContactForce::new(2.0, direction() * -force, 0.0);
    detector.update(&load, &(Vector3::new(0.1, 0.2, -0.1) + direction() * x))
}

/// Moves on from `from` to `to` by small steps under a force; the way of the first sample with that verdict.
fn until(
    detector: &mut IncipientSlip<f64>,
    (from, to): (f64, f64),
    force: impl Fn(f64) -> f64,
    verdict: SlipVerdict,
) -> Option<f64> {
    let count = ((to - from) / STEP).round() as i32;
    (1..=count)
        .map(|index| from + STEP * f64::from(index))
        .find(|x| sample(detector, *x, force(*x)) == verdict)
}

/// A spring of 1 kN/m up to the knee, and a share of that from there on.
fn knee(at: f64, share: f64) -> impl Fn(f64) -> f64 {
    move |x| 1e3 * (x.min(at) + share * (x - at).max(0.0))
}

#[test]
fn stiffness_of_a_spring_is_found_after_five_windows() {
    let mut detector = started(1e3);
    let mut found = None;
    for index in 105..3000_i32 {
        let x = STEP * f64::from(index);
        assert_eq!(sample(&mut detector, x, 1e3 * x), SlipVerdict::Holding);
        if let Some(stiffness) = detector.stiffness() {
            found = found.or(Some(x));
            // The displacement rounds at a tenth of a metre.
            assert!((stiffness - 1e3).abs() < 1e-6 * 1e3, "{stiffness}");
        }
    }
    // Four windows to the oldest place that tells a mean, and one beyond it.
    let found = found.unwrap();
    assert!((5.0 * WINDOW - STEP..5.5 * WINDOW).contains(&found), "{found}");
}

/// Over the window, a stiffness just below the share warns and one just above it does not; below a fifth it
/// is called slip.
#[test]
fn warning_and_slip_come_at_their_shares() {
    let at = 12.0 * WINDOW;
    let end = at + 1.5 * WINDOW;
    for (share, warns, slips) in [
        (0.66, false, false),
        (0.64, true, false),
        (0.21, true, false),
        (0.19, true, true),
        (-1.0, true, true),
    ] {
        for verdict in [SlipVerdict::Warning, SlipVerdict::Slipping] {
            let mut detector = started(1e3);
            let found = until(&mut detector, (START, end), knee(at, share), verdict);
            let wanted = if verdict == SlipVerdict::Warning { warns } else { slips };
            assert_eq!(found.is_some(), wanted, "{share} {verdict:?} {found:?}");
            assert!(found.is_none_or(|x| x > at), "{found:?}");
        }
    }
}

#[test]
fn verdicts_last_until_the_motion_turns() {
    let at = 12.0 * WINDOW;
    let mut detector = started(1e3);
    let end = until(&mut detector, (START, at + 2.0 * WINDOW), knee(at, 0.4), SlipVerdict::Warning).unwrap();
    let force = knee(at, 0.4)(end);
    // Stiff again, at rest, and back by less than a quarter of the window.
    for x in [1.0, 1.0, 0.8] {
        assert_eq!(sample(&mut detector, end + x * WINDOW, force + x * 1e3 * WINDOW), SlipVerdict::Warning);
    }
    assert!(detector.stiffness().is_some());
    // By more than that: turned.
    let (turn, force) = (end + WINDOW, force + 1e3 * WINDOW);
    assert_eq!(sample(&mut detector, turn - 0.3 * WINDOW, force - 0.3 * 2e3 * WINDOW), SlipVerdict::Holding);
    assert_eq!(detector.stiffness(), None);
    // The way back is judged from the turn: a spring of 2 kN/m.
    let mut x = 0.3 * WINDOW;
    while x < 7.0 * WINDOW {
        x += STEP;
        assert_eq!(sample(&mut detector, turn - x, force - 2e3 * x), SlipVerdict::Holding, "{x}");
    }
    let stiffness = detector.stiffness().unwrap();
    assert!((stiffness / 2e3 - 1.0).abs() < 1e-6, "{stiffness}");
}

/// A motion that turns twice within half a window starts anew at the second turn.
#[test]
fn a_second_turn_counts_as_the_first() {
    let mut detector = started(1e3);
    until(&mut detector, (START, 8.0 * WINDOW), |x| 1e3 * x, SlipVerdict::Warning);
    let turn = 7.7 * WINDOW;
    for x in [turn, turn + START] {
        assert_eq!(sample(&mut detector, x, 1e3 * x), SlipVerdict::Holding);
        assert_eq!(detector.stiffness(), None);
    }
    let mut x = turn + START;
    while detector.stiffness().is_none() {
        x += STEP;
        assert_eq!(sample(&mut detector, x, 1e3 * x), SlipVerdict::Holding);
        assert!(x < turn + 6.0 * WINDOW);
    }
    // Five windows on, but for what the first place lies beyond a quarter of one.
    assert!((x - turn - 5.0 * WINDOW).abs() < 0.1 * WINDOW, "{}", (x - turn) / WINDOW);
}

/// The mean stiffness falls as the patch lets go; what counts is the greatest.
#[test]
fn the_greatest_mean_stiffness_is_the_measure() {
    // 1 kN/m over ten windows, then 0.7 kN/m over fifty, then 0.64: below 0.65 of the first alone.
    let force = |x: f64| {
        let (first, second) = (10.0 * WINDOW, 60.0 * WINDOW);
        1e3 * (x.min(first) + 0.7 * (x.clamp(first, second) - first) + 0.64 * (x - second).max(0.0))
    };
    let mut detector = started(1e3);
    let warned = until(&mut detector, (START, 70.0 * WINDOW), force, SlipVerdict::Warning).unwrap();
    assert!((60.0 * WINDOW..62.0 * WINDOW).contains(&warned), "{warned}");
    assert!((detector.stiffness().unwrap() / 1e3 - 1.0).abs() < 1e-6);
}

/// At rest before the motion the force may relax, or grow: the last of it is where the spring starts.
#[test]
fn rest_before_the_motion_is_not_judged() {
    let mut detector = new();
    for index in 0..1000_i32 {
        let force = 5.0 - 5e-3 * f64::from(index);
        assert_eq!(sample(&mut detector, 0.1 * WINDOW * f64::from(index % 2), force), SlipVerdict::Holding);
    }
    sample(&mut detector, 0.0, 0.0);
    assert_eq!(until(&mut detector, (0.0, 8.0 * WINDOW), |x| 1e3 * x, SlipVerdict::Warning), None);
    // The last quarter of a window counts as rest, of the seven windows from which the mean is taken.
    let stiffness = detector.stiffness().unwrap();
    assert!((stiffness / 1e3 - (1.0 - 0.25 / 7.0)).abs() < 2e-3, "{stiffness}");
}

/// No force, or one along the motion, tells no stiffness, and nothing warns.
#[test]
fn without_stiffness_there_is_no_warning() {
    for force in [0.0, -1e3] {
        let mut detector = new();
        sample(&mut detector, 0.0, 0.0);
        let end = 20.0 * WINDOW;
        assert_eq!(until(&mut detector, (0.0, end), |x| force * x, SlipVerdict::Warning), None);
        assert_eq!(detector.stiffness(), None);
    }
}

#[test]
fn long_steps_are_judged_as_short_ones_are() {
    // One sample a window, one in three, and one in forty.
    for stride in [1.0, 3.0, 40.0] {
        let mut detector = new();
        let (mut x, mut warned) = (0.0, None);
        let at = 12.0 * stride * WINDOW;
        while x < 24.0 * stride * WINDOW {
            let verdict = sample(&mut detector, x, knee(at, 0.3)(x));
            if verdict == SlipVerdict::Warning {
                warned = warned.or(Some(x));
            }
            x += stride * WINDOW;
        }
        let warned = warned.unwrap();
        assert!(warned > at && warned < at + 5.5 * stride * WINDOW, "{stride}: {}", warned / at);
        assert!((detector.stiffness().unwrap() / 1e3 - 1.0).abs() < 1e-6);
    }
}

#[test]
fn an_open_contact_forgets_and_a_faulty_sample_does_not() {
    let mut detector = new();
    sample(&mut detector, 0.0, 0.0);
    until(&mut detector, (0.0, 8.0 * WINDOW), |x| 1e3 * x, SlipVerdict::Warning);
    let before = detector;
    let (good, place) = (ContactForce::new(2.0, Vector3::x(), 0.0), Vector3::zeros());
    for bad in [f64::NAN, f64::INFINITY] {
        for force in [
            ContactForce::new(bad, Vector3::x(), 0.0),
            ContactForce::new(2.0, Vector3::y() * bad, 0.0),
            ContactForce::new(2.0, Vector3::x(), bad),
        ] {
            assert_eq!(detector.update(&force, &place), SlipVerdict::NotPressing);
        }
        assert_eq!(detector.update(&good, &Vector3::new(0.0, 0.0, bad)), SlipVerdict::NotPressing);
    }
    assert_eq!(detector, before);
    // Ten deviations do not pass the gate, a little more does.
    let mut pressed = detector;
    let end = Vector3::new(0.1, 0.2, -0.1) + direction() * (8.0 * WINDOW);
    assert_eq!(
        pressed.update(&ContactForce::new(0.1 + 1e-9, Vector3::zeros(), 0.0), &end),
        SlipVerdict::Holding
    );
    assert!(pressed.stiffness().is_some());
    assert_eq!(
        detector.update(&ContactForce::new(0.1, Vector3::zeros(), 0.0), &end),
        SlipVerdict::NotPressing
    );
    assert_eq!(detector, new());
}

#[test]
fn limits_of_the_settings() {
    let gate = NormalForceGate::from_noise(&ForceNoise::isotropic(0.01).unwrap());
    for (window, share) in
        [(1e-6, 0.2), (1e-6, 1.0), (0.0, 0.5), (-1.0, 0.5), (1e-309, 0.5), (f64::INFINITY, 0.5)]
    {
        assert!(
            IncipientSlip::new(gate, window).and_then(|detector| detector.with_warning_share(share)).is_err(),
            "{window} {share}"
        );
    }
    assert!(
        IncipientSlip::new(gate, 1e-6).and_then(|detector| detector.with_warning_share(0.201)).is_ok()
            && IncipientSlip::new(gate, 1.0).and_then(|detector| detector.with_warning_share(0.999)).is_ok()
    );
    // Displacements at the ends of the range are taken without a panic.
    let mut detector = new();
    for x in [0.0, f64::MAX, -f64::MAX, 5e-324, 1e300, 0.0] {
        for y in [0.0, f64::MAX, 1e-300] {
            let force = ContactForce::new(f64::MAX, Vector3::new(y, f64::MAX, x), 0.0);
            assert_ne!(detector.update(&force, &Vector3::new(x, y, -x)), SlipVerdict::NotPressing);
            assert!(detector.stiffness().is_none_or(f64::is_finite));
        }
    }
}

/// Elastic ramps whose force grows by twenty times its noise over a window: as advised, noise alone does not warn.
#[test]
fn noise_of_a_twentieth_does_not_warn_on_a_spring() {
    let mut random = Pcg64Mcg::seed_from_u64(41);
    let mut warned = 0;
    for _ in 0..100 {
        let mut detector = started(1e3);
        let noise = 1e3 * WINDOW / 20.0;
        warned += u32::from((0..2000_u32).any(|index| {
            let x = START + 2e-8 * f64::from(index);
            let draw: f64 = StandardNormal.sample(&mut random);
            sample(&mut detector, x, 1e3 * x + noise * draw) != SlipVerdict::Holding
        }));
    }
    assert_eq!(warned, 0);
}
