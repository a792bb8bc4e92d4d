//! The paper's sensor against the rosette, from touch to contact point.

use fingertip_calibration::design::{
    Accuracy, Assessment, Criterion, DesignError, DesignTouch, LoadedTube, Material, MatrixUsed,
    NominalLoads, Placement, Search, Touches, Trial, TubeLayout, TubeSpace, Wall, search, tolerance,
};
use fingertip_surfaces::Sphere;

const FORCE: f64 = 10.0;
/// 1 µm/m: what a good amplifier leaves.
const NOISE: f64 = 1e-6;

fn loads() -> NominalLoads {
    NominalLoads::equal(30.0, 0.3).unwrap()
}

fn tube(radius: f64) -> LoadedTube {
    LoadedTube { material: Material::ALUMINIUM_7075_T6, radius, length: 20e-3, loads: loads() }
}

fn degrees(low: f64, high: f64) -> (f64, f64) {
    (low.to_radians(), high.to_radians())
}

/// Six gauges each on the same tube: R = 5 mm, s = 0.2 mm.
fn paper_and_rosette() -> [TubeLayout; 2] {
    let wall = Wall::Fixed(0.2e-3);
    let angle = degrees(1.0, 59.0);
    let paper = TubeSpace::bicchi_dario((2e-3, 15e-3), angle, (2e-3, 20e-3), tube(5e-3), wall).unwrap();
    let rosette = TubeSpace::rosettes(3, (2e-3, 15e-3), angle, (-20e-3, 20e-3), tube(5e-3), wall).unwrap();
    [
        paper.layout(&[5e-3, 14_f64.to_radians(), 10e-3]).unwrap(),
        rosette.layout(&[5e-3, 19.7924_f64.to_radians(), 0.0]).unwrap(),
    ]
}

fn touches(force: f64) -> Vec<DesignTouch> {
    DesignTouch::on_sphere(13e-3, 80_f64.to_radians(), 0.4, force).unwrap()
}

fn trial(placement: Placement, matrix: MatrixUsed, sensors: usize) -> Trial {
    Trial { loads: loads(), placement, noise: NOISE, resolution: 0.0, matrix, sensors, seed: 4 }
}

const EXACT: Placement = Placement { angle: 0.0, position: 0.0 };
const CAREFUL: Placement = Placement { angle: 0.5 * core::f64::consts::PI / 180.0, position: 0.05e-3 };
const CARELESS: Placement = Placement { angle: 2.0 * core::f64::consts::PI / 180.0, position: 0.2e-3 };

fn run(layout: &TubeLayout, trial: &Trial) -> Accuracy {
    trial.run(layout, &Sphere::centred(13e-3).unwrap(), &touches(FORCE)).unwrap()
}

#[test]
fn rosette_gains_on_the_papers_sensor() {
    let [paper, rosette] = paper_and_rosette();
    let calibrated = MatrixUsed::Calibrated { loads: 100, load_error: 2e-3 };
    println!("rms contact error at {FORCE} N, {:.0} µm/m noise, same tube, six gauges each", NOISE * 1e6);
    for (name, placement, matrix, least_gain) in [
        ("exact", EXACT, MatrixUsed::AsDesigned, 1.2),
        ("0.5°, 0.05 mm, as designed", CAREFUL, MatrixUsed::AsDesigned, 1.2),
        ("0.5°, 0.05 mm, calibrated", CAREFUL, calibrated, 1.2),
        ("2°, 0.2 mm, as designed", CARELESS, MatrixUsed::AsDesigned, 1.2),
        ("2°, 0.2 mm, calibrated", CARELESS, calibrated, 1.2),
    ] {
        let trial = trial(placement, matrix, 40);
        let (before, after) = (run(&paper, &trial), run(&rosette, &trial));
        for Accuracy { position_rms, position_95, .. } in [before, after] {
            // 1.73 if errors were alike in both directions and everywhere.
            let ratio = position_95 / position_rms;
            assert!(ratio > 1.3 && ratio < 2.5, "{name}: {ratio}");
        }
        let gain = before.position_rms / after.position_rms;
        println!(
            "{name}: paper {:.3} mm, rosette {:.3} mm, gain {gain:.2}; force {:.2} % and {:.2} %",
            before.position_rms * 1e3,
            after.position_rms * 1e3,
            before.force_rms * 1e2,
            after.force_rms * 1e2
        );
        assert!(gain > least_gain, "{name}: {gain}");
        assert_eq!((before.missed, after.missed), (0.0, 0.0));
    }
}

#[test]
fn predicted_error_is_what_the_trial_finds() {
    let list = touches(FORCE);
    let touches = Touches::new(&list).unwrap();
    for layout in paper_and_rosette() {
        let matrix = layout.normalised(1.0, &loads()).unwrap();
        let weight = touches.weight().normalised(&loads().components());
        let predicted = NOISE * Assessment::new(&matrix, Some(&weight)).unwrap().contact_error.unwrap();
        let found = run(&layout, &trial(EXACT, MatrixUsed::AsDesigned, 40));
        // 64 000 touches: 0.5 % of chance, and the second order of the noise.
        assert!((found.position_rms / predicted - 1.0).abs() < 0.03, "{found:?} {predicted}");
        let report = tolerance(&layout, &loads(), CAREFUL, Some(&touches), 60, 1).unwrap();
        let calibrated = report.calibrated_error.unwrap();
        assert!((calibrated.nominal * NOISE / predicted - 1.0).abs() < 1e-9);
        // Misplacement and noise are independent: their squares add up.
        let misplaced = report.uncalibrated_error.unwrap().mean;
        let found = run(&layout, &trial(CAREFUL, MatrixUsed::AsDesigned, 60));
        let both = predicted.hypot(misplaced);
        assert!((found.position_rms / both - 1.0).abs() < 0.1, "{} {both}", found.position_rms);
    }
}

#[test]
fn tolerance_of_the_isotropic_rosette() {
    let root = 2.0_f64.sqrt();
    let loads = NominalLoads { force: [root * 10.0, 10.0, 10.0], torque: [root * 0.1, 0.1, 0.1] };
    let wall = Wall::Fixed(0.2e-3);
    let space = TubeSpace::rosettes(3, (2e-3, 15e-3), degrees(1.0, 59.0), (-20e-3, 20e-3), tube(8e-3), wall);
    let layout = space.unwrap().layout(&[10e-3, 19.7924_f64.to_radians(), 0.0]).unwrap();
    for (placement, mean, most) in [(CAREFUL, 1.04, 1.07), (CARELESS, 1.17, 1.34)] {
        let found = tolerance(&layout, &loads, placement, None, 1000, 1).unwrap().condition_number;
        assert!((found.nominal - 1.0).abs() < 1e-5);
        assert!((found.mean - mean).abs() < 0.025 && (found.quantile_99 - most).abs() < 0.04, "{found:?}");
    }
    assert!(tolerance(&layout, &loads, EXACT, None, 0, 1).is_err());
    let same = tolerance(&layout, &loads, EXACT, None, 3, 1).unwrap().condition_number;
    assert_eq!((same.mean, same.quantile_99), (same.nominal, same.nominal));
}

#[test]
fn condition_number_is_not_the_contact_error() {
    // At equal strength a thin tube strains more: the layout of least contact error has a higher N_c
    // than the best conditioned one, and a smaller error.
    let list = touches(FORCE);
    let touches = Touches::new(&list).unwrap();
    let weight = touches.weight().normalised(&loads().components());
    let wall = Wall::AtStrength { safety: 3.0 };
    let space =
        TubeSpace::rosettes(3, (4.5e-3, 15e-3), degrees(2.0, 50.0), (-10e-3, 15e-3), tube(8e-3), wall)
            .unwrap();
    let how = Search { starts: 4, ..Search::default() };
    let best = |criterion: &Criterion| {
        let found = search(&space, criterion, &loads(), &how, &|_| ()).unwrap();
        let layout = space.layout(&found.best().unwrap().values).unwrap();
        let judged = Assessment::new(&layout.normalised(1.0, &loads()).unwrap(), Some(&weight)).unwrap();
        println!(
            "{}: {:?} N_c {:.3} error {:.4} mm",
            criterion.name(),
            found.best().unwrap().values,
            judged.condition_number,
            judged.contact_error.unwrap() * NOISE * 1e3
        );
        (judged.condition_number, judged.contact_error.unwrap())
    };
    let (conditioned, precise) = (best(&Criterion::ConditionNumber), best(&Criterion::ContactError(weight)));
    assert!(precise.0 > conditioned.0 && precise.1 < conditioned.1);
}

#[test]
fn refuses_trials_that_make_no_sense() {
    let [paper, _] = paper_and_rosette();
    let sphere = Sphere::centred(13e-3).unwrap();
    let good = trial(EXACT, MatrixUsed::AsDesigned, 1);
    for bad in [
        Trial { noise: f64::NAN, ..good.clone() },
        Trial { resolution: -1.0, ..good.clone() },
        Trial { sensors: 0, ..good.clone() },
        Trial { matrix: MatrixUsed::Calibrated { loads: 5, load_error: 0.0 }, ..good.clone() },
        Trial { placement: Placement { angle: f64::INFINITY, position: 0.0 }, ..good.clone() },
    ] {
        assert!(bad.run(&paper, &sphere, &touches(1.0)).is_err());
    }
    assert!(good.run(&paper, &sphere, &touches(1.0)).is_ok());
    // Noise as large as the signals: touches are missed or wrong, never NaN.
    let drowned = Trial { noise: 1e-3, ..good }.run(&paper, &sphere, &touches(1.0)).unwrap();
    assert!(drowned.missed > 0.0 && drowned.position_rms.is_finite());
}

/// A layout takes a value for each parameter of its family.
#[test]
fn a_layout_has_a_value_for_each_parameter() {
    let angle = degrees(1.0, 59.0);
    let wall = Wall::Fixed(0.2e-3);
    let paper = TubeSpace::bicchi_dario((2e-3, 15e-3), angle, (2e-3, 20e-3), tube(5e-3), wall).unwrap();
    let values = [5e-3, 14_f64.to_radians(), 10e-3, 1e-3];
    for count in 0..=4 {
        let layout = paper.layout(&values[..count]);
        match layout {
            Err(DesignError::WrongCount { found, expected, .. }) => assert_eq!((found, expected), (count, 3)),
            other => assert!(count == 3 && other.is_ok(), "{count}: {other:?}"),
        }
    }
}
