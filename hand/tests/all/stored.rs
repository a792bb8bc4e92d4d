//! Files: what comes out is read as it was written, from a text and from bytes, in both scalar types.

use core::fmt::Debug;

use fingertip_friction::SlipVerdict;
use fingertip_hand::{
    FingerLimits, FingerSample, FingerState, Grasp, GraspContact, GripOutcome, Hand, HandCommand,
    HandController, HandLoad, HandSettings, HandState, LeastGrip, Metric, Reach, UncertainWrench,
};
use fingertip_wrench::{ContactForce, Real, Wrench};
use nalgebra::{Matrix6, Vector3};
use serde::Serialize;
use serde::de::DeserializeOwned;

/// Through MessagePack, which has all numbers and no need of names.
fn kept<V: Serialize + DeserializeOwned + PartialEq + Debug>(value: &V) {
    for bytes in [rmp_serde::to_vec(value).unwrap(), rmp_serde::to_vec_named(value).unwrap()] {
        assert_eq!(&rmp_serde::from_slice::<V>(&bytes).unwrap(), value);
    }
}

/// Through JSON as well, which has no infinity.
fn kept_as_text<V: Serialize + DeserializeOwned + PartialEq + Debug>(value: &V) -> serde_json::Value {
    kept(value);
    let text = serde_json::to_string(value).unwrap();
    assert_eq!(&serde_json::from_str::<V>(&text).unwrap(), value, "{text}");
    serde_json::from_str(&text).unwrap()
}

/// On the x axis, so far from the origin, pressing inwards.
fn soft<T: Real>(x: f64) -> GraspContact<T, Hand> {
    let place = Vector3::x() * T::literal(x);
    GraspContact::soft(place, -place, T::literal(0.5), T::literal(3e-3)).unwrap()
}

fn force<T: Real>(x: f64, z: f64) -> Wrench<T, Hand> {
    Wrench::on_fingertip(Vector3::new(T::literal(x), T::zero(), T::literal(z)), Vector3::zeros())
}

fn grips<T: Real + Serialize + DeserializeOwned>() {
    let solve = |grasp: &Grasp<T, 2>, load: &Wrench<T, Hand>| {
        LeastGrip::new().solve(grasp, &[FingerLimits::<T, 1>::none(); 2], load)
    };
    let two = Grasp::new([Some(soft(-0.02)), Some(soft(0.02))]);
    let held = solve(&two, &force(0.1, -2.0));
    let text = kept_as_text(&held);
    assert_eq!(text["held"]["forces"].as_array().unwrap().len(), 2, "{text}");
    kept_as_text(held.grip().unwrap());
    // One finger cannot pull.
    let not_held = solve(&Grasp::new([Some(soft(0.02)), None]), &force(-1.0, 0.0));
    let GripOutcome::CannotHold(why) = not_held else { panic!("{not_held:?}") };
    kept(&not_held);
    kept(&why);
    kept(&HandState::CannotHold(why));
    assert_eq!(kept_as_text(&HandState::<T>::WithoutSafety), "without_safety");
    assert_eq!(kept_as_text(&solve(&two, &force(f64::NAN, 0.0))), "not_finite");
    assert_eq!(kept_as_text(&GripOutcome::<T, 2>::Undecided), "undecided");
}

fn grasps<T: Real + Serialize + DeserializeOwned>() {
    let two = Grasp::new([Some(soft::<T>(-0.02)), Some(soft(0.02))]);
    let press = |newtons| ContactForce::new(T::literal(newtons), Vector3::zeros(), T::literal(0.01));
    kept_as_text(&two.split(&[press(5.0), press(4.0)]));
    kept_as_text(&two.ball(Metric::Each { length: T::literal(0.02) }).unwrap());
    for margin in two.slip_margins(&[press(2.0), press(1.0)]) {
        kept_as_text(&margin.unwrap());
    }
    // Sliding, turning about contacts and screwing; words are part of what comes back.
    let point = |x: f64, normal: Vector3<f64>| {
        let place = Vector3::x() * T::literal(x);
        GraspContact::<T, Hand>::point(place, normal.map(T::literal), T::literal(0.5)).unwrap()
    };
    let between = Grasp::new([Some(point(-0.02, Vector3::x())), Some(point(0.02, -Vector3::x()))]);
    let free = Grasp::new([None::<GraspContact<T, Hand>>, None]);
    let mut words = Vec::new();
    for freedom in between.freedoms().iter().chain(&free.freedoms()).flatten() {
        kept_as_text(freedom);
        let bytes = rmp_serde::to_vec(freedom).unwrap();
        let same: fingertip_hand::Freedom<T, 2> = rmp_serde::from_slice(&bytes).unwrap();
        assert_eq!(same.to_string(), freedom.to_string());
        words.push(freedom.to_string());
    }
    assert_eq!(words[0], "turning about the line through contacts 0 and 1");
    assert_eq!(words.len(), 7);
    for (reach, text) in [
        (Reach::Times(T::literal(1.5)), serde_json::json!({ "times": 1.5 })),
        (Reach::Unlimited, "unlimited".into()),
        (Reach::NotHeld, "not_held".into()),
        (Reach::Unknown, "unknown".into()),
    ] {
        assert_eq!(kept_as_text(&reach), text);
    }
    kept_as_text(&UncertainWrench { wrench: force::<T>(1.0, 2.0), covariance: Matrix6::identity() });
}

/// More fingers than serde's own arrays have places.
fn commands<T: Real + Serialize + DeserializeOwned>() {
    let mut hand = HandController::new(HandSettings::default(), [FingerLimits::<T, 2>::none(); 40]).unwrap();
    let mut fingers = [FingerState::Free; 40];
    for (x, finger) in [-0.02, 0.02].into_iter().zip(&mut fingers) {
        let force = ContactForce::new(T::literal(3.0), -Vector3::z(), T::zero());
        *finger = FingerState::Touching(FingerSample { contact: soft(x), force, slip: SlipVerdict::Holding });
    }
    let command = hand.command(&fingers, &HandLoad::FromFingers, T::literal(1e-3));
    assert_eq!(command.state, HandState::Holding);
    let text = kept_as_text(&command);
    assert_eq!((text["normal"].as_array().unwrap().len(), &text["state"]), (40, &"holding".into()));
    fingers[39] = FingerState::Unexplained;
    let command: HandCommand<T, 40> = hand.command(&fingers, &HandLoad::FromFingers, T::literal(1e-3));
    let text = kept_as_text(&command);
    assert_eq!((&text["implausible"][39], &text["state"]), (&true.into(), &"doubtful".into()));
    // One finger too few.
    let short = serde_json::json!({ "normal": [1.0], "state": "holding", "implausible": [false, false] });
    assert!(serde_json::from_value::<HandCommand<T, 2>>(short).is_err());
}

#[test]
fn what_comes_out_survives_a_file() {
    grips::<f64>();
    grips::<f32>();
    grasps::<f64>();
    grasps::<f32>();
    commands::<f64>();
    commands::<f32>();
}
