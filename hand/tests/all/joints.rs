//! Limits of joints, against another's solver and by what a joint feels.

use fingertip_hand::{FingerLimits, Grasp, GraspContact, GripOutcome, LeastGrip, Reach};
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
