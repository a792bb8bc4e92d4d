//! Where a matrix stops being solvable, and how many steps refinement takes: against what can be counted.

use crate::support::{cast, generator, greatest, of_condition};
use fingertip_wrench::{
    BadCovariance, BadInverse, BicchiDario, Combination, Conditioning, Decoupled, ErrorBound,
    GaussianElimination, Inverse, LeastSquares, LeastSquaresError, NoErrorBound, NotDecoupled, Real, Refined,
    SensorMatrix, SensorMatrixError, SingularMatrix, Uncertainty, Wrench, WrenchCovariance, WrenchSolver,
};
use nalgebra::{Matrix6, SMatrix, SVector, Vector6};

/// The identity but for two rows that differ by `δ`: Skeel's number is `(4 + 3δ)/δ`, and no entry rounds.
fn nearly_alike<T: Real>(delta: T) -> SensorMatrix<T, 6> {
    let mut matrix = Matrix6::identity();
    (matrix[(1, 4)], matrix[(4, 1)]) = (T::one(), T::one());
    matrix[(4, 4)] += delta;
    SensorMatrix::new(matrix, Vector6::repeat(T::one())).expect("proper")
}

fn skeels_limit<T: Real>() {
    // 1/(8ε) is passed where δ is 32ε.
    for (units, regular) in [(1, false), (16, false), (31, false), (33, true), (128, true)] {
        let delta = T::EPSILON * T::literal(f64::from(units));
        let sensor = nearly_alike(delta);
        let found = [
            GaussianElimination::new(&sensor).err(),
            Inverse::new(&sensor).err(),
            Refined::new(&sensor).err(),
        ];
        for error in found {
            match error {
                None => assert!(regular, "{units}"),
                Some(SingularMatrix::DependentGauge { gauge, pivot }) => {
                    assert!(!regular && (gauge == 1 || gauge == 4), "{units}: {gauge}");
                    // What is left of the row, once the other is taken out.
                    assert!((pivot / delta.to_f64() - 1.0).abs() < 1e-6, "{units}: {pivot}");
                }
                Some(other) => panic!("{units}: {other}"),
            }
        }
        // The inverse by least squares is known to a few units only.
        if units <= 16 || units >= 128 {
            let error = LeastSquares::new(&sensor).err();
            assert_eq!(error.is_none(), regular, "{units}: {error:?}");
        }
        if units == 33 {
            // Each solve may be all wrong: no number of steps is enough, and no more than the most are taken.
            assert_eq!(Refined::new(&sensor).map(|solver| solver.steps()), Ok(Refined::<T>::MAX_STEPS));
        }
        if units >= 128 {
            let skeel = Conditioning::of(&sensor).skeel.expect("regular").to_f64();
            let wanted = (4.0 + 3.0 * delta.to_f64()) / delta.to_f64();
            assert!((skeel / wanted - 1.0).abs() < 0.5, "{skeel} {wanted}");
        }
    }
}

#[test]
fn a_matrix_is_singular_from_skeels_limit_on() {
    skeels_limit::<f32>();
    skeels_limit::<f64>();
}

/// Five columns that differ by `δ` each, and one of its own. What is left of the last of the five is `1.1 δ`, with
/// which the factorisation is content from 48ε on; Skeel's number is `8/δ`, which is too much up to 64ε.
fn crowded<T: Real>() {
    for (units, regular) in [(46, false), (200, true)] {
        let delta = T::EPSILON * T::literal(f64::from(units));
        let mut matrix = Matrix6::<T>::identity();
        for i in 1..6 {
            for j in 1..6 {
                matrix[(i, j)] = if i == j { T::one() + delta } else { T::one() };
            }
        }
        let sensor = SensorMatrix::new(matrix, Vector6::repeat(T::one())).expect("proper");
        match LeastSquares::new(&sensor) {
            Ok(_) => assert!(regular, "{units}"),
            Err(LeastSquaresError::DependentAxis { axis }) => {
                assert!(!regular && axis > 0, "{units}: {axis}")
            }
            Err(other) => panic!("{other}"),
        }
        assert_eq!(GaussianElimination::new(&sensor).is_ok(), regular, "{units}");
    }
}

#[test]
fn columns_that_crowd_are_dependent_by_skeels_number() {
    crowded::<f32>();
    crowded::<f64>();
}

/// As many steps as the bound of one solve asks for, and no more.
fn steps<T: Real>(conditions: &[f64]) -> Vec<u8> {
    let mut random = generator(160);
    let mut counts = Vec::new();
    for condition in conditions {
        for _ in 0..20 {
            // Equilibrated already, so that the bound of the solver inside is that of one outside.
            let matrix = cast::<T, 6, 6>(&of_condition::<6>(&mut random, *condition));
            let mut matrix = matrix;
            for mut column in matrix.column_iter_mut() {
                let factor = column.amax().normalising_factor();
                column *= factor;
            }
            for mut row in matrix.row_iter_mut() {
                let factor = row.amax().normalising_factor();
                row *= factor;
            }
            if !matrix.column_iter().all(|column| (1.0..2.0).contains(&column.amax().to_f64())) {
                continue;
            }
            let sensor = SensorMatrix::new(matrix, Vector6::repeat(T::one())).expect("proper");
            let left = GaussianElimination::new(&sensor)
                .expect("regular")
                .linear_map(&sensor)
                .expect("linear")
                .own_error
                .per_load;
            let left = greatest(&left.column_sum());
            let enough = (1..=8).find(|steps| left.powi(*steps) <= T::EPSILON.to_f64() / 8.0).unwrap_or(8);
            let steps = Refined::new(&sensor).expect("regular").steps();
            assert_eq!(i32::from(steps), enough, "{left:e}");
            counts.push(steps);
        }
    }
    counts
}

#[test]
fn refinement_takes_the_steps_that_it_needs() {
    let wide = steps::<f64>(&[1.0, 1e3, 1e6, 1e9, 1e11, 1e12]);
    let narrow = steps::<f32>(&[1.0, 1e2, 1e3, 1e4, 3e4]);
    for counts in [wide, narrow] {
        assert!(counts.iter().min() == Some(&2) && counts.iter().max() >= Some(&4), "{counts:?}");
    }
    assert_eq!(Refined::<f64>::MAX_STEPS, 8);
}

/// Matrices and loads that leave the range once they are multiplied are refused, and those within solved.
#[test]
fn what_leaves_the_range_is_refused() {
    let of = |entry: f64, nominal: f64| {
        SensorMatrix::new(Matrix6::from_diagonal_element(entry), Vector6::repeat(nominal)).expect("proper")
    };
    for (entry, nominal) in [(1e300, 1e100), (1e-300, 1.0), (1e-100, 1e200), (1e308, 1e10), (1e-300, 1e-300)]
    {
        let sensor = of(entry, nominal);
        let gauss = GaussianElimination::new(&sensor).expect("in range");
        let load = gauss.solve(&Vector6::repeat(entry)).components();
        assert!((load / nominal - Vector6::repeat(1.0)).iter().all(|x| x.abs() < 1e-15), "{load}");
        // So does a refined one, whose bound and inverse may overflow only in what is not asked for.
        if let Ok(refined) = Refined::new(&sensor) {
            assert!(
                (refined.solve(&Vector6::repeat(entry)).components() / nominal)
                    .iter()
                    .all(|x| (x - 1.0).abs() < 1e-15)
            );
        }
    }
    for (entry, nominal) in [(1e-300, 1e10), (1e300, 1e-10 * 1e-300), (1e-310, 1e300)] {
        let sensor = of(entry, nominal);
        assert_eq!(
            GaussianElimination::new(&sensor).err(),
            Some(SingularMatrix::OutOfRange),
            "{entry:e} {nominal:e}"
        );
        assert_eq!(Refined::new(&sensor).err(), Some(SingularMatrix::OutOfRange));
        assert!(Inverse::new(&sensor).is_err());
    }
    // Newtons per signal alone beyond the range, of a gauge that is faint.
    let mut faint = Matrix6::identity();
    (faint[(0, 5)], faint[(5, 5)]) = (1.0, 1e-200);
    let faint = SensorMatrix::new(faint, Vector6::repeat(1e150)).expect("proper");
    assert!(GaussianElimination::new(&faint).is_ok());
    assert_eq!(Inverse::new(&faint).err(), Some(SingularMatrix::OutOfRange));
    assert_eq!(Inverse::new(&of(1e-200, 1e150)).err(), Some(SingularMatrix::OutOfRange));
    assert_eq!(LeastSquares::new(&of(1e-200, 1e150)).err(), Some(LeastSquaresError::OutOfRange));
    assert!(Inverse::new(&of(1e-200, 1e50)).is_ok() && LeastSquares::new(&of(1e-200, 1e50)).is_ok());
    let combination = Matrix6::from_fn(|i, j| BicchiDario::MATRIX[i][j]).try_inverse().expect("independent");
    let combined = |entry: f64, nominal: f64| {
        let sensor = SensorMatrix::new(combination * entry, Vector6::repeat(nominal)).expect("proper");
        Decoupled::<f64, BicchiDario, 6>::new(&sensor).err()
    };
    assert_eq!(combined(1e-200, 1e50), None);
    assert_eq!(combined(1e-200, 1e150), Some(NotDecoupled::OutOfRange));
    // Weights whose ratio is none.
    let mut deviations = Vector6::repeat(1e300);
    assert!(LeastSquares::weighted(&of(1.0, 1.0), &deviations).is_ok());
    deviations[2] = 1e-300;
    assert_eq!(LeastSquares::weighted(&of(1.0, 1.0), &deviations).err(), Some(LeastSquaresError::OutOfRange));
}

/// Rows that weigh nothing in the answer, and rows that outweigh all: what counts is the ratio of deviations.
#[test]
fn only_ratios_of_deviations_matter() {
    let mut random = generator(161);
    let sensor = crate::support::sensor::<f64, 9>(&of_condition::<9>(&mut random, 5.0));
    let deviations = SVector::<f64, 9>::from_fn(|i, _| 1.0 + i as f64);
    let one = LeastSquares::weighted(&sensor, &deviations).expect("regular");
    for exponent in [-1000, -3, 7, 1000] {
        let other = LeastSquares::weighted(&sensor, &(deviations * 2.0_f64.powi(exponent))).expect("regular");
        assert_eq!(other, one, "{exponent}");
    }
    // How much of an error of a gauge shows in its own residual.
    for gauge in 0..9 {
        let mut error = SVector::<f64, 9>::zeros();
        error[gauge] = 1.0;
        assert!((one.residual(&error)[gauge] - one.redundancy(gauge)).abs() < 1e-14);
        // Another gauge's signal that is its prediction is explained as well without it.
        let repaired = one.repaired(&error, gauge).expect("redundant");
        assert!(repaired.iter().all(|x| x.abs() < 1e-14), "{repaired}");
    }
    let total: f64 = (0..9).map(|gauge| one.redundancy(gauge)).sum();
    assert!((total - 3.0).abs() < 1e-13, "as many as gauges to spare: {total}");
}

#[test]
fn what_a_sensor_matrix_must_be() {
    let five = SensorMatrix::<f64, 5>::new(SMatrix::repeat(1.0), Vector6::repeat(1.0));
    assert_eq!(five, Err(SensorMatrixError::TooFewGauges { gauges: 5 }));
    let nominal = Vector6::new(1.0, 2.0, 4.0, 8.0, 16.0, 32.0);
    let matrix = of_condition::<6>(&mut generator(162), 3.0);
    let sensor = SensorMatrix::from_sensitivities(matrix, nominal).expect("proper");
    assert_eq!(*sensor.nominal(), nominal);
    for axis in 0..6 {
        assert_eq!(sensor.normalised().column(axis), matrix.column(axis) * nominal[axis]);
        // One newton or newton metre gives the column of sensitivities.
        let mut load = Vector6::zeros();
        load[axis] = 1.0;
        let signals = sensor.signals(&Wrench::from_components(&load));
        assert_eq!(signals, matrix.column(axis));
    }
}

#[test]
fn published_inverses_that_are_none() {
    let good = of_condition::<6>(&mut generator(163), 3.0);
    let nominal = Vector6::new(30.0, 20.0, 10.0, 0.5, 0.3, 0.2);
    let sensor = SensorMatrix::from_inverse(&good, nominal).expect("regular");
    let product = good * sensor.normalised() * Matrix6::from_diagonal(&nominal.map(f64::recip));
    assert!(greatest(&(product - Matrix6::identity())) < 1e-14);
    let mut nan = good;
    nan[(2, 5)] = f64::NAN;
    let refused = BadInverse::Matrix(SensorMatrixError::NotFinite { gauge: 2, axis: 5 });
    assert_eq!(SensorMatrix::from_inverse(&nan, nominal), Err(refused));
    let mut twice = good;
    twice.set_row(3, &good.row(1).into_owned());
    let error = SensorMatrix::from_inverse(&twice, nominal);
    assert!(matches!(error, Err(BadInverse::Singular(SingularMatrix::DependentGauge { gauge: 1 | 3, .. }))));
    let refused = BadInverse::Matrix(SensorMatrixError::BadNominalLoad { axis: 4 });
    let mut negative = nominal;
    negative[4] = -0.3;
    assert_eq!(SensorMatrix::from_inverse(&good, negative), Err(refused));
}

/// A solver of which nothing is known but what it answers: it works, and its error has no bound.
#[test]
fn a_solver_that_says_no_linear_map_has_no_bound() {
    struct Cubed;
    impl WrenchSolver<f64, 6> for Cubed {
        fn solve(&self, signals: &Vector6<f64>) -> Wrench<f64> {
            Wrench::from_components(&signals.map(|signal| signal.powi(3)))
        }
    }
    let sensor = SensorMatrix::new(Matrix6::identity(), Vector6::repeat(1.0)).expect("proper");
    assert_eq!(Cubed.solve(&Vector6::repeat(2.0)).components(), Vector6::repeat(8.0));
    assert_eq!(ErrorBound::new(&sensor, &Cubed, &Uncertainty::none()), Err(NoErrorBound::NotLinear));
    assert_eq!(WrenchCovariance::new(&sensor, &&Cubed, &Matrix6::identity()), Err(BadCovariance::NotLinear));
}
