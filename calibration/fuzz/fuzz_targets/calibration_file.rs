//! Calibration files.
#![no_main]

use fingertip_calibration::file::{AtiCalibration, CalibrationFile, FileError, Scalar};
use libfuzzer_sys::fuzz_target;

/// Reads a text; one that lacks nothing but the right checksum gets it, as whoever edits a file on purpose
/// writes it.
fn read(text: &str) -> Option<CalibrationFile> {
    match CalibrationFile::from_toml(text) {
        Ok(file) => Some(file),
        Err(FileError::WrongChecksum { found, expected }) if !found.is_empty() => {
            CalibrationFile::from_toml(&text.replacen(&found, &expected, 1)).ok()
        }
        Err(_) => None,
    }
}

fuzz_target!(|text: &str| {
    let Some(file) = read(text) else { return };
    assert!(file.validate().is_ok());
    let numbers = file.matrix.iter().chain(&file.nominal).chain(&file.zero);
    assert!(numbers.chain(file.noise.iter().flatten()).all(|number| number.is_finite()));
    assert!(file.nominal.iter().all(|load| *load > 0.0));
    let again = file.to_toml().and_then(|text| CalibrationFile::from_toml(&text));
    assert_eq!(again.ok().as_ref(), Some(&file));
    let _ = file.load(&file.zero);
    let _ = file.load_at(&file.zero, 25.0);
    let _ = (file.sensor_matrix::<6>(), file.sensor_matrix_in::<f32, 6>());
    let _ = (file.zero::<6>(), file.temperature_compensation::<f32, 6>());
    let _ = (file.to_rust(Scalar::F32), file.to_rust(Scalar::F64));
    if let Ok(ati) = AtiCalibration::from_calibration(&file) {
        let loads = ati.loads_per_volt();
        assert!(loads.is_ok_and(|loads| loads.iter().all(|load| load.is_finite())));
    }
});
