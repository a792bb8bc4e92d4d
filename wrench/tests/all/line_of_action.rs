//! The wrench axis: its definition, invariance under motion and scale, and the ends of the range.

use crate::support::{generator, normal};
use fingertip_wrench::{LineOfAction, NoLineOfAction, Real, RigidTransform, Sensor, Wrench};
use nalgebra::Vector3;
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

fn vector<T: Real>(random: &mut Pcg64Mcg, size: f64) -> Vector3<T> {
    Vector3::from_fn(|_, _| T::literal(normal(random) * size))
}

fn wide<T: Real>(v: &Vector3<T>) -> Vector3<f64> {
    v.map(T::to_f64)
}

fn axis<T: Real>(wrench: &Wrench<T>) -> LineOfAction<T> {
    wrench.line_of_action().expect("a force")
}

/// `m − r × f = pitch · f` at every point of the axis; the foot is the point closest to the origin.
fn definition<T: Real>() {
    let mut random = generator(90);
    let epsilon = T::EPSILON.to_f64();
    for _ in 0..20_000 {
        let lever = 10.0_f64.powf(random.random_range(-3.0..3.0));
        let wrench = Wrench::<T>::on_fingertip(vector(&mut random, 1.0), vector(&mut random, lever));
        let found = axis(&wrench);
        let (f, m) = (wide(&wrench.force()), wide(&wrench.torque()));
        let reach = m.norm() / f.norm();
        // The formulas again, in f64, without scaling.
        let foot = f.cross(&m) / f.norm_squared();
        let pitch = f.dot(&m) / f.norm_squared();
        if epsilon > 1e-10 {
            assert!((wide(&found.line.point) - foot).norm() <= 8.0 * epsilon * reach);
            assert!((found.pitch.to_f64() - pitch).abs() <= 8.0 * epsilon * reach);
        }
        assert!((found.force.to_f64() / f.norm() - 1.0).abs() <= 4.0 * epsilon);
        let direction = wide(&found.line.direction);
        assert!((direction - f / f.norm()).norm() <= 4.0 * epsilon);
        assert!(wide(&found.line.point).dot(&direction).abs() <= 8.0 * epsilon * reach);
        for along in [-2.0, 0.0, 0.7] {
            let point = wide(&found.line.at(T::literal(along * reach)));
            let rest = m - point.cross(&f) - f * found.pitch.to_f64();
            assert!(rest.norm() <= 32.0 * epsilon * m.norm(), "{rest}");
        }
    }
}

#[test]
fn every_point_of_the_axis_has_torque_along_the_force_only() {
    definition::<f32>();
    definition::<f64>();
}

fn through_the_point<T: Real>() {
    let mut random = generator(91);
    let epsilon = T::EPSILON.to_f64();
    for _ in 0..20_000 {
        let point = vector::<T>(&mut random, 0.01);
        let wrench: Wrench<T> = Wrench::from_force_at(&point, vector(&mut random, 3.0));
        let found = axis(&wrench);
        let offset = wide(&(point - found.line.point));
        let across = offset - wide(&found.line.direction) * offset.dot(&wide(&found.line.direction));
        let size = wide(&point).norm();
        assert!(across.norm() <= 16.0 * epsilon * size, "{across}");
        assert!(found.pitch.to_f64().abs() <= 8.0 * epsilon * size);
    }
}

#[test]
fn a_pure_force_acts_along_a_line_through_its_point() {
    through_the_point::<f32>();
    through_the_point::<f64>();
}

/// The same line, to the last digit, for forces of any size.
fn any_size<T: Real>(exponents: &[i32]) {
    let mut random = generator(92);
    for _ in 0..2_000 {
        let wrench = Wrench::<T>::on_fingertip(vector(&mut random, 1.0), vector(&mut random, 0.01));
        let one = axis(&wrench);
        for exponent in exponents {
            let factor = T::literal(2.0_f64.powi(*exponent));
            let found = axis(&(wrench * factor));
            assert_eq!((found.line, found.pitch, found.force), (one.line, one.pitch, one.force * factor));
        }
        let pushed_back = axis(&-wrench);
        assert_eq!(pushed_back.line.point, one.line.point);
        assert_eq!(pushed_back.line.direction, -one.line.direction);
        assert_eq!(pushed_back.pitch, one.pitch);
    }
}

#[test]
fn the_line_does_not_depend_on_the_size_of_the_force() {
    any_size::<f64>(&[-900, -100, 100, 900]);
    any_size::<f32>(&[-100, -50, 50, 100]);
}

fn moved<T: Real>() {
    let mut random = generator(93);
    let epsilon = T::EPSILON.to_f64();
    for _ in 0..5_000 {
        let motion: RigidTransform<T, Sensor, Sensor> =
            RigidTransform::from_axis_angle(vector(&mut random, 1.0), vector(&mut random, 0.05))
                .expect("finite");
        let wrench = Wrench::<T>::on_fingertip(vector(&mut random, 1.0), vector(&mut random, 0.02));
        let (here, there) = (axis(&wrench), axis(&wrench.expressed_in(&motion)));
        let reach = wide(&wrench.torque()).norm() / wide(&wrench.force()).norm()
            + wide(&motion.origin()).norm()
            + wide(&here.line.point).norm();
        let tolerance = 50.0 * epsilon * reach;
        assert!((there.pitch - here.pitch).to_f64().abs() <= tolerance);
        let direction = motion.rotate(&here.line.direction);
        assert!(wide(&(direction - there.line.direction)).norm() <= 30.0 * epsilon);
        let offset = wide(&(motion.transform_point(&here.line.point) - there.line.point));
        let along = wide(&there.line.direction);
        assert!((offset - along * offset.dot(&along)).norm() <= tolerance);
    }
}

#[test]
fn the_line_moves_with_the_frame() {
    moved::<f32>();
    moved::<f64>();
}

fn extremes<T: Real>() {
    let zero = Vector3::<T>::zeros();
    let (unit, infinite) = (Vector3::x(), T::one() / T::zero());
    let of =
        |force: Vector3<T>, torque: Vector3<T>| Wrench::<T>::on_fingertip(force, torque).line_of_action();
    assert_eq!(of(zero, zero).err(), Some(NoLineOfAction::NoForce));
    assert_eq!(of(zero, unit).err(), Some(NoLineOfAction::NoForce));
    for bad in [infinite, -infinite, T::zero() / T::zero()] {
        for k in 0..6 {
            let (mut force, mut torque) = (unit, unit);
            if k < 3 {
                force[k] = bad
            } else {
                torque[k - 3] = bad
            }
            assert_eq!(of(force, torque).err(), Some(NoLineOfAction::NotFinite));
        }
    }
    // A breath of a force and a large torque: beyond all numbers.
    let far = of(unit * T::LEAST_NORMAL, Vector3::y() * T::GREATEST);
    assert_eq!(far.err(), Some(NoLineOfAction::TooFar));
    // Subnormal and nearly infinite forces have a line like any other.
    for size in [T::LEAST_NORMAL * T::literal(0.0625), T::GREATEST * T::literal(0.5)] {
        let line = of(Vector3::new(size, T::zero(), -size), zero).expect("a force");
        assert!((line.line.direction.x.to_f64() - 0.5_f64.sqrt()).abs() < 1e-6);
        assert!(line.line.point == zero && line.pitch.is_zero());
    }
}

#[test]
fn the_ends_of_the_range() {
    extremes::<f32>();
    extremes::<f64>();
}
