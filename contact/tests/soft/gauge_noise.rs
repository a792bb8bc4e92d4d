//! What the noise of gauges does to wrench and contact force.

use fingertip_contact::{
    CalibrationUncertainty, Contact, ContactCovariance, ContactJacobian, ContactModel, PointContact,
    SensorUncertainty, SoftFinger, WrenchNoise,
};
use fingertip_surfaces::SmoothSurface;
use fingertip_test_support::Worst;
use fingertip_wrench::{GaussianElimination, SensorMatrix, Wrench, WrenchSolver};
use nalgebra::{Matrix2, Matrix3, Matrix6, Vector6};

use crate::common;
use crate::wrenches::{Case, Random};

/// From gauges with noise and a matrix with errors to the wrench.
#[test]
fn gauges_to_wrench_match_monte_carlo() {
    let mut random = Random::new(7);
    let matrix = Matrix6::from_fn(|i, j| if i == j { 2.0 } else { 0.0 } + random.uniform(-0.4, 0.4));
    let nominal = Vector6::new(10.0, 10.0, 10.0, 0.1, 0.1, 0.1);
    let sensor = SensorMatrix::new(matrix, nominal).unwrap();
    let solver = GaussianElimination::new(&sensor).unwrap();
    let wrench = Wrench::from_components(&Vector6::new(2.0, -3.0, 5.0, 0.02, 0.01, -0.03));
    let noise = Vector6::new(1e-3, 2e-3, 1e-3, 3e-3, 1e-3, 2e-3);
    // Relative errors of 1e-3 in the sensitivities, correlated within each row.
    let rows = core::array::from_fn(|_| {
        let scale = Matrix6::from_diagonal(&nominal.map(|n| 2e-3 / n));
        let mix = Matrix6::from_fn(|_, _| random.uniform(-0.5, 0.5)) + Matrix6::identity();
        scale * mix * mix.transpose() * scale
    });
    let uncertainty =
        SensorUncertainty::independent(&solver, &noise).unwrap().with_calibration(rows).unwrap();
    let predicted = uncertainty.wrench_covariance(&wrench);
    // Rows that are uncertain alike are what a fit to the same loads leaves.
    let alike = core::array::from_fn(|gauge| rows[0] * noise[gauge] * noise[gauge]);
    let of_rows = SensorUncertainty::independent(&solver, &Vector6::zeros()).unwrap();
    let of_rows = of_rows.with_calibration(alike).unwrap().wrench_covariance(&wrench);
    let readings = SensorUncertainty::independent(&solver, &noise).unwrap().wrench_covariance(&wrench);
    let fit = CalibrationUncertainty::new(readings, rows[0]).unwrap().covariance(&wrench);
    assert!((fit - of_rows).norm() < 1e-12 * of_rows.norm(), "{fit} for {of_rows}");
    let factors = rows.map(|row: Matrix6<f64>| row.cholesky().unwrap().l());
    let mut sums = Matrix6::zeros();
    let count = 60_000;
    for _ in 0..count {
        let mut signals = sensor.signals(&wrench);
        for gauge in 0..6 {
            let wrong = factors[gauge] * Vector6::from_fn(|_, _| random.normal());
            signals[gauge] += noise[gauge] * random.normal() - wrong.dot(&wrench.components());
        }
        let error = solver.solve(&signals).components() - wrench.components();
        sums += error * error.transpose();
    }
    let deviations = predicted.diagonal().map(f64::sqrt);
    let difference =
        (sums / f64::from(count) - predicted).component_div(&(deviations * deviations.transpose()));
    assert!(Worst::of(difference.iter().copied()).get() < 0.03, "{difference}");
    let sheet = WrenchNoise { floor: Vector6::repeat(0.1), relative: 0.01 };
    assert!((sheet.covariance(&wrench)[(2, 2)] - (0.01 + 0.05_f64.powi(2))).abs() < 1e-15);
    let nan = Vector6::repeat(f64::NAN);
    assert!(SensorUncertainty::independent(&solver, &nan).is_err());
}

/// All the way: gauges with noise and a matrix with errors, the wrench solved from them, a soft finger
/// under it, its normal and tangential force.
#[test]
fn gauges_to_normal_and_tangential_force_match_monte_carlo() {
    let surface = common::ellipsoid::<f64>();
    let mut random = Random::new(9);
    let matrix = Matrix6::from_fn(|i, j| if i == j { 2.0 } else { 0.0 } + random.uniform(-0.4, 0.4));
    let nominal = Vector6::new(10.0, 10.0, 10.0, 0.1, 0.1, 0.1);
    let sensor = SensorMatrix::new(matrix, nominal).unwrap();
    let solver = GaussianElimination::new(&sensor).unwrap();
    // Noise of some 2 mN, and relative errors of 5e-4 in the sensitivities, correlated within each gauge.
    let noise = Vector6::new(2e-4, 4e-4, 2e-4, 6e-4, 2e-4, 4e-4);
    let rows = core::array::from_fn(|_| {
        let scale = Matrix6::from_diagonal(&nominal.map(|n| 1e-3 / n));
        let mix = Matrix6::from_fn(|_, _| random.uniform(-0.5, 0.5)) + Matrix6::identity();
        scale * mix * mix.transpose() * scale
    });
    let factors = rows.map(|row: Matrix6<f64>| row.cholesky().unwrap().l());
    let uncertainty =
        SensorUncertainty::independent(&solver, &noise).unwrap().with_calibration(rows).unwrap();
    for soft in [false, true] {
        let case = loop {
            let spins = if soft { [0.1, 0.5] } else { [1e-12, 1e-11] };
            let case = Case::random(&mut random, &surface, 0.017, spins, 5.0);
            if (0.7..0.9).contains(&case.incidence) {
                break case;
            }
        };
        let resolve = |wrench: &Wrench<f64>| -> Contact<f64> {
            *if soft {
                SoftFinger::new(0.0).unwrap().without_friction_limit().resolve(wrench, &surface)
            } else {
                PointContact::new(0.0).unwrap().resolve(wrench, &surface)
            }
            .contact()
            .unwrap()
        };
        let truth = resolve(&case.wrench);
        let jacobian = if soft {
            ContactJacobian::of_soft_finger_on(&truth, &surface)
        } else {
            let bend = surface.shape_operator(&truth.point);
            ContactJacobian::of_point_contact(&truth, &case.wrench, &bend)
        }
        .unwrap();
        let of_wrench = uncertainty.wrench_covariance(&case.wrench);
        let predicted = ContactCovariance::new(&jacobian, &of_wrench);
        let ellipse = predicted.ellipse(0.95).unwrap();
        let (mut forces, mut points, mut inside) = (Matrix2::zeros(), Matrix3::zeros(), 0);
        let count = 40_000;
        for _ in 0..count {
            let mut signals = sensor.signals(&case.wrench);
            for gauge in 0..6 {
                let wrong = factors[gauge] * Vector6::from_fn(|_, _| random.normal());
                signals[gauge] += noise[gauge] * random.normal() - wrong.dot(&case.wrench.components());
            }
            let contact = resolve(&solver.solve(&signals));
            let pair = nalgebra::Vector2::new(
                contact.normal_force() - truth.normal_force(),
                contact.tangential_force().norm() - truth.tangential_force().norm(),
            );
            forces += pair * pair.transpose();
            let moved = contact.point - truth.point;
            points += moved * moved.transpose();
            let [a, b] = [0, 1].map(|i| moved.dot(&ellipse.directions[i]) / ellipse.semi_axes[i]);
            inside += usize::from(a * a + b * b <= 1.0);
        }
        let (forces, points) = (forces / f64::from(count), points / f64::from(count));
        let expected = predicted.normal_and_tangential(&truth);
        let deviations = expected.diagonal().map(f64::sqrt);
        let of_forces = (forces - expected).component_div(&(deviations * deviations.transpose()));
        let of_forces = Worst::of(of_forces.iter().copied()).get();
        let of_points = (points - predicted.point()).norm() / predicted.point().norm();
        let coverage = inside as f64 / f64::from(count);
        println!(
            "gauges to forces, soft {soft}: sd of normal {:.1} mN, tangential {:.1} mN; Monte Carlo deviates \
             {:.2} %, of the point {:.2} %, 95 % ellipse holds {:.2} %",
            deviations[0] * 1e3,
            deviations[1] * 1e3,
            100.0 * of_forces,
            100.0 * of_points,
            100.0 * coverage
        );
        assert!(of_forces < 0.03 && of_points < 0.03 && (0.94..=0.96).contains(&coverage));
    }
}
