//! Sensors and payloads from gravity, motion and use.

use fingertip_calibration::file::Covariance;
use fingertip_calibration::gravity::{PayloadOptions, Pose, fit_orientation, fit_payload, try_frames};
use fingertip_calibration::in_situ::{DriftMonitor, PointContactForm, refine};
use fingertip_calibration::inertial::{InertialOptions, MovingSample, fit_inertial};
use fingertip_calibration::motion::{LeverArm, constant_force, lever_arms};
use fingertip_calibration::nalgebra::{DMatrix, DVector, Matrix6, Rotation3, Vector3, Vector6};
use fingertip_test_support::MovingBody;
use fingertip_wrench::{InertialReading, InertialUnit, Wrench};

use super::{Draw, to_ten_digits, unchanged};

fn six(force: Vector3<f64>, torque: Vector3<f64>) -> Vector6<f64> {
    Vector6::new(force.x, force.y, force.z, torque.x, torque.y, torque.z)
}

#[test]
fn of_gravity() {
    let mut unchanged = unchanged("gravity");
    let draw = &mut Draw::new(5);
    for (count, noise, tilted) in [(3, 1e-3, 0.0), (6, 0.02, 0.0), (12, 0.02, 0.2), (30, 0.3, 0.1)] {
        let weight = Vector3::new(tilted, -0.5 * tilted, -1.0) * 3.0;
        let poses: Vec<Pose> = (0..count)
            .map(|_| {
                let turn = Rotation3::from_scaled_axis(draw.vector() * 3.0).into_inner();
                let pull = turn.tr_mul(&weight);
                let force = pull + Vector3::new(0.4, -0.3, 0.2) + draw.vector() * noise;
                let torque = Vector3::new(0.02, -0.03, 0.05).cross(&pull)
                    + Vector3::new(0.01, 0.02, -0.03)
                    + draw.vector() * (0.05 * noise);
                Pose { base_from_sensor: turn, wrench: six(force, torque) }
            })
            .collect();
        let down = PayloadOptions { down: Some(-Vector3::z()), ..PayloadOptions::default() };
        let on =
            PayloadOptions { centre_on: Some(Vector3::new(0.02, -0.03, 0.05)), ..PayloadOptions::default() };
        let mut answers = Vec::new();
        for options in [PayloadOptions::default(), down, on] {
            answers.push(to_ten_digits(&try_frames(&poses, &options)));
            let fit = fit_payload(&poses, &options);
            let told = fit.as_ref().map(|fit| {
                (fit.verdict(), fit.to_file(poses.len()), fit.reading(&poses[0].base_from_sensor))
            });
            answers.push(to_ten_digits(&(told, &fit)));
        }
        answers.push(to_ten_digits(&fit_orientation(&poses, &-Vector3::z())));
        unchanged.note(&format!("{count} poses, noise {noise}, tilt {tilted}"), answers);
    }
    unchanged.check();
}

#[test]
fn of_shape_from_motion() {
    let mut unchanged = unchanged("motion");
    let draw = &mut Draw::new(6);
    for (gauges, noise) in [(3, 1e-6), (4, 0.02), (6, 0.2)] {
        let truth = DMatrix::from_fn(3, gauges, |i, j| if i == j % 3 { 2.0 } else { 0.3 * draw.signed() });
        let zero = DVector::from_fn(gauges, |i, _| 3.0 - i as f64);
        let force = |draw: &mut Draw| draw.direction() * 5.0;
        let mut signals = DMatrix::zeros(20, gauges);
        for mut row in signals.row_iter_mut() {
            row.copy_from(&(force(draw).transpose() * &truth + zero.transpose()));
        }
        signals += draw.noises(20, gauges) * noise;
        let fit = constant_force(&signals, 5.0);
        let known: Vec<(DVector<f64>, Vector3<f64>)> = (0..4)
            .map(|_| {
                let force = force(draw);
                (truth.tr_mul(&force) + &zero, force)
            })
            .collect();
        let aligned = fit.as_ref().map(|fit| (fit.aligned(&known), fit.force(&known[0].0)));
        unchanged.note(&format!("constant force, {gauges} gauges"), [to_ten_digits(&(aligned, &fit))]);
    }
    for noise in [1e-4, 0.02] {
        let truth = DMatrix::from_fn(6, 6, |i, j| {
            let size = if j < 3 { 1.0 } else { 10.0 };
            size * (if i == j { 2.0 } else { 0.3 * draw.signed() })
        });
        let arms: Vec<LeverArm> = [[0.1, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.0, 0.1], [-0.05, -0.06, 0.02]]
            .map(|arm| {
                let arm = Vector3::from(arm);
                let mut signals = DMatrix::zeros(12, 6);
                for i in 0..12 {
                    let force = draw.direction() * 5.0;
                    let load = six(force, arm.cross(&force));
                    let read = &truth * DVector::from_column_slice(load.as_slice());
                    signals.set_row(
                        i,
                        &(read.add_scalar(0.5) + draw.noises(6, 1).column(0) * noise).transpose(),
                    );
                }
                LeverArm { arm, signals }
            })
            .into();
        unchanged
            .note(&format!("lever arms, noise {noise}"), [to_ten_digits(&lever_arms(&arms, 5.0, 0.1, 6, 2))]);
    }
    unchanged.check();
}

#[test]
fn of_a_motion_with_an_inertial_unit() {
    let mut unchanged = unchanged("inertial");
    let body = MovingBody::swung_after_a_rest();
    let unit_turn = Rotation3::from_euler_angles(0.3, -1.1, 2.0);
    let unit = InertialUnit::new(unit_turn.into_inner(), MovingBody::swung().unit).unwrap();
    let rested = InertialOptions { unit, rest: Some(0.95), ..InertialOptions::default() };
    let short =
        InertialOptions { longest_delay: 0.0, rest: None, reach: 0.05, time_constant: 0.02, ..rested };
    for (name, noise, delay, options) in
        [("quiet", 1e-3, 0.0, rested), ("late", 0.05, -0.013, rested), ("of the same time", 0.02, 0.0, short)]
    {
        let draw = &mut Draw::new(7);
        let samples: Vec<MovingSample> = (0..800)
            .map(|k| {
                let time = f64::from(k) / 200.0;
                // A pause, which the filter does not bridge.
                let time = if k < 720 { time } else { time + 1.5 };
                let (load, ride) = (body.at(time), body.at(time - delay));
                let noises = Vector6::from_fn(|i, _| draw.noise() * if i < 3 { noise } else { 0.02 * noise });
                let own = |v: Vector3<f64>| unit_turn.inverse() * v;
                let reading = InertialReading {
                    acceleration: own(ride.acceleration) + draw.vector() * noise,
                    angular_velocity: own(ride.angular_velocity)
                        + Vector3::new(0.01, -0.02, 0.015)
                        + draw.vector() * (0.1 * noise),
                };
                MovingSample { time, wrench: load.wrench + noises, reading }
            })
            .collect();
        let fit = fit_inertial(&samples, &options);
        let told = fit.as_ref().map(|fit| (fit.verdict(), fit.over_noise(), fit.share_left(), fit.to_file()));
        unchanged.note(name, [to_ten_digits(&(told, &fit))]);
    }
    unchanged.check();
}

#[test]
fn of_use() {
    let mut unchanged = unchanged("use");
    let draw = &mut Draw::new(8);
    for (count, noise) in [(30, 1e-4), (60, 1e-3), (200, 1e-2)] {
        let truth = DMatrix::from_fn(6, 6, |i, j| if i == j { 2.0 } else { 0.2 * draw.signed() });
        let inverse = truth.clone().try_inverse().unwrap();
        let mut touch = || {
            let (force, point) = (draw.vector() * 3.0, draw.vector());
            let clean = &inverse * DVector::from_column_slice(six(force, point.cross(&force)).as_slice());
            clean + draw.noises(6, 1).column(0) * noise
        };
        let touches: Vec<DVector<f64>> = (0..count).map(|_| touch()).collect();
        let mut form = PointContactForm::new(6);
        assert!(touches.iter().all(|touch| form.push(touch.as_slice())));
        let rows = DMatrix::from_fn(count, 6, |i, j| touches[i][j]);
        let loads = draw.matrix(12, 6);
        let signals = &loads * inverse.transpose() + draw.noises(12, 6) * noise;
        let start = &truth + draw.noises(6, 6) * 0.02;
        let refined = refine(&start, &rows, 0.02, &signals, &loads, 0.01);
        let covariance =
            Covariance::of_entries(DMatrix::identity(6, 6) * 1e-4, DMatrix::identity(6, 6) * 1e-3);
        let after =
            refined.as_ref().map(|refined| refined.covariance_after(&start, &covariance).map(|c| c.all()));
        unchanged.note(
            &format!("{count} touches"),
            [to_ten_digits(&form.solve()), to_ten_digits(&(&refined, after))],
        );
    }
    let mut covariance = Matrix6::from_diagonal(&[1e-2, 2e-2, 1e-2, 1e-4, 1e-4, 2e-4].into());
    covariance[(0, 1)] = 5e-3;
    covariance[(1, 0)] = 5e-3;
    for memory in [20.0, 200.0] {
        let mut monitor = DriftMonitor::new(covariance, memory).unwrap();
        let verdicts = (0..400).map(|k| {
            let (force, point) = (draw.vector() * 3.0, draw.vector() * 0.02);
            let drift = Vector3::new(0.0, 3e-2, 0.0) * if k < 200 { 0.0 } else { 1.0 };
            let noise = Vector3::from_fn(|_, _| 1e-2 * draw.noise());
            let taken = monitor.push(&Wrench::on_fingertip(force + noise, point.cross(&force) + drift));
            to_ten_digits(&(taken, monitor.verdict()))
        });
        unchanged.note(&format!("drift, memory {memory}"), verdicts.collect::<Vec<_>>());
    }
    unchanged.check();
}
