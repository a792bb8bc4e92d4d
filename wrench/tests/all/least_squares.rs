//! Extended sensors: least squares, what redundancy tells, and what it does not.

use crate::support::{
    cast, generator, greatest, normal, of_condition, random_vector, sensor, symmetric, wide,
};
use fingertip_wrench::{
    BadCheck, ConsistencyCheck, DriftMonitor, Fault, GaussianElimination, LeastSquares, LeastSquaresError,
    Real, SensorMatrix, Verdict, WrenchSolver, singular_values,
};
use nalgebra::{SMatrix, SVector, Vector6};
use rand::RngExt;

/// The residual of a least-squares solution is orthogonal to every column, in the weighted sense.
fn optimal<T: Real>(condition: f64, decades: f64) {
    let mut random = generator(50);
    for _ in 0..300 {
        let sensor = sensor::<T, 9>(&of_condition::<9>(&mut random, condition));
        let deviations = SVector::<f64, 9>::from_fn(|_, _| 10.0_f64.powf(decades * symmetric(&mut random)));
        let solver = LeastSquares::weighted(&sensor, &cast(&deviations)).expect("regular");
        let signals: SVector<T, 9> = cast(&random_vector::<9>(&mut random).component_mul(&deviations));
        let loads = wide(&solver.solve(&signals).components().component_div(sensor.nominal()));
        let matrix = wide(sensor.normalised());
        let residual = wide(&signals) - matrix * loads;
        let whitened = SMatrix::<f64, 9, 6>::from_fn(|i, j| matrix[(i, j)] / deviations[i]);
        let whitened_residual = residual.component_div(&deviations);
        let gradient = whitened.transpose() * whitened_residual;
        let whitened_signals = wide(&signals).component_div(&deviations).norm();
        let values = singular_values(&whitened);
        let tolerance = 20.0 * values[0] / values[5] * T::EPSILON.to_f64() * whitened_signals;
        assert!(gradient.norm() <= tolerance * values[0], "{}", gradient.norm());
        let reported = wide(&solver.residual(&signals));
        let off = (reported - residual).component_div(&deviations).norm();
        assert!(off <= tolerance, "{off}");
    }
}

#[test]
fn residual_is_orthogonal_to_what_loads_cause() {
    optimal::<f64>(10.0, 2.0);
    optimal::<f64>(1e4, 2.0);
    optimal::<f32>(10.0, 0.5);
}

#[test]
fn six_gauges_are_solved_as_by_elimination() {
    let mut random = generator(51);
    for _ in 0..1_000 {
        let sensor = sensor::<f64, 6>(&of_condition::<6>(&mut random, 100.0));
        let least_squares = LeastSquares::new(&sensor).expect("regular");
        let gauss = GaussianElimination::new(&sensor).expect("regular");
        let signals = random_vector::<6>(&mut random);
        let (a, b) = (least_squares.solve(&signals).components(), gauss.solve(&signals).components());
        assert!((a - b).component_div(sensor.nominal()).norm() < 1e-11 * signals.norm() * 100.0);
        assert!(greatest(&least_squares.residual(&signals)) < 1e-14 * signals.norm());
        assert!((0..6).all(|gauge| least_squares.solve_without(&signals, gauge).is_none()));
    }
}

/// What elimination refuses least squares refuses too: one criterion, of two inverses, which near it are known
/// to a quarter of their size or so.
fn refused_alike<T: Real>() {
    let mut random = generator(57);
    let limit = 1.0 / (8.0 * T::EPSILON.to_f64());
    let (mut accepted, mut refused) = (0, 0);
    for _ in 0..3_000 {
        let condition = limit * 10.0_f64.powf(2.0 * symmetric(&mut random));
        let sensor = sensor::<T, 6>(&of_condition::<6>(&mut random, condition));
        let gauss = GaussianElimination::new(&sensor).is_ok();
        let least_squares = LeastSquares::new(&sensor).is_ok();
        // Skeel's number is at most √6 times 6 times N_c, and seldom less than a tenth of it.
        if condition > 30.0 * limit {
            assert!(!gauss && !least_squares, "{condition:e}");
            refused += 1;
        } else if condition < limit / 30.0 {
            assert!(gauss && least_squares, "{condition:e}");
            accepted += 1;
        }
    }
    assert!(accepted > 300 && refused > 300);
}

#[test]
fn singular_means_the_same_to_both_solvers() {
    refused_alike::<f64>();
    refused_alike::<f32>();
}

/// Normal equations would lose all digits here.
#[test]
fn a_bad_condition_costs_its_digits_once() {
    let mut random = generator(52);
    for _ in 0..200 {
        let sensor = sensor::<f64, 8>(&of_condition::<8>(&mut random, 1e10));
        let solver = LeastSquares::new(&sensor).expect("regular");
        let load = random_vector::<6>(&mut random);
        let signals = sensor.normalised() * load;
        let found = solver.solve(&signals).components().component_div(sensor.nominal());
        assert!((found - load).norm() < 1e10 * 50.0 * f64::EPSILON * load.norm());
    }
}

#[test]
fn without_a_gauge_is_the_sensor_without_it() {
    let mut random = generator(53);
    for _ in 0..300 {
        let sensor = sensor::<f64, 9>(&of_condition::<9>(&mut random, 10.0));
        let deviations = SVector::<f64, 9>::from_fn(|_, _| random.random_range(0.1..10.0));
        let solver = LeastSquares::weighted(&sensor, &deviations).expect("regular");
        let signals = random_vector::<9>(&mut random);
        for gauge in 0..9 {
            let smaller =
                SensorMatrix::new(sensor.normalised().remove_row(gauge), *sensor.nominal()).expect("proper");
            let reduced = LeastSquares::weighted(&smaller, &deviations.remove_row(gauge)).expect("regular");
            let expected = reduced.solve(&signals.remove_row(gauge)).components();
            let mut broken = signals;
            broken[gauge] = f64::NAN;
            let found = solver.solve_without(&broken, gauge).expect("redundant").components();
            let difference = (found - expected).component_div(sensor.nominal()).norm();
            assert!(difference < 1e-10 / solver.redundancy(gauge), "{difference}");
            let predicted = (smaller.normalised(), reduced.solve(&signals.remove_row(gauge)));
            let row = sensor.normalised().row(gauge);
            let reading = (row * predicted.1.components().component_div(sensor.nominal()))[0];
            let error = (solver.predicted(&broken, gauge).expect("redundant") - reading).abs();
            assert!(error < 1e-10 / solver.redundancy(gauge), "{error}");
        }
    }
}

#[test]
fn a_gauge_that_nothing_replaces_is_known() {
    // Gauge 7 alone feels the last axis.
    let mut matrix = SMatrix::<f64, 8, 6>::zeros();
    for i in 0..8 {
        matrix[(i, i % 5)] = 1.0 + i as f64 * 0.1;
    }
    matrix[(7, 2)] = 0.3;
    matrix[(7, 5)] = 1.0;
    let sensor = SensorMatrix::new(matrix, Vector6::repeat(1.0)).expect("proper");
    let solver = LeastSquares::new(&sensor).expect("regular");
    let signals = SVector::<f64, 8>::repeat(1.0);
    assert_eq!(solver.redundancy(7), 0.0);
    assert_eq!((solver.predicted(&signals, 7), solver.solve_without(&signals, 7)), (None, None));
    assert!(solver.redundancy(0) > 0.1 && solver.solve_without(&signals, 0).is_some());
    assert_eq!((solver.redundancy(99), solver.predicted(&signals, 99)), (0.0, None));
}

fn unusable<T: Real>() {
    let mut random = generator(54);
    let regular = of_condition::<8>(&mut random, 10.0);
    for axis in 0..6 {
        let mut matrix = regular;
        let copy = matrix.column((axis + 2) % 6) * 3.0;
        matrix.set_column(axis, &copy);
        let error = LeastSquares::new(&sensor::<T, 8>(&matrix)).err();
        let candidates = [axis, (axis + 2) % 6].map(|axis| Some(LeastSquaresError::DependentAxis { axis }));
        assert!(candidates.contains(&error), "{error:?}");
    }
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let mut deviations = SVector::<T, 8>::repeat(T::one());
        deviations[3] = T::literal(bad);
        let error = LeastSquares::weighted(&sensor::<T, 8>(&regular), &deviations).err();
        assert_eq!(error, Some(LeastSquaresError::BadDeviation { gauge: 3 }));
    }
}

#[test]
fn dependent_axes_and_bad_weights_are_refused() {
    unusable::<f32>();
    unusable::<f64>();
}

const NOISE: f64 = 1e-3;

fn watched<const N: usize>(seed: u128) -> (SensorMatrix<f64, N>, LeastSquares<f64, N>) {
    let sensor = sensor::<f64, N>(&of_condition::<N>(&mut generator(seed), 3.0));
    let solver = LeastSquares::new(&sensor).expect("regular");
    (sensor, solver)
}

fn reading<const N: usize>(
    random: &mut rand_pcg::Pcg64Mcg,
    sensor: &SensorMatrix<f64, N>,
) -> SVector<f64, N> {
    let load = random_vector::<6>(random);
    sensor.normalised() * load + SVector::<f64, N>::from_fn(|_, _| NOISE * normal(random))
}

#[test]
fn false_alarms_are_as_rare_as_stated() {
    const SAMPLES: usize = 200_000;
    let mut random = generator(55);
    let (sensor, solver) = watched::<10>(56);
    let check = ConsistencyCheck::new(&solver, &SVector::repeat(NOISE), 0.01).expect("valid");
    let alarms = (0..SAMPLES)
        .filter(|_| check.verdict(&solver, &reading(&mut random, &sensor)) != Verdict::Consistent)
        .count();
    let rate = alarms as f64 / SAMPLES as f64;
    println!("false alarms: {rate} of 0.01");
    // Bonferroni's bound is an upper one, and residuals hang together.
    assert!(rate <= 0.01 * 1.05 && rate > 0.003, "{rate}");
}

#[test]
fn a_faulty_gauge_is_found_and_named() {
    let mut random = generator(57);
    let (sensor, solver) = watched::<12>(58);
    let range = SVector::<f64, 12>::repeat(0.9);
    let check = ConsistencyCheck::new(&solver, &SVector::repeat(NOISE), 1e-4)
        .expect("valid")
        .with_range(-range, range);
    let mut found = [0; 4];
    const TRIALS: usize = 5_000;
    for _ in 0..TRIALS {
        let gauge = random.random_range(0..12);
        let sound = reading(&mut random, &sensor) * 0.3;
        for (kind, (value, expected)) in [
            (0.0, Fault::Dead),
            (0.9, Fault::Saturated),
            (sound[gauge] + 0.2, Fault::Deviating),
            (f64::NAN, Fault::NotFinite),
        ]
        .into_iter()
        .enumerate()
        {
            let mut signals = sound;
            signals[gauge] = value;
            let big = !((value - sound[gauge]).abs() < 20.0 * NOISE / solver.redundancy(gauge));
            match check.verdict(&solver, &signals) {
                Verdict::Faulty { gauge: named, fault, error } if named == gauge => {
                    assert!(
                        fault == expected || value.abs() >= 0.9 || value.abs() < 5.0 * NOISE,
                        "{fault:?}"
                    );
                    if value.is_finite() {
                        let tolerance = 10.0 * NOISE / solver.redundancy(gauge);
                        assert!((error - (value - sound[gauge])).abs() < tolerance);
                    }
                    found[kind] += 1;
                }
                Verdict::Faulty { gauge: wrong, .. } => {
                    assert!(!big, "gauge {wrong} named for {gauge}");
                }
                Verdict::Consistent => assert!(!big),
                Verdict::Ambiguous { suspects } => assert!(suspects[gauge]),
                Verdict::Inconsistent => {}
            }
        }
    }
    println!("named, of {TRIALS} each: dead, saturated, deviating, not finite: {found:?}");
    assert!(found.iter().all(|n| *n > TRIALS * 8 / 10), "{found:?}");
}

#[test]
fn seven_gauges_see_a_fault_but_not_whose() {
    let mut random = generator(59);
    let (sensor, solver) = watched::<7>(60);
    let check = ConsistencyCheck::new(&solver, &SVector::repeat(NOISE), 1e-4).expect("valid");
    for _ in 0..500 {
        let mut signals = reading(&mut random, &sensor);
        signals[3] += 1.0;
        match check.verdict(&solver, &signals) {
            Verdict::Ambiguous { suspects } => assert!(suspects[3]),
            other => panic!("{other:?}"),
        }
    }
}

#[test]
fn two_faults_are_not_blamed_on_one_gauge() {
    let mut random = generator(61);
    let (sensor, solver) = watched::<12>(62);
    let check = ConsistencyCheck::new(&solver, &SVector::repeat(NOISE), 1e-4).expect("valid");
    for _ in 0..500 {
        let mut signals = reading(&mut random, &sensor);
        signals[3] += 1.0;
        signals[8] -= 0.8;
        assert_eq!(check.verdict(&solver, &signals), Verdict::Inconsistent);
        signals[3] = f64::NAN;
        assert_eq!(check.verdict(&solver, &signals), Verdict::Inconsistent);
        signals[8] = f64::INFINITY;
        assert_eq!(check.verdict(&solver, &signals), Verdict::Inconsistent);
    }
}

#[test]
fn slow_drift_shows_in_the_mean_before_it_shows_in_a_sample() {
    let mut random = generator(63);
    let (sensor, solver) = watched::<12>(64);
    let noise = SVector::repeat(NOISE);
    let check = ConsistencyCheck::new(&solver, &noise, 1e-4).expect("valid");
    let mut monitor = DriftMonitor::new(&solver, &noise, 0.01, 1e-4).expect("valid");
    let mut alarms = 0;
    for _ in 0..5_000 {
        let verdict = monitor.update(&solver, &reading(&mut random, &sensor));
        alarms += usize::from(!matches!(verdict, None | Some(Verdict::Consistent)));
    }
    assert!(alarms < 50, "{alarms}");
    // Two standard deviations of a sample: a single sample seldom shows that.
    let (mut named, mut single) = (None, 0);
    for _ in 0..2_000 {
        let mut signals = reading(&mut random, &sensor);
        signals[5] += 2.0 * NOISE;
        single += usize::from(check.verdict(&solver, &signals) != Verdict::Consistent);
        if let Some(Verdict::Faulty { gauge, fault, error }) = monitor.update(&solver, &signals) {
            named = Some((gauge, fault));
            assert!(gauge != 5 || (error / NOISE - 2.0).abs() < 1.5);
        }
        monitor.update(&solver, &SVector::repeat(f64::NAN));
    }
    assert_eq!(named.map(|(gauge, _)| gauge), Some(5));
    assert!(single < 100, "{single}");
}

#[test]
fn bad_thresholds_are_refused() {
    let (_, solver) = watched::<8>(65);
    let noise = SVector::repeat(NOISE);
    for rate in [0.0, 1.0, -0.1, f64::NAN] {
        assert_eq!(ConsistencyCheck::new(&solver, &noise, rate), Err(BadCheck::BadRate));
    }
    let mut bad = noise;
    bad[6] = 0.0;
    assert_eq!(ConsistencyCheck::new(&solver, &bad, 0.01), Err(BadCheck::BadNoise { gauge: 6 }));
    for weight in [0.0, 1.5, f64::NAN] {
        assert!(DriftMonitor::new(&solver, &noise, weight, 0.01).is_err());
    }
}
