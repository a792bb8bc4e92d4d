//! Hands: what C gets is what the crate of hands says.

use core::ptr;

use fingertip::friction::{ForceNoise, SlipVerdict};
use fingertip::hand::{
    FingerLimits, FingerSample, FingerState, FrictionBelief, Grasp, GraspContact, GripOutcome, Hand,
    HandController, HandLoad, HandSettings, HandState, LearntFriction, LeastGrip,
};
use fingertip::wrench::{ContactForce, RigidTransform, Sensor, Wrench};
use fingertip_c::{
    FT_MAX_FINGERS, ft_error, ft_finger, ft_finger_from_touch, ft_finger_limits, ft_grip, ft_hand,
    ft_hand_command, ft_hand_create, ft_hand_forget, ft_hand_free, ft_hand_least_grip, ft_hand_message,
    ft_hand_order, ft_hand_settings_defaults, ft_hand_state, ft_margin, ft_object_wrench, ft_pose,
    ft_resolution, ft_sense_wrench, ft_slip, ft_slip_margins, ft_status, ft_touch, ft_wrench,
};
use nalgebra::{Matrix3, Vector3};

use crate::{BALL, HEAD, Tip, said, written};

const LIMIT: ft_finger_limits =
    ft_finger_limits { least_normal_force: 0.3, greatest_normal_force: 15.0, cost: 2.0 };

struct Held(*mut ft_hand);

impl Held {
    fn new(limits: &[ft_finger_limits]) -> Self {
        let settings = ft_hand_settings_defaults();
        let made = written(|hand| unsafe {
            ft_hand_create(&settings, limits.as_ptr(), limits.len(), hand, ptr::null_mut())
        });
        Self(made.unwrap())
    }

    fn says(&self) -> String {
        unsafe { core::ffi::CStr::from_ptr(ft_hand_message(self.0)) }.to_str().unwrap().to_owned()
    }
}

impl Drop for Held {
    fn drop(&mut self) {
        unsafe { ft_hand_free(&raw mut self.0) };
        assert!(self.0.is_null());
        unsafe { ft_hand_free(&raw mut self.0) };
    }
}

/// A finger of three around a jar, that bears its share of 3 N.
fn finger(index: usize, arm: f64) -> ft_finger {
    let angle = index as f64 * 2.1;
    let outward = [angle.cos(), angle.sin(), 0.0];
    ft_finger {
        touching: 1,
        slip: ft_slip::FT_HOLDING as u32,
        point: outward.map(|x| x * 0.04),
        normal: outward.map(|x| -x),
        friction: 0.6,
        torque_arm: arm,
        normal_force: 3.0,
        tangential_force: [0.0, 0.0, -1.0],
        spin_torque: 0.0,
    }
}

fn sample(finger: &ft_finger) -> FingerSample<f64, Hand> {
    let (point, normal) = (finger.point.into(), finger.normal.into());
    let contact = match finger.torque_arm > 0.0 {
        true => GraspContact::soft(point, normal, finger.friction, finger.torque_arm),
        false => GraspContact::point(point, normal, finger.friction),
    };
    let force = ContactForce::new(finger.normal_force, finger.tangential_force.into(), finger.spin_torque);
    let slip = if finger.slip == 3 { SlipVerdict::Slipping } else { SlipVerdict::Holding };
    FingerSample { contact: contact.unwrap(), force, slip }
}

fn limits() -> FingerLimits<f64, 2> {
    let none = FingerLimits::none();
    none.with_least_normal(0.3).unwrap().with_greatest_normal(15.0).unwrap().with_cost(2.0).unwrap()
}

/// Against a controller of just three fingers: the number of fingers that there is room for changes no force.
#[test]
fn commands_are_those_of_the_controller() {
    let hand = Held::new(&[LIMIT; 3]);
    let settings = HandSettings::default();
    let mut controller = HandController::<f64, 3, 2>::new(settings, [limits(); 3]).unwrap();
    let mut before = [0.0; 3];
    for k in 0..60 {
        let mut fingers = [0, 1, 2].map(|index| finger(index, [0.0, 2e-3][usize::from(k >= 20)]));
        if k == 40 {
            fingers[1].slip = ft_slip::FT_SLIPPING as u32;
        }
        // One whose force cannot be, and one that feels what no contact explains.
        match k {
            50 | 51 => fingers[2].normal_force = -1.0,
            52 | 53 => fingers[2] = ft_finger { touching: 2, point: [f64::NAN; 3], ..fingers[2] },
            _ => {}
        }
        let wrong = (50..54).contains(&k);
        let load: ft_wrench =
            written(|to| unsafe { ft_object_wrench(fingers.as_ptr(), 3, to, ptr::null_mut()) }).unwrap();
        let states = fingers.each_ref().map(|finger| match finger.touching {
            2 => FingerState::Unexplained,
            _ => FingerState::Touching(sample(finger)),
        });
        let (grasp, forces) = Grasp::of_fingers(&states);
        let sum = grasp.wrench(&forces);
        assert!((Vector3::from(load.force) - sum.force()).norm() < 1e-12);
        assert!((Vector3::from(load.torque) - sum.torque()).norm() < 1e-12);

        let given = if k % 2 == 0 { ptr::null() } else { &raw const load };
        let order: ft_hand_order =
            written(|to| unsafe { ft_hand_command(hand.0, fingers.as_ptr(), 3, given, 1e-3, to) }).unwrap();
        let known = if given.is_null() { HandLoad::FromFingers } else { HandLoad::Known(sum) };
        let command = controller.command(&states, &known, 1e-3);
        // What they feel is doubtful. Two of three do not hold what a third that pulls is part of, but what they feel alone.
        let state = match k {
            50 | 52 => ft_hand_state::FT_HAND_DOUBTFUL,
            51 => ft_hand_state::FT_HAND_CANNOT_HOLD,
            _ => ft_hand_state::FT_HAND_HOLDING,
        };
        let holds = state == ft_hand_state::FT_HAND_HOLDING;
        assert_eq!(order.state, state, "{k}");
        assert_eq!(matches!(command.state, HandState::Holding), holds);
        assert_eq!(order.implausible, if wrong { 4 } else { 0 });
        if wrong {
            assert_eq!(order.normal_force[2], before[2]);
        }
        if !holds {
            assert_eq!(order.normal_force[..3], before);
        }
        before.copy_from_slice(&order.normal_force[..3]);
        let grip: ft_grip =
            written(|to| unsafe { ft_hand_least_grip(hand.0, fingers.as_ptr(), 3, given, to) }).unwrap();
        let doubtful = grip.state == ft_hand_state::FT_HAND_DOUBTFUL;
        assert_eq!(doubtful, state == ft_hand_state::FT_HAND_DOUBTFUL);
        for (told, expected) in order.normal_force.iter().zip(command.normal) {
            assert!((told - expected).abs() < 1e-6, "{k}: {told} {expected}");
        }
        assert_eq!(order.normal_force[3..], [0.0; FT_MAX_FINGERS - 3]);
    }
    assert!(controller.present()[1] > controller.present()[0] + 0.1);
    assert_eq!(unsafe { ft_hand_forget(hand.0) }, ft_status::FT_OK);
}

/// Three fingers that may give 3 N each, and loads that need more with safety, and then without.
#[test]
fn what_holds_without_safety_is_commanded_and_said() {
    let hand = Held::new(&[ft_finger_limits { greatest_normal_force: 3.0, ..LIMIT }; 3]);
    let fingers = [0, 1, 2].map(|index| finger(index, 2e-3));
    let mut states = Vec::new();
    for down in [3.0, 4.7, 8.0] {
        let load = ft_wrench { force: [0.0, 0.0, -down], torque: [0.0; 3] };
        let before = written::<ft_hand_order>(|to| unsafe {
            ft_hand_command(hand.0, fingers.as_ptr(), 3, &load, 0.1, to)
        });
        let order: ft_hand_order =
            written(|to| unsafe { ft_hand_command(hand.0, fingers.as_ptr(), 3, &load, 0.1, to) }).unwrap();
        assert_eq!(order.state, before.unwrap().state);
        let sum = order.normal_force.iter().sum::<f64>();
        match order.state {
            ft_hand_state::FT_HAND_HOLDING => assert!(sum >= 1.3 * down / 0.6 - 1e-6, "{order:?}"),
            ft_hand_state::FT_HAND_WITHOUT_SAFETY => {
                assert!(sum >= down / 0.6 - 1e-6 && sum < 9.0, "{order:?}");
                assert_eq!([order.velocity, order.turning], [[0.0; 3]; 2]);
            }
            _ => assert!(order.velocity[2] < 0.0),
        }
        states.push(order.state);
    }
    let expected = [
        ft_hand_state::FT_HAND_HOLDING,
        ft_hand_state::FT_HAND_WITHOUT_SAFETY,
        ft_hand_state::FT_HAND_CANNOT_HOLD,
    ];
    assert_eq!(states, expected);
    assert_eq!(states[1] as u32, 4);
}

#[test]
fn the_least_grip_is_that_of_the_crate() {
    let hand = Held::new(&[LIMIT; 3]);
    let fingers = [0, 1, 2].map(|index| finger(index, 2e-3));
    let contacts = fingers.each_ref().map(|finger| Some(sample(finger).contact));
    let load = ft_wrench { force: [0.2, 0.1, -3.0], torque: [0.01, 0.0, 0.002] };
    let grip: ft_grip =
        written(|to| unsafe { ft_hand_least_grip(hand.0, fingers.as_ptr(), 3, &load, to) }).unwrap();
    let loaded = Wrench::on_fingertip(load.force.into(), load.torque.into());
    let outcome = LeastGrip::<f64, 3, 2>::new().solve(&Grasp::new(contacts), &[limits(); 3], &loaded);
    let GripOutcome::Held(found) = outcome else { panic!("{outcome:?}") };
    assert_eq!(grip.state, ft_hand_state::FT_HAND_HOLDING);
    assert!((grip.cost - found.cost).abs() < 1e-5 * found.cost && grip.least_cost <= grip.cost);
    // It bears the load, whatever the path to it.
    let mut sum = Wrench::<f64, Hand>::zero();
    for (index, contact) in contacts.iter().enumerate() {
        let contact = contact.unwrap();
        let tangential: Vector3<f64> = grip.tangential_force[index].into();
        let force = ContactForce::new(grip.normal_force[index], tangential, grip.spin_torque[index]);
        sum = sum + contact.wrench(&force);
        let used = tangential.norm_squared() + (grip.spin_torque[index] / 2e-3).powi(2);
        assert!(used.sqrt() <= 0.6 * grip.normal_force[index] + 1e-9);
    }
    assert!((sum.components() - loaded.components()).norm() < 1e-6, "{sum:?}");

    // Two fingers on the same side hold nothing, and the object goes where the load is.
    let aside = [finger(0, 0.0), finger(0, 0.0), ft_finger { touching: 0, ..finger(1, 0.0) }];
    let grip: ft_grip =
        written(|to| unsafe { ft_hand_least_grip(hand.0, aside.as_ptr(), 3, &load, to) }).unwrap();
    assert_eq!(grip.state, ft_hand_state::FT_HAND_CANNOT_HOLD);
    let power =
        Vector3::from(grip.velocity).dot(&loaded.force()) + Vector3::from(grip.turning).dot(&loaded.torque());
    assert!(power > 0.0);
    let order: ft_hand_order =
        written(|to| unsafe { ft_hand_command(hand.0, aside.as_ptr(), 3, &load, 1e-3, to) }).unwrap();
    assert_eq!((order.state, order.normal_force[0]), (ft_hand_state::FT_HAND_CANNOT_HOLD, 0.3));
    assert_ne!([order.velocity, order.turning], [[0.0; 3]; 2]);
    // Numbers that are none are told, too.
    let blind = ft_wrench { force: [f64::NAN; 3], ..load };
    let grip: ft_grip =
        written(|to| unsafe { ft_hand_least_grip(hand.0, fingers.as_ptr(), 3, &blind, to) }).unwrap();
    assert_eq!(grip.state, ft_hand_state::FT_HAND_BLIND);
}

#[test]
fn margins_are_those_of_each_finger() {
    let fingers = [finger(0, 0.0), ft_finger { touching: 0, ..finger(1, 0.0) }, finger(2, 2e-3)];
    let mut margins = [ft_margin { newtons: 9.0, utilisation: 9.0 }; 4];
    let status = unsafe { ft_slip_margins(fingers.as_ptr(), 3, margins.as_mut_ptr(), ptr::null_mut()) };
    assert_eq!(status, ft_status::FT_OK);
    // 1 N of the 1.8 N that friction holds.
    assert!((margins[0].utilisation - 1.0 / 1.8).abs() < 1e-12 && margins[0].newtons > 0.5);
    assert_eq!(margins[1], ft_margin { newtons: 0.0, utilisation: 0.0 });
    assert!((margins[2].utilisation - 1.0 / 1.8).abs() < 1e-12);
    assert_eq!(margins[3].newtons, 9.0);
}

#[test]
fn a_touch_becomes_a_finger_in_the_frame_of_the_hand() {
    let tip = Tip::new(&format!("{HEAD}{BALL}[friction]\nstatic_coefficient = 0.6\n"));
    let wrench = ft_wrench { force: [0.3, -0.2, -2.0], torque: [0.2 * 0.013, 0.3 * 0.013, 0.0] };
    let touch: ft_touch = written(|to| unsafe { ft_sense_wrench(tip.0, &wrench, 1e-3, to) }).unwrap();
    assert_eq!(touch.resolution, ft_resolution::FT_CONTACT);
    let pose: RigidTransform<f64, Hand, Sensor> =
        RigidTransform::from_axis_angle(Vector3::new(0.3, -1.0, 0.5), Vector3::new(0.1, 0.2, -0.3)).unwrap();
    let given = ft_pose { rotation: pose.rotation().transpose().into(), origin: pose.origin().into() };
    // Rows, not columns.
    assert_eq!(given.rotation[0][1], pose.rotation()[(0, 1)]);
    let made = |touch: &ft_touch| -> ft_finger {
        written(|to| unsafe { ft_finger_from_touch(touch, &given, 0.6, 0.002, to, ptr::null_mut()) }).unwrap()
    };
    let finger = made(&touch);
    // The wrench about the origin of the hand is that of the sensor, moved there.
    let moved: Wrench<f64, Hand> =
        Wrench::<f64, Sensor>::on_fingertip(wrench.force.into(), wrench.torque.into()).expressed_in(&pose);
    let load: ft_wrench = written(|to| unsafe { ft_object_wrench(&finger, 1, to, ptr::null_mut()) }).unwrap();
    assert!((Vector3::from(load.force) - moved.force()).norm() < 1e-12);
    assert!((Vector3::from(load.torque) - moved.torque()).norm() < 1e-9);
    assert_eq!((finger.friction, finger.torque_arm), (0.6, 0.002));

    for (resolution, touching) in [
        (ft_resolution::FT_BELOW_THRESHOLD, 0),
        (ft_resolution::FT_MISSES, 2),
        (ft_resolution::FT_NOT_FINITE, 2),
    ] {
        assert_eq!(made(&ft_touch { resolution, ..touch }).touching, touching);
    }
    let mut error = core::mem::MaybeUninit::<ft_error>::uninit();
    let bent = ft_pose { rotation: (Matrix3::<f64>::identity() * 2.0).into(), ..given };
    let status = unsafe {
        let mut finger = core::mem::MaybeUninit::uninit();
        ft_finger_from_touch(&touch, &bent, 0.6, 0.0, finger.as_mut_ptr(), error.as_mut_ptr())
    };
    assert_eq!(status, ft_status::FT_BAD_NUMBER);
    let said = said(&unsafe { error.assume_init() });
    assert!(said.starts_with("`hand_from_sensor`: "), "{said}");
}

/// Two fingers are pulled ever harder, until they slip at a ratio of 0.4.
#[test]
fn a_hand_that_learns_tells_what_slips_have_taught() {
    let settings = fingertip_c::ft_hand_settings { friction_noise: 0.01, ..ft_hand_settings_defaults() };
    let mut hand: *mut ft_hand = ptr::null_mut();
    let limits = [LIMIT; 2];
    let status = unsafe { ft_hand_create(&settings, limits.as_ptr(), 2, &raw mut hand, ptr::null_mut()) };
    assert_eq!(status, ft_status::FT_OK);
    let noise = ForceNoise::isotropic(0.01).unwrap();
    let mut belief = LearntFriction::new(noise, 0.05, 0.01).unwrap();
    for k in 0..=100 {
        let ratio = 0.004 * f64::from(k);
        let fingers = [0, 1].map(|index| ft_finger {
            normal_force: 2.0,
            tangential_force: [0.0, 0.0, -2.0 * ratio],
            slip: if k == 100 { ft_slip::FT_SLIPPING as u32 } else { ft_slip::FT_HOLDING as u32 },
            ..finger(index, 2e-3)
        });
        let order: ft_hand_order =
            written(|to| unsafe { ft_hand_command(hand, fingers.as_ptr(), 2, ptr::null(), 1e-3, to) })
                .unwrap();
        let sample = sample(&fingers[0]);
        belief.rely(sample.contact.friction(), &sample.force, sample.slip, 1e-3, &HandSettings::default());
        let learnt = belief.estimate().map_or([0.0; 2], |learnt| [learnt.coefficient, learnt.deviation]);
        assert_eq!([order.friction[0], order.friction_deviation[0]], learnt, "{k}");
        assert_eq!(order.friction[2..], [0.0; FT_MAX_FINGERS - 2]);
        assert_eq!(order.friction[0] > 0.0, k == 100);
    }
    unsafe { ft_hand_free(&raw mut hand) };
}

#[test]
fn what_a_hand_cannot_use_is_named() {
    let hand = Held::new(&[LIMIT; 3]);
    let refused = |fingers: &[ft_finger], status: ft_status, says: &str| {
        let told = written::<ft_hand_order>(|to| unsafe {
            ft_hand_command(hand.0, fingers.as_ptr(), fingers.len(), ptr::null(), 1e-3, to)
        });
        assert_eq!(told.unwrap_err(), status);
        assert!(hand.says().contains(says), "{}", hand.says());
    };
    refused(&[finger(0, 0.0); 2], ft_status::FT_WRONG_SIZE, "2 fingers were given, and 3 are taken");
    let bad = ft_finger { normal: [0.0; 3], ..finger(1, 0.0) };
    refused(&[finger(0, 0.0), bad, bad], ft_status::FT_BAD_NUMBER, "finger 1: the point or normal");
    let bad = ft_finger { friction: -1.0, ..finger(1, 0.0) };
    refused(&[finger(0, 0.0), finger(1, 0.0), bad], ft_status::FT_BAD_NUMBER, "finger 2: the friction");
    let bad = ft_finger { touching: 3, ..finger(1, 0.0) };
    refused(&[finger(0, 0.0), finger(1, 0.0), bad], ft_status::FT_BAD_NUMBER, "`touching` must be 0, 1 or 2");
    let bad = ft_finger { slip: 4, ..finger(1, 0.0) };
    refused(
        &[finger(0, 0.0), finger(1, 0.0), bad],
        ft_status::FT_BAD_NUMBER,
        "`slip` must be that of a verdict",
    );

    let create = |settings: fingertip_c::ft_hand_settings, limits: &[ft_finger_limits], says: &str| {
        let mut hand: *mut ft_hand = ptr::null_mut();
        let mut error = core::mem::MaybeUninit::<ft_error>::uninit();
        let (limits, count) = (limits.as_ptr(), limits.len());
        let status = unsafe { ft_hand_create(&settings, limits, count, &raw mut hand, error.as_mut_ptr()) };
        assert!(status != ft_status::FT_OK && hand.is_null());
        let said = said(&unsafe { error.assume_init() });
        assert!(said.contains(says), "{said}");
    };
    let good = ft_hand_settings_defaults();
    create(good, &[], "0 fingers were given, and a hand has from 1 to 6");
    create(good, &[LIMIT; 7], "7 fingers");
    create(fingertip_c::ft_hand_settings { safety: 0.5, ..good }, &[LIMIT], "factor of safety");
    for (noise, says) in [(-0.01, "noise"), (f64::NAN, "noise")] {
        create(fingertip_c::ft_hand_settings { friction_noise: noise, ..good }, &[LIMIT], says);
    }
    let learning = fingertip_c::ft_hand_settings { friction_noise: 0.01, friction_probability: 0.7, ..good };
    create(learning, &[LIMIT], "probability of less friction");
    let limit = ft_finger_limits { greatest_normal_force: 0.1, ..LIMIT };
    create(good, &[LIMIT, limit], "finger 1: the greatest normal force");
}
