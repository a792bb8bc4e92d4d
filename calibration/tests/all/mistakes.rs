//! Mistakes with a matrix, on a sensor whose gauges read far from zero at rest.

use fingertip_calibration::Axis;
use fingertip_calibration::calibrate;
use fingertip_calibration::file::{CalibrationFile, SignalUnit, Verdict};
use fingertip_calibration::loads::LoadTable;
use fingertip_calibration::model::{Limits, Options};
use fingertip_calibration::nalgebra::DMatrix;
use fingertip_calibration::report::{Mistake, Report};
use rand::SeedableRng as _;

use super::random::gaussian;

/// Loads of a few newtons and newton-metres, and what six gauges read of them besides some volts at rest.
fn table() -> LoadTable {
    let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(17);
    let loads = DMatrix::from_fn(80, 6, |_, _| 3.0 * gaussian(&mut random));
    let cross_talk = DMatrix::from_fn(6, 6, |i, j| f64::from(u8::from(i == j)) + 0.4 * gaussian(&mut random));
    let mut signals = &loads * cross_talk.transpose();
    for (gauge, mut column) in signals.column_iter_mut().enumerate() {
        column.add_scalar_mut(2.0 - gauge as f64);
    }
    LoadTable::new(&Axis::ALL, loads, signals, SignalUnit::Volt).unwrap()
}

/// The file with another matrix in signals per load, as people write it.
pub(crate) fn with(file: &CalibrationFile, change: impl Fn(DMatrix<f64>) -> DMatrix<f64>) -> CalibrationFile {
    let mut sensitivities = file.matrix.clone();
    for (mut column, nominal) in sensitivities.column_iter_mut().zip(&file.nominal) {
        column /= *nominal;
    }
    let mut matrix = change(sensitivities);
    for (mut column, nominal) in matrix.column_iter_mut().zip(&file.nominal) {
        column *= *nominal;
    }
    CalibrationFile { matrix, ..file.clone() }
}

#[test]
fn a_matrix_that_is_written_otherwise_is_told() {
    let table = table();
    let file = calibrate(&table, &Options::default()).unwrap().to_file().unwrap();
    assert!(file.zero.iter().zip(0..).all(|(zero, gauge)| (zero - (2.0 - f64::from(gauge))).abs() < 1e-6));
    let check = |file: &CalibrationFile| Report::of_check(file, &table, &Limits::default(), None).unwrap();
    let right = check(&file);
    assert!(right.verdict == Verdict::Good && right.suspicions.is_empty(), "{right}");

    let inverse = |matrix: DMatrix<f64>| matrix.try_inverse().unwrap();
    let mistakes = [
        (with(&file, |matrix| matrix.transpose()), Mistake::Transposed),
        (with(&file, inverse), Mistake::Inverted),
        (with(&file, |matrix| inverse(matrix).transpose()), Mistake::TransposedAndInverted),
    ];
    for (wrong, mistake) in mistakes {
        let report = check(&wrong);
        let [first, ..] = report.suspicions.as_slice() else { panic!("{report}") };
        assert_eq!(first.mistake, mistake, "{report}");
        // It explains all there is.
        assert!(first.after_percent < 1e-6 && !first.outliers_aside, "{report}");
        assert_eq!(report.verdict, Verdict::Bad);
    }

    let mut exchanged = file.clone();
    exchanged.matrix.swap_rows(1, 4);
    exchanged.zero.swap(1, 4);
    let report = check(&exchanged);
    assert!(
        report.suspicions.iter().any(|s| s.mistake == Mistake::Gauges { first: 2, second: 5 }),
        "{report}"
    );
}

/// Six gauges are enough: that a seventh is dead does no harm to figures, but whoever mounts the sensor must know.
#[test]
fn a_good_fit_with_a_dead_gauge_is_suspect() {
    let table = table();
    let readings = table.signals.clone().insert_column(6, 1.25);
    let with_dead = LoadTable::new(&Axis::ALL, table.loads.clone(), readings, SignalUnit::Volt).unwrap();
    let report = calibrate(&with_dead, &Options::default()).unwrap().report;
    assert!(report.reasons.iter().any(|reason| reason.contains("gauge 7 is dead")), "{report}");
    assert_eq!(report.verdict, Verdict::Suspect, "{report}");
}
