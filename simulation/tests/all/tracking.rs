//! A contact that rolls to and fro on the simulated fingertip, followed: how far off, and how late.

use fingertip::contact::{ContactModel, Continuity, PointContact, Sighting, Tracker};
use fingertip::wrench::{Compensation, DummyGaugeAccumulator, GaussianElimination, WrenchSolver};
use fingertip_simulation::{Imperfections, Options, Script, SimulatedFingertip, SurfacePoint, ThermalDrift};
use nalgebra::{Matrix6, Vector3};

/// How well a contact was followed while it rolled.
#[derive(Debug)]
struct Followed {
    /// Medians of the distance from the true place, of single samples and of the track [m].
    single: f64,
    tracked: f64,
    /// Of the track without its mean error, which is that of tare and calibration [m].
    noise: f64,
    /// That mean error [m].
    systematic: f64,
    /// By how much the track comes late [s].
    delay: f64,
    /// New contacts behind the first, in the whole run.
    lost: usize,
}

fn median(errors: impl Iterator<Item = f64>) -> f64 {
    let mut errors: Vec<f64> = errors.collect();
    errors.sort_by(f64::total_cmp);
    errors[errors.len() / 2]
}

/// Rolls of 15° to and fro in several directions, each within 0.51 s: up to 10 mm/s, with a turn at each end.
fn script(force: f64) -> Script {
    let mut script =
        Script::default().rest(1.0).press(SurfacePoint::degrees(20.0, 0.0), force, 0.2).hold(0.3);
    for turn in [0.0, 70.0, 200.0] {
        script = script
            .roll(SurfacePoint::degrees(20.0, turn), 0.8)
            .roll(SurfacePoint::degrees(35.0, turn), 0.51)
            .roll(SurfacePoint::degrees(20.0, turn), 0.51)
            .roll(SurfacePoint::degrees(35.0, turn), 0.51)
            .roll(SurfacePoint::degrees(20.0, turn), 0.51);
    }
    script
}

fn followed(force: f64, options: Options, within: f64) -> Followed {
    let fingertip = SimulatedFingertip::new(&script(force), options).unwrap();
    let solver = GaussianElimination::new(fingertip.calibrated_matrix()).unwrap();
    let ball = fingertip.sphere();
    let rest: Vec<_> = fingertip.clone().take_while(|sample| sample.truth.phase == 0).collect();
    let mut accumulator = DummyGaugeAccumulator::default();
    for sample in &rest {
        assert!(accumulator.add(&sample.reading()));
    }
    let zero = accumulator.finish().unwrap();
    // The noise as the rest shows it.
    let mut noise = Matrix6::zeros();
    for sample in &rest {
        let wrench = solver.solve(&zero.compensate(&sample.reading())).components();
        noise += wrench * wrench.transpose() / rest.len() as f64;
    }
    let model = PointContact::new(force * 0.3).unwrap();
    let mut tracker = Tracker::new(0.01, within).unwrap();
    let (mut truth, mut track, mut single) = (Vec::new(), Vec::new(), Vec::new());
    let (mut last, mut lost) = (None, 0);
    for sample in fingertip {
        let wrench = solver.solve(&zero.compensate(&sample.reading()));
        let found = model.resolve_near(&wrench, &ball, last.as_ref());
        last = found.contact().map(|contact| contact.point);
        let sighting =
            found.contact().and_then(|contact| Sighting::of_point_contact(contact, &wrench, &noise));
        let tracked = tracker.follow(&ball, sighting.as_ref(), 1e-3);
        // Behind the press and the hold.
        if sample.truth.phase > 2
            && let (Some(contact), Some(tracked)) = (sample.truth.contact, tracked)
        {
            lost += usize::from(tracked.continuity == Continuity::New);
            single.extend(last.map(|point| (point - contact.point).norm()));
            truth.push(contact.point);
            track.push(tracked.point);
        }
    }
    let count = track.len();
    let mean = |delay: usize| -> Vector3<f64> {
        (delay..count).map(|k| track[k] - truth[k - delay]).sum::<Vector3<f64>>() / (count - delay) as f64
    };
    // That by which the true course has to be shifted to fit best.
    let misfit = |delay: usize| -> f64 {
        let mean = mean(delay);
        (delay..count).map(|k| (track[k] - truth[k - delay] - mean).norm_squared()).sum::<f64>()
            / (count - delay) as f64
    };
    let delay = (0..200).min_by(|a, b| misfit(*a).total_cmp(&misfit(*b))).unwrap();
    let systematic = mean(0);
    Followed {
        single: median(single.into_iter()),
        tracked: median((0..count).map(|k| (track[k] - truth[k]).norm())),
        noise: median((0..count).map(|k| (track[k] - truth[k] - systematic).norm())),
        systematic: systematic.norm(),
        delay: delay as f64 * 1e-3,
        lost,
    }
}

fn exact(seed: u64) -> Options {
    Options {
        seed,
        imperfections: Imperfections::none(),
        thermal_drift: ThermalDrift::none(),
        ..Options::default()
    }
}

fn as_built(seed: u64) -> Options {
    Options { seed, ..Options::default() }
}

#[test]
fn a_rolling_contact_is_followed_closer_than_a_sample() {
    let light = followed(0.1, exact(1), 0.1);
    assert!(light.tracked < 0.6e-3 && light.delay <= 0.040 && light.lost <= 2, "{light:?}");
    assert!(light.tracked < 0.4 * light.single, "{light:?}");
    let firm = followed(1.0, exact(1), 0.1);
    assert!(firm.tracked < 0.12e-3 && firm.delay <= 0.015 && firm.lost <= 2, "{firm:?}");
}

/// The median over the sensors, with their flaws and the errors of their calibration, and without.
#[test]
#[ignore = "180 runs of nine seconds each take a while"]
fn rolling_contacts_on_many_sensors() {
    for force in [0.1, 1.0] {
        for within in [0.03, 0.1, 0.3] {
            for (name, options) in [("exact", exact as fn(u64) -> Options), ("as built", as_built)] {
                let runs: Vec<Followed> =
                    (0..15).map(|seed| followed(force, options(100 + seed), within)).collect();
                let of = |part: fn(&Followed) -> f64| median(runs.iter().map(part));
                println!(
                    "{force} N, turns within {within} s, {name}: sample {:.3} mm, track {:.3} mm, of which noise {:.3} and \
                     systematic {:.3} mm; {:.0} ms late; {} lost",
                    of(|run| run.single) * 1e3,
                    of(|run| run.tracked) * 1e3,
                    of(|run| run.noise) * 1e3,
                    of(|run| run.systematic) * 1e3,
                    of(|run| run.delay) * 1e3,
                    runs.iter().map(|run| run.lost).sum::<usize>(),
                );
                let (most, latest) = if force < 0.5 { (0.6e-3, 0.040) } else { (0.12e-3, 0.015) };
                assert!(
                    of(|run| run.tracked) <= most && of(|run| run.delay) <= latest,
                    "{force} {within} {name}"
                );
            }
        }
    }
}
