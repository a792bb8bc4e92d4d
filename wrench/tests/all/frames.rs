//! Frames: rigid motions, wrenches carried by them, loads taken apart at a contact, weights.

use crate::support::{generator, greatest, normal};
use fingertip_wrench::{
    BadNormal, BadPayload, ContactForce, ContactFrame, Frame, Motion, Payload, Real, RigidTransform, Sensor,
    TransformError, Wrench,
};
use nalgebra::{Matrix3, Vector3, Vector6};
use rand_pcg::Pcg64Mcg;

#[derive(Clone, Copy, Debug, PartialEq)]
struct Palm;
impl Frame for Palm {
    const NAME: &'static str = "palm";
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct World;
impl Frame for World {
    const NAME: &'static str = "world";
}

fn vector<T: Real>(random: &mut Pcg64Mcg) -> Vector3<T> {
    Vector3::from_fn(|_, _| T::literal(normal(random)))
}

fn motion<T: Real, A: Frame, B: Frame>(random: &mut Pcg64Mcg) -> RigidTransform<T, A, B> {
    RigidTransform::from_axis_angle(vector(random), vector(random)).expect("finite")
}

fn close<T: Real>(a: &Vector3<T>, b: &Vector3<T>, scale: f64) {
    let error = (a - b).map(T::to_f64).norm();
    assert!(error <= scale * T::EPSILON.to_f64(), "{a} {b}");
}

fn close_wrench<T: Real, F: Frame>(a: &Wrench<T, F>, b: &Wrench<T, F>, scale: f64) {
    close(&a.force(), &b.force(), scale);
    close(&a.torque(), &b.torque(), scale);
}

fn group<T: Real>() {
    let mut random = generator(100);
    for _ in 0..2_000 {
        let palm_from_sensor: RigidTransform<T, Palm, Sensor> = motion(&mut random);
        let world_from_palm: RigidTransform<T, World, Palm> = motion(&mut random);
        let point = vector::<T>(&mut random);
        let carried = world_from_palm.transform_point(&palm_from_sensor.transform_point(&point));
        close(&(world_from_palm * palm_from_sensor).transform_point(&point), &carried, 200.0);
        let back = palm_from_sensor.inverse().transform_point(&palm_from_sensor.transform_point(&point));
        close(&back, &point, 200.0);
        let none = palm_from_sensor.inverse() * palm_from_sensor;
        close(&none.origin(), &Vector3::zeros(), 100.0);
        assert!(greatest(&(none.rotation() - Matrix3::identity())) < 20.0 * T::EPSILON.to_f64());
        assert_eq!(RigidTransform::<T, Sensor, Sensor>::identity().transform_point(&point), point);
        // Right-handed and orthonormal.
        let rotation = palm_from_sensor.rotation();
        let defect = rotation.transpose() * rotation - Matrix3::identity();
        assert!(greatest(&defect) < 20.0 * T::EPSILON.to_f64());
        assert!((rotation.determinant() - T::one()).abs() < T::EPSILON * T::literal(20.0));
    }
}

#[test]
fn rigid_motions_are_a_group() {
    group::<f32>();
    group::<f64>();
}

fn transport<T: Real>() {
    let mut random = generator(101);
    for _ in 0..2_000 {
        let palm_from_sensor: RigidTransform<T, Palm, Sensor> = motion(&mut random);
        let world_from_palm: RigidTransform<T, World, Palm> = motion(&mut random);
        let point = vector::<T>(&mut random);
        let force = vector::<T>(&mut random);
        // A force at a point is the same force at the same point, seen from elsewhere.
        let here: Wrench<T> = Wrench::from_force_at(&point, force);
        let seen = Wrench::<T, Palm>::from_force_at(
            &palm_from_sensor.transform_point(&point),
            palm_from_sensor.rotate(&force),
        );
        close_wrench(&here.expressed_in(&palm_from_sensor), &seen, 200.0);
        // In two steps or in one; there and back again.
        let wrench: Wrench<T> = Wrench::on_fingertip(vector(&mut random), vector(&mut random));
        let steps = wrench.expressed_in(&palm_from_sensor).expressed_in(&world_from_palm);
        close_wrench(&steps, &wrench.expressed_in(&(world_from_palm * palm_from_sensor)), 500.0);
        let back = wrench.expressed_in(&palm_from_sensor).expressed_in(&palm_from_sensor.inverse());
        close_wrench(&back, &wrench, 300.0);
        // The power on any twist does not depend on the frame.
        let (velocity, spin) = (vector::<T>(&mut random), vector::<T>(&mut random));
        let there = wrench.expressed_in(&palm_from_sensor);
        let turned_spin = palm_from_sensor.rotate(&spin);
        let turned_velocity =
            palm_from_sensor.rotate(&velocity) + palm_from_sensor.origin().cross(&turned_spin);
        let power = wrench.force().dot(&velocity) + wrench.torque().dot(&spin);
        let same = there.force().dot(&turned_velocity) + there.torque().dot(&turned_spin);
        assert!((power - same).abs() < T::EPSILON * T::literal(2_000.0));
        // Invariants: |f|, f·m.
        let pitch = |w: Vector3<T>, m: Vector3<T>| w.dot(&m);
        let invariant = pitch(wrench.force(), wrench.torque()) - pitch(there.force(), there.torque());
        assert!(invariant.abs() < T::EPSILON * T::literal(500.0));
        // Torque about a point.
        let shifted = RigidTransform::<T, Palm, Sensor>::translation(-point);
        close(&wrench.torque_about(&point), &wrench.expressed_in(&shifted).torque(), 100.0);
    }
}

#[test]
fn wrenches_are_carried_by_rigid_motions() {
    transport::<f32>();
    transport::<f64>();
}

#[test]
fn wrenches_add_and_reactions_are_opposite() {
    let mut random = generator(102);
    for _ in 0..500 {
        let a: Wrench<f64> = Wrench::on_fingertip(vector(&mut random), vector(&mut random));
        let b: Wrench<f64> = Wrench::on_fingertip(vector(&mut random), vector(&mut random));
        assert_eq!((a + b).components(), a.components() + b.components());
        assert_eq!((a - b).components(), a.components() - b.components());
        assert_eq!((a * 2.0).components(), a.components() * 2.0);
        assert_eq!((-a) + a, Wrench::zero());
        let (force, torque) = a.reaction();
        assert_eq!(Wrench::from_reaction(force, torque), a);
        assert_eq!(Wrench::from_components(&a.components()), a);
        assert_eq!(
            a.components(),
            Vector6::from_fn(|i, _| if i < 3 { a.force()[i] } else { a.torque()[i - 3] })
        );
    }
    for k in 0..6 {
        let mut components = Vector6::zeros();
        components[k] = f64::NAN;
        assert!(!Wrench::<f64>::from_components(&components).is_finite());
    }
}

fn bad_motions<T: Real>() {
    type Motion<T> = RigidTransform<T, Palm, Sensor>;
    let (zero, one, nan) = (T::zero(), T::one(), T::zero() / T::zero());
    let origin = Vector3::zeros();
    let identity = Matrix3::identity();
    assert!(Motion::from_matrix(identity, origin).is_ok());
    assert_eq!(Motion::from_matrix(-identity, origin), Err(TransformError::Reflection));
    assert_eq!(Motion::from_matrix(identity * T::literal(1.01), origin), Err(TransformError::NotOrthonormal));
    assert_eq!(Motion::from_matrix(Matrix3::zeros(), origin), Err(TransformError::NotOrthonormal));
    assert_eq!(Motion::from_matrix(identity * nan, origin), Err(TransformError::NotFinite));
    assert_eq!(Motion::from_matrix(identity, origin.add_scalar(one / zero)), Err(TransformError::NotFinite));
    assert_eq!(Motion::from_axis_angle(origin.add_scalar(nan), origin), Err(TransformError::NotFinite));
    assert_eq!(Motion::from_quaternion([zero; 4], origin), Err(TransformError::ZeroLength));
    assert_eq!(Motion::from_quaternion([nan, one, one, one], origin), Err(TransformError::NotFinite));
    // Tiny and huge quaternions are as good as unit ones.
    for size in [T::LEAST_NORMAL, T::literal(1e-30), T::literal(1e30)] {
        let quarter = Motion::from_quaternion([size, zero, zero, size], origin).expect("a rotation");
        close(&quarter.rotate(&Vector3::x()), &Vector3::y(), 4.0);
    }
    let still = Motion::from_axis_angle(origin, origin).expect("a rotation");
    assert_eq!(still.rotation(), identity);
}

#[test]
fn what_is_no_motion_is_refused() {
    bad_motions::<f32>();
    bad_motions::<f64>();
}

fn taken_apart<T: Real>() {
    let mut random = generator(103);
    for i in 0..5_000 {
        let mut outward = vector::<T>(&mut random);
        if i % 5 == 0 {
            // About the direction where the tangents are chosen differently.
            outward = Vector3::new(outward.x * T::EPSILON, outward.y * T::EPSILON, -T::one());
        }
        let frame = ContactFrame::new(vector(&mut random), outward * T::literal(1e-3)).expect("a direction");
        let (n, [a, b]) = (frame.normal(), frame.tangents());
        let axes = Matrix3::from_columns(&[a, b, n]);
        assert!(greatest(&(axes.transpose() * axes - Matrix3::identity())) < 8.0 * T::EPSILON.to_f64());
        assert!((axes.determinant() - T::one()).abs() < T::EPSILON * T::literal(8.0));
        close(&(n * outward.norm()), &outward, 16.0);
        let wrench: Wrench<T> = Wrench::on_fingertip(vector(&mut random), vector(&mut random));
        let load = frame.decompose(&wrench);
        close_wrench(&frame.compose(&load), &wrench, 100.0);
        assert!(load.force.tangential.dot(&n).abs() < T::EPSILON * T::literal(20.0));
        assert!(load.rolling.dot(&n).abs() < T::EPSILON * T::literal(50.0));
        assert!((load.force.normal + wrench.force().dot(&n)).abs() < T::EPSILON * T::literal(20.0));
        // A point contact there, and a soft finger.
        let spin = T::literal(0.01);
        let soft = Wrench::on_fingertip(wrench.force(), frame.point().cross(&wrench.force()) + n * spin);
        let load = frame.decompose::<Sensor>(&soft);
        close(&load.rolling, &Vector3::zeros(), 100.0);
        assert!((load.force.spin - spin).abs() < T::EPSILON * T::literal(100.0));
    }
    let zero = Vector3::<T>::zeros();
    let nan = zero.add_scalar(T::zero() / T::zero());
    for (point, outward) in [(zero, zero), (zero, nan), (nan, Vector3::z())] {
        assert_eq!(ContactFrame::new(point, outward), Err(BadNormal));
    }
}

#[test]
fn wrenches_are_taken_apart_and_put_together_at_a_contact() {
    taken_apart::<f32>();
    taken_apart::<f64>();
}

fn friction_ratio<T: Real>() {
    let mut random = generator(104);
    for _ in 0..2_000 {
        let normal = vector::<f64>(&mut random).normalize();
        let force = vector::<f64>(&mut random);
        let split = ContactForce::split(&force.map(T::literal), &normal.map(T::literal), T::zero());
        let pressing = -force.dot(&normal);
        let sliding = (force + normal * pressing).norm();
        let tolerance = 8.0 * T::EPSILON.to_f64();
        assert!((split.normal.to_f64() - pressing).abs() < tolerance * force.norm());
        assert!((split.tangential_magnitude().to_f64() - sliding).abs() < tolerance * force.norm());
        match split.friction_ratio() {
            Some(ratio) => {
                let relative = force.norm() / pressing;
                let error = (ratio.to_f64() - sliding / pressing).abs();
                assert!(error < 2.0 * tolerance * relative * relative.max(1.0), "{error}");
            }
            None => assert!(pressing < tolerance * force.norm()),
        }
    }
    // Magnitudes at the ends of the range, and no contact.
    for size in [T::LEAST_NORMAL, T::GREATEST * T::literal(0.25)] {
        let tangential = Vector3::new(size, T::zero(), T::zero());
        let contact = ContactForce::new(size, tangential, T::zero());
        assert_eq!(contact.tangential_magnitude(), size);
        assert_eq!(contact.friction_ratio(), Some(T::one()));
    }
    assert_eq!(ContactForce::<T>::zero().friction_ratio(), None);
    let nan = T::zero() / T::zero();
    let broken = ContactForce { normal: nan, ..ContactForce::zero() };
    assert!(!broken.is_finite() && broken.friction_ratio().is_none());
    let broken = ContactForce::new(T::one(), Vector3::repeat(nan), T::zero());
    assert!(!broken.is_finite() && broken.friction_ratio().is_none());
}

#[test]
fn contact_forces_know_their_friction_ratio() {
    friction_ratio::<f32>();
    friction_ratio::<f64>();
}

/// A tip of known weight in any orientation leaves nothing once its weight is taken off.
#[test]
fn weight_is_taken_off_in_any_orientation() {
    let mut random = generator(105);
    let gravity = Vector3::new(0.0, 0.0, -9.80665);
    for _ in 0..500 {
        let centre = vector::<f64>(&mut random) * 0.02;
        let tip = Payload::new(0.05, centre).expect("a mass");
        let sensor_from_world: RigidTransform<f64, Sensor, World> = motion(&mut random);
        // The weight, in the world frame, at the centre of mass there.
        let world_from_sensor = sensor_from_world.inverse();
        let weight =
            Wrench::<f64, World>::from_force_at(&world_from_sensor.transform_point(&centre), gravity * 0.05);
        let contact = Wrench::on_fingertip(vector(&mut random), vector(&mut random));
        let measured = weight.expressed_in(&sensor_from_world) + contact;
        let now = sensor_from_world.rotate(&gravity);
        close_wrench(&(measured - tip.load(&Motion::resting(now))), &contact, 50.0);
        // Tared with the tip on, in another orientation.
        let then = motion::<f64, Sensor, World>(&mut random).rotate(&gravity);
        let tared = tip.weight(&now) + contact - tip.weight(&then);
        close_wrench(&(tared - tip.load(&Motion::resting(now - then))), &contact, 50.0);
    }
    for mass in [-1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(Payload::new(mass, Vector3::zeros()), Err(BadPayload::BadMass));
    }
    assert_eq!(Payload::new(1.0, Vector3::repeat(f64::NAN)), Err(BadPayload::BadCentre));
    assert_eq!(Payload::new(0.0, Vector3::zeros()), Ok(Payload::none()));
    assert_eq!(Payload::none().weight(&gravity), Wrench::zero());
}

/// The load of a body in motion against the forces that its points need, one by one.
#[test]
fn inertia_loads_the_sensor_as_the_points_of_the_body_do() {
    let mut random = generator(106);
    for _ in 0..200 {
        let points: Vec<(f64, Vector3<f64>)> =
            (0..8).map(|_| (0.1 + normal(&mut random).abs(), vector(&mut random))).collect();
        let mass = points.iter().map(|(mass, _)| mass).sum();
        let centre = points.iter().map(|(mass, at)| at * *mass).sum::<Vector3<f64>>() / mass;
        let inertia = points.iter().fold(Matrix3::zeros(), |sum, (mass, at)| {
            let arm: Vector3<f64> = at - centre;
            sum + (Matrix3::identity() * arm.norm_squared() - arm * arm.transpose()) * *mass
        });
        // Symmetric to the last bit.
        let inertia = (inertia + inertia.transpose()) * 0.5;
        let body = Payload::new(mass, centre).and_then(|body| body.with_inertia(inertia)).expect("a body");
        assert_eq!((body.mass(), body.centre_of_mass(), body.inertia()), (mass, centre, inertia));
        let [reading, turning, turning_faster] = core::array::from_fn(|_| vector::<f64>(&mut random));
        let moves = Motion::from_inertial_unit(reading, turning, turning_faster);
        let load = points.iter().fold(Wrench::zero(), |sum, (mass, at)| {
            let acceleration = reading + turning_faster.cross(at) + turning.cross(&turning.cross(at));
            sum + Wrench::from_force_at(at, -acceleration * *mass)
        });
        close_wrench(&body.load(&moves), &load, 2e3);
        close_wrench(&body.load(&Motion::resting(-reading)), &body.weight(&-reading), 1e-9);
    }
    let tip = Payload::new(0.05, Vector3::x()).expect("a mass");
    let lopsided = Matrix3::new(1.0, 0.1, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);
    for bad in [Matrix3::repeat(f64::NAN), lopsided, Matrix3::from_diagonal(&Vector3::new(1.0, -1e-9, 1.0))] {
        assert_eq!(tip.with_inertia(bad), Err(BadPayload::BadInertia));
    }
    assert!(tip.with_inertia(Matrix3::zeros()).is_ok());
}
