//! Readings through calibrations of every number of gauges, and what is said of them.
#![cfg(test)]

use std::fs;
use std::path::{Path, PathBuf};

use fingertip_calibration::file::{CalibrationFile, Quality, Temperature, Verdict};
use nalgebra::DMatrix;

use super::{Calibration, Readings, SignalUnit};
use fingertip_scene::Sensor;

const NOMINAL: [f64; 6] = [10.0, 10.0, 10.0, 0.1, 0.1, 0.1];

const READINGS: Readings =
    Readings { unit: SignalUnit::Volt, has_dummy: false, has_rest: false, has_temperature: false };

/// A sensor of so many gauges, well conditioned, with zeros of 0.1 V, 0.2 V and so on.
fn file(gauges: usize) -> CalibrationFile {
    let matrix = DMatrix::from_fn(gauges, 6, |gauge, axis| {
        let same = if gauge % 6 == axis { 2.0 } else { 0.0 };
        same + 0.3 * (1.0 + 1.7 * gauge as f64 + 2.9 * axis as f64).sin()
    });
    let zero = (1..=gauges).map(|gauge| 0.1 * gauge as f64).collect();
    CalibrationFile::new(matrix, NOMINAL.to_vec(), zero, SignalUnit::Volt).unwrap()
}

/// Written to a file and read from it, which is removed.
fn read(file: &CalibrationFile, readings: &Readings) -> (Result<Sensor<f64>, String>, Vec<String>) {
    static NUMBER: core::sync::atomic::AtomicU32 = core::sync::atomic::AtomicU32::new(0);
    let number = NUMBER.fetch_add(1, core::sync::atomic::Ordering::Relaxed);
    let path: PathBuf =
        std::env::temp_dir().join(format!("fingertip-calibrated-{}-{number}.toml", std::process::id()));
    file.write(&path).unwrap();
    let mut notes = Vec::new();
    let calibration = Calibration::read(&path).unwrap();
    assert_eq!(calibration.gauges(), file.gauges());
    let calibrated = calibration.of(readings, &mut notes).map_err(|error| error.to_string());
    fs::remove_file(&path).unwrap();
    (calibrated, notes)
}

#[test]
fn what_is_to_be_minded_is_noted_and_what_does_not_fit_is_refused() {
    for (verdict, noted) in
        [(Verdict::Good, false), (Verdict::Unchecked, true), (Verdict::Suspect, true), (Verdict::Bad, true)]
    {
        let quality = Quality { verdict, reasons: vec!["one".into(), "two".into()], ..Quality::default() };
        let (_, notes) = read(&CalibrationFile { quality, ..file(6) }, &READINGS);
        assert_eq!(!notes.is_empty(), noted, "{notes:?}");
        let word = verdict.name();
        let said = [format!("the calibration calls itself {word}: one; two")];
        let known =
            notes.is_empty() || notes == said || (verdict == Verdict::Unchecked && notes == ["one", "two"]);
        assert!(known, "{notes:?}");
    }
    // A rest gives the zero that a design lacks, and nothing else of what it lacks.
    let reasons = vec!["a design".to_owned(), "its zero is not known: tare before use".to_owned()];
    let design = Quality { verdict: Verdict::Unchecked, reasons: reasons.clone(), ..Quality::default() };
    let design = CalibrationFile { quality: design, ..file(6) };
    assert_eq!(read(&design, &READINGS).1, reasons);
    assert_eq!(read(&design, &Readings { has_rest: true, ..READINGS }).1, ["a design"]);
    let (_, notes) = read(&file(6), &Readings { has_temperature: true, ..READINGS });
    assert_eq!(notes, ["the temperature is known, but the calibration has no terms for it"]);
    for (unit, fits) in [
        (SignalUnit::Volt, [true, false]),
        (SignalUnit::Count, [false, true]),
        (SignalUnit::Unstated, [true, true]),
    ] {
        for (calibrated, fits) in [SignalUnit::Volt, SignalUnit::Count].into_iter().zip(fits) {
            let file = CalibrationFile { signal_unit: calibrated, ..file(6) };
            let found = read(&file, &Readings { unit, ..READINGS }).0;
            assert_eq!(found.is_ok(), fits, "{unit:?} {calibrated:?}");
            assert!(found.err().is_none_or(|error| error.contains("it is for signals in")));
        }
    }
    assert!(Calibration::read(Path::new("/no/such.toml")).is_err());
}

/// A calibration with terms for the temperature takes its drift from these.
#[test]
fn the_dummy_gauge_is_not_used_beside_temperature_terms() {
    let temperature = Some(Temperature {
        reference_celsius: 20.0,
        range_celsius: [10.0, 30.0],
        zero_drift: vec![0.01; 6],
        zero_curvature: vec![0.0; 6],
        gain_drift: vec![0.0; 6],
    });
    let warm = CalibrationFile { temperature, ..file(6) };
    let readings = Readings { has_dummy: true, has_rest: true, has_temperature: true, ..READINGS };
    let (calibrated, notes) = read(&warm, &readings);
    assert!(calibrated.is_ok());
    assert_eq!(notes, ["the dummy gauge is not used: the temperature terms of the calibration are"]);
    let (calibrated, notes) = read(&warm, &Readings { has_dummy: false, ..readings });
    assert!(calibrated.is_ok() && notes.is_empty(), "{notes:?}");
    let error = read(&warm, &Readings { has_temperature: false, ..readings }).0.err().unwrap();
    assert!(error.contains("reference 20 °C") && error.contains("--celsius"), "{error}");
}
