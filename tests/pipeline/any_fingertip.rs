//! Fingertips of different types, as one.

use fingertip::contact::{PointContact, SoftFinger};
use fingertip::friction::{Coulomb, DropDetector, ForceNoise};
use fingertip::surfaces::{Capsule, Sphere, Torus};
use fingertip::wrench::Wrench;
use fingertip::{Fingertip, Present, Step, TouchSensor};
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
    let capsule = Capsule::new(Vector3::zeros(), Vector3::z(), 6e-3, 7e-3).unwrap();
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
