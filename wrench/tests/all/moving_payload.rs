//! The load of a body in motion, taken off by what an inertial unit reads: against heavy points that go their way
//! through the world.

use fingertip_test_support::MovingBody;
use fingertip_wrench::{
    BadInertialUnit, InertialReading, InertialUnit, Motion, MovingPayload, Payload, Real, Wrench,
};
use nalgebra::{Matrix3, Rotation3, Vector3};

fn cast<T: Real>(v: &Vector3<f64>) -> Vector3<T> {
    v.map(T::literal)
}

/// The pieces of a swung body: compensation, and its readings with the unit turned on the sensor.
fn moving<T: Real>(body: &MovingBody, turn: &Rotation3<f64>, rate: Vector3<f64>) -> MovingPayload<T> {
    let (mass, centre, inertia) = body.mass_properties();
    let payload = Payload::new(T::literal(mass), cast(&centre))
        .and_then(|payload| payload.with_inertia(inertia.map(T::literal)))
        .expect("what can be");
    let unit = InertialUnit::new(turn.matrix().map(T::literal), cast(&body.unit))
        .and_then(|unit| unit.with_resting_rate(cast(&rate)))
        .expect("what can be");
    MovingPayload::new(payload, unit, T::literal(0.004)).expect("what can be")
}

fn reading<T: Real>(
    body: &MovingBody,
    turn: &Rotation3<f64>,
    rate: Vector3<f64>,
    time: f64,
) -> (Wrench<T>, InertialReading<T>) {
    let moved = body.at(time);
    let wrench = Wrench::from_components(&moved.wrench.map(T::literal));
    let reading = InertialReading {
        acceleration: cast(&(turn.inverse() * moved.acceleration)),
        angular_velocity: cast(&(turn.inverse() * moved.angular_velocity + rate)),
    };
    (wrench, reading)
}

/// Force and torque that are left, at most, behind the first 0.1 s.
fn left<T: Real>(change: impl Fn(MovingPayload<T>) -> MovingPayload<T>, step: f64) -> (f64, f64) {
    let body = MovingBody::swung();
    let turn = Rotation3::from_euler_angles(0.3, -1.1, 2.0);
    let rate = Vector3::new(0.02, -0.03, 0.01);
    let mut compensation = change(moving::<T>(&body, &turn, rate));
    let mut most = (0.0_f64, 0.0_f64);
    let mut time = 0.0;
    while time < 1.5 {
        let (wrench, reading) = reading(&body, &turn, rate, time);
        let left = compensation.take_off(&wrench, &reading, T::literal(step)).expect("what can be");
        if time > 0.1 {
            most.0 = most.0.max(left.force().norm().to_f64());
            most.1 = most.1.max(left.torque().norm().to_f64());
        }
        time += step;
    }
    most
}

#[test]
fn nothing_is_left_of_a_body_that_is_swung() {
    // The loads are about 10 N and 0.5 N·m. What is left is the straight line between samples: a quarter at half the step.
    let (force, torque) = left::<f64>(|all| all, 1e-3);
    assert!(force < 4e-4 && torque < 4e-5, "{force} {torque}");
    let (half_force, half_torque) = left::<f64>(|all| all, 0.5e-3);
    assert!(half_force < 0.3 * force && half_torque < 0.3 * torque, "{half_force} {half_torque}");
    let (force, torque) = left::<f32>(|all| all, 1e-3);
    assert!(force < 6e-4 && torque < 8e-5, "{force} {torque}");
}

/// Each part of the load is needed: without it, much more is left.
#[test]
fn every_part_of_the_load_counts() {
    let again = |body: Payload<f64>, unit: InertialUnit<f64>| MovingPayload::new(body, unit, 0.004).unwrap();
    let body = |all: &MovingPayload<f64>| *all.body();
    let no_inertia = left::<f64>(
        |all| again(Payload::new(body(&all).mass(), body(&all).centre_of_mass()).unwrap(), *all.unit()),
        1e-3,
    );
    assert!(no_inertia.1 > 0.02, "{no_inertia:?}");
    let no_lever = left::<f64>(
        |all| {
            let unit = InertialUnit::new(all.unit().sensor_from_unit(), Vector3::zeros()).unwrap();
            again(body(&all), unit.with_resting_rate(all.unit().resting_rate()).unwrap())
        },
        1e-3,
    );
    assert!(no_lever.0 > 0.05, "{no_lever:?}");
    let no_rate =
        left::<f64>(|all| again(body(&all), all.unit().with_resting_rate(Vector3::zeros()).unwrap()), 1e-3);
    assert!(no_rate.0 > 0.005, "{no_rate:?}");
}

/// A zero taken with the body on holds its weight as it hung then.
#[test]
fn a_zero_with_the_body_on_counts_its_weight_once() {
    let body = Payload::new(0.5_f64, Vector3::new(0.0, 0.01, 0.04)).unwrap();
    let mut moving = MovingPayload::new(body, InertialUnit::at_the_origin(), 0.003).unwrap();
    let at = |acceleration| InertialReading { acceleration, angular_velocity: Vector3::zeros() };
    let (upright, lying) = (Vector3::new(0.0, 0.0, 9.8), Vector3::new(0.0, 9.8, 0.0));
    moving.zeroed_under(moving.gravity(&at(upright)));
    assert_eq!(moving.take_off(&Wrench::zero(), &at(upright), 1e-3), Some(Wrench::zero()));
    moving.start_anew();
    let zero = body.load(&Motion::resting(-upright));
    let measured = body.load(&Motion::resting(-lying)) - zero;
    let left = moving.take_off(&measured, &at(lying), 1e-3).unwrap();
    assert!(left.force().norm() < 1e-12 && left.torque().norm() < 1e-12, "{left:?}");
    assert_eq!(moving.delay(), 0.006);
}

#[test]
fn what_is_no_number_is_left_out_and_forgotten() {
    let body = MovingBody::swung();
    let turn = Rotation3::identity();
    let (mut whole, rate) = (moving::<f64>(&body, &turn, Vector3::zeros()), Vector3::zeros());
    for k in 0..400 {
        let (wrench, mut reading) = reading::<f64>(&body, &turn, rate, 1e-3 * f64::from(k));
        let bad = match k % 100 {
            40 => Some(f64::NAN),
            41 => Some(f64::INFINITY),
            42 => Some(1e308),
            _ => None,
        };
        if let Some(bad) = bad {
            reading.angular_velocity.y = bad;
        }
        let left = whole.take_off(&wrench, &reading, 1e-3);
        assert_eq!(left.is_none(), bad.is_some(), "{k}");
        if let Some(left) = left.filter(|_| k > 60 && k % 100 > 80) {
            assert!(left.force().norm() < 2e-3, "{k} {left:?}");
        }
    }
}

#[test]
fn units_that_cannot_be_are_refused() {
    let at = Vector3::zeros();
    let mirror = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, -1.0));
    for bad in [mirror, Matrix3::zeros(), Matrix3::repeat(f64::NAN), Matrix3::identity() * 1.1] {
        assert_eq!(InertialUnit::new(bad, at), Err(BadInertialUnit::Rotation));
    }
    let unit = InertialUnit::<f64>::at_the_origin();
    assert_eq!(
        InertialUnit::new(unit.sensor_from_unit(), Vector3::new(f64::NAN, 0.0, 0.0)),
        Err(BadInertialUnit::Position)
    );
    let bad = unit.with_resting_rate(Vector3::new(0.0, f64::INFINITY, 0.0));
    assert_eq!(bad, Err(BadInertialUnit::RestingRate));
    assert_eq!(MovingPayload::new(Payload::none(), unit, 0.0).unwrap_err(), BadInertialUnit::TimeConstant);
}
