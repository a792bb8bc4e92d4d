//! The load of the simulated fingertip at chosen times, against numbers worked out by hand.

use core::f64::consts::E;

use fingertip_simulation::{
    Imperfections, Options, Script, SimulatedFingertip, SimulatedSample, SurfacePoint, ThermalDrift,
};
use fingertip_wrench::gauge_layout::GaugeLayout;
use nalgebra::Vector3;

/// A sensor without flaws, noise or warming, and a converter of 24 bits.
fn flawless() -> Options {
    let mut options = Options {
        imperfections: Imperfections::none(),
        thermal_drift: ThermalDrift::none(),
        ..Options::default()
    };
    options.electronics.input_noise = 0.0;
    options.electronics.bits = 24;
    options
}

fn played(script: &Script) -> (SimulatedFingertip, Vec<SimulatedSample>) {
    let fingertip = SimulatedFingertip::new(script, flawless()).unwrap();
    (fingertip.clone(), fingertip.collect())
}

fn is(found: Vector3<f64>, expected: Vector3<f64>) {
    // A few roundings of forces of some newtons.
    assert!((found - expected).norm() < 1e-12, "{found} is not {expected}");
}

fn force(sample: &SimulatedSample) -> Vector3<f64> {
    sample.truth.contact.unwrap().force
}

/// 60° from the top at azimuth 30°.
fn first() -> (SurfacePoint, Vector3<f64>) {
    let half = 3_f64.sqrt() / 2.0;
    (SurfacePoint::degrees(60.0, 30.0), Vector3::new(0.5, half * half, half * 0.5))
}

/// 90° from the top at azimuth 120°: the direction, and those along the meridian and across it.
fn second() -> (SurfacePoint, [Vector3<f64>; 3]) {
    let half = 3_f64.sqrt() / 2.0;
    let directions = [Vector3::new(0.0, -0.5, half), -Vector3::x(), Vector3::new(0.0, -half, -0.5)];
    (SurfacePoint::degrees(90.0, 120.0), directions)
}

/// 3u² − 2u³ at a quarter, a half and three quarters.
const SMOOTH: [f64; 3] = [0.156_25, 0.5, 0.843_75];

#[test]
fn forces_follow_the_script() {
    let ((a, at_a), (b, [at_b, along, across])) = (first(), second());
    let script = Script::default()
        .rest(0.1)
        .press(a, 4.0, 0.1)
        .hold(0.1)
        .squeeze(6.0, 0.1)
        .roll(b, 0.2)
        .drag(0.7, (0.5, 0.3), 0.2, 0.1)
        .release(0.1)
        .rest(0.1);
    let (fingertip, samples) = played(&script);
    assert!((fingertip.duration() - 1.1).abs() < 1e-12);
    assert!((1100..=1101).contains(&samples.len()));
    assert!(samples.iter().enumerate().all(|(number, sample)| sample.time == number as f64 / 1000.0));
    let starts: Vec<i32> =
        fingertip.phases().iter().map(|phase| (phase.start * 1e3).round() as i32).collect();
    assert_eq!(starts, [0, 100, 200, 300, 400, 600, 900, 1000]);
    assert!((fingertip.slip_onsets()[0] - 0.8).abs() < 1e-12 && fingertip.slip_onsets().len() == 1);
    assert!(samples[50].truth.contact.is_none() && samples[1050].truth.contact.is_none());
    let quarters = [0.25, 0.5, 0.75].into_iter().zip(SMOOTH);
    for (share, smooth) in quarters {
        let number = |start: f64, duration: f64| (start + share * duration).round() as usize;
        is(force(&samples[number(100.0, 100.0)]), at_a * (-4.0 * smooth));
        is(force(&samples[number(200.0, 100.0)]), at_a * -4.0);
        is(force(&samples[number(300.0, 100.0)]), at_a * -(4.0 + 2.0 * smooth));
        // On the great circle, its angle from the beginning that share of the whole one.
        let rolling = samples[number(400.0, 200.0)].truth.contact.unwrap();
        let angle = at_a.angle(&at_b);
        let turned = at_a * (((1.0 - smooth) * angle).sin() / angle.sin())
            + at_b * ((smooth * angle).sin() / angle.sin());
        is(rolling.normal, turned);
        is(rolling.force, turned * -6.0);
        is(rolling.point, turned * 13e-3);
        // In proportion: what was kept of the sliding is 0.3 of the pressing.
        let pull = along * 0.7_f64.cos() + across * 0.7_f64.sin();
        is(force(&samples[number(900.0, 100.0)]), (at_b * -6.0 + pull * 1.8) * (1.0 - smooth));
        // Linearly up to half of the pressing.
        is(force(&samples[number(600.0, 200.0)]), at_b * -6.0 + pull * (3.0 * share));
        assert!(!samples[number(600.0, 200.0)].truth.slipping);
    }
    // 3 ms behind the onset a part of 1/e of the fall is left; a tenth of a second behind it nothing.
    let pull = along * 0.7_f64.cos() + across * 0.7_f64.sin();
    is(force(&samples[803]), at_b * -6.0 + pull * (6.0 * (0.3 + 0.2 / E)));
    is(force(&samples[895]), at_b * -6.0 + pull * (6.0 * (0.3 + 0.2 * (-95.0_f64 / 3.0).exp())));
    assert!(samples[803].truth.slipping && samples[895].truth.slipping && !samples[905].truth.slipping);
    assert_eq!(samples[350].truth.phase, 3);
}

#[test]
fn a_pull_goes_on_from_the_one_before() {
    let (b, [at_b, along, across]) = second();
    let script = Script::default().press(b, 2.0, 0.1).drag(0.0, (0.5, 0.4), 0.1, 0.1).squeeze(4.0, 0.1).drag(
        core::f64::consts::FRAC_PI_2,
        (0.6, 0.3),
        0.1,
        0.1,
    );
    let (_, samples) = played(&script);
    // The tangential force stays while the grip grows, then it turns to the new direction in a straight line.
    let kept = along * (2.0 * (0.4 + 0.1 * (-100.0_f64 / 3.0).exp()));
    is(force(&samples[350]), at_b * -3.0 + kept);
    is(force(&samples[450]), at_b * -4.0 + kept * 0.5 + across * 1.2);
    is(force(&samples[503]), at_b * -4.0 + across * (4.0 * (0.3 + 0.3 / E)));
}

#[test]
fn an_object_rolls_with_its_tangential_force_and_half_way_round() {
    // Along the meridian: the force along it stays so.
    let top = SurfacePoint::TOP;
    let script = Script::default()
        .press(top, 2.0, 0.1)
        .drag(0.0, (0.5, 0.4), 0.1, 0.1)
        .roll(SurfacePoint::degrees(90.0, 0.0), 0.2)
        .hold(0.1);
    let (_, samples) = played(&script);
    let pull = 2.0 * (0.4 + 0.1 * (-100.0_f64 / 3.0).exp());
    let pulled = 2.0 * (0.4 + 0.1 * (-50.0_f64 / 3.0).exp());
    is(force(&samples[250]), Vector3::new(-2.0, pulled, 0.0));
    is(force(&samples[550]), Vector3::new(-pull, -2.0, 0.0));
    let (sin, cos) = (core::f64::consts::FRAC_PI_4.sin(), core::f64::consts::FRAC_PI_4.cos());
    is(force(&samples[400]), Vector3::new(cos, sin, 0.0) * -2.0 + Vector3::new(-sin, cos, 0.0) * pull);
    // Between opposite points it takes the meridian of the first.
    let (from, to) = (SurfacePoint::degrees(90.0, 0.0), SurfacePoint::degrees(90.0, 180.0));
    let (_, samples) = played(&Script::default().press(from, 1.0, 0.1).roll(to, 0.2));
    is(samples[200].truth.contact.unwrap().normal, -Vector3::x());
}

#[test]
fn the_channels_are_the_bridges_of_the_strains() {
    let (a, _) = first();
    let script = Script::default().rest(0.05).press(a, 20.0, 0.05).hold(0.05);
    let (fingertip, samples) = played(&script);
    let design = fingertip.options().design;
    let strains = GaugeLayout::new(&design.beam, design.gauges).unwrap().strain_matrix();
    // Half a step of 24 bits over 5 V, and roundings.
    let tolerance = 0.5 * 5.0 / 16_777_216.0 + 1e-12;
    for sample in &samples {
        assert!((sample.raw[6] - 2.5).abs() <= tolerance);
        let strains = strains * sample.truth.wrench.components();
        for channel in 0..6 {
            let change = 2.0 * strains[channel];
            // Amplification 2000, excitation 5 V: a quarter bridge.
            let volts = 2.5 + 2000.0 * 5.0 * change / (4.0 + 2.0 * change);
            assert!((sample.raw[channel] - volts).abs() <= tolerance, "{}", sample.time);
        }
        assert_eq!(sample.truth.temperature, 0.0);
    }
}
