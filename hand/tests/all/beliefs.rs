//! Which friction is relied on at a finger, by what its samples have taught.

use fingertip_friction::{ForceNoise, SlipVerdict};
use fingertip_hand::{
    FingerLimits, FingerSample, FingerState, FrictionBelief, GraspContact, Hand, HandController, HandLoad,
    HandSettings, LearntFriction, SlipFactor,
};
use fingertip_wrench::{ContactForce, Wrench};
use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use SlipVerdict::{Holding, Slipping};

const STEP: f64 = 1e-3;

fn settings() -> HandSettings<f64> {
    HandSettings::default()
}

fn learning() -> LearntFriction<f64> {
    LearntFriction::new(ForceNoise::isotropic(0.01).unwrap(), 0.05, 0.01).unwrap()
}

fn at_ratio(ratio: f64) -> ContactForce<f64> {
    ContactForce::new(2.0, Vector3::x() * (2.0 * ratio), 0.0)
}

/// Slides along a surface of this friction: the ratio rises, peaks where it slips, and falls.
fn slide(
    belief: &mut impl FrictionBelief<f64>,
    known: f64,
    friction: f64,
    settings: &HandSettings<f64>,
) -> f64 {
    for step in 0..100 {
        let ratio = friction * f64::from(step) / 100.0;
        belief.rely(known, &at_ratio(ratio), Holding, STEP, settings);
    }
    belief.rely(known, &at_ratio(friction), Slipping, STEP, settings)
}

#[test]
fn a_factor_goes_back_to_one_with_its_rate_and_not_by_itself() {
    for recovery in [0.0, 0.5, 20.0] {
        let settings = HandSettings { recovery, ..settings() };
        let mut belief = SlipFactor::default();
        assert_eq!(belief.rely(0.5, &at_ratio(0.1), Slipping, STEP, &settings), 0.4);
        for step in 1..=1000 {
            let found = belief.rely(0.5, &at_ratio(0.1), Holding, STEP, &settings);
            let expected = 0.5 * (1.0 - 0.2 * (-recovery * STEP * f64::from(step)).exp());
            // Sample by sample instead of continuously.
            let coarse = 0.5 * recovery * STEP * 0.1;
            assert!((found - expected).abs() <= coarse + 1e-13, "{recovery}: {found} {expected}");
        }
        // However long it was, it is one and no more.
        let last = belief.rely(0.5, &at_ratio(0.1), Holding, 1e9, &settings);
        assert!((last - if recovery > 0.0 { 0.5 } else { 0.4 }).abs() < 1e-15);
        belief.forget();
        assert_eq!(belief, SlipFactor::default());
    }
}

/// Of any friction, thought less or more: what is relied on is below it, by the scatter and noise that are stated.
#[test]
fn a_slip_teaches_the_friction_whatever_was_known() {
    let mut rng = Pcg64Mcg::seed_from_u64(71);
    for index in 0..200 {
        let (friction, known) = (rng.random_range(0.2..1.5), rng.random_range(0.15..2.0));
        let mut belief = learning();
        let found = slide(&mut belief, known, friction, &settings());
        assert!((0.8 * friction..friction).contains(&found), "{index}: {found} of {friction}");
        let estimate = belief.estimate().unwrap();
        assert!((estimate.coefficient / friction - 1.0).abs() < 0.03, "{index}: {estimate:?}");
        assert_eq!(found, estimate.quantile(0.01));
        // It stays relied on, and what is known beforehand has no say any more.
        for known in [0.01, 10.0] {
            assert_eq!(belief.rely(known, &at_ratio(0.05), Holding, STEP, &settings()), found);
        }
        belief.forget();
        assert!(belief.estimate().is_none());
        assert_eq!(belief.rely(known, &at_ratio(0.05), Holding, STEP, &settings()), known.min(3.0));
    }
}

/// Too soon after the contact nothing is measured: friction is less, by the factor.
#[test]
fn a_slip_that_tells_nothing_counts_by_the_factor() {
    let mut belief = learning();
    assert_eq!(belief.rely(0.5, &ContactForce::zero(), Slipping, STEP, &settings()), 0.4);
    assert!(belief.estimate().is_none());
    // One that goes on is one slip.
    assert_eq!(belief.rely(0.5, &ContactForce::zero(), Slipping, STEP, &settings()), 0.4);
}

/// A slip that goes on is measured again once its 64 samples are all of it: as often as they are, and not before.
#[test]
fn a_slip_that_goes_on_is_measured_anew() {
    let mut belief = learning();
    let first = slide(&mut belief, 0.5, 0.6, &settings());
    let mut before = first;
    for friction in [0.3, 0.45, 0.2] {
        for sample in 0..64 {
            let found = belief.rely(0.5, &at_ratio(friction), Slipping, STEP, &settings());
            assert_eq!(found, before, "{friction}: {sample}");
        }
        let found = belief.rely(0.5, &at_ratio(friction), Slipping, STEP, &settings());
        assert!((0.8 * friction..friction).contains(&found), "{friction}: {found}");
        before = found;
    }
    // Once it holds, the next slip is one of its own.
    assert_eq!(slide(&mut belief, 0.5, 0.6, &settings()), first);
}

/// What is measured, or has held, is relied on as it is: what slips that told nothing had taken off is not taken off it.
#[test]
fn what_is_learnt_takes_the_place_of_the_factor() {
    let slipped = || {
        let mut belief = learning();
        assert_eq!(belief.rely(0.5, &ContactForce::zero(), Slipping, STEP, &settings()), 0.4);
        belief
    };
    let mut belief = slipped();
    let found = slide(&mut belief, 0.5, 0.35, &settings());
    assert_eq!(found, belief.estimate().unwrap().quantile(0.01));
    let mut belief = slipped();
    for _ in 0..32 {
        belief.rely(0.5, &at_ratio(0.45), Holding, STEP, &settings());
    }
    assert!((belief.rely(0.5, &at_ratio(0.05), Holding, STEP, &settings()) - 0.45).abs() < 1e-15);
}

/// Where break-away scatters so much that no friction can be relied on, a slip counts by the factor.
#[test]
fn a_slip_that_leaves_nothing_to_rely_on_counts_by_the_factor() {
    let mut belief = LearntFriction::new(ForceNoise::isotropic(0.01).unwrap(), 1e3, 0.01).unwrap();
    assert_eq!(slide(&mut belief, 0.5, 0.4, &settings()), 0.4);
    assert_eq!(belief.estimate().unwrap().quantile(0.01), 0.0);
}

/// What slips that told nothing have taught is forgotten with the object, too.
#[test]
fn a_factor_is_forgotten_with_the_object() {
    let mut belief = learning();
    assert_eq!(belief.rely(0.5, &ContactForce::zero(), Slipping, STEP, &settings()), 0.4);
    belief.forget();
    assert_eq!(belief.rely(0.5, &at_ratio(0.05), Holding, STEP, &settings()), 0.5);
}

#[test]
fn what_holds_long_enough_is_held() {
    let hold = |belief: &mut LearntFriction<f64>, ratio: f64, count: u32| {
        (0..count).map(|_| belief.rely(0.3, &at_ratio(ratio), Holding, STEP, &settings())).last().unwrap()
    };
    let mut belief = learning();
    assert_eq!(hold(&mut belief, 0.5, 31), 0.3);
    // One that is not above what is relied on begins the count anew.
    hold(&mut belief, 0.3, 1);
    assert_eq!(hold(&mut belief, 0.5, 31), 0.3);
    assert!((hold(&mut belief, 0.5, 1) - 0.5).abs() < 1e-15);
    // The least of those in a row.
    hold(&mut belief, 0.8, 16);
    hold(&mut belief, 0.6, 1);
    assert!((hold(&mut belief, 0.8, 15) - 0.6).abs() < 1e-15);
    // No more than any contact can have.
    assert_eq!(hold(&mut belief, 5.0, 32), settings().greatest_ratio);
    // A verdict that is not sure counts for nothing.
    let mut belief = learning();
    for _ in 0..100 {
        assert_eq!(belief.rely(0.3, &at_ratio(0.5), SlipVerdict::Warning, STEP, &settings()), 0.3);
    }
}

/// Whatever comes: a positive coefficient, and no more than any contact can have.
#[test]
fn no_sample_teaches_what_cannot_be() {
    let mut rng = Pcg64Mcg::seed_from_u64(72);
    let numbers = [0.0, -1.0, 1.0, 5e-324, 1e-300, 1e300, f64::INFINITY, f64::NEG_INFINITY, f64::NAN];
    let verdicts = [Holding, Slipping, SlipVerdict::Warning, SlipVerdict::NotPressing];
    for _ in 0..300 {
        let mut belief = learning();
        for _ in 0..200 {
            let mut any = || {
                let odd = numbers[rng.random_range(0..numbers.len())];
                if rng.random_bool(0.1) { odd } else { rng.random_range(-1.0..5.0) }
            };
            let force = ContactForce::new(any(), Vector3::new(any(), any(), 0.0), any());
            let verdict = verdicts[rng.random_range(0..4)];
            let time_step = [0.0, 1e-3, 1e300][rng.random_range(0..3)];
            let found = belief.rely(0.5, &force, verdict, time_step, &settings());
            assert!(found > 0.0 && found <= settings().greatest_ratio, "{found} {force:?}");
        }
    }
    let noise = ForceNoise::isotropic(0.01).unwrap();
    for bad in [0.0, -0.1, 0.6, f64::NAN] {
        assert!(LearntFriction::new(noise, 0.05, bad).is_err());
    }
    for bad in [-0.1, f64::NAN, f64::INFINITY] {
        assert!(LearntFriction::new(noise, bad, 0.01).is_err());
    }
}

/// Two fingers on a surface that is rougher than was known: after one slip of each the grip is the least for the friction
/// that was measured, and less than before.
#[test]
fn a_hand_grips_by_what_it_has_learnt() {
    let settings = HandSettings { safety: 1.0, rise: 1e4, fall: 1e4, ..settings() };
    let limits = [FingerLimits::<f64, 1>::none(); 2];
    let mut hand = HandController::with_beliefs(settings, limits, [learning(); 2]).unwrap();
    let (friction, weight) = (0.9, 1.96);
    let load: HandLoad<f64, Hand> =
        HandLoad::Known(Wrench::on_fingertip(Vector3::z() * -weight, Vector3::zeros()));
    let mut command = |ratio: f64, slip| {
        let finger = |side: f64| {
            let contact = GraspContact::soft(Vector3::x() * side, -Vector3::x() * side, 0.4, 3e-3).unwrap();
            let force = ContactForce::new(2.0, -Vector3::z() * (2.0 * ratio), 0.0);
            FingerState::Touching(FingerSample { contact, force, slip })
        };
        hand.command(&[finger(-0.02), finger(0.02)], &load, STEP).normal[0]
    };
    let before = command(0.0, Holding);
    assert!((before - 0.5 * weight / 0.4).abs() < 1e-6, "{before}");
    for step in 0..100 {
        command(friction * f64::from(step) / 100.0, SlipVerdict::Warning);
    }
    let after = command(friction, Slipping);
    let relied = hand.beliefs().map(|belief| belief.estimate().unwrap().quantile(0.01));
    assert!(relied.iter().all(|relied| (0.8 * friction..friction).contains(relied)), "{relied:?}");
    assert!((after - 0.5 * weight / relied[0]).abs() < 1e-6 && after < 0.6 * before, "{after} {relied:?}");
    hand.forget_friction();
    assert!(hand.beliefs().iter().all(|belief| belief.estimate().is_none()));
}
