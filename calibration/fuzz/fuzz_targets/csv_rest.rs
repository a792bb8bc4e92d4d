//! Readings at rest in CSV, and the zero that they give.
#![no_main]

use fingertip_calibration::file::CalibrationFile;
use fingertip_calibration::loads::signals_from_csv;
use fingertip_calibration::nalgebra::DMatrix;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let Ok(rest) = signals_from_csv(bytes) else { return };
    assert!(rest.signals.iter().chain(rest.temperatures.iter().flatten()).all(|number| number.is_finite()));
    assert!(rest.temperatures.is_none_or(|list| list.len() == rest.signals.nrows()));
    let matrix = DMatrix::identity(rest.signals.ncols(), 3);
    let zero = vec![0.0; rest.signals.ncols()];
    let Ok(file) = CalibrationFile::new(matrix, vec![1.0; 3], zero, rest.unit) else { return };
    if let Ok(tared) = file.tared(bytes, None, false) {
        assert!(tared.file.validate().is_ok());
        assert_eq!(tared.samples, rest.signals.nrows());
        assert!(tared.load_before.iter().chain(&tared.moved).all(|number| number.is_finite()));
    }
});
