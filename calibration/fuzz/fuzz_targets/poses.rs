//! Tables of poses, and the payload that they tell.
#![no_main]

use fingertip_calibration::gravity::{PayloadOptions, fit_payload, poses_from_csv};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let Ok(poses) = poses_from_csv(bytes) else { return };
    for pose in &poses {
        assert!(pose.wrench.iter().all(|number| number.is_finite()));
        let turned = pose.base_from_sensor;
        assert!((turned.determinant() - 1.0).abs() < 1e-9, "{turned}");
    }
    let Ok(fit) = fit_payload(&poses, &PayloadOptions::default()) else { return };
    if let Ok(file) = fit.to_file(poses.len()) {
        let text = file.to_toml();
        assert!(text.is_ok(), "{text:?}");
    }
});
