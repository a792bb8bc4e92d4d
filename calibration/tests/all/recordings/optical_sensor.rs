//! A poor sensor, and that the reports say so.

use fingertip_calibration::Axis;
use fingertip_calibration::calibrate;
use fingertip_calibration::file::{CalibrationFile, SignalUnit, Verdict};
use fingertip_calibration::loads::LoadTable;
use fingertip_calibration::model::{CalibrationError, Curvature, Direction, Options};

use fingertip_test_support::recording;

use super::common;

fn poses() -> Option<LoadTable> {
    let path = recording("jonurce_fts8/poses.csv")?;
    let table = common::csv(&path);
    let loads = common::columns(&table, &["Fx", "Fy", "Fz", "Mx", "My", "Mz"]);
    let names: [String; 8] = core::array::from_fn(|i| format!("s{i}_mean"));
    let signals = common::columns(&table, &names.each_ref().map(|name| name.as_str()));
    let mut result = LoadTable::new(&Axis::ALL, loads, signals, SignalUnit::Count).unwrap();
    result.names = table.1.iter().map(|row| format!("pose {}", row[0])).collect();
    Some(result)
}

fn options() -> Options {
    Options {
        direction: Direction::LoadsFromSignals,
        range: Some([50.0, 950.0]),
        nominal: Some(vec![10.08, 10.08, 10.08, 0.544, 0.599, 0.385]),
        ..Options::default()
    }
}

#[test]
fn saturated_poses_are_left_out_by_name_and_the_sensor_is_called_poor() {
    let Some(table) = poses() else { return };
    let calibration = calibrate(&table, &options()).unwrap();
    let report = &calibration.report;
    let named: Vec<&str> = report.excluded.iter().map(|sample| sample.sample.as_str()).collect();
    let saturated = [13, 14, 21, 25, 26, 27, 32, 33, 40, 43, 44, 53, 55].map(|i| format!("pose {i}"));
    assert_eq!(named, saturated);
    assert!(report.excluded[0].reason.contains("gauge 8 saturated: reading 16.871"));
    assert_eq!(report.axes.len(), 6);
    for (axis, (rms, left_out)) in report.axes.iter().zip([
        (1.651, 21.3),
        (1.645, 22.3),
        (1.745, 21.6),
        (0.0517, 12.3),
        (0.0656, 14.9),
        (0.0632, 20.9),
    ]) {
        assert!((axis.rms / rms - 1.0).abs() < 1e-3, "{}: {}", axis.axis, axis.rms);
        let found = axis.left_out_percent.unwrap();
        println!("{}: left out {found:.2} %", axis.axis);
        assert!((found - left_out).abs() < 0.06 && (12.0..22.5).contains(&found), "{found} {left_out}");
    }
    assert_eq!(report.verdict, Verdict::Bad);
    // The stamp goes with the file.
    let file = CalibrationFile::from_toml(&calibration.to_file().unwrap().to_toml().unwrap()).unwrap();
    assert_eq!(file.quality.verdict, Verdict::Bad);
    assert!(file.quality.reasons[0].contains("% of full scale"));
    assert_eq!(file.sensor_matrix::<8>().unwrap().normalised().nrows(), 8);
}

#[test]
fn quadratic_fit_of_45_coefficients_is_refused() {
    let Some(table) = poses() else { return };
    let error = calibrate(&table, &Options { curvature: Curvature::Quadratic, ..options() }).unwrap_err();
    let CalibrationError::OverFitted { coefficients, samples, fitted, left_out, linear } = &error else {
        panic!("{error}");
    };
    println!("{error}");
    assert_eq!((*coefficients, *samples), (45, 47));
    assert!(*fitted < 2.0 && *linear < 20.0 && left_out.is_none_or(|left_out| left_out > *linear));
}
