//! Readings through calibrations of every number of gauges, and what is said of them.
#![cfg(test)]

use std::fs;
use std::path::{Path, PathBuf};

use fingertip::wrench::{Wrench, WrenchSolver as _};
use fingertip_calibration::file::{CalibrationFile, Quality, Temperature, Verdict};
use nalgebra::{DMatrix, DVector, Vector6};

use super::{Calibrated, Calibration, GaugeReading, MOST_GAUGES, Readings, SignalUnit};
use crate::observe::Status;

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

/// What the gauges read under a load.
fn signals(file: &CalibrationFile, load: &Vector6<f64>) -> Vec<f64> {
    let share = DVector::from_fn(6, |axis, _| load[axis] / NOMINAL[axis]);
    (&file.matrix * share).iter().zip(&file.zero).map(|(signal, zero)| signal + zero).collect()
}

/// Written to a file and read from it, which is removed.
fn read(file: &CalibrationFile, readings: &Readings) -> (Result<Box<dyn Calibrated>, String>, Vec<String>) {
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

fn reading(gauges: &[f64]) -> GaugeReading<'_> {
    GaugeReading { gauges, dummy: None, celsius: None }
}

fn assert_near(found: &Wrench<f64>, expected: &Vector6<f64>) {
    for axis in 0..6 {
        assert!((found.components()[axis] - expected[axis]).abs() < 1e-12 * NOMINAL[axis], "{found:?}");
    }
}

#[test]
fn six_to_sixteen_gauges_give_the_load_back() {
    let load = Vector6::new(1.0, -2.0, 3.0, 0.04, 0.05, -0.06);
    for gauges in 6..=MOST_GAUGES {
        let file = file(gauges);
        let (calibrated, notes) = read(&file, &READINGS);
        let wrench = calibrated.unwrap().wrench(&reading(&signals(&file, &load))).unwrap();
        assert_near(&wrench, &load);
        assert!(notes.is_empty(), "{notes:?}");
    }
    let error = read(&file(17), &READINGS).0.err().unwrap();
    assert!(error.contains("it has 17 gauges, but this program reads 6 to 16"), "{error}");
    // The exact solver and least squares agree where there is nothing to choose.
    let file = file(6);
    let exact = fingertip::wrench::LeastSquares::new(&file.sensor_matrix::<6>().unwrap()).unwrap();
    let less = DVector::from_vec(signals(&file, &load)) - DVector::from_vec(file.zero.clone());
    assert_near(&exact.solve(&less.fixed_rows::<6>(0).into()), &load);
}

#[test]
fn what_is_no_reading_gives_no_wrench() {
    let file = CalibrationFile { range: Some([-3.0, 4.0]), ..file(6) };
    let calibrated = read(&file, &READINGS).0.unwrap();
    let with = |value: f64| {
        let mut gauges = signals(&file, &Vector6::zeros());
        gauges[4] = value;
        calibrated.wrench(&reading(&gauges)).map(|_| ())
    };
    assert_eq!((with(3.999), with(-2.999)), (Ok(()), Ok(())));
    // At the end of its range a gauge may read anything.
    for value in [4.0, 4.1, -3.0, -3.1] {
        assert_eq!(with(value), Err(Status::Saturated), "{value}");
    }
    for value in [f64::NAN, f64::INFINITY] {
        assert_eq!(with(value), Err(Status::UnusableRow));
    }
    assert_eq!(calibrated.wrench(&reading(&[0.0; 5])).map(|_| ()), Err(Status::UnusableRow));
}

#[test]
fn the_mean_of_the_rest_is_the_zero() {
    let file = CalibrationFile { range: Some([-5.0, 5.0]), ..file(7) };
    let mut calibrated = read(&file, &Readings { has_rest: true, ..READINGS }).0.unwrap();
    let shifted = |load: &Vector6<f64>, shift: f64| -> Vec<f64> {
        signals(&file, load).iter().map(|signal| signal + shift).collect()
    };
    let zero = Vector6::zeros();
    assert!(calibrated.end_rest().is_err());
    for i in 0..64 {
        // A zero that has shifted by 0.25 V, with something like noise.
        let noise = 1e-3 * f64::from(i * 37 % 11 - 5);
        assert_eq!(calibrated.rest(&reading(&shifted(&zero, 0.25 + noise))), Status::Rest);
        assert_eq!(calibrated.rest(&reading(&[f64::NAN; 7])), Status::UnusableRow);
        assert_eq!(calibrated.rest(&reading(&[9.0; 7])), Status::Saturated);
    }
    calibrated.end_rest().unwrap();
    assert_eq!(calibrated.doubt(), None);
    let load = Vector6::new(1.0, 2.0, -3.0, 0.01, 0.02, 0.03);
    let noise = (0..64).map(|i| 1e-3 * f64::from(i * 37 % 11 - 5)).sum::<f64>() / 64.0;
    assert_near(&calibrated.wrench(&reading(&shifted(&load, 0.25 + noise))).unwrap(), &load);
}

#[test]
fn the_dummy_gauge_takes_off_what_drifts_with_all() {
    let readings = Readings { has_dummy: true, has_rest: true, ..READINGS };
    let (calibrated, notes) = read(&file(6), &readings);
    let mut calibrated = calibrated.unwrap();
    assert!(notes.is_empty(), "{notes:?}");
    let at = |load: &Vector6<f64>, drift: f64| -> (Vec<f64>, Option<f64>) {
        (signals(&file(6), load).iter().map(|signal| signal + drift).collect(), Some(2.0 + drift))
    };
    let none = reading(&[0.0; 6]);
    assert_eq!(
        (calibrated.rest(&none), calibrated.wrench(&none).map(|_| ())),
        (Status::UnusableRow, Err(Status::UnusableRow))
    );
    for i in 0..50 {
        let (gauges, dummy) = at(&Vector6::zeros(), 0.01 * f64::from(i % 5));
        assert_eq!(calibrated.rest(&GaugeReading { dummy, ..reading(&gauges) }), Status::Rest);
    }
    calibrated.end_rest().unwrap();
    let load = Vector6::new(1.0, 2.0, -3.0, 0.01, 0.02, 0.03);
    let (gauges, dummy) = at(&load, 0.7);
    assert_near(&calibrated.wrench(&GaugeReading { dummy, ..reading(&gauges) }).unwrap(), &load);
    let infinite = GaugeReading { dummy: Some(f64::INFINITY), ..reading(&gauges) };
    assert_eq!(calibrated.wrench(&infinite).map(|_| ()), Err(Status::UnusableRow));
    // Without a rest its zero is not known: it is not used, and that is said.
    let (calibrated, notes) = read(&file(6), &Readings { has_rest: false, ..readings });
    assert!(notes.len() == 1 && notes[0].contains("that needs a rest, rest_s"), "{notes:?}");
    assert_near(&calibrated.unwrap().wrench(&reading(&signals(&file(6), &load))).unwrap(), &load);
}

#[test]
fn what_is_to_be_minded_is_noted_and_what_does_not_fit_is_refused() {
    for (verdict, noted) in
        [(Verdict::Good, false), (Verdict::Unchecked, false), (Verdict::Suspect, true), (Verdict::Bad, true)]
    {
        let quality = Quality { verdict, reasons: vec!["one".into(), "two".into()], ..Quality::default() };
        let (_, notes) = read(&CalibrationFile { quality, ..file(6) }, &READINGS);
        assert_eq!(!notes.is_empty(), noted, "{notes:?}");
        let word = verdict.name();
        assert!(notes.iter().all(|note| *note == format!("the calibration calls itself {word}: one; two")));
    }
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
