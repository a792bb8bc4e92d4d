//! Fingertips of different types, as one.

use fingertip::contact::{PointContact, SoftFinger};
use fingertip::friction::{Coulomb, DropDetector, ForceNoise};
use fingertip::surfaces::{Capsule, Sphere, Torus};
use fingertip::wrench::Wrench;
use fingertip::{Fingertip, Fingertips, Present, Step, TouchSensor};
use nalgebra::Vector3;

/// Each answers as it does alone, stage by stage; one that has no such stage says nothing there.
#[test]
fn fingers_of_different_types_answer_as_they_do_alone() {
    let noise = ForceNoise::isotropic(0.01).unwrap();
    let mut thumb = Fingertip::builder()
        .contact(Sphere::centred(0.013).unwrap(), PointContact::new(0.1).unwrap())
        .friction(Coulomb::new(0.5).unwrap())
        .slip_detector(DropDetector::new(noise).unwrap())
        .build();
    let capsule = Capsule::new(Vector3::zeros(), Vector3::z(), 7e-3, 6e-3).unwrap();
    let mut index = Fingertip::builder().contact(capsule, SoftFinger::new(0.1).unwrap()).build();
    let (mut thumb_alone, mut index_alone) = (thumb, index);
    let mut hand: [&mut dyn TouchSensor<f64>; 2] = [&mut thumb, &mut index];
    for k in 0..200 {
        let aside = 0.3 * (0.1 * f64::from(k)).sin();
        let push = Wrench::from_force_at(
            &Vector3::new(0.01, 1e-3, 0.0),
            Vector3::new(-1.0 + f64::from(k % 50) / 40.0, aside, 0.1),
        );
        let [first, second] = hand.each_mut().map(|finger| finger.feel(push, Step::of(1e-3)));
        let one = thumb_alone.sense_wrench(push, 1e-3);
        assert_eq!((first.wrench, first.resolution, first.force), (one.wrench, one.resolution, one.force));
        assert_eq!((first.grip, first.slip), (one.grip.map(Some), Some(one.slip)));
        let two = index_alone.sense_wrench(push, 1e-3);
        assert_eq!((second.wrench, second.resolution, second.force), (two.wrench, two.resolution, two.force));
        assert_eq!((second.grip.flatten(), second.slip), (None, None));
    }
    let fresh = Present(DropDetector::new(noise).unwrap());
    let push = Wrench::on_fingertip(Vector3::new(-1.0, 0.0, 0.2), Vector3::zeros());
    thumb.feel(push, Step::of(1e-3));
    assert_ne!(*thumb.detector(), fresh);
    thumb.start_anew();
    assert_eq!(*thumb.detector(), fresh);
}

/// What a step says of the last contact is heard.
#[test]
fn the_last_contact_is_handed_on() {
    let mut ring = Fingertip::builder()
        .contact(Torus::new(0.01, 0.003).unwrap(), PointContact::new(0.1).unwrap())
        .build();
    let ring: &mut dyn TouchSensor<f64> = &mut ring;
    let push = Wrench::on_fingertip(Vector3::new(-1.0, 0.0, 0.0), Vector3::zeros());
    let inside = Vector3::new(-0.007, 0.0, 0.0);
    assert!((ring.feel(push, Step::of(1e-3)).point().unwrap().x - 0.013).abs() < 1e-12);
    let again = ring.feel(push, Step::of(1e-3).with_last(Some(inside)));
    assert!((again.point().unwrap().x + 0.007).abs() < 1e-12);
}

/// Tuples of two to five and arrays answer as each does alone, in their order.
#[test]
fn fingers_together_answer_as_they_do_alone() {
    let ball = |radius: f64| {
        let noise = ForceNoise::isotropic(0.01).unwrap();
        Fingertip::builder()
            .contact(Sphere::centred(radius).unwrap(), SoftFinger::new(0.1).unwrap())
            .slip_detector(DropDetector::new(noise).unwrap())
            .build()
    };
    let ring = || {
        Fingertip::builder()
            .contact(Torus::new(0.01, 0.003).unwrap(), PointContact::new(0.1).unwrap())
            .build()
    };
    fn check<const N: usize>(hand: &mut impl Fingertips<f64, N>, mut alone: [&mut dyn TouchSensor<f64>; N]) {
        for k in 0..50 {
            let mut number = f64::from(k);
            let wrenches = [(); N].map(|()| {
                number += 0.7;
                let force = Vector3::new(-1.0, 0.2 * number.sin(), 0.1 * number.cos());
                Wrench::from_force_at(&Vector3::new(0.01, 1e-3 * number.cos(), 0.0), force)
            });
            let steps = [(); N].map(|()| {
                number += 1.0;
                Step::of(1e-3 * number).with_last((k % 2 == 0).then(|| Vector3::x() * -0.007))
            });
            let touches = hand.feel_all(&wrenches, &steps);
            for (((touch, wrench), step), finger) in touches.iter().zip(wrenches).zip(steps).zip(&mut alone) {
                assert_eq!(*touch, finger.feel(wrench, step));
            }
            if k == 25 {
                hand.start_all_anew();
                alone.iter_mut().for_each(|finger| finger.start_anew());
            }
        }
        let still = Wrench::zero();
        assert!(hand.feel_all(&[still; N], &[Step::of(1e-3); N]).iter().all(|touch| touch.point().is_none()));
    }
    let ([mut a, mut b, mut c], [mut r, mut q]) = ([0.013, 0.011, 0.01].map(ball), [ring(), ring()]);
    check(&mut (a, r), [&mut a, &mut r]);
    check(&mut (a, r, b), [&mut a, &mut r, &mut b]);
    check(&mut (r, a, b, c), [&mut r, &mut a, &mut b, &mut c]);
    check(&mut (a, r, b, q, c), [&mut a, &mut r, &mut b, &mut q, &mut c]);
    check(&mut [a, b, c], [&mut a, &mut b, &mut c]);
    let (mut first, mut second) = (a, r);
    let mut mixed: [&mut dyn TouchSensor<f64>; 2] = [&mut first, &mut second];
    check(&mut mixed, [&mut a, &mut r]);
}
