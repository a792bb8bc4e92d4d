//! Tables of a motion, with an inertial unit, and the payload that they tell.
#![no_main]

use fingertip_calibration::inertial::{InertialOptions, fit_inertial, moving_samples};
use fingertip_recordings::RecordingReader;
use libfuzzer_sys::fuzz_target;

/// Rows of a motion that is fitted.
const ROWS: usize = 64;

fuzz_target!(|bytes: &[u8]| {
    let Ok(mut reader) = RecordingReader::new("fuzz.csv", bytes) else { return };
    let Ok((samples, _)) = moving_samples(&mut reader, None, Some(1000.0)) else { return };
    for sample in &samples {
        assert!(sample.time.is_finite() && sample.wrench.iter().all(|number| number.is_finite()));
        let reading = &sample.reading;
        assert!(
            reading.acceleration.iter().chain(&reading.angular_velocity).all(|number| number.is_finite())
        );
    }
    let _ = fit_inertial(&samples, &InertialOptions::default());
    // So few bytes are no motion: the same rows over and over are.
    let mut motion: Vec<_> = samples.iter().cycle().take(ROWS).copied().collect();
    for (index, sample) in motion.iter_mut().enumerate() {
        sample.time = index as f64 * 0.01;
    }
    let options = InertialOptions { longest_delay: 0.02, ..InertialOptions::default() };
    if let Ok(fit) = fit_inertial(&motion, &options)
        && let Ok(file) = fit.to_file()
    {
        assert!(file.mass.is_finite() && file.to_toml().is_ok());
    }
});
