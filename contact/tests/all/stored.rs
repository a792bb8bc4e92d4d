//! Files: models come back as they were written.
#![cfg(feature = "serde")]

use fingertip_contact::PointContact;

#[test]
fn models_survive_a_file() {
    let model = PointContact::new(0.1)
        .and_then(|m| m.accepting_gap(0.001))
        .and_then(|m| m.with_greatest_friction(0.8))
        .unwrap();
    let written = toml::to_string(&model).unwrap();
    assert!(written.contains("least_force_N = 0.1"), "{written}");
    assert_eq!(toml::from_str::<PointContact<f64>>(&written).unwrap(), model);
    assert!(toml::from_str::<PointContact<f64>>("least_force_N = -1.0").is_err());
}
