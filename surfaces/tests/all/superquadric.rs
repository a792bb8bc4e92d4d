//! Superquadrics: their level function and its derivatives, for all exponents, beside the axes and on them.

use fingertip_surfaces::*;
use nalgebra::{Matrix3, Vector3};
use num_dual::{DualNum, HyperDual64};
use proptest::prelude::*;

use crate::every_shape::v;

const SEMI_AXES: [f64; 3] = [1.0, 0.5, 0.75];

/// `(|x/a|^(2/e₂) + |y/b|^(2/e₂))^(e₂/e₁) + |z/c|^(2/e₁)`, to the power e₁/2: Barr 1981, written down.
fn gauge(p: [HyperDual64; 3], [e1, e2]: [f64; 2]) -> HyperDual64 {
    let scaled = |k: usize| {
        let x = p[k] / SEMI_AXES[k];
        if x.re < 0.0 { -x } else { x }
    };
    let power =
        |x: HyperDual64, p: f64| if x.re == 0.0 && p > 2.0 { HyperDual64::from_re(0.0) } else { x.powf(p) };
    let plane = power(scaled(0), 2.0 / e2) + power(scaled(1), 2.0 / e2);
    (power(plane, e2 / e1) + power(scaled(2), 2.0 / e1)).powf(e1 / 2.0)
}

fn expected(p: &Vector3<f64>, exponents: [f64; 2]) -> (f64, Vector3<f64>, Matrix3<f64>) {
    let mut gradient = Vector3::zeros();
    let mut value = 0.0;
    let hessian = Matrix3::from_fn(|i, j| {
        let number =
            |k: usize| HyperDual64::new(p[k], f64::from(u8::from(k == i)), f64::from(u8::from(k == j)), 0.0);
        let found = gauge([number(0), number(1), number(2)], exponents);
        gradient[i] = found.eps1;
        value = found.re - 1.0;
        found.eps1eps2
    });
    (value, gradient, hessian)
}

#[test]
fn levels_are_those_of_the_equation() {
    let directions = [
        [0.3, -0.4, 0.8],
        [-0.9, 0.2, -0.1],
        [0.05, 0.6, 0.02],
        [-0.2, -0.3, 0.9],
        [0.01, -0.01, -0.5],
        [0.7, 1e-3, 0.4],
    ];
    for exponents in
        [[1.0, 1.0], [0.5, 0.8], [1.5, 0.7], [0.7, 1.5], [2.0, 2.0], [2.0, 1.0], [1.0, 2.0], [0.3, 0.2]]
    {
        let shape = Superquadric::new(SEMI_AXES.into(), exponents).unwrap();
        for direction in directions.map(Vector3::from) {
            for size in [1e-3, 1.0, 1.5, 1e4] {
                let point = direction * size;
                let level = shape.level(&point);
                let (value, gradient, hessian) = expected(&point, exponents);
                let name = format!("{exponents:?} {direction} {size}");
                assert!(
                    (level.value - value).abs() <= 1e-13 * (value + 1.0),
                    "{name}: {} {value}",
                    level.value
                );
                assert!((level.gradient - gradient).norm() <= 1e-12 * gradient.norm(), "{name}");
                let off = (level.hessian - hessian).norm();
                let steep = hessian.norm() + gradient.norm() / point.norm();
                assert!(off <= 1e-11 * steep, "{name}: {} {hessian}", level.hessian);
                assert!((shape.normal(&point) - gradient.normalize()).norm() < 1e-12, "{name}");
            }
        }
    }
}

/// Where the equation has no second derivatives, they are large, but numbers.
#[test]
fn levels_are_numbers_on_axes_and_planes() {
    for exponents in [[1.0, 1.0], [0.5, 0.8], [1.5, 0.7], [0.7, 1.5], [2.0, 2.0], [2.0, 0.05], [0.05, 2.0]] {
        let shape = Superquadric::new(SEMI_AXES.into(), exponents).unwrap();
        for point in [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, -0.5, 0.0],
            [0.0, 0.0, 0.75],
            [0.5, 0.25, 0.0],
            [-0.5, 0.0, 0.3],
            [0.0, 0.3, -0.3],
        ] {
            let point = Vector3::from(point);
            let level = shape.level(&point);
            let all = level.hessian.iter().chain(&level.gradient).chain([&level.value]);
            assert!(all.clone().all(|x| x.is_finite()), "{exponents:?} {point}: {level:?}");
            assert!(level.hessian.symmetric_eigenvalues().min() >= -1e-9 * level.hessian.norm());
            let [e1, e2] = exponents;
            // With squares and higher powers only there are derivatives.
            if e1 < 1.0 && e2 < 1.0 && point.xy().norm() > 0.0 {
                let (value, gradient, hessian) = expected(&point, exponents);
                assert!((level.value - value).abs() < 1e-13 && (level.gradient - gradient).norm() < 1e-12);
                assert!(
                    (level.hessian - hessian).norm() < 1e-6 * hessian.norm().max(1.0),
                    "{point} {hessian}"
                );
            }
            // The gauge grows in proportion.
            let grown = gauge_of(&shape, &(point * 2.0));
            assert!((grown - 2.0 * gauge_of(&shape, &point)).abs() < 1e-13 * grown.max(1.0));
        }
    }
    let ball = Superquadric::new(v(2.0, 2.0, 2.0), [1.0, 1.0]).unwrap();
    for axis in [Vector3::x(), Vector3::y(), Vector3::z()] {
        let operator = ball.shape_operator(&(axis * 2.0));
        let exact = (Matrix3::identity() - axis * axis.transpose()) / 2.0;
        assert!((operator - exact).norm() < 1e-9, "{operator}");
    }
}

fn gauge_of(shape: &Superquadric<f64>, point: &Vector3<f64>) -> f64 {
    shape.level(point).value + 1.0
}

proptest! {
    /// Logarithms that powers share say the same as powers of their own, up to the roundings that an exponent multiplies; and
    /// one over the value comes with it.
    #[test]
    fn fine_powers_have_the_digits_of_the_type(
        v in [0.001_f64..1.0, 0.001..1.0, 0.001..1.0],
        exponents in [0.05_f64..1.99, 0.05..1.99],
        stretch in 0.7_f64..1.4,
    ) {
        let shape = Superquadric::new(Vector3::repeat(1.0), exponents).unwrap();
        let away = Vector3::from(v) * (stretch / shape.gauge_near(&v.into(), Powers::Exact).value);
        let gauges = [Powers::Exact, Powers::Fine, Powers::Quick].map(|powers| shape.gauge_near(&away, powers));
        for gauge in &gauges {
            prop_assert!((gauge.value * gauge.inverse - 1.0).abs() < 1e-7, "{} {}", gauge.value, gauge.inverse);
        }
        let [exact, fine, _] = gauges;
        prop_assert!((fine.value * fine.inverse - 1.0).abs() < 4.0 * f64::EPSILON);
        let goal = 64.0 * f64::EPSILON * exponents.into_iter().fold(1.0, |most: f64, e| most.max(2.0 / e));
        prop_assert!((fine.value / exact.value - 1.0).abs() < goal, "{} {}", fine.value, exact.value);
        prop_assert!((fine.gradient - exact.gradient).norm() < goal * exact.gradient.norm());
        for ((k, way), (exact_k, exact_way)) in fine.bends.into_iter().zip(exact.bends) {
            prop_assert!((k - exact_k).abs() <= goal * exact_k.abs(), "{k} {exact_k}");
            prop_assert!((way - exact_way).norm() <= goal * exact_way.norm());
        }
    }
}
