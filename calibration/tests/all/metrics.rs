//! Each figure of a report, on readings made so that it is known.

use fingertip_calibration::Axis;
use fingertip_calibration::file::{CalibrationFile, SignalUnit};
use fingertip_calibration::loads::LoadTable;
use fingertip_calibration::model::Limits;
use fingertip_calibration::nalgebra::DMatrix;
use fingertip_calibration::report::{AxisReport, Report};

/// Powers of two, so that a sensor with these nominal loads reads what its signals say to the last bit.
pub(crate) const FULL_SCALE: [f64; 6] = [8.0, 16.0, 32.0, 0.25, 0.5, 1.0];

/// One sample: load and what the sensor says of it.
pub(crate) type Sample<const N: usize> = ([f64; N], [f64; N]);

/// A sensor whose signals are newtons and newton metres.
pub(crate) fn sensor(axes: usize) -> CalibrationFile {
    let matrix = DMatrix::from_fn(axes, axes, |i, j| if i == j { FULL_SCALE[i] } else { 0.0 });
    CalibrationFile::new(matrix, FULL_SCALE[..axes].to_vec(), vec![0.0; axes], SignalUnit::Wrench).unwrap()
}

pub(crate) fn table<const N: usize>(samples: &[Sample<N>]) -> LoadTable {
    let loads = DMatrix::from_fn(samples.len(), N, |i, j| samples[i].0[j]);
    let said = DMatrix::from_fn(samples.len(), N, |i, j| samples[i].1[j]);
    LoadTable::new(&Axis::ALL[..N], loads, said, SignalUnit::Wrench).unwrap()
}

fn check(table: &LoadTable) -> Report {
    Report::of_check(&sensor(table.axes.len()), table, &Limits::default(), None).unwrap()
}

pub(crate) fn x(load: f64, said: f64) -> Sample<3> {
    ([load, 0.0, 0.0], [said, 0.0, 0.0])
}

pub(crate) fn y(load: f64, said: f64) -> Sample<3> {
    ([0.0, load, 0.0], [0.0, said, 0.0])
}

fn close(found: Option<f64>, expected: f64) {
    let found = found.unwrap();
    assert!((found - expected).abs() < 1e-12 * (1.0 + expected), "{found} instead of {expected}");
}

#[test]
fn errors_are_percentages_of_full_scale() {
    let table = table(&[x(0.0, 0.0), x(8.0, 8.4), y(16.0, 15.2), ([0.0, 0.0, 32.0], [-0.3, 0.0, 32.0])]);
    let report = check(&table);
    assert_eq!((report.samples, report.cases, report.details.len()), (4, 4, 4));
    let [x, y, z] = &report.axes[..] else { panic!("{report}") };
    close(Some(x.rms), 0.25);
    close(Some(x.rms_percent), 3.125);
    close(Some(x.greatest_percent), 5.0);
    close(Some(y.rms), 0.4);
    close(Some(y.rms_percent), 2.5);
    close(Some(y.greatest_percent), 5.0);
    assert_eq!((x.greatest_at.as_str(), y.greatest_at.as_str()), ("sample 2", "sample 3"));
    assert_eq!((z.rms, z.rms_percent, z.greatest_percent), (0.0, 0.0, 0.0));
    let scales: Vec<f64> = report.axes.iter().map(|axis| axis.full_scale).collect();
    assert_eq!(scales, FULL_SCALE[..3]);
    let third = report.details.get(2).unwrap();
    assert_eq!(
        (third.name.as_str(), &third.applied, &third.measured),
        ("sample 3", &vec![0.0, 16.0, 0.0], &vec![0.0, 15.2, 0.0])
    );
    // Nothing was fitted.
    assert!(
        report.axes.iter().all(|axis| axis.left_out_percent.is_none() && axis.deviation_percent.is_none())
    );
}

#[test]
fn cross_talk_is_of_loads_of_one_axis_alone() {
    let tiny = 1e-3 * FULL_SCALE[1];
    let mut samples = vec![
        ([8.0, 0.0, 0.0], [8.0, 0.8, -0.64]),
        ([-8.0, 0.0, 0.0], [-8.0, -1.6, 0.32]),
        ([0.0, 0.0, 0.0], [1.0, 1.0, 1.0]),
        // Of two axes: neither's cross-talk.
        ([8.0, 8.0, 0.0], [8.0, 8.0, 16.0]),
        // So little of another axis does not count, wherever it stands.
        ([8.0, tiny, 0.0], [8.0, tiny + 3.2, 0.0]),
        ([1e-3 * FULL_SCALE[0], 16.0, 0.0], [1e-3 * FULL_SCALE[0], 16.0, 0.96]),
    ];
    let rows = |samples: &[Sample<3>]| check(&table(samples)).cross_talk_percent;
    let found = rows(&samples);
    close(found[1][0], 20.0);
    close(found[2][0], 2.0);
    close(found[2][1], 3.0);
    close(found[0][1], 0.0);
    let unknown: Vec<bool> = found.iter().map(|row| row[2].is_none()).collect();
    assert_eq!(unknown, [true; 3]);
    assert!((0..3).all(|i| found[i][i].is_none()));
    // A little more does.
    samples[4].0[1] = 1.01 * tiny;
    close(rows(&samples)[1][0], 10.0);
}

#[test]
fn linearity_is_about_the_best_line_through_zero() {
    let samples = [x(0.0, 0.5), x(2.0, 2.2), x(4.0, 4.0), x(-8.0, -7.9), y(16.0, 17.0)];
    let report = check(&table(&samples));
    let slope = (2.0 * 2.2 + 4.0 * 4.0 + 8.0 * 7.9) / (4.0 + 16.0 + 64.0);
    close(report.axes[0].linearity_percent, 100.0 * (2.2 - 2.0 * slope) / 8.0);
    // One load, however often, tells of no line.
    assert_eq!((report.axes[1].linearity_percent, report.axes[2].linearity_percent), (None, None));
    let twice = [y(16.0, 17.0), y(16.0, 16.0), y(8.0, 8.0)];
    assert_eq!(check(&table(&twice[..2])).axes[1].linearity_percent, None);
    let slope = (16.0 * 33.0 + 64.0) / (2.0 * 256.0 + 64.0);
    close(check(&table(&twice)).axes[1].linearity_percent, 100.0 * (17.0 - 16.0 * slope) / 16.0);
}

fn of(samples: &[Sample<3>], groups: &[usize], value: fn(&AxisReport) -> Option<f64>) -> [Option<f64>; 3] {
    let mut table = table(samples);
    table.groups = groups.to_vec();
    // Readings 2 and 3 at the same time.
    table.times = Some((0..samples.len()).map(|i| if i == 2 { 1.0 } else { i as f64 }).collect());
    let report = check(&table);
    core::array::from_fn(|axis| value(&report.axes[axis]))
}

#[test]
fn hysteresis_is_between_rising_and_falling_load() {
    let hysteresis =
        |samples: &[Sample<3>], groups: &[usize]| of(samples, groups, |axis| axis.hysteresis_percent);
    // Means of two rising and of two falling readings; held loads count as neither.
    let samples = [
        x(0.0, 0.0),
        x(4.0, 4.1),
        x(4.0, 9.0),
        x(8.0, 8.0),
        x(4.0, 4.5),
        x(0.0, 0.3),
        x(4.0, 4.3),
        x(8.0, 8.0),
        x(4.0, 4.7),
        // The sign of a load is not its way: this one rises.
        x(0.0, 0.0),
        x(-2.0, -2.5),
        x(0.0, 0.0),
    ];
    let found = hysteresis(&samples, &[0; 12]);
    close(found[0], 100.0 * 0.4 / 8.0);
    assert_eq!(found[1], Some(0.0));
    // Another group is another mounting: neither its loads nor the way to them belong here.
    let mut groups = [0; 12];
    groups[4..].fill(1);
    let found = hysteresis(&samples, &groups);
    close(found[0], 100.0 * 0.4 / 8.0);
    groups[5..].fill(2);
    close(hysteresis(&samples, &groups)[0], 100.0 * 0.4 / 8.0);
    assert_eq!(hysteresis(&samples[..5], &[0, 0, 0, 0, 1])[0], None);
    assert_eq!(hysteresis(&samples[..4], &[0; 4])[0], None);
    // Sizes are shares of full scale: from 4 N of 8 to 6 N of 16 the load falls.
    let across = [x(0.0, 0.0), x(4.0, 4.0), y(6.0, 6.5), y(0.0, 0.0), y(6.0, 6.1)];
    close(hysteresis(&across, &[0; 5])[1], 100.0 * 0.4 / 16.0);
    // The greatest of several, in any direction.
    let several = [x(0.0, 0.0), x(2.0, 2.0), x(4.0, 4.0), x(8.0, 8.0), x(4.0, 3.8), x(2.0, 2.4), y(0.0, 0.0)];
    close(hysteresis(&several, &[0; 7])[0], 100.0 * 0.4 / 8.0);
}

#[test]
fn repeatability_is_pooled_over_loads() {
    let repeatability =
        |samples: &[Sample<3>], groups: &[usize]| of(samples, groups, |axis| axis.repeatability_percent);
    let samples = [
        x(4.0, 1.0),
        x(8.0, 2.0),
        x(4.0, 3.0),
        x(8.0, 2.0),
        x(8.0, 5.0),
        x(0.0, 7.0),
        x(0.0, 9.0),
        x(2.0, 0.0),
    ];
    // Sums of squares 2 and 6 of one and two degrees of freedom; in any group.
    for groups in [[0; 8], [0, 1, 2, 3, 4, 5, 6, 7]] {
        let found = repeatability(&samples, &groups);
        close(found[0], 100.0 * (8.0_f64 / 3.0).sqrt() / 8.0);
        close(found[1], 0.0);
    }
    assert_eq!(repeatability(&samples[5..], &[0; 3]), [None; 3]);
}

#[test]
fn zero_returns_after_loading() {
    let zero_return =
        |samples: &[Sample<3>], groups: &[usize]| of(samples, groups, |axis| axis.zero_return_percent);
    let samples = [
        x(0.0, 0.1),
        x(0.0, 5.0), // after no load: not counted
        x(8.0, 8.0),
        x(0.0, -0.3),
        x(8.0, 8.0),
        x(0.0, 0.2),
    ];
    close(zero_return(&samples, &[0; 6])[0], 100.0 * 0.4 / 8.0);
    // In a group of its own the first reading without load is the zero, and what comes before is none.
    close(zero_return(&samples, &[0, 0, 0, 1, 1, 1])[0], 100.0 * 0.5 / 8.0);
    assert_eq!(zero_return(&samples, &[0, 0, 0, 1, 2, 2])[0], None);
    assert_eq!(zero_return(&samples[..3], &[0; 3])[0], None);
    // A reading without load that follows another group's load.
    assert_eq!(zero_return(&samples, &[0, 0, 1, 0, 1, 0])[0], None);
}

#[test]
fn creep_is_of_a_load_that_is_held() {
    let creep = |samples: &[Sample<3>], groups: &[usize]| of(samples, groups, |axis| axis.creep_percent);
    let samples = [
        x(0.0, 0.0),
        x(4.0, 4.0),
        x(4.0, 9.0), // at the same time: not counted
        x(4.0, 4.2),
        x(4.0, 3.6),
        x(8.0, 8.0),
        x(8.0, 8.3),
        x(0.0, 0.0),
        x(0.0, 5.0),
    ];
    close(creep(&samples, &[0; 9])[0], 100.0 * 0.4 / 8.0);
    close(creep(&samples, &[0, 0, 0, 0, 1, 1, 1, 1, 1])[0], 100.0 * 0.3 / 8.0);
    assert_eq!(creep(&samples[..3], &[0; 3])[0], None);
    assert_eq!(creep(&samples[7..], &[0; 2])[0], None);
    assert_eq!(check(&table(&samples)).axes[0].creep_percent, None);
}

/// A force of 10 N on a line that is so many metres off the origin, read as if it were so many further off.
fn line(off: f64, further: f64, scale: f64) -> Sample<6> {
    let wrench = |distance: f64, scale: f64| {
        // Along y, the line displaced along z: m = (−z f, 0, 0).
        [0.0, 8.0 * scale, 0.0, -distance * 8.0 * scale, 0.0, 0.0]
    };
    (wrench(off, 1.0), wrench(off + further, scale))
}

#[test]
fn lines_of_action_are_off_by_their_distance() {
    let mut samples = vec![
        line(0.01, 1e-3, 1.0),
        // The size of what is read does not matter.
        line(-0.02, 4e-3, 1.5),
        line(0.0, -2e-3, 0.5),
        // Not a pure force: a torque along it.
        ([0.0, 8.0, 0.0, 0.0, 0.1, 0.0], [0.0, 8.0, 0.0, 0.1, 0.1, 0.0]),
        // Less than a fiftieth of full scale.
        ([0.0, 0.3, 0.0, 0.0, 0.0, 0.0], [0.0, 0.3, 0.0, 0.1, 0.0, 0.0]),
        // No force is read.
        ([0.0, 8.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.1, 0.0, 0.0]),
    ];
    let lines = check(&table(&samples)).lines.unwrap();
    assert_eq!((lines.lines, lines.expected_mm), (3, None));
    close(Some(lines.median_mm), 2.0);
    close(Some(lines.greatest_mm), 4.0);
    // Of an even number the median lies between two. A fiftieth of full scale is enough.
    let fiftieth = 0.02 * FULL_SCALE[1];
    samples.push(([0.0, fiftieth, 0.0, 0.0, 0.0, 0.0], [0.0, fiftieth, 0.0, 3e-3 * fiftieth, 0.0, 0.0]));
    let lines = check(&table(&samples)).lines.unwrap();
    assert_eq!(lines.lines, 4);
    close(Some(lines.median_mm), 2.5);
    // A force of any direction, off by 3 mm sideways and 4 mm upwards, and along itself, which is no error.
    let (force, point) = ([3.0, 0.0, 4.0], [0.01, 0.02, -0.01]);
    let off = [0.004 * 0.8 + 0.3, 0.003, -0.004 * 0.6 + 0.4];
    let moment = |p: [f64; 3]| {
        let [fx, fy, fz] = force;
        [fx, fy, fz, p[1] * fz - p[2] * fy, p[2] * fx - p[0] * fz, p[0] * fy - p[1] * fx]
    };
    let skew = (moment(point), moment(core::array::from_fn(|i| point[i] + off[i])));
    let lines = check(&table(&[skew])).lines.unwrap();
    assert!((lines.median_mm - 5.0).abs() < 1e-9 && lines.greatest_mm == lines.median_mm, "{lines:?}");
    // Without torques, or pure forces, there are no lines.
    assert_eq!(check(&table(&[x(8.0, 8.0)])).lines, None);
    assert_eq!(check(&table(&samples[3..6])).lines, None);
}
