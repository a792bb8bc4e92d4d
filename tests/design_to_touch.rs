//! A designed sensor, loaded from its file into the simulated fingertip and the solvers, against the
//! paper's: the whole chain from gauges to contact points.
#![allow(clippy::unwrap_used, reason = "helpers of tests, which may fail so")]

use fingertip::Fingertip;
use fingertip::contact::PointContact;
use fingertip::wrench::{
    Decoupled, DummyGaugeAccumulator, GaussianElimination, ThreeRosettes, Wrench, WrenchSolver,
};
use fingertip_calibration::design::{
    Excitation, LayoutFile, LoadedTube, Material, NominalLoads, TubeSpace, Wall,
};
use fingertip_simulation::{
    Design, Imperfections, Options, SessionScore, SimulatedFingertip, standard_session,
};
use nalgebra::Vector6;

/// Three pairs at ±19.8° on the paper's tube, by way of a file.
fn rosette_file() -> LayoutFile {
    let paper = Design::default();
    let tube = LoadedTube {
        material: Material::new(paper.beam.youngs_modulus, paper.beam.poisson_ratio, 276e6),
        radius: paper.beam.radius,
        length: 20e-3,
        loads: NominalLoads::equal(30.0, 0.3).unwrap(),
    };
    let wall = Wall::Fixed(paper.beam.thickness);
    let angles = (5_f64.to_radians(), 50_f64.to_radians());
    let space = TubeSpace::rosettes(3, (2e-3, 10e-3), angles, (-5e-3, 15e-3), tube, wall).unwrap();
    let layout = space.layout(&[5e-3, 19.7924_f64.to_radians(), 0.0]).unwrap();
    let excitation = Excitation { supply: 5.0, gauge_factor: 2.0, amplifier_gain: 2000.0 };
    let text = LayoutFile::new(&layout, &tube, excitation).unwrap().to_toml().unwrap();
    LayoutFile::from_toml(&text).unwrap()
}

#[test]
fn solvers_take_the_file() {
    let sensor = rosette_file().sensor_matrix::<6>().unwrap();
    let general = GaussianElimination::new(&sensor).unwrap();
    let fast = Decoupled::<f64, ThreeRosettes, 6>::new(&sensor).unwrap();
    let load = Wrench::from_components(&Vector6::new(1.0, -2.0, 3.0, 0.01, 0.02, -0.03));
    let signals = sensor.signals(&load);
    let off = |found: Wrench<f64>, tolerance: f64| {
        assert!((found - load).components().iter().all(|x| x.abs() < tolerance), "{found:?}");
    };
    off(general.solve(&signals), 1e-12);
    off(fast.solve(&signals), 1e-8);
}

/// Root mean square position error of single samples \[m\] at presses of 1, 5 and 10 N.
fn errors(design: Design, imperfections: Imperfections, seed: u64) -> [f64; 3] {
    let options = Options { design, imperfections, seed, ..Options::default() };
    let mut simulated = SimulatedFingertip::new(&standard_session(), options).unwrap();
    let mut score = SessionScore::new(&simulated);
    let mut zero = DummyGaugeAccumulator::default();
    let first = loop {
        match simulated.next() {
            Some(sample) if sample.truth.phase == 0 => {
                zero.add(&sample.reading());
            }
            other => break other,
        }
    };
    let mut fingertip = Fingertip::builder()
        .zero(zero.finish().unwrap())
        .solver(GaussianElimination::new(simulated.calibrated_matrix()).unwrap())
        .contact(simulated.sphere(), PointContact::new(0.05).unwrap())
        .build();
    let step = simulated.options().sample_rate.recip();
    for sample in first.into_iter().chain(&mut simulated) {
        let touch = fingertip.sense(&sample.reading(), step);
        let point = touch.resolution.contact().map(|contact| contact.point);
        score.add(&sample, &touch.wrench, point.as_ref(), false);
    }
    let levels = score.report().levels();
    [1.0, 5.0, 10.0].map(|force: f64| {
        let level = levels.iter().find(|level| (level.force - force).abs() < 0.1 * force).unwrap();
        level.sample_position_error
    })
}

#[test]
fn rosette_beats_the_papers_sensor_in_the_simulated_fingertip() {
    let paper = Design::default();
    let rosette = Design { gauges: rosette_file().gauge_layout().unwrap().gauges, ..paper };
    for (name, imperfections) in
        [("no imperfections", Imperfections::none()), ("imperfect", Imperfections::default())]
    {
        let seeds = 6;
        let mean = |design: Design| {
            let mut sums = [0.0; 3];
            for seed in 0..seeds {
                let found = errors(design, imperfections, seed);
                sums.iter_mut().zip(found).for_each(|(sum, error)| *sum += error * error);
            }
            sums.map(|sum| (sum / seeds as f64).sqrt())
        };
        let (before, after) = (mean(paper), mean(rosette));
        for ((force, before), after) in [1.0, 5.0, 10.0].iter().zip(before).zip(after) {
            println!(
                "{name}, {force} N: paper {:.3} mm, rosette {:.3} mm, gain {:.2}",
                before * 1e3,
                after * 1e3,
                before / after
            );
        }
        // At 1 N noise rules, and the gain is that of the layout.
        assert!(before[0] / after[0] > 1.1, "{name}: {before:?} {after:?}");
    }
}
