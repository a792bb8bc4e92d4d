//! What the simulated sensor reads, and what the score says of it, is held to seven digits.
//!
//! Sines and exponentials are the system's and may differ in their last bit; seven digits do not see that.

use core::f64::consts::TAU;

use fingertip_simulation::hand::standard_hand;
use fingertip_simulation::{
    Electronics, Imperfections, Options, Script, SessionScore, SimulatedFingertip, SimulatedSample,
    SurfacePoint, ThermalDrift, standard_session,
};
use fingertip_test_support::Unchanged;
use fingertip_wrench::Wrench;
use nalgebra::Vector3;

/// Sensors with no flaw, with those that are usual, and with great ones.
fn options() -> Vec<(&'static str, Options)> {
    let flawless = Options {
        imperfections: Imperfections::none(),
        thermal_drift: ThermalDrift::none(),
        ..Options::default()
    };
    let great = Options {
        sample_rate: 400.0,
        seed: 5,
        electronics: Electronics {
            excitation: 3.3,
            amplification: 900.0,
            offset: 1.7,
            input_noise: 4e-6,
            bits: 20,
            conversions: 3,
            dummy_averaging: 0.02,
            converter_range: 3.5,
            ..Electronics::default()
        },
        thermal_drift: ThermalDrift {
            warming: 9.0,
            time_constant: 0.7,
            random_walk: 0.3,
            apparent_strain: 5e-6,
            spread: 0.3,
            offset_drift: 2e-6,
        },
        imperfections: Imperfections {
            axial_placement: 0.4e-3,
            circumferential_placement: 0.1,
            angle: 0.1,
            gain: 0.05,
            unbalance: 200e-6,
            calibration_scale: 0.1,
            calibration_entry: 0.02,
        },
        ..Options::default()
    };
    let unaveraged = Options {
        electronics: Electronics { dummy_averaging: 0.0, conversions: 1, ..Electronics::default() },
        ..flawless
    };
    vec![
        ("no flaws", flawless),
        ("the usual flaws", Options { seed: 3, ..Options::default() }),
        ("great flaws", great),
        ("no averages", unaveraged),
    ]
}

fn script() -> Script {
    Script::default()
        .rest(0.08)
        .press(SurfacePoint::degrees(30.0, 50.0), 5.0, 0.05)
        .hold(0.03)
        .squeeze(9.0, 0.05)
        .roll(SurfacePoint::degrees(80.0, 300.0), 0.1)
        .drag(0.7, (0.6, 0.4), 0.06, 0.04)
        .hold(0.02)
        .release(0.03)
        .rest(0.02)
        .press(SurfacePoint::degrees(100.0, 200.0), 0.5, 0.05)
        .hold(0.03)
        .release(0.02)
}

fn of_sample(sample: &SimulatedSample) -> String {
    let contact = sample.truth.contact.map(|contact| {
        let [point, normal, force] =
            [contact.point, contact.normal, contact.force].map(|vector| vector.map(|x| format!("{x:.6e}")));
        format!("{point:?} {normal:?} {force:?}")
    });
    let raw = sample.raw.map(|volts| format!("{volts:.6e}"));
    let truth = &sample.truth;
    format!(
        "Sample {:.6e} {raw:?} {contact:?} {:.6e} {} {} {}",
        sample.time, truth.temperature, truth.slipping, truth.phase, truth.saturated
    )
}

#[test]
fn what_is_read_and_what_was_so_stay_as_they_are() {
    let mut unchanged = Unchanged::new(env!("CARGO_MANIFEST_DIR"), "tests/unchanged/samples.txt");
    for (name, options) in options() {
        let fingertip = SimulatedFingertip::new(&script(), options).unwrap();
        let matrices = [fingertip.nominal_matrix(), fingertip.true_matrix(), fingertip.calibrated_matrix()];
        let entries: Vec<String> = matrices
            .iter()
            .flat_map(|matrix| matrix.normalised().iter().map(|x| format!("{x:.6e}")))
            .collect();
        unchanged.note(&format!("{name}: matrices"), entries);
        unchanged.note(
            &format!("{name}: phases"),
            fingertip
                .phases()
                .iter()
                .map(|phase| format!("{:?} {:.6e} {:.6e}", phase.segment, phase.start, phase.end)),
        );
        unchanged.note(&format!("{name}: samples"), fingertip.map(|sample| of_sample(&sample)));
    }
    // Figures of the sessions that are shown and quoted are compared from one version to the next.
    let session = SimulatedFingertip::new(&standard_session(), options().swap_remove(0).1).unwrap();
    let phase = |segment: &dyn core::fmt::Debug, start: f64| format!("{segment:?} {start:.6e}");
    unchanged.note("standard session", session.phases().iter().map(|of| phase(&of.segment, of.start)));
    let hand = standard_hand(1).unwrap();
    unchanged.note("standard hand", hand.phases().map(|(segment, start)| phase(&segment, start)));
    // Gentle and great overloads: ends of the range.
    let (_, flawless) = options().swap_remove(0);
    let mut hard = Script::default();
    for k in 0..8 {
        let at = SurfacePoint::degrees(12.0 * f64::from(k), 70.0 * f64::from(k));
        hard = hard.press(at, 20.0 * f64::from(k + 1), 0.02).hold(0.01).release(0.01);
    }
    let samples = SimulatedFingertip::new(&hard, flawless).unwrap();
    unchanged.note("overload", samples.map(|sample| of_sample(&sample)));
    unchanged.check();
}

/// Wrenches and points with errors that depend on time, some points lost, slips called too soon, late and in vain.
#[test]
fn what_is_scored_stays_as_it_is() {
    let mut unchanged = Unchanged::new(env!("CARGO_MANIFEST_DIR"), "tests/unchanged/scores.txt");
    for (name, script) in [("short", script()), ("standard", standard_session())] {
        let fingertip = SimulatedFingertip::new(&script, Options::default()).unwrap();
        let mut score = SessionScore::new(&fingertip);
        for (i, sample) in fingertip.enumerate() {
            let at = sample.time * TAU;
            let error = Vector3::new((3.0 * at).sin(), (5.0 * at).cos(), (7.0 * at).sin());
            let load = sample.truth.wrench;
            let wrench =
                Wrench::on_fingertip(load.force() * (1.0 + 0.01 * error.x), load.torque() + error * 1e-5);
            let point =
                sample.truth.contact.filter(|_| i % 5 != 0).map(|contact| contact.point + error * 1e-4);
            let called = i % 97 == 0 || (sample.truth.slipping && i % 7 == 0);
            score.add(&sample, &wrench, point.as_ref(), called);
        }
        let report = score.report();
        let of_press = report.presses.iter().map(|press| {
            let (point, position) = (press.point, press.position_error.unwrap_or(-1.0));
            let numbers = [
                point.x,
                point.y,
                point.z,
                press.force,
                press.force_error,
                position,
                press.sample_force_error,
                press.sample_position_error,
                press.greatest_position_error,
            ];
            format!(
                "{} {:?} {} {}",
                press.phase,
                numbers.map(|x| format!("{x:.6e}")),
                press.samples,
                press.resolved
            )
        });
        unchanged.note(&format!("{name}: presses"), of_press);
        let of_level = report.levels().into_iter().map(|level| {
            let numbers = [
                level.force,
                level.mean_force_error,
                level.mean_position_error,
                level.greatest_position_error,
                level.sample_position_error,
                level.resolved,
            ];
            format!("{} {:?}", level.presses, numbers.map(|x| format!("{x:.6e}")))
        });
        unchanged.note(&format!("{name}: levels"), of_level);
        let of_slip = |slip: &fingertip_simulation::SlipScore| {
            format!("{:.6e} {:?}", slip.onset, slip.delay.map(|delay| format!("{delay:.6e}")))
        };
        unchanged.note(&format!("{name}: slips"), report.slips.iter().map(of_slip));
        unchanged.note(&format!("{name}: alarms"), report.false_alarms.iter().map(|at| format!("{at:.6e}")));
    }
    unchanged.check();
}
