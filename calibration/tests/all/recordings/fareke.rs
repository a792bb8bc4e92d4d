//! Home-made load cells against weights.

use fingertip_calibration::Axis;
use fingertip_calibration::calibrate;
use fingertip_calibration::file::{SignalUnit, Verdict};
use fingertip_calibration::loads::LoadTable;
use fingertip_calibration::model::{Direction, Limits, Method, Options};
use fingertip_calibration::report::{Exclusion, Mistake, Report};

use fingertip_test_support::recording;

use super::common;
use crate::mistakes::with;

const GRAM_FORCE: f64 = 9.80665e-3;

fn cell(cell: &str, validation: &str) -> Option<LoadTable> {
    let path = recording("fareke_3axis_raw/cells.csv")?;
    let (header, mut rows) = common::csv(&path);
    rows.retain(|row| row[0] == cell && row[1] == validation);
    let table = (header, rows);
    let loads = common::columns(&table, &["fx_gf", "fy_gf", "fz_gf"]) * GRAM_FORCE;
    let signals = common::columns(&table, &["raw_x_counts", "raw_y_counts", "raw_z_counts"]);
    let mut result = LoadTable::new(&Axis::FORCES, loads, signals, SignalUnit::Count).unwrap();
    result.groups = common::column(&table, "orientation_group").iter().map(|group| *group as usize).collect();
    result.names = table.1.iter().map(|row| format!("({}, {}, {}) gf", row[3], row[4], row[5])).collect();
    Some(result)
}

fn options() -> Options {
    Options { direction: Direction::LoadsFromSignals, bias: false, tare_groups: true, ..Options::default() }
}

#[test]
fn errors_are_those_of_the_readme() {
    let published = [
        ("1", [0.414, 1.007, 0.399]),
        ("2", [0.357, 0.136, 0.845]),
        ("3", [0.529, 7.496, 0.359]),
        ("4", [0.285, 0.207, 0.640]),
    ];
    for (number, rms) in published {
        let Some(table) = cell(number, "0") else { return };
        let report = calibrate(&table, &options()).unwrap().report;
        assert_eq!(report.axes.len(), 3);
        for (axis, rms) in report.axes.iter().zip(rms) {
            assert!(
                (axis.rms / GRAM_FORCE - rms).abs() < 6e-4,
                "cell {number} {}: {}",
                axis.axis,
                axis.rms / GRAM_FORCE
            );
        }
    }
}

#[test]
fn bad_reading_of_cell_3_is_named() {
    let Some(table) = cell("3", "0") else { return };
    for direction in [Direction::LoadsFromSignals, Direction::SignalsFromLoads] {
        let options = Options { direction, ..options() };
        let report = calibrate(&table, &options).unwrap().report;
        let named: Vec<&str> = report.outliers.iter().map(|outlier| outlier.sample.as_str()).collect();
        println!("{direction:?}: {named:?}");
        assert!(named.contains(&"(0, 151, 0) gf"), "{named:?}");
        // Its RMS alone would be good: 0.86 % of full scale.
        assert_eq!(report.verdict, Verdict::Suspect, "{report}");
        assert!(report.reasons[0].contains("(0, 151, 0) gf"), "{report}");
        let without =
            calibrate(&table, &Options { reject_outliers: true, ..options.clone() }).unwrap().report;
        assert_eq!(without.verdict, Verdict::Good, "{without}");
        assert!(without.excluded.iter().any(|sample| sample.sample == "(0, 151, 0) gf"));
        assert_eq!(without.axes.len(), 3);
        for axis in &without.axes {
            println!("{}: RMS {:.4} %", axis.axis, axis.rms_percent);
            assert!(axis.rms_percent < 0.1, "{without}");
        }
        // RANSAC does without it too, and says so.
        let method = Method::Ransac { outliers: 0.2, seed: 1 };
        let agreeing = calibrate(&table, &Options { method, ..options }).unwrap().report;
        let left_out =
            |sample: &Exclusion| sample.sample == "(0, 151, 0) gf" && sample.reason.contains("RANSAC");
        assert!(agreeing.excluded.iter().any(left_out), "{agreeing}");
        assert!(agreeing.axes.iter().all(|axis| axis.rms_percent < 0.1), "{agreeing}");
    }
}

/// The author's error table comes of using the matrix transposed.
#[test]
fn transposition_is_noticed() {
    for number in ["1", "2", "3", "4"] {
        let Some(table) = cell(number, "0") else { return };
        let tared = table.tared_by_group().unwrap();
        let calibration = calibrate(&table, &options()).unwrap();
        let file = calibration.to_file().unwrap();
        let right = Report::of_check(&file, &tared, &Limits::default(), None).unwrap();
        assert!(right.suspicions.is_empty(), "{right}");
        let transposed = with(&file, |matrix| matrix.transpose());
        let wrong = Report::of_check(&transposed, &tared, &Limits::default(), None).unwrap();
        assert_eq!(wrong.suspicions[0].mistake, Mistake::Transposed, "{wrong}");
        assert_eq!(wrong.verdict, Verdict::Bad);
        println!("cell {number}: {}", wrong.suspicions[0]);
    }
}

#[test]
fn validation_of_cell_2_is_as_published() {
    let (Some(table), Some(unseen)) = (cell("2", "0"), cell("2", "1")) else { return };
    let mut file = calibrate(&table, &options()).unwrap().to_file().unwrap();
    file.nominal.iter_mut().for_each(|load| assert!((*load / GRAM_FORCE - 872.1).abs() < 1e-9));
    let report =
        Report::of_check(&file, &unseen.tared_by_group().unwrap(), &Limits::default(), None).unwrap();
    assert_eq!(report.axes.len(), 3);
    for (axis, rms) in report.axes.iter().zip([4.609, 12.062, 19.601]) {
        assert!((axis.rms / GRAM_FORCE - rms).abs() < 6e-4, "{}", axis.rms / GRAM_FORCE);
    }
}

fn six_axes() -> Option<LoadTable> {
    let path = recording("fareke_6axis_crosstalk/readings.csv")?;
    let table = common::csv(&path);
    let loads = common::columns(&table, &["Fx_N", "Fy_N", "Fz_N", "Mx_Nm", "My_Nm", "Mz_Nm"]);
    let signals = common::columns(
        &table,
        &["Fx_meas_N", "Fy_meas_N", "Fz_meas_N", "Mx_meas_Nm", "My_meas_Nm", "Mz_meas_Nm"],
    );
    let mut result = LoadTable::new(&Axis::ALL, loads, signals, SignalUnit::Wrench).unwrap();
    result.groups = common::column(&table, "setup").iter().map(|setup| *setup as usize).collect();
    Some(result)
}

#[test]
fn six_axis_rig_is_as_in_the_readme() {
    let Some(table) = six_axes() else { return };
    let rms = |options: &Options| {
        let report = calibrate(&table, options).unwrap().report;
        report.axes.iter().map(|axis| axis.rms_percent).collect::<Vec<_>>()
    };
    let tared = rms(&options());
    let plain = rms(&Options { tare_groups: false, ..options() });
    let affine = rms(&Options { tare_groups: false, bias: true, ..options() });
    for (found, published) in [
        (&plain, [0.184, 0.213, 0.216, 0.550, 0.321, 0.262]),
        (&affine, [0.179, 0.196, 0.202, 0.526, 0.319, 0.258]),
        (&tared, [0.120, 0.157, 0.131, 0.570, 0.336, 0.202]),
    ] {
        assert_eq!(found.len(), 6);
        for (found, published) in found.iter().zip(published) {
            assert!(*found < published + 6e-4, "{found} {published}");
        }
    }
    println!("tare and least squares: {tared:.3?}");
}

/// Lever arms of 150 mm from the mended wrench: per setup, as torque over force, above 1 N.
#[test]
fn lever_arms_are_found() {
    let Some(table) = six_axes() else { return };
    let calibration = calibrate(&table, &options()).unwrap();
    let predicted = calibration.model.loads(&calibration.table.signals).unwrap();
    // Setups 1, 3, 4: force on Fy, Fx, Fx; torque on Mx, My, Mz.
    for (setup, force, torque, published) in [(1, 1, 3, 2.43), (3, 0, 4, 2.41), (4, 0, 5, 4.04)] {
        let errors: Vec<f64> = (0..table.samples())
            .filter(|i| table.groups[*i] == setup && table.loads[(*i, force)].abs() > 1.0)
            .map(|i| 1e3 * (predicted[(i, torque)] / predicted[(i, force)]).abs() - 150.0)
            .collect();
        let rms = (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt();
        println!("setup {setup}: lever arm within {rms:.3} mm RMS (README {published})");
        assert!(rms < published + 6e-3, "{rms}");
    }
}

#[test]
fn loads_without_one_axis_are_refused_by_name() {
    let Some(mut table) = six_axes() else { return };
    // As the sibling recording without Fz.
    table = table.select(|i| table.groups[i] != 5);
    let error =
        calibrate(&table, &Options { direction: Direction::SignalsFromLoads, ..options() }).unwrap_err();
    assert!(error.to_string().contains("unobserved: Fz"), "{error}");
}
