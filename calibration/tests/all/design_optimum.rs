//! What the optimiser must find: the condition numbers of the paper, its optimum, and the layouts
//! that beat it.

use core::num::NonZero;
use core::sync::atomic::{AtomicUsize, Ordering};

use fingertip_calibration::design::{
    Assessment, ContactWeight, Coordinate, Criterion, Decoupling, DesignError, DesignSpace, GaugeRule,
    LoadedTube, Material, NominalLoads, Parameter, Search, TubeSpace, TubeTheory, Wall, gram, search,
};
use nalgebra::{DMatrix, Vector6};
use rand::{RngExt as _, SeedableRng as _};

/// Torque over force of the paper's condition numbers: 10 mm.
const ARM: f64 = 10e-3;

fn loads() -> NominalLoads {
    NominalLoads::equal(10.0, 10.0 * ARM).unwrap()
}

fn tube(radius: f64) -> LoadedTube {
    LoadedTube { material: Material::ALUMINIUM_7075_T6, radius, length: 60e-3, loads: loads() }
}

fn degrees(low: f64, high: f64) -> (f64, f64) {
    (low.to_radians(), high.to_radians())
}

fn paper() -> TubeSpace {
    let wall = Wall::Fixed(0.2e-3);
    TubeSpace::bicchi_dario((2e-3, 15e-3), degrees(1.0, 59.0), (2e-3, 40e-3), tube(5e-3), wall).unwrap()
}

fn rosettes(count: usize) -> TubeSpace {
    let wall = Wall::Fixed(0.2e-3);
    let z = (-20e-3, 20e-3);
    TubeSpace::rosettes(count, (2e-3, 40e-3), degrees(1.0, 59.0), z, tube(10e-3), wall).unwrap()
}

fn matrix(space: &dyn DesignSpace, values: &[f64], loads: &NominalLoads) -> DMatrix<f64> {
    let mut rows = vec![Vector6::zeros(); space.channels()];
    space.response(values, &mut rows).unwrap();
    let nominal = loads.components();
    DMatrix::from_fn(rows.len(), 6, |i, j| rows[i][j] * nominal[j])
}

fn condition_number(space: &dyn DesignSpace, values: &[f64], loads: &NominalLoads) -> f64 {
    Assessment::new(&matrix(space, values, loads), None).unwrap().condition_number
}

/// The columns of the paper's table: R \[mm\], Q \[°\], d \[mm\].
const TABLE: [[f64; 3]; 4] = [[4.1, 11.5, 9.7], [6.6, 19.5, 13.5], [7.2, 20.0, 14.6], [5.0, 14.0, 10.0]];

fn values([radius, angle, distance]: [f64; 3]) -> [f64; 3] {
    [radius * 1e-3, angle.to_radians(), distance * 1e-3]
}

#[test]
fn table_of_the_paper_as_reconstructed() {
    let space = paper().with_theory(TubeTheory::Reconstructed1987);
    let printed = [4.9, 3.7, 3.6, 4.2];
    // Reference values computed independently at 40 digits.
    let exact = [4.926_632_677_187_543, 3.719_372_945_334_568, 3.569_324_559_635_22, 4.268_050_570_185_961];
    for ((point, printed), exact) in TABLE.into_iter().zip(printed).zip(exact) {
        let found = condition_number(&space, &values(point), &loads());
        assert!((found / exact - 1.0).abs() < 1e-12, "{found} {exact}");
        assert!((found / printed - 1.0).abs() <= 0.0165, "{found} {printed}");
    }
}

#[test]
fn table_of_the_paper_under_the_right_physics() {
    let exact = [5.264_791_419_375_356, 4.687_671_983_095_47, 4.671_211_993_197_365, 4.761_421_197_481_623];
    let rounded = [5.26, 4.69, 4.67, 4.76];
    for ((point, exact), rounded) in TABLE.into_iter().zip(exact).zip(rounded) {
        let found = condition_number(&paper(), &values(point), &loads());
        assert!((found / exact - 1.0).abs() < 1e-12, "{found} {exact}");
        assert!((found - rounded).abs() < 0.005);
    }
    let found = condition_number(&paper(), &values([5.0, 14.0, 11.0]), &loads());
    assert!((found / 4.777_820_294_900_352 - 1.0).abs() < 1e-12);
}

#[test]
fn every_start_finds_the_optimum_of_the_papers_layout() {
    for seed in 0..5 {
        let how = Search { starts: 20, seed, ..Search::default() };
        let found = search(&paper(), &Criterion::ConditionNumber, &loads(), &how, &|_| ()).unwrap();
        assert_eq!((found.minima.len(), found.failed), (1, 0), "{found:?}");
        let best = found.best().unwrap();
        assert_eq!((best.starts, best.share), (20, 1.0));
        assert!(best.equivalents.is_empty());
        assert!((best.criterion - 4.183).abs() < 5e-4, "{}", best.criterion);
        let [radius, angle, distance] = best.values[..] else { panic!() };
        assert!((radius - 6.55e-3).abs() < 0.01e-3 && (distance - 13.46e-3).abs() < 0.01e-3);
        assert!((angle.to_degrees() - 14.45).abs() < 0.01);
        // It is a minimum: no step of a tolerance goes down.
        assert!(best.sensitivities.iter().all(|s| s.lower > 0.0 && s.higher > 0.0), "{best:?}");
    }
}

#[test]
fn optimum_scales_with_torque_over_force() {
    let long = NominalLoads::equal(3.0, 3.0 * 2.0 * ARM).unwrap();
    let wall = Wall::Fixed(0.2e-3);
    let space =
        TubeSpace::bicchi_dario((4e-3, 30e-3), degrees(1.0, 59.0), (4e-3, 80e-3), tube(5e-3), wall).unwrap();
    let how = Search { starts: 6, ..Search::default() };
    let found = search(&space, &Criterion::ConditionNumber, &long, &how, &|_| ()).unwrap();
    let best = found.best().unwrap();
    assert!((best.criterion - 4.182_82).abs() < 1e-4);
    assert!((best.values[0] - 2.0 * 6.5455e-3).abs() < 1e-5);
}

#[test]
fn all_eighteen_parameters_free_reach_the_lower_bound() {
    let wall = Wall::Fixed(0.2e-3);
    let space = TubeSpace::free(6, (-20e-3, 20e-3), tube(ARM), wall).unwrap();
    let how = Search { starts: 16, ..Search::default() };
    let found = search(&space, &Criterion::ConditionNumber, &loads(), &how, &|_| ()).unwrap();
    let best = found.best().unwrap();
    assert!(best.criterion <= 1.43 && best.criterion >= 2.0_f64.sqrt() * (1.0 - 1e-9), "{}", best.criterion);
    // Other minima are reported, ordered, with their shares.
    assert!(found.minima.len() > 1 && found.minima.is_sorted_by(|a, b| a.criterion <= b.criterion));
    let shares: f64 = found.minima.iter().map(|minimum| minimum.share).sum();
    assert!((shares + found.failed as f64 / 16.0 - 1.0).abs() < 1e-12);
}

#[test]
fn no_random_design_beats_the_lower_bound() {
    // N_c ≥ √2·max(x, 1/x) with x = m/(fR), for any number of gauges anywhere on a thin tube.
    let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(8);
    let (mut least, mut closest) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..5 {
        let radius = random.random_range(3e-3..30e-3);
        for count in [6, 8] {
            let space = TubeSpace::free(count, (-30e-3, 30e-3), tube(radius), Wall::Fixed(0.2e-3)).unwrap();
            let x = ARM / radius;
            let bound = 2.0_f64.sqrt() * x.max(1.0 / x);
            let mut rows = vec![Vector6::zeros(); count];
            for _ in 0..10_000 {
                let values: Vec<f64> =
                    space.parameters().iter().map(|p| random.random_range(p.lower..p.upper)).collect();
                space.response(&values, &mut rows).unwrap();
                let found = Criterion::ConditionNumber.of(&gram(&rows, &loads().components()));
                assert!(found >= bound * (1.0 - 1e-9), "{found} {bound}");
                least = least.min(found);
                closest = closest.min(found / bound);
            }
        }
    }
    println!("100000 random designs: best {least:.3}, closest to its bound {closest:.3}");
}

#[test]
fn rosette_of_condition_number_one() {
    // Fx and Tx weighted √2 stronger, R = m/f: then N_c = 1 exactly.
    let (force, torque, root) = (10.0, 10.0 * ARM, 2.0_f64.sqrt());
    let loads = NominalLoads { force: [root * force, force, force], torque: [root * torque, torque, torque] };
    for count in [3, 4, 5] {
        let space = rosettes(count);
        let how = Search { starts: 8, ..Search::default() };
        let found = search(&space, &Criterion::ConditionNumber, &loads, &how, &|_| ()).unwrap();
        let best = found.best().unwrap();
        assert!(best.criterion < 1.0 + 1e-5, "{best:?}");
        assert!((best.values[0] - ARM).abs() < 1e-6 && (best.values[1].to_degrees() - 19.7924).abs() < 1e-2);
        // (1+μ) sin 2Q = cos² Q − μ sin² Q.
        let mu = 0.33_f64;
        let residual = |q: f64| (1.0 + mu) * (2.0 * q).sin() - q.cos().powi(2) + mu * q.sin().powi(2);
        let (mut low, mut high) = degrees(1.0, 45.0);
        for _ in 0..80 {
            let middle = 0.5 * (low + high);
            if residual(middle) < 0.0 { low = middle } else { high = middle }
        }
        let exact = condition_number(&space, &[ARM, low, 0.0], &loads);
        assert!((exact - 1.0).abs() < 1e-12, "{exact}");
        let matrix = matrix(&space, &[ARM, low, 0.0], &loads);
        match Decoupling::find(&matrix) {
            Some(found) => assert_eq!(found.couplings(), 0),
            // sin 72° is no ratio of small whole numbers.
            None => assert_eq!(count, 5),
        }
    }
}

#[test]
fn theory_of_other_optima() {
    // Two rings of four gauges of one sign each: √5 at R = 0.816 m/f with one Q and −Q; alternating and
    // turned freely, rings reach √2, as four rosettes do.
    let wall = Wall::Fixed(0.2e-3);
    let ring = (-30e-3, 30e-3);
    let space = TubeSpace::rings(2, 4, false, (2e-3, 40e-3), ring, tube(ARM), wall).unwrap();
    let how = Search { starts: 10, ..Search::default() };
    let found = search(&space, &Criterion::ConditionNumber, &loads(), &how, &|_| ()).unwrap();
    assert!((found.best().unwrap().criterion / 2.0_f64.sqrt() - 1.0).abs() < 1e-5);
    let found = search(&rosettes(4), &Criterion::ConditionNumber, &loads(), &how, &|_| ()).unwrap();
    assert!((found.best().unwrap().criterion / 2.0_f64.sqrt() - 1.0).abs() < 1e-6);
}

#[test]
fn result_depends_on_the_seed_only() {
    let wall = Wall::Fixed(0.2e-3);
    let space = TubeSpace::free(6, (-20e-3, 20e-3), tube(ARM), wall).unwrap();
    let run = |seed, threads| {
        let calls = AtomicUsize::new(0);
        let how = Search { starts: 6, seed, threads: NonZero::new(threads), ..Search::default() };
        let progress = |progress: fingertip_calibration::design::Progress| {
            assert!(progress.done <= progress.starts && progress.best >= 1.0);
            calls.fetch_add(1, Ordering::Relaxed);
        };
        let found = search(&space, &Criterion::ConditionNumber, &loads(), &how, &progress).unwrap();
        assert_eq!(calls.into_inner(), 6);
        found
    };
    assert_eq!(run(3, 1), run(3, 4));
    assert_ne!(run(3, 1), run(4, 1));
}

#[test]
fn every_criterion_is_minimised() {
    let weight = ContactWeight::on_sphere(13e-3, 1.5, 0.5, 1.0).unwrap();
    let nominal = loads().components();
    let criteria = [
        Criterion::ConditionNumber,
        Criterion::LogDeterminant,
        Criterion::Trace,
        Criterion::WorstAxis,
        Criterion::ContactError(weight.normalised(&nominal)),
    ];
    let wall = Wall::AtStrength { safety: 3.0 };
    let bounds = ((4e-3, 15e-3), degrees(2.0, 50.0), (3e-3, 30e-3));
    let space = TubeSpace::bicchi_dario(bounds.0, bounds.1, bounds.2, tube(8e-3), wall).unwrap();
    let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(5);
    for criterion in criteria {
        let how = Search { starts: 4, ..Search::default() };
        let found = search(&space, &criterion, &loads(), &how, &|_| ()).unwrap();
        let best = found.best().unwrap();
        for _ in 0..2000 {
            let values: Vec<f64> =
                space.parameters().iter().map(|p| random.random_range(p.lower..p.upper)).collect();
            let mut rows = [Vector6::zeros(); 6];
            if space.response(&values, &mut rows).is_ok() {
                let value = criterion.of(&gram(&rows, &nominal));
                assert!(value >= best.criterion * (1.0 - 1e-9), "{criterion:?} {value} {best:?}");
            }
        }
    }
}

#[test]
fn refuses_searches_that_make_no_sense() {
    let none = Search { starts: 0, ..Search::default() };
    assert!(search(&paper(), &Criterion::Trace, &loads(), &none, &|_| ()).is_err());
    let bad = NominalLoads { force: [f64::NAN; 3], torque: [1.0; 3] };
    assert!(search(&paper(), &Criterion::Trace, &bad, &Search::default(), &|_| ()).is_err());
    assert!(NominalLoads::equal(0.0, 1.0).is_err());
    // No wall is thick enough anywhere: not a panic, and not a sensor.
    let heavy = LoadedTube { loads: NominalLoads::equal(1e7, 1e5).unwrap(), ..tube(5e-3) };
    let wall = Wall::AtStrength { safety: 2.0 };
    let space =
        TubeSpace::bicchi_dario((2e-3, 15e-3), degrees(1.0, 59.0), (2e-3, 40e-3), heavy, wall).unwrap();
    let how = Search { starts: 2, ..Search::default() };
    assert!(search(&space, &Criterion::Trace, &loads(), &how, &|_| ()).is_err());
    // Of a radius that is settled it is said at once.
    let gauges = (0..6).map(|k| GaugeRule {
        z: Coordinate::fixed(0.0),
        theta: Coordinate::fixed(f64::from(k) * 60_f64.to_radians()),
        q: Coordinate::following(0, if k % 2 == 0 { 1.0 } else { -1.0 }),
    });
    let turned = vec![Parameter::angle("Q", 0.0, 1.0)];
    let fixed = TubeSpace::new(turned, Coordinate::fixed(5e-3), gauges.collect(), heavy, wall);
    assert!(matches!(fixed, Err(DesignError::WallTooThick { .. })), "{fixed:?}");
}

/// The paper's gauges turned the other way are another sensor: for 30 N and 0.1 N·m the better one.
#[test]
fn both_signs_of_the_papers_angle_are_searched() {
    let loads = NominalLoads::equal(30.0, 0.1).unwrap();
    let tube = LoadedTube { loads, length: 20e-3, ..tube(5e-3) };
    let best = |angles: (f64, f64)| {
        let space =
            TubeSpace::bicchi_dario((4e-3, 10e-3), angles, (1e-3, 16e-3), tube, Wall::Fixed(0.2e-3)).unwrap();
        let how = Search { starts: 8, ..Search::default() };
        let found = search(&space, &Criterion::ConditionNumber, &loads, &how, &|_| ()).unwrap();
        found.best().unwrap().clone()
    };
    assert!((best(degrees(1.0, 59.0)).criterion - 5.405).abs() < 1e-3);
    let both = best(degrees(-59.0, 59.0));
    assert!((both.criterion - 5.058).abs() < 1e-3, "{both:?}");
    assert!((both.values[1].to_degrees() + 15.15).abs() < 0.01 && (both.values[2] - 5.66e-3).abs() < 1e-5);
}
