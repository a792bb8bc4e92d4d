//! Gravity poses: errors as stated, and the same payload in any units, order and frame.

use fingertip_calibration::gravity::{PayloadOptions, Pose, fit_orientation, fit_payload};
use fingertip_calibration::nalgebra::{DMatrix, Matrix3, Rotation3, Vector3, Vector6};
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64Mcg;

use super::random::{turn, vector};
use super::spread::Spread;
use super::testing::Largest as _;

const CENTRE: Vector3<f64> = Vector3::new(0.02, -0.03, 0.05);
const FORCE: Vector3<f64> = Vector3::new(0.4, -0.3, 0.2);
const TORQUE: Vector3<f64> = Vector3::new(0.01, 0.02, -0.03);
/// Noise of forces \[N\] and of torques \[N·m\]: the errors of the centre of mass come of both alike.
const NOISE: (f64, f64) = (0.02, 1e-3);

fn wrench(force: Vector3<f64>, torque: Vector3<f64>) -> Vector6<f64> {
    Vector6::new(force.x, force.y, force.z, torque.x, torque.y, torque.z)
}

/// What the sensor reads of a weight of 3 N in the base frame.
fn reading(base_from_sensor: &Matrix3<f64>, weight: &Vector3<f64>, noise: &mut Pcg64Mcg) -> Pose {
    let pull = base_from_sensor.tr_mul(weight);
    let force = pull + FORCE + vector(noise) * NOISE.0;
    let torque = CENTRE.cross(&pull) + TORQUE + vector(noise) * NOISE.1;
    Pose { base_from_sensor: *base_from_sensor, wrench: wrench(force, torque) }
}

/// Of a weight whose direction is known, or is found too.
fn errors_are_as_stated(down: Option<Vector3<f64>>, weight: Vector3<f64>) {
    let random = &mut Pcg64Mcg::seed_from_u64(31);
    let turns: Vec<_> = (0..8).map(|_| turn(random)).collect();
    let options = PayloadOptions { down, ..PayloadOptions::default() };
    let spread = Spread::over(10_000, || {
        let poses: Vec<Pose> = turns.iter().map(|turn| reading(turn, &weight, random)).collect();
        let fit = fit_payload(&poses, &options).unwrap();
        let mut errors = vec![fit.weight.norm() - weight.norm()];
        let mut variances = vec![fit.weight_deviation.powi(2)];
        if down.is_none() {
            // Two turns together, each as large.
            errors.push(fit.weight.angle(&weight) / core::f64::consts::SQRT_2);
            variances.push(fit.direction_deviation.powi(2));
        }
        for (error, deviation) in [
            (fit.centre_of_mass - CENTRE, fit.centre_deviation),
            (fit.force_bias - FORCE, fit.force_bias_deviation),
            (fit.torque_bias - TORQUE, fit.torque_bias_deviation),
        ] {
            errors.extend(error.iter());
            variances.extend(deviation.iter().map(|deviation| deviation * deviation));
        }
        (errors, variances)
    });
    // What chance makes of the weights of the components is known to first order.
    spread.agrees_within("payload", 0.16);
}

#[test]
fn errors_of_the_payload_are_as_stated() {
    errors_are_as_stated(None, Vector3::new(0.6, 0.9, -2.8));
}

#[test]
fn errors_of_the_payload_under_a_known_gravity_are_as_stated() {
    errors_are_as_stated(Some(-Vector3::z()), Vector3::new(0.0, 0.0, -3.0));
}

#[test]
fn errors_of_the_mounting_are_as_stated() {
    let random = &mut Pcg64Mcg::seed_from_u64(32);
    let (mount, turns) = (turn(random), (0..10).map(|_| turn(random)).collect::<Vec<_>>());
    let spread = Spread::over(8_000, || {
        let poses: Vec<Pose> = turns
            .iter()
            .map(|turn| {
                let force =
                    mount * turn.tr_mul(&Vector3::new(0.0, 0.0, -4.0)) + FORCE + vector(random) * 0.02;
                Pose { base_from_sensor: *turn, wrench: wrench(force, Vector3::zeros()) }
            })
            .collect();
        let fit = fit_orientation(&poses, &-Vector3::z()).unwrap();
        let turned = Rotation3::from_matrix_unchecked(fit.sensor_from_flange * mount.transpose());
        let mut errors: Vec<f64> = turned.scaled_axis().iter().copied().collect();
        errors.push(fit.weight - 4.0);
        errors.extend((fit.force_bias - FORCE).iter());
        let mut deviations: Vec<f64> = fit.turn_deviation.iter().copied().collect();
        deviations.push(fit.weight_deviation);
        deviations.extend(fit.bias_deviation.iter());
        (errors, deviations.iter().map(|deviation| deviation * deviation).collect())
    });
    spread.agrees("mounting");
}

/// One of the 24 ways to name the axes of a frame anew.
fn quarter_turns(random: &mut Pcg64Mcg) -> Matrix3<f64> {
    let about = |axis: &Vector3<f64>, quarters: i32| {
        let turn = Rotation3::new(axis * (core::f64::consts::FRAC_PI_2 * f64::from(quarters)));
        turn.into_inner().map(f64::round)
    };
    let quarters = (random.random_range(0..4), random.random_range(0..4), random.random_range(0..4));
    about(&Vector3::x(), quarters.0) * about(&Vector3::y(), quarters.1) * about(&Vector3::z(), quarters.2)
}

/// Base frame turned, axes of the sensor named anew, forces and lengths in other units, poses in another order.
#[test]
fn payload_and_mounting_do_not_mind_units_order_and_frames() {
    let random = &mut Pcg64Mcg::seed_from_u64(33);
    for _ in 0..100 {
        let weight = Vector3::new(0.6, 0.9, -2.8);
        let poses: Vec<Pose> = (0..8).map(|_| reading(&turn(random), &weight, random)).collect();
        // The base may stand crooked, but not upside down.
        let base = core::iter::repeat_with(|| turn(random)).find(|base| (base * weight).z < 0.0).unwrap();
        // How noisy each component is goes with the axes of the sensor, which stay.
        let sensor = quarter_turns(random);
        let (newton, metre) =
            (10_f64.powi(random.random_range(-6..6)), 10_f64.powi(random.random_range(-3..4)));
        let other: Vec<Pose> = (0..8)
            .map(|i| {
                let pose = &poses[(3 * i + 5) % 8];
                let force = sensor * pose.wrench.fixed_rows::<3>(0) * newton;
                let torque = sensor * pose.wrench.fixed_rows::<3>(3) * (newton * metre);
                let base_from_sensor = base * pose.base_from_sensor * sensor.transpose();
                Pose { base_from_sensor, wrench: wrench(force, torque) }
            })
            .collect();
        let options = PayloadOptions { down: None, ..PayloadOptions::default() };
        let Ok(fit) = fit_payload(&poses, &options) else { continue };
        let same = fit_payload(&other, &PayloadOptions { down: None, ..options }).unwrap();
        // Rounding, as often as the poses are conditioned and the weight stands over the biases.
        let close = |a: Vector3<f64>, b: Vector3<f64>, size: f64| {
            let allowed = 1e3 * f64::EPSILON * fit.condition_number.powi(2) * size;
            assert!((a - b).largest() < allowed, "{a} {b}");
        };
        close(same.weight / newton, base * fit.weight, 3.0);
        close(same.centre_of_mass / metre, sensor * fit.centre_of_mass, 0.1);
        close(same.force_bias / newton, sensor * fit.force_bias, 3.0);
        close(same.torque_bias / (newton * metre), sensor * fit.torque_bias, 0.3);
        let near = |a: f64, b: f64| {
            assert!((a / b - 1.0).abs() < 1e-8 * fit.condition_number.powi(2), "{a} {b}");
        };
        near(same.weight_deviation / newton, fit.weight_deviation);
        near(same.freedom.weight, fit.freedom.weight);
        let named = sensor.map(f64::abs);
        for i in 0..3 {
            near(same.centre_deviation[i] / metre, (named * fit.centre_deviation)[i]);
            near(same.torque_bias_deviation[i] / (newton * metre), (named * fit.torque_bias_deviation)[i]);
            near(same.freedom.centre[i], (named * fit.freedom.centre)[i]);
        }
        // The mounting turns with the sensor, whose flange is the former frame.
        let down = weight.normalize();
        let one = fit_orientation(&poses, &down).unwrap();
        let turned: Vec<Pose> = poses
            .iter()
            .rev()
            .map(|pose| {
                let force = sensor * pose.wrench.fixed_rows::<3>(0) * newton;
                let base_from_sensor = base * pose.base_from_sensor;
                Pose { base_from_sensor, wrench: wrench(force, Vector3::zeros()) }
            })
            .collect();
        let two = fit_orientation(&turned, &(base * down)).unwrap();
        let allowed = 1e3 * f64::EPSILON * fit.condition_number.powi(2);
        assert!((two.sensor_from_flange - sensor * one.sensor_from_flange).largest() < allowed);
        assert!((two.weight / newton - one.weight).abs() < 4.0 * allowed);
        close(two.force_bias / newton, sensor * one.force_bias, 3.0);
        near(two.weight_deviation / newton, one.weight_deviation);
        near(two.freedom[3], one.freedom[3]);
        let of = |freedom: &[f64; 7], first: usize| Vector3::from_fn(|i, _| freedom[first + i]);
        for i in 0..3 {
            near(two.turn_deviation[i], (named * one.turn_deviation)[i]);
            near(two.bias_deviation[i] / newton, (named * one.bias_deviation)[i]);
            near(of(&two.freedom, 0)[i], (named * of(&one.freedom, 0))[i]);
            near(of(&two.freedom, 4)[i], (named * of(&one.freedom, 4))[i]);
        }
    }
}

/// What is left of the readings, in the sensor frame and in the base frame, pose by pose.
#[test]
fn the_residuals_are_those_of_the_readings() {
    let random = &mut Pcg64Mcg::seed_from_u64(34);
    let weight = Vector3::new(0.0, 0.0, -3.0);
    let poses: Vec<Pose> = (0..7).map(|_| reading(&turn(random), &weight, random)).collect();
    let fit = fit_payload(&poses, &PayloadOptions::default()).unwrap();
    let (mut here, mut there) = (Vector6::zeros(), Vector6::zeros());
    for pose in &poses {
        let left = pose.wrench - fit.reading(&pose.base_from_sensor);
        let (force, torque) = (left.fixed_rows::<3>(0).into_owned(), left.fixed_rows::<3>(3).into_owned());
        let base = wrench(pose.base_from_sensor * force, pose.base_from_sensor * torque);
        here += left.component_mul(&left) / 7.0;
        there += base.component_mul(&base) / 7.0;
    }
    for i in 0..6 {
        assert!((fit.rms[i] / here[i].sqrt() - 1.0).abs() < 1e-9, "{i}");
        assert!((fit.rms_in_base[i] / there[i].sqrt() - 1.0).abs() < 1e-9, "{i}");
    }
    // The size of the mass and its error are those of the weight.
    assert!((fit.mass * 9.806_65 / fit.weight.norm() - 1.0).abs() < 1e-12);
}

/// Forces without noise, so that the centre of mass is one regression of the torques: on a given axis of one unknown,
/// or of three. Where the torques seem alike, as they are, it is the plain one, and by its covariance sure, but for what is
/// seen of correlations; where chance makes them seem unlike, the answers are not far off. The readings taken as of the base
/// frame, and how alike the poses are, by normal equations.
#[test]
fn the_centre_of_mass_may_be_known_to_lie_on_an_axis() {
    let random = &mut Pcg64Mcg::seed_from_u64(35);
    let weight = Vector3::new(0.0, 0.0, -3.0);
    let axis = Vector3::new(0.6, 0.0, -0.8);
    let (mut plain, mut squares) = (0, 0.0);
    for draw in 0..60 {
        let centre_on = (draw % 2 == 0).then_some(axis * 7.0);
        let poses: Vec<Pose> = (0..12)
            .map(|_| {
                let base_from_sensor = turn(random);
                let pull = base_from_sensor.tr_mul(&weight);
                let torque = (axis * 0.05).cross(&pull) + TORQUE + vector(random) * NOISE.1;
                Pose { base_from_sensor, wrench: wrench(pull + FORCE, torque) }
            })
            .collect();
        let fit = fit_payload(&poses, &PayloadOptions { centre_on, ..PayloadOptions::default() }).unwrap();
        let span = if centre_on.is_some() {
            DMatrix::from_column_slice(3, 1, axis.as_slice())
        } else {
            DMatrix::identity(3, 3)
        };
        let stacked = |of: &dyn Fn(&Pose, usize) -> Vec<f64>| {
            let rows: Vec<Vec<f64>> = poses.iter().flat_map(|pose| (0..3).map(|i| of(pose, i))).collect();
            DMatrix::from_fn(36, rows[0].len(), |i, j| rows[i][j])
        };
        let unit = |i: usize| (0..3).map(move |j| if i == j { 1.0 } else { 0.0 });
        let (x, y) = (
            stacked(&|pose, i| {
                let pull = pose.base_from_sensor.tr_mul(&weight);
                let arms = span.column_iter().map(|arm| arm.cross(&pull)[i]);
                arms.chain(unit(i)).collect()
            }),
            stacked(&|pose, i| vec![pose.wrench[3 + i]]),
        );
        let inverse = (x.transpose() * &x).try_inverse().unwrap();
        let found = &inverse * x.transpose() * &y;
        let lengths = span.ncols();
        let centre = &span * found.rows(0, lengths);
        let spread = &span * inverse.view((0, 0), (lengths, lengths)) * span.transpose();
        let is_plain = (0..3).all(|i| (fit.centre_of_mass[i] - centre[i]).abs() < 1e-12);
        plain += usize::from(is_plain);
        for i in 0..3 {
            let (turn, freedom) = (fit.torque_bias[i] - found[lengths + i], (36 - lengths - 3) as f64);
            let deviation = fit.centre_deviation[i];
            let expected = spread[(i, i)].sqrt() * NOISE.1;
            if is_plain {
                assert!(turn.abs() < 1e-12, "{fit:?}");
            } else {
                assert!((fit.centre_of_mass[i] - centre[i]).abs() <= deviation, "{fit:?} {centre}");
                assert!(turn.abs() < fit.torque_bias_deviation[i], "{fit:?} {found}");
            }
            assert!(deviation <= 3.0 * expected && deviation >= expected / 3.0, "{deviation} {expected}");
            assert!(fit.freedom.centre[i] < 1.3 * freedom || expected == 0.0, "{fit:?}");
            if expected > 0.0 {
                squares += (deviation / expected).powi(2) / 150.0;
            }
        }
        let x = stacked(&|pose, i| core::iter::once(-pose.base_from_sensor[(2, i)]).chain(unit(i)).collect());
        let y = stacked(&|pose, i| vec![pose.base_from_sensor.tr_mul(&pose.wrench.fixed_rows::<3>(0))[i]]);
        let gram = x.transpose() * &x;
        let eigenvalues = gram.symmetric_eigenvalues();
        let number = (eigenvalues.max() / eigenvalues.min()).sqrt();
        assert!((fit.condition_number / number - 1.0).abs() < 1e-9, "{fit:?} {number}");
        let left = &y - &x * (gram.try_inverse().unwrap() * x.transpose() * &y);
        let rms = left.norm() / 36.0_f64.sqrt();
        assert!(rms > 0.1 && (fit.rms_if_in_base / rms - 1.0).abs() < 1e-9, "{fit:?} {rms}");
    }
    assert!(plain > 30, "{plain}");
    assert!((squares - 1.0).abs() < 0.15, "{squares}");
}
