//! Factory certificates of four ATI sensors: the published matrix comes back from the loads.

use fingertip_calibration::Axis;
use fingertip_calibration::file::{AtiCalibration, SignalUnit, Verdict};
use fingertip_calibration::loads::LoadTable;
use fingertip_calibration::model::{Direction, Options};
use fingertip_calibration::{Calibration, calibrate};

use fingertip_test_support::{Worst, recording};

use super::super::testing::Largest as _;
use super::common;

/// Loads in the units of the certificate: the README's figures are of these.
fn certificate(serial: &str) -> Option<(AtiCalibration, LoadTable)> {
    let path = recording("ati_cert_loads")?;
    let text = std::fs::read_to_string(path.join(format!("{serial}.cal"))).unwrap();
    let ati = AtiCalibration::from_xml(&text).unwrap();
    let (header, mut rows) = common::csv(&path.join("loads.csv"));
    rows.retain(|row| row[0] == serial);
    let table = (header, rows);
    let names = ["fx", "fy", "fz", "tx", "ty", "tz"];
    let mut loads =
        common::columns(&table, &names.map(|name| format!("applied_{name}")).each_ref().map(|s| s.as_str()));
    // Torques of the Nano17 are in N·mm.
    let unit = ati.full_scale()[3] / ati.axes[3].max;
    for j in 3..6 {
        loads.column_mut(j).scale_mut(unit);
    }
    let signals = common::columns(
        &table,
        &core::array::from_fn::<_, 6, _>(|i| format!("v{i}_reconstructed")).each_ref().map(|s| s.as_str()),
    );
    Some((ati, LoadTable::new(&Axis::ALL, loads, signals, SignalUnit::Volt).unwrap()))
}

fn options(ati: &AtiCalibration, bias: bool) -> Options {
    Options {
        direction: Direction::LoadsFromSignals,
        bias,
        nominal: Some(ati.full_scale().to_vec()),
        ..Options::default()
    }
}

type Published = (&'static str, [f64; 6], [f64; 6], [f64; 6], [f64; 2]);

/// From the README of the recordings: serial, RMS, left-out RMS, affine RMS (% of full scale), line
/// error median and greatest \[mm\].
const PUBLISHED: [Published; 4] = [
    (
        "FT44297",
        [0.071, 0.113, 0.109, 0.212, 0.370, 0.141],
        [0.098, 0.173, 0.154, 0.274, 0.477, 0.205],
        [0.068, 0.105, 0.108, 0.210, 0.369, 0.129],
        [0.120, 0.514],
    ),
    (
        "FT52907",
        [0.181, 0.093, 0.109, 0.190, 0.395, 0.145],
        [0.239, 0.123, 0.142, 0.240, 0.631, 0.202],
        [0.169, 0.087, 0.094, 0.186, 0.381, 0.130],
        [0.385, 1.376],
    ),
    (
        "FT43243",
        [0.284, 0.379, 0.324, 0.151, 0.130, 0.196],
        [0.371, 0.550, 0.418, 0.201, 0.169, 0.260],
        [0.280, 0.379, 0.176, 0.151, 0.126, 0.194],
        [0.609, 1.297],
    ),
    (
        "FT16810",
        [0.074, 0.051, 0.065, 0.091, 0.089, 0.091],
        [0.096, 0.067, 0.093, 0.122, 0.114, 0.119],
        [0.074, 0.049, 0.065, 0.089, 0.089, 0.073],
        [0.179, 0.328],
    ),
];

fn close(serial: &str, what: &str, found: impl Iterator<Item = f64>, expected: &[f64]) {
    let found: Vec<f64> = found.collect();
    assert_eq!(found.len(), expected.len(), "{serial} {what}");
    for (found, expected) in found.iter().zip(expected) {
        // Three digits behind the point are printed.
        assert!((found - expected).abs() < 6e-4, "{serial} {what}: {found:.4} instead of {expected}");
    }
}

#[test]
fn published_matrix_and_errors_come_back() {
    for (serial, rms, left_out, affine, line) in PUBLISHED {
        let Some((ati, table)) = certificate(serial) else { return };
        let Calibration { model, report, .. } = calibrate(&table, &options(&ati, false)).unwrap();
        // The fitted loads per volt against ATI's, at the greatest voltage of each gauge, % of full scale.
        let published = ati.loads_per_volt().unwrap();
        let mut worst = Worst::new();
        for i in 0..6 {
            for j in 0..6 {
                let fitted = model.fit.coefficients[(j, i)] * model.nominal[i];
                let volts = table.signals.column(j).largest();
                worst.see(100.0 * (fitted - published[(i, j)]) * volts / model.nominal[i]);
            }
        }
        let worst = worst.get();
        println!("{serial}: matrix within {worst:.4} % of full scale");
        assert!(worst < 0.006, "{serial}: {worst}");
        close(serial, "RMS", report.axes.iter().map(|axis| axis.rms_percent), &rms);
        close(serial, "left out", report.axes.iter().map(|axis| axis.left_out_percent.unwrap()), &left_out);
        let lines = report.lines.as_ref().unwrap();
        // The README's lines are of the published matrix, ours of the fitted one.
        for (found, line) in [lines.median_mm, lines.greatest_mm].into_iter().zip(line) {
            assert!((found / line - 1.0).abs() < 0.015, "{serial}: {found} {line}");
        }
        let affine_fit = calibrate(&table, &options(&ati, true)).unwrap();
        close(serial, "affine", affine_fit.report.axes.iter().map(|axis| axis.rms_percent), &affine);
        assert_eq!(report.verdict, Verdict::Good, "{report}");
    }
}

/// The physical direction gives nearly the same sensor.
#[test]
fn signals_on_loads_agree_within_the_errors() {
    for (serial, rms, ..) in PUBLISHED {
        let Some((ati, table)) = certificate(serial) else { return };
        let forward = Options { direction: Direction::SignalsFromLoads, ..options(&ati, false) };
        let report = calibrate(&table, &forward).unwrap().report;
        assert_eq!(report.axes.len(), 6);
        for (axis, rms) in report.axes.iter().zip(rms) {
            assert!(axis.rms_percent < 1.1 * rms, "{serial} {}: {} {rms}", axis.axis, axis.rms_percent);
        }
        let lines = report.lines.unwrap();
        println!(
            "{serial}: lines off by {:.3} mm in the median, {:.3} mm expected",
            lines.median_mm,
            lines.expected_mm.unwrap()
        );
    }
}
