//! What is measured of a sensor, axis by axis (`docs/theory/calibration.md#figures-of-quality`; terms of
//! VDI/VDE 2638 and ISO 376, which know one axis only).

use alloc::collections::BTreeMap;
use std::collections::HashMap;

use nalgebra::{DMatrix, Matrix3, Matrix3x6, Matrix6, Vector3};
use serde::Serialize;

use super::samples::LeftOut;
use crate::Axis;
use crate::loads::{LoadTable, same_loads};

/// Errors of one axis. Percentages are of full scale; `None` where the table of loads does not
/// tell.
///
/// ```
/// # use fingertip_calibration::{Axis, file::SignalUnit, loads::LoadTable, nalgebra::DMatrix};
/// # // Three forces one after another, up to ±9.5 N; each has a gauge of 0.1 V/N, and they scatter by a millivolt.
/// # let loads = DMatrix::from_fn(60, 3, |i, j| if i % 3 == j { (i / 3) as f64 - 9.5 } else { 0.0 });
/// # let signals = loads.map_with_location(|i, j, newtons| 0.1 * newtons + 1e-3 * ((7 * i + 3 * j) as f64).sin());
/// # let table = LoadTable::new(&Axis::FORCES, loads, signals, SignalUnit::Volt)?;
/// use fingertip_calibration::report::AxisReport;
/// use fingertip_calibration::{calibrate, model::Options};
///
/// // 7 mN of scatter and a full scale of 9.5 N: 0.07 %.
/// let report = calibrate(&table, &Options::default())?.report;
/// let first: &AxisReport = &report.axes[0];
/// assert_eq!((first.axis, first.full_scale), (Axis::Fx, 9.5));
/// assert!((first.rms_percent - 100.0 * first.rms / 9.5).abs() < 1e-9 && first.rms_percent < 0.1);
/// assert!(first.greatest_percent > first.rms_percent);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AxisReport {
    /// Which axis.
    pub axis: Axis,
    /// Full scale \[N or N·m\].
    pub full_scale: f64,
    /// Root mean square of the error over all samples \[N or N·m\].
    pub rms: f64,
    /// The same, % of full scale.
    pub rms_percent: f64,
    /// Greatest error, % of full scale.
    pub greatest_percent: f64,
    /// Name of the sample with the greatest error.
    pub greatest_at: String,
    /// RMS of the error on loads left out of the fit, a case at a time.
    pub left_out_percent: Option<f64>,
    /// Greatest error on loads left out.
    pub left_out_greatest_percent: Option<f64>,
    /// Standard deviation of one reading, from the residuals and the covariance of the fit, at zero
    /// load.
    pub deviation_percent: Option<f64>,
    /// Greatest deviation from the best line through zero.
    pub linearity_percent: Option<f64>,
    /// Greatest difference between rising and falling load.
    pub hysteresis_percent: Option<f64>,
    /// Pooled standard deviation of readings of the same load.
    pub repeatability_percent: Option<f64>,
    /// Greatest change of the reading without load after loading.
    pub zero_return_percent: Option<f64>,
    /// Greatest change of the reading while a load is held.
    pub creep_percent: Option<f64>,
}

/// What of the loads all axes ask.
struct Loads {
    /// Which samples have the same load, as numbers from 0; of any group.
    anywhere: Vec<usize>,
    /// The same of one group.
    in_group: Vec<usize>,
    /// Samples with a load.
    is_loaded: Vec<bool>,
    /// The square of the load in full scales.
    size: Vec<f64>,
}

impl Loads {
    fn of(table: &LoadTable, full_scale: &[f64]) -> Self {
        let samples = table.samples();
        let (mut is_loaded, mut size) = (vec![false; samples], vec![0.0; samples]);
        for (column, full_scale) in table.loads.column_iter().zip(full_scale) {
            for ((load, is_loaded), size) in column.iter().zip(&mut is_loaded).zip(&mut size) {
                *is_loaded |= *load != 0.0;
                *size += (load / full_scale).powi(2);
            }
        }
        let anywhere = in_order(&same_loads(&table.loads));
        let one_group = table.groups.array_windows().all(|[a, b]| a == b);
        let in_group = if one_group {
            anywhere.clone()
        } else {
            let mut seen = HashMap::new();
            let of_group = anywhere.iter().zip(&table.groups).map(|key| {
                let new = seen.len();
                *seen.entry(key).or_insert(new)
            });
            of_group.collect()
        };
        Self { anywhere, in_group, is_loaded, size }
    }
}

/// The same classes numbered in the order in which they first occur: what is kept of each is then read as it lies in memory.
fn in_order(classes: &[usize]) -> Vec<usize> {
    let mut new = vec![usize::MAX; classes.iter().max().map_or(0, |last| last + 1)];
    let mut next = 0;
    let mut renumbered = Vec::with_capacity(classes.len());
    for class in classes {
        let number = &mut new[*class];
        if *number == usize::MAX {
            *number = next;
            next += 1;
        }
        renumbered.push(*number);
    }
    renumbered
}

/// How many classes there are.
fn count(classes: &[usize]) -> usize {
    classes.iter().max().map_or(0, |last| last + 1)
}

/// The errors of every axis; `predicted` is samples × axes.
pub(crate) fn axis_reports(
    table: &LoadTable,
    full_scale: &[f64],
    predicted: &DMatrix<f64>,
    left_out: Option<&LeftOut>,
) -> Vec<AxisReport> {
    let error = predicted - &table.loads;
    let loads = Loads::of(table, full_scale);
    let rms = |values: &mut dyn Iterator<Item = f64>| {
        let (sum, count) = values.fold((0.0, 0_u32), |(sum, count), x| (sum + x * x, count + 1));
        (sum / f64::from(count.max(1))).sqrt()
    };
    let known = left_out.and_then(LeftOut::all);
    table
        .axes
        .iter()
        .enumerate()
        .map(|(j, axis)| {
            let percent = |x: f64| 100.0 * x / full_scale[j];
            let column = error.column(j);
            let worst =
                (0..column.len()).max_by(|a, b| column[*a].abs().total_cmp(&column[*b].abs())).unwrap_or(0);
            let applied = &table.loads;
            let out = known.map(|known| (0..known.nrows()).map(move |i| known[(i, j)] - applied[(i, j)]));
            let one = rms(&mut column.iter().copied());
            AxisReport {
                axis: *axis,
                full_scale: full_scale[j],
                rms: one,
                rms_percent: percent(one),
                greatest_percent: percent(column[worst].abs()),
                greatest_at: table.names.get(worst).into_owned(),
                left_out_percent: out.clone().map(|mut out| percent(rms(&mut out))),
                left_out_greatest_percent: out
                    .map(|out| percent(out.fold(0.0, |most, x: f64| most.max(x.abs())))),
                deviation_percent: None,
                linearity_percent: linearity(table, predicted, j).map(percent),
                hysteresis_percent: hysteresis(table, &loads, predicted, j).map(percent),
                repeatability_percent: repeatability(&loads, predicted, j).map(percent),
                zero_return_percent: zero_return(table, &loads, predicted, j).map(percent),
                creep_percent: creep(table, &loads, predicted, j).map(percent),
            }
        })
        .collect()
}

fn linearity(table: &LoadTable, predicted: &DMatrix<f64>, axis: usize) -> Option<f64> {
    let pairs: Vec<(f64, f64)> = (0..table.samples())
        .map(|i| (table.loads[(i, axis)], predicted[(i, axis)]))
        .filter(|(load, _)| *load != 0.0)
        .collect();
    let first = pairs.first()?.0;
    if pairs.iter().all(|(load, _)| *load == first) {
        return None;
    }
    let slope = pairs.iter().map(|(l, p)| l * p).sum::<f64>() / pairs.iter().map(|(l, _)| l * l).sum::<f64>();
    Some(pairs.iter().map(|(l, p)| (p - slope * l).abs()).fold(0.0, f64::max))
}

fn hysteresis(table: &LoadTable, loads: &Loads, predicted: &DMatrix<f64>, axis: usize) -> Option<f64> {
    if count(&loads.in_group) == loads.in_group.len() {
        // No load comes twice.
        return None;
    }
    // Sum and number of the readings with rising and with falling load.
    let mut seen = vec![[(0.0, 0_u32); 2]; count(&loads.in_group)];
    let mut before = 0.0;
    for (i, now) in loads.size.iter().enumerate() {
        if i > 0 && table.groups[i] == table.groups[i - 1] && *now > 0.0 && *now != before {
            let entry = &mut seen[loads.in_group[i]][usize::from(*now < before)];
            *entry = (entry.0 + predicted[(i, axis)], entry.1 + 1);
        }
        before = *now;
    }
    let differences = seen.iter().filter(|[up, down]| up.1 > 0 && down.1 > 0);
    differences.map(|[up, down]| (up.0 / f64::from(up.1) - down.0 / f64::from(down.1)).abs()).reduce(f64::max)
}

fn repeatability(loads: &Loads, predicted: &DMatrix<f64>, axis: usize) -> Option<f64> {
    if count(&loads.anywhere) == loads.anywhere.len() {
        return None;
    }
    let loaded = || (0..loads.is_loaded.len()).filter(|i| loads.is_loaded[*i]);
    let mut seen = vec![(0.0, 0_u32); count(&loads.anywhere)];
    for i in loaded() {
        let (sum, count) = &mut seen[loads.anywhere[i]];
        (*sum, *count) = (*sum + predicted[(i, axis)], *count + 1);
    }
    let squares: f64 = loaded()
        .map(|i| (predicted[(i, axis)], seen[loads.anywhere[i]]))
        .filter(|(_, (_, count))| *count > 1)
        .map(|(reading, (sum, count))| (reading - sum / f64::from(count)).powi(2))
        .sum();
    let freedom: f64 = seen.iter().map(|(_, count)| f64::from(count.saturating_sub(1))).sum();
    (freedom > 0.0).then(|| (squares / freedom).sqrt())
}

fn zero_return(table: &LoadTable, loads: &Loads, predicted: &DMatrix<f64>, axis: usize) -> Option<f64> {
    let mut first: BTreeMap<usize, f64> = BTreeMap::new();
    let mut greatest: Option<f64> = None;
    // Where nothing is unloaded, nothing is to be looked up.
    for i in (0..table.samples()).filter(|i| !loads.is_loaded[*i]) {
        let follows_load = i > 0 && table.groups[i - 1] == table.groups[i] && loads.is_loaded[i - 1];
        match first.get(&table.groups[i]) {
            None => {
                first.insert(table.groups[i], predicted[(i, axis)]);
            }
            Some(zero) if follows_load => {
                let change = (predicted[(i, axis)] - zero).abs();
                greatest = Some(greatest.map_or(change, |most| most.max(change)));
            }
            Some(_) => {}
        }
    }
    greatest
}

fn creep(table: &LoadTable, loads: &Loads, predicted: &DMatrix<f64>, axis: usize) -> Option<f64> {
    let times = table.times.as_ref()?;
    let mut greatest: Option<f64> = None;
    let mut start = 0;
    for i in 1..table.samples() {
        if table.groups[i] != table.groups[start] || loads.anywhere[i] != loads.anywhere[start] {
            start = i;
        } else if loads.is_loaded[i] && times[i] > times[start] {
            let change = (predicted[(i, axis)] - predicted[(start, axis)]).abs();
            greatest = Some(greatest.map_or(change, |most| most.max(change)));
        }
    }
    greatest
}

/// Cross-talk, % of full scale: row i, column j is the greatest false reading of axis i under loads
/// of axis j alone; `None` where no load is of axis j alone.
pub(crate) fn cross_talk(
    table: &LoadTable,
    full_scale: &[f64],
    predicted: &DMatrix<f64>,
) -> Vec<Vec<Option<f64>>> {
    let axes = table.axes.len();
    let mut result = vec![vec![None; axes]; axes];
    for i in 0..table.samples() {
        let share = |j: usize| (table.loads[(i, j)] / full_scale[j]).abs();
        let Some(pure) = (0..axes).max_by(|a, b| share(*a).total_cmp(&share(*b))) else { continue };
        let mixed = (0..axes).any(|j| j != pure && share(j) > 1e-3 * share(pure));
        if mixed || !(share(pure) > 0.0) {
            continue;
        }
        for (axis, row) in result.iter_mut().enumerate().filter(|(axis, _)| *axis != pure) {
            let error = 100.0 * (predicted[(i, axis)] - table.loads[(i, axis)]).abs() / full_scale[axis];
            row[pure] = Some(row[pure].map_or(error, |most: f64| most.max(error)));
        }
    }
    result
}

/// How well lines of action are found: what a calibration is worth for touch.
///
/// ```
/// # use fingertip_calibration::{Axis, file::SignalUnit, loads::LoadTable, nalgebra::DMatrix};
/// # // Six loads one after another, up to ±9.5 N and ±95 N·mm; gauges of 0.1 V/N or 10 V/(N·m) that scatter.
/// # let size = [1.0, 1.0, 1.0, 0.01, 0.01, 0.01];
/// # let loads = DMatrix::from_fn(120, 6, |i, j| if i % 6 == j { ((i / 6) as f64 - 9.5) * size[j] } else { 0.0 });
/// # let signals = loads.map_with_location(|i, j, load| 0.1 * load / size[j] + 1e-3 * ((7 * i + 3 * j) as f64).sin());
/// # let table = LoadTable::new(&Axis::ALL, loads, signals, SignalUnit::Volt)?;
/// use fingertip_calibration::report::LineReport;
/// use fingertip_calibration::{calibrate, model::Options};
///
/// // Torques that scatter by 0.07 N·mm shift the line of a force of some newtons by some hundredths of a millimetre.
/// let lines: LineReport = calibrate(&table, &Options::default())?.report.lines.ok_or("no forces")?;
/// assert!(lines.lines > 0 && lines.median_mm > 1e-3 && lines.median_mm < 0.1);
/// assert!(lines.greatest_mm > lines.median_mm);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LineReport {
    /// How many samples are pure forces on a known line.
    pub lines: usize,
    /// Median distance between the foot of the true line and the measured line \[mm\].
    pub median_mm: f64,
    /// Greatest such distance \[mm\].
    pub greatest_mm: f64,
    /// Median of the distance that the covariance of the fit makes one expect, within 2 % \[mm\].
    pub expected_mm: Option<f64>,
}

/// The median of the length of a normal vector with this covariance: that of a χ² of as many degrees of freedom as have the
/// same mean and variance (Satterthwaite 1946), by Wilson & Hilferty (1931). Within 2 % for vectors across a line.
fn median_distance(covariance: &Matrix3<f64>) -> f64 {
    let mean = covariance.trace();
    let squares = covariance.norm_squared();
    if !(mean > 0.0 && squares > 0.0) {
        return 0.0;
    }
    let freedom = mean * mean / squares;
    (mean * (1.0 - 2.0 / (9.0 * freedom)).powi(3)).sqrt()
}

/// Of more lines than this, so many evenly spread ones tell the median of what is expected.
const EXPECTED: usize = 20_000;

/// Distances between true and measured lines of action, for samples that are pure forces of at least a
/// fiftieth of full scale. `None` unless all six axes are there.
pub(crate) fn lines(
    table: &LoadTable,
    full_scale: &[f64],
    predicted: &DMatrix<f64>,
    covariance: impl Fn(&[f64]) -> Option<DMatrix<f64>>,
) -> Option<LineReport> {
    if table.axes != Axis::ALL {
        return None;
    }
    let vector = |matrix: &DMatrix<f64>, i: usize, from: usize| {
        Vector3::new(matrix[(i, from)], matrix[(i, from + 1)], matrix[(i, from + 2)])
    };
    let (mut distances, mut expected) = (Vec::new(), Vec::new());
    let is_line = |i: &usize| {
        let (force, torque) = (vector(&table.loads, *i, 0), vector(&table.loads, *i, 3));
        let large = (0..3).any(|j| (table.loads[(*i, j)] / full_scale[j]).abs() >= 0.02);
        large && !(force.dot(&torque).abs() > 1e-3 * force.norm() * torque.norm())
    };
    let known: Vec<usize> = (0..table.samples()).filter(is_line).collect();
    let every = known.len().div_ceil(EXPECTED).max(1);
    for i in known {
        let (force, torque) = (vector(&table.loads, i, 0), vector(&table.loads, i, 3));
        let foot = force.cross(&torque) / force.norm_squared();
        let (f, m) = (vector(predicted, i, 0), vector(predicted, i, 3));
        let squared = f.norm_squared();
        if !(squared > 0.0) {
            continue;
        }
        // The foot of the true line lies off the measured line by |f × (m − r × f)| / |f|².
        distances.push(1e3 * f.cross(&(m - foot.cross(&f))).norm() / squared);
        let [load, moment]: [[f64; 3]; 2] = [force.into(), torque.into()];
        // The first of all lines among them.
        if (distances.len() - 1).is_multiple_of(every)
            && let Some(covariance) = covariance(&[load, moment].concat())
        {
            let cross = f.cross_matrix() / squared;
            let mut jacobian = Matrix3x6::zeros();
            jacobian.fixed_columns_mut::<3>(0).copy_from(&(-cross * foot.cross_matrix()));
            jacobian.fixed_columns_mut::<3>(3).copy_from(&cross);
            let spread = jacobian * Matrix6::from_fn(|i, j| covariance[(i, j)]) * jacobian.transpose();
            expected.push(1e3 * median_distance(&spread));
        }
    }
    let median = |list: &mut Vec<f64>| {
        list.sort_by(f64::total_cmp);
        let n = list.len();
        (n > 0).then(|| if n % 2 == 1 { list[n / 2] } else { 0.5 * (list[n / 2 - 1] + list[n / 2]) })
    };
    Some(LineReport {
        lines: distances.len(),
        median_mm: median(&mut distances)?,
        greatest_mm: distances.last().copied()?,
        expected_mm: median(&mut expected),
    })
}

#[cfg(test)]
mod tests;
