//! Loads that can be held, but not with the factor of safety.

use fingertip_friction::SlipVerdict;
use fingertip_hand::{
    FingerLimits, FingerSample, FingerState, Grasp, GraspContact, GripOutcome, Hand, HandCommand,
    HandController, HandLoad, HandSettings, HandState, LeastGrip,
};
use fingertip_wrench::{ContactForce, Frame, Wrench};
use nalgebra::{Vector3, Vector6};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use crate::support::clarabel_oracle::{self, Oracle};
use crate::support::{TestHand, problem};

const STEP: f64 = 1e-3;

/// Commands reach what is wanted in one sample.
fn at_once(safety: f64) -> HandSettings<f64> {
    HandSettings { safety, rise: 1e9, fall: 1e9, ..HandSettings::default() }
}

fn touching<F: Frame>(contact: GraspContact<f64, F>) -> FingerState<f64, F> {
    let force = ContactForce::new(1.0, Vector3::zeros(), 0.0);
    FingerState::Touching(FingerSample { contact, force, slip: SlipVerdict::Holding })
}

/// Two fingers that face each other.
fn pinch(friction: f64) -> [FingerState<f64>; 2] {
    [-1.0, 1.0].map(|side| {
        let (at, inward) = (Vector3::x() * (0.02 * side), -Vector3::x() * side);
        touching(GraspContact::<f64, Hand>::soft(at, inward, friction, 3e-3).unwrap())
    })
}

fn down(newtons: f64) -> HandLoad<f64> {
    HandLoad::Known(Wrench::on_fingertip(-Vector3::z() * newtons, Vector3::zeros()))
}

fn limited(greatest: f64) -> FingerLimits<f64, 2> {
    FingerLimits::none().with_least_normal(0.3).unwrap().with_greatest_normal(greatest).unwrap()
}

/// 10.7 N of each finger hold 200 g, 13.9 N would with the factor of safety, and 12 N are all there is: the commands rise
/// from 0.3 N to 12 N by the rate, and stay there.
#[test]
fn what_can_be_held_is_held_where_limits_leave_no_room_for_safety() {
    let settings = HandSettings::default();
    let mut hand = HandController::new(settings, [limited(12.0); 2]).unwrap();
    let fingers = pinch(0.98 / 10.7);
    for step in 1..=100 {
        let found = hand.command(&fingers, &down(1.96), STEP);
        assert_eq!(found.state, HandState::WithoutSafety);
        let expected = (0.3 + settings.rise * STEP * f64::from(step)).min(12.0);
        assert!(found.normal.iter().all(|normal| (normal - expected).abs() < 1e-6), "{found:?}");
    }
    // Where less is asked for, it falls by its rate, and has its safety back.
    let found = hand.command(&fingers, &down(1.5), STEP);
    assert_eq!(found.state, HandState::Holding);
    assert!((found.normal[0] - 12.0 + settings.fall * STEP).abs() < 1e-6);
    // More than the fingers can give without safety: as before, and the motion is that of the load.
    let (before, found) = (hand.present(), hand.command(&fingers, &down(2.3), STEP));
    assert_eq!(found.normal, before);
    assert!(matches!(found.state, HandState::CannotHold(why) if why.velocity.z < 0.0));
}

/// As the load grows the wanted forces grow with it, times the factor of safety, up to the limit, and then stay: with no step
/// down where the safety is lost. Without that factor there is nothing to lose.
#[test]
fn a_growing_load_never_loosens_the_grip() {
    let greatest = 9.0;
    for safety in [1.0, 1.3, 2.0] {
        let mut hand = HandController::new(at_once(safety), [limited(greatest); 2]).unwrap();
        let mut states = [0; 3];
        for tenths in 1..130 {
            let least = 0.1 * f64::from(tenths) + 1e-3;
            let before = hand.present()[0];
            let found = hand.command(&pinch(0.5), &down(least), STEP);
            let given_up = matches!(found.state, HandState::CannotHold(_));
            let expected = if given_up { before } else { (least * safety).clamp(0.3, greatest) };
            assert_eq!(given_up, least > greatest);
            assert!((found.normal[0] - expected).abs() < 1e-5, "{safety} {least}: {found:?}");
            assert!((found.normal[1] - expected).abs() < 1e-5, "{safety} {least}: {found:?}");
            let state = match found.state {
                HandState::Holding => 0,
                HandState::WithoutSafety => 1,
                HandState::CannotHold(_) => 2,
                other => panic!("{other:?}"),
            };
            assert!(states[state + 1..].iter().all(|count| *count == 0));
            states[state] += 1;
        }
        assert_eq!(states[1] > 0, safety > 1.0, "{states:?}");
        assert!(states[0] > 0 && states[2] > 0);
    }
}

/// Two faces that are inclined by more than the friction with safety holds, and by less than there is: no force would do
/// with safety. The grip is firm, and far from the limits.
#[test]
fn inclined_faces_are_held_with_the_friction_that_there_is() {
    let contact = |side: f64| {
        let inward = Vector3::new(-side, 0.0, -0.44).normalize();
        GraspContact::<f64, Hand>::soft(Vector3::x() * (0.02 * side), inward, 0.5, 3e-3).unwrap()
    };
    let contacts = [contact(-1.0), contact(1.0)];
    let Oracle::Held { cost, .. } = clarabel_oracle::solve(
        &Grasp::new(contacts.map(|contact| Some(contact.expressed_in(&to_tests())))),
        &[limited(100.0); 2],
        &Wrench::on_fingertip(-Vector3::z(), Vector3::zeros()),
    ) else {
        panic!()
    };
    let mut hand = HandController::new(at_once(1.3), [limited(100.0); 2]).unwrap();
    let found = hand.command(&contacts.map(touching), &down(1.0), STEP);
    assert_eq!(found.state, HandState::WithoutSafety);
    let sum = found.normal[0] + found.normal[1];
    assert!(sum > cost * (1.0 - 1e-6) && sum < 1.4 * cost, "{sum} {cost}");
}

fn to_tests() -> fingertip_wrench::RigidTransform<f64, TestHand, Hand> {
    fingertip_wrench::RigidTransform::identity()
}

/// Whether contact forces with these normal forces hold the load within friction.
fn holds<const N: usize>(
    grasp: &Grasp<f64, N, TestHand>,
    normal: &[f64; N],
    load: &Wrench<f64, TestHand>,
) -> bool {
    let size = normal.iter().fold(0.0, |a: f64, b| a.max(*b));
    let just = normal.map(|normal| {
        let (least, greatest) = (normal - 1e-6 * size, normal + 1e-6 * size);
        let limits = FingerLimits::<f64, 2>::none().with_greatest_normal(greatest).unwrap();
        limits.with_least_normal(least).unwrap_or(limits)
    });
    let found = LeastGrip::new().solve(grasp, &just, load);
    matches!(found, GripOutcome::Held(_))
        || matches!(clarabel_oracle::solve(grasp, &just, load), Oracle::Held { .. })
}

/// On random grasps with limits, against another's solver: what can be held with safety is, else what can be held without it
/// is held so, and only what cannot be held at all is said to be that. What is commanded without safety holds, within limits,
/// from wherever the controller starts.
#[test]
fn whatever_can_be_held_is_never_given_up() {
    let mut rng = Pcg64Mcg::seed_from_u64(2501);
    let mut counts = [0; 3];
    for index in 0..1_500 {
        let problem = problem::<5>(&mut rng);
        let safety = rng.random_range(1.05..2.0);
        let settings = at_once(safety);
        let with = |safety: f64| {
            let contacts = problem.grasp.contacts();
            Grasp::new(contacts.map(|contact| contact.map(|contact| contact.with_safety(safety).unwrap())))
        };
        let oracle = |safety| clarabel_oracle::solve(&with(safety), &problem.limits, &problem.load);
        let fingers = problem.grasp.contacts().map(|contact| contact.map_or(FingerState::Free, touching));
        let ask = |hand: &mut HandController<f64, 5, 2>, times: f64| {
            hand.command(&fingers, &HandLoad::Known(problem.load * times), STEP)
        };
        let mut hand = HandController::new(settings, problem.limits).unwrap();
        let found: HandCommand<f64, 5, TestHand> = ask(&mut hand, 1.0);
        let at = format!("{index}: {:?}", found.state);
        match (found.state, oracle(safety), oracle(1.0)) {
            (HandState::Holding, Oracle::Held { .. }, _) => counts[0] += 1,
            (HandState::WithoutSafety, Oracle::CannotHold { .. }, Oracle::Held { cost, .. }) => {
                counts[1] += 1;
                let each = found.normal.iter().zip(problem.grasp.contacts()).zip(&problem.limits);
                let mut total = 0.0;
                for ((normal, contact), limits) in each {
                    assert!(limits.greatest_normal().is_none_or(|most| *normal <= most), "{at}");
                    if contact.is_some() {
                        assert!(limits.least_normal().is_none_or(|least| *normal >= least - 1e-6), "{at}");
                        total += limits.cost() * normal;
                    }
                }
                assert!(total > cost * (1.0 - 1e-6), "{at}: {total} {cost}");
                assert!(holds(&problem.grasp, &found.normal, &problem.load), "{at}");
                // Once more, and after another load.
                for other in [1.0, 0.7] {
                    ask(&mut hand, other);
                    let again = ask(&mut hand, 1.0);
                    assert_eq!(again.state, HandState::WithoutSafety, "{at}");
                    assert!(holds(&problem.grasp, &again.normal, &problem.load), "{at}: {again:?}");
                }
            }
            (HandState::CannotHold(why), _, Oracle::CannotHold { .. }) => {
                counts[2] += 1;
                assert_eq!(found.normal, problem.limits.map(|limits| limits.least_normal().unwrap_or(0.0)));
                assert!(why.excess > 0.0, "{at}");
            }
            (_, Oracle::Unclear, _) | (_, _, Oracle::Unclear) => {}
            (_, careful, all) => panic!("{at}, but {careful:?} with safety and {all:?} without"),
        }
    }
    println!("{counts:?}");
    assert!(counts.iter().all(|count| *count > 50), "{counts:?}");
}

/// What has forgotten the object is as new, where no command could move meanwhile.
#[test]
fn what_is_held_without_safety_is_forgotten_with_the_object() {
    let settings = HandSettings { rise: 1e-300, fall: 1e-300, ..HandSettings::default() };
    let new = HandController::new(settings, [limited(12.0); 2]).unwrap();
    let mut hand = new;
    assert_eq!(hand.command(&pinch(0.98 / 10.7), &down(1.96), STEP).state, HandState::WithoutSafety);
    assert!(hand != new);
    hand.forget_friction();
    assert_eq!(hand, new);
}

/// Either grip starts from the last one of its kind: to ask again changes what the next one starts from. What has its safety
/// again is as if it had never lost it.
#[test]
fn each_grip_starts_from_the_last_of_its_kind() {
    let settings = HandSettings { rise: 1e-300, fall: 1e-300, ..HandSettings::default() };
    let after = |loads: &[f64]| {
        let mut hand = HandController::new(settings, [limited(6.5); 2]).unwrap();
        loads.iter().for_each(|load| _ = hand.command(&pinch(0.5), &down(*load), STEP));
        hand
    };
    for load in [4.0, 5.2] {
        assert_ne!(after(&[load, load]), after(&[load]), "{load}");
    }
    assert_eq!(after(&[5.2, 4.0]), after(&[4.0]));
    assert_eq!(after(&[4.0, 5.2]), after(&[5.2]));
}

/// What was pressed before is more than the fingers may give now, as of joints that have turned: it is left at once, and not
/// by the rate at which a grip falls.
#[test]
fn limits_that_shrink_are_kept_at_once() {
    let mut hand = HandController::new(HandSettings::default(), [limited(12.0); 2]).unwrap();
    for _ in 0..100 {
        hand.command(&pinch(0.5), &down(8.0), STEP);
    }
    assert!(hand.present().iter().all(|normal| (normal - 1.3 * 8.0).abs() < 1e-5));
    for greatest in [9.0, 7.0] {
        hand.set_limits([limited(greatest); 2]);
        let found = hand.command(&pinch(0.5), &down(5.0), STEP);
        assert_eq!((found.state, found.normal), (HandState::Holding, [greatest; 2]));
    }
}

/// A joint that gives no more than the grip without safety needs is not asked for more.
#[test]
fn joints_give_no_more_than_they_can() {
    // A linear drive along x, behind the right finger: as a limit of its normal force.
    let along = Vector6::new(1.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    let limits = FingerLimits::<f64, 4>::none().with_least_normal(0.3).unwrap();
    let mut hand =
        HandController::new(at_once(1.5), [limits, limits.with_joint(&along, 2.4).unwrap()]).unwrap();
    for (load, expected, safe) in [(1.0, 1.5, true), (1.8, 2.4, false), (2.2, 2.4, false), (1.5, 2.25, true)]
    {
        let found = hand.command(&pinch(0.5), &down(load), STEP);
        assert_eq!(found.state, if safe { HandState::Holding } else { HandState::WithoutSafety });
        assert!(found.normal.iter().all(|normal| (normal - expected).abs() < 1e-5), "{found:?}");
    }
}

/// A load that goes back and forth over the edge of what can be held with safety: commands change by no more than the load
/// does, whatever the state was before, and are those of a controller that begins with it.
#[test]
fn nothing_chatters_at_the_edge_of_safety() {
    let mut rng = Pcg64Mcg::seed_from_u64(2502);
    let mut hand = HandController::new(at_once(1.3), [limited(6.5); 2]).unwrap();
    let mut seen = [0; 2];
    for _ in 0..500 {
        let load = 5.0 * rng.random_range(0.99..1.01);
        let found = hand.command(&pinch(0.5), &down(load), STEP);
        let mut new = HandController::new(at_once(1.3), [limited(6.5); 2]).unwrap();
        let cold = new.command(&pinch(0.5), &down(load), STEP);
        assert_eq!(found.state, cold.state);
        assert!((found.normal[0] - (1.3 * load).min(6.5)).abs() < 1e-5, "{found:?}");
        assert!((found.normal[0] - cold.normal[0]).abs() < 1e-5, "{found:?} {cold:?}");
        seen[usize::from(found.state == HandState::WithoutSafety)] += 1;
    }
    assert!(seen.iter().all(|count| *count > 100), "{seen:?}");
}
