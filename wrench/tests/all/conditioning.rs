//! Singular values and condition numbers against 77-digit arithmetic.

use crate::support::{cast, generator, greatest, of_condition, orthonormal, wide};
use dashu_float::FBig;
use dashu_float::round::mode::HalfEven;
use fingertip_test_support::Worst;
use fingertip_wrench::{BeyondBound, Conditioning, Real, SensorMatrix, singular_values};
use nalgebra::{Matrix6, SMatrix, Vector6};
use rand::RngExt;

type Big = FBig<HalfEven, 2>;
const BITS: usize = 256;

fn big(x: f64) -> Big {
    Big::try_from(x).expect("finite").with_precision(BITS).value()
}

/// Singular values as roots of the eigenvalues of the Gram matrix, by two-sided Jacobi rotations:
/// hopeless in `f64`, exact to 45 digits and more here.
fn oracle<const N: usize>(matrix: &SMatrix<f64, N, 6>) -> Vec<f64> {
    let entry = |i: usize, j: usize| big(matrix[(i, j)]);
    let mut gram: Vec<Vec<Big>> = (0..6)
        .map(|i| (0..6).map(|j| (0..N).fold(big(0.0), |sum, k| sum + entry(k, i) * entry(k, j))).collect())
        .collect();
    let tiny = big(2.0_f64.powi(-200));
    for _sweep in 0..30 {
        let mut rotated = false;
        for p in 0..5 {
            for q in p + 1..6 {
                let off = gram[p][q].clone();
                let size = &gram[p][p] * &gram[q][q];
                if &off * &off <= &size * &tiny || off == big(0.0) {
                    continue;
                }
                rotated = true;
                let theta = (&gram[q][q] - &gram[p][p]) / (big(2.0) * &off);
                let root = (&theta * &theta + big(1.0)).sqrt();
                let tangent =
                    if theta < big(0.0) { big(-1.0) / (root - theta) } else { big(1.0) / (root + theta) };
                let cos = big(1.0) / (&tangent * &tangent + big(1.0)).sqrt();
                let sin = &tangent * &cos;
                for k in 0..6 {
                    let (x, y) = (gram[k][p].clone(), gram[k][q].clone());
                    gram[k][p] = &cos * &x - &sin * &y;
                    gram[k][q] = &sin * &x + &cos * &y;
                }
                for k in 0..6 {
                    let (x, y) = (gram[p][k].clone(), gram[q][k].clone());
                    gram[p][k] = &cos * &x - &sin * &y;
                    gram[q][k] = &sin * &x + &cos * &y;
                }
            }
        }
        if !rotated {
            break;
        }
    }
    let mut values: Vec<f64> = (0..6)
        .map(|i| if gram[i][i] > big(0.0) { gram[i][i].sqrt().to_f64().value() } else { 0.0 })
        .collect();
    values.sort_by(|a, b| b.total_cmp(a));
    values
}

/// Worst error of any singular value, in ε of the largest.
fn against_oracle<T: Real, const N: usize>(condition: f64, matrices: usize) -> f64 {
    let mut random = generator(condition.to_bits().into());
    let mut worst = Worst::new();
    for _ in 0..matrices {
        let matrix: SMatrix<T, N, 6> = cast(&of_condition::<N>(&mut random, condition));
        let expected = oracle(&wide(&matrix));
        let found = singular_values(&matrix);
        for i in 0..6 {
            let error = (found[i].to_f64() - expected[i]).abs() / expected[0];
            worst.see(error / T::EPSILON.to_f64());
        }
    }
    worst.get()
}

#[test]
fn singular_values_are_right_at_every_condition() {
    for decade in 0..=15 {
        let condition = 10.0_f64.powi(decade);
        let worst = against_oracle::<f64, 6>(condition, 8).max(against_oracle::<f64, 9>(condition, 3));
        println!("condition 1e{decade}: worst error {worst:.2} epsilon of the largest singular value");
        assert!(worst < 10.0, "{worst}");
    }
    for decade in 0..=7 {
        let worst = against_oracle::<f32, 6>(10.0_f64.powi(decade), 8);
        assert!(worst < 10.0, "{worst}");
    }
}

/// Where only the columns differ in size, even the smallest singular value is right in itself.
#[test]
fn badly_scaled_columns_cost_no_digit() {
    let mut random = generator(5);
    for _ in 0..12 {
        let columns = Vector6::from_fn(|_, _| 10.0_f64.powf(random.random_range(-15.0..0.0)));
        let matrix = of_condition::<6>(&mut random, 10.0) * Matrix6::from_diagonal(&columns);
        let expected = oracle(&matrix);
        let found = singular_values(&matrix);
        for i in 0..6 {
            let error = (found[i] / expected[i] - 1.0).abs() / f64::EPSILON;
            assert!(error < 200.0, "{error}");
        }
    }
}

#[test]
fn invariants_of_singular_values() {
    let mut random = generator(6);
    for _ in 0..500 {
        let matrix = of_condition::<8>(&mut random, 1e4);
        let values = singular_values(&matrix);
        assert!(values.as_slice().windows(2).all(|pair| pair[0] >= pair[1]));
        // Σσ² = ‖A‖², the check that nalgebra's own decomposition fails on some matrices.
        assert!((values.norm_squared() / matrix.norm_squared() - 1.0).abs() < 50.0 * f64::EPSILON);
        let turned = matrix * orthonormal::<6>(&mut random);
        assert!(greatest(&(singular_values(&turned) - values)) < 50.0 * f64::EPSILON);
        for exponent in [-900, 900] {
            let scale = 2.0_f64.powi(exponent);
            assert_eq!(singular_values(&(matrix * scale)), values * scale);
        }
        let columns = [3, 1, 5, 0, 2, 4].map(|j| matrix.column(j).into_owned());
        let shuffled = SMatrix::<f64, 8, 6>::from_columns(&columns);
        assert!(greatest(&(singular_values(&shuffled) - values)) < 50.0 * f64::EPSILON);
    }
    // Structured loads, on which nalgebra's decomposition goes wrong.
    for _ in 0..2_000 {
        let matrix = Matrix6::from_fn(|_, _| f64::from(random.random_range(-1..=1)));
        let values = singular_values(&matrix);
        assert!((values.norm_squared() - matrix.norm_squared()).abs() < 1e3 * f64::EPSILON);
        let product: f64 = values.iter().product();
        assert!((product - matrix.determinant().abs()).abs() < 1e5 * f64::EPSILON);
    }
}

#[test]
fn extremes_of_singular_values() {
    assert_eq!(singular_values(&Matrix6::<f64>::zeros()), Vector6::zeros());
    let rank_one = Matrix6::<f64>::repeat(1.0);
    let values = singular_values(&rank_one);
    assert!((values[0] - 6.0).abs() < 1e-14 && values[1] < 1e-15);
    for bad in [f64::NAN, f64::INFINITY] {
        let mut matrix = Matrix6::<f64>::identity();
        matrix[(2, 3)] = bad;
        assert!(!singular_values(&matrix).iter().all(|x| x.is_finite()));
    }
    let subnormal = singular_values(&Matrix6::<f64>::from_diagonal_element(5e-324));
    assert!(subnormal.iter().all(|x| *x == 5e-324));
    // Columns at half a right angle whose lengths have no ratio that can be squared.
    for short in [1e-30, 1e-170, 1e-200, 1e-290] {
        let mut aslant = Matrix6::<f64>::identity();
        (aslant[(0, 1)], aslant[(1, 1)]) = (short, short);
        let values = singular_values(&aslant);
        assert!((values[5] / short - 1.0).abs() < 1e-14 && (values[0] - 1.0).abs() < 1e-14, "{values}");
    }
    // Columns whose squares underflow are put in order, too.
    let faint = Matrix6::from_diagonal(&Vector6::new(1e-200, 1.0, 1e-190, 1e-195, 1e-170, 1e-180));
    assert_eq!(singular_values(&faint).as_slice(), [1.0, 1e-170, 1e-180, 1e-190, 1e-195, 1e-200]);
}

fn sensor(matrix: Matrix6<f64>) -> SensorMatrix<f64, 6> {
    SensorMatrix::new(matrix, Vector6::repeat(1.0)).expect("proper")
}

#[test]
fn conditioning_of_known_matrices() {
    // Orthogonal columns of equal norm: as good as it gets.
    let mut random = generator(7);
    let best = Conditioning::of(&sensor(orthonormal::<6>(&mut random)));
    assert!((best.condition_number() - 1.0).abs() < 20.0 * f64::EPSILON);
    // Orthogonal columns alone are not enough.
    let diagonal =
        Conditioning::of(&sensor(Matrix6::from_diagonal(&Vector6::new(1.0, 2.0, 1.0, 1.0, 1.0, 4.0))));
    assert_eq!(diagonal.condition_number(), 4.0);
    assert_eq!(diagonal.skeel, Some(1.0));
    assert_eq!(diagonal.amplification, Some(Vector6::new(1.0, 0.5, 1.0, 1.0, 1.0, 0.25)));
    // Hilbert's matrix of order 6: N_c = 1.4951058642254665e7.
    let hilbert = Conditioning::of(&sensor(Matrix6::from_fn(|i, j| 1.0 / (i + j + 1) as f64)));
    assert!((hilbert.condition_number() / 1.495_105_864_225_466_5e7 - 1.0).abs() < 1e-8);
    // Scaling a gauge changes N_c, but not Skeel's number.
    let matrix = of_condition::<6>(&mut random, 100.0);
    let gauges = Vector6::new(1.0, 1e3, 1.0, 1e-3, 1.0, 1.0);
    let (plain, scaled) = (
        Conditioning::of(&sensor(matrix)),
        Conditioning::of(&sensor(Matrix6::from_diagonal(&gauges) * matrix)),
    );
    let (a, b) = (plain.skeel.expect("regular"), scaled.skeel.expect("regular"));
    assert!((a / b - 1.0).abs() < 1e-9);
    assert!(scaled.condition_number() > 10.0 * plain.condition_number());
    // A singular matrix says so.
    let mut singular = matrix;
    let row = singular.row(0).into_owned();
    singular.set_row(1, &row);
    let singular = Conditioning::of(&sensor(singular));
    assert!(singular.condition_number() > 1e14 && singular.skeel.is_none());
    assert!(matches!(singular.relative_error_bound(0.0, 0.01), Err(BeyondBound::MatrixMayBeSingular { .. })));
}

#[test]
fn equation_14_is_not_extrapolated() {
    let conditioning =
        Conditioning::of(&sensor(Matrix6::from_diagonal(&Vector6::new(1.0, 1.0, 1.0, 1.0, 1.0, 0.1))));
    assert!(conditioning.relative_error_bound(0.01, 0.099).is_ok());
    assert_eq!(
        conditioning.relative_error_bound(0.01, 0.125),
        Err(BeyondBound::MatrixMayBeSingular { product: 1.25 })
    );
    for bad in [-0.1, f64::NAN, f64::INFINITY] {
        assert_eq!(conditioning.relative_error_bound(bad, 0.0), Err(BeyondBound::BadRelativeError));
        assert_eq!(conditioning.relative_error_bound(0.0, bad), Err(BeyondBound::BadRelativeError));
    }
}

#[test]
fn amplification_is_the_noise_of_a_load() {
    let mut random = generator(8);
    let sensor = SensorMatrix::<f64, 8>::new(of_condition::<8>(&mut random, 10.0), Vector6::repeat(1.0))
        .expect("proper");
    let c = sensor.normalised();
    let covariance = (c.transpose() * c).try_inverse().expect("regular");
    let conditioning = Conditioning::of(&sensor);
    let amplification = conditioning.amplification.expect("regular");
    let worst = conditioning.worst_amplification.expect("regular");
    for axis in 0..6 {
        assert!((amplification[axis] / covariance[(axis, axis)].sqrt() - 1.0).abs() < 1e-11);
        assert!(worst[axis] >= amplification[axis] && worst[axis] <= amplification[axis] * 8.0_f64.sqrt());
    }
}
