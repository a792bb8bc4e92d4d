//! Files: models come back as they were written.
#![cfg(feature = "serde")]

use fingertip_contact::{PointContact, SoftFinger};

#[test]
fn models_survive_a_file() {
    let model = PointContact::new(0.1)
        .and_then(|m| m.with_greatest_gap(0.001))
        .and_then(|m| m.with_greatest_friction(0.8))
        .unwrap();
    let written = toml::to_string(&model).unwrap();
    assert!(written.contains("least_force_N = 0.1"), "{written}");
    assert_eq!(toml::from_str::<PointContact<f64>>(&written).unwrap(), model);
    assert!(toml::from_str::<PointContact<f64>>("least_force_N = -1.0").is_err());
}

#[test]
fn soft_fingers_survive_a_file() {
    let model = SoftFinger::new(0.1).unwrap();
    let stated = model.with_greatest_friction(0.8).and_then(|m| m.with_torque_arm(0.002)).unwrap();
    for model in [model, stated, model.without_friction_limit(), model.with_torque_noise(1e-4).unwrap()] {
        let written = toml::to_string(&model).unwrap();
        assert_eq!(toml::from_str::<SoftFinger<f64>>(&written).unwrap(), model, "{written}");
    }
    // What says nothing of friction has the limit of a new one.
    assert_eq!(toml::from_str::<SoftFinger<f64>>("least_force_N = 0.1").unwrap(), model);
    assert!(toml::from_str::<SoftFinger<f64>>("torque_noise_N_m = -1.0").is_err());
}
