//! Uncertainties that are none are refused, with the gauge; what is known exactly is welcome.

use crate::support::{generator, of_condition, sensor};
use fingertip_wrench::{
    BadCovariance, ErrorBound, GaussianElimination, Inverse, LeastSquares, NoErrorBound, Real, SensorMatrix,
    Uncertainty, Wrench, WrenchCovariance,
};
use nalgebra::{Matrix6, SMatrix, SVector, Vector6};

fn extended<T: Real>() -> (SensorMatrix<T, 8>, LeastSquares<T, 8>) {
    let sensor = sensor::<T, 8>(&of_condition::<8>(&mut generator(110), 3.0));
    let solver = LeastSquares::new(&sensor).expect("regular");
    (sensor, solver)
}

/// Negative, NaN, infinite.
fn bad<T: Real>() -> [T; 4] {
    [-T::LEAST_NORMAL, T::literal(f64::NAN), T::literal(f64::INFINITY), T::literal(f64::NEG_INFINITY)]
}

fn bounds<T: Real>() {
    let (sensor, solver) = extended::<T>();
    let bound = |uncertainty: &Uncertainty<T, 8>| ErrorBound::new(&sensor, &solver, uncertainty);
    let small = T::literal(1e-3);
    let good = Uncertainty::of_signals(SVector::repeat(small)).with_relative_matrix_error(&sensor, small);
    assert!(bound(&good).is_ok() && bound(&Uncertainty::none()).is_ok());
    for bad in bad::<T>() {
        for gauge in 0..8 {
            let refused = Err(NoErrorBound::BadUncertainty { gauge });
            let mut signals = good;
            signals.signals[gauge] = bad;
            assert_eq!(bound(&signals), refused);
            for axis in 0..6 {
                let mut matrix = good;
                matrix.matrix[(gauge, axis)] = bad;
                assert_eq!(bound(&matrix), refused);
            }
        }
    }
    // The first gauge is named.
    let mut two = good;
    (two.signals[5], two.matrix[(3, 0)]) = (-small, -small);
    assert_eq!(bound(&two), Err(NoErrorBound::BadUncertainty { gauge: 3 }));
    // One entry alone that is zero, or not.
    let mut exact = good;
    (exact.signals[2], exact.matrix[(4, 1)]) = (T::zero(), T::zero());
    assert!(bound(&exact).is_ok());
}

#[test]
fn no_bound_from_bad_uncertainties() {
    bounds::<f32>();
    bounds::<f64>();
}

/// A matrix that may be singular within its uncertainty, a solver of another sensor, numbers out of range.
#[test]
fn no_bound_where_there_is_none() {
    let sensor = SensorMatrix::new(Matrix6::identity(), Vector6::repeat(1.0)).expect("proper");
    let solver = Inverse::new(&sensor).expect("regular");
    let with = |fraction| {
        ErrorBound::new(&sensor, &solver, &Uncertainty::none().with_relative_matrix_error(&sensor, fraction))
    };
    // Every entry off by δ: the matrix may be singular from 6 δ = 1 on. The series is summed up to its 2^13th
    // term, which is enough up to 0.98.
    assert!(with(0.163).is_ok());
    assert_eq!(with(0.167), Err(NoErrorBound::Unbounded));
    let other = SensorMatrix::new(Matrix6::identity() * 4.0, Vector6::repeat(1.0)).expect("proper");
    assert_eq!(ErrorBound::new(&other, &solver, &Uncertainty::none()), Err(NoErrorBound::Unbounded));
    let huge = Uncertainty::of_signals(Vector6::repeat(f64::MAX));
    let strong = SensorMatrix::new(Matrix6::identity(), Vector6::repeat(10.0)).expect("proper");
    let solver = Inverse::new(&strong).expect("regular");
    assert_eq!(ErrorBound::new(&strong, &solver, &huge), Err(NoErrorBound::Unbounded));
    // What is not finite has no finite bound.
    let bound = ErrorBound::new(&strong, &solver, &Uncertainty::none()).expect("bounded");
    let nan = Wrench::from_components(&Vector6::repeat(f64::NAN));
    assert!(bound.at(&Vector6::zeros(), &nan).iter().all(|x| !x.is_finite()));
    assert!(bound.at(&Vector6::repeat(f64::INFINITY), &Wrench::zero()).iter().all(|x| !x.is_finite()));
}

fn covariances<T: Real>() {
    let (sensor, solver) = extended::<T>();
    let noise = SVector::<T, 8>::repeat(T::literal(1e-3));
    let entries = SMatrix::<T, 8, 6>::repeat(T::literal(1e-4));
    let model = WrenchCovariance::from_noise(&sensor, &solver, &noise).expect("valid");
    assert!(model.with_matrix_deviations(&sensor, &entries).is_ok());
    let variances = SMatrix::<T, 8, 8>::from_diagonal(&noise.component_mul(&noise));
    assert_eq!(WrenchCovariance::new(&sensor, &solver, &variances), Ok(model));
    for bad in bad::<T>() {
        for gauge in 0..8 {
            let refused = BadCovariance::BadNoise { gauge };
            let mut deviations = noise;
            deviations[gauge] = bad;
            let found = WrenchCovariance::from_noise(&sensor, &solver, &deviations);
            assert_eq!(found.err(), Some(refused));
            let mut matrix = variances;
            matrix[(gauge, gauge)] = bad;
            assert_eq!(WrenchCovariance::new(&sensor, &solver, &matrix).err(), Some(refused));
            for axis in 0..6 {
                let mut deviations = entries;
                deviations[(gauge, axis)] = bad;
                assert_eq!(model.with_matrix_deviations(&sensor, &deviations).err(), Some(refused));
            }
        }
    }
    // No noise is a noise; correlated noise may have any sign, but is as much either way.
    let zero = SVector::<T, 8>::zeros();
    let none = WrenchCovariance::from_noise(&sensor, &solver, &zero).expect("valid");
    assert_eq!(*none.floor(), Matrix6::zeros());
    assert!(none.with_matrix_deviations(&sensor, &SMatrix::zeros()).is_ok());
    let shared = |forth: T, back: T| {
        let mut matrix = variances;
        (matrix[(2, 5)], matrix[(5, 2)]) = (forth, back);
        WrenchCovariance::new(&sensor, &solver, &matrix).err()
    };
    let size = T::literal(5e-7);
    let (zero, hair) = (T::zero(), T::EPSILON);
    let one = T::one();
    assert_eq!([shared(-size, -size), shared(size, size), shared(zero, zero)], [None; 3]);
    let refused = Some(BadCovariance::BadNoise { gauge: 2 });
    assert_eq!([shared(size, -size), shared(size, zero), shared(zero, -size)], [refused; 3]);
    // Rounding is forgiven: sixteen units of it of the entry, no more.
    assert_eq!(shared(size, size * (one + T::literal(8.0) * hair)), None);
    assert_eq!(shared(-size, -size * (one + T::literal(8.0) * hair)), None);
    assert_eq!(shared(size, size * (one + T::literal(32.0) * hair)), refused);
    assert_eq!(shared(-size, -size * (one + T::literal(32.0) * hair)), refused);
    for nan in [T::literal(f64::NAN), T::literal(f64::INFINITY)] {
        assert_eq!(shared(nan, nan), refused);
        assert!(shared(nan, size).is_some() && shared(size, nan).is_some());
    }
    // Beyond the range.
    let huge = SVector::<T, 8>::repeat(T::GREATEST * T::literal(0.5));
    let found = WrenchCovariance::from_noise(&sensor, &solver, &huge);
    assert!(found.is_err());
    let found = WrenchCovariance::new(&sensor, &solver, &SMatrix::from_diagonal(&huge));
    assert_eq!(found.err(), Some(BadCovariance::OutOfRange));
    let huge = SMatrix::repeat(T::GREATEST);
    assert_eq!(model.with_matrix_deviations(&sensor, &huge).err(), Some(BadCovariance::OutOfRange));
}

#[test]
fn no_covariance_from_bad_noise() {
    covariances::<f32>();
    covariances::<f64>();
}

/// The covariance by its definition, sum by sum, with correlated noise, units and loads that all differ.
#[test]
fn covariance_by_its_definition() {
    let nominal = Vector6::new(30.0, 20.0, 10.0, 0.5, 0.3, 0.2);
    let matrix = of_condition::<6>(&mut generator(111), 4.0);
    let sensor = SensorMatrix::new(matrix, nominal).expect("proper");
    let solver = GaussianElimination::new(&sensor).expect("regular");
    let inverse = matrix.try_inverse().expect("regular");
    let noise =
        Matrix6::from_fn(
            |i, j| if i == j { 3.0 + i as f64 } else { 0.1 * (i as f64 - 2.5) * (j as f64 - 2.5) },
        );
    let entries = Matrix6::from_fn(|i, j| 1e-2 * (1 + i + 2 * j) as f64);
    let model = WrenchCovariance::new(&sensor, &solver, &noise)
        .and_then(|model| model.with_matrix_deviations(&sensor, &entries))
        .expect("valid");
    let load = Vector6::new(5.0, -12.0, 3.0, -0.25, 0.1, 0.15);
    let wrench: Wrench<f64> = Wrench::from_components(&load);
    let gain = |axis: usize, gauge: usize| inverse[(axis, gauge)] * nominal[axis];
    let (floor, at) = (model.floor(), model.at(&wrench));
    for a in 0..6 {
        for b in 0..6 {
            let (mut constant, mut whole) = (0.0, 0.0);
            for i in 0..6 {
                for j in 0..6 {
                    constant += gain(a, i) * noise[(i, j)] * gain(b, j);
                }
                // Errors of the entries of one gauge are independent, each times its load.
                let variance: f64 = (0..6).map(|k| (entries[(i, k)] * load[k] / nominal[k]).powi(2)).sum();
                whole += gain(a, i) * variance * gain(b, i);
            }
            whole += constant;
            let size = nominal[a] * nominal[b];
            // Sums of 36 products of numbers up to 4·9·4.
            assert!((floor[(a, b)] - constant).abs() < 1e-12 * size, "{a} {b}");
            assert!((at[(a, b)] - whole).abs() < 1e-12 * size, "{a} {b}");
            assert_eq!((floor[(a, b)], at[(a, b)]), (floor[(b, a)], at[(b, a)]));
        }
    }
    assert_eq!(model.at(&Wrench::zero()), *floor);
}
