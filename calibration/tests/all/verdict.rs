//! What a report makes of its figures: good, suspect or bad, and what it says of it.

use fingertip_calibration::Axis;
use fingertip_calibration::calibrate;
use fingertip_calibration::file::{SignalUnit, Verdict};
use fingertip_calibration::loads::LoadTable;
use fingertip_calibration::model::{Curvature, Direction, Limits, Method, Options};
use fingertip_calibration::nalgebra::DMatrix;
use fingertip_calibration::report::{Mistake, Report};
use rand::SeedableRng as _;
use rand_pcg::Pcg64Mcg;

use super::metrics::{Sample, sensor, table, x, y};
use super::random::{gaussian, gaussians};

fn check(samples: &[Sample<3>], limits: &Limits) -> Report {
    Report::of_check(&sensor(3), &table(samples), limits, None).unwrap()
}

/// Full scale of every axis is reached, and two are read right.
fn samples(said: f64) -> [Sample<3>; 4] {
    [x(8.0, said), x(0.0, 0.0), y(-16.0, -16.0), ([0.0, 0.0, 32.0], [0.0, 0.0, 32.0])]
}

#[test]
fn what_is_allowed_is_good_and_more_is_not() {
    let plain = check(&samples(8.25), &Limits::default());
    assert_eq!((plain.verdict, plain.notes.len(), plain.reasons.len()), (Verdict::Good, 0, 0), "{plain}");
    let (rms, number) = (plain.axes[0].rms_percent, plain.condition_number.unwrap());
    assert!((rms - 100.0 * 0.125 / 8.0).abs() < 1e-12 && (number - 4.0).abs() < 1e-12);
    let limits = Limits { left_out_percent: rms, condition_number: number, ..Limits::default() };
    assert_eq!(check(&samples(8.25), &limits).verdict, Verdict::Good);
    let less = check(&samples(8.25), &Limits { left_out_percent: 1.5, ..limits });
    assert_eq!((less.verdict, less.reasons.len()), (Verdict::Bad, 1));
    assert_eq!(less.reasons[0], "Fx: 1.56 % of full scale on these loads; 1.5 % is allowed");
    let less = check(&samples(8.25), &Limits { condition_number: 3.9, ..limits });
    assert_eq!(less.verdict, Verdict::Bad);
    assert_eq!(less.reasons, ["ill-conditioned: N_c = 4; 4 is allowed"]);
}

#[test]
fn loads_that_leave_much_unchecked_are_noted() {
    let notes = |load: f64| {
        check(&[x(load, load), x(0.0, 0.0), samples(8.0)[2], samples(8.0)[3]], &Limits::default()).notes
    };
    assert_eq!(notes(-6.0), [""; 0]);
    assert_eq!(notes(5.9), ["Fx: the loads reach 74 % of full scale, beyond which nothing is checked"]);
}

#[test]
fn saturated_samples_are_left_out_and_counted() {
    let mut file = sensor(3);
    file.range = Some([-30.0, 30.0]);
    let saturated = |said: f64| {
        let mut list = samples(8.0).to_vec();
        list[3] = ([0.0, 0.0, 28.0], [0.0, 0.0, 28.0]);
        list.extend([([0.0, 0.0, 32.0], [1.0, 2.0, 30.0]), ([0.0, 0.0, 32.0], [1.0, 2.0, said])]);
        Report::of_check(&file, &table(&list), &Limits::default(), None).unwrap()
    };
    let two = saturated(-30.0);
    assert_eq!(two.notes, ["2 samples were left out"]);
    assert_eq!((two.samples, two.verdict, two.excluded.len()), (4, Verdict::Good, 2), "{two}");
    assert_eq!(two.excluded[0].sample, "sample 5");
    assert_eq!(two.excluded[1].reason, "gauge 3 saturated");
    let one = saturated(29.9);
    assert_eq!((one.notes[0].as_str(), one.samples, one.verdict), ("1 sample was left out", 5, Verdict::Bad));
}

#[test]
fn a_check_says_what_it_cannot_do() {
    let file = sensor(3);
    let error =
        |table: &LoadTable| Report::of_check(&file, table, &Limits::default(), None).unwrap_err().to_string();
    let plain = table(&samples(8.0));
    let mut fewer = plain.clone();
    fewer.signals = fewer.signals.columns(0, 2).into_owned();
    assert!(
        error(&fewer).contains("it has 2 gauges and 3 axes, the calibration 3 and 3"),
        "{}",
        error(&fewer)
    );
    let mut others = plain.clone();
    others.axes = vec![Axis::Fx, Axis::Fy, Axis::Tz];
    assert!(error(&others).contains("3 gauges and 3 axes"));
    let mut warm = plain;
    warm.temperatures = Some(vec![20.0; 4]);
    let report = Report::of_check(&file, &warm, &Limits::default(), None).unwrap();
    assert_eq!(report.notes, ["temperatures are known, but the calibration has no terms for them"]);
    let mut stamped = file.clone();
    stamped.quality.verdict = Verdict::Bad;
    stamped.provenance.method = "hand".to_owned();
    stamped.quality.reasons = vec!["a".to_owned(), "b".to_owned()];
    let report = Report::of_check(&stamped, &table(&samples(8.0)), &Limits::default(), None).unwrap();
    assert_eq!(report.notes, ["the file itself is stamped as bad: a; b"]);
    assert_eq!(report.method, "check of a calibration by hand");
    assert_eq!(report.verdict, Verdict::Good);
}

/// Fx and Fy exchanged, Fz never loaded: of what the sensor says there no sign is known.
#[test]
fn an_axis_without_load_has_no_sign() {
    let random = &mut Pcg64Mcg::seed_from_u64(94);
    let samples: Vec<Sample<3>> = (0..12)
        .map(|i| {
            let load = [f64::from(i % 4) - 1.5, f64::from(i % 3) - 1.0, 0.0];
            (load, [load[1], load[0], 1e-6 * gaussian(random)])
        })
        .collect();
    let report = check(&samples, &Limits::default());
    let reads = report.suspicions.iter().find_map(|suspicion| match &suspicion.mistake {
        Mistake::Axes { reads } => Some(reads.clone()),
        _ => None,
    });
    assert_eq!(reads.unwrap(), [(Axis::Fy, false), (Axis::Fx, false), (Axis::Fz, false)], "{report}");
}

/// Forty loads that are read within a thousandth of full scale, and one that is not.
#[test]
fn a_check_names_the_sample_that_stands_out() {
    let random = &mut Pcg64Mcg::seed_from_u64(93);
    let mut samples: Vec<Sample<3>> = (0..40)
        .map(|i| {
            let load = 8.0 * (f64::from(i % 9) / 4.0 - 1.0);
            x(load, load + 8e-3 * gaussian(random))
        })
        .collect();
    samples.extend([y(-16.0, -16.0), ([0.0, 0.0, 32.0], [0.0, 0.0, 32.0])]);
    assert_eq!(check(&samples, &Limits::default()).outliers, []);
    samples[17].1[0] += 0.5;
    let report = check(&samples, &Limits::default());
    let [outlier] = &report.outliers[..] else { panic!("{report}") };
    assert_eq!((outlier.index, outlier.sample.as_str(), outlier.response.as_str()), (17, "sample 18", "Fx"));
    assert!(report.reasons.iter().any(|reason| reason.starts_with("sample 18: outlier: Fx is off by")));
    assert_eq!(report.verdict, Verdict::Suspect, "{report}");
}

/// Readings of one gauge under −1, 0 and 1 N: the line leaves `e·(1, −2, 1)`, and each sample is off by
/// `e·(6, −3, 6)` from the line through the other two.
fn bent(e: f64) -> LoadTable {
    let loads = DMatrix::from_column_slice(3, 1, &[-1.0, 0.0, 1.0]);
    let signals = DMatrix::from_column_slice(3, 1, &[-1.0 + e, -2.0 * e, 1.0 + e]);
    LoadTable::new(&[Axis::Fz], loads, signals, SignalUnit::Volt).unwrap()
}

#[test]
fn over_fitting_is_told_by_what_was_left_out() {
    let e = 1e-3;
    let judged =
        |limits: Limits| calibrate(&bent(e), &Options { limits, ..Options::default() }).unwrap().report;
    let report = judged(Limits::default());
    let axis = &report.axes[0];
    // To first order in e.
    assert!((axis.rms_percent / (100.0 * e * 2.0_f64.sqrt()) - 1.0).abs() < 1e-2, "{report}");
    let left_out = axis.left_out_percent.unwrap();
    assert!((left_out / (100.0 * e * 27.0_f64.sqrt()) - 1.0).abs() < 1e-2, "{report}");
    assert!((axis.left_out_greatest_percent.unwrap() / (600.0 * e) - 1.0).abs() < 1e-2);
    assert_eq!(report.verdict, Verdict::Bad);
    assert_eq!(
        report.reasons,
        ["Fz: over-fitted: 0.52 % on loads left out of the fit, 0.14 % on those in it"]
    );
    // Where so much more is allowed, or so little that nobody minds.
    let ratio = left_out / axis.rms_percent;
    let limits = Limits::default();
    for (good, limits) in [
        (true, Limits { over_fitting: 1.001 * ratio, ..limits }),
        (false, Limits { over_fitting: 0.999 * ratio, ..limits }),
        (true, Limits { left_out_percent: 10.01 * left_out, ..limits }),
        (false, Limits { left_out_percent: 9.99 * left_out, ..limits }),
    ] {
        assert_eq!(judged(limits).verdict == Verdict::Good, good, "{limits:?}");
    }
    let strict = judged(Limits { left_out_percent: 0.5, over_fitting: 10.0, ..limits });
    assert_eq!(strict.reasons, ["Fz: 0.52 % of full scale on loads left out of the fit; 0.5 % is allowed"]);
}

#[test]
fn a_case_that_nothing_checks_is_named() {
    let mut table = bent(1e-5);
    table.cases = vec![0, 1, 1];
    // Without the second case there is one reading for two coefficients.
    let report = calibrate(&table, &Options::default()).unwrap().report;
    assert_eq!(report.needed_cases, ["sample 2", "sample 3"]);
    assert_eq!((report.verdict, report.cases), (Verdict::Bad, 2));
    let reason = "nothing checks sample 2, sample 3: without it, the other loads do not determine the sensor";
    assert_eq!(report.reasons, [reason]);
    assert_eq!(report.axes[0].left_out_percent, None);
}

/// Many readings of full scale, some noise, and one reading that is off by so much of full scale.
fn with_one_off(percent: f64, leverage: f64) -> LoadTable {
    let random = &mut Pcg64Mcg::seed_from_u64(91);
    let mut loads = DMatrix::from_fn(40, 1, |i, _| if i % 2 == 0 { 1.0 } else { -1.0 });
    loads[(7, 0)] = leverage;
    let mut signals = loads.map(|load| 2.0 * load + 1e-4 * gaussian(random));
    signals[(7, 0)] += 0.02 * percent;
    LoadTable::new(&[Axis::Fz], loads, signals, SignalUnit::Volt).unwrap()
}

#[test]
fn outliers_make_a_good_calibration_suspect_if_they_are_large() {
    let options = Options { nominal: Some(vec![1.0]), ..Options::default() };
    let small = calibrate(&with_one_off(1.0, 0.0), &options).unwrap().report;
    assert_eq!((small.verdict, small.outliers.len()), (Verdict::Good, 1), "{small}");
    assert_eq!((small.outliers[0].index, small.outliers[0].response.as_str()), (7, "gauge 1"));
    assert!(small.notes[0].starts_with("sample 8: outlier: gauge 1 is off by "), "{small}");
    assert!(
        small.notes[1].starts_with("without the outlier the sensor would read otherwise by up to 0.03 %")
    );
    let large = calibrate(&with_one_off(4.0, 0.0), &options).unwrap().report;
    assert_eq!(large.verdict, Verdict::Suspect, "{large}");
    // 39/40 of it are left by the fit, but for noise of 0.005 %.
    let greatest = large.axes[0].greatest_percent;
    assert!((greatest - 3.9).abs() < 0.02, "{large}");
    let words = format!("; it is read wrong by {greatest:.2} % of full scale, 2 % is allowed");
    assert!(large.reasons[0].ends_with(&words), "{large}");
    // One that draws the fit to itself.
    let lever = Options { limits: Limits { left_out_percent: 1e-3, ..Limits::default() }, ..options.clone() };
    let drawn = calibrate(&with_one_off(1.0, 0.0), &lever).unwrap().report;
    assert!(
        drawn.reasons.iter().any(|reason| reason.starts_with("without the outlier the sensor")),
        "{drawn}"
    );
    assert_eq!(drawn.verdict, Verdict::Bad);
    // The influence is the greatest change of what the other samples are read as: 1 %/40 at the most, since the
    // constant takes all of it.
    let influence = small.outlier_influence_percent.unwrap();
    assert!((influence - 1.0 / 40.0).abs() < 2e-3, "{influence}");
    let without = calibrate(&with_one_off(1.0, 0.0), &Options { reject_outliers: true, ..options }).unwrap();
    assert_eq!((without.report.outliers.len(), without.report.outlier_influence_percent), (0, None));
    assert_eq!(without.report.excluded[0].sample, "sample 8");
    assert_eq!(without.table.samples(), 39);
}

#[test]
fn the_method_is_described() {
    let described = |options: Options| {
        let random = &mut Pcg64Mcg::seed_from_u64(92);
        let loads = DMatrix::from_fn(20, 1, |i, _| (i % 5) as f64);
        let mut table = {
            let signals = loads.map(|load| 0.1 * load * (1.0 + 0.1 * load) + 1e-4 * gaussian(random));
            LoadTable::new(&[Axis::Fz], loads, signals, SignalUnit::Volt).unwrap()
        };
        table.temperatures = Some((0..20).map(|i| 20.0 + f64::from(i * 7 % 20)).collect());
        calibrate(&table, &options).unwrap().report
    };
    let plain = Options::default();
    let report = described(plain.clone());
    assert_eq!(report.method, "least squares of signals on loads, with bias");
    assert_eq!(report.coefficients, 2);
    assert_eq!(report.notes.last().unwrap(), "temperatures are known but no drift was fitted");
    let report = described(Options {
        direction: Direction::LoadsFromSignals,
        curvature: Curvature::Quadratic,
        ..plain.clone()
    });
    assert_eq!(report.method, "least squares of loads on signals, quadratic, with bias");
    assert_eq!(report.coefficients, 3);
    let all = Options {
        bias: false,
        tare_groups: true,
        reference_celsius: Some(25.0),
        reject_outliers: true,
        method: Method::Huber,
        ..plain
    };
    let report = described(all);
    assert_eq!(
        report.method,
        "Huber of signals on loads, without bias, tared by group, drift with temperature taken off, outliers rejected"
    );
    assert_eq!(report.coefficients, 1);
    assert!(!report.notes.iter().any(|note| note.contains("no drift was fitted")));
}

/// The sensor tells what the finger does to the object: every sign is reversed.
#[test]
fn a_reaction_is_suspected() {
    let samples: Vec<Sample<3>> = samples(8.0).iter().map(|(load, said)| (*load, said.map(|x| -x))).collect();
    let report = check(&samples, &Limits::default());
    let reads = report.suspicions.iter().find_map(|suspicion| match &suspicion.mistake {
        Mistake::Axes { reads } => Some(reads.clone()),
        _ => None,
    });
    assert_eq!(reads.unwrap(), [(Axis::Fx, true), (Axis::Fy, true), (Axis::Fz, true)], "{report}");
}

/// A line through zero: the noise of a reading is what is left over one degree less, and so many of it are a load.
#[test]
fn the_deviation_of_one_reading_is_that_of_what_is_left() {
    let random = &mut Pcg64Mcg::seed_from_u64(95);
    let loads = gaussians(random, 9, 1);
    let signals = &loads * 3.0 + gaussians(random, 9, 1) * 0.01;
    let table = LoadTable::new(&[Axis::Fz], loads.clone(), signals.clone(), SignalUnit::Volt).unwrap();
    let options = Options { bias: false, nominal: Some(vec![5.0]), ..Options::default() };
    let report = calibrate(&table, &options).unwrap().report;
    let slope = loads.dot(&signals) / loads.norm_squared();
    let noise = ((signals - &loads * slope).norm_squared() / 8.0).sqrt();
    let percent = report.axes[0].deviation_percent.unwrap();
    assert!((percent / (100.0 * noise / slope / 5.0) - 1.0).abs() < 1e-9, "{report}");
    // The matrix is that of full scale.
    assert!((report.matrix.unwrap()[0][0] / (5.0 * slope) - 1.0).abs() < 1e-12);
    let deviation = report.matrix_deviations.unwrap()[0][0];
    assert!((deviation / (5.0 * noise / loads.norm()) - 1.0).abs() < 1e-9);
}

/// Each axis stands for the next: none is where it should be.
#[test]
fn axes_that_all_moved_are_suspected() {
    let random = &mut Pcg64Mcg::seed_from_u64(96);
    let samples: Vec<Sample<3>> = (0..12)
        .map(|_| {
            let load = [8.0, 16.0, 32.0].map(|full| full * gaussian(random));
            (load, [load[1], load[2], load[0]])
        })
        .collect();
    let report = check(&samples, &Limits::default());
    let reads = report.suspicions.iter().find_map(|suspicion| match &suspicion.mistake {
        Mistake::Axes { reads } => Some(reads.clone()),
        _ => None,
    });
    // Fx was read as the third, Fy as the first, Fz as the second.
    assert_eq!(reads.unwrap(), [(Axis::Fz, false), (Axis::Fx, false), (Axis::Fy, false)], "{report}");
}
