//! Curved sensors: which terms are chosen, whether the stated errors are those of loads never seen, and what they make of
//! contacts.

use fingertip_calibration::curve::Terms;
use fingertip_calibration::file::{SignalUnit, Verdict};
use fingertip_calibration::linear::{pairs, pseudo_inverse};
use fingertip_calibration::loads::LoadTable;
use fingertip_calibration::model::{CalibrationError, Curvature, Direction, Limits, Options};
use fingertip_calibration::nalgebra::{DMatrix, DVector, Vector3, Vector6};
use fingertip_calibration::report::Report;
use fingertip_calibration::{Axis, Calibration, calibrate};
use fingertip_contact::{ContactModel as _, PointContact};
use fingertip_surfaces::Sphere;
use fingertip_wrench::Wrench;
use rand::SeedableRng as _;
use rand_pcg::Pcg64Mcg;

use crate::random::{gaussian, gaussians};

fn chosen() -> Options {
    Options { direction: Direction::LoadsFromSignals, curvature: Curvature::Chosen, ..Options::default() }
}

/// Three axes, whose loads are straight in the signals but for these terms; a zero that is not small.
fn of_terms(random: &mut Pcg64Mcg, samples: usize, unit: f64, noise: f64) -> LoadTable {
    let signals = gaussians(random, samples, 3);
    let mut loads = DMatrix::from_fn(samples, 3, |i, j| {
        let s = |k: usize| signals[(i, k % 3)];
        3.0 * s(j)
            + 0.4 * s(j + 1)
            + [0.3, 0.0, -0.2][j] * s(0) * s(0)
            + [0.0, 0.25, 0.1][j] * s(1) * s(2) * s(2)
    });
    loads += gaussians(random, samples, 3) * noise;
    let readings = DMatrix::from_fn(samples, 3, |i, j| unit * (signals[(i, j)] + [2.0, -7.0, 0.5][j]));
    LoadTable::new(&Axis::FORCES, loads, readings, SignalUnit::Volt).unwrap()
}

fn terms(calibration: &Calibration) -> &Terms {
    &calibration.model.terms
}

#[test]
fn the_terms_that_are_there_are_found_whatever_the_unit_and_the_zero() {
    for unit in [1e-9, 1.0, 1e6] {
        let random = &mut Pcg64Mcg::seed_from_u64(301);
        let table = of_terms(random, 120, unit, 0.0);
        let calibration = calibrate(&table, &chosen()).unwrap();
        assert_eq!(terms(&calibration).names(), ["v1·v1", "v2·v3·v3"], "{unit}");
        let loads = calibration.model.loads(&table.signals).unwrap();
        assert!((loads - &table.loads).amax() < 1e-7, "{unit}");
        // The file has the same, by a zero that gives no load.
        let file = calibration.to_file().unwrap();
        for (zero, expected) in file.zero.iter().zip([2.0, -7.0, 0.5]) {
            assert!((zero / unit - expected).abs() < 1e-7, "{zero}");
        }
        for i in 0..20 {
            let reading: Vec<f64> = table.signals.row(i).iter().copied().collect();
            let load = file.load(&reading).unwrap();
            assert!((load.transpose() - table.loads.row(i)).amax() < 1e-6, "{unit}: {load}");
        }
        let region = file.region.as_ref().unwrap();
        let distance = |i: usize| {
            let signals: Vec<f64> = (0..3).map(|j| table.signals[(i, j)] - file.zero[j]).collect();
            region.distance(&signals)
        };
        let farthest = (0..120).map(distance).fold(0.0, f64::max);
        assert!((farthest - 1.0).abs() < 1e-6, "{farthest}");
    }
}

/// Bumps are taken where no product of three signals will do, and say no load without any.
#[test]
fn what_no_polynomial_is_gets_bumps() {
    let random = &mut Pcg64Mcg::seed_from_u64(302);
    let signals = gaussians(random, 300, 3);
    let loads = DMatrix::from_fn(300, 3, |i, j| {
        let away: f64 = (0..3).map(|k| (signals[(i, k)] - [0.8, -0.6, 0.4][k]).powi(2)).sum();
        2.0 * signals[(i, j)] + (1.0 + j as f64) / (1.0 + 2.0 * away)
    });
    let readings = signals.map(|x| x + 3.0);
    let table = LoadTable::new(&Axis::FORCES, loads, readings, SignalUnit::Volt).unwrap();
    let calibration = calibrate(&table, &chosen()).unwrap();
    let curve = calibration.report.curve.as_ref().unwrap();
    assert!(!terms(&calibration).centres.is_empty(), "{curve}");
    assert!(curve.taken && curve.left_out_percent < 0.6 * curve.straight_percent, "{curve}");
    let file = calibration.to_file().unwrap();
    assert!(file.load(&file.zero).unwrap().amax() < 1e-9);
    let again = fingertip_calibration::file::CalibrationFile::from_toml(&file.to_toml().unwrap()).unwrap();
    let (ours, read) = (calibration.model.loads(&table.signals).unwrap(), |i: usize| {
        again.load(table.signals.row(i).iter().copied().collect::<Vec<_>>().as_slice()).unwrap()
    });
    for i in 0..300 {
        assert!((read(i).transpose() - ours.row(i)).amax() < 1e-8, "{i}");
    }
}

/// On loads that are drawn anew the error is the one that was stated, and a straight sensor gets few terms, if any.
#[test]
fn the_stated_error_is_that_of_loads_never_seen() {
    let (mut stated, mut found, mut straight_terms) = (0.0, 0.0, 0);
    for seed in 0..12 {
        let random = &mut Pcg64Mcg::seed_from_u64(400 + seed);
        let table = of_terms(random, 80, 1.0, 0.1);
        let calibration = calibrate(&table, &chosen()).unwrap();
        let fresh = of_terms(random, 2_000, 1.0, 0.1);
        let off = calibration.model.loads(&fresh.signals).unwrap() - &fresh.loads;
        let shares: f64 = off
            .column_iter()
            .zip(&calibration.model.nominal)
            .map(|(column, nominal)| column.norm_squared() / nominal.powi(2))
            .sum();
        found += (100.0 * (shares / off.len() as f64).sqrt()).ln() / 12.0;
        stated += calibration.report.curve.as_ref().unwrap().left_out_percent.ln() / 12.0;

        let signals = gaussians(random, 80, 3);
        let loads = &signals * 3.0 + gaussians(random, 80, 3) * 0.1;
        let straight = LoadTable::new(&Axis::FORCES, loads, signals, SignalUnit::Volt).unwrap();
        let calibration = calibrate(&straight, &chosen()).unwrap();
        straight_terms += terms(&calibration).len();
        assert!(calibration.report.curve.as_ref().is_some_and(|curve| curve.taken));
    }
    // The tried tenths have their own scatter, and nine tenths tell a little less than all.
    assert!((found - stated).abs() < 0.2, "{} {}", found.exp(), stated.exp());
    assert!(straight_terms <= 12, "{straight_terms}");
}

/// A soft sensor of six gauges: signals bend by up to 15 % of full scale with products of loads.
struct Soft {
    matrix: DMatrix<f64>,
    bend: DMatrix<f64>,
    zero: DVector<f64>,
}

const NOMINAL: [f64; 6] = [10.0, 10.0, 10.0, 0.1, 0.1, 0.1];

impl Soft {
    fn new(random: &mut Pcg64Mcg) -> Self {
        let matrix = DMatrix::identity(6, 6) * 2.0 + gaussians(random, 6, 6) * 0.2;
        let mut bend = gaussians(random, 6, 21);
        // At one nominal load after another and two at once, no gauge bends by more than 15 % of its signal there.
        for (mut row, straight) in bend.row_iter_mut().zip(matrix.row_iter()) {
            let most = row.iter().map(|x| x.abs()).fold(0.0, f64::max);
            row *= 0.15 * straight.norm() / most;
        }
        Self { matrix, bend, zero: gaussians(random, 6, 1).column(0).into_owned() }
    }

    fn reading(&self, load: &Vector6<f64>, random: &mut Pcg64Mcg) -> DVector<f64> {
        let share = DVector::from_fn(6, |i, _| load[i] / NOMINAL[i]);
        let bent = &self.matrix * &share + &self.bend * pairs(share.as_slice());
        bent + &self.zero + DVector::from_fn(6, |_, _| 5e-4 * gaussian(random))
    }

    /// Pushes on a ball from all sides that a finger meets, four readings of each.
    fn pushes(&self, random: &mut Pcg64Mcg, count: usize) -> (LoadTable, Vec<Vector3<f64>>) {
        let (mut loads, mut readings, mut points, mut cases) =
            (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for case in 0..count {
            let mut direction = Vector3::from_fn(|_, _| gaussian(random)).normalize();
            direction.z = direction.z.abs();
            let point = direction * RADIUS;
            let across = Vector3::from_fn(|_, _| gaussian(random)).cross(&direction) * 0.2;
            let force = (across - direction) * (2.0 + 5.0 * gaussian(random).abs().min(1.6));
            let load = Wrench::<f64>::from_force_at(&point, force).components();
            for _ in 0..4 {
                readings.extend(self.reading(&load, random).iter().copied());
                loads.extend(load.iter().copied());
                points.push(point);
                cases.push(case);
            }
        }
        let rows = points.len();
        let (loads, readings) =
            (DMatrix::from_row_slice(rows, 6, &loads), DMatrix::from_row_slice(rows, 6, &readings));
        let mut table = LoadTable::new(&Axis::ALL, loads, readings, SignalUnit::Volt).unwrap();
        table.cases = cases;
        (table, points)
    }
}

const RADIUS: f64 = 0.008;

/// Median distance between the contacts that a calibration tells of and where they are \[mm\].
fn median_miss(calibration: &Calibration, table: &LoadTable, points: &[Vector3<f64>]) -> f64 {
    let loads = calibration.model.loads(&table.signals).unwrap();
    let (ball, model) = (Sphere::centred(RADIUS).unwrap(), PointContact::new(0.1).unwrap());
    let mut misses: Vec<f64> = points
        .iter()
        .zip(loads.row_iter())
        .map(|(point, load)| {
            let wrench = Wrench::from_components(&Vector6::from_iterator(load.iter().copied()));
            model
                .resolve(&wrench, &ball)
                .contact()
                .map_or(2e3 * RADIUS, |contact| 1e3 * (contact.point - point).norm())
        })
        .collect();
    misses.sort_by(f64::total_cmp);
    misses[misses.len() / 2]
}

#[test]
fn a_soft_sensor_locates_at_least_twice_as_well_on_cases_never_seen() {
    for seed in [501, 502, 503] {
        let random = &mut Pcg64Mcg::seed_from_u64(seed);
        let soft = Soft::new(random);
        let (table, _) = soft.pushes(random, 150);
        let (fresh, points) = soft.pushes(random, 150);
        let nominal = Some(NOMINAL.to_vec());
        let straight =
            calibrate(&table, &Options { nominal: nominal.clone(), ..Options::default() }).unwrap();
        let curved = calibrate(&table, &Options { nominal, ..chosen() }).unwrap();
        let (before, after) =
            (median_miss(&straight, &fresh, &points), median_miss(&curved, &fresh, &points));
        assert!(after < 0.5 * before, "{seed}: {after:.3} mm, {before:.3} mm without");
        // Who fits it straight is told what it could be.
        let could = straight.report.curve.as_ref().unwrap();
        assert!(!could.taken && could.left_out_percent < 0.7 * could.straight_percent, "{could}");
        // Nor is one to whom it does as it is.
        let limits = Limits { left_out_percent: 1e3, ..Limits::default() };
        let nominal = Some(NOMINAL.to_vec());
        let easy = calibrate(&table, &Options { nominal, limits, ..Options::default() }).unwrap().report;
        assert!(easy.verdict != Verdict::Bad && easy.curve.is_none(), "{:?}", easy.reasons);
        let is = curved.report.curve.as_ref().unwrap();
        // Its terms are as many as help, though they say more of loads that they have seen.
        assert!(
            !curved.report.reasons.iter().any(|reason| reason.contains("over-fitted")),
            "{:?}",
            curved.report.reasons
        );
        assert!((could.left_out_percent / is.left_out_percent - 1.0).abs() < 0.2, "{could}; {is}");
        println!("{seed}: {before:.3} mm straight, {after:.3} mm curved by {}", terms(&curved).described());
    }
}

#[test]
fn what_cannot_be_curved_is_refused() {
    let random = &mut Pcg64Mcg::seed_from_u64(303);
    let table = of_terms(random, 60, 1.0, 0.01);
    let refused = |table: &LoadTable, options: &Options| match calibrate(table, options) {
        Err(CalibrationError::BadOption { option: "curvature", message }) => message,
        other => panic!("{other:?}"),
    };
    let forward = Options { direction: Direction::SignalsFromLoads, ..chosen() };
    assert!(refused(&table, &forward).contains("only loads from signals"));
    let mut few = table.clone();
    few.cases = (0..60).map(|i| i % 3).collect();
    assert!(refused(&few, &chosen()).contains("too few"));
    let given = |terms: Terms| {
        let origin = vec![0.0; 3];
        Options { curvature: Curvature::Given { terms: Box::new(terms), origin }, ..chosen() }
    };
    let other = Terms { products: vec![vec![0, 7]], ..Terms::default() };
    assert!(refused(&table, &given(other)).contains("not those of 3 gauges"));
    // Given terms are fitted as they are.
    let right = Terms { products: vec![vec![0, 0], vec![1, 2, 2]], ..Terms::default() };
    let calibration = calibrate(&table, &given(right.clone())).unwrap();
    assert_eq!(*terms(&calibration), right);
    assert!(calibration.report.method.contains("curved by 2 terms"), "{}", calibration.report.method);
    assert!(calibration.report.curve.is_none());
}

/// What a pipeline refuses to read is no part of a check either, and named.
#[test]
fn a_check_leaves_out_what_lies_beyond_the_calibration() {
    let random = &mut Pcg64Mcg::seed_from_u64(333);
    let file = calibrate(&of_terms(random, 120, 1.0, 0.0), &chosen()).unwrap().to_file().unwrap();
    let mut table = of_terms(random, 40, 1.0, 0.0);
    let limits = Limits::default();
    let within = Report::of_check(&file, &table, &limits, None).unwrap();
    let sum = within.samples + within.excluded.len();
    assert!(sum == 40 && within.samples > 30, "{}", within.samples);
    for gauge in 0..3 {
        table.signals[(7, gauge)] = file.zero[gauge] + 50.0;
    }
    let report = Report::of_check(&file, &table, &limits, None).unwrap();
    let left = report.excluded.iter().find(|left| left.sample == "sample 8").unwrap();
    assert!(left.reason.contains("times as far out"), "{}", left.reason);
    assert_eq!(report.verdict, within.verdict);
}

/// The variance of a load by the fit, over many fits of the same sensor, against the stated one.
#[test]
fn the_stated_covariance_is_that_of_all_terms() {
    let random = &mut Pcg64Mcg::seed_from_u64(334);
    let clean = of_terms(random, 60, 1.0, 0.0);
    let origin = vec![2.0, -7.0, 0.5];
    let products = vec![vec![0, 0], vec![1, 2, 2], vec![0, 1], vec![2, 2]];
    let terms = Box::new(Terms { products, ..Terms::default() });
    let options = Options {
        direction: Direction::LoadsFromSignals,
        curvature: Curvature::Given { terms, origin: origin.clone() },
        nominal: Some(vec![6.0; 3]),
        ..Options::default()
    };
    let asked = of_terms(random, 40, 1.0, 0.0);
    let (mut found, mut stated, mut linear) = (Vec::new(), vec![0.0; 40], vec![0.0; 40]);
    const FITS: usize = 400;
    for _ in 0..FITS {
        let mut table = clean.clone();
        table.loads += gaussians(random, 60, 3) * 0.05;
        let calibration = calibrate(&table, &options).unwrap();
        let file = calibration.to_file().unwrap();
        let of_linear = calibration.model.covariance().unwrap();
        let whole = file.covariance.as_ref().unwrap();
        let inverse = pseudo_inverse(&file.matrix).unwrap();
        let mut loads = Vec::new();
        for sample in 0..40 {
            let reading: Vec<f64> = asked.signals.row(sample).iter().copied().collect();
            // Of a tared sensor: the zero has an error of its own.
            let zero = file.load(&origin).unwrap();
            loads.push(file.load(&reading).unwrap() - zero);
            let load = asked.loads.row(sample).transpose() / 6.0;
            let variance = |covariance: &fingertip_calibration::file::Covariance| {
                36.0 * (&inverse * covariance.of_signals(&load) * inverse.transpose()).trace()
            };
            stated[sample] += variance(whole) / FITS as f64;
            linear[sample] += variance(&of_linear) / FITS as f64;
        }
        found.push(loads);
    }
    let mut ratios = [(); 2].map(|()| Vec::new());
    for sample in 0..40 {
        let mean = found.iter().map(|loads| &loads[sample]).sum::<DVector<f64>>() / FITS as f64;
        let spread = found.iter().map(|loads| (&loads[sample] - &mean).norm_squared()).sum::<f64>();
        let spread = spread / (FITS - 1) as f64;
        ratios[0].push((stated[sample] / spread).ln());
        ratios[1].push((linear[sample] / spread).ln());
    }
    let off = |ratios: &[f64]| (ratios.iter().map(|ratio| ratio * ratio).sum::<f64>() / 40.0).sqrt();
    let mean = |ratios: &[f64]| (ratios.iter().sum::<f64>() / 40.0).exp();
    // A quadratic form of the loads is no polynomial of higher order, but right in the mean; the linear part is not.
    assert!((0.85..1.3).contains(&mean(&ratios[0])) && off(&ratios[0]) < 0.6, "{}", mean(&ratios[0]));
    assert!(mean(&ratios[1]) < 0.8 && off(&ratios[1]) > off(&ratios[0]), "{}", mean(&ratios[1]));
}
