//! The frame of a contact: which tangents, and what becomes of the parts of a wrench in it.

use crate::support::{generator, greatest, normal};
use fingertip_wrench::{BadNormal, ContactForce, ContactFrame, ContactLoad, Real, TangentialForce, Wrench};
use nalgebra::Vector3;

/// The tangents of Duff et al. 2017 by another way: those of the pole, turned about the horizontal axis
/// across which the pole is turned to the normal. Below the equator, from the lower pole, mirrored.
fn tangents<T: Real>(outward: Vector3<f64>) {
    let frame = ContactFrame::new(Vector3::zeros(), outward.map(T::literal)).expect("a direction");
    let n = frame.normal().map(T::to_f64);
    let pole = if n.z < 0.0 { -Vector3::z() } else { Vector3::z() };
    // The rotation that takes the pole to the normal: v − (v·(p+n))/(1+p·n) (p+n) + 2 (v·p) n.
    let turned = |v: Vector3<f64>| {
        v - (pole + n) * (v.dot(&(pole + n)) / (1.0 + pole.dot(&n))) + n * (2.0 * v.dot(&pole))
    };
    let sign = pole.z;
    let wanted = [turned(Vector3::x()), turned(Vector3::y() * sign)];
    for (found, wanted) in frame.tangents().iter().zip(wanted) {
        let off = found.map(T::to_f64) - wanted;
        assert!(greatest(&off) < 8.0 * T::EPSILON.to_f64(), "{outward}: {off}");
    }
}

#[test]
fn tangents_are_turned_from_the_pole() {
    let mut random = generator(140);
    for _ in 0..2_000 {
        let outward = Vector3::from_fn(|_, _| normal(&mut random));
        tangents::<f64>(outward);
        tangents::<f32>(outward);
    }
    // The equator counts as above it.
    for angle in 0..12 {
        let (sin, cos) = f64::from(angle).sin_cos();
        tangents::<f64>(Vector3::new(cos, sin, 0.0));
        tangents::<f64>(Vector3::new(cos, sin, -1e-9));
        tangents::<f64>(Vector3::new(cos, sin, 1e-9));
    }
    for pole in [1.0, -1.0] {
        tangents::<f64>(Vector3::z() * pole);
        tangents::<f32>(Vector3::z() * pole);
    }
}

/// Normals of any length are the same normal; of none, none.
fn lengths<T: Real>(exponents: &[i32]) {
    let outward = Vector3::new(3.0, -4.0, 12.0);
    let point = Vector3::new(T::one(), T::zero(), -T::one());
    for exponent in exponents {
        // In two steps, since half of the subnormal powers are beyond what `powi` takes the reciprocal of.
        let half = 2.0_f64.powi(exponent / 2);
        let long = outward.map(|x| T::literal(x * half * half));
        let frame = ContactFrame::new(point, long).expect("a direction");
        let off = frame.normal().map(T::to_f64) - outward / 13.0;
        assert!(greatest(&off) < 2.0 * T::EPSILON.to_f64(), "{off}");
        assert_eq!(frame.point(), point);
    }
    for k in 0..3 {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let mut v = Vector3::repeat(T::one());
            v[k] = T::literal(bad);
            assert_eq!(ContactFrame::new(point, v), Err(BadNormal));
            assert_eq!(ContactFrame::new(v, Vector3::z()), Err(BadNormal));
        }
    }
    assert_eq!(ContactFrame::new(point, Vector3::<T>::zeros()), Err(BadNormal));
}

#[test]
fn normals_may_have_any_length() {
    lengths::<f32>(&[-140, -60, 0, 60, 120]);
    lengths::<f64>(&[-1060, -600, 0, 600, 1018]);
}

/// A contact whose numbers can be checked by hand.
#[test]
fn parts_of_a_wrench_by_hand() {
    let frame = ContactFrame::new(Vector3::new(0.0, 0.0, 2.0), Vector3::z() * 5.0).expect("a direction");
    // At the point: force (3, 4, −10), rolling torque (0.5, −0.25, 0), spin torque 0.125.
    let force = Vector3::new(3.0, 4.0, -10.0);
    let torque = Vector3::new(0.5 - 8.0, -0.25 + 6.0, 0.125);
    let wrench: Wrench<f64> = Wrench::on_fingertip(force, torque);
    let load = frame.decompose(&wrench);
    let wanted = ContactLoad {
        force: ContactForce::new(10.0, Vector3::new(3.0, 4.0, 0.0), 0.125),
        rolling: Vector3::new(0.5, -0.25, 0.0),
    };
    assert_eq!(load, wanted);
    assert_eq!(load.force.tangential_magnitude(), 5.0);
    assert_eq!(load.force.friction_ratio(), Some(0.5));
    assert_eq!(frame.compose::<fingertip_wrench::Sensor>(&load), wrench);
}

#[test]
fn tangential_forces_scale_and_keep_what_is_known_of_them() {
    let force = TangentialForce::new(Vector3::new(3.0, -4.0, 0.0));
    for (factor, magnitude) in [(2.0, 10.0), (-0.5, 2.5), (0.0, 0.0)] {
        let scaled = force.scaled(factor);
        assert_eq!((scaled.vector(), scaled.magnitude()), (force.vector() * factor, magnitude));
    }
    // A length that is known is taken at its word.
    let known = TangentialForce::of_magnitude(Vector3::new(3.0, -4.0, 0.0), 5.25);
    assert_eq!((known.vector(), known.magnitude(), known.x), (force.vector(), 5.25, 3.0));
    assert_eq!(Vector3::from(known), force.vector());
    let zero = TangentialForce::<f64>::zero();
    assert_eq!((zero.vector(), zero.magnitude()), (Vector3::zeros(), 0.0));
    assert_eq!(TangentialForce::from(force.vector()), force);
}

/// Any part of a contact force that is no number spoils it; a ratio beyond all numbers is none.
#[test]
fn contact_forces_that_are_none() {
    let good = ContactForce::new(1.0, Vector3::new(0.5, 0.25, -0.5), 0.125);
    assert!(good.is_finite());
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert!(!ContactForce { normal: bad, ..good }.is_finite());
        assert!(!ContactForce { spin: bad, ..good }.is_finite());
        for k in 0..3 {
            let mut tangential = good.tangential.vector();
            tangential[k] = bad;
            assert!(!ContactForce { tangential: tangential.into(), ..good }.is_finite());
        }
    }
    let of = |normal: f64, tangential: f64| {
        ContactForce::new(normal, Vector3::x() * tangential, 0.0).friction_ratio()
    };
    assert_eq!([of(0.0, 1.0), of(-1.0, 1.0), of(f64::NAN, 1.0), of(1e-300, 1e300)], [None; 4]);
    assert_eq!([of(0.0, 0.0), of(1.0, 0.0), of(4.0, -1.0)], [None, Some(0.0), Some(0.25)]);
}

#[test]
fn wrenches_are_finite_as_their_components_are() {
    for k in 0..6 {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let mut components = nalgebra::Vector6::repeat(1.0);
            components[k] = bad;
            assert!(!Wrench::<f64>::from_components(&components).is_finite());
        }
    }
    // Their sum would overflow.
    assert!(Wrench::<f64>::from_components(&nalgebra::Vector6::repeat(f64::MAX)).is_finite());
    assert!(Wrench::<f32>::zero().is_finite());
}
