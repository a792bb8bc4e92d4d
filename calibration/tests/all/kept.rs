//! What a calibration keeps in its file, and what methods make of an earlier one.

use fingertip_calibration::Axis;
use fingertip_calibration::calibrate;
use fingertip_calibration::file::{CalibrationFile, SignalUnit};
use fingertip_calibration::loads::LoadTable;
use fingertip_calibration::model::{Method, Options};
use fingertip_calibration::nalgebra::DMatrix;
use rand::SeedableRng as _;
use rand_pcg::Pcg64Mcg;

use super::random::{gaussians, sensor};
use super::testing::Largest as _;

const NOMINAL: [f64; 3] = [2.0, 4.0, 0.5];

/// Loads and readings of four gauges with noise.
fn noisy(seed: u64) -> (LoadTable, DMatrix<f64>) {
    let random = &mut Pcg64Mcg::seed_from_u64(seed);
    let (loads, truth) = (gaussians(random, 25, 3), sensor(random, 3, 4));
    let signals = (&loads * &truth).add_scalar(0.7) + gaussians(random, 25, 4) * 0.05;
    (LoadTable::new(&Axis::FORCES, loads, signals, SignalUnit::Volt).unwrap(), truth)
}

/// The loads in nominal loads, and the constant.
fn regressors(table: &LoadTable, bias: bool) -> DMatrix<f64> {
    let loads = DMatrix::from_fn(table.samples(), 3, |i, j| table.loads[(i, j)] / NOMINAL[j]);
    if bias { loads.insert_column(3, 1.0) } else { loads }
}

#[test]
fn the_file_has_matrix_covariance_and_quality() {
    for bias in [true, false] {
        let (table, _) = noisy(201);
        let options = Options { bias, nominal: Some(NOMINAL.to_vec()), ..Options::default() };
        let calibration = calibrate(&table, &options).unwrap();
        let file = calibration.to_file().unwrap();
        // The normal equations: a fair oracle while all is well conditioned.
        let x = regressors(&table, bias);
        let inverse = (x.transpose() * &x).try_inverse().unwrap();
        let theta = &inverse * x.transpose() * &table.signals;
        let left = &table.signals - &x * &theta;
        let noise = left.transpose() * &left / (25 - x.ncols()) as f64;
        assert!((&file.matrix - theta.rows(0, 3).transpose()).largest() < 1e-12);
        let zero = if bias { theta.row(3).into_owned() } else { theta.row(0) * 0.0 };
        assert!(file.zero.iter().zip(zero.iter()).all(|(a, b)| (a - b).abs() < 1e-12), "{:?}", file.zero);
        let covariance = file.covariance.as_ref().unwrap();
        assert!((&covariance.signals - noise).largest() < 1e-14);
        assert!((&covariance.loads - inverse.view((0, 0), (3, 3))).largest() < 1e-13);
        assert_eq!((file.nominal.as_slice(), file.axes.as_slice()), (&NOMINAL[..], &Axis::FORCES[..]));
        // What the report found.
        let report = &calibration.report;
        assert_eq!((file.quality.verdict, &file.quality.reasons), (report.verdict, &report.reasons));
        assert_eq!(
            (file.quality.samples, file.quality.condition_number),
            (Some(25), report.condition_number)
        );
        let (rms, greatest, left_out) = (
            file.quality.rms_percent.unwrap(),
            file.quality.greatest_percent.unwrap(),
            file.quality.left_out_percent,
        );
        for (j, axis) in report.axes.iter().enumerate() {
            assert_eq!((rms[j], greatest[j]), (axis.rms_percent, axis.greatest_percent));
            assert_eq!(left_out.as_ref().map(|list| list[j]), axis.left_out_percent);
        }
        assert_eq!(file.provenance.method, report.method);
    }
}

/// The sensor found makes the residuals and what it is off the earlier one, each over its variance, least; and the
/// variance of the residuals is that which it leaves.
#[test]
fn a_prior_weighs_as_much_as_is_said() {
    for (bias, relative) in [(false, 0.01), (true, 0.01), (true, 0.1)] {
        let (table, truth) = noisy(202);
        let random = &mut Pcg64Mcg::seed_from_u64(203);
        // Made with other nominal loads.
        let earlier = [1.0, 2.0, 3.0];
        let physical = truth + gaussians(random, 3, 4) * 0.05;
        let of = |nominal: [f64; 3]| DMatrix::from_fn(3, 4, |i, j| physical[(i, j)] * nominal[i]);
        let zero = vec![0.5, 0.6, 0.7, 0.8];
        let prior =
            CalibrationFile::new(of(earlier).transpose(), earlier.to_vec(), zero, SignalUnit::Volt).unwrap();
        let mut center = of(NOMINAL);
        // The root mean square of the matrix.
        let entry = (center.iter().map(|x| x * x).sum::<f64>() / 12.0).sqrt();
        // A zero may be off by a hundred times as much.
        let mut off = vec![relative * entry; 3];
        if bias {
            center = center.insert_row(3, 0.0);
            (0..4).for_each(|j| center[(3, j)] = prior.zero[j]);
            off.push(100.0 * relative * entry);
        }
        let method = Method::Prior { prior: Box::new(prior), relative };
        let options = Options { bias, nominal: Some(NOMINAL.to_vec()), method, ..Options::default() };
        let found = calibrate(&table, &options).unwrap().model.fit.coefficients;
        let x = regressors(&table, bias);
        let left = &table.signals - &x * &found;
        // variance · 25 · 4 = residuals² + variance · Σ (how far off / how far it may be)².
        let pulled: f64 =
            (0..off.len()).map(|i| (found.row(i) - center.row(i)).norm_squared() / off[i].powi(2)).sum();
        let variance = left.norm_squared() / (100.0 - pulled);
        assert!(variance > 0.0, "{pulled}");
        let precision =
            DMatrix::from_fn(
                off.len(),
                off.len(),
                |i, j| if i == j { variance / off[i].powi(2) } else { 0.0 },
            );
        let slope = x.transpose() * left - &precision * (&found - &center);
        assert!(slope.largest() < 1e-9 * (precision * &center).largest(), "{bias} {relative}: {slope}");
    }
}

/// Two samples that RANSAC does not believe: the gauge that is worst off, in deviations of the others.
#[test]
fn what_is_left_out_is_told_in_deviations_of_the_rest() {
    let (mut table, _) = noisy(204);
    let plain = table.clone();
    table.signals[(6, 2)] += 3.0;
    table.signals[(17, 0)] -= 2.0;
    table.signals[(17, 3)] -= 5.0;
    let method = Method::Ransac { outliers: 0.2, seed: 1 };
    let options = Options { nominal: Some(NOMINAL.to_vec()), method, ..Options::default() };
    let found = calibrate(&table, &options).unwrap();
    let good: Vec<usize> = (0..25).filter(|i| ![6, 17].contains(i)).collect();
    let x = regressors(&plain, true);
    let (rows, readings) = (x.select_rows(&good), table.signals.select_rows(&good));
    let theta = (rows.transpose() * &rows).try_inverse().unwrap() * rows.transpose() * &readings;
    let left = &readings - &rows * &theta;
    let off = &table.signals - &x * &theta;
    let told = |sample: usize, gauge: usize| {
        let deviation = (left.column(gauge).norm_squared() / (good.len() - 4) as f64).sqrt();
        let number = off[(sample, gauge)].abs() / deviation;
        format!(
            "RANSAC: gauge {} is off by {number:.1} standard deviations of the samples that agree",
            gauge + 1
        )
    };
    let reasons: Vec<(&str, &str)> =
        found.report.excluded.iter().map(|one| (one.sample.as_str(), one.reason.as_str())).collect();
    assert_eq!(reasons, [("sample 7", told(6, 2).as_str()), ("sample 18", told(17, 3).as_str())]);
    assert_eq!((found.table.samples(), found.model.fit.trust.shape()), (23, (23, 4)));
}
