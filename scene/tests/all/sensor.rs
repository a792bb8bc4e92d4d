//! Readings of gauges to wrenches: every number of gauges, zeros, drifts, and what is no reading.

use fingertip::wrench::{Real, Wrench};
use fingertip_calibration::creep::Creep;
use fingertip_calibration::file::{CalibrationFile, SignalUnit, Temperature};
use fingertip_scene::{GAUGES, GaugeReading, NoWrench, Sensor};
use nalgebra::{DMatrix, DVector, Vector6};

pub(crate) const NOMINAL: [f64; 6] = [10.0, 10.0, 10.0, 0.1, 0.1, 0.1];

/// A sensor of so many gauges, well conditioned, with zeros of 0.1 V, 0.2 V and so on.
pub(crate) fn file(gauges: usize) -> CalibrationFile {
    let matrix = DMatrix::from_fn(gauges, 6, |gauge, axis| {
        let same = if gauge % 6 == axis { 2.0 } else { 0.0 };
        same + 0.3 * (1.0 + 1.7 * gauge as f64 + 2.9 * axis as f64).sin()
    });
    let zero = (1..=gauges).map(|gauge| 0.1 * gauge as f64).collect();
    CalibrationFile::new(matrix, NOMINAL.to_vec(), zero, SignalUnit::Volt).unwrap()
}

/// With products of pairs of signals that tell up to a tenth of the load.
fn curved(gauges: usize) -> CalibrationFile {
    let terms = DMatrix::from_fn(6, gauges * (gauges + 1) / 2, |axis, pair| {
        0.01 * (0.3 + 1.9 * axis as f64 + 0.7 * pair as f64).sin()
    });
    CalibrationFile { quadratic: Some(terms), ..file(gauges) }
}

/// What the gauges of a linear sensor read under a load.
pub(crate) fn signals(file: &CalibrationFile, load: &Vector6<f64>) -> Vec<f64> {
    let share = DVector::from_fn(6, |axis, _| load[axis] / NOMINAL[axis]);
    (&file.matrix * share).iter().zip(&file.zero).map(|(signal, zero)| signal + zero).collect()
}

fn sensor(file: &CalibrationFile) -> Sensor<f64> {
    Sensor::new(file).unwrap()
}

fn assert_near<T: Real>(found: &Wrench<T>, expected: &Vector6<f64>, tolerance: f64) {
    for axis in 0..6 {
        let error = (found.components()[axis].to_f64() - expected[axis]).abs() / NOMINAL[axis];
        assert!(error < tolerance, "{error:e} of axis {axis}: {found:?} for {expected}");
    }
}

#[test]
fn six_to_sixteen_gauges_give_the_load_back() {
    let load = Vector6::new(1.0, -2.0, 3.0, 0.04, 0.05, -0.06);
    for gauges in GAUGES {
        let file = file(gauges);
        let reading = signals(&file, &load);
        assert_eq!(sensor(&file).gauges(), gauges);
        assert_near(&sensor(&file).wrench(&GaugeReading::of(&reading), 1e-3).unwrap(), &load, 1e-12);
        let narrow: Vec<f32> = reading.iter().map(|x| *x as f32).collect();
        let mut single = Sensor::<f32>::new(&file).unwrap();
        assert_near(&single.wrench(&GaugeReading::of(&narrow), 1e-3).unwrap(), &load, 1e-5);
    }
    let error = Sensor::<f64>::new(&file(17)).unwrap_err().to_string();
    assert!(error.contains("it has 17 gauges, but this program reads 6 to 16"), "{error}");
}

/// Against the load that the file itself works out, by other code.
#[test]
fn quadratic_terms_are_those_of_the_file() {
    for gauges in GAUGES {
        let file = curved(gauges);
        let reading = signals(&file, &Vector6::new(-3.0, 1.0, -4.0, 0.01, 0.05, -0.09));
        let expected = file.load(&reading).unwrap();
        let expected = Vector6::from_iterator(expected.iter().copied());
        assert_near(&sensor(&file).wrench(&GaugeReading::of(&reading), 1e-3).unwrap(), &expected, 1e-12);
        let straight = sensor(&self::file(gauges)).wrench(&GaugeReading::of(&reading), 1e-3).unwrap();
        assert!((straight.components() - expected).amax() > 1e-3, "the terms tell nothing");
    }
}

#[test]
fn what_is_no_reading_gives_no_wrench() {
    let file = CalibrationFile { range: Some([-3.0, 4.0]), ..file(6) };
    let mut sensor = sensor(&file);
    let mut with = |value: f64| {
        let mut gauges = signals(&file, &Vector6::zeros());
        gauges[4] = value;
        sensor.wrench(&GaugeReading::of(&gauges), 1e-3).map(|_| ())
    };
    assert_eq!((with(3.999), with(-2.999)), (Ok(()), Ok(())));
    // At the end of its range a gauge may read anything.
    for value in [4.0, 4.1, -3.0, -3.1] {
        assert_eq!(with(value), Err(NoWrench::Saturated), "{value}");
    }
    for value in [f64::NAN, f64::INFINITY] {
        assert_eq!(with(value), Err(NoWrench::Incomplete));
    }
    for count in [0, 5, 7] {
        let short = vec![0.0; count];
        assert_eq!(sensor.wrench(&GaugeReading::of(&short), 1e-3).map(|_| ()), Err(NoWrench::Incomplete));
    }
}

/// Something like noise, of 5 mV.
fn noise(i: i32) -> f64 {
    1e-3 * f64::from(i * 37 % 11 - 5)
}

fn mean_noise(count: i32) -> f64 {
    (0..count).map(noise).sum::<f64>() / f64::from(count)
}

#[test]
fn the_mean_of_the_rest_is_the_zero() {
    let file = CalibrationFile { range: Some([-5.0, 5.0]), ..file(7) };
    let mut sensor = sensor(&file);
    let shifted = |load: &Vector6<f64>, shift: f64| -> Vec<f64> {
        signals(&file, load).iter().map(|signal| signal + shift).collect()
    };
    let zero = Vector6::zeros();
    assert!(sensor.end_rest().is_err());
    let load = Vector6::new(1.0, 2.0, -3.0, 0.01, 0.02, 0.03);
    // Zeros that have shifted; the second rest has nothing of the first.
    for shift in [0.25, -0.5] {
        for i in 0..64 {
            let resting = shifted(&zero, shift + noise(i));
            assert_eq!(sensor.rest(&GaugeReading::of(&resting)), Ok(()));
            assert_eq!(sensor.rest(&GaugeReading::of(&[f64::NAN; 7])), Err(NoWrench::Incomplete));
            assert_eq!(sensor.rest(&GaugeReading::of(&[9.0; 7])), Err(NoWrench::Saturated));
        }
        sensor.end_rest().unwrap();
        assert_eq!(sensor.doubt(), None);
        let reading = shifted(&load, shift + mean_noise(64));
        assert_near(&sensor.wrench(&GaugeReading::of(&reading), 1e-3).unwrap(), &load, 1e-12);
    }
    // A rest that was none leaves the zero, and one that moved is doubted.
    assert!(sensor.end_rest().is_err());
    let reading = shifted(&load, -0.5 + mean_noise(64));
    assert_near(&sensor.wrench(&GaugeReading::of(&reading), 1e-3).unwrap(), &load, 1e-12);
    for i in 0..64 {
        let moving = shifted(&zero, noise(i) + 0.01 * f64::from(i));
        sensor.rest(&GaugeReading::of(&moving)).unwrap();
    }
    sensor.end_rest().unwrap();
    let doubt = sensor.doubt().unwrap();
    assert!(doubt.seen.starts_with("gauge ") && doubt.seen.contains(" moved by "), "{doubt}");
}

#[test]
fn the_dummy_gauge_takes_off_what_drifts_with_all() {
    let file = file(6);
    let mut sensor = sensor(&file);
    let at = |load: &Vector6<f64>, drift: f64| -> (Vec<f64>, Option<f64>) {
        (signals(&file, load).iter().map(|signal| signal + drift).collect(), Some(2.0 + drift))
    };
    let load = Vector6::new(1.0, 2.0, -3.0, 0.01, 0.02, 0.03);
    // Without a rest its zero is not known: it is not used.
    let (gauges, dummy) = at(&load, 0.0);
    let plain = GaugeReading { dummy, ..GaugeReading::of(&gauges) };
    assert_near(&sensor.wrench(&plain, 1e-3).unwrap(), &load, 1e-12);
    for i in 0..50 {
        let (gauges, dummy) = at(&Vector6::zeros(), 0.01 * f64::from(i) + noise(i));
        assert_eq!(sensor.rest(&GaugeReading { dummy, ..GaugeReading::of(&gauges) }), Ok(()));
        // Behind the first, none may lack it.
        assert_eq!(sensor.rest(&GaugeReading::of(&gauges)), Err(NoWrench::Incomplete));
        let unknown = GaugeReading { dummy: Some(f64::NAN), ..GaugeReading::of(&gauges) };
        assert_eq!(sensor.rest(&unknown), Err(NoWrench::Incomplete));
    }
    sensor.end_rest().unwrap();
    // The drift that both show is no motion.
    assert_eq!(sensor.doubt(), None);
    let (gauges, dummy) = at(&load, 0.7);
    let reading = GaugeReading { dummy, ..GaugeReading::of(&gauges) };
    assert_near(&sensor.wrench(&reading, 1e-3).unwrap(), &load, 1e-12);
    for dummy in [None, Some(f64::INFINITY)] {
        let lacking = GaugeReading { dummy, ..reading };
        assert_eq!(sensor.wrench(&lacking, 1e-3).map(|_| ()), Err(NoWrench::Incomplete));
    }
    // A rest whose first reading has no dummy gauge goes without.
    for i in 0..50 {
        let (gauges, dummy) = at(&Vector6::zeros(), noise(i));
        let dummy = dummy.filter(|_| i > 0);
        assert_eq!(sensor.rest(&GaugeReading { dummy, ..GaugeReading::of(&gauges) }), Ok(()));
    }
    sensor.end_rest().unwrap();
    let (gauges, _) = at(&load, mean_noise(50));
    assert_near(&sensor.wrench(&GaugeReading::of(&gauges), 1e-3).unwrap(), &load, 1e-12);
}

#[test]
fn drift_with_temperature_is_taken_off_and_a_rest_takes_what_is_left() {
    let temperature = Some(Temperature {
        reference_celsius: 20.0,
        range_celsius: [0.0, 60.0],
        zero_drift: vec![0.01, 0.02, -0.03, 0.004, 0.05, -0.006],
        zero_curvature: vec![1e-4; 6],
        gain_drift: vec![1e-3; 6],
    });
    let file = CalibrationFile { temperature, ..file(6) };
    let mut sensor = sensor(&file);
    let drift = file.temperature.clone().unwrap();
    // As the model of the file has it.
    let at = |load: &Vector6<f64>, celsius: f64, shift: f64| -> Vec<f64> {
        let warmer = celsius - 20.0;
        let cold = signals(&file, load);
        (0..6)
            .map(|i| {
                let zero = file.zero[i] + warmer * (drift.zero_drift[i] + drift.zero_curvature[i] * warmer);
                zero + (cold[i] - file.zero[i] + shift) * (1.0 + drift.gain_drift[i] * warmer)
            })
            .collect()
    };
    let load = Vector6::new(1.0, 2.0, -3.0, 0.01, 0.02, 0.03);
    let gauges = at(&load, 35.0, 0.0);
    let warm = GaugeReading { celsius: Some(35.0), dummy: Some(9.0), ..GaugeReading::of(&gauges) };
    assert_near(&sensor.wrench(&warm, 1e-3).unwrap(), &load, 1e-12);
    for celsius in [None, Some(f64::NAN)] {
        let lacking = GaugeReading { celsius, ..warm };
        assert_eq!(sensor.wrench(&lacking, 1e-3).map(|_| ()), Err(NoWrench::Incomplete));
        assert_eq!(sensor.rest(&lacking), Err(NoWrench::Incomplete));
    }
    for i in 0..60 {
        let celsius = 20.0 + 0.1 * f64::from(i);
        let gauges = at(&Vector6::zeros(), celsius, 0.25 + noise(i));
        let reading = GaugeReading { celsius: Some(celsius), ..GaugeReading::of(&gauges) };
        assert_eq!(sensor.rest(&reading), Ok(()));
    }
    sensor.end_rest().unwrap();
    assert_eq!(sensor.doubt(), None);
    let gauges = at(&load, 45.0, 0.25 + mean_noise(60));
    let reading = GaugeReading { celsius: Some(45.0), ..GaugeReading::of(&gauges) };
    assert_near(&sensor.wrench(&reading, 1e-3).unwrap(), &load, 1e-12);
}

/// Creep is taken off from reading to reading, and a rest begins anew.
fn creep_is_taken_off<T: Real>(tolerance: f64) {
    let mut file = file(7);
    let load = Vector6::new(1.0, -2.0, 3.0, 0.04, 0.05, -0.06);
    let loaded = signals(&file, &load);
    let zero = file.zero.clone();
    file.creep = Some(Creep { times_s: vec![2.0], shares: vec![vec![0.1; 7]] });
    let mut sensor = Sensor::<T>::new(&file).unwrap();
    let of = |readings: &[f64]| readings.iter().map(|reading| T::literal(*reading)).collect::<Vec<T>>();
    let (loaded, unloaded) = (of(&loaded), of(&zero));
    let mut at = |gauges: &[T], step: f64| {
        let wrench = sensor.wrench(&GaugeReading::of(gauges), T::literal(step)).unwrap();
        wrench.components().map(|x| x.to_f64()).dot(&load) / load.norm_squared()
    };
    // At once all of it; in the end less by a share; afterwards the share is left, and goes.
    assert!((at(&loaded, 9.0) - 1.0).abs() < tolerance);
    assert!((at(&loaded, 2.0) - (0.9 + 0.1 * (-1.0_f64).exp())).abs() < tolerance);
    assert!((at(&loaded, 1e3) - 0.9).abs() < tolerance);
    assert!((at(&unloaded, 0.0) + 0.1).abs() < tolerance);
    assert!(at(&unloaded, 1e3).abs() < tolerance);
    at(&loaded, 1e3);
    for _ in 0..10 {
        sensor.rest(&GaugeReading::of(&unloaded)).unwrap();
    }
    sensor.end_rest().unwrap();
    let rested = sensor.wrench(&GaugeReading::of(&unloaded), T::one()).unwrap();
    assert!(rested.components().amax().to_f64() < tolerance);
}

#[test]
fn creep_is_taken_off_in_both_precisions() {
    creep_is_taken_off::<f64>(1e-9);
    creep_is_taken_off::<f32>(2e-4);
}
