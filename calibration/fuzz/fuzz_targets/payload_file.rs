//! Payload files.
#![no_main]

use fingertip_calibration::file::{FileError, PayloadFile};
use libfuzzer_sys::fuzz_target;

/// As in the target `calibration_file`.
fn read(text: &str) -> Option<PayloadFile> {
    match PayloadFile::from_toml(text) {
        Ok(file) => Some(file),
        Err(FileError::WrongChecksum { found, expected }) if !found.is_empty() => {
            PayloadFile::from_toml(&text.replacen(&found, &expected, 1)).ok()
        }
        Err(_) => None,
    }
}

fuzz_target!(|text: &str| {
    let Some(file) = read(text) else { return };
    let numbers = file.centre_of_mass.iter().chain(&file.gravity).chain(&file.force_bias);
    let numbers = numbers.chain(&file.torque_bias).chain(file.sensor_from_flange.as_flattened());
    assert!(numbers.chain([&file.mass]).all(|number| number.is_finite()));
    assert!(file.mass >= 0.0);
    let again = file.to_toml().and_then(|text| PayloadFile::from_toml(&text));
    assert_eq!(again.ok().as_ref(), Some(&file));
    assert!(file.bias().is_finite());
    let _ = (file.payload::<f32>(), file.payload::<f64>());
    let _ = file.gravity_at([0.0, 0.0, 0.0, 1.0]);
});
