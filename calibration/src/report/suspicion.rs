//! Mistakes that people make with calibrations, and how to recognise them.

use core::fmt;

use nalgebra::DMatrix;
use serde::Serialize;

use crate::Axis;
use crate::file::CalibrationFile;
use crate::fit::least_squares;
use crate::linear::{Singular, pseudo_inverse};
use crate::loads::{LoadTable, spread};

/// A mistake that would explain the errors.
///
/// ```
/// # use fingertip_calibration::{Axis, file::SignalUnit, loads::LoadTable, nalgebra::DMatrix};
/// # // Six loads one after another, up to ±9.5 N and ±95 N·mm; gauges of 0.1 V/N or 10 V/(N·m) that scatter.
/// # let size = [1.0, 1.0, 1.0, 0.01, 0.01, 0.01];
/// # let loads = DMatrix::from_fn(120, 6, |i, j| if i % 6 == j { ((i / 6) as f64 - 9.5) * size[j] } else { 0.0 });
/// # let signals = loads.map_with_location(|i, j, load| 0.1 * load / size[j] + 1e-3 * ((7 * i + 3 * j) as f64).sin());
/// # let table = LoadTable::new(&Axis::ALL, loads, signals, SignalUnit::Volt)?;
/// use fingertip_calibration::model::{Limits, Options};
/// use fingertip_calibration::report::{Report, Suspicion};
///
/// let file = fingertip_calibration::calibrate(&table, &Options::default())?.to_file()?;
/// // Somebody checks it with torques in N·mm, and says that they are in N·m.
/// let mut wrong = table.clone();
/// wrong.loads.columns_mut(3, 3).scale_mut(1000.0);
/// let report = Report::of_check(&file, &wrong, &Limits::default(), None)?;
/// let suspicion: &Suspicion = report.suspicions.first().ok_or("nothing is suspected")?;
/// assert!(suspicion.after_percent < 0.1 * suspicion.before_percent);
/// assert!(suspicion.to_string().starts_with("Tx, Ty, Tz too small by a factor of 1000.0"), "{suspicion}");
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Suspicion {
    /// What seems to be wrong.
    pub mistake: Mistake,
    /// RMS error over all axes as things are, % of full scale.
    pub before_percent: f64,
    /// The same with the mistake mended.
    pub after_percent: f64,
    /// Whether both are without the worst fifth of the samples, where outliers would hide the mistake.
    pub outliers_aside: bool,
}

/// What people get wrong.
///
/// ```
/// # use fingertip_calibration::{Axis, file::SignalUnit, loads::LoadTable, nalgebra::DMatrix};
/// # // Six loads one after another, up to ±9.5 N and ±95 N·mm; gauges of 0.1 V/N or 10 V/(N·m) that scatter.
/// # let size = [1.0, 1.0, 1.0, 0.01, 0.01, 0.01];
/// # let loads = DMatrix::from_fn(120, 6, |i, j| if i % 6 == j { ((i / 6) as f64 - 9.5) * size[j] } else { 0.0 });
/// # let signals = loads.map_with_location(|i, j, load| 0.1 * load / size[j] + 1e-3 * ((7 * i + 3 * j) as f64).sin());
/// # let table = LoadTable::new(&Axis::ALL, loads, signals, SignalUnit::Volt)?;
/// use fingertip_calibration::model::{Limits, Options};
/// use fingertip_calibration::report::{Mistake, Report};
///
/// let file = fingertip_calibration::calibrate(&table, &Options::default())?.to_file()?;
/// // The plugs of the first and the fourth gauge are exchanged.
/// let mut wrong = table.clone();
/// wrong.signals.swap_columns(0, 3);
/// let report = Report::of_check(&file, &wrong, &Limits::default(), None)?;
/// let mistakes: Vec<&Mistake> = report.suspicions.iter().map(|suspicion| &suspicion.mistake).collect();
/// assert!(mistakes.contains(&&Mistake::Gauges { first: 1, second: 4 }));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub enum Mistake {
    /// Rows and columns of the matrix are exchanged.
    Transposed,
    /// The matrix is that from loads to signals where that from signals to loads is meant, or the
    /// other way round.
    Inverted,
    /// Both.
    TransposedAndInverted,
    /// One axis stands for another: `reads[i]` is the axis that column `i` in truth holds, and
    /// whether its sign is reversed.
    Axes {
        /// For each axis of the table, the axis that the sensor calls so and whether reversed.
        reads: Vec<(Axis, bool)>,
    },
    /// Two gauges are exchanged, counting from 1.
    Gauges {
        /// One.
        first: usize,
        /// The other.
        second: usize,
    },
    /// The readings of an axis are off by a factor that is one between units.
    Unit {
        /// Which axes.
        axes: Vec<Axis>,
        /// By what the readings are too large.
        factor: f64,
        /// Which confusion gives this factor.
        confusion: &'static str,
    },
}

impl fmt::Display for Suspicion {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.mistake {
            Mistake::Transposed => write!(formatter, "the matrix seems to be transposed")?,
            Mistake::Inverted => write!(formatter, "the matrix seems to be the inverse of what is meant")?,
            Mistake::TransposedAndInverted => {
                write!(formatter, "the matrix seems to be transposed and inverted")?;
            }
            Mistake::Axes { reads } => {
                let names: Vec<String> = reads
                    .iter()
                    .map(|(axis, minus)| format!("{}{axis}", if *minus { "−" } else { "" }))
                    .collect();
                write!(
                    formatter,
                    "axes or signs seem to be exchanged: the sensor gives {}",
                    names.join(", ")
                )?;
            }
            Mistake::Gauges { first, second } => {
                write!(formatter, "gauges {first} and {second} seem to be exchanged")?;
            }
            Mistake::Unit { axes, factor, confusion } => {
                let names: Vec<String> = axes.iter().map(ToString::to_string).collect();
                let (way, factor) =
                    if *factor < 1.0 { ("small", factor.recip()) } else { ("large", *factor) };
                write!(
                    formatter,
                    "{} too {way} by a factor of {factor:.6}: {confusion} seem to be confused",
                    names.join(", ")
                )?;
            }
        }
        write!(
            formatter,
            " ({:.2} % of full scale as it is, {:.2} % if mended{})",
            self.before_percent,
            self.after_percent,
            if self.outliers_aside { ", outliers aside" } else { "" }
        )
    }
}

/// A mistake is suspected if mending it divides the error by at least this.
const LEAST_GAIN: f64 = 3.0;

/// Factors between units that are confused in practice.
const CONFUSIONS: [(f64, &str); 12] = [
    (1000.0, "milli and unit (N·mm and N·m, mV and V)"),
    (100.0, "N·cm and N·m"),
    (9.806_65, "kilogram-force and newton"),
    (9.806_65e-3, "gram-force and newton"),
    (4.448_221_615_260_5, "pound-force and newton"),
    (0.112_984_829_027_616_7, "lbf·in and N·m"),
    (1.355_817_948_331_400_4, "lbf·ft and N·m"),
    (25.4, "inch and millimetre"),
    (39.370_078_740_157_48, "inch and metre"),
    (12.0, "inch and foot"),
    (2.0, "peak to peak and amplitude, or full and half bridge"),
    (3.280_839_895_013_123, "foot and metre"),
];

/// Of more samples than this, so many are asked, spread over all: a mistake makes errors everywhere.
const ASKED: usize = 20_000;

/// Mistakes that would explain the errors of a calibration on known loads, best explanation first. Of a table of more than
/// 20 000 samples, as many that are spread over it tell, and the errors that are said are of these.
pub(crate) fn suspicions(
    file: &CalibrationFile,
    table: &LoadTable,
    predicted: &DMatrix<f64>,
) -> Vec<Suspicion> {
    if table.samples() > ASKED {
        let asked = spread(table.samples(), ASKED);
        return of_all(file, &table.rows(&asked), &predicted.select_rows(&asked));
    }
    of_all(file, table, predicted)
}

fn of_all(file: &CalibrationFile, table: &LoadTable, predicted: &DMatrix<f64>) -> Vec<Suspicion> {
    let full_scale = &file.nominal;
    // Over all samples, and without the worst fifth.
    let errors = |loads: &DMatrix<f64>| {
        let difference = crate::model::normalised(&(loads - &table.loads), full_scale);
        let mut squares: Vec<f64> = difference.row_iter().map(|row| row.norm_squared()).collect();
        squares.sort_by(f64::total_cmp);
        let percent = |squares: &[f64]| {
            100.0 * (squares.iter().sum::<f64>() / (squares.len() * full_scale.len()).max(1) as f64).sqrt()
        };
        [percent(&squares), percent(&squares[..squares.len().min((squares.len() * 4).div_ceil(5))])]
    };
    let before = errors(predicted);
    let mut found = Vec::new();
    let mut consider = |mistake: Mistake, loads: &DMatrix<f64>| {
        let after = errors(loads);
        let explains = |k: usize| after[k].is_finite() && after[k] * LEAST_GAIN < before[k];
        if let Some(k) = [0, 1].into_iter().find(|k| explains(*k)) {
            found.push(Suspicion {
                mistake,
                before_percent: before[k],
                after_percent: after[k],
                outliers_aside: k == 1,
            });
        }
    };
    for (mistake, loads) in of_the_matrix(file, table) {
        consider(mistake, &loads);
    }
    for (mistake, loads) in of_the_axes(table, full_scale, predicted) {
        consider(mistake, &loads);
    }
    for (mistake, loads) in of_the_gauges(file, table) {
        consider(mistake, &loads);
    }
    found.sort_by(|a, b| a.after_percent.total_cmp(&b.after_percent));
    found.truncate(3);
    found
}

/// Loads from signals (in SI) with another matrix.
fn read_with(file: &CalibrationFile, table: &LoadTable, inverse: &DMatrix<f64>) -> DMatrix<f64> {
    let mut signals = table.signals.clone();
    for (mut column, zero) in signals.column_iter_mut().zip(&file.zero) {
        column.add_scalar_mut(-zero);
    }
    signals * inverse.transpose()
}

fn of_the_matrix(file: &CalibrationFile, table: &LoadTable) -> Vec<(Mistake, DMatrix<f64>)> {
    // The mistake was made with the matrices as people write them: in SI, not normalised.
    let mut sensitivities = file.matrix.clone();
    for (mut column, nominal) in sensitivities.column_iter_mut().zip(&file.nominal) {
        column /= *nominal;
    }
    let Some(inverse) = pseudo_inverse(&sensitivities) else { return Vec::new() };
    if sensitivities.nrows() != sensitivities.ncols() {
        return Vec::new();
    }
    vec![
        (Mistake::Transposed, read_with(file, table, &inverse.transpose())),
        (Mistake::Inverted, read_with(file, table, &sensitivities)),
        (Mistake::TransposedAndInverted, read_with(file, table, &sensitivities.transpose())),
    ]
}

/// The map from what the sensor says to what was applied, if it is nearly a signed permutation or a
/// change of units.
fn of_the_axes(
    table: &LoadTable,
    full_scale: &[f64],
    predicted: &DMatrix<f64>,
) -> Vec<(Mistake, DMatrix<f64>)> {
    let applied = crate::model::normalised(&table.loads, full_scale);
    let said = crate::model::normalised(predicted, full_scale);
    let Ok(fit) = least_squares(&said, &applied, None) else { return Vec::new() };
    // Row: what the sensor calls so; column: what was applied.
    let map = fit.coefficients;
    let axes = table.axes.len();
    let mut result = Vec::new();
    // The entry that stands out in each column, on the scale of the physical readings.
    let mut strongest = Vec::new();
    for j in 0..axes {
        let share = |i: usize| (map[(i, j)] * said.column(i).norm()).abs();
        let best = (0..axes).max_by(|a, b| share(*a).total_cmp(&share(*b))).unwrap_or(j);
        strongest.push(best);
    }
    let mut sorted = strongest.clone();
    sorted.sort_unstable();
    sorted.dedup();
    if sorted.len() == axes {
        let moved = strongest.iter().enumerate().any(|(j, i)| i != &j || map[(*i, j)] < 0.0);
        if moved {
            let mut loads = DMatrix::zeros(table.samples(), axes);
            for (j, i) in strongest.iter().enumerate() {
                loads.set_column(j, &(predicted.column(*i) * map[(*i, j)].signum()));
            }
            let reads =
                strongest.iter().enumerate().map(|(j, i)| (table.axes[*i], map[(*i, j)] < 0.0)).collect();
            result.push((Mistake::Axes { reads }, loads));
        }
    }
    // One factor for each axis, matched with the known ones to 3 %.
    let mut by_confusion: Vec<(f64, &'static str, Vec<usize>)> = Vec::new();
    for j in 0..axes {
        let size = said.column(j).norm_squared();
        if !(size > 0.0) {
            continue;
        }
        let factor = size / said.column(j).dot(&applied.column(j));
        for (unit, confusion) in CONFUSIONS {
            for candidate in [unit, 1.0 / unit] {
                if (factor / candidate - 1.0).abs() < 0.03 {
                    match by_confusion.iter_mut().find(|(known, _, _)| *known == candidate) {
                        Some((_, _, list)) => list.push(j),
                        None => by_confusion.push((candidate, confusion, vec![j])),
                    }
                }
            }
        }
    }
    for (factor, confusion, list) in by_confusion {
        let mut loads = predicted.clone();
        for j in &list {
            loads.column_mut(*j).scale_mut(1.0 / factor);
        }
        let axes = list.iter().map(|j| table.axes[*j]).collect();
        result.push((Mistake::Unit { axes, factor, confusion }, loads));
    }
    result
}

fn of_the_gauges(file: &CalibrationFile, table: &LoadTable) -> Vec<(Mistake, DMatrix<f64>)> {
    if Singular::new(&file.matrix).is_none_or(|s| s.rank() < file.axes.len()) {
        return Vec::new();
    }
    let Some(mut inverse) = pseudo_inverse(&file.matrix) else { return Vec::new() };
    for (mut row, nominal) in inverse.row_iter_mut().zip(&file.nominal) {
        row *= *nominal;
    }
    let mut result = Vec::new();
    for first in 0..table.gauges() {
        for second in first + 1..table.gauges() {
            let mut swapped = table.clone();
            swapped.signals.swap_columns(first, second);
            let mistake = Mistake::Gauges { first: first + 1, second: second + 1 };
            result.push((mistake, read_with(file, &swapped, &inverse)));
        }
    }
    result
}
