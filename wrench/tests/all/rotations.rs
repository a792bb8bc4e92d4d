//! Rotations from matrices, axes and quaternions, against the formulas of Rodrigues and Hamilton.

use crate::support::{generator, greatest, normal};
use fingertip_wrench::{Real, RigidTransform, Sensor, TransformError};
use nalgebra::{Matrix3, Vector3};

type Motion<T> = RigidTransform<T, Sensor, Sensor>;

fn wide<T: Real>(v: &Vector3<T>) -> Vector3<f64> {
    v.map(T::to_f64)
}

/// `v + 2w u×v + 2 u×(u×v)` of the unit quaternion `(w, u)`.
fn turned([w, x, y, z]: [f64; 4], v: &Vector3<f64>) -> Vector3<f64> {
    let norm = (w * w + x * x + y * y + z * z).sqrt();
    let (w, u) = (w / norm, Vector3::new(x, y, z) / norm);
    v + u.cross(v) * (2.0 * w) + u.cross(&u.cross(v)) * 2.0
}

fn quaternions<T: Real>(sizes: &[f64]) {
    let mut random = generator(130);
    let origin = Vector3::new(1.0, -2.0, 3.0).map(T::literal);
    for trial in 0..2_000 {
        let mut quaternion: [f64; 4] = core::array::from_fn(|_| normal(&mut random));
        // Each component in turn outweighs the others, with either sign; or stands alone.
        match trial % 10 {
            k @ 0..4 => quaternion[k] *= 1e3,
            k @ 4..8 => {
                let alone = quaternion[k - 4];
                quaternion = [0.0; 4];
                quaternion[k - 4] = alone;
            }
            _ => {}
        }
        for size in sizes {
            let given = quaternion.map(|x| T::literal(x * size));
            let motion = Motion::from_quaternion(given, origin).expect("a rotation");
            assert_eq!(motion.origin(), origin);
            // As rounded when handed over.
            let quaternion = given.map(|x| (x / T::literal(*size)).to_f64());
            for axis in [Vector3::x(), Vector3::y(), Vector3::z()] {
                let off = wide(&motion.rotate(&axis)) - turned(quaternion, &axis.map(T::to_f64));
                assert!(greatest(&off) < 8.0 * T::EPSILON.to_f64(), "{quaternion:?}: {off}");
            }
        }
    }
    for k in 0..4 {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let mut quaternion = [T::one(); 4];
            quaternion[k] = T::literal(bad);
            assert_eq!(Motion::from_quaternion(quaternion, origin), Err(TransformError::NotFinite));
        }
    }
    let nowhere = Vector3::new(T::zero(), T::literal(f64::NAN), T::zero());
    assert_eq!(Motion::from_quaternion([T::one(); 4], nowhere), Err(TransformError::NotFinite));
}

#[test]
fn quaternions_turn_by_hamiltons_product() {
    quaternions::<f32>(&[1.0, 2.0_f64.powi(-100), 2.0_f64.powi(100)]);
    quaternions::<f64>(&[1.0, 2.0_f64.powi(-990), 2.0_f64.powi(1000)]);
}

/// `v cos α + u×v sin α + u (u·v)(1 − cos α)`.
fn axes<T: Real>() {
    let mut random = generator(131);
    for trial in 0..2_000 {
        let size = [1.0, 1e-3, 1e-12, 3.0][trial % 4];
        let given = Vector3::from_fn(|_, _| T::literal(size * normal(&mut random)));
        let motion = Motion::from_axis_angle(given, Vector3::zeros()).expect("a rotation");
        let angle = wide(&given).norm();
        let (sin, cos) = angle.sin_cos();
        let u = wide(&given) / angle;
        for axis in [Vector3::x(), Vector3::y(), Vector3::z()] {
            let v = axis.map(T::to_f64);
            let wanted = v * cos + u.cross(&v) * sin + u * (u.dot(&v) * (1.0 - cos));
            let off = wide(&motion.rotate(&axis)) - wanted;
            // An angle of many turns is known to that many rounding units less.
            assert!(greatest(&off) < 8.0 * T::EPSILON.to_f64() * angle.max(1.0), "{given}: {off}");
        }
    }
    // The smallest and the largest angles, which have no square; no angle at all; none that is a number.
    let l = T::literal;
    let tiny = T::LEAST_NORMAL * l(4.0);
    let motion = Motion::from_axis_angle(Vector3::z() * tiny, Vector3::x()).expect("a rotation");
    assert!((motion.rotation()[(1, 0)] / tiny - T::one()).abs() < l(4.0) * T::EPSILON);
    assert!((motion.rotation()[(0, 1)] / tiny + T::one()).abs() < l(4.0) * T::EPSILON);
    let huge = Motion::<T>::from_axis_angle(Vector3::y() * (T::GREATEST * l(0.5)), Vector3::x())
        .expect("a rotation");
    let defect = huge.rotation().transpose() * huge.rotation() - Matrix3::identity();
    assert!(greatest(&defect) < 8.0 * T::EPSILON.to_f64());
    let still = Motion::<T>::from_axis_angle(Vector3::zeros(), Vector3::x()).expect("a rotation");
    assert_eq!((still.rotation(), still.origin()), (Matrix3::identity(), Vector3::x()));
    let far = Motion::<T>::from_axis_angle(Vector3::repeat(T::GREATEST), Vector3::zeros());
    assert_eq!(far, Err(TransformError::NotFinite));
    let nowhere = Vector3::new(T::zero(), T::zero(), l(f64::INFINITY));
    assert_eq!(Motion::from_axis_angle(Vector3::x(), nowhere), Err(TransformError::NotFinite));
}

#[test]
fn axes_turn_right_handed_by_their_length() {
    axes::<f32>();
    axes::<f64>();
}

/// The same rotation from its matrix; matrices off by less than a root of ε, and by more.
fn matrices<T: Real>() {
    let mut random = generator(132);
    let hair = T::EPSILON.root();
    let vector = |random: &mut _| Vector3::from_fn(|_, _| T::literal(normal(random)));
    for _ in 0..200 {
        let origin = vector(&mut random);
        let motion = Motion::from_axis_angle(vector(&mut random), origin).expect("a rotation");
        assert_eq!(Motion::from_matrix(motion.rotation(), origin), Ok(motion));
        for i in 0..3 {
            for j in 0..3 {
                // The shear S of the rotation R leaves SᵀS − I as R Sᵀ S Rᵀ has it.
                let mut shear = Matrix3::<T>::identity();
                shear[(i, j)] += hair * T::literal(0.4);
                let near = motion.rotation() * shear;
                let stored = Motion::from_matrix(near, origin).expect("a rotation").rotation();
                assert!((stored - near).amax() <= hair, "{stored} {near}");
                let defect = (stored.transpose() * stored - Matrix3::identity()).amax();
                assert!(defect <= T::EPSILON * T::literal(4.0), "{defect:?}");
                // The nearest: S of R S, symmetric, is what it is off by.
                let stretch = stored.transpose() * near;
                assert!((stretch - stretch.transpose()).amax() <= T::EPSILON * T::literal(4.0), "{stretch}");
                shear[(i, j)] += hair * T::literal(0.8);
                let skewed = Motion::from_matrix(motion.rotation() * shear, origin);
                assert_eq!(skewed, Err(TransformError::NotOrthonormal));
            }
            let mut mirror = Matrix3::<T>::identity();
            mirror[(i, i)] = -T::one();
            let mirrored = Motion::from_matrix(motion.rotation() * mirror, origin);
            assert_eq!(mirrored, Err(TransformError::Reflection));
            for bad in [T::one() / T::zero(), T::zero() / T::zero()] {
                let mut matrix = motion.rotation();
                matrix[(i, 2 - i)] = bad;
                assert_eq!(Motion::from_matrix(matrix, origin), Err(TransformError::NotFinite));
                let mut nowhere = origin;
                nowhere[i] = bad;
                assert_eq!(Motion::from_matrix(motion.rotation(), nowhere), Err(TransformError::NotFinite));
            }
        }
    }
}

#[test]
fn matrices_are_rotations_to_a_root_of_epsilon() {
    matrices::<f32>();
    matrices::<f64>();
}
