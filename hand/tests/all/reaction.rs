//! What is commanded: within rates and limits, whatever the fingers say.

use fingertip_friction::SlipVerdict;
use fingertip_hand::{
    FingerLimits, FingerSample, FingerState, GraspContact, Hand, HandCommand, HandController, HandLoad,
    HandSettings, HandState,
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
        recovery: 0.0,
    }
}

fn controller() -> HandController<f64, 2, 2> {
    let limits = FingerLimits::none().with_least_normal(0.2).unwrap().with_greatest_normal(15.0).unwrap();
    HandController::new(settings(), [limits; 2]).unwrap()
}

fn finger(side: f64, force: ContactForce<f64>, slip: SlipVerdict) -> FingerState<f64> {
    let contact = GraspContact::soft(Vector3::x() * (0.02 * side), -Vector3::x() * side, 0.6, 3e-3).unwrap();
    FingerState::Touching(FingerSample { contact, force, slip })
}

fn pressed() -> ContactForce<f64> {
    ContactForce::new(3.0, -Vector3::z() * 0.98, 0.0)
}

fn weight() -> Wrench<f64, Hand> {
    Wrench::on_fingertip(-Vector3::z() * 1.96, Vector3::zeros())
}

const FROM_FINGERS: HandLoad<f64, Hand> = HandLoad::FromFingers;

/// What is commanded where the load is known.
fn command<const N: usize, const ROWS: usize>(
    hand: &mut HandController<f64, N, ROWS>,
    fingers: &[FingerState<f64>; N],
    load: Wrench<f64, Hand>,
) -> HandCommand<f64, N> {
    hand.command(fingers, &HandLoad::Known(load), STEP)
}

fn settle(hand: &mut HandController<f64, 2, 2>) -> [f64; 2] {
    let fingers = [-1.0, 1.0].map(|side| finger(side, pressed(), SlipVerdict::Holding));
    let mut command = [0.0; 2];
    for _ in 0..50 {
        let found = self::command(hand, &fingers, weight());
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
    let after = command(&mut hand, &fingers, weight());
    assert!((after.normal[0] - before[0] - 500.0 * STEP).abs() < 1e-9 && after.normal[1] > before[1] + 0.4);
    // The load that was measured stays: the grip goes on to what a coefficient of 0.48 asks of the left one.
    let settled = settle(&mut hand);
    let (left, right) = (settled[0], settled[1]);
    // Each carries half of the weight, or it would turn; equal normal forces.
    assert!((left - right).abs() < 1e-6 && (left - 0.98 * 1.5 / 0.48).abs() < 1e-5, "{left}");
    hand.forget_friction();
    let falling = command(&mut hand, &[finger(-1.0, pressed(), SlipVerdict::Holding), fingers[1]], weight());
    assert!((falling.normal[0] - (left - 2.0 * STEP)).abs() < 1e-9, "no faster than it may fall");
}

/// However often it slips, the friction taken stays above the least, and forces within the limits.
#[test]
fn slipping_for_ever_stays_within_limits() {
    let mut hand = controller();
    let fingers = [-1.0, 1.0].map(|side| finger(side, pressed(), SlipVerdict::Slipping));
    for _ in 0..1_000 {
        let found = command(&mut hand, &fingers, weight());
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
        let found = command(&mut hand, &fingers, weight());
        assert_eq!((found.normal, found.state, found.implausible), (before, HandState::Blind, [true; 2]));
        // One alone cannot hold it, and does not try.
        let fingers = [fingers[0], finger(1.0, pressed(), SlipVerdict::Holding)];
        let found = command(&mut hand, &fingers, weight());
        assert_eq!((found.normal, found.implausible), (before, [true, false]));
        assert!(matches!(found.state, HandState::CannotHold(_)));
    }
    let lost = command(&mut hand, &[FingerState::Free; 2], weight());
    assert_eq!((lost.normal, lost.state), (before, HandState::Blind));
    let fingers = [-1.0, 1.0].map(|side| finger(side, pressed(), SlipVerdict::Holding));
    for step in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let found = hand.command(&fingers, &HandLoad::Known(weight()), step);
        assert_eq!((found.normal, found.state), (before, HandState::Blind), "{step}");
    }
    // What no grip holds does not drive it to its maximum.
    let anvil = weight() * 1e3;
    let found = command(&mut hand, &fingers, anvil);
    assert_eq!(found.normal, before);
    assert!(matches!(found.state, HandState::CannotHold(why) if why.velocity.z < 0.0));
}

/// Three fingers hold 200 g, and one of them reads 15 N that no contact of it explains, in whatever way: where the load is
/// the sum of what the fingers feel, no command rises or falls, however long, and the others answer slip only once it is
/// over. Where the load is known without them, the others bear it alone, whatever the third one reads.
#[test]
fn a_finger_that_reads_what_cannot_be_does_not_drive_the_others() {
    let limits = FingerLimits::<f64, 2>::none().with_least_normal(0.3).unwrap();
    let limits = limits.with_greatest_normal(15.0).unwrap();
    let around = |index: usize, force, slip| {
        let angle = index as f64 * 2.1;
        let outward = Vector3::new(angle.cos(), angle.sin(), 0.0);
        let contact = GraspContact::soft(outward * 0.03, -outward, 0.6, 3e-3).unwrap();
        FingerState::Touching(FingerSample { contact, force, slip })
    };
    let third = weight().force() / 3.0;
    let held = |index| around(index, ContactForce::new(3.0, third, 0.0), SlipVerdict::Holding);
    let wrong = |normal, sideways, spin| {
        around(2, ContactForce::new(normal, third.normalize() * sideways, spin), SlipVerdict::NotPressing)
    };
    for wrong in [
        FingerState::Unexplained,
        wrong(-15.0, 0.0, 0.0),
        wrong(0.1, 15.0, 0.0),
        wrong(1e-3, 0.0, 0.045),
        wrong(f64::NAN, 15.0, 0.0),
    ] {
        let mut hand = HandController::new(settings(), [limits; 3]).unwrap();
        let mut before = [0.0; 3];
        for _ in 0..50 {
            let found = hand.command(&[held(0), held(1), held(2)], &FROM_FINGERS, STEP);
            assert_eq!((found.state, found.implausible), (HandState::Holding, [false; 3]));
            before = found.normal;
        }
        assert!(before.iter().all(|normal| (0.5..5.0).contains(normal)), "{before:?}");
        let (mut known, untouched) = (hand, hand);
        for _ in 0..1_000 {
            let found = hand.command(&[held(0), held(1), wrong], &FROM_FINGERS, STEP);
            assert_eq!((found.state, found.normal), (HandState::Doubtful, before));
            assert_eq!(found.implausible, [false, false, true]);
        }
        assert_eq!(hand, untouched);
        let slips = around(0, ContactForce::new(3.0, third, 0.0), SlipVerdict::Slipping);
        let found = hand.command(&[slips, held(1), wrong], &FROM_FINGERS, STEP);
        assert_eq!((found.state, found.normal), (HandState::Doubtful, before));
        let found = hand.command(&[held(0), held(1), held(2)], &FROM_FINGERS, STEP);
        assert!(found.state == HandState::Holding && found.normal[0] > before[0] + 1e-3);
        // With the load known: as if the third did not touch.
        let mut without = known;
        for _ in 0..100 {
            let found = command(&mut known, &[held(0), held(1), wrong], weight());
            assert_eq!(
                found.normal,
                command(&mut without, &[held(0), held(1), FingerState::Free], weight()).normal
            );
        }
    }
}

/// What the fingers feel is the load: as if it were known.
#[test]
fn the_load_is_the_sum_of_what_the_fingers_feel() {
    let (mut from_fingers, mut known) = (controller(), controller());
    for k in 0..60 {
        let force = |side: f64| {
            let aside = Vector3::new(0.0, 0.2 * f64::from(k % 7), -0.98 + 0.01 * side * f64::from(k));
            ContactForce::new(3.0 - 0.2 * side, aside, 1e-3 * side)
        };
        let fingers = [-1.0, 1.0].map(|side| finger(side, force(side), SlipVerdict::Holding));
        // From force and place, without the crate's own sum.
        let mut load = Wrench::<f64, Hand>::zero();
        for side in [-1.0, 1.0] {
            let (force, normal) = (force(side), -Vector3::x() * side);
            let on_tip = force.tangential.vector() - normal * force.normal;
            let torque = (Vector3::x() * (0.02 * side)).cross(&on_tip) + normal * force.spin;
            load = load + Wrench::on_fingertip(on_tip, torque);
        }
        let found = from_fingers.command(&fingers, &FROM_FINGERS, STEP);
        let expected = command(&mut known, &fingers, load);
        assert_eq!(found.state, HandState::Holding);
        assert!(
            found.normal.iter().zip(expected.normal).all(|(a, b)| (a - b).abs() < 1e-9),
            "{found:?} {expected:?}"
        );
    }
}

/// A contact that asks for just as much friction as there can be is believed, for a force and for a spin torque; one that
/// asks for a little more, or does not press, is not. A point contact has no spin torque to ask for.
#[test]
fn what_can_just_be_is_believed() {
    let mut hand = controller();
    let mut believes = |contact: GraspContact<f64, Hand>, force: ContactForce<f64>| {
        let fingers = [
            FingerState::Touching(FingerSample { contact, force, slip: SlipVerdict::Holding }),
            finger(1.0, pressed(), SlipVerdict::Holding),
        ];
        !command(&mut hand, &fingers, weight()).implausible[0]
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
    for third in [FingerState::Free, pulls, FingerState::Unexplained] {
        for _ in 0..50 {
            let holding = [-1.0, 1.0].map(|side| finger(side, pressed(), SlipVerdict::Holding));
            let found = command(&mut hand, &[holding[0], third, holding[1]], weight());
            assert_eq!(found.state, HandState::Holding);
            assert_eq!(found.implausible, [false, third != FingerState::Free, false]);
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
    let slipping = [-1.0, 1.0].map(|side| finger(side, pressed(), SlipVerdict::Slipping));
    let found = command(&mut hand, &slipping, weight());
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
    let slippery = FingerState::Touching(FingerSample { contact, force, slip: SlipVerdict::Holding });
    for _ in 0..5 {
        let holding = [-1.0, 1.0].map(|side| finger(side, pressed(), SlipVerdict::Holding));
        let found = command(&mut hand, &[holding[0], slippery, holding[1]], weight() * 3.0);
        assert_eq!((found.state, found.normal[1]), (HandState::Holding, 0.7));
    }
    let mut alone = HandController::new(HandSettings { safety: 3.0, ..settings() }, [limits; 1]).unwrap();
    let found = command(&mut alone, &[slippery], weight());
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
            FingerState::Touching(FingerSample { contact, force: pressed(), slip })
        };
        let mut feel = |slip| command(&mut hand, &[-1.0, 1.0].map(|side| sample(side, slip)), weight());
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
        let found = command(&mut hand, &fingers, load);
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
    for bad in [f64::NAN, -1.0, f64::INFINITY] {
        let settings = HandSettings { recovery: bad, ..settings() };
        assert_eq!(HandController::new(settings, limits).unwrap_err().parameter, "rate of recovery");
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
            let left = match kind {
                1 => FingerState::Free,
                5 => FingerState::Unexplained,
                _ => left,
            };
            let fingers = [left, finger(1.0, pressed(), SlipVerdict::Holding)];
            let load = HandLoad::Known(weight() * if kind == 2 { wild } else { tangential });
            let load = if kind > 5 { FROM_FINGERS } else { load };
            let found = hand.command(&fingers, &load, STEP);
            let blamed = matches!(found.state, HandState::Doubtful | HandState::Blind);
            prop_assert!(kind <= 5 || !found.implausible[0] || (blamed && found.normal == before));
            let found = found.normal;
            for (now, last) in found.iter().zip(&before) {
                prop_assert!((0.0..=15.0).contains(now));
                prop_assert!(now - last <= 500.0 * STEP + 1e-12 && last - now <= 2.0 * STEP + 1e-12);
            }
            before = found;
        }
    }
}
