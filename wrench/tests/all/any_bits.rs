//! Whatever the bits: constructors answer, and what they build stays within numbers.

use fingertip_wrench::{
    BicchiDario, Compensation, Conditioning, ConsistencyCheck, Decoupled, ErrorBound, GaussianElimination,
    Inverse, LeastSquares, Real, Refined, RestTest, SensorMatrix, ThreeRosettes, Uncertainty, Wrench,
    WrenchCovariance, WrenchSolver, singular_values,
};
use nalgebra::{Matrix6, SMatrix, SVector, Vector6};
use proptest::prelude::*;
use proptest::test_runner::RngAlgorithm;

/// Any bits at all; or numbers of a size, so that solvers are built often enough.
fn number64() -> impl Strategy<Value = f64> {
    prop_oneof![
        2 => any::<u64>().prop_map(f64::from_bits),
        6 => -1.0..1.0_f64,
        1 => Just(0.0),
        1 => (-300..300_i32, -1.0..1.0_f64).prop_map(|(e, x)| x * 10.0_f64.powi(e)),
    ]
}

/// Mostly one scale for a whole matrix, with a few entries of any kind.
fn entries<const COUNT: usize>() -> impl Strategy<Value = [f64; COUNT]> {
    let ordinary = (-290..290_i32, prop::array::uniform(-1.0..1.0_f64))
        .prop_map(|(e, x): (i32, [f64; COUNT])| x.map(|x| x * 10.0_f64.powi(e)));
    let spoiled = (prop::array::uniform(-1.0..1.0_f64), 0..COUNT, number64()).prop_map(
        |(mut x, at, bad): ([f64; COUNT], usize, f64)| {
            x[at] = bad;
            x
        },
    );
    prop_oneof![3 => ordinary, 3 => spoiled, 1 => prop::array::uniform(number64())]
}

fn check_solver<T: Real, const N: usize>(
    sensor: &SensorMatrix<T, N>,
    solver: &impl WrenchSolver<T, N>,
    signals: &SVector<T, N>,
) {
    assert_eq!(solver.solve(&SVector::zeros()).components(), Vector6::zeros());
    let wrench = solver.solve(signals);
    if wrench.is_finite() {
        // What a wrench in range says of signals is of one kind with them.
        assert!(signals.iter().all(|x| x.is_number()) || N > 6);
    }
    let noise = SVector::repeat(T::literal(1e-3));
    if let Ok(bound) = ErrorBound::new(sensor, solver, &Uncertainty::of_signals(noise)) {
        let error = bound.at(&SVector::zeros(), &Wrench::zero());
        assert!(error.iter().all(|x| *x >= T::zero()), "{error}");
        assert!(bound.floor().iter().all(|x| x.is_number()));
    }
    if let Ok(covariance) = WrenchCovariance::from_noise(sensor, solver, &noise) {
        assert!(covariance.floor().diagonal().iter().all(|x| *x >= T::zero() && x.is_number()));
        let _ = covariance.at(&wrench);
    }
}

fn check<T: Real>(matrix: &[f64; 48], nominal: &[f64; 6], signals: &[f64; 8]) {
    let wide = SMatrix::<T, 8, 6>::from_fn(|i, j| T::literal(matrix[6 * i + j]));
    let nominal = Vector6::from_fn(|i, _| T::literal(nominal[i]));
    let signals = SVector::<T, 8>::from_fn(|i, _| T::literal(signals[i]));
    let _ = singular_values(&wide);
    let six: Matrix6<T> = wide.fixed_rows::<6>(0).into_owned();
    let signals6: Vector6<T> = signals.fixed_rows::<6>(0).into_owned();
    if let Ok(sensor) = SensorMatrix::new(six, nominal) {
        let conditioning = Conditioning::of(&sensor);
        assert!(!(conditioning.condition_number() < T::one() - T::EPSILON * T::literal(8.0)));
        let _ = conditioning.relative_error_bound(T::literal(0.01), T::literal(0.01));
        if let Ok(solver) = GaussianElimination::new(&sensor) {
            check_solver(&sensor, &solver, &signals6);
        }
        if let Ok(solver) = Inverse::new(&sensor) {
            check_solver(&sensor, &solver, &signals6);
        }
        if let Ok(solver) = Refined::new(&sensor) {
            assert!((1..=Refined::<T>::MAX_STEPS).contains(&solver.steps()));
            check_solver(&sensor, &solver, &signals6);
        }
        if let Ok(solver) = Decoupled::<T, BicchiDario, 6>::new(&sensor) {
            check_solver(&sensor, &solver, &signals6);
        }
        if let Ok(solver) = Decoupled::<T, ThreeRosettes, 6>::new(&sensor) {
            check_solver(&sensor, &solver, &signals6);
        }
    }
    let _ = SensorMatrix::from_inverse(&six, nominal);
    if let Ok(sensor) = SensorMatrix::new(wide, nominal) {
        let _ = Conditioning::of(&sensor);
        for solver in
            [LeastSquares::new(&sensor), LeastSquares::weighted(&sensor, &signals)].into_iter().flatten()
        {
            check_solver(&sensor, &solver, &signals);
            for gauge in 0..9 {
                let _ = solver.solve_without(&signals, gauge);
            }
            if let Ok(check) = ConsistencyCheck::new(&solver, &SVector::repeat(T::literal(1e-3)), 0.01) {
                let _ = check.verdict(&solver, &signals);
            }
        }
    }
}

proptest! {
    // A choice starts a generator for every alternative, which is most of the time where the generator is ChaCha.
    #![proptest_config(ProptestConfig {
        cases: 2_000,
        rng_algorithm: RngAlgorithm::XorShift,
        ..ProptestConfig::default()
    })]

    #[test]
    fn constructors_and_solvers_survive_any_bits(
        matrix in entries::<48>(),
        nominal in prop_oneof![3 => prop::array::uniform6(0.1..100.0_f64), 1 => prop::array::uniform6(number64())],
        signals in prop::array::uniform8(number64()),
    ) {
        check::<f64>(&matrix, &nominal, &signals);
        check::<f32>(&matrix, &nominal, &signals);
    }

    #[test]
    fn rest_test_survives_any_bits(readings in prop::collection::vec(prop::array::uniform2(number64()), 0..80)) {
        let mut test = RestTest::<f64, 2>::new(0.01).expect("valid");
        for reading in &readings {
            test.add(&SVector::from(*reading));
        }
        if let Ok(rested) = test.finish() {
            let numbers = rested.tare.zero().iter().chain(&rested.noise).chain(&rested.tare_noise);
            assert!(numbers.copied().all(f64::is_finite), "{rested:?}");
            assert!(rested.tare.compensate(&SVector::zeros()).iter().all(|x| x.is_finite()));
        }
    }
}
