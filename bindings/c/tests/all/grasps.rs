//! Joints, quality and the object of a hand: against formulas, and against the crate of hands.

use core::ptr;

use fingertip::hand::{Grasp, GraspContact, Hand, Metric, ObjectWeight, OtherContact, UncertainWrench};
use fingertip::wrench::Wrench;
use fingertip_c::{
    FT_MAX_JOINTS, ft_error, ft_finger, ft_finger_limits, ft_grasp_quality, ft_grip, ft_hand,
    ft_hand_command, ft_hand_create, ft_hand_forget, ft_hand_free, ft_hand_least_grip, ft_hand_message,
    ft_hand_object, ft_hand_order, ft_hand_other, ft_hand_reach, ft_hand_set_joints,
    ft_hand_settings_defaults, ft_hand_state, ft_hand_weigh, ft_object, ft_other, ft_quality, ft_reach,
    ft_reach_state, ft_status, ft_uncertain_wrench, ft_wrench,
};
use nalgebra::{Matrix6, Vector3};

use crate::{said, written};

const FRICTION: f64 = 0.5;
const ARM: f64 = 3e-3;

/// Two fingers that pinch along x, 4 cm apart.
fn pinch() -> [ft_finger; 2] {
    [-1.0, 1.0].map(|side| ft_finger {
        touching: 1,
        slip: 0,
        point: [0.02 * side, 0.0, 0.0],
        normal: [-side, 0.0, 0.0],
        friction: FRICTION,
        torque_arm: ARM,
        normal_force: 4.0,
        tangential_force: [0.0, 0.0, -1.0],
        spin_torque: 0.0,
    })
}

fn contacts() -> [Option<GraspContact<f64, Hand>>; 2] {
    pinch().map(|finger| GraspContact::soft(finger.point.into(), finger.normal.into(), FRICTION, ARM).ok())
}

fn down(newtons: f64) -> ft_wrench {
    ft_wrench { force: [0.0, 0.0, -newtons], torque: [0.0; 3] }
}

/// Freed when the test ends.
struct Held(*mut ft_hand);

impl Held {
    fn new(limit: ft_finger_limits) -> Self {
        let settings = ft_hand_settings_defaults();
        let made = written(|hand| unsafe {
            ft_hand_create(&settings, [limit; 2].as_ptr(), 2, hand, ptr::null_mut())
        });
        Self(made.unwrap())
    }

    fn says(&self) -> String {
        unsafe { core::ffi::CStr::from_ptr(ft_hand_message(self.0)) }.to_str().unwrap().to_owned()
    }

    fn joints(&self, finger: usize, jacobian: &[f64], greatest: &[f64]) -> ft_status {
        unsafe { ft_hand_set_joints(self.0, finger, jacobian.as_ptr(), greatest.as_ptr(), greatest.len()) }
    }

    fn least(&self, newtons: f64) -> ft_grip {
        let (fingers, load) = (pinch(), down(newtons));
        written(|to| unsafe { ft_hand_least_grip(self.0, fingers.as_ptr(), 2, &load, to) }).unwrap()
    }

    fn reach(&self, load: &ft_wrench, disturbance: &ft_wrench) -> ft_reach {
        let fingers = pinch();
        written(|to| unsafe { ft_hand_reach(self.0, fingers.as_ptr(), 2, load, disturbance, to) }).unwrap()
    }
}

impl Drop for Held {
    fn drop(&mut self) {
        unsafe { ft_hand_free(&raw mut self.0) };
    }
}

const FREE: ft_finger_limits =
    ft_finger_limits { least_normal_force: 0.0, greatest_normal_force: 0.0, cost: 0.0 };

/// Hinges along y, 8 cm below the line of the fingers: a newton of normal force is 0.08 N·m, and what hangs on the finger
/// adds 0.02 N·m for a newton. With friction 0.5 each finger presses as firmly as the load is heavy.
#[test]
fn joints_limit_what_a_hand_holds() {
    let hand = Held::new(FREE);
    let hinge = [0.08, 0.0, 0.0, 0.0, 1.0, 0.0];
    // Of a load of 4 N.
    let needed = 0.08 * 4.0 + 0.02 * 2.0;
    let held = |grip: &ft_grip| grip.state == ft_hand_state::FT_HAND_HOLDING;
    assert!(held(&hand.least(400.0)));
    for (share, holds) in [(1.01, true), (0.9, false)] {
        for finger in 0..2 {
            // The second joint does not see the load: it limits nothing.
            let jacobian = [&hinge[..], &[0.0, 0.0, 0.0, 0.0, 0.0, 1.0]].concat();
            assert_eq!(hand.joints(finger, &jacobian, &[needed * share, 1e-3]), ft_status::FT_OK);
        }
        let grip = hand.least(4.0);
        assert_eq!(held(&grip), holds, "{share}");
        assert!(!holds || grip.normal_force[..2].iter().all(|normal| (normal - 4.0).abs() < 1e-4));
        let (fingers, load) = (pinch(), down(4.0 / 1.3));
        let order: ft_hand_order =
            written(|to| unsafe { ft_hand_command(hand.0, fingers.as_ptr(), 2, &load, 1.0, to) }).unwrap();
        // With the safety of 1.3 of commands, the same normal forces hold so much less.
        assert_eq!(order.state == ft_hand_state::FT_HAND_HOLDING, holds);
        let reach = hand.reach(&down(0.0), &down(4.0));
        assert_eq!(reach.state, ft_reach_state::FT_REACH_TIMES);
        assert!((reach.times - share).abs() < 1e-4, "{reach:?}");
    }
    // None any more.
    for finger in 0..2 {
        assert_eq!(hand.joints(finger, &[], &[]), ft_status::FT_OK);
    }
    assert!(held(&hand.least(400.0)));
    assert_eq!(hand.reach(&down(1.0), &down(1.0)).state, ft_reach_state::FT_REACH_UNLIMITED);

    for (finger, jacobian, greatest, says) in [
        (2, &hinge[..], &[1.0][..], "`finger` must be less than the number of fingers"),
        (1, &hinge[..], &[-1.0][..], "finger 1: the greatest torque of a joint"),
        (0, &[f64::NAN; 6][..], &[1.0][..], "finger 0: the Jacobian of the joints must be finite"),
        (0, &[1.0; 6][..], &[1.0; FT_MAX_JOINTS + 1][..], "7 joints were given, and 6 are taken"),
    ] {
        assert_ne!(hand.joints(finger, jacobian, greatest), ft_status::FT_OK);
        assert!(hand.says().contains(says), "{}", hand.says());
    }
    let status = unsafe { ft_hand_set_joints(hand.0, 0, ptr::null(), [1.0].as_ptr(), 1) };
    assert_eq!(status, ft_status::FT_NULL);
    // What was refused has changed nothing.
    assert!(held(&hand.least(400.0)));
}

#[test]
fn a_reach_ends_at_the_limits_of_the_fingers() {
    let hand = Held::new(ft_finger_limits { greatest_normal_force: 10.0, ..FREE });
    // Two fingers of 10 N with friction 0.5 carry 10 N: 2 N now and 8 N more.
    let reach = hand.reach(&down(2.0), &down(1.0));
    assert!(reach.state == ft_reach_state::FT_REACH_TIMES && (reach.times - 8.0).abs() < 1e-4, "{reach:?}");
    assert_eq!(hand.reach(&down(11.0), &down(1.0)).state, ft_reach_state::FT_REACH_NOT_HELD);
    assert_eq!(hand.reach(&down(f64::NAN), &down(1.0)).state, ft_reach_state::FT_REACH_UNKNOWN);
    // What the fingers feel, 2 N, where no load is given; unless one of them feels what cannot be.
    let mut fingers = pinch();
    let of_felt = |fingers: &[ft_finger; 2]| -> ft_reach {
        let more = down(1.0);
        written(|to| unsafe { ft_hand_reach(hand.0, fingers.as_ptr(), 2, ptr::null(), &more, to) }).unwrap()
    };
    assert!((of_felt(&fingers).times - 8.0).abs() < 1e-4);
    fingers[1].touching = 2;
    assert_eq!(of_felt(&fingers).state, ft_reach_state::FT_REACH_UNKNOWN);
}

#[test]
fn the_quality_of_a_grasp_is_that_of_the_crate() {
    let quality = |fingers: &[ft_finger], length: f64, each: u32| -> Result<ft_quality, ft_status> {
        written(|to| unsafe {
            ft_grasp_quality(fingers.as_ptr(), fingers.len(), length, each, to, ptr::null_mut())
        })
    };
    let found = quality(&pinch(), 0.02, 1).unwrap();
    let ball = Grasp::new(contacts()).ball(Metric::Each { length: 0.02 }).unwrap();
    assert_eq!((found.rank, found.force_closure), (6, 1));
    assert!((found.found - ball.found).abs() < 1e-9 && (found.certified - ball.certified).abs() < 1e-9);
    // What it bears least is a torque about the line of the fingers.
    assert!((found.found - 2.0 * FRICTION * ARM / 0.02).abs() < 1e-3);
    assert!((found.weakest.torque[0].abs() - 0.02).abs() < 1e-3, "{:?}", found.weakest);
    let total = quality(&pinch(), 0.02, 0).unwrap();
    assert!(total.found < found.found && total.certified > 0.0);
    // Two points do not keep it from turning about their line.
    let points = pinch().map(|finger| ft_finger { torque_arm: 0.0, ..finger });
    let found = quality(&points, 0.02, 1).unwrap();
    assert_eq!((found.rank, found.force_closure, found.found), (5, 0, 0.0));
    let turning = Vector3::from(found.freedom_turning[0]);
    assert!((turning.x.abs() / turning.norm() - 1.0).abs() < 1e-9 && turning.norm() > 0.0);
    assert!(Vector3::from(found.freedom_velocity[0]).norm() < 1e-9 * turning.norm());
    assert_eq!(found.freedom_turning[1], [0.0; 3]);
    for (length, each) in [(0.0, 0), (f64::NAN, 0), (-1.0, 1), (1.0, 2)] {
        assert_eq!(quality(&pinch(), length, each).unwrap_err(), ft_status::FT_BAD_NUMBER);
    }
    let mut error = core::mem::MaybeUninit::<ft_error>::uninit();
    let mut to = core::mem::MaybeUninit::<ft_quality>::uninit();
    let fingers = pinch();
    let status =
        unsafe { ft_grasp_quality(fingers.as_ptr(), 2, 0.0, 0, to.as_mut_ptr(), error.as_mut_ptr()) };
    assert_eq!(status, ft_status::FT_BAD_NUMBER);
    assert!(said(&unsafe { error.assume_init() }).contains("`length` must be positive"));
}

/// A covariance with entries off the diagonal, so that rows and columns are told apart.
fn noise() -> Matrix6<f64> {
    let mut root = Matrix6::from_diagonal(&[0.01, 0.01, 0.02, 1e-4, 1e-4, 2e-4].into());
    root[(4, 0)] = 5e-5;
    root[(1, 0)] = 4e-3;
    root * root.transpose()
}

fn felt(wrench: Wrench<f64, Hand>) -> ft_uncertain_wrench {
    let (force, torque) = (wrench.force().into(), wrench.torque().into());
    ft_uncertain_wrench { wrench: ft_wrench { force, torque }, covariance: noise().transpose().into() }
}

#[test]
fn an_object_is_weighed_and_what_touches_it_is_found() {
    let hand = Held::new(FREE);
    let object = || -> ft_object { written(|to| unsafe { ft_hand_object(hand.0, to) }).unwrap() };
    let other = |load: &ft_uncertain_wrench, gravity: &[f64; 3], alarm: f64| -> Result<ft_other, ft_status> {
        written(|to| unsafe { ft_hand_other(hand.0, load, gravity.as_ptr(), alarm, to) })
    };
    assert_eq!((object().has_mass, object().has_centre), (0, 0));
    let (mass, centre) = (0.2, Vector3::new(0.01, 0.0, 0.02));
    let weight = |gravity: Vector3<f64>| Wrench::<f64, Hand>::from_force_at(&centre, gravity * mass);
    let (down, aside) = (Vector3::new(0.0, 0.0, -9.81), Vector3::new(-9.81, 0.0, 0.0));
    let mut same = ObjectWeight::<f64>::new();
    for (count, gravity) in [down, aside].into_iter().enumerate() {
        assert_eq!(other(&felt(weight(down)), &down.into(), 1e-3).unwrap().is_known, 0);
        let load = felt(weight(gravity));
        assert_eq!(unsafe { ft_hand_weigh(hand.0, &load, gravity.as_slice().as_ptr()) }, ft_status::FT_OK);
        same.observe(&UncertainWrench { wrench: weight(gravity), covariance: noise() }, &gravity);
        let found = object();
        assert_eq!((found.has_mass, found.has_centre), (1, u32::from(count == 1)));
        let (expected, deviation) = same.mass().unwrap();
        assert!((found.mass - mass).abs() < 1e-9 && (expected - mass).abs() < 1e-9);
        assert_eq!(found.mass_deviation, deviation);
    }
    let (found, estimate) = (object(), same.estimate().unwrap());
    assert!((Vector3::from(found.centre) - centre).norm() < 1e-9);
    assert_eq!(found.centre_covariance[0][0], estimate.centre_covariance.m11);
    assert_eq!(found.centre_covariance[0][1], estimate.centre_covariance.m12);

    // Nothing; then a table under it; then a wrench that also twists.
    let nothing = other(&felt(weight(down)), &down.into(), 1e-3).unwrap();
    assert_eq!((nothing.is_known, nothing.touches), (1, 0));
    let (place, push) = (Vector3::new(0.02, 0.01, -0.05), Vector3::new(0.0, 0.0, 0.981));
    let table = Wrench::from_force_at(&place, push);
    let twist = Wrench::on_fingertip(Vector3::zeros(), push * 0.004);
    for (more, pitch) in [(table, 0.0), (table + twist, 0.004)] {
        let told = other(&felt(weight(down) + more), &down.into(), 1e-3).unwrap();
        assert_eq!((told.is_known, told.touches, told.has_line), (1, 1, 1));
        assert!((Vector3::from(told.load.wrench.force) - push).norm() < 1e-9);
        assert!((told.pitch - pitch).abs() < 1e-9, "{}", told.pitch);
        assert!((Vector3::from(told.point) - Vector3::new(0.02, 0.01, 0.0)).norm() < 1e-9);
        assert!((Vector3::from(told.direction) - Vector3::z()).norm() < 1e-9);
        let load = UncertainWrench { wrench: weight(down) + more, covariance: noise() };
        let expected = OtherContact::new(&load, &same, &down).unwrap();
        assert_eq!(told.statistic, expected.statistic);
        assert_eq!(told.load.covariance[4][0], expected.load.covariance[(4, 0)]);
    }
    let bent = ft_uncertain_wrench { covariance: [[1.0; 6]; 6], ..felt(weight(down)) };
    assert_eq!(unsafe { ft_hand_weigh(hand.0, &bent, down.as_slice().as_ptr()) }, ft_status::FT_BAD_NUMBER);
    assert!(hand.says().contains("positive definite"), "{}", hand.says());
    for alarm in [0.0, 1.0, f64::NAN] {
        assert_eq!(other(&felt(weight(down)), &down.into(), alarm).unwrap_err(), ft_status::FT_BAD_NUMBER);
    }
    assert_eq!(object().mass, found.mass);
    assert_eq!(unsafe { ft_hand_forget(hand.0) }, ft_status::FT_OK);
    assert_eq!(object().has_mass, 0);
}
