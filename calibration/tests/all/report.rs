//! The report in its three forms, on a sensor made for the purpose.

use super::testing::Largest as _;
use fingertip_calibration::Axis;
use fingertip_calibration::calibrate;
use fingertip_calibration::design::{DesignTouch, TouchSet};
use fingertip_calibration::file::{SignalUnit, Verdict};
use fingertip_calibration::loads::LoadTable;
use fingertip_calibration::model::{CalibrationError, Curvature, Direction, Method, Options};
use fingertip_calibration::nalgebra::DMatrix;
use fingertip_calibration::report::{Mistake, Report};
use fingertip_test_support::Worst;
use rand::{RngExt as _, SeedableRng as _};

/// Up and down each axis twice, with a known hysteresis of 0.01 and a creep of 0.002 nominal loads.
fn table() -> LoadTable {
    let (mut loads, mut signals, mut groups, mut times) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let mut push = |axis: usize, load: f64, extra: f64| {
        let mut row = [0.0; 6];
        row[axis] = load;
        loads.extend(row);
        // Gauge i reads axis i, with a tenth of its neighbour's.
        let mut read = row;
        read[axis] += extra;
        signals.extend((0..6).map(|i| 2.0 * read[i] + 0.2 * read[(i + 1) % 6]));
        groups.push(axis);
        times.push(times.len() as f64);
    };
    for axis in 0..6 {
        for sign in [1.0, -1.0] {
            push(axis, 0.0, 0.0);
            push(axis, 0.5 * sign, 0.0);
            push(axis, sign, 0.0);
            push(axis, sign, 0.002);
            push(axis, 0.5 * sign, 0.01);
            push(axis, 0.0, 0.001);
        }
    }
    let samples = groups.len();
    let loads = DMatrix::from_row_slice(samples, 6, &loads);
    let signals = DMatrix::from_row_slice(samples, 6, &signals);
    let mut table = LoadTable::new(&Axis::ALL, loads, signals, SignalUnit::Volt).unwrap();
    table.groups = groups;
    table.times = Some(times);
    table
}

#[test]
fn made_up_faults_are_measured() {
    let report = calibrate(&table(), &Options::default()).unwrap().report;
    for axis in &report.axes {
        let close = |value: Option<f64>, expected: f64| {
            assert!(
                (value.unwrap() - expected).abs() < 0.02 * expected + 0.02,
                "{}: {value:?} {expected}",
                axis.axis
            );
        };
        close(axis.hysteresis_percent, 1.0);
        close(axis.zero_return_percent, 0.1);
        close(axis.creep_percent, 0.2);
        assert!(axis.repeatability_percent.unwrap() > 0.2 && axis.linearity_percent.unwrap() > 0.3);
        assert!(axis.left_out_percent.unwrap() < 1.0);
    }
    assert!(report.cross_talk_percent[0][1].unwrap() < 0.2);
    assert_eq!(report.verdict, Verdict::Good, "{report}");
}

/// Touches that are asked about are judged.
#[test]
fn touches_are_judged_where_they_are_asked_about() {
    let touches = DesignTouch::on_sphere(0.01, 1.2, 0.3, 5.0).unwrap();
    let set = TouchSet { surface: "a sphere".to_owned(), touches };
    assert!(calibrate(&table(), &Options::default()).unwrap().report.contacts.is_none());
    let options = Options { touches: Some(set.clone()), ..Options::default() };
    let calibration = calibrate(&table(), &options).unwrap();
    let found = calibration.report.contacts.unwrap();
    assert_eq!((found.touches, found.surface.as_str()), (set.touches.len(), "a sphere"));
    assert!(found.calibration_mm > 0.0 && found.together_mm > found.reading_mm, "{found:?}");
}

#[test]
fn three_forms_say_the_same() {
    let calibration = calibrate(&table(), &Options { method: Method::Huber, ..Options::default() }).unwrap();
    let report = &calibration.report;
    let text = report.to_string();
    assert!(text.contains("GOOD") && text.contains("Huber") && text.contains("hysteresis"));
    let json: serde_json::Value = serde_json::from_str(&report.to_json().unwrap()).unwrap();
    assert_eq!(json["verdict"], "good");
    assert_eq!(json["axes"][2]["rms_percent"].as_f64().unwrap(), report.axes[2].rms_percent);
    assert_eq!(json["details"].as_array().unwrap().len(), 72);
    let html = report.to_html("Tip <7>", &[("serial", "A <1>".to_owned()), ("date", String::new())]);
    assert!(html.contains("A &lt;1&gt;") && !html.contains(">date<"), "{html}");
    assert!(html.contains("Tip &lt;7&gt;") && html.matches("<script>").count() == 1);
    assert_eq!(html.matches("<svg viewBox").count(), 12);
}

#[test]
fn exchanged_axes_units_and_gauges_are_suspected() {
    let table = table();
    let file = calibrate(&table, &Options::default()).unwrap().to_file().unwrap();
    let limits = Options::default().limits;
    let check = |table: &LoadTable| Report::of_check(&file, table, &limits, None).unwrap();
    assert!(check(&table).suspicions.is_empty());
    let mut wrong = table.clone();
    wrong.loads.swap_columns(0, 1);
    let found = &check(&wrong).suspicions[0];
    let Mistake::Axes { reads } = &found.mistake else { panic!("{found}") };
    assert_eq!(reads[..3], [(Axis::Fy, false), (Axis::Fx, false), (Axis::Fz, false)]);
    // The figures are those of all axes together, as they are and as they would be.
    let overall = |report: &Report| {
        let squares: f64 = report.axes.iter().map(|axis| axis.rms_percent.powi(2)).sum();
        (squares / report.axes.len() as f64).sqrt()
    };
    assert!((found.before_percent / overall(&check(&wrong)) - 1.0).abs() < 1e-9 && !found.outliers_aside);
    assert!((found.after_percent / overall(&check(&table)) - 1.0).abs() < 1e-9);
    wrong = table.clone();
    wrong.loads.column_mut(2).neg_mut();
    assert!(check(&wrong).suspicions[0].to_string().contains("−Fz"));
    wrong = table.clone();
    wrong.loads.columns_mut(3, 3).scale_mut(1000.0);
    let report = check(&wrong);
    assert!(report.suspicions[0].to_string().contains("milli"), "{report}");
    assert_eq!(report.verdict, Verdict::Bad);
    wrong = table.clone();
    wrong.signals.swap_columns(1, 4);
    assert_eq!(check(&wrong).suspicions[0].mistake, Mistake::Gauges { first: 2, second: 5 });
    // Of a sensor whose nominal loads are none of them 1, too.
    let mut strong = table;
    for (mut column, size) in strong.loads.column_iter_mut().zip([40.0, 50.0, 120.0, 0.4, 0.5, 0.3]) {
        column *= size;
    }
    let file = calibrate(&strong, &Options::default()).unwrap().to_file().unwrap();
    strong.signals.swap_columns(1, 4);
    let found = &Report::of_check(&file, &strong, &limits, None).unwrap().suspicions[0];
    assert_eq!(found.mistake, Mistake::Gauges { first: 2, second: 5 });
    assert!(found.after_percent < 0.5, "{found}");
}

/// Of a table of many samples, which repeat themselves, mistakes are suspected and outliers found as of a small one.
#[test]
fn of_many_samples_the_same_is_said() {
    let small = table();
    let file = calibrate(&small, &Options::default()).unwrap().to_file().unwrap();
    let limits = Options::default().limits;
    let repeated = |matrix: &DMatrix<f64>| DMatrix::from_fn(72 * 500, 6, |i, j| matrix[(i % 72, j)]);
    let large = |table: &LoadTable| {
        LoadTable::new(&Axis::ALL, repeated(&table.loads), repeated(&table.signals), SignalUnit::Volt)
            .unwrap()
    };
    let mut wrong = small.clone();
    wrong.signals.swap_columns(1, 4);
    let check = |table: &LoadTable| Report::of_check(&file, table, &limits, None).unwrap();
    let (of_few, of_many) = (check(&wrong), check(&large(&wrong)));
    assert_eq!(of_many.suspicions[0].mistake, Mistake::Gauges { first: 2, second: 5 });
    let shares = [of_few, of_many.clone()].map(|report| report.suspicions[0].before_percent);
    assert!((shares[0] / shares[1] - 1.0).abs() < 0.02, "{shares:?}");
    let mut right = large(&small);
    assert!(check(&right).suspicions.is_empty());
    right.signals[(20_011, 3)] += 0.5;
    let fitted = calibrate(&right, &Options::default()).unwrap().report;
    assert_eq!(fitted.outliers.first().map(|outlier| outlier.index), Some(20_011));
    assert_eq!(fitted.lines.unwrap().expected_mm.map(|expected| expected > 0.0), Some(true));
}

#[test]
fn every_method_finds_the_sensor() {
    let table = table();
    let plain = calibrate(&table, &Options::default()).unwrap();
    let deviations = (vec![1e-3; 6], vec![2e-3; 6]);
    for method in [
        Method::Huber,
        Method::Ransac { outliers: 0.6, seed: 3 },
        Method::Total { load_deviations: deviations.0.clone(), signal_deviations: deviations.1.clone() },
        Method::GaussHelmert {
            load_deviations: deviations.0.clone(),
            relative: 1e-3,
            signal_deviations: deviations.1.clone(),
        },
        Method::Prior { prior: Box::new(plain.to_file().unwrap()), relative: 0.1 },
    ] {
        let found = calibrate(&table, &Options { method: method.clone(), ..Options::default() }).unwrap();
        let difference = found.to_file().unwrap().matrix - plain.to_file().unwrap().matrix;
        assert!(difference.largest() < 0.05, "{method:?}: {}", difference.largest());
    }
    let backward = Options { direction: Direction::LoadsFromSignals, ..Options::default() };
    let found = calibrate(&table, &backward).unwrap().to_file().unwrap();
    assert!((found.matrix - plain.to_file().unwrap().matrix).largest() < 0.05);
}

/// A zero may move as it likes: only the matrix is believed.
#[test]
fn a_prior_leaves_the_zero_free() {
    let table = table();
    let prior = calibrate(&table, &Options::default()).unwrap().to_file().unwrap();
    let mut moved = table;
    moved.signals.add_scalar_mut(0.5);
    let method = Method::Prior { prior: Box::new(prior.clone()), relative: 1e-3 };
    let found = calibrate(&moved, &Options { method, ..Options::default() }).unwrap().to_file().unwrap();
    for (zero, before) in found.zero.iter().zip(&prior.zero) {
        assert!((zero - before - 0.5).abs() < 1e-3, "{zero} {before}");
    }
    assert!((found.matrix - prior.matrix).largest() < 1e-3);
}

#[test]
fn quadratic_terms_are_kept_where_they_help_and_refused_where_not() {
    // A sensor of three axes, truly quadratic, and its linear twin with noise.
    let count = 60;
    let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(7);
    let signals = DMatrix::from_fn(count, 3, |_, _| random.random_range(-1.0..1.0));
    let noise = DMatrix::from_fn(count, 3, |_, _| random.random_range(-1e-3..1e-3));
    let make = |bend: f64| {
        let loads = DMatrix::from_fn(count, 3, |i, j| {
            let s = |k: usize| signals[(i, k % 3)];
            2.0 * s(j) + 0.1 * s(j + 1) + bend * s(j) * s(j) + 0.2 + noise[(i, j)]
        });
        LoadTable::new(&Axis::FORCES, loads, signals.clone(), SignalUnit::Volt).unwrap()
    };
    let options = Options {
        direction: Direction::LoadsFromSignals,
        curvature: Curvature::Quadratic,
        ..Options::default()
    };
    let bent = make(0.2);
    let calibration = calibrate(&bent, &options).unwrap();
    assert!(calibration.report.axes.iter().all(|axis| axis.left_out_percent.unwrap() < 0.1));
    // The file gives the same loads as the model.
    let file = calibration.to_file().unwrap();
    let again = fingertip_calibration::file::CalibrationFile::from_toml(&file.to_toml().unwrap()).unwrap();
    let reading = [0.3, -0.7, 0.5];
    let by_file = again.load(&reading).unwrap();
    let by_model = calibration.model.loads(&DMatrix::from_row_slice(1, 3, &reading)).unwrap();
    assert!((by_file.transpose() - by_model.row(0)).largest() < 1e-12);
    let error = calibrate(&make(0.0), &options).unwrap_err();
    assert!(matches!(error, CalibrationError::OverFitted { coefficients: 10, samples: 60, .. }), "{error}");
}

#[test]
fn drift_with_temperature_is_fitted_and_kept() {
    let mut table = table();
    let celsius: Vec<f64> = (0..table.samples()).map(|i| 20.0 + ((i * 7) % 11) as f64).collect();
    for (i, t) in celsius.iter().enumerate() {
        for gauge in 0..6 {
            let clean = table.signals[(i, gauge)];
            table.signals[(i, gauge)] = 0.5 + 0.01 * (t - 25.0) + clean * (1.0 + 0.002 * (t - 25.0));
        }
    }
    table.temperatures = Some(celsius);
    let without = calibrate(&table, &Options::default()).unwrap();
    assert!(without.report.notes.iter().any(|note| note.contains("temperatures")));
    let rms = |report: &Report| {
        let mut worst = Worst::new();
        report.axes.iter().for_each(|axis| worst.see(axis.rms_percent));
        worst.get()
    };
    let with = calibrate(&table, &Options { reference_celsius: Some(25.0), ..Options::default() }).unwrap();
    assert!(rms(&with.report) < 0.3 * rms(&without.report), "{}", with.report);
    let file = with.to_file().unwrap();
    let drift = file.temperature.as_ref().unwrap();
    assert!(drift.zero_drift.iter().all(|drift| (drift - 0.01).abs() < 1e-3));
    assert!(drift.gain_drift.iter().all(|drift| (drift - 0.002).abs() < 1e-3));
    assert!(file.zero.iter().all(|zero| (zero - 0.5).abs() < 0.01));
    table.temperatures = None;
    let error =
        calibrate(&table, &Options { reference_celsius: Some(25.0), ..Options::default() }).unwrap_err();
    assert!(error.to_string().contains("no temperatures"), "{error}");
}
