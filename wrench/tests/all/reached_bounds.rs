//! Bounds are reached: errors of the worst signs come as near to them as the terms of second order let them.

use crate::support::{generator, greatest, of_condition, sensor, wide};
use fingertip_wrench::{
    BicchiDario, Combination, Decoupled, ErrorBound, GaussianElimination, Inverse, LeastSquares, Refined,
    SensorMatrix, Uncertainty, Wrench, WrenchSolver,
};
use nalgebra::{Matrix6, SMatrix, SVector, Vector6};

/// Least and greatest share of the bound that the worst errors make, over sensors, loads and axes.
///
/// `noise` and `fraction` are relative to the largest entry of the matrix and of its columns. With
/// `S = C⁻¹` and the true sensor `C + dC`, the error is `S (dC P + dV)`: on axis `i` it is greatest where
/// every `dC` and `dV` has the sign of `S[i, ·]` and of its load.
fn reached<const N: usize, S: WrenchSolver<f64, N>>(
    noise: f64,
    fraction: f64,
    build: impl Fn(&SensorMatrix<f64, N>) -> S,
) -> (f64, f64) {
    let mut random = generator(120);
    let (mut least, mut greatest) = (f64::INFINITY, 0.0_f64);
    for _ in 0..50 {
        let sensor = sensor::<f64, N>(&of_condition::<N>(&mut random, 10.0));
        let solver = build(&sensor);
        let matrix = wide(sensor.normalised());
        let inverse = solver.linear_map(&sensor).expect("linear").gain;
        let noise = noise * matrix.amax();
        let uncertainty =
            Uncertainty::of_signals(SVector::repeat(noise)).with_relative_matrix_error(&sensor, fraction);
        let bound = ErrorBound::new(&sensor, &solver, &uncertainty).expect("bounded");
        let load = crate::support::random_vector::<6>(&mut random);
        for axis in 0..6 {
            let sign = |gauge: usize| inverse[(axis, gauge)].signum();
            let error = SMatrix::<f64, N, 6>::from_fn(|gauge, column| {
                fraction * matrix.column(column).amax() * sign(gauge) * load[column].signum()
            });
            let off = SVector::<f64, N>::from_fn(|gauge, _| noise * sign(gauge));
            let signals = (matrix + error) * load + off;
            let found = solver.solve(&signals);
            let true_load = load.component_mul(sensor.nominal());
            let share = (found.components() - true_load)[axis].abs() / bound.at(&signals, &found)[axis];
            // The test itself rounds the signals.
            assert!(share <= 1.0 + 1e-12, "{share}");
            (least, greatest) = (least.min(share), greatest.max(share));
        }
    }
    (least, greatest)
}

fn check<const N: usize, S: WrenchSolver<f64, N>>(build: impl Fn(&SensorMatrix<f64, N>) -> S) {
    // The noise of signals: rounding is ten orders of magnitude less.
    let (least, _) = reached(1e-3, 0.0, &build);
    assert!(least > 1.0 - 1e-9, "noise reaches {least} of the bound");
    // The matrix: to second order, of six times a condition number of 10 times the error.
    let (least, _) = reached(0.0, 1e-6, &build);
    assert!(least > 1.0 - 1e-3, "the matrix reaches {least} of the bound");
    let (least, _) = reached(1e-3, 1e-6, &build);
    assert!(least > 1.0 - 1e-3, "both reach {least} of the bound");
}

#[test]
fn worst_errors_reach_the_bound_of_every_solver() {
    check::<6, _>(|sensor| GaussianElimination::new(sensor).expect("regular"));
    check::<6, _>(|sensor| Inverse::new(sensor).expect("regular"));
    check::<6, _>(|sensor| Refined::new(sensor).expect("regular"));
    check::<9, _>(|sensor| LeastSquares::new(sensor).expect("regular"));
    let weights = SVector::<f64, 9>::from_fn(|i, _| 1.0 + i as f64);
    check::<9, _>(|sensor| LeastSquares::weighted(sensor, &weights).expect("regular"));
}

/// What a decoupled solver neglects, the load of the neglected axis brings out in full.
#[test]
fn neglected_couplings_reach_the_bound() {
    let combination = Matrix6::from_fn(|i, j| BicchiDario::MATRIX[i][j]);
    let coupled = |i: usize, j: usize| !BicchiDario::KEPT[i][j];
    for i in 0..6 {
        for j in (0..6).filter(|j| coupled(i, *j)) {
            for coupling in [1e-4, -1e-4] {
                // The combined matrix is the identity but for one entry that is to be neglected.
                let mut wanted = Matrix6::identity();
                wanted[(i, j)] = coupling;
                let matrix = combination.try_inverse().expect("independent") * wanted;
                let nominal = Vector6::new(32.0, 16.0, 8.0, 0.25, 0.5, 0.125);
                let sensor = SensorMatrix::new(matrix, nominal).expect("proper");
                let solver = Decoupled::<f64, BicchiDario, 6>::new(&sensor).expect("decoupled");
                let mut neglected = Matrix6::zeros();
                neglected[(i, j)] = coupling.abs();
                assert!(greatest(&(solver.neglected() - neglected)) < 1e-14, "{}", solver.neglected());
                let bound = ErrorBound::new(&sensor, &solver, &Uncertainty::none()).expect("bounded");
                let mut load = Vector6::zeros();
                load[j] = nominal[j];
                let signals = sensor.signals(&Wrench::from_components(&load));
                let found = WrenchSolver::solve(&solver, &signals);
                let off = (found.components() - load)[i];
                assert!((off / (coupling * nominal[i]) - 1.0).abs() < 1e-10, "{off}");
                let share = off.abs() / bound.at(&signals, &found)[i];
                assert!((1.0 - 1e-3..=1.0).contains(&share), "{share}");
            }
        }
    }
}

/// The floor is the bound without load, and each part grows in proportion.
#[test]
fn bounds_grow_in_proportion() {
    let mut random = generator(121);
    for _ in 0..20 {
        let sensor = sensor::<f64, 6>(&of_condition::<6>(&mut random, 10.0));
        let solver = Inverse::new(&sensor).expect("regular");
        let magnitude = solver.linear_map(&sensor).expect("linear").gain.abs();
        let deviations = Vector6::from_fn(|i, _| 1e-3 * (1 + i) as f64);
        let bound = ErrorBound::new(&sensor, &solver, &Uncertainty::of_signals(deviations)).expect("bounded");
        let wanted = (magnitude * deviations).component_mul(sensor.nominal());
        assert!(greatest(&bound.floor().component_div(&wanted).add_scalar(-1.0)) < 1e-9);
        assert_eq!(bound.at(&Vector6::zeros(), &Wrench::zero()), *bound.floor());
        // Twice the uncertainty is twice the floor; another unit of load changes nothing but the unit.
        let twice = Uncertainty::of_signals(deviations * 2.0);
        let twice = ErrorBound::new(&sensor, &solver, &twice).expect("bounded");
        assert!(greatest(&(twice.floor() - bound.floor() * 2.0)) < 1e-14 * greatest(bound.floor()));
        let uncertain = Uncertainty::none().with_relative_matrix_error(&sensor, 1e-3);
        for axis in 0..6 {
            assert_eq!(uncertain.matrix.column(axis).amin(), sensor.normalised().column(axis).amax() * 1e-3);
            assert_eq!(uncertain.matrix.column(axis).amax(), uncertain.matrix.column(axis).amin());
        }
        assert_eq!(uncertain.signals, Vector6::zeros());
        let bound = ErrorBound::new(&sensor, &solver, &uncertain).expect("bounded");
        let load = crate::support::random_vector::<6>(&mut random).component_mul(sensor.nominal());
        let wrench: Wrench<f64> = Wrench::from_components(&load);
        let at = |wrench: &Wrench<f64>| bound.at(&Vector6::zeros(), wrench);
        let one = at(&wrench);
        assert!(greatest(&(at(&(wrench * -3.0)) - one * 3.0)) < 1e-14 * greatest(&one) * 3.0);
    }
}
