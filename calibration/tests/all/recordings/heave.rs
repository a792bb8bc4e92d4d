//! A foil on a wrist sensor, heaved at 1 Hz in air: its mass, and what is left of its inertia.

use fingertip_calibration::file::AtiCalibration;
use fingertip_calibration::inertial::{InertialOptions, MovingSample, fit_inertial};
use fingertip_calibration::nalgebra::{Vector3, Vector6};
use fingertip_test_support::recording;
use fingertip_wrench::InertialReading;

use super::common;

/// Readings to each side of a parabola that tells the acceleration.
const HALF: usize = 25;

/// Second derivative of what is read every millisecond, by the parabola of least squares about each reading
/// (Savitzky & Golay 1964): without delay.
fn acceleration(heave: &[f64]) -> Vec<f64> {
    let offsets: Vec<f64> = (0..=2 * HALF).map(|k| (k as f64 - HALF as f64) * 1e-3).collect();
    let mean = offsets.iter().map(|t| t * t).sum::<f64>() / offsets.len() as f64;
    let weights: Vec<f64> = offsets.iter().map(|t| t * t - mean).collect();
    let size: f64 = offsets.iter().zip(&weights).map(|(t, w)| w * t * t).sum();
    let of = |window: &[f64]| 2.0 * window.iter().zip(&weights).map(|(x, w)| x * w).sum::<f64>() / size;
    heave.windows(2 * HALF + 1).map(of).collect()
}

#[test]
fn little_is_left_of_a_foil_that_is_heaved() {
    let Some(path) = recording("ati_delta_raw_1khz/heave_1hz_after_recal.csv") else { return };
    let text = std::fs::read_to_string(path.with_file_name("FT16810.cal")).unwrap();
    let file = AtiCalibration::from_xml(&text).unwrap().to_calibration().unwrap();
    let loads = file.matrix.clone().try_inverse().unwrap();
    let table = common::csv(&path);
    let volts = common::columns(&table, &["v0", "v1", "v2", "v3", "v4", "v5"]);
    let heave: Vec<f64> = common::column(&table, "heave_mm").iter().map(|x| x * 1e-3).collect();
    // Along x, as the sensor stands; gravity does not turn and is in the zero. The encoder's steps are 3 µm.
    let samples: Vec<MovingSample> = acceleration(&heave)
        .iter()
        .enumerate()
        .map(|(k, acceleration)| {
            let share = &loads * volts.row(k + HALF).transpose();
            MovingSample {
                time: k as f64 * 1e-3,
                wrench: Vector6::from_fn(|i, _| share[i] * file.nominal[i]),
                reading: InertialReading {
                    acceleration: Vector3::new(*acceleration, 0.0, 0.0),
                    angular_velocity: Vector3::zeros(),
                },
            }
        })
        .collect();
    let options =
        InertialOptions { time_constant: 0.02, longest_delay: 0.0, rest: None, ..InertialOptions::default() };
    let fit = fit_inertial(&samples, &options).unwrap();
    println!("{fit:#?}");
    // By the publisher's own model and a filter of 8 Hz to and fro: 1.2010 kg, 4.97 mN left.
    assert!((fit.body.mass - 1.2010).abs() < 0.012, "{}", fit.body.mass);
    // The lever of the force, 91.5 mm.
    assert!((fit.body.centre.z - 0.0915).abs() < 0.003, "{}", fit.body.centre);
    // It never turned.
    let names = ["inertia xx", "inertia yy", "inertia zz"];
    assert!(names.iter().all(|name| fit.undetermined.contains(name)), "{:?}", fit.undetermined);
    // What is left along the motion, beside what is left across it, where nothing moves: less than twice as much.
    let (along, across) = (fit.left[0], fit.left[1]);
    println!("left along the motion {along:.4} N of {:.4} N, across it {across:.4} N", fit.load[0]);
    assert!(along < 2.0 * across && along < 0.06 * fit.load[0], "{along} {across}");
}
