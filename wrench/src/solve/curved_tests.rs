//! Curved sensors against the sum as the formula has it, and against differences.

use nalgebra::{SMatrix, SVector, Vector6};
use proptest::prelude::*;

use super::{BadCurve, CurvedInverse, ProductTerm, RadialTerm};
use crate::{Real, WrenchSolver as _};

/// Different in every coefficient.
fn coefficient<T: Real>(axis: usize, i: usize, j: usize) -> T {
    T::literal(((1 + axis) as f64 * 1.3 + (3 + i) as f64 * 0.7 + (5 + j) as f64 * 2.9).sin())
}

fn linear<T: Real, const N: usize>() -> SMatrix<T, 6, N> {
    SMatrix::from_fn(|axis, gauge| coefficient::<T>(axis, 17, gauge) * T::literal(10.0))
}

fn load<T: Real>(i: usize, j: usize) -> Vector6<T> {
    Vector6::from_fn(|axis, _| coefficient(axis, i, j))
}

const CUBES: [[u8; 3]; 4] = [[0, 0, 0], [0, 1, 2], [3, 3, 5], [7, 4, 4]];

/// All pairs, and some products of three.
fn products<T: Real>() -> Vec<ProductTerm<T>> {
    let pairs = (0..8_u8).flat_map(|i| (i..8).map(move |j| (i, j)));
    let pairs = pairs.map(|(i, j)| ProductTerm::of_two(i, j, load(usize::from(i), usize::from(j))));
    let cubes =
        CUBES.iter().enumerate().map(|(k, [a, b, c])| ProductTerm::of_three(*a, *b, *c, load(20 + k, 3)));
    pairs.chain(cubes).collect()
}

fn widths() -> [f64; 8] {
    core::array::from_fn(|i| 0.5 + 0.3 * i as f64)
}

fn centres() -> [[f64; 8]; 3] {
    core::array::from_fn(|k| core::array::from_fn(|i| coefficient::<f64>(k, 31, i)))
}

type Sensor<T> = CurvedInverse<T, 8, Vec<ProductTerm<T>>, Vec<RadialTerm<T, 8>>>;

fn sensor<T: Real>() -> Sensor<T> {
    let radial = centres().into_iter().enumerate().map(|(k, centre)| RadialTerm {
        centre: SVector::from(centre.map(T::literal)),
        load: load(40 + k, 5),
    });
    let curved = CurvedInverse::new(linear(), products()).unwrap();
    curved.with_radial(SVector::from(widths().map(T::literal)), radial.collect()).unwrap()
}

/// The sum as the formula has it, component by component; the slope of the bumps by differences of the eighth digit.
fn by_formula(signals: &[f64; 8], axis: usize) -> f64 {
    let linear = linear::<f64, 8>();
    let mut expected: f64 = (0..8).map(|i| linear[(axis, i)] * signals[i]).sum();
    for i in 0..8 {
        for j in i..8 {
            expected += coefficient::<f64>(axis, i, j) * signals[i] * signals[j];
        }
    }
    for (k, factors) in CUBES.iter().enumerate() {
        let product: f64 = factors.iter().map(|i| signals[usize::from(*i)]).product();
        expected += coefficient::<f64>(axis, 20 + k, 3) * product;
    }
    for (k, centre) in centres().iter().enumerate() {
        let height = |at: &dyn Fn(usize) -> f64| {
            let square: f64 = (0..8).map(|i| ((at(i) - centre[i]) / widths()[i]).powi(2)).sum();
            1.0 / (1.0 + square).sqrt()
        };
        let along = |step: f64| height(&|i| step * signals[i]);
        let slope = (along(1e-4) - along(-1e-4)) / 2e-4;
        expected += coefficient::<f64>(axis, 40 + k, 5) * (along(1.0) - along(0.0) - slope);
    }
    expected
}

proptest! {
    #[test]
    fn every_term_counts_once(signals in proptest::array::uniform8(-3.0..3.0_f64)) {
        let found = sensor::<f64>().solve(&SVector::from(signals)).components();
        let narrow = sensor::<f32>().solve(&SVector::from(signals.map(|x| x as f32))).components();
        for axis in 0..6 {
            let expected = by_formula(&signals, axis);
            prop_assert!((found[axis] - expected).abs() < 1e-6, "{} for {expected}", found[axis]);
            prop_assert!((f64::from(narrow[axis]) - expected).abs() < 3e-3);
        }
    }

    /// Against differences, which err by the third derivative.
    #[test]
    fn the_jacobian_is_the_slope(signals in proptest::array::uniform8(-3.0..3.0_f64), gauge in 0..8_usize) {
        let (sensor, at) = (sensor::<f64>(), SVector::from(signals));
        let step = SVector::<f64, 8>::ith(gauge, 1e-4);
        let away = |step| sensor.solve(&(at + step)).components();
        let slope = (away(step) - away(-step)) / 2e-4;
        let difference = sensor.jacobian(&at).column(gauge) - slope;
        prop_assert!(difference.amax() < 1e-6, "{difference}");
    }
}

/// A tare keeps its meaning, and the linear part is the sensor of small loads.
#[test]
fn without_load_only_the_linear_part_is_left() {
    let sensor = sensor::<f64>();
    assert!(sensor.solve(&SVector::zeros()).components().amax() < 1e-15);
    assert!((sensor.jacobian(&SVector::zeros()) - linear::<f64, 8>()).amax() < 1e-14);
    let straight =
        CurvedInverse::new(linear::<f64, 7>(), [ProductTerm::of_two(0, 6, Vector6::zeros())]).unwrap();
    let signals = SVector::from_fn(|i, _| 0.1 * i as f64 - 0.3);
    let difference = straight.solve(&signals).components() - linear::<f64, 7>() * signals;
    assert!(difference.amax() < 1e-13);
}

#[test]
fn terms_that_are_none_are_refused() {
    for bad in [f64::NAN, f64::INFINITY] {
        let broken = |place: usize| {
            let load = Vector6::from_fn(|i, _| if i == place { bad } else { 1.0 });
            CurvedInverse::<f64, 6, _>::new(
                linear(),
                [ProductTerm::of_two(0, 0, Vector6::x()), ProductTerm::of_two(0, 5, load)],
            )
        };
        assert!((0..6).all(|place| broken(place).err() == Some(BadCurve::NotFinite)));
        assert!(broken(6).is_ok());
        let crooked = SMatrix::<f64, 6, 6>::repeat(bad);
        assert!(CurvedInverse::new(crooked, [ProductTerm::of_two(0, 0, Vector6::zeros())]).is_err());
        let radial = |centre, load| {
            let curved =
                CurvedInverse::new(linear::<f64, 6>(), [ProductTerm::of_two(0, 0, Vector6::zeros())]);
            curved.unwrap().with_radial(Vector6::repeat(1.0), [RadialTerm { centre, load }])
        };
        assert!(radial(Vector6::repeat(0.1), Vector6::y()).is_ok());
        for (centre, load) in [(Vector6::repeat(bad), Vector6::y()), (Vector6::y(), Vector6::repeat(bad))] {
            assert_eq!(radial(centre, load).err(), Some(BadCurve::NotFinite));
        }
    }
    for (term, signal) in [
        (ProductTerm::of_two(0, 6, Vector6::<f64>::x()), 6),
        (ProductTerm::of_two(7, 0, Vector6::x()), 7),
        (ProductTerm::of_three(5, 5, 9, Vector6::x()), 9),
    ] {
        let error = CurvedInverse::new(linear::<f64, 6>(), [term]).unwrap_err();
        assert_eq!(error, BadCurve::NoSuchSignal { signal, gauges: 6 });
        assert!(error.to_string().contains(&format!("gauge {}", signal + 1)), "{error}");
    }
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-320] {
        let curved = CurvedInverse::new(linear::<f64, 8>(), products()).unwrap();
        let widths = SVector::from_fn(|i, _| if i == 3 { bad } else { 1.0 });
        assert_eq!(curved.with_radial(widths, Vec::new()).unwrap_err(), BadCurve::Width, "{bad}");
    }
}

#[test]
fn extremes_overflow_and_do_not_panic() {
    for size in [0.0, 1e-320, 1e90, 1e200, f64::MAX, f64::INFINITY, f64::NAN] {
        let wrench = sensor::<f64>().solve(&SVector::repeat(size));
        assert_eq!(wrench.is_finite(), size < 1e100, "{size}: {wrench:?}");
        let slopes = sensor::<f64>().jacobian(&SVector::repeat(size));
        assert_eq!(slopes.iter().all(|x| x.is_finite()), size < 1e100, "{size}");
    }
}
