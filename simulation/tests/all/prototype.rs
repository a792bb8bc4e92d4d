//! The simulated prototype through the whole pipeline reproduces the paper's figures.

use fingertip::Fingertip;
use fingertip::contact::PointContact;
use fingertip::friction::{Coulomb, DropDetector, ForceNoise, SlipVerdict};
use fingertip::wrench::{
    Compensation, DummyGauge, DummyGaugeAccumulator, GaussianElimination, Tare, WrenchSolver,
};
use fingertip_simulation::{
    Imperfections, LevelScore, Options, SessionReport, SessionScore, SimulatedFingertip, SimulatedSample,
    ThermalDrift, standard_session,
};
use fingertip_test_support::Worst;
use nalgebra::{SVector, Vector3};

/// What the rest before the session says of the sensor.
struct Rest {
    zero: DummyGauge<f64, 6>,
    tare: Tare<f64, 6>,
    /// Standard deviation of the worst force component \[N\].
    noise: f64,
}

fn rest(fingertip: &SimulatedFingertip, solver: &GaussianElimination<f64>) -> Rest {
    let samples: Vec<_> = fingertip.clone().take_while(|sample| sample.truth.phase == 0).collect();
    let mut accumulator = DummyGaugeAccumulator::default();
    let mut plain = fingertip::wrench::TareAccumulator::default();
    for sample in &samples {
        assert!(accumulator.add(&sample.reading()));
        assert!(plain.add(&sample.reading().gauges));
    }
    let zero = accumulator.finish().unwrap();
    let mut squares = Vector3::zeros();
    for sample in &samples {
        let force = solver.solve(&zero.compensate(&sample.reading())).force();
        squares += force.component_mul(&force);
    }
    assert!(squares.iter().all(|square| square.is_finite()));
    Rest { zero, tare: plain.finish().unwrap(), noise: (squares.amax() / samples.len() as f64).sqrt() }
}

/// The session of one sensor, solved with what `zero` leaves of a reading.
fn run<Zero>(
    options: Options,
    zero: impl Fn(&Rest) -> Zero,
    raw: impl Fn(&SimulatedSample) -> Zero::Raw,
) -> SessionReport
where
    Zero: Compensation<SVector<f64, 6>>,
{
    let fingertip = SimulatedFingertip::new(&standard_session(), options).unwrap();
    let solver = GaussianElimination::new(fingertip.calibrated_matrix()).unwrap();
    let rest = rest(&fingertip, &solver);
    let mut pipeline = Fingertip::builder()
        .zero(zero(&rest))
        .solver(solver)
        .contact(fingertip.sphere(), PointContact::new(3.0 * rest.noise).unwrap())
        .friction(Coulomb::new(0.5).unwrap())
        .slip_detector(DropDetector::new(ForceNoise::isotropic(rest.noise).unwrap()).unwrap())
        .build();
    let mut score = SessionScore::new(&fingertip);
    let step = 1.0 / fingertip.options().sample_rate;
    for sample in fingertip {
        assert!(!sample.truth.saturated, "a channel saturates at {} s", sample.time);
        let touch = pipeline.sense(&raw(&sample), step);
        let point = touch.resolution.contact().map(|contact| contact.point);
        score.add(&sample, &touch.wrench, point.as_ref(), touch.slip == SlipVerdict::Slipping);
    }
    score.report()
}

fn compensated(seed: u64) -> SessionReport {
    run(Options { seed, ..Options::default() }, |rest| rest.zero, SimulatedSample::reading)
}

fn at(report: &SessionReport, force: f64) -> LevelScore {
    let levels = report.levels();
    *levels.iter().find(|level| (level.force - force).abs() < 1e-6).unwrap()
}

const SENSORS: u64 = 20;

#[test]
fn accuracy_of_force_and_position_is_that_of_the_paper() {
    let reports: Vec<SessionReport> = (1..=SENSORS).map(compensated).collect();
    let mean =
        |value: &dyn Fn(&SessionReport) -> f64| reports.iter().map(value).sum::<f64>() / SENSORS as f64;
    for force in [0.1, 1.0, 10.0, 30.0] {
        let mut worst = Worst::new();
        reports.iter().for_each(|report| worst.see(at(report, force).greatest_position_error));
        println!(
            "{force:5.1} N: force {:.2} %, position {:.3} mm, of single samples {:.3} mm; worst press of all sensors {:.3} mm",
            100.0 * mean(&|report| at(report, force).mean_force_error),
            1e3 * mean(&|report| at(report, force).mean_position_error),
            1e3 * mean(&|report| at(report, force).sample_position_error),
            1e3 * worst.get(),
        );
    }
    // The force within about 2 % of the reading.
    for force in [1.0, 10.0, 30.0] {
        let error = mean(&|report| at(report, force).mean_force_error);
        assert!((0.015..0.025).contains(&error), "{force} N: {error}");
    }
    // The position, of single samples as the paper plots them: 0.2 mm at 1 N, 0.05 mm at 10 N.
    let single = |force| mean(&|report| at(report, force).sample_position_error);
    assert!((0.15e-3..0.3e-3).contains(&single(1.0)), "{}", single(1.0));
    assert!(single(10.0) < 0.1e-3, "{}", single(10.0));
    for report in &reports {
        assert!(at(report, 10.0).mean_position_error < 0.1e-3);
        // Below 1 mm from 0.1 to 30 N, of every press of every sensor.
        for level in report.levels() {
            assert!(level.greatest_position_error < 1e-3, "{level:?}");
        }
    }
}

#[test]
fn every_slip_is_found_within_20_ms_and_none_is_invented() {
    let mut delays = Vec::new();
    for seed in 1..=SENSORS {
        let report = compensated(seed);
        assert_eq!(report.slips.len(), 8);
        assert_eq!(report.false_alarms, [], "sensor {seed}");
        for slip in &report.slips {
            delays.push(
                slip.delay.unwrap_or_else(|| panic!("sensor {seed} missed the slip at {} s", slip.onset)),
            );
        }
    }
    delays.sort_by(f64::total_cmp);
    println!(
        "{} slips, delay: median {:.1} ms, greatest {:.1} ms",
        delays.len(),
        1e3 * delays[delays.len() / 2],
        1e3 * delays[delays.len() - 1]
    );
}

#[test]
fn without_the_dummy_gauge_the_warming_spoils_small_forces() {
    // A sensor as drawn, so that the temperature alone makes the difference.
    let imperfections = Imperfections::none();
    let options = Options { seed: 4, imperfections, ..Options::default() };
    let with = run(options, |rest| rest.zero, SimulatedSample::reading);
    let without = run(options, |rest| rest.tare, |sample| sample.reading().gauges);
    // Late in the session, when it has become warmer.
    let error = |report: &SessionReport| at(report, 2.0).mean_force_error;
    assert!(error(&without) > 2.0 * error(&with), "{} {}", error(&without), error(&with));
}

#[test]
fn a_sensor_without_flaws_is_exact_to_the_bridge() {
    let mut options = Options {
        imperfections: Imperfections::none(),
        thermal_drift: ThermalDrift::none(),
        ..Options::default()
    };
    options.electronics.input_noise = 0.0;
    options.electronics.bits = 24;
    let fingertip = SimulatedFingertip::new(&standard_session(), options).unwrap();
    assert_eq!(fingertip.calibrated_matrix(), fingertip.nominal_matrix());
    let solver = GaussianElimination::new(fingertip.nominal_matrix()).unwrap();
    let zero = rest(&fingertip, &solver).zero;
    let largest = fingertip.options().design.nominal_loads();
    for sample in fingertip {
        let wrench = solver.solve(&zero.compensate(&sample.reading()));
        let error = (wrench - sample.truth.wrench).components().component_div(&largest);
        // The quarter bridge falls short by ε, at most 450 µm/m, of each gauge's signal; the matrix
        // inverse, of condition 4.8, can turn that against an axis.
        assert!(error.norm() < 5.0 * 4.5e-4, "{error}");
    }
}
