//! The simulated prototype through the whole pipeline reproduces the paper's figures.
#![cfg(feature = "simulation")]

use fingertip::Fingertip;
use fingertip::friction::{Coulomb, DropDetector, ForceNoise, SlipVerdict};
use fingertip::surfaces::PointContact;
use fingertip::wrench::{Compensation, DummyGauge, DummyGaugeAccumulator, GaussianElimination, WrenchSolver};
use fingertip_drivers::simulation::{
    Options, SessionReport, SessionScore, SimulatedFingertip, standard_session,
};
use nalgebra::Vector3;

/// What the rest before the session says of the sensor.
struct Rest {
    zero: DummyGauge<f64, 6>,
    /// Standard deviation of the worst force component \[N\].
    noise: f64,
}

fn rest(fingertip: &SimulatedFingertip, solver: &GaussianElimination<f64>) -> Rest {
    let samples: Vec<_> = fingertip.clone().take_while(|sample| sample.truth.phase == 0).collect();
    let mut accumulator = DummyGaugeAccumulator::default();
    for sample in &samples {
        assert!(accumulator.add(&sample.reading()));
    }
    let zero = accumulator.finish().unwrap();
    let mut squares = Vector3::zeros();
    for sample in &samples {
        let force = solver.solve(&zero.compensate(&sample.reading())).force();
        squares += force.component_mul(&force);
    }
    Rest { zero, noise: (squares.amax() / samples.len() as f64).sqrt() }
}

fn run(seed: u64) -> SessionReport {
    let fingertip =
        SimulatedFingertip::new(&standard_session(), Options { seed, ..Options::default() }).unwrap();
    let solver = GaussianElimination::new(fingertip.calibrated_matrix()).unwrap();
    let Rest { zero, noise } = rest(&fingertip, &solver);
    let mut pipeline = Fingertip::builder()
        .zero(zero)
        .solver(solver)
        .contact(fingertip.sphere(), PointContact::new(3.0 * noise).unwrap())
        .friction(Coulomb::new(0.5).unwrap())
        .slip_detector(DropDetector::new(ForceNoise::isotropic(noise).unwrap()).unwrap())
        .build();
    let mut score = SessionScore::new(&fingertip);
    let step = 1.0 / fingertip.options().sample_rate;
    for sample in fingertip {
        assert!(!sample.truth.saturated, "a channel saturates at {} s", sample.time);
        let touch = pipeline.sense(&sample.reading(), step);
        let point = touch.resolution.contact().map(|contact| contact.point);
        score.add(&sample, &touch.wrench, point.as_ref(), touch.slip == SlipVerdict::Slipping);
    }
    println!("seed {seed}: noise {noise:.4} N");
    score.report()
}

#[test]
fn the_prototype_reproduces_the_papers_figures() {
    for seed in 1..=3 {
        let report = run(seed);
        for level in report.levels() {
            println!(
                "{:6.1} N: force {:.2} %, position mean {:.3} mm, greatest {:.3} mm, of single samples {:.3} mm, resolved {:.1} %",
                level.force,
                100.0 * level.mean_force_error,
                1e3 * level.mean_position_error,
                1e3 * level.greatest_position_error,
                1e3 * level.sample_position_error,
                100.0 * level.resolved,
            );
        }
        println!(
            "{:?} false {:?}",
            report.slips.iter().map(|s| s.delay.map(|d| (d * 1e3).round())).collect::<Vec<_>>(),
            report.false_alarms
        );
    }
}
