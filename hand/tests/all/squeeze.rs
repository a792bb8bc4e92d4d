//! How far a grip is squeezed that holds without the factor of safety only.

use fingertip_friction::SlipVerdict;
use fingertip_hand::{
    FingerLimits, FingerSample, FingerState, Grasp, GraspContact, GripOutcome, HandController, HandLoad,
    HandSettings, HandState, LeastGrip,
};
use fingertip_wrench::{ContactForce, Wrench};
use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use crate::support::{TestHand, problem};

const STEP: f64 = 1e-3;

/// Commands reach what is wanted in one sample.
fn at_once(safety: f64) -> HandSettings<f64> {
    HandSettings { safety, rise: 1e9, fall: 1e9, ..HandSettings::default() }
}

fn touching(contact: GraspContact<f64, TestHand>) -> FingerState<f64, TestHand> {
    let force = ContactForce::new(1.0, Vector3::zeros(), 0.0);
    FingerState::Touching(FingerSample { contact, force, slip: SlipVerdict::Holding })
}

/// On random grasps: the least forces without safety and so many times their internal part as limits leave room for, up to the
/// factor of safety; all of that where no contact slips then, by the margins of slip, and else none of it.
#[test]
fn a_grip_without_safety_is_squeezed_as_far_as_limits_and_friction_allow() {
    let mut rng = Pcg64Mcg::seed_from_u64(2503);
    let (mut by_limits, mut by_safety, mut by_friction) = (0, 0, 0);
    for index in 0..4_000 {
        let problem = problem::<5>(&mut rng);
        let safety = rng.random_range(1.05..4.0);
        let fingers = problem.grasp.contacts().map(|contact| contact.map_or(FingerState::Free, touching));
        let mut hand = HandController::new(at_once(safety), problem.limits).unwrap();
        let found = hand.command(&fingers, &HandLoad::Known(problem.load), STEP);
        if found.state != HandState::WithoutSafety {
            continue;
        }
        let outcome = LeastGrip::new().solve(&problem.grasp, &problem.limits, &problem.load);
        let GripOutcome::Held(grip) = outcome else { panic!("{outcome:?}") };
        let more = problem.grasp.split(&grip.forces).internal;
        let mut times = safety - 1.0;
        for ((force, more), limits) in grip.forces.iter().zip(&more).zip(&problem.limits) {
            let end = if more.normal > 0.0 { limits.greatest_normal() } else { limits.least_normal() };
            if let Some(end) = end.filter(|_| more.normal != 0.0) {
                times = times.min(((end - force.normal) / more.normal).max(0.0));
            }
        }
        let mut squeezed = grip.forces;
        for (force, more) in squeezed.iter_mut().zip(&more) {
            let tangential = force.tangential.vector() + more.tangential.vector() * times;
            *force = ContactForce::new(
                force.normal + more.normal * times,
                tangential,
                force.spin + more.spin * times,
            );
        }
        let margins = problem.grasp.slip_margins(&squeezed);
        let worst = margins.iter().flatten().map(|margin| margin.utilisation).fold(0.0, f64::max);
        // Where one just slips, rounding may have it either way.
        if (worst - 1.0).abs() < 1e-6 {
            continue;
        }
        let expected = if worst < 1.0 { squeezed } else { grip.forces };
        match (worst < 1.0, times < safety - 1.0) {
            (false, _) => by_friction += 1,
            (true, true) => by_limits += 1,
            (true, false) => by_safety += 1,
        }
        let size = grip.forces.iter().fold(0.0, |a: f64, b| a.max(b.normal));
        for (finger, (normal, expected)) in found.normal.iter().zip(&expected).enumerate() {
            if problem.grasp.contacts()[finger].is_some() {
                let off = (normal - expected.normal).abs();
                assert!(
                    off < 1e-9 * size,
                    "{index}, {finger}: {normal} for {expected:?}, {times} of {safety}"
                );
            }
        }
    }
    println!("{by_limits} by limits, {by_safety} by the factor of safety, {by_friction} by friction");
    assert!(by_limits > 20 && by_safety > 20 && by_friction > 20);
}

/// With a factor of one the grip is that of the solver alone, from sample to sample, and so is the reason why there is none.
#[test]
fn a_factor_of_one_asks_for_one_grip() {
    let limits = FingerLimits::<f64, 2>::none().with_least_normal(0.3).unwrap();
    let limits = [limits.with_greatest_normal(9.0).unwrap(); 2];
    let contacts = [-1.0, 1.0].map(|side| {
        let (at, inward) = (Vector3::x() * (0.02 * side), -Vector3::x() * side);
        GraspContact::<f64, TestHand>::soft(at, inward, 0.5, 3e-3).unwrap()
    });
    let (grasp, fingers) = (Grasp::new(contacts.map(Some)), contacts.map(touching));
    let mut hand = HandController::new(at_once(1.0), limits).unwrap();
    let mut least = LeastGrip::new();
    let mut given_up = 0;
    for newtons in [5.0, 8.0, 8.9, 9.4, 8.9, 9.4, 11.0, 6.0, 14.0] {
        let load = Wrench::on_fingertip(-Vector3::z() * newtons, Vector3::zeros());
        let before = hand.present();
        let found = hand.command(&fingers, &HandLoad::Known(load), STEP);
        let (state, normal) = match least.solve(&grasp, &limits, &load) {
            GripOutcome::Held(grip) => (HandState::Holding, grip.forces.map(|force| force.normal)),
            GripOutcome::CannotHold(why) => (HandState::CannotHold(why), before),
            other => panic!("{other:?}"),
        };
        given_up += u32::from(matches!(state, HandState::CannotHold(_)));
        assert_eq!((found.state, found.normal), (state, normal), "{newtons}");
    }
    assert_eq!(given_up, 4);
}
