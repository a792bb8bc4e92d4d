//! What is plain data survives a file, and a file cannot smuggle in what a constructor refuses.
#![cfg(feature = "serde")]

use core::fmt::Debug;

use fingertip_wrench::gauge_layout::{Gauge, GaugeLayout, ThinWalledBeam};
use fingertip_wrench::{
    ChannelLimits, Conditioning, ContactForce, DummyGauge, InertialUnit, Payload, RigidTransform, Sensor,
    SensorMatrix, Tare, TemperatureCompensation, Uncertainty, Wrench,
};
use nalgebra::{Matrix3, Matrix6, SVector, Vector3, Vector6};
use serde_json::{from_str, to_string};

fn survives<V: serde::Serialize + serde::de::DeserializeOwned + PartialEq + Debug>(value: &V) {
    let text = to_string(value).expect("writable");
    assert_eq!(&from_str::<V>(&text).expect("readable"), value, "{text}");
}

fn beam() -> ThinWalledBeam<f64> {
    ThinWalledBeam { radius: 5e-3, thickness: 2e-4, youngs_modulus: 70e9, poisson_ratio: 0.33 }
}

fn sensor() -> SensorMatrix<f64, 6> {
    SensorMatrix::new(
        Matrix6::from_fn(|i, j| if i == j { 2.0 } else { 0.1 * i as f64 }),
        Vector6::repeat(10.0),
    )
    .expect("proper")
}

#[test]
fn plain_data_survives() {
    let sensor = sensor();
    survives(&sensor);
    survives(&Conditioning::of(&sensor));
    survives(&Uncertainty::of_signals(Vector6::repeat(0.25)).with_relative_matrix_error(&sensor, 0.01));
    survives(&Wrench::<f64>::from_components(&Vector6::new(1.0, 2.0, 3.0, 4.0, 5.0, 6.0)));
    survives(&ContactForce::split(&Vector3::new(1.0_f32, 0.5, -2.0), &Vector3::z(), 0.25));
    let turned = Vector3::new(0.1, 0.2, -0.3);
    survives(&RigidTransform::<f64, Sensor, Sensor>::from_axis_angle(turned, Vector3::x()).expect("finite"));
    survives(&Tare::new(Vector6::repeat(0.125_f32)));
    survives(&DummyGauge::new(Tare::new(Vector6::repeat(0.125)), 0.5).with_ratios(Vector6::repeat(0.9)));
    survives(&ChannelLimits::new(-1.0, 1.0).expect("a range"));
    let tip = Payload::new(0.02, Vector3::new(0.015, 0.0, 0.0)).expect("a mass");
    survives(&tip);
    survives(&tip.with_inertia(Matrix3::identity() * 1e-6).expect("an inertia"));
    let unit = InertialUnit::new(Matrix3::identity(), Vector3::new(0.01, 0.0, -0.02)).expect("a unit");
    survives(&unit);
    survives(&unit.with_resting_rate(Vector3::new(0.0, 0.001, 0.0)).expect("a rate"));
    let coefficients = [SVector::<f64, 6>::repeat(0.5), SVector::repeat(1e-3)];
    let none = [SVector::zeros(); 2];
    survives(&TemperatureCompensation::new(20.0, (0.0, 60.0), coefficients, none).expect("a model"));
    survives(&beam());
    let force = ContactForce::new(2.0, Vector3::new(3.0, 4.0, 0.0), 1e-3);
    survives(&force);
    let text = to_string(&force).expect("writable");
    assert_eq!(text, r#"{"normal":2.0,"tangential":[3.0,4.0,0.0],"spin":0.001}"#);
    survives(&Gauge { z: 0.01, theta: 0.5, q: -0.25 });
    survives(&GaugeLayout::new(&beam(), GaugeLayout::four_rosettes(0.35)).expect("a beam"));
}

#[test]
fn what_a_constructor_refuses_a_file_cannot_bring_in() {
    let refused = |text: String, from: &str, to: &str| {
        let changed = text.replacen(from, to, 1);
        assert_ne!(changed, text);
        changed
    };
    let dead = refused(to_string(&sensor()).expect("writable"), "10.0", "-10.0");
    assert!(from_str::<SensorMatrix<f64, 6>>(&dead).is_err());
    let payload = to_string(&Payload::new(0.02, Vector3::x()).expect("a mass")).expect("writable");
    assert!(from_str::<Payload<f64>>(&refused(payload.clone(), "0.02", "-0.02")).is_err());
    let unit = to_string(&InertialUnit::<f64>::at_the_origin()).expect("writable");
    assert!(from_str::<InertialUnit<f64>>(&refused(unit, "1.0", "-1.0")).is_err());
    // What is misspelt must not be passed over.
    let misspelt = refused(payload, "{", r#"{"gravitation":1,"#);
    assert!(from_str::<Payload<f64>>(&misspelt).unwrap_err().to_string().contains("`gravitation`"));
    let limits = ChannelLimits::new(-1.0, 1.0).expect("a range");
    let limits = refused(to_string(&limits).expect("writable"), "-1.0", "3.0");
    assert!(from_str::<ChannelLimits<f64>>(&limits).is_err());
    let none = [SVector::<f64, 1>::zeros(); 1];
    let model = TemperatureCompensation::new(20.0, (0.0, 60.0), none, none).expect("a model");
    let model = refused(to_string(&model).expect("writable"), "60.0", "10.0");
    assert!(from_str::<TemperatureCompensation<f64, 1, 1>>(&model).is_err());
    // One gauge too few.
    let layout = GaugeLayout::new(&beam(), GaugeLayout::three_rosettes(0.35)).expect("a beam");
    let text = to_string(&layout).expect("writable");
    assert!(from_str::<GaugeLayout<f64, 8>>(&text).is_err());
}
