//! Limits of joints, against another's solver and by what a joint feels.

use fingertip_hand::{BadLimit, FingerLimits, Grasp, GraspContact, GripOutcome, LeastGrip, Reach};
use fingertip_wrench::Wrench;
use nalgebra::{SMatrix, Vector3, Vector6};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use crate::support::clarabel_oracle::{self, Joint, Oracle};
use crate::support::{Problem, TestHand, problem, vector};

/// Limits of normal forces and of two joints for each finger, whose axes run near the contacts.
struct Jointed {
    limits: [FingerLimits<f64, 6>; 4],
    joints: [Vec<Joint>; 4],
}

fn jointed(rng: &mut Pcg64Mcg, grasp: &Grasp<f64, 4, TestHand>, of: &[FingerLimits<f64, 2>; 4]) -> Jointed {
    let mut limits = [FingerLimits::none(); 4];
    let mut joints = [const { Vec::new() }; 4];
    for (i, (limits, joints)) in limits.iter_mut().zip(&mut joints).enumerate() {
        let (Some(contact), given) = (grasp.contacts()[i], of[i]) else { continue };
        *limits = limits.with_cost(given.cost()).unwrap();
        let mut jacobian = SMatrix::<f64, 6, 2>::zeros();
        let mut torques = [0.0; 2];
        for (j, torque) in torques.iter_mut().enumerate() {
            // A hinge at a place: the velocity of the origin is that of a body that turns about it.
            let (axis, place) = (vector(rng).normalize(), contact.place() + vector(rng) * 0.06);
            let velocity = place.cross(&axis);
            let column = Vector6::from_iterator(velocity.iter().chain(axis.iter()).copied());
            jacobian.set_column(j, &column);
            *torque = rng.random_range(0.03..1.0);
            joints.push((column, *torque));
        }
        *limits = limits.with_joint_torques(&jacobian, &torques).unwrap();
        if let Some(least) = given.least_normal() {
            *limits = limits.with_least_normal(least).unwrap();
        }
        if let Some(greatest) = given.greatest_normal() {
            *limits = limits.with_greatest_normal(greatest).unwrap();
        }
    }
    Jointed { limits, joints }
}

/// The cost is that of the oracle, no joint is asked for more than it gives, and the same grip is refused and held.
#[test]
fn limits_of_joints_agree_with_clarabel() {
    let mut rng = Pcg64Mcg::seed_from_u64(41);
    let (mut held, mut not, mut at_limit) = (0, 0, 0);
    for index in 0..900 {
        let Problem { grasp, limits, load } = problem::<4>(&mut rng);
        let Jointed { limits, joints } = jointed(&mut rng, &grasp, &limits);
        let ours = LeastGrip::new().solve(&grasp, &limits, &load);
        match (&ours, clarabel_oracle::solve_with_joints(&grasp, &limits, &joints, &load)) {
            (GripOutcome::Held(grip), Oracle::Held { cost, .. }) => {
                held += 1;
                assert!((grip.cost / cost - 1.0).abs() < 1e-6, "{index}: {} {cost}", grip.cost);
                assert!(grip.gap() < 1e-6 && grip.steps <= 20, "{index}: {grip:?}");
                for ((contact, force), joints) in grasp.contacts().iter().zip(&grip.forces).zip(&joints) {
                    let Some(contact) = contact else { continue };
                    for (column, greatest) in joints {
                        let torque = contact.wrench(force).components().dot(column).abs();
                        let slack = 1e-6 * (greatest + grip.cost * grasp.length());
                        assert!(torque <= greatest + slack, "{index}: {torque} {greatest}");
                        at_limit += u32::from(torque > greatest * 0.99);
                    }
                }
            }
            (GripOutcome::CannotHold(why), Oracle::CannotHold { .. }) => {
                not += 1;
                assert!(why.excess > 0.0 && why.steps <= 20, "{index}: {why:?}");
            }
            (_, Oracle::Unclear) => {}
            (ours, oracle) => panic!("{index}: {ours:?}, but {oracle:?}"),
        }
    }
    println!("{held} {not} {at_limit}");
    assert!(held > 150 && not > 150 && at_limit > 15, "{held} {not} {at_limit}");
}

/// From nothing, with nothing but joints to limit it, by formula: two drives of 10 N with friction 0.5 carry 10 N.
#[test]
fn joints_alone_limit_the_reach() {
    let at = |side: f64| {
        GraspContact::<f64, TestHand>::point(Vector3::x() * (side * 0.02), -Vector3::x() * side, 0.5)
    };
    let grasp = Grasp::new([at(-1.0).ok(), at(1.0).ok()]);
    let mut jacobian = SMatrix::<f64, 6, 1>::zeros();
    jacobian[0] = 1.0;
    let limits = [FingerLimits::<f64, 2>::none().with_joint_torques(&jacobian, &[10.0]).unwrap(); 2];
    for newtons in [1e-6, 1.0, 1e6] {
        let down = Wrench::on_fingertip(-Vector3::z() * newtons, Vector3::zeros());
        let Reach::Times(times) = grasp.reach(&limits, &Wrench::zero(), &down) else { panic!("{newtons}") };
        assert!((times * newtons - 10.0).abs() < 1e-5, "{newtons}: {times}");
    }
}

/// Room for more limits than there are changes no bit.
#[test]
fn room_for_more_limits_changes_nothing() {
    let mut rng = Pcg64Mcg::seed_from_u64(17);
    let (mut tight, mut roomy) = (LeastGrip::new(), LeastGrip::new());
    let mut held = 0;
    for _ in 0..200 {
        let Problem { grasp, limits, load } = problem::<4>(&mut rng);
        let wide = limits.map(|limits| {
            let mut wide = FingerLimits::<f64, 14>::none().with_cost(limits.cost()).unwrap();
            if let Some(greatest) = limits.greatest_normal() {
                wide = wide.with_greatest_normal(greatest).unwrap();
            }
            if let Some(least) = limits.least_normal() {
                wide = wide.with_least_normal(least).unwrap();
            }
            wide
        });
        let (first, second) = (tight.solve(&grasp, &limits, &load), roomy.solve(&grasp, &wide, &load));
        assert_eq!(first, second);
        held += u32::from(first.grip().is_some());
        let push = Wrench::from_force_at(&grasp.centre(), load.force());
        assert_eq!(grasp.reach(&limits, &load, &push), grasp.reach(&wide, &load, &push));
    }
    assert!(held > 50, "{held}");
}

/// Joints that feel nothing of a finger, or little beside what they give, limit nothing; so do normal forces far above.
#[test]
fn limits_that_do_not_matter_change_nothing() {
    let at = |side: f64| {
        GraspContact::<f64, TestHand>::point(Vector3::x() * (side * 0.02), -Vector3::x() * side, 0.5)
    };
    let grasp = Grasp::new([at(-1.0).ok(), at(1.0).ok()]);
    let down = Wrench::on_fingertip(-Vector3::z() * 2.0, Vector3::zeros());
    // The first turns a finger about the line of the contacts, so that it feels nothing; the second by rounding alone.
    let turning = Vector6::new(0.0, 0.0, 0.0, 1.0, 0.0, 0.0);
    let rounding = Vector6::new(1e-18, 0.0, 0.0, 1.0, 0.0, 0.0);
    let hinge = Vector6::new(0.08, 0.0, 0.0, 0.0, 1.0, 0.0);
    for power in -3..=12 {
        let much = 10.0_f64.powi(power);
        let none = FingerLimits::<f64, 5>::none();
        let mut all =
            vec![none.with_joint(&turning, much).unwrap(), none.with_joint(&rounding, much).unwrap()];
        if power >= 0 {
            all.push(none.with_joint(&hinge, much).unwrap());
            all.push(none.with_joint(&hinge, much).unwrap().with_joint(&turning, much).unwrap());
            all.push(none.with_greatest_normal(3.0 * much).unwrap());
        }
        for limits in all {
            let outcome = LeastGrip::new().solve(&grasp, &[limits; 2], &down);
            let grip = outcome.grip().unwrap_or_else(|| panic!("{power}: {limits:?}: {outcome:?}"));
            assert!((grip.cost - 4.0).abs() < 4e-6 && grip.steps <= 25, "{power}: {limits:?}: {grip:?}");
        }
    }
}

/// A finger without room for any limit says that a joint needs two rows.
#[test]
fn no_room_at_all_is_said() {
    let joint = FingerLimits::<f64, 0>::none().with_joint(&Vector6::x(), 1.0);
    assert_eq!(joint, Err(BadLimit::NoRoom { room: 0, needed: 2 }));
}
