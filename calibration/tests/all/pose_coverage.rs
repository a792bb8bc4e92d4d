//! Intervals of payloads, mountings and shapes from motion hold the truth as often as they say.

use fingertip_calibration::fit::student_factor;
use fingertip_calibration::gravity::{PayloadOptions, Pose, fit_orientation, fit_payload};
use fingertip_calibration::in_situ::refine;
use fingertip_calibration::motion::{LeverArm, constant_force, lever_arms};
use fingertip_calibration::nalgebra::{DMatrix, DVector, Matrix3, Matrix6, Rotation3, Vector3, Vector6};
use rand::SeedableRng as _;
use rand_pcg::Pcg64Mcg;

use super::coverage::{Coverage, LONG, SHORT};
use super::random::{gaussian, gaussians, sensor, turn, vector};

const CENTRE: Vector3<f64> = Vector3::new(0.02, -0.03, 0.05);
const FORCE: Vector3<f64> = Vector3::new(0.4, -0.3, 0.2);
const TORQUE: Vector3<f64> = Vector3::new(0.01, 0.02, -0.03);

/// Half the width of an interval of 95 %.
fn width((deviation, freedom): (f64, f64)) -> f64 {
    deviation * student_factor(0.95, freedom)
}

/// Roots of the covariance of a wrench's noise: alike; as different as a beam's along and across it; of gauges, whose noise
/// comes out in several components at once.
fn noises() -> [(&'static str, Matrix6<f64>); 3] {
    let alike = Matrix6::from_diagonal(&Vector6::new(0.02, 0.02, 0.02, 1e-3, 1e-3, 1e-3));
    let unequal = Matrix6::from_diagonal(&Vector6::new(0.01, 0.01, 0.05, 3e-3, 1e-3, 3e-4));
    let mut together = alike;
    (together[(3, 1)], together[(4, 0)], together[(2, 5)]) = (-8e-4, 8e-4, 0.015);
    [("alike", alike), ("unequal", unequal), ("correlated", together)]
}

fn wrench(force: Vector3<f64>, torque: Vector3<f64>) -> Vector6<f64> {
    Vector6::new(force.x, force.y, force.z, torque.x, torque.y, torque.z)
}

fn of_payloads(trials: usize) {
    let random = &mut Pcg64Mcg::seed_from_u64(321);
    for (name, root) in noises() {
        // Eight poses say too little of how unlike components are.
        let (few, more) = if name == "unequal" { (16, 20) } else { (8, 12) };
        for (count, down) in [(few, Some(-Vector3::z())), (more, None), (30, Some(-Vector3::z()))] {
            let turns: Vec<_> = (0..count).map(|_| turn(random)).collect();
            let weight = if down.is_some() { -3.0 * Vector3::z() } else { Vector3::new(0.6, 0.9, -2.8) };
            let options = PayloadOptions { down, ..PayloadOptions::default() };
            let coverage = Coverage::over(trials, || {
                let pose = |base_from_sensor: Matrix3<f64>| {
                    let pull = base_from_sensor.tr_mul(&weight);
                    let clean = wrench(pull + FORCE, CENTRE.cross(&pull) + TORQUE);
                    let noise = root * Vector6::from_fn(|_, _| gaussian(random));
                    Pose { base_from_sensor, wrench: clean + noise }
                };
                let poses: Vec<Pose> = turns.iter().copied().map(pose).collect();
                let fit = fit_payload(&poses, &options).unwrap();
                let freedom = &fit.freedom;
                let mut errors = vec![fit.weight.norm() - weight.norm()];
                let mut widths = vec![width((fit.weight_deviation, freedom.weight))];
                for (error, deviation, freedom) in [
                    (fit.centre_of_mass - CENTRE, fit.centre_deviation, freedom.centre),
                    (fit.force_bias - FORCE, fit.force_bias_deviation, freedom.force_bias),
                    (fit.torque_bias - TORQUE, fit.torque_bias_deviation, freedom.torque_bias),
                ] {
                    errors.extend(error.iter());
                    widths.extend((0..3).map(|i| width((deviation[i], freedom[i]))));
                }
                Some((errors, widths))
            });
            let what = format!("payload in {count} poses, noise {name}");
            coverage.holds(&what);
        }
    }
}

fn of_mountings(trials: usize) {
    let random = &mut Pcg64Mcg::seed_from_u64(322);
    for (name, root) in noises() {
        for count in [8, 20] {
            let (mount, turns) = (turn(random), (0..count).map(|_| turn(random)).collect::<Vec<_>>());
            Coverage::over(trials, || {
                let pose = |base_from_sensor: &Matrix3<f64>| {
                    let pull = mount * base_from_sensor.tr_mul(&Vector3::new(0.0, 0.0, -4.0));
                    let noise = root * Vector6::from_fn(|_, _| gaussian(random));
                    let wrench = wrench(pull + FORCE, Vector3::zeros()) + noise;
                    Pose { base_from_sensor: *base_from_sensor, wrench }
                };
                let poses: Vec<Pose> = turns.iter().map(pose).collect();
                let fit = fit_orientation(&poses, &-Vector3::z()).unwrap();
                let turned = Rotation3::from_matrix_unchecked(fit.sensor_from_flange * mount.transpose());
                let mut errors: Vec<f64> = turned.scaled_axis().iter().copied().collect();
                errors.push(fit.weight - 4.0);
                errors.extend((fit.force_bias - FORCE).iter());
                let mut deviations: Vec<f64> = fit.turn_deviation.iter().copied().collect();
                deviations.push(fit.weight_deviation);
                deviations.extend(fit.bias_deviation.iter());
                Some((errors, deviations.into_iter().zip(fit.freedom).map(width).collect()))
            })
            .holds(&format!("mounting in {count} poses, noise {name}"));
        }
    }
}

/// Forces of 5 N in any directions.
fn forces(random: &mut Pcg64Mcg, count: usize) -> Vec<Vector3<f64>> {
    (0..count).map(|_| vector(random).normalize() * 5.0).collect()
}

fn of_motions(trials: usize) {
    let random = &mut Pcg64Mcg::seed_from_u64(323);
    for (gauges, count) in [(3, 16), (5, 12), (6, 40)] {
        let (truth, forces) = (sensor(random, 3, gauges), forces(random, count));
        let zero = DVector::from_fn(gauges, |i, _| 10.0 - i as f64);
        let clean = DMatrix::from_fn(count, gauges, |i, j| {
            zero[j] + (0..3).map(|k| forces[i][k] * truth[(k, j)]).sum::<f64>()
        });
        Coverage::over(trials, || {
            let fit = constant_force(&(&clean + gaussians(random, count, gauges) * 0.02), 5.0).unwrap();
            let errors = (&fit.zero - &zero).iter().copied().collect();
            Some((errors, fit.zero_deviation.iter().map(|s| width((*s, fit.freedom))).collect()))
        })
        .holds(&format!("zero from motion, {gauges} gauges, {count} directions"));
    }
}

/// Lever arms with readings by a sensor of six gauges.
fn arms(random: &mut Pcg64Mcg, truth: &DMatrix<f64>, zero: &DVector<f64>) -> Vec<LeverArm> {
    [[0.1, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.0, 0.1], [-0.05, -0.06, 0.02]]
        .into_iter()
        .map(|arm| {
            let arm = Vector3::from(arm);
            let rows: Vec<_> = forces(random, 14)
                .iter()
                .map(|force| {
                    let load = wrench(*force, arm.cross(force));
                    (truth * DVector::from_column_slice(load.as_slice()) + zero).transpose()
                })
                .collect();
            LeverArm { arm, signals: DMatrix::from_rows(&rows) }
        })
        .collect()
}

fn of_lever_arms(trials: usize) {
    let random = &mut Pcg64Mcg::seed_from_u64(324);
    let mut truth = sensor(random, 6, 6).transpose();
    truth.columns_mut(3, 3).scale_mut(10.0);
    let zero = DVector::from_fn(6, |i, _| i as f64);
    let clean = arms(random, &truth, &zero);
    let seed = (0..200).find(|seed| lever_arms(&clean, 5.0, 1e-6, 1, *seed).is_ok()).unwrap();
    Coverage::over(trials, || {
        let noisy: Vec<LeverArm> = (clean.iter())
            .map(|arm| LeverArm { signals: &arm.signals + gaussians(random, 14, 6) * 1e-3, ..arm.clone() })
            .collect();
        let fit = lever_arms(&noisy, 5.0, 1e-2, 1, seed).unwrap();
        let fit = fit.with_sign(&(truth.column(0) + &zero), &Vector3::x()).unwrap();
        let mut errors: Vec<f64> = (&fit.sensitivities - &truth).iter().copied().collect();
        errors.extend((&fit.zero - &zero).iter());
        let deviations = fit.deviations.iter().chain(fit.zero_deviation.iter());
        Some((errors, deviations.map(|s| width((*s, fit.freedom))).collect()))
    })
    .holds("sensor from weights on lever arms");
}

/// The errors are stated, so that there is no freedom to lose.
fn of_mended(trials: usize) {
    let random = &mut Pcg64Mcg::seed_from_u64(325);
    let truth = sensor(random, 6, 6);
    let inverse = truth.clone().try_inverse().unwrap();
    let known = gaussians(random, 7, 6);
    let loads = &known * truth.transpose();
    let places: Vec<_> = (0..40).map(|_| (vector(random), vector(random))).collect();
    let (pitch, noise) = (1e-3, 2e-3);
    Coverage::over(trials, || {
        let mut touches = DMatrix::zeros(40, 6);
        for (i, (force, point)) in places.iter().enumerate() {
            let torque = point.cross(force);
            let torque = torque + force.normalize() * (torque.norm() * pitch * gaussian(random));
            let load = wrench(*force, torque);
            touches.set_row(i, &(&inverse * DVector::from_column_slice(load.as_slice())).transpose());
        }
        let measured = &loads + gaussians(random, 7, 6) * noise;
        let fit = refine(&truth, &touches, pitch, &known, &measured, noise).unwrap();
        let errors = (&fit.loads_per_signal - &truth).as_slice().to_vec();
        Some((errors, fit.deviations.iter().map(|s| width((*s, f64::INFINITY))).collect()))
    })
    .holds("sensor mended by touches and loads");
}

#[test]
fn intervals_of_payloads_hold() {
    of_payloads(SHORT);
}

#[test]
fn intervals_of_mountings_hold() {
    of_mountings(SHORT);
}

#[test]
fn intervals_of_shapes_from_motion_hold() {
    of_motions(SHORT);
}

#[test]
fn intervals_of_lever_arms_hold() {
    of_lever_arms(SHORT);
}

#[test]
#[ignore = "long: 2 000 trials of each"]
fn intervals_of_payloads_and_motion_hold_in_many_trials() {
    of_payloads(LONG);
    of_mountings(LONG);
    of_motions(LONG);
    // Each takes a second or so.
    of_mended(SHORT);
    of_lever_arms(LONG);
}
