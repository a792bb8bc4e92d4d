//! What a zero of each group, taken from its own readings, does to what a fit states: against the formulas in full.

use fingertip_calibration::Axis;
use fingertip_calibration::calibrate;
use fingertip_calibration::file::SignalUnit;
use fingertip_calibration::loads::LoadTable;
use fingertip_calibration::model::{Method, Options};
use fingertip_calibration::nalgebra::DMatrix;
use rand::SeedableRng as _;
use rand_pcg::Pcg64Mcg;

use super::random::{gaussians, sensor};
use super::testing::Largest as _;

const SAMPLES: usize = 16;

/// Two groups that take turns, each with two readings at rest, all of different weight.
fn table() -> LoadTable {
    let random = &mut Pcg64Mcg::seed_from_u64(141);
    let mut loads = gaussians(random, SAMPLES, 2);
    [0, 1, 6, 9].into_iter().for_each(|i| loads.row_mut(i).fill(0.0));
    let signals = &loads * sensor(random, 2, 3) + gaussians(random, SAMPLES, 3) * 0.05;
    let mut table = LoadTable::new(&Axis::ALL[..2], loads, signals, SignalUnit::Volt).unwrap();
    table.groups = (0..SAMPLES).map(|i| i % 2).collect();
    table.weights = Some((0..SAMPLES).map(|i| 0.5 + (i * 5 % 7) as f64).collect());
    table
}

fn options(tare_groups: bool, bias: bool) -> Options {
    Options { bias, tare_groups, nominal: Some(vec![1.0; 2]), ..Options::default() }
}

/// The map from readings to readings less what `share` has of each group, and the degrees of freedom that it leaves.
fn check(
    table: &LoadTable,
    fitted: &LoadTable,
    (tare, bias): (bool, bool),
    share: impl Fn(usize, usize) -> f64,
) {
    let weights = DMatrix::from_diagonal(&table.weights.clone().unwrap().into());
    let less = DMatrix::from_fn(SAMPLES, SAMPLES, |i, j| {
        let same = if table.groups[i] == table.groups[j] { share(i, j) } else { 0.0 };
        if i == j { 1.0 - same } else { -same }
    });
    let x = &if bias { fitted.loads.clone().insert_column(2, 1.0) } else { fitted.loads.clone() };
    let gram = (x.transpose() * &weights * x).try_inverse().unwrap();
    let noise = &less * weights.clone().try_inverse().unwrap() * less.transpose();
    let spread = &gram * x.transpose() * &weights * &noise * &weights * x * &gram;
    let coefficients = &gram * x.transpose() * &weights * &less * &table.signals;
    let left = &less * &table.signals - x * &coefficients;
    let freedom = (noise * (&weights - &weights * x * &gram * x.transpose() * &weights)).trace();
    let variance = left.transpose() * weights * left / freedom;
    let fit = calibrate(if tare { table } else { fitted }, &options(tare, bias)).unwrap().model.fit;
    assert!((&fit.coefficients - coefficients).largest() < 1e-12);
    let near = |a: &DMatrix<f64>, b: &DMatrix<f64>| (a - b).largest() < 1e-10 * b.largest();
    assert!(near(&fit.inverse_gram, &spread), "{} {spread}", fit.inverse_gram);
    assert!(near(&fit.residual_covariance, &variance), "{} {variance}", fit.residual_covariance);
}

#[test]
fn of_readings_at_rest() {
    let table = table();
    let at_rest = |i: usize| table.loads.row(i).amax() == 0.0;
    let count =
        |group: usize| (0..SAMPLES).filter(|i| table.groups[*i] == group && at_rest(*i)).count() as f64;
    let share = |_: usize, j: usize| if at_rest(j) { 1.0 / count(table.groups[j]) } else { 0.0 };
    check(&table, &table, (true, false), share);
    // A constant is pulled by the zeros as well, and at rest by these alone.
    check(&table, &table, (true, true), share);
}

#[test]
fn of_all_readings() {
    let table = table();
    let weights = table.weights.clone().unwrap();
    let total = |group: usize| -> f64 {
        (0..SAMPLES).filter(|i| table.groups[*i] == group).map(|i| weights[i]).sum()
    };
    check(&table, &table.centred_by_group(), (false, false), |_, j| weights[j] / total(table.groups[j]));
}

/// A sample of no weight, or one that RANSAC does not believe, is as if it were not there.
#[test]
fn of_samples_that_do_not_count() {
    let table = table();
    let expected = calibrate(&table.select(|i| i != 5), &options(true, false)).unwrap().model.fit;
    let same = |table: &LoadTable, options: &Options| {
        let fit = calibrate(table, options).unwrap().model.fit;
        assert!((&fit.coefficients - &expected.coefficients).largest() < 1e-12);
        assert!((&fit.inverse_gram - &expected.inverse_gram).largest() < 1e-12);
        assert!((&fit.residual_covariance - &expected.residual_covariance).largest() < 1e-12);
    };
    let mut light = table.clone();
    light.weights.as_mut().unwrap()[5] = 0.0;
    same(&light, &options(true, false));
    let mut wrong = table;
    wrong.signals[(5, 1)] += 30.0;
    let method = Method::Ransac { outliers: 0.2, seed: 1 };
    same(&wrong, &Options { method, ..options(true, false) });
}
