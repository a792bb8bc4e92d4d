//! Files of a gauge layout.
#![no_main]

use fingertip_calibration::design::LayoutFile;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    let Ok(file) = LayoutFile::from_toml(text) else { return };
    let again = file.to_toml().and_then(|text| LayoutFile::from_toml(&text));
    assert_eq!(again.as_ref().ok(), Some(&file));
    let layout = file.layout();
    let places = layout.gauges.iter().flat_map(|gauge| [gauge.z, gauge.theta, gauge.q]);
    assert!(places.chain([layout.beam.radius, layout.beam.thickness]).all(f64::is_finite));
    // What is a layout is a sensor, as good as the numbers of its file.
    let matrix = layout.normalised(file.excitation.gain(), &file.loads);
    assert!(matrix.is_ok_and(|matrix| matrix.iter().all(|signal| signal.is_finite())));
    assert!(file.predicted_calibration().is_ok_and(|predicted| predicted.validate().is_ok()));
    assert!(file.find_decoupling().is_ok());
    let _ = (file.sensor_matrix::<6>(), file.gauge_layout::<6>(), layout.closest_gauges());
});
