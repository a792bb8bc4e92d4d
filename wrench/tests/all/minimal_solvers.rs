//! Solvers of six gauges against an oracle of 32 digits, over conditions, precisions and ranges.

use crate::support::double_double::{difference, residual, solve};
use crate::support::{cast, generator, of_condition, random_vector, sensor, wide};
use fingertip_test_support::Worst;
use fingertip_wrench::{
    GaussianElimination, Inverse, LeastSquares, Real, Refined, SensorMatrix, SensorMatrixError,
    SingularMatrix, WrenchSolver,
};
use nalgebra::{Matrix6, Vector6};
use rand::RngExt;

/// Worst figures over a decade, in units of ε.
#[derive(Default, Debug)]
struct Figures {
    residual: Worst,
    forward_per_condition: Worst,
    inverse_per_condition: Worst,
    refined: Worst,
}

fn accuracy_in_decade<T: Real>(decade: i32, matrices: usize) -> Figures {
    let mut random = generator(decade as u128);
    let epsilon = T::EPSILON.to_f64();
    let mut worst = Figures::default();
    for _ in 0..matrices {
        let condition = 10.0_f64.powf(f64::from(decade) + random.random_range(0.0..1.0));
        let sensor = sensor::<T, 6>(&of_condition::<6>(&mut random, condition));
        let matrix = wide(sensor.normalised());
        // Half of the signals are of likely loads, which a bad condition spreads over decades; half
        // are any signals, whose loads are large.
        let vector = random_vector::<6>(&mut random);
        let signals: Vector6<T> = cast(&if random.random() { matrix * vector } else { vector });
        let right = wide(&signals);
        let exact = solve(&matrix, &right);
        let size = Vector6::from_fn(|i, _| exact[i].to_f64()).norm();
        let error_of = |solver: &dyn WrenchSolver<T, 6>| {
            let loads = wide(&solver.solve(&signals).components().component_div(sensor.nominal()));
            (loads, difference(&loads, &exact).norm() / size / epsilon)
        };
        let gauss = GaussianElimination::new(&sensor).expect("regular");
        let (loads, forward) = error_of(&gauss);
        let relative = residual(&matrix, &right, &loads).norm() / loads.norm() / epsilon;
        worst.residual.see(relative);
        worst.forward_per_condition.see(forward / condition);
        let inverse = Inverse::new(&sensor).expect("regular");
        worst.inverse_per_condition.see(error_of(&inverse).1 / condition);
        let refined = Refined::new(&sensor).expect("regular");
        worst.refined.see(error_of(&refined).1);
    }
    worst
}

fn check_accuracy<T: Real>(decades: i32, matrices: usize) {
    for decade in 0..decades {
        let worst = accuracy_in_decade::<T>(decade, matrices);
        println!("condition 1e{decade}, in units of epsilon: {worst:?}");
        // The spectral norm of every matrix is 1 but for rounding.
        // Measured: 2.9, 2.6, 1.25 and 0.48, of which half a unit is the rounding of the answer itself.
        assert!(worst.residual.get() <= 4.0, "{worst:?}");
        assert!(worst.forward_per_condition.get() <= 4.0, "{worst:?}");
        assert!(worst.inverse_per_condition.get() <= 2.0, "{worst:?}");
        assert!(worst.refined.get() <= 0.6, "{worst:?}");
    }
}

#[test]
fn accurate_at_every_condition_in_double_precision() {
    check_accuracy::<f64>(12, 10_000);
}

#[test]
fn accurate_at_every_condition_in_single_precision() {
    check_accuracy::<f32>(5, 10_000);
}

/// Two rows equal, a row a combination of two others, a matrix of rank `rank`.
fn singular_is_refused<T: Real>() {
    let mut random = generator(77);
    for _ in 0..10_000 {
        let regular = of_condition::<6>(&mut random, 10.0);
        let mut gauges = [0, 1, 2, 3, 4, 5];
        for i in 0..6 {
            gauges.swap(i, random.random_range(i..6));
        }
        let [a, b, c, ..] = gauges;

        let mut twice: Matrix6<T> = cast(&regular);
        let row = twice.row(b) * T::literal(random.random_range(0.5..2.0));
        twice.set_row(a, &row);
        assert_names(&twice, &[a, b]);

        let mut combined: Matrix6<T> = cast(&regular);
        let row = combined.row(b) * T::literal(0.3) - combined.row(c) * T::literal(1.7);
        combined.set_row(a, &row);
        assert_names(&combined, &[a, b, c]);

        let mut deficient = Matrix6::<T>::zeros();
        let rank = random.random_range(1..6);
        for _ in 0..rank {
            let (left, right) = (random_vector::<6>(&mut random), random_vector::<6>(&mut random));
            deficient += cast::<T, 6, 6>(&(left * right.transpose()));
        }
        assert_names(&deficient, &[0, 1, 2, 3, 4, 5]);
    }
}

fn assert_names<T: Real>(matrix: &Matrix6<T>, candidates: &[usize]) {
    let sensor = SensorMatrix::new(*matrix, Vector6::repeat(T::one())).expect("no gauge is dead");
    for error in
        [GaussianElimination::new(&sensor).err(), Inverse::new(&sensor).err(), Refined::new(&sensor).err()]
    {
        let Some(SingularMatrix::DependentGauge { gauge, pivot }) = error else {
            panic!("not refused: {error:?}: {matrix}");
        };
        assert!(candidates.contains(&gauge), "gauge {gauge} of {candidates:?}");
        assert!(pivot < 100.0 * T::EPSILON.to_f64(), "{pivot}");
    }
}

#[test]
fn singular_matrices_are_refused_with_the_gauge() {
    singular_is_refused::<f32>();
    singular_is_refused::<f64>();
}

fn dead_channel_is_refused<T: Real>() {
    let mut random = generator(78);
    let regular: Matrix6<T> = cast(&of_condition::<6>(&mut random, 10.0));
    let nominal = Vector6::repeat(T::one());
    for k in 0..6 {
        let mut dead = regular;
        dead.row_mut(k).fill(T::zero());
        assert_eq!(SensorMatrix::new(dead, nominal), Err(SensorMatrixError::DeadGauge { gauge: k }));
        let mut blind = regular;
        blind.column_mut(k).fill(T::zero());
        assert_eq!(SensorMatrix::new(blind, nominal), Err(SensorMatrixError::BlindAxis { axis: k }));
        for bad in [T::zero() / T::zero(), T::one() / T::zero()] {
            let mut wrong = regular;
            wrong[(k, 5 - k)] = bad;
            let error = SensorMatrixError::NotFinite { gauge: k, axis: 5 - k };
            assert_eq!(SensorMatrix::new(wrong, nominal), Err(error));
        }
        for bad in [T::zero(), -T::one(), T::zero() / T::zero(), T::one() / T::zero()] {
            let mut loads = nominal;
            loads[k] = bad;
            let error = SensorMatrixError::BadNominalLoad { axis: k };
            assert_eq!(SensorMatrix::new(regular, loads), Err(error));
        }
    }
}

#[test]
fn dead_channels_are_refused_with_the_gauge() {
    dead_channel_is_refused::<f32>();
    dead_channel_is_refused::<f64>();
}

/// The same load times a power of two: the same digits.
fn range<T: Real>(exponents: &[i32]) {
    let mut random = generator(79);
    for _ in 0..200 {
        let sensor = sensor::<T, 6>(&of_condition::<6>(&mut random, 50.0));
        let signals: Vector6<T> = cast(&random_vector::<6>(&mut random));
        let gauss = GaussianElimination::new(&sensor).expect("regular");
        let inverse = Inverse::new(&sensor).expect("regular");
        let refined = Refined::new(&sensor).expect("regular");
        let least_squares = LeastSquares::new(&sensor).expect("regular");
        let solvers: [&dyn WrenchSolver<T, 6>; 4] = [&gauss, &inverse, &refined, &least_squares];
        for solver in solvers {
            let one = solver.solve(&signals).components();
            for exponent in exponents {
                let factor = T::literal(2.0_f64.powi(*exponent));
                assert_eq!(solver.solve(&(signals * factor)).components(), one * factor, "2^{exponent}");
            }
        }
    }
}

#[test]
fn forces_of_any_size_are_found_equally_well() {
    // 2^100 is 1.3e30, 2^50 is 1.1e15.
    range::<f64>(&[-100, -50, 50, 100]);
    range::<f32>(&[-50, -25, 25, 50]);
}

#[test]
fn scales_of_gauges_and_axes_cost_no_accuracy() {
    let mut random = generator(80);
    for _ in 0..500 {
        let plain = sensor::<f64, 6>(&of_condition::<6>(&mut random, 50.0));
        let load = fingertip_wrench::Wrench::from_components(&random_vector::<6>(&mut random));
        let rows = Vector6::from_fn(|_, _| 2.0_f64.powi(random.random_range(-200..200)));
        let columns = Vector6::from_fn(|_, _| 2.0_f64.powi(random.random_range(-200..200)));
        let scaled = Matrix6::from_diagonal(&rows) * plain.normalised() * Matrix6::from_diagonal(&columns);
        let scaled = SensorMatrix::new(scaled, plain.nominal().component_mul(&columns)).expect("proper");
        let signals = plain.signals(&load);
        let found = GaussianElimination::new(&scaled).expect("regular").solve(&signals.component_mul(&rows));
        let error = (found - load).components().component_div(plain.nominal());
        let size = load.components().component_div(plain.nominal()).norm();
        assert!(error.norm() <= 10.0 * 50.0 * f64::EPSILON * size, "{error}");
    }
}

#[test]
fn signals_that_are_not_finite_give_wrenches_that_are_not() {
    let mut random = generator(81);
    let sensor = sensor::<f64, 6>(&of_condition::<6>(&mut random, 5.0));
    let refined = Refined::new(&sensor).expect("regular");
    let gauss = GaussianElimination::new(&sensor).expect("regular");
    let inverse = Inverse::new(&sensor).expect("regular");
    let solvers: [&dyn WrenchSolver<f64, 6>; 3] = [&gauss, &inverse, &refined];
    for solver in solvers {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for gauge in 0..6 {
                let mut signals = Vector6::repeat(0.1);
                signals[gauge] = bad;
                assert!(!solver.solve(&signals).is_finite());
            }
        }
        assert_eq!(solver.solve(&Vector6::zeros()).components(), Vector6::zeros());
    }
}
