//! The pipeline of a scene and the typed one, bit for bit.

use fingertip::contact::{PointContact, SoftFinger};
use fingertip::friction::{Coulomb, DropDetector, ForceNoise, SoftFingerLimit};
use fingertip::surfaces::{Capsule, Posed, Sphere};
use fingertip::wrench::RigidTransform;
use fingertip::{Fingertip, Step};
use fingertip_scene::Scene;
use nalgebra::Vector3;

use crate::{BALL, HEAD, pushes};

#[test]
fn a_point_contact_on_a_sphere() {
    let text = format!(
        "{HEAD}{BALL}[contact]\nleast_force_N = 0.1\n[friction]\nstatic_coefficient = 0.5\n\
         [slip]\ndetector = \"drop\"\nnoise_N = 0.01\n"
    );
    let mut pipeline = Scene::from_text(&text).unwrap().pipeline();
    let mut typed = Fingertip::builder()
        .contact(Sphere::centred(0.013).unwrap(), PointContact::new(0.1).unwrap())
        .friction(Coulomb::new(0.5).unwrap())
        .slip_detector(DropDetector::new(ForceNoise::isotropic(0.01).unwrap()).unwrap())
        .build();
    let mut last = None;
    for push in pushes(3, 2000) {
        let felt = pipeline.sense(push, 1e-3);
        let touch = typed.sense_wrench(push, Step::of(1e-3).with_last(last));
        last = touch.point();
        assert_eq!(felt.touch.resolution, touch.resolution);
        assert_eq!(
            (felt.touch.force, felt.margin(), felt.touch.slip),
            (touch.force, touch.grip, Some(touch.slip))
        );
    }
}

#[test]
fn a_soft_finger_on_a_capsule_that_is_turned() {
    let text = format!(
        "{HEAD}[surface]\nshape = \"capsule\"\nradius_m = 0.008\nhalf_length_m = 0.01\n\
         [pose]\ntranslation_m = [0.001, 0.0, 0.002]\nrotation_deg = [0.0, 90.0, 0.0]\n\
         [contact]\nmodel = \"soft_finger\"\n[friction]\nlimit = \"soft_finger\"\nstatic_coefficient = 0.5\n\
         torque_arm_m = 0.003\n"
    );
    let scene = Scene::from_text(&text).unwrap();
    let (mut double, mut single) = (scene.pipeline(), scene.pipeline_in::<f32>().unwrap());
    macro_rules! check {
        ($t:ty, $pipeline:ident) => {
            let number = |x: f64| x as $t;
            let turn = Vector3::new(0.0, 90.0_f64.to_radians(), 0.0).map(number);
            let pose =
                RigidTransform::from_axis_angle(turn, Vector3::new(0.001, 0.0, 0.002).map(number)).unwrap();
            let capsule = Capsule::new(Vector3::zeros(), Vector3::z(), number(0.01), number(0.008)).unwrap();
            let mut typed = Fingertip::builder()
                .contact(Posed::new(capsule, pose), SoftFinger::new(0.0).unwrap())
                .friction(SoftFingerLimit::new(number(0.5), number(0.003)).unwrap())
                .build();
            let mut last = None;
            for push in pushes(4, 2000) {
                let push = fingertip::wrench::Wrench::on_fingertip(
                    push.force().map(number),
                    push.torque().map(number),
                );
                let felt = $pipeline.sense(push, number(1e-3));
                let touch = typed.sense_wrench(push, Step::of(number(1e-3)).with_last(last));
                last = touch.point();
                assert_eq!(felt.touch.resolution, touch.resolution);
                assert_eq!((felt.touch.force, felt.margin()), (touch.force, touch.grip));
            }
        };
    }
    check!(f64, double);
    check!(f32, single);
}
