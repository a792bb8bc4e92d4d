//! The simulated fingertip keeps to its script, and says the truth about it.

use fingertip_drivers::Source;
use fingertip_simulation::{
    Options, Script, ScriptProblem, Segment, SessionScore, SimulatedFingertip, SimulationError, SurfacePoint,
    standard_session,
};
use fingertip_wrench::Wrench;
use nalgebra::Vector3;
use proptest::prelude::*;

fn made(script: &Script, seed: u64) -> SimulatedFingertip {
    SimulatedFingertip::new(script, Options { seed, ..Options::default() }).unwrap()
}

/// A sound script of presses, rolls, squeezes and drags.
fn script() -> impl Strategy<Value = Script> {
    let point =
        || (0.0_f64..145.0, -180.0_f64..180.0).prop_map(|(top, turn)| SurfacePoint::degrees(top, turn));
    let duration = || 0.02_f64..0.2;
    let act = prop_oneof![
        duration().prop_map(|duration| Segment::Hold { duration }),
        (0.1_f64..30.0, duration()).prop_map(|(force, duration)| Segment::Squeeze { force, duration }),
        (point(), duration()).prop_map(|(to, duration)| Segment::Roll { to, duration }),
    ];
    let drag = (-4.0_f64..4.0, 0.2_f64..1.0, 0.3_f64..1.0, duration(), duration());
    let drag = drag.prop_map(|(heading, static_coefficient, share, ramp, slide)| Segment::Drag {
        heading,
        static_coefficient,
        kinetic_coefficient: static_coefficient * share,
        ramp,
        slide,
    });
    let grasp = (
        point(),
        0.1_f64..30.0,
        duration(),
        prop::collection::vec(act, 0..3),
        prop::option::of(drag),
        duration(),
    );
    prop::collection::vec(grasp, 1..4).prop_map(|grasps| {
        let mut script = Script::default().rest(0.05);
        for (at, force, duration, acts, drag, release) in grasps {
            script = acts.into_iter().chain(drag).fold(script.press(at, force, duration), Script::then);
            script = script.release(release).rest(0.01);
        }
        script
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn the_truth_is_consistent(script in script(), seed in any::<u64>()) {
        let fingertip = made(&script, seed);
        let radius = fingertip.options().design.sphere_radius;
        let (phases, onsets) = (fingertip.phases().to_vec(), fingertip.slip_onsets().to_vec());
        let expected = (fingertip.duration() * 1000.0).ceil() as usize;
        let mut count = 0;
        let mut last = Wrench::zero();
        for sample in fingertip {
            let phase = &phases[sample.truth.phase];
            prop_assert!(phase.start <= sample.time && sample.time < phase.end);
            count += 1;
            if let Some(contact) = sample.truth.contact {
                prop_assert!((contact.point.norm() / radius - 1.0).abs() < 1e-14);
                prop_assert!((contact.point / radius - contact.normal).norm() < 1e-14);
                let force = contact.contact_force();
                prop_assert!(force.normal > 0.0);
                prop_assert!(force.tangential.dot(&contact.normal).abs() < 1e-12 * contact.force.norm());
                prop_assert_eq!(sample.truth.wrench, contact.wrench());
                // A pure force: no pitch.
                let (f, m) = (sample.truth.wrench.force(), sample.truth.wrench.torque());
                prop_assert!(f.dot(&m).abs() < 1e-14 * f.norm_squared());
                if let Segment::Drag { static_coefficient, kinetic_coefficient, .. } = phase.segment {
                    let ratio = force.friction_ratio().unwrap();
                    if sample.truth.slipping {
                        prop_assert!(ratio >= kinetic_coefficient - 1e-12 && ratio <= static_coefficient + 1e-12);
                    }
                }
            } else {
                prop_assert_eq!(sample.truth.wrench, Wrench::zero());
            }
            // It slips from each onset to the end of its drag, and at no other time.
            let slips = matches!(phase.segment, Segment::Drag { .. })
                && onsets.iter().any(|onset| phase.start <= *onset && *onset <= sample.time);
            prop_assert_eq!(sample.truth.slipping, slips);
            // Nothing jumps: the fastest thing is the break-away, 30 N in 3 ms.
            prop_assert!((sample.truth.wrench.force() - last.force()).norm() < 12.0);
            last = sample.truth.wrench;
        }
        prop_assert!(count == expected || count + 1 == expected || count == expected + 1, "{} {}", count, expected);
    }
}

#[test]
fn the_same_seed_gives_the_same_samples_and_another_one_others() {
    let script = Script::default().rest(0.05).press(SurfacePoint::TOP, 3.0, 0.05).release(0.05);
    let samples = |seed| made(&script, seed).collect::<Vec<_>>();
    assert_eq!(samples(7), samples(7));
    assert_ne!(samples(7), samples(8));
    // As a source it gives the same numbers, and then ends for good.
    let mut source = made(&script, 7);
    for expected in samples(7) {
        let sample = source.next_sample().unwrap().unwrap();
        assert_eq!((sample.time, sample.value), (Some(expected.time), expected.raw));
    }
    assert!(source.next_sample().unwrap().is_none() && source.next_sample().unwrap().is_none());
}

#[test]
fn an_overload_saturates_the_converter_and_is_told() {
    let script = Script::default().press(SurfacePoint::degrees(90.0, 0.0), 200.0, 0.1).hold(0.1);
    let fingertip = made(&script, 1);
    let range = fingertip.options().electronics.converter_range;
    let samples: Vec<_> = fingertip.collect();
    assert!(!samples[0].truth.saturated && samples[199].truth.saturated);
    assert!(samples.iter().all(|sample| sample.raw.iter().all(|volts| (0.0..=range).contains(volts))));
}

#[test]
fn a_script_that_cannot_be_played_says_which_segment_and_why() {
    let (at, rest) = (SurfacePoint::TOP, Script::default().rest(1.0));
    let pressed = rest.clone().press(at, 1.0, 0.1);
    let opening = SurfacePoint::degrees(150.0, 0.0);
    use ScriptProblem::*;
    for (script, segment, problem) in [
        (rest.clone().hold(1.0), 2, NotInContact),
        (rest.clone().release(1.0), 2, NotInContact),
        (rest.clone().drag(0.0, (0.5, 0.4), 1.0, 1.0), 2, NotInContact),
        (rest.clone().rest(0.0), 2, BadDuration),
        (rest.clone().rest(f64::NAN), 2, BadDuration),
        (rest.clone().press(at, 0.0, 1.0), 2, BadForce),
        (rest.clone().press(at, f64::INFINITY, 1.0), 2, BadForce),
        (rest.clone().press(opening, 1.0, 1.0), 2, NotOnActiveSurface),
        (rest.press(SurfacePoint::degrees(f64::NAN, 0.0), 1.0, 1.0), 2, BadAngle),
        (pressed.clone().rest(1.0), 3, AlreadyInContact),
        (pressed.clone().press(at, 1.0, 1.0), 3, AlreadyInContact),
        (pressed.clone().roll(opening, 1.0), 3, NotOnActiveSurface),
        (pressed.clone().squeeze(-1.0, 1.0), 3, BadForce),
        (pressed.clone().drag(0.0, (0.4, 0.5), 1.0, 1.0), 3, BadFriction),
        (pressed.clone().drag(0.0, (0.4, 0.0), 1.0, 1.0), 3, BadFriction),
        (pressed.clone().drag(f64::NAN, (0.5, 0.4), 1.0, 1.0), 3, BadAngle),
        (pressed.clone().drag(0.0, (0.5, 0.4), -1.0, 2.0), 3, BadDuration),
        (pressed.release(0.1).release(0.1), 4, NotInContact),
    ] {
        let error = SimulatedFingertip::new(&script, Options::default()).unwrap_err();
        assert_eq!(error, SimulationError::Script { segment, problem });
    }
}

#[test]
fn parameters_out_of_range_are_refused() {
    let refused = |change: &dyn Fn(&mut Options)| {
        let mut options = Options::default();
        change(&mut options);
        SimulatedFingertip::new(&standard_session(), options).is_err()
    };
    assert!(!refused(&|_| {}));
    let bad: [&dyn Fn(&mut Options); 31] = [
        &|options| options.sample_rate = 0.0,
        &|options| options.sample_rate = f64::INFINITY,
        &|options| options.design.sphere_radius = f64::NAN,
        &|options| options.design.beam.thickness = 0.0,
        &|options| options.design.gauges[4].z = f64::NAN,
        &|options| options.design.force_range = -1.0,
        &|options| options.electronics.gauge_factor = 0.0,
        &|options| options.electronics.excitation = -1.0,
        &|options| options.electronics.amplification = f64::NAN,
        &|options| options.electronics.converter_range = 0.0,
        &|options| options.electronics.offset = -0.1,
        &|options| options.electronics.input_noise = f64::NAN,
        &|options| options.electronics.dummy_averaging = -1.0,
        &|options| options.electronics.bits = 0,
        &|options| options.electronics.bits = 25,
        &|options| options.electronics.conversions = 0,
        &|options| options.thermal_drift.time_constant = 0.0,
        &|options| options.thermal_drift.random_walk = -1e-3,
        &|options| options.thermal_drift.spread = f64::INFINITY,
        &|options| options.thermal_drift.offset_drift = f64::NAN,
        &|options| options.thermal_drift.warming = f64::NAN,
        &|options| options.thermal_drift.warming = f64::INFINITY,
        &|options| options.thermal_drift.apparent_strain = f64::NAN,
        &|options| options.thermal_drift.apparent_strain = f64::NEG_INFINITY,
        &|options| options.imperfections.axial_placement = -1e-3,
        &|options| options.imperfections.circumferential_placement = f64::NAN,
        &|options| options.imperfections.angle = -0.1,
        &|options| options.imperfections.gain = -0.1,
        &|options| options.imperfections.unbalance = f64::INFINITY,
        &|options| options.imperfections.calibration_scale = -0.1,
        &|options| options.imperfections.calibration_entry = f64::NAN,
    ];
    for (index, change) in bad.iter().enumerate() {
        assert!(refused(change), "bad option {index} is accepted");
    }
}

#[test]
fn the_score_knows_perfect_late_and_false() {
    let script = Script::default()
        .rest(0.1)
        .press(SurfacePoint::degrees(40.0, 0.0), 2.0, 0.1)
        .hold(0.1)
        .drag(0.0, (0.5, 0.3), 0.2, 0.1)
        .release(0.1);
    let scored = |call_at: f64, offset: f64| {
        let fingertip = made(&script, 1);
        let mut score = SessionScore::new(&fingertip);
        for sample in fingertip {
            let wrench = sample.truth.wrench;
            let shifted =
                Wrench::on_fingertip(wrench.force() * (1.0 + offset), wrench.torque() * (1.0 + offset));
            let point =
                sample.truth.contact.map(|contact| contact.point + Vector3::new(0.0, 0.0, offset * 1e-3));
            score.add(&sample, &shifted, point.as_ref(), (sample.time - call_at).abs() < 1e-9);
        }
        score.report()
    };
    let perfect = scored(0.505, 0.0);
    assert_eq!((perfect.presses.len(), perfect.slips.len(), perfect.slips_found()), (1, 1, 1));
    assert!((perfect.slips[0].delay.unwrap() - 0.005).abs() < 1e-9);
    assert!(perfect.false_alarms.is_empty());
    let press = perfect.presses[0];
    assert!(press.force_error < 1e-14 && press.position_error.unwrap() < 1e-15);
    // One more or less for the rounding of the times.
    assert!((99..=101).contains(&press.samples) && press.resolved == press.samples);

    let off = scored(0.53, 0.01);
    // Late by more than 20 ms: missed; but it was sliding, so not false either.
    assert_eq!((off.slips_found(), off.false_alarms.len()), (0, 0));
    let press = off.presses[0];
    assert!((press.force_error - 0.01).abs() < 1e-12 && (press.sample_force_error - 0.01).abs() < 1e-12);
    // A wrench that is too large as a whole has its contact in the right place.
    assert!(press.position_error.unwrap() < 1e-15);
    assert!((press.sample_position_error - 1e-5).abs() < 1e-15);

    let early = scored(0.45, 0.0);
    assert_eq!((early.slips_found(), early.false_alarms.len()), (0, 1));
}

/// A hold behind a drag, under a tangential force, is no press; one beside it, without, is.
#[test]
fn a_hold_after_a_drag_is_no_press() {
    let at = SurfacePoint::degrees(40.0, 0.0);
    let script = Script::default()
        .press(at, 2.0, 0.1)
        .hold(0.1)
        .drag(0.0, (0.5, 0.3), 0.2, 0.1)
        .hold(0.2)
        .release(0.1)
        .press(at, 5.0, 0.1)
        .hold(0.1)
        .release(0.1);
    let fingertip = made(&script, 1);
    let mut score = SessionScore::new(&fingertip);
    for sample in fingertip {
        let point = sample.truth.contact.map(|contact| contact.point);
        score.add(&sample, &sample.truth.wrench, point.as_ref(), false);
    }
    let forces: Vec<f64> = score.report().presses.iter().map(|press| press.force).collect();
    assert_eq!(forces.len(), 2, "{forces:?}");
    assert!((forces[0] - 2.0).abs() < 1e-9 && (forces[1] - 5.0).abs() < 1e-9, "{forces:?}");
}

/// The standard session is what it says it is: its length, and a roll that goes down to the equator without slip.
#[test]
fn the_standard_session_shows_everything() {
    let session = SimulatedFingertip::new(&standard_session(), Options::default()).unwrap();
    assert!((session.duration() - 26.4).abs() < 1e-9, "{}", session.duration());
    let radius = session.clone().find_map(|sample| sample.truth.contact).unwrap().point.norm();
    // How far from the top, which is on the x axis, contacts of 3 N are: between the presses and the drags.
    let rolled: Vec<f64> = session
        .filter(|sample| !sample.truth.slipping)
        .filter_map(|sample| sample.truth.contact)
        .filter(|contact| (contact.contact_force().normal - 3.0).abs() < 1e-9)
        .map(|contact| (contact.point.x / radius).acos().to_degrees())
        .collect();
    let (least, most) =
        rolled.iter().fold((f64::MAX, f64::MIN), |(low, high), x| (low.min(*x), high.max(*x)));
    assert!((least - 15.0).abs() < 0.1 && (most - 85.0).abs() < 0.1, "{least} {most}");
}

#[test]
fn presses_of_one_force_are_one_level() {
    let at = SurfacePoint::degrees(30.0, 0.0);
    let press = |script: Script, force| script.press(at, force, 0.1).hold(0.1).release(0.1);
    // Nearer to each other than a millionth, and further.
    let script = [20.0, 0.1, 20.000_01, 20.000_1].into_iter().fold(Script::default(), press);
    let fingertip = made(&script, 1);
    let mut score = SessionScore::new(&fingertip);
    // Every other sample is found, 1 µm off at 0.1 N and 3 µm at the others; all wrenches are 1 % too large.
    for (number, sample) in fingertip.enumerate() {
        let contact = sample.truth.contact;
        let off = |force: f64| if force < 1.0 { 1e-6 } else { 3e-6 };
        let point = contact.map(|contact| contact.point + Vector3::new(0.0, off(contact.force.norm()), 0.0));
        let point = point.filter(|_| number % 2 == 0);
        score.add(&sample, &(sample.truth.wrench * 1.01), point.as_ref(), false);
    }
    let report = score.report();
    let levels = report.levels();
    let presses: Vec<(f64, usize)> =
        levels.iter().map(|level| ((level.force * 1e6).round() / 1e6, level.presses)).collect();
    assert_eq!(presses, [(0.1, 1), (20.0, 2), (20.0001, 1)]);
    for (level, off) in levels.iter().zip([1e-6, 3e-6, 3e-6]) {
        assert!((level.mean_force_error - 0.01).abs() < 1e-12);
        assert!(level.mean_position_error < 1e-15 && level.greatest_position_error < 1e-15);
        assert!((level.sample_position_error - off).abs() < 1e-12 && (level.resolved - 0.5).abs() < 0.01);
    }
    for press in &report.presses {
        assert!((press.greatest_position_error - press.sample_position_error).abs() < 1e-12);
        assert!(press.resolved < press.samples && press.resolved >= press.samples / 2);
    }
}

#[cfg(feature = "serde")]
#[test]
fn a_script_is_written_and_read() {
    let script = standard_session();
    let text = toml::to_string(&script).unwrap();
    assert!(text.contains("do = \"press\""), "{text}");
    assert_eq!(toml::from_str::<Script>(&text).unwrap(), script);
}
