//! Whole calibrations: model, file, report and its page.

use core::fmt::Debug;

use fingertip_calibration::design::{Touch, TouchSet};
use fingertip_calibration::file::{AtiCalibration, CalibrationFile, Scalar, SignalUnit};
use fingertip_calibration::loads::LoadTable;
use fingertip_calibration::model::{Curvature, Direction, Limits, Method, Options, StreamedFit};
use fingertip_calibration::nalgebra::DMatrix;
use fingertip_calibration::report::Report;
use fingertip_calibration::{Axis, Calibration, calibrate};

use super::{Draw, to_ten_digits, unchanged};

const LEVELS: [f64; 8] = [0.0, 0.25, 0.6, 1.0, 0.6, 0.25, 0.0, 0.0];

/// Each axis up and down in both directions, and loads of several axes at once; in two groups with zeros of their own.
fn table(draw: &mut Draw, axes: &[Axis], noise: f64) -> LoadTable {
    let count = axes.len();
    let mut loads: Vec<Vec<f64>> = Vec::new();
    for axis in 0..count {
        for sign in [1.0, -1.0] {
            for level in LEVELS {
                let mut load = vec![0.0; count];
                load[axis] = sign * level * if axes[axis].is_torque() { 0.3 } else { 20.0 };
                loads.push(load);
            }
        }
    }
    for _ in 0..12 {
        loads.push(
            axes.iter().map(|axis| draw.signed() * if axis.is_torque() { 0.3 } else { 20.0 }).collect(),
        );
    }
    let samples = loads.len();
    let loads = DMatrix::from_fn(samples, count, |i, j| loads[i][j]);
    let nominal =
        DMatrix::from_fn(samples, count, |i, j| loads[(i, j)] / if axes[j].is_torque() { 0.3 } else { 20.0 });
    let truth = DMatrix::from_fn(count, count, |i, j| if i == j { 2.0 } else { 0.2 * draw.signed() });
    let mut signals = &nominal * truth + draw.noises(samples, count) * noise;
    for i in 0..samples {
        for j in 0..count {
            let bent = 3e-3 * nominal[(i, j)] * nominal[(i, (j + 1) % count)];
            signals[(i, j)] += bent + if i < samples / 2 { 0.3 } else { 0.5 } + 1e-3 * j as f64;
        }
    }
    signals[(5, 0)] += 30.0 * noise;
    let mut table = LoadTable::new(axes, loads, signals, SignalUnit::Volt).unwrap();
    table.groups = (0..samples).map(|i| usize::from(i >= samples / 2)).collect();
    table.times = Some((0..samples).map(|i| 2.0 * i as f64).collect());
    table
}

fn touches() -> TouchSet {
    let touches = Touch::on_sphere(13e-3, 1.2, 0.4, 5.0).unwrap().into_iter().step_by(200).collect();
    TouchSet { surface: "a sphere of 13 mm".to_owned(), touches }
}

fn pages(report: &Report) -> String {
    format!(
        "{report}\n{}\n{}",
        report.to_html("A sensor", &[("file", "a.toml".to_owned())]),
        report.to_json().unwrap()
    )
}

/// All that can be had of a calibration; the words of pages as they are, their numbers have few digits.
fn told<E: Debug>(calibration: &Result<Calibration, E>) -> String {
    let calibration = match calibration {
        Ok(calibration) => calibration,
        Err(error) => return format!("{error:?}"),
    };
    let Calibration { model, table, report, temperature } = calibration;
    let file = calibration.to_file();
    let of_file = file.as_ref().ok().map(|file| {
        let celsius = 25.0;
        let reading: Vec<f64> = table.signals.row(3).iter().copied().collect();
        (
            file.to_toml(),
            file.load_at(&reading, celsius),
            [Scalar::F32, Scalar::F64].map(|scalar| file.to_rust(scalar)),
            AtiCalibration::from_calibration(file).map(|ati| ati.to_xml()),
            file.uncertainty_in::<f64>().is_ok(),
            Report::of_check(file, table, &Limits::default(), Some(&touches())),
        )
    });
    let of_model = (model.loads(&table.signals), model.matrix_and_zero(), model.condition_number());
    let errors = (model.covariance(), model.load_covariance().map(|of| of.at(&vec![1.0; model.axes.len()])));
    format!(
        "{} {} {} {}",
        to_ten_digits(&(model, of_model, errors, temperature)),
        to_ten_digits(&of_file),
        to_ten_digits(report),
        to_ten_digits(&pages(report)),
    )
}

#[test]
fn by_every_method() {
    let mut unchanged = unchanged("calibrations");
    let draw = &mut Draw::new(11);
    let three = table(draw, &Axis::FORCES, 1e-3);
    let prior = Box::new(calibrate(&three, &Options::default()).unwrap().to_file().unwrap());
    let methods = [
        Method::LeastSquares,
        Method::Huber,
        Method::Ransac { outliers: 0.1, seed: 2 },
        Method::Total { load_deviations: vec![0.02; 3], signal_deviations: vec![1e-3; 3] },
        Method::GaussHelmert {
            load_deviations: vec![0.01; 3],
            relative: 1e-3,
            signal_deviations: vec![1e-3; 3],
        },
        Method::Prior { prior, relative: 0.01 },
    ];
    for method in methods {
        let options = Options { method: method.clone(), touches: Some(touches()), ..Options::default() };
        unchanged.note(method.name(), [told(&calibrate(&three, &options))]);
    }
    unchanged.check();
}

#[test]
fn with_every_option() {
    let mut unchanged = unchanged("options");
    let draw = &mut Draw::new(15);
    let three = table(draw, &Axis::FORCES, 1e-3);
    let six = table(draw, &Axis::ALL, 1e-3);
    let from_signals = Options { direction: Direction::LoadsFromSignals, ..Options::default() };
    for (name, options) in [
        ("no zero", Options { bias: false, ..Options::default() }),
        ("zeros of groups", Options { tare_groups: true, touches: Some(touches()), ..Options::default() }),
        ("outliers out", Options { reject_outliers: true, tare_groups: true, ..Options::default() }),
        (
            "saturated",
            Options { range: Some([-1.9, 2.2]), nominal: Some(vec![25.0; 3]), ..Options::default() },
        ),
        ("loads", from_signals.clone()),
        ("loads, quadratic", Options { curvature: Curvature::Quadratic, ..from_signals.clone() }),
        (
            "loads, chosen",
            Options { curvature: Curvature::Chosen, tare_groups: true, ..from_signals.clone() },
        ),
    ] {
        unchanged.note(name, [told(&calibrate(&three, &options))]);
    }
    unchanged.note(
        "six axes",
        [told(&calibrate(&six, &Options { touches: Some(touches()), ..Options::default() }))],
    );
    let mut warm = three.clone();
    let samples = warm.samples();
    let celsius: Vec<f64> = (0..samples).map(|i| 20.0 + (i % 7) as f64).collect();
    for i in 0..samples {
        let warmer = celsius[i] - 22.0;
        for j in 0..3 {
            warm.signals[(i, j)] = warm.signals[(i, j)] * (1.0 + 1e-3 * warmer) + 0.02 * warmer;
        }
    }
    warm.temperatures = Some(celsius);
    warm.weights = Some((0..samples).map(|i| [1.0, 0.5, 2.0][i % 3]).collect());
    let options = Options { reference_celsius: Some(22.0), tare_groups: true, ..Options::default() };
    unchanged.note("temperature", [told(&calibrate(&warm, &options))]);
    unchanged.note("weights", [told(&calibrate(&warm, &Options::default()))]);
    unchanged.check();
}

/// Samples of a file by the row, and a file that is checked against other loads than its own.
#[test]
fn by_the_row_and_checked() {
    let mut unchanged = unchanged("checks");
    let draw = &mut Draw::new(12);
    let (table, other) = (table(draw, &Axis::ALL, 1e-3), table(draw, &Axis::ALL, 5e-3));
    let mut streamed = StreamedFit::new(&Axis::ALL, 6, SignalUnit::Volt, true);
    for i in 0..table.samples() {
        let row = |matrix: &DMatrix<f64>| matrix.row(i).iter().copied().collect::<Vec<_>>();
        assert!(streamed.push(&row(&table.loads), &row(&table.signals), [1.0, 0.5][i % 2]));
    }
    let model = streamed.finish(None).unwrap();
    unchanged.note("by the row", [to_ten_digits(&(model.covariance(), model.matrix_and_zero(), &model))]);
    let file = model.to_file("least squares").unwrap();
    let changed = |change: &dyn Fn(&mut LoadTable)| {
        let mut table = table.clone();
        change(&mut table);
        table
    };
    let tables = [
        ("itself", table.clone()),
        ("another sensor", other),
        ("reaction", changed(&|table| table.loads.neg_mut())),
        ("a gauge turned round", changed(&|table| table.signals.column_mut(2).neg_mut())),
        ("gauges swapped", changed(&|table| table.signals.swap_columns(1, 4))),
        ("other units", changed(&|table| table.loads.columns_mut(3, 3).scale_mut(1000.0))),
        ("another zero", changed(&|table| table.signals.add_scalar_mut(0.7))),
        ("one sample off", changed(&|table| table.signals[(40, 3)] += 0.4)),
    ];
    for (name, table) in tables {
        let report = Report::of_check(&file, &table, &Limits::default(), Some(&touches()));
        unchanged.note(name, [to_ten_digits(&(report.as_ref().map(pages), &report))]);
    }
    let rest = |noise: f64, drift: f64| {
        let mut draw = Draw::new(13);
        DMatrix::from_fn(120, 6, |i, j| 0.31 + 0.01 * j as f64 + noise * draw.noise() + drift * i as f64)
    };
    let tared = [(0.0, 0.0), (1e-3, 0.0), (1e-3, 1e-4), (0.2, 0.0)].map(|(noise, drift)| {
        [true, false].map(|any| to_ten_digits(&file.tared_by(&rest(noise, drift), any)))
    });
    unchanged.note("tared", tared.as_flattened());
    unchanged.note(
        "kept",
        [CalibrationFile::from_toml(&file.to_toml().unwrap()).map(|kept| {
            let load = kept.load(&[0.5, 0.3, 0.4, 0.9, 0.1, 0.2]).unwrap();
            to_ten_digits(&load)
        })],
    );
    unchanged.check();
}
