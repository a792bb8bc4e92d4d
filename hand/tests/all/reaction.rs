//! What is commanded: within rates and limits, whatever the fingers say.

use fingertip_friction::SlipVerdict;
use fingertip_hand::{
    FingerLimits, FingerSample, GraspContact, Hand, HandController, HandSettings, HandState,
};
use fingertip_wrench::{ContactForce, Wrench};
use nalgebra::Vector3;
use proptest::prelude::*;

const STEP: f64 = 1e-3;

fn settings() -> HandSettings<f64> {
    HandSettings {
        safety: 1.5,
        rise: 500.0,
        fall: 2.0,
        at_slip: 0.8,
        least_friction: 0.1,
        greatest_ratio: 2.0,
    }
}

fn controller() -> HandController<f64, 2, 2> {
    let limits = FingerLimits::none().with_least_normal(0.2).unwrap().with_greatest_normal(15.0).unwrap();
    HandController::new(settings(), [limits; 2]).unwrap()
}

fn finger(side: f64, force: ContactForce<f64>, slip: SlipVerdict) -> Option<FingerSample<f64, Hand>> {
    let contact = GraspContact::soft(Vector3::x() * (0.02 * side), -Vector3::x() * side, 0.6, 3e-3).unwrap();
    Some(FingerSample { contact, force, slip })
}

fn pressed() -> ContactForce<f64> {
    ContactForce::new(3.0, -Vector3::z() * 0.98, 0.0)
}

fn weight() -> Wrench<f64, Hand> {
    Wrench::on_fingertip(-Vector3::z() * 1.96, Vector3::zeros())
}

fn settle(hand: &mut HandController<f64, 2, 2>) -> [f64; 2] {
    let fingers = [-1.0, 1.0].map(|side| finger(side, pressed(), SlipVerdict::Holding));
    let mut command = [0.0; 2];
    for _ in 0..50 {
        let found = hand.command(&fingers, &weight(), STEP);
        assert_eq!(found.state, HandState::Holding);
        command = found.normal;
    }
    command
}

#[test]
fn slip_raises_the_grip_in_the_same_sample_and_is_remembered() {
    let mut hand = controller();
    let before = settle(&mut hand);
    assert!((before[0] - 0.98 * 1.5 / 0.6).abs() < 1e-6);
    let fingers =
        [finger(-1.0, pressed(), SlipVerdict::Slipping), finger(1.0, pressed(), SlipVerdict::Holding)];
    let after = hand.command(&fingers, &weight(), STEP);
    assert!((after.normal[0] - before[0] - 500.0 * STEP).abs() < 1e-9 && after.normal[1] > before[1] + 0.4);
    // The load that was measured stays: the grip goes on to what a coefficient of 0.48 asks of the left one.
    let settled = settle(&mut hand);
    let (left, right) = (settled[0], settled[1]);
    // Each carries half of the weight, or it would turn; equal normal forces.
    assert!((left - right).abs() < 1e-6 && (left - 0.98 * 1.5 / 0.48).abs() < 1e-5, "{left}");
    hand.forget_friction();
    let falling = hand.command(&[finger(-1.0, pressed(), SlipVerdict::Holding), fingers[1]], &weight(), STEP);
    assert!((falling.normal[0] - (left - 2.0 * STEP)).abs() < 1e-9, "no faster than it may fall");
}

/// However often it slips, the friction taken stays above the least, and forces within the limits.
#[test]
fn slipping_for_ever_stays_within_limits() {
    let mut hand = controller();
    let fingers = [-1.0, 1.0].map(|side| finger(side, pressed(), SlipVerdict::Slipping));
    for _ in 0..1_000 {
        let found = hand.command(&fingers, &weight(), STEP);
        assert!(found.normal.iter().all(|n| *n <= 15.0));
    }
    assert!((hand.present()[0] - 0.98 * 1.5 / 0.1).abs() < 1e-4, "{:?}", hand.present());
}

/// A contact that cannot be never drives a grip: its finger keeps what it had.
#[test]
fn implausible_contacts_drive_nothing() {
    let mut hand = controller();
    let before = settle(&mut hand);
    for bad in [
        ContactForce::new(-1.0, Vector3::zeros(), 0.0),
        ContactForce::new(0.1, Vector3::z() * 15.0, 0.0),
        ContactForce::new(0.1, Vector3::zeros(), 1.0),
        ContactForce::new(f64::NAN, Vector3::zeros(), 0.0),
        ContactForce::new(1.0, Vector3::z() * f64::INFINITY, 0.0),
    ] {
        let fingers = [-1.0, 1.0].map(|side| finger(side, bad, SlipVerdict::Slipping));
        let found = hand.command(&fingers, &weight(), STEP);
        assert_eq!((found.normal, found.state, found.implausible), (before, HandState::Blind, [true; 2]));
        // One alone cannot hold it, and does not try.
        let fingers = [fingers[0], finger(1.0, pressed(), SlipVerdict::Holding)];
        let found = hand.command(&fingers, &weight(), STEP);
        assert_eq!((found.normal, found.implausible), (before, [true, false]));
        assert!(matches!(found.state, HandState::CannotHold(_)));
    }
    let lost = hand.command(&[None, None], &weight(), STEP);
    assert_eq!((lost.normal, lost.state), (before, HandState::Blind));
    let fingers = [-1.0, 1.0].map(|side| finger(side, pressed(), SlipVerdict::Holding));
    for step in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let found = hand.command(&fingers, &weight(), step);
        assert_eq!((found.normal, found.state), (before, HandState::Blind), "{step}");
    }
    // What no grip holds does not drive it to its maximum.
    let anvil = weight() * 1e3;
    let found = hand.command(&fingers, &anvil, STEP);
    assert_eq!(found.normal, before);
    assert!(matches!(found.state, HandState::CannotHold(why) if why.velocity.z < 0.0));
}

/// A contact that asks for just as much friction as there can be is believed, for a force and for a spin torque; one that
/// asks for a little more, or does not press, is not. A point contact has no spin torque to ask for.
#[test]
fn what_can_just_be_is_believed() {
    let mut hand = controller();
    let mut believes = |contact: GraspContact<f64, Hand>, force: ContactForce<f64>| {
        let fingers = [
            Some(FingerSample { contact, force, slip: SlipVerdict::Holding }),
            finger(1.0, pressed(), SlipVerdict::Holding),
        ];
        !hand.command(&fingers, &weight(), STEP).implausible[0]
    };
    let (at, inward) = (-Vector3::x() * 0.02, Vector3::x());
    let soft = GraspContact::soft(at, inward, 0.6, 0.25).unwrap();
    let point = GraspContact::point(at, inward, 0.6).unwrap();
    for contact in [soft, point] {
        assert!(believes(contact, ContactForce::new(1.5, Vector3::z() * 3.0, 0.0)));
        assert!(!believes(contact, ContactForce::new(1.5, Vector3::z() * 3.01, 0.0)));
        assert!(!believes(contact, ContactForce::new(0.0, Vector3::zeros(), 0.0)));
        assert!(!believes(contact, ContactForce::new(f64::INFINITY, Vector3::zeros(), 0.0)));
    }
    assert!(believes(soft, ContactForce::new(1.5, Vector3::zeros(), 0.75)));
    assert!(believes(soft, ContactForce::new(1.5, Vector3::zeros(), -0.75)));
    assert!(!believes(soft, ContactForce::new(1.5, Vector3::zeros(), 0.76)));
    assert!(!believes(soft, ContactForce::new(1.5, Vector3::zeros(), -0.76)));
    assert!(believes(point, ContactForce::new(1.5, Vector3::zeros(), 0.76)));
}

/// Two fingers hold; the third, which touches nothing or is not believed, keeps its command however long.
#[test]
fn a_finger_that_does_not_touch_keeps_its_command() {
    let limits = FingerLimits::<f64, 2>::none().with_least_normal(0.7).unwrap();
    let mut hand = HandController::new(settings(), [limits; 3]).unwrap();
    let pulls = finger(0.5, ContactForce::new(-1.0, Vector3::zeros(), 0.0), SlipVerdict::Slipping);
    for third in [None, pulls] {
        for _ in 0..50 {
            let holding = [-1.0, 1.0].map(|side| finger(side, pressed(), SlipVerdict::Holding));
            let found = hand.command(&[holding[0], third, holding[1]], &weight(), STEP);
            assert_eq!(found.state, HandState::Holding);
            assert_eq!(found.implausible, [false, third.is_some(), false]);
            assert_eq!(found.normal[1], 0.7);
            assert_eq!(hand.present(), found.normal);
        }
        assert!((hand.present()[0] - 0.98 * 1.5 / 0.6).abs() < 1e-6);
    }
}

/// What has forgotten the object is as new, where no command could move meanwhile.
#[test]
fn what_forgets_friction_is_as_new() {
    let settings = HandSettings { rise: 1e-300, fall: 1e-300, ..settings() };
    let limits = [FingerLimits::<f64, 1>::none().with_least_normal(9.0).unwrap(); 2];
    let new = HandController::new(settings, limits).unwrap();
    let mut hand = new;
    let found = hand.command(
        &[-1.0, 1.0].map(|side| finger(side, pressed(), SlipVerdict::Slipping)),
        &weight(),
        STEP,
    );
    assert_eq!((found.state, found.normal), (HandState::Holding, [9.0; 2]));
    assert!(hand != new);
    hand.forget_friction();
    assert_eq!(hand, new);
}

/// A contact whose friction, safety considered, is too small for a number holds nothing: its finger keeps its command.
#[test]
fn a_contact_without_friction_is_left_out() {
    let limits = FingerLimits::<f64, 1>::none().with_least_normal(0.7).unwrap();
    let mut hand = HandController::new(HandSettings { safety: 3.0, ..settings() }, [limits; 3]).unwrap();
    let contact = GraspContact::point(Vector3::y() * 0.02, -Vector3::y(), 5e-324).unwrap();
    let force = ContactForce::new(1.0, Vector3::zeros(), 0.0);
    let slippery = Some(FingerSample { contact, force, slip: SlipVerdict::Holding });
    for _ in 0..5 {
        let holding = [-1.0, 1.0].map(|side| finger(side, pressed(), SlipVerdict::Holding));
        let found = hand.command(&[holding[0], slippery, holding[1]], &(weight() * 3.0), STEP);
        assert_eq!((found.state, found.normal[1]), (HandState::Holding, 0.7));
    }
    let mut alone = HandController::new(HandSettings { safety: 3.0, ..settings() }, [limits; 1]).unwrap();
    let found = alone.command(&[slippery], &weight(), STEP);
    assert_eq!((found.state, found.normal), (HandState::Blind, [0.7]));
}

/// Friction after so many slips, and never below the least (of a contact that has less, its own): with equal fingers the
/// command is half of the weight, times safety, over it.
#[test]
fn friction_is_learnt_by_the_factor_down_to_the_least() {
    let factors = [(0.6, 0), (0.6, 1), (0.6, 3), (0.6, 7), (0.6, 8), (0.6, 40), (0.05, 0), (0.05, 3)];
    for (friction, slips) in factors {
        let limits = [FingerLimits::<f64, 0>::none(); 2];
        let mut hand =
            HandController::new(HandSettings { rise: 1e9, fall: 1e9, ..settings() }, limits).unwrap();
        let sample = |side: f64, slip| {
            let (at, inward) = (Vector3::x() * (0.02 * side), -Vector3::x() * side);
            let contact = GraspContact::<f64, Hand>::soft(at, inward, friction, 3e-3).unwrap();
            Some(FingerSample { contact, force: pressed(), slip })
        };
        let mut feel = |slip| hand.command(&[-1.0, 1.0].map(|side| sample(side, slip)), &weight(), STEP);
        for _ in 0..slips {
            feel(SlipVerdict::Slipping);
        }
        let found = feel(SlipVerdict::Holding);
        let left = (friction * 0.8_f64.powi(slips)).max(friction.min(0.1));
        let expected = 0.98 * 1.5 / left;
        assert!(
            (found.normal[0] / expected - 1.0).abs() < 1e-6,
            "{friction} {slips}: {:?} {expected}",
            found.normal
        );
    }
}

/// At a load that asks for all that the fingers may give no command exceeds it by the last digit.
#[test]
fn no_command_exceeds_a_limit_by_a_digit() {
    for i in 0..60 {
        let greatest = 3.0 + 0.37 * f64::from(i);
        let limits = FingerLimits::<f64, 2>::none().with_least_normal(0.2).unwrap();
        let limits = limits.with_greatest_normal(greatest).unwrap();
        let mut hand = HandController::new(HandSettings { rise: 1e9, ..settings() }, [limits; 2]).unwrap();
        let fingers = [-1.0, 1.0].map(|side| finger(side, pressed(), SlipVerdict::Holding));
        // Friction 0.6 over safety 1.5, twice.
        let load = Wrench::on_fingertip(-Vector3::z() * (0.8 * greatest * (1.0 - 1e-9)), Vector3::zeros());
        let found = hand.command(&fingers, &load, STEP);
        assert!(found.normal.iter().all(|normal| *normal <= greatest), "{found:?}");
    }
}

#[test]
fn settings_are_checked() {
    let limits = [FingerLimits::<f64, 2>::none(); 2];
    for bad in [f64::NAN, -1.0, 0.0, f64::INFINITY] {
        for (settings, parameter) in [
            (HandSettings { safety: bad, ..settings() }, "factor of safety"),
            (HandSettings { rise: bad, ..settings() }, "rate of rise"),
            (HandSettings { fall: bad, ..settings() }, "rate of fall"),
            (HandSettings { at_slip: bad, ..settings() }, "factor at slip"),
            (HandSettings { least_friction: bad, ..settings() }, "least friction coefficient"),
            (HandSettings { greatest_ratio: bad, ..settings() }, "greatest friction ratio"),
        ] {
            assert_eq!(HandController::new(settings, limits).unwrap_err().parameter, parameter);
        }
    }
    assert!(HandController::new(HandSettings { safety: 1.0, ..settings() }, limits).is_ok());
    let error = HandController::new(HandSettings { at_slip: 1.0, ..settings() }, limits).unwrap_err();
    assert_eq!(error.to_string(), "the factor at slip must be between 0 and 1");
}

proptest! {
    #[test]
    fn commands_keep_rates_and_limits(
        samples in prop::collection::vec((any::<f64>(), -5.0..20.0_f64, -5.0..5.0_f64, any::<bool>(), 0..8_u8), 1..60),
    ) {
        let mut hand = controller();
        let mut before = hand.present();
        for (wild, normal, tangential, slips, kind) in samples {
            let slip = if slips { SlipVerdict::Slipping } else { SlipVerdict::Holding };
            let normal = if kind == 0 { wild } else { normal };
            let left = finger(-1.0, ContactForce::new(normal, Vector3::z() * tangential, 0.0), slip);
            let fingers = [left.filter(|_| kind != 1), finger(1.0, pressed(), SlipVerdict::Holding)];
            let load = weight() * if kind == 2 { wild } else { tangential };
            let found = hand.command(&fingers, &load, STEP).normal;
            for (now, last) in found.iter().zip(&before) {
                prop_assert!((0.0..=15.0).contains(now));
                prop_assert!(now - last <= 500.0 * STEP + 1e-12 && last - now <= 2.0 * STEP + 1e-12);
            }
            before = found;
        }
    }
}
