//! Superquadrics that were wrong in silence, or said to be unresolved.

use fingertip_contact::{ContactModel, NoContact, Resolution, SoftFinger, SoftFingerSurface};
use fingertip_surfaces::{ActiveSurface, ForceLine, SmoothSurface, Superquadric};
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

/// What the shortcut answers solves the equations, at corners, edges and flat sides of every exponent, and next to
/// the axes and planes, where second derivatives are infinite or zero.
#[test]
fn shortcuts_answer_what_the_equations_say() {
    fn check<T: Real>(goal: f64) {
        let (mut random, mut asked, mut answered) = (Random::new(802), 0, 0);
        for k in 0..20_000 {
            let scale = random.log_uniform(1e-3, 1e3);
            let axes = Vector3::from_fn(|_, _| T::literal(scale * random.log_uniform(0.1, 1.0)));
            let exponents = [0, 1].map(|_| match k % 4 {
                0 => T::literal(random.log_uniform(0.05, 2.0)),
                1 => T::literal(0.05),
                2 => T::literal(2.0),
                _ => T::one(),
            });
            let shape = Superquadric::<T>::new(axes, exponents).unwrap();
            let double = Superquadric::new(axes.map(Real::to_f64), exponents.map(Real::to_f64)).unwrap();
            let mut outward = random.direction();
            for (axis, part) in outward.iter_mut().enumerate() {
                let chance = random.uniform(0.0, 4.0);
                if axis > 0 && chance < 1.0 {
                    *part = 0.0;
                } else if axis > 0 && chance < 2.0 {
                    *part *= random.log_uniform(1e-30, 1.0);
                }
            }
            let line = fingertip_wrench::Line { point: Vector3::zeros(), direction: outward.normalize() };
            let mut place = None;
            double.crossings(&line, |crossing| {
                if crossing.along > 0.0 {
                    place = Some((crossing.point, crossing.normal));
                }
            });
            let (point, normal) = place.unwrap();
            let mut force = random.direction();
            force *= -force.dot(&normal).signum() * random.log_uniform(1e-6, 1e6);
            let spin = random.sign() * random.log_uniform(1e-6, 10.0) * force.norm() * scale;
            let torque = point.cross(&force) + normal * if k % 5 == 0 { 0.0 } else { spin };
            let wrench = Wrench::on_fingertip(force.map(T::literal), torque.map(T::literal));
            asked += 1;
            let Some(push) = ForceLine::new(&wrench, T::zero()) else { continue };
            let Some(contact) = shape.sole_soft_contact(&push) else { continue };
            answered += 1;
            let wide = |v: Vector3<T>| v.map(Real::to_f64);
            let (f, m, c, n) =
                (wide(wrench.force()), wide(wrench.torque()), wide(contact.point), wide(contact.normal));
            let rest = (m - c.cross(&f) - n * contact.spin_torque.to_f64()).norm();
            let size = double.semi_axes().max();
            let level = double.level(&c);
            let (height, bend) = (level.value, level.hessian.norm());
            let steepness = level.gradient.norm();
            let (height, bend) = (height / steepness, bend / steepness);
            let told = || format!("{shape:?} {wrench:?} {contact:?}");
            assert!(rest <= goal * (f.norm() * size + m.norm()), "{rest:e} {}", told());
            assert!(height.abs() <= goal * size, "{height:e} {}", told());
            assert!((n.norm() - 1.0).abs() <= goal && n.dot(&f) < 0.0, "{}", told());
            // On an edge or a tip it may be one of many, and next to them that of a place nearby.
            let apart = (double.normal(&c) - n).norm();
            let sharp = c.component_div(&double.semi_axes()).amin() < 1e-3;
            assert!(sharp || apart <= goal * (1.0 + bend * size), "{apart:e} {bend:e} {}", told());
        }
        println!("{}: {answered} of {asked} answered", core::any::type_name::<T>());
        assert!(answered * 4 > asked, "{answered}");
    }
    check::<f64>(1e-13);
    check::<f32>(1e-6);
}

/// Tiny, huge, infinite, NaN: whatever the shortcut answers is made of numbers, and presses.
#[test]
fn shortcuts_answer_no_nonsense() {
    fn check<T: Real>() {
        let [zero, one] = [T::zero(), T::one()];
        let extremes = [
            zero,
            one,
            -one,
            T::LEAST_NORMAL,
            T::LEAST_NORMAL * T::EPSILON,
            T::LEAST_NORMAL.root(),
            T::GREATEST,
            T::GREATEST.root(),
            zero / zero,
            one / zero,
        ];
        let mut answered = 0;
        for size in [T::LEAST_NORMAL.root(), one, T::GREATEST.root()] {
            for exponents in [[0.05, 2.0], [2.0, 0.05], [1.0, 1.0], [0.05, 0.05], [2.0, 2.0], [0.7, 0.8]] {
                let axes = Vector3::new(one, T::literal(0.5), T::literal(0.1)) * size;
                let Ok(shape) = Superquadric::new(axes, exponents.map(T::literal)) else { continue };
                for down in extremes {
                    for across in extremes {
                        for torque in extremes {
                            for along in extremes {
                                let force = Vector3::new(across, zero, down);
                                let moment = Vector3::new(zero, torque, along);
                                let wrench = Wrench::on_fingertip(force, moment);
                                let Some(push) = ForceLine::new(&wrench, zero) else { continue };
                                let Some(contact) = shape.sole_soft_contact(&push) else { continue };
                                answered += 1;
                                let sum = contact.point.sum() + contact.normal.sum() + contact.spin_torque;
                                assert!(sum.is_number(), "{shape:?} {wrench:?} {contact:?}");
                                // Of a force that is subnormal no share shall vanish.
                                let scaled = force * force.amax().normalising_factor();
                                let pressing = contact.normal.dot(&scaled) < zero;
                                let unit = (contact.normal.norm() - one).abs() < T::literal(1e-6);
                                assert!(pressing && unit, "{shape:?} {wrench:?} {contact:?}");
                            }
                        }
                    }
                }
            }
        }
        assert!(answered > 100, "{answered}");
    }
    check::<f32>();
    check::<f64>();
}
