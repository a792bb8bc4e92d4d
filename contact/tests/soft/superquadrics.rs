//! Superquadrics that were wrong in silence, or said to be unresolved.

use fingertip_contact::{ContactModel, NoContact, Resolution, SoftFinger};
use fingertip_surfaces::{ActiveSurface, Superquadric};
use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;

use crate::wrenches::Random;

/// The residual of the equations in units of `|f| size + |m|`, and the height over the size.
///
/// `None` where it is said that no contact could be found for certain.
fn off<T: Real>(shape: &Superquadric<T>, wrench: &Wrench<T>) -> Option<[f64; 2]> {
    let found = SoftFinger::new(T::zero()).unwrap().without_friction_limit().resolve(wrench, shape);
    let contact = match found {
        Resolution::Contact(contact) => contact,
        Resolution::NoContact(NoContact::Unresolved) => return None,
        Resolution::NoContact(reason) => panic!("{reason:?} {shape:?} {wrench:?}"),
    };
    let wide = |v: Vector3<T>| v.map(Real::to_f64);
    let double = Superquadric::new(wide(shape.semi_axes()), shape.exponents().map(Real::to_f64)).unwrap();
    let (f, m, c) = (wide(wrench.force()), wide(wrench.torque()), wide(contact.point));
    // In double precision the normal of the very point is known; where it is sharply bent, that of single is too.
    let rest = m - c.cross(&f) - wide(contact.normal) * contact.spin_torque.to_f64();
    assert!(f.dot(&wide(contact.normal)) < 0.0, "{contact:?}");
    let size = double.semi_axes().max();
    let scaled = c.component_div(&double.semi_axes());
    let line = fingertip_wrench::Line { point: Vector3::zeros(), direction: c.normalize() };
    let mut height = f64::INFINITY;
    double.crossings(&line, |crossing| height = height.min((crossing.point - c).norm()));
    assert!(scaled.norm() > 0.1);
    Some([rest.norm() / (f.norm() * size + m.norm()), height / size])
}

/// In single precision this was off by a tenth of the size, and nothing said so.
#[test]
fn what_was_wrong_in_silence_is_right() {
    let axes = Vector3::new(24.782_553_f32, 14.660_491, 59.546_97);
    let shape = Superquadric::new(axes, [1.343_592_f32, 0.206_242_5]).unwrap();
    let wrench = Wrench::on_fingertip(
        Vector3::new(0.410_412_28_f32, -0.098_198_72, 0.162_877_48),
        Vector3::new(2.454_499_2_f32, -5_552.727_5, -165.546_53),
    );
    let [residual, height] = off(&shape, &wrench).unwrap();
    assert!(residual < 1e-6 && height < 1e-6, "{residual:e} {height:e}");
    // And its place is that of double precision.
    let double = Superquadric::new(axes.cast::<f64>(), [1.343_592_f32, 0.206_242_5].map(f64::from)).unwrap();
    let model = SoftFinger::new(0.0).unwrap().without_friction_limit();
    let exact = Wrench::on_fingertip(wrench.force().cast(), wrench.torque().cast());
    let exact = model.resolve(&exact, &double);
    let single = SoftFinger::new(0.0_f32).unwrap().without_friction_limit().resolve(&wrench, &shape);
    let (Some(exact), Some(single)) = (exact.contact(), single.contact()) else {
        panic!("{exact:?} {single:?}")
    };
    let apart = (single.point.cast::<f64>() - exact.point).norm() / 59.5;
    assert!(apart < 1e-6, "{apart:e} {exact:?} {single:?}");
}

/// In double precision this was said to be unresolved.
#[test]
fn what_was_unresolved_has_a_contact() {
    let axes = Vector3::new(0.010_209_862, 0.011_854_478, 0.019_609_447);
    let shape = Superquadric::new(axes, [0.669_413_1, 1.593_837_6]).unwrap();
    let wrench = Wrench::on_fingertip(
        Vector3::new(9.568_473e-13, -2.054_441e-12, 9.584_614e-12),
        Vector3::new(-3.781_802_9e-14, -1.161_212_32e-13, -2.099_92e-14),
    );
    let [residual, height] = off(&shape, &wrench).unwrap();
    assert!(residual < 1e-13 && height < 1e-13, "{residual:e} {height:e}");
}

/// At flat angles on superquadrics that are all but octahedra: what is found is right, in both precisions, and next
/// to all is found.
#[test]
fn flat_angles_on_sharp_shapes_have_contacts() {
    fn check<T: Real>(goal: f64) {
        let (mut random, mut unresolved) = (Random::new(801), 0);
        for _ in 0..400 {
            let axes = Vector3::from_fn(|_, _| random.log_uniform(0.2, 1.0));
            let exponents = [random.uniform(0.2, 1.9), random.uniform(1.4, 1.95)];
            let double = Superquadric::<f64>::new(axes, exponents).unwrap();
            let (point, normal) = random.place(&double, 1.0);
            let cosine = random.log_uniform(1e-3, 0.05);
            let any = random.direction();
            let across = (any - normal * any.dot(&normal)).normalize();
            let force = across * (1.0 - cosine * cosine).sqrt() - normal * cosine;
            let spin = random.sign() * random.log_uniform(1e-6, 1e2);
            let torque = point.cross(&force) + normal * spin;
            let shape = Superquadric::<T>::new(axes.map(T::literal), exponents.map(T::literal)).unwrap();
            let wrench = Wrench::on_fingertip(force.map(T::literal), torque.map(T::literal));
            let Some([residual, height]) = off(&shape, &wrench) else {
                unresolved += 1;
                continue;
            };
            assert!(residual < goal && height < goal, "{residual:e} {height:e} {shape:?} {wrench:?}");
        }
        println!("{}: {unresolved} of 400 unresolved", core::any::type_name::<T>());
        assert!(unresolved <= 8, "{unresolved}");
    }
    check::<f64>(1e-12);
    check::<f32>(2e-6);
}
