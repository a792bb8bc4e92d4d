//! ATI's `.cal` files.
#![no_main]

use fingertip_calibration::file::{AtiCalibration, AtiError, CalibrationFile};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    let Ok(ati) = AtiCalibration::from_xml(text) else { return };
    assert_eq!(AtiCalibration::from_xml(&ati.to_xml()).as_ref().ok(), Some(&ati));
    assert!(ati.full_scale().iter().all(|load| *load > 0.0 && load.is_finite()));
    for loads in [ati.loads_per_volt(), ati.transformed_axes()] {
        match loads {
            Ok(loads) => assert!(loads.iter().all(|load| load.is_finite())),
            Err(error) => assert!(matches!(error, AtiError::Turned)),
        }
    }
    if let Ok(file) = ati.to_calibration() {
        let again = file.to_toml().and_then(|text| CalibrationFile::from_toml(&text));
        assert_eq!(again.ok(), Some(file));
    }
});
