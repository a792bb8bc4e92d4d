//! The session that `fingertip demo --hand` plays shows what is said of it.

use fingertip_simulation::hand::{GrippingSettings, HandSample, play_standard_hand};

const GRAVITY: f64 = 9.81;

/// A sample, and what was felt then: the upward part of the load \[N\], and the least normal force that was commanded.
type End = (HandSample<3>, f64, Option<f64>);

/// The last sample of each segment.
fn ends(seed: u64, settings: &GrippingSettings<3>) -> Vec<End> {
    let mut ends: Vec<End> = Vec::new();
    let mut samples = 0;
    play_standard_hand(seed, settings, &mut |sample, felt, _| {
        samples += 1;
        let least = felt.command.map(|command| command.normal.into_iter().fold(f64::INFINITY, f64::min));
        let end = (*sample, felt.load.force().z, least);
        match ends.last_mut() {
            Some(last) if last.0.phase == sample.phase => *last = end,
            _ => ends.push(end),
        }
    })
    .unwrap();
    // 8.5 s at 1 kHz, of which half a second is rest.
    assert_eq!(samples, 8000);
    ends
}

#[test]
fn the_hand_lifts_tilts_fills_sets_down_and_hands_over_a_jar() {
    let ends = ends(1, &GrippingSettings::default());
    assert!(ends.iter().map(|end| end.0.phase).eq(1..18));
    let of = |phase: usize| &ends[phase - 1];
    assert!((of(17).0.time - 8.5).abs() < 2e-3, "{}", of(17).0.time);
    let weighs = |phase: usize, mass: f64| {
        let (sample, felt, _) = of(phase);
        assert!((sample.truth.mass - mass).abs() < 1e-9 && sample.truth.table == 0.0, "{phase}: {sample:?}");
        assert!((felt + mass * GRAVITY).abs() < 0.05 * mass * GRAVITY, "{phase}: {felt} N");
    };
    // Gripped on the table, lifted, tilted by 0.4 rad and back.
    assert!(of(1).0.truth.table > 1.0);
    weighs(3, 0.2);
    let tilted = of(4).0.gravity.angle(&of(3).0.gravity);
    assert!((tilted - 0.4).abs() < 0.01, "{tilted} rad");
    weighs(6, 0.2);
    // Filled, pushed, put on the table, and lifted again.
    weighs(8, 0.3);
    weighs(10, 0.3);
    assert!(of(12).0.truth.table > 1.0);
    weighs(14, 0.3);
    // Another hand has it, and no finger touches it.
    let (last, felt, command) = of(17);
    assert!(last.open && last.truth.contacts.iter().all(Option::is_none) && command.is_none());
    assert!(felt.abs() < 0.1, "{felt} N");
}

/// Another seed is another hand, with sensors of its own; the settings are those that are given.
#[test]
fn the_session_is_played_with_its_seed_and_settings() {
    let firm = GrippingSettings { normal: (3.0, 20.0), ..GrippingSettings::default() };
    let (usual, firm) = (ends(1, &GrippingSettings::default()), ends(2, &firm));
    assert!(usual[2].2.is_some_and(|newton| (0.5..2.9).contains(&newton)), "{:?}", usual[2].2);
    assert!(firm[2].2.is_some_and(|newton| newton > 2.99), "{:?}", firm[2].2);
    assert_ne!(usual[2].0.raw, firm[2].0.raw);
    let never = GrippingSettings { reach: -1.0, ..GrippingSettings::default() };
    assert!(play_standard_hand(1, &never, &mut |_, _, _| panic!("it cannot reach")).is_err());
}
