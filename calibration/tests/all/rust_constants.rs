//! The exported constants compile and give back the calibration.

use fingertip_calibration::file::{CalibrationFile, FileError, Scalar, SignalUnit, Temperature, Verdict};
use fingertip_calibration::nalgebra::DMatrix;

/// What a module takes of the crate `fingertip`, which stands above this one and compiles such modules in the tests of scenes.
mod facade {
    pub(super) use fingertip_calibration::nalgebra;
    pub(super) use fingertip_wrench as wrench;
}

/// What `to_rust` wrote of [`example`], compiled here.
#[allow(unreachable_pub)]
mod exported {
    use super::facade as fingertip;

    include!("rust_constants/exported.rs");
}

fn example() -> CalibrationFile {
    let matrix = DMatrix::from_fn(7, 6, |i, j| if i == j { 1.5 } else { 0.1 / (1.0 + (i + 2 * j) as f64) });
    let nominal = vec![10.0, 10.0, 20.0, 0.1, 0.1, 0.05];
    let zero = (0..7).map(|i| f64::from(i) * 0.01 - 0.02).collect();
    let mut file = CalibrationFile::new(matrix, nominal, zero, SignalUnit::Volt).unwrap();
    file.temperature = Some(Temperature {
        reference_celsius: 22.0,
        range_celsius: [15.0, 45.0],
        zero_drift: (0..7).map(|i| 1e-3 * f64::from(i)).collect(),
        zero_curvature: vec![1e-5; 7],
        gain_drift: vec![-2e-4; 7],
    });
    file.provenance.serial = "demo\n1".to_owned();
    file.quality.verdict = Verdict::Bad;
    file.quality.reasons = vec!["made up".to_owned()];
    file
}

#[test]
fn text_is_what_is_compiled() {
    let text = example().to_rust(Scalar::F32).unwrap();
    assert_eq!(
        text,
        include_str!("rust_constants/exported.rs"),
        "write this to tests/all/rust_constants/exported.rs"
    );
    assert!(text.contains("Quality: BAD") && text.contains("made up"));
}

#[test]
fn constants_are_the_nearest_numbers() {
    let expected = example().sensor_matrix_in::<f32, 7>().unwrap();
    assert_eq!(exported::sensor_matrix().unwrap(), expected);
    assert_eq!(exported::ZERO.map(f64::from)[6], f64::from(0.04_f32));
    assert_eq!(exported::GAUGES, 7);
    let expected = example().temperature_compensation::<f32, 7>().unwrap().unwrap();
    assert_eq!(exported::temperature_compensation().unwrap(), expected);
}

#[test]
fn what_f32_cannot_hold_is_named() {
    let mut file = example();
    file.matrix[(2, 3)] = 1e200;
    let error = file.to_rust(Scalar::F32).unwrap_err();
    assert!(matches!(&error, FileError::OutOfRange { field, .. } if field == "matrix[2][3]"), "{error}");
    assert!(file.to_rust(Scalar::F64).is_ok());
}
