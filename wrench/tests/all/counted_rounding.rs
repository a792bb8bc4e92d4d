//! What solvers state of their own rounding: as many errors as operations, counted on matrices whose factors
//! are exact, and the same in any unit.

use crate::support::{generator, greatest, of_condition, random_vector};
use fingertip_wrench::{
    BicchiDario, Combination, Decoupled, ErrorBound, GaussianElimination, Inverse, LeastSquares, Refined,
    SensorMatrix, Uncertainty, WrenchSolver,
};
use nalgebra::{Matrix6, SMatrix, SVector, Vector6};

/// `k` rounding errors in a row, at most: `k u/(1 − k u)`.
fn rounded(k: usize) -> f64 {
    let all = k as f64 * f64::EPSILON / 2.0;
    all / (1.0 - all)
}

fn unit_loads(matrix: Matrix6<f64>) -> SensorMatrix<f64, 6> {
    SensorMatrix::new(matrix, Vector6::repeat(1.0)).expect("proper")
}

fn same(found: &Matrix6<f64>, wanted: &Matrix6<f64>) {
    assert!(greatest(&(found - wanted)) < 1e-13 * greatest(wanted), "{found} {wanted}");
}

/// Elimination of a triangle with one entry off the diagonal, which nothing rounds: what the substitutions
/// round is counted by hand. A diagonal term is multiplied once, has 5 subtractions on its way in all and is
/// scaled at the end.
#[test]
fn substitutions_are_counted() {
    let identity = Matrix6::identity();
    let own = |matrix| {
        let sensor = unit_loads(matrix);
        GaussianElimination::new(&sensor).expect("regular").linear_map(&sensor).expect("linear").own_error
    };
    let found = own(identity);
    same(&found.per_load, &(identity * (rounded(6) + rounded(1))));
    assert_eq!((found.per_signal, found.magnitude), (Matrix6::zeros(), identity));
    for i in 0..6 {
        for j in (0..6).filter(|j| *j != i) {
            let mut matrix = identity;
            matrix[(i, j)] = 0.5;
            let mut backward = identity * rounded(6);
            // Above the diagonal, a product and the subtractions after it, i + 1 before; below, a product and
            // the subtractions from that of unknown j on.
            backward[(i, j)] = 0.5 * if j > i { rounded(7) } else { rounded((i + 1 - j) + (5 - j)) };
            let inverse = identity * 2.0 - matrix;
            let found = own(matrix);
            same(&found.per_load, &(inverse.abs() * backward + identity * rounded(1)));
            assert_eq!(found.magnitude, inverse.abs());
        }
    }
}

/// Products are counted by their terms: that of the first two columns is rounded six times, of the others once less
/// from column to column. Those of many gauges have one rounding more for the division by the nominal load.
#[test]
fn products_are_counted() {
    let mut random = generator(170);
    let sensor = unit_loads(of_condition::<6>(&mut random, 5.0));
    let inverse = Inverse::new(&sensor).expect("regular");
    let (own, gain) = (
        inverse.linear_map(&sensor).expect("linear").own_error,
        inverse.linear_map(&sensor).expect("linear").gain.abs(),
    );
    let counts = [6, 6, 5, 4, 3, 2];
    let counted = Matrix6::from_fn(|i, gauge| gain[(i, gauge)] * rounded(counts[gauge]));
    for (found, least) in [(own.magnitude, gain), (own.per_signal, counted)] {
        for (found, least) in found.iter().zip(least.iter()) {
            // And a hair for what computing the bound rounds.
            assert!(found >= least && *found <= least * (1.0 + 8.0 * f64::EPSILON), "{found} {least}");
        }
    }
    assert!(greatest(&own.per_load) < 10.0 * f64::EPSILON * 5.0);
    let wide = SensorMatrix::new(of_condition::<9>(&mut random, 5.0), Vector6::repeat(1.0)).expect("proper");
    let solver = LeastSquares::new(&wide).expect("regular");
    let own = solver.linear_map(&wide).expect("linear").own_error;
    let gain = solver.linear_map(&wide).expect("linear").gain.abs();
    assert_eq!(own.magnitude, gain);
    let off = own.per_signal - gain * rounded(10);
    assert!(greatest(&off) < 1e-13 * greatest(&own.per_signal));
    // The paper's combination of a matrix that it takes to the identity.
    let combination = Matrix6::from_fn(|i, j| BicchiDario::MATRIX[i][j]);
    let sensor = unit_loads(combination.try_inverse().expect("independent"));
    let decoupled = Decoupled::<f64, BicchiDario, 6>::new(&sensor).expect("decoupled");
    let own = decoupled.linear_map(&sensor).expect("linear").own_error;
    let off = own.per_signal - combination.abs() * rounded(6 + 17);
    assert!(greatest(&off) < 1e-13 * greatest(&own.per_signal));
    assert_eq!(
        (own.magnitude, own.per_load),
        (decoupled.linear_map(&sensor).expect("linear").gain.abs(), *decoupled.neglected())
    );
}

/// A refined answer is off by the rounding of its last sum and of its last scaling, and of no more.
#[test]
fn a_refined_answer_rounds_twice() {
    let mut random = generator(171);
    for condition in [1.0, 1e3, 1e6] {
        let sensor = unit_loads(of_condition::<6>(&mut random, condition));
        let own = Refined::new(&sensor).expect("regular").linear_map(&sensor).expect("linear").own_error;
        for i in 0..6 {
            assert!((own.per_load[(i, i)] / f64::EPSILON - 1.0).abs() < 1e-3, "{}", own.per_load[(i, i)]);
            for j in (0..6).filter(|j| *j != i) {
                assert!(own.per_load[(i, j)] < 1e-3 * f64::EPSILON);
            }
        }
        assert_eq!(own.per_signal, Matrix6::zeros());
    }
}

/// Of the error `E` before it a step leaves `P (I + P) E` at most, `P` being the error of one solve: where `P`
/// is not small, that is what is left of the first error in the end.
#[test]
fn what_refinement_leaves_of_the_first_error_is_stated() {
    for units in [33, 50, 100, 300] {
        let mut matrix = Matrix6::<f64>::identity();
        (matrix[(1, 4)], matrix[(4, 1)]) = (1.0, 1.0);
        matrix[(4, 4)] += f64::EPSILON * f64::from(units);
        let sensor = unit_loads(matrix);
        let one = GaussianElimination::new(&sensor)
            .expect("regular")
            .linear_map(&sensor)
            .expect("linear")
            .own_error
            .per_load;
        let refined = Refined::new(&sensor).expect("regular");
        let stated = refined.linear_map(&sensor).expect("linear").own_error.per_load;
        let mut left = one;
        for _ in 0..refined.steps() {
            left = one * (Matrix6::identity() + one) * left;
        }
        assert!(left.iter().all(|x| x.is_finite()) && left[(1, 1)] > f64::EPSILON, "{units}: {left}");
        assert!((0..36).all(|k| stated[k] >= left[k] * (1.0 - 1e-12)), "{units}: {stated} {left}");
    }
}

/// Other units of load and of signal: the same bound, but for the rounding of the bound itself.
fn in_any_unit<const N: usize, S: WrenchSolver<f64, N>>(build: impl Fn(&SensorMatrix<f64, N>) -> S) {
    let mut random = generator(172);
    let loads = Vector6::new(1024.0, 1.0, 0.125, 16.0, 0.5, 4096.0);
    for _ in 0..20 {
        let matrix = of_condition::<N>(&mut random, 10.0);
        let plain = SensorMatrix::new(matrix, Vector6::repeat(1.0)).expect("proper");
        let scaled = SMatrix::<f64, N, 6>::from_fn(|i, j| matrix[(i, j)] * loads[j] * 8.0);
        let scaled = SensorMatrix::new(scaled, loads).expect("proper");
        let (one, other) = (build(&plain), build(&scaled));
        let signals = random_vector::<N>(&mut random);
        let wrench = one.solve(&signals);
        let found = other.solve(&(signals * 8.0));
        let close = |a: &Vector6<f64>, b: &Vector6<f64>| {
            assert!((0..6).all(|k| (a[k] - b[k]).abs() <= 1e-13 * b.norm()), "{a} {b}");
        };
        close(&found.components(), &wrench.components());
        for noise in [0.0, 1e-3] {
            let of = |unit: f64| Uncertainty::of_signals(SVector::<f64, N>::repeat(noise * unit));
            let with = |sensor, solver: &S, unit: f64| {
                let known = of(unit).with_relative_matrix_error(sensor, noise);
                ErrorBound::new(sensor, solver, &known).expect("bounded")
            };
            let (one_bound, other_bound) = (with(&plain, &one, 1.0), with(&scaled, &other, 8.0));
            let bound = one_bound.at(&signals, &wrench);
            let again = other_bound.at(&(signals * 8.0), &wrench);
            // Defects of rounding are in both, and differ by themselves.
            let alike = if noise > 0.0 { 1e-9 } else { 0.25 };
            assert!((0..6).all(|k| (again[k] / bound[k] - 1.0).abs() < alike), "{again} {bound}");
            assert!((0..6).all(|k| bound[k] > 0.0));
        }
        // The gain is that of the other unit.
        let (gain, again) =
            (one.linear_map(&plain).expect("linear").gain, other.linear_map(&scaled).expect("linear").gain);
        let off = SMatrix::<f64, 6, N>::from_fn(|i, j| again[(i, j)] * loads[i] * 8.0 - gain[(i, j)]);
        assert!(greatest(&off) < 1e-13 * greatest(&gain), "{off}");
    }
}

/// The gain of every solver inverts the matrix, whatever the units of gauges and loads.
fn inverts<S: WrenchSolver<f64, 6>>(build: impl Fn(&SensorMatrix<f64, 6>) -> S) {
    let mut random = generator(173);
    for _ in 0..20 {
        let matrix = of_condition::<6>(&mut random, 10.0);
        let scaled = Matrix6::from_fn(|i, j| matrix[(i, j)] * 2.0_f64.powi(7 * i as i32 - 5 * j as i32));
        let nominal = Vector6::from_fn(|i, _| 3.0_f64.powi(i as i32 - 3));
        let sensor = SensorMatrix::new(scaled, nominal).expect("proper");
        let solver = build(&sensor);
        let gain = solver.linear_map(&sensor).expect("linear").gain;
        let signals = random_vector::<6>(&mut random);
        let found = solver.solve(&signals).components();
        for i in 0..6 {
            // Of terms as large as the product of their scales lets them be.
            let size: f64 = (0..6).map(|k| (gain[(i, k)] * signals[k]).abs()).sum();
            let product: f64 = (0..6).map(|k| gain[(i, k)] * signals[k]).sum();
            assert!((found[i] / nominal[i] - product).abs() < 1e3 * f64::EPSILON * size);
            for j in 0..6 {
                let size: f64 = (0..6).map(|k| (gain[(i, k)] * scaled[(k, j)]).abs()).sum();
                let product: f64 = (0..6).map(|k| gain[(i, k)] * scaled[(k, j)]).sum();
                let wanted = f64::from(u8::from(i == j));
                assert!((product - wanted).abs() < 1e3 * f64::EPSILON * size, "{i} {j}: {product}");
            }
        }
        let magnitude = solver.linear_map(&sensor).expect("linear").own_error.magnitude;
        assert!((0..36).all(|k| (magnitude[k] / gain[k].abs() - 1.0).abs() < 1e-9));
    }
}

#[test]
fn gains_invert_in_any_unit() {
    inverts(|sensor| GaussianElimination::new(sensor).expect("regular"));
    inverts(|sensor| Inverse::new(sensor).expect("regular"));
    inverts(|sensor| Refined::new(sensor).expect("regular"));
}

#[test]
fn bounds_are_the_same_in_any_unit() {
    in_any_unit::<6, _>(|sensor| GaussianElimination::new(sensor).expect("regular"));
    in_any_unit::<6, _>(|sensor| Inverse::new(sensor).expect("regular"));
    in_any_unit::<6, _>(|sensor| Refined::new(sensor).expect("regular"));
    in_any_unit::<9, _>(|sensor| LeastSquares::new(sensor).expect("regular"));
}
