//! Curved sensors: what the pipeline believes, and exported modules.

use fingertip::contact::{NoContact, Resolution};
use fingertip_calibration::curve::Region;
use fingertip_calibration::file::{CalibrationFile, Curve};
use fingertip_scene::{GaugeReading, NoWrench, Scene, Sensor};
use nalgebra::{DMatrix, SVector};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use crate::calibrated_spread::calibrated;
use crate::export::example;
use crate::export_beside::{SKINNED, calibration};
use crate::exported;

/// All squares, some cubes and bumps on top of six gauges or eight, whose readings were within 3 V.
pub(crate) fn curved(gauges: usize) -> CalibrationFile {
    let mut file = calibration(gauges);
    file.temperature = None;
    let wave = |i: usize, j: usize| ((3 * i + 7 * j) as f64).sin();
    if gauges == 6 {
        file.quadratic = Some(DMatrix::from_fn(6, 21, |i, j| 0.01 * wave(i, j)));
    }
    file.curve = Some(Curve {
        products: vec![vec![0, 0, 1], vec![2, 3], vec![5, 5, 5]],
        widths: vec![4.0; gauges],
        centres: vec![vec![0.5; gauges], vec![-1.0; gauges]],
        loads: DMatrix::from_fn(6, 5, |i, j| 0.02 * wave(j, i)),
    });
    let mut random = Pcg64Mcg::seed_from_u64(77);
    let signals = DMatrix::from_fn(200, gauges, |_, _| random.random_range(-3.0..3.0));
    file.region = Region::of(&signals);
    file
}

/// Readings within and beyond the region.
fn readings<const N: usize>(file: &CalibrationFile) -> Vec<[f64; N]> {
    let mut random = Pcg64Mcg::seed_from_u64(78);
    let reach = |k: usize| 0.2 + 0.03 * k as f64;
    (0..200)
        .map(|k| core::array::from_fn(|i| file.zero[i] + reach(k) * random.random_range(-1.0..1.0)))
        .collect()
}

/// An exported module gives the wrench and the contact of the pipeline, bit for bit; where the pipeline refuses a reading, no
/// contact.
#[test]
fn exported_modules_give_the_bits_of_the_pipeline() {
    let (file, mut refused) = (curved(6), 0);
    let scene = Scene::from_text(SKINNED).unwrap();
    let mut pipeline = calibrated(SKINNED, &file).pipeline();
    let (mut tip, mut last) = (exported::skinned_curved::tip().unwrap(), None);
    for reading in readings::<6>(&file) {
        let felt = pipeline.sense_reading(&GaugeReading::of(&reading), None, 1e-3);
        let touch = tip.sense(&SVector::from(reading), fingertip::Step::of(1e-3).with_last(last));
        last = touch.point();
        match felt {
            Ok(felt) => {
                assert_eq!((felt.touch.wrench, felt.touch.resolution), (touch.wrench, touch.resolution))
            }
            Err(why) => {
                assert_eq!(why, NoWrench::Uncalibrated);
                assert_eq!(touch.resolution, Resolution::NoContact(NoContact::NotFinite));
                refused += 1;
            }
        }
    }
    assert!((20..180).contains(&refused), "{refused}");
    assert!(scene.to_rust(fingertip_scene::Scalar::F32, Some(&file)).is_ok());

    let (file, mut refused) = (curved(8), 0);
    let mut sensor = Sensor::<f32>::new(&file).unwrap();
    let mut tip = exported::plane_curved_f32::tip().unwrap();
    for reading in readings::<8>(&file) {
        let reading = reading.map(|x| x as f32);
        let touch = tip.sense(&SVector::from(reading), 1e-3);
        match sensor.wrench(&GaugeReading::of(&reading), 1e-3) {
            Ok(wrench) => assert_eq!(wrench, touch.wrench),
            Err(why) => {
                assert_eq!(why, NoWrench::Uncalibrated);
                assert!(!touch.wrench.is_finite());
                refused += 1;
            }
        }
    }
    assert!((20..180).contains(&refused), "{refused}");
    assert!(example("plane").to_c(fingertip_scene::Scalar::F32, Some(&file), "tip").is_ok());
}

/// A new zero moves the region along: what counts is the signal, not the reading.
#[test]
fn a_new_zero_moves_the_region() {
    let file = curved(6);
    let mut sensor = Sensor::<f64>::new(&file).unwrap();
    let far: Vec<f64> = file.zero.iter().map(|zero| zero + 5.0).collect();
    assert_eq!(sensor.wrench(&GaugeReading::of(&far), 1e-3), Err(NoWrench::Uncalibrated));
    for _ in 0..20 {
        sensor.rest(&GaugeReading::of(&far)).unwrap();
    }
    sensor.end_rest().unwrap();
    assert!(sensor.wrench(&GaugeReading::of(&far), 1e-3).unwrap().components().amax() < 1e-12);
    // Without a region nothing is refused.
    let everywhere = CalibrationFile { region: None, ..file };
    assert!(Sensor::<f64>::new(&everywhere).unwrap().wrench(&GaugeReading::of(&far), 1e-3).is_ok());
}
