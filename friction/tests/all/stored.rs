//! Everything that may stand in a file comes back as it was, and what no constructor takes is
//! refused.

use core::fmt::Debug;

use fingertip_friction::{
    AdaptiveDropDetector, AnisotropicCoulomb, Bristle, Coulomb, Cusum, Dahl, DropDetector, ElastoPlastic,
    ForceNoise, GripController, GripSettings, Implicit, IncipientSlip, KineticFriction, LikelihoodRatio,
    LikelihoodRatioDetector, LoadDependentLimit, LuGre, NormalForceGate, PowerLimit, PressureDistribution,
    RatioThreshold, SlipDetector, SoftFingerLimit, StaticFriction, StickSlipDetector, Stribeck,
    StribeckFriction, UncertainCoulomb,
};
use fingertip_wrench::{ContactForce, Real};
use nalgebra::{SVector, Vector3};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

/// Written and read again.
fn again<V: Serialize + DeserializeOwned>(value: &V) -> V {
    serde_json::from_str(&serde_json::to_string(value).unwrap()).unwrap()
}

/// It comes back, and with any one of its numbers at fault it does not.
fn kept<V: Serialize + DeserializeOwned + PartialEq + Debug>(value: &V) {
    assert_eq!(again(value), *value);
    let json = serde_json::to_value(value).unwrap();
    let mut numbers = Vec::new();
    pointers(&json, "", &mut numbers);
    assert!(!numbers.is_empty());
    for pointer in numbers {
        for bad in [Value::from(-1e9), Value::Null, Value::from("1")] {
            let mut broken = json.clone();
            // No noise, and nothing known, may be null.
            if let Some(place) = broken.pointer_mut(&pointer) {
                *place = bad;
            }
            let read = serde_json::from_value::<V>(broken.clone());
            assert!(read.is_err(), "{pointer}: {broken} gave {read:?}");
        }
    }
    assert!(serde_json::from_str::<V>("{}").is_err());
    let mut misspelt = json;
    misspelt["stifness"] = Value::from(1.0);
    assert!(serde_json::from_value::<V>(misspelt).is_err());
}

fn pointers(json: &Value, path: &str, found: &mut Vec<String>) {
    match json {
        Value::Number(_) => found.push(path.to_owned()),
        Value::Array(items) => {
            for (index, item) in items.iter().enumerate() {
                pointers(item, &format!("{path}/{index}"), found);
            }
        }
        Value::Object(items) => {
            for (name, item) in items {
                pointers(item, &format!("{path}/{name}"), found);
            }
        }
        _ => {}
    }
}

fn limits<T: Real + Serialize + DeserializeOwned>() {
    let l = T::literal;
    kept(&Coulomb::new(l(0.6)).unwrap());
    kept(&AnisotropicCoulomb::new([Vector3::x(), Vector3::y()], [l(0.5), l(0.8)]).unwrap());
    kept(&SoftFingerLimit::new(l(0.6), l(3e-3)).unwrap());
    kept(&PowerLimit::new(l(0.6), l(3e-3), l(1.725)).unwrap());
    kept(&LoadDependentLimit::new(l(0.6), l(3e-3), l(5.0), l(0.33)).unwrap());
    let noise = ForceNoise { normal: l(0.02), tangential: l(0.03) };
    kept(&noise);
    kept(&UncertainCoulomb::new(l(0.6), l(0.05), Some(noise)).unwrap());
    kept(&UncertainCoulomb::new(l(0.6), l(0.05), None).unwrap());
    let settings = GripSettings {
        safety: l(1.5),
        least: l(0.5),
        greatest: l(20.0),
        rise: l(100.0),
        fall: l(2.0),
        slip_boost: l(1.25),
    };
    kept(&GripController::new(settings).unwrap());
}

fn detectors<T: Real + Serialize + DeserializeOwned>() {
    let l = T::literal;
    let noise = ForceNoise { normal: l(0.02), tangential: l(0.03) };
    let gate = NormalForceGate::from_noise(&noise);
    kept(&gate);
    kept(&Cusum::new(l(0.75), l(7.0)).unwrap());
    kept(&RatioThreshold::new(gate, l(0.6)).unwrap().with_warning_share(l(0.9)).unwrap());
    let drops = DropDetector::with_sum(noise, Cusum::new(l(1.0), l(6.1)).unwrap()).unwrap();
    kept(&drops);
    kept(&StickSlipDetector::new(drops));
    kept(&AdaptiveDropDetector::new(noise, 0.5, 1000.0).unwrap());
    kept(&LikelihoodRatio::<T, 16>::with_window(12, l(9.5)).unwrap());
    kept(&LikelihoodRatioDetector::<T, 16>::new(noise, 1.0, 1000.0).unwrap());
    kept(&IncipientSlip::new(gate, l(4e-6)).unwrap().with_warning_share(l(0.65)).unwrap());
    kept(&KineticFriction::new(noise, l(0.5)).unwrap());
    kept(&StaticFriction::<T, 64>::new(noise, l(0.05), l(0.01)).unwrap());
    // A window longer than the room for it.
    let wide = LikelihoodRatio::<T, 32>::new(l(9.5)).unwrap();
    let json = serde_json::to_string(&wide).unwrap();
    assert!(serde_json::from_str::<LikelihoodRatio<T, 16>>(&json).is_err());
}

/// What a detector has seen is not written, what an estimator has learnt of the surface is.
fn states<T: Real + Serialize + DeserializeOwned>() {
    let l = T::literal;
    let noise = ForceNoise::isotropic(l(0.02)).unwrap();
    let fresh = DropDetector::new(noise).unwrap();
    let (mut used, mut friction) = (fresh, StaticFriction::<T, 64>::with_noise(noise).unwrap());
    for index in 0..100 {
        let tangential = Vector3::new(l(0.01 * f64::from(index)), T::zero(), T::zero());
        let force = ContactForce::new(l(4.0), tangential, T::zero());
        used.update(&force, l(1e-3));
        friction.observe(&force);
    }
    assert_ne!(used, fresh);
    assert_eq!(again(&used), fresh);
    friction.onset().unwrap();
    assert_eq!(again(&friction).estimate(), friction.estimate());
    assert!(again(&friction).estimate().is_some());
    // What no onset can have taught is refused: a coefficient out of range, a variance below zero.
    let json: Value = serde_json::from_str(&serde_json::to_string(&friction).unwrap()).unwrap();
    for (place, bad) in [(0, 1e9), (1, -1e-3)] {
        let mut broken = json.clone();
        broken["log_coefficient_and_variance"][place] = bad.into();
        assert!(serde_json::from_value::<StaticFriction<T, 64>>(broken).is_err(), "{place} {bad}");
    }
    let mut sure = json;
    sure["log_coefficient_and_variance"][1] = 0.0.into();
    let sure = serde_json::from_value::<StaticFriction<T, 64>>(sure).unwrap();
    assert_eq!(sure.estimate().unwrap().deviation, T::zero());
}

fn dynamics<T: Real + Serialize + DeserializeOwned>() {
    let l = T::literal;
    let curve = Stribeck::new(l(1.0), l(1.5), l(1e-3)).unwrap();
    kept(&curve);
    let lugre = LuGre::reference().unwrap();
    kept(&lugre);
    kept(&Dahl::new(l(1e5), l(1.0)).unwrap());
    kept(&ElastoPlastic::new(lugre, l(0.5)).unwrap());
    kept(&StribeckFriction::new(l(1e5), l(0.4), curve).unwrap());
    let mut bristle = Bristle::<T, _, 2, Implicit>::with_method(lugre);
    bristle.set_load(l(3.0));
    bristle.step(&SVector::<T, 2>::new(l(1e-3), l(2e-3)), l(1e-3));
    kept(&bristle);
    // With the greatest deflection, and without load.
    for _ in 0..100 {
        bristle.step(&SVector::<T, 2>::new(l(-3e-6), l(4e-6)), l(1.0));
    }
    assert!(bristle.deflection().norm() > l(1.4999e-5));
    kept(&bristle);
    let mut unloaded = bristle;
    unloaded.set_load(T::zero());
    assert_eq!(again(&unloaded), unloaded);
    // A break-away below the kinetic friction, and an elastic share beyond it.
    for (kinetic, share) in [("2.0", "0.5"), ("1.0", "0.7")] {
        let json = format!(
            r#"{{"sliding":{{"stiffness":1e5,"damping":0,"viscous":0,
                "curve":{{"kinetic":{kinetic},"static":1.5,"speed_m_per_s":1e-3}}}},"elastic_share":{share}}}"#
        );
        assert!(serde_json::from_str::<ElastoPlastic<T>>(&json).is_err(), "{json}");
    }
}

#[test]
fn all_that_is_written_is_read() {
    limits::<f64>();
    limits::<f32>();
    detectors::<f64>();
    detectors::<f32>();
    states::<f64>();
    states::<f32>();
    dynamics::<f64>();
    dynamics::<f32>();
    kept(&PressureDistribution::PowerLaw(4.0));
    assert_eq!(again(&PressureDistribution::Hertz), PressureDistribution::Hertz);
}
