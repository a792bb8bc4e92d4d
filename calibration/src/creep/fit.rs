//! Times and shares of creep from load cycles.

use nalgebra::DMatrix;

use super::cycles::History;
use super::sums::Sums;
use super::{Creep, CreepError, averages};
use crate::loads::LoadTable;

/// What was found of a sensor's creep.
///
/// ```
/// use fingertip_calibration::creep::{CreepFit, fit};
/// use fingertip_calibration::{Axis, file::SignalUnit, loads::LoadTable, nalgebra::DMatrix};
///
/// // 12 cycles: 20 s without load, 20 s with 10 N and less; a gauge of 0.1 V/N of which a solid with 8 s adds 4 %.
/// let newtons = DMatrix::from_fn(480, 1, |second, _| {
///     if second % 40 < 20 { 0.0 } else { 10.0 - 0.5 * (second / 40) as f64 }
/// });
/// let mut lasting = 0.0;
/// let volts = newtons.map(|newtons| {
///     let signal = 0.1 * newtons;
///     lasting += (signal - lasting) * (1.0 - (-1.0_f64 / 8.0).exp());
///     signal + 0.04 * lasting
/// });
/// let mut table = LoadTable::new(&[Axis::Fz], newtons, volts, SignalUnit::Volt)?;
/// table.times = Some((0..480).map(f64::from).collect());
/// let found: CreepFit = fit(&table, false)?;
/// let [without, with] = found.left_out_percent;
/// assert!(found.cycles == 12 && with < 0.3 * without);
/// // About 8 s.
/// assert!(found.creep.times_s.iter().any(|seconds| (seconds / 8.0 - 1.0).abs() < 0.3));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct CreepFit {
    /// Times and shares; without any if none predicts load cycles that were left out better than no creep does.
    pub creep: Creep,
    /// Standard deviation of each share, for these times and errors of the readings that are independent.
    pub deviations: Vec<Vec<f64>>,
    /// How many load cycles there were.
    pub cycles: usize,
    /// What loads and creep leave of the readings of cycles that the fit has not seen, root mean square over all gauges,
    /// % of the span of a gauge: without creep, and with it.
    pub left_out_percent: [f64; 2],
}

/// Fewest load cycles.
const CYCLES: usize = 3;
/// So many parts are left out at most, one after another.
const PARTS: usize = 10;
/// A further time must make the error of cycles left out smaller by this factor.
const WORTH: f64 = 0.95;
/// Neighbouring times differ by this factor at least: those that lie closer are not told apart.
const APART: f64 = 3.0;
/// Times are looked for in steps of this factor, and between the best ones.
const SCAN: f64 = 1.4;
/// How often each time is found anew beside the others.
const ROUNDS: usize = 6;
/// How often an interval of times is narrowed.
const NARROWED: usize = 24;

/// Finds over which times a sensor creeps and by how much, from load cycles with the time of each sample: as many times as
/// predict cycles best that were left out of the fit, three at most.
///
/// For given times the shares of each gauge follow by least squares, beside its sensitivities and a zero of each group, from
/// `reading − zero = sensitivities · loads + Σ shares · averages` (`docs/theory/calibration.md#creep`); a `curved` sensor
/// has products of two loads beside the loads, and drift with temperature is taken as proportional. Times are looked for
/// between two samples and the longest group. Samples must follow each other several times within the shortest time.
///
/// # Errors
/// [`CreepError`].
pub fn fit(table: &LoadTable, curved: bool) -> Result<CreepFit, CreepError> {
    let problem = Problem::of(table, curved)?;
    let nothing = problem.tried(&[])?;
    let mut best = Tried { left_out: nothing.left_out, ..nothing };
    let without = best.left_out;
    let mut times: Vec<f64> = Vec::new();
    while times.len() < Creep::MOST {
        let Some(more) = problem.with_another(&times) else { break };
        let tried = match problem.tried(&more) {
            Ok(tried) if tried.left_out < WORTH * best.left_out => tried,
            _ => break,
        };
        (times, best) = (more, tried);
    }
    Ok(CreepFit {
        creep: Creep { times_s: times, shares: best.shares },
        deviations: best.deviations,
        cycles: problem.history.count,
        left_out_percent: [100.0 * without, 100.0 * best.left_out],
    })
}

/// What some times are worth.
struct Tried {
    /// RMS of what is left of cycles left out, in spans.
    left_out: f64,
    shares: Vec<Vec<f64>>,
    deviations: Vec<Vec<f64>>,
}

struct Problem {
    history: History,
    /// What explains readings beside creep, samples × columns.
    static_part: DMatrix<f64>,
    /// Which part of the cycles each sample belongs to.
    parts: Vec<usize>,
    /// Root of the weight of each sample.
    weights: Vec<f64>,
    /// Between which times is looked \[s\].
    range: [f64; 2],
    /// Of each gauge.
    spans: Vec<f64>,
    groups: Vec<usize>,
}

impl Problem {
    fn of(table: &LoadTable, curved: bool) -> Result<Self, CreepError> {
        let history = History::of(table)?;
        if history.count < CYCLES {
            return Err(CreepError::TooFewCycles { found: history.count, needed: CYCLES });
        }
        let [step, longest] = history.scales().ok_or(CreepError::TooCoarse)?;
        let range = [2.0 * step, longest];
        if !(range[0] * APART < range[1]) {
            return Err(CreepError::TooCoarse);
        }
        let static_part = static_part(table, curved);
        // Every gauge has these, the zeros of its groups, and its shares.
        if table.samples() < static_part.ncols() + history.runs.len() + 2 * Creep::MOST {
            return Err(CreepError::TooCoarse);
        }
        let parts = PARTS.min(history.count);
        let spans = history.signals.column_iter().map(|signal| signal.max() - signal.min());
        Ok(Self {
            parts: history.cycles.iter().map(|cycle| cycle % parts).collect(),
            weights: match &table.weights {
                Some(weights) => weights.iter().map(|weight| weight.sqrt()).collect(),
                None => vec![1.0; table.samples()],
            },
            // A gauge that never changes tells nothing, and spoils nothing.
            spans: spans.map(|span| if span > 0.0 { span } else { f64::INFINITY }).collect(),
            groups: table.groups.clone(),
            history,
            static_part,
            range,
        })
    }

    /// The columns of these samples, weighted and less their mean in each group, as sums; a zero of each group is thereby
    /// found beside all else.
    fn sums(&self, averages: &[DMatrix<f64>], rows: &[usize]) -> Sums {
        let mut groups: Vec<usize> = rows.iter().map(|row| self.groups[*row]).collect();
        groups.sort_unstable();
        groups.dedup();
        let centred = |matrix: &DMatrix<f64>| {
            let mut matrix = matrix.select_rows(rows);
            for group in &groups {
                let of_group: Vec<usize> =
                    (0..rows.len()).filter(|at| self.groups[rows[*at]] == *group).collect();
                let weight = |at: usize| self.weights[rows[at]];
                let total: f64 = of_group.iter().map(|at| weight(*at).powi(2)).sum();
                for mut column in matrix.column_iter_mut() {
                    let sum: f64 = of_group.iter().map(|at| weight(*at).powi(2) * column[*at]).sum();
                    let mean = if total > 0.0 { sum / total } else { 0.0 };
                    of_group.iter().for_each(|at| column[*at] = (column[*at] - mean) * weight(*at));
                }
            }
            matrix
        };
        let averages: Vec<DMatrix<f64>> = averages.iter().map(centred).collect();
        Sums::of(&centred(&self.static_part), &centred(&self.history.signals), &averages)
    }

    fn all_rows(&self) -> Vec<usize> {
        (0..self.groups.len()).collect()
    }

    /// What is left of all readings with averages over these times, in squared spans; infinite where it is not determined.
    fn left(&self, averages: &[DMatrix<f64>]) -> f64 {
        let Some(found) = self.sums(averages, &self.all_rows()).shares() else { return f64::INFINITY };
        let sound = found.iter().all(|found| found.shares.sum() < 1.0);
        let left: f64 = found.iter().zip(&self.spans).map(|(found, span)| found.left / (span * span)).sum();
        if sound && left.is_finite() { left } else { f64::INFINITY }
    }

    /// The times with another one, all found anew; `None` if there is no room for it.
    fn with_another(&self, times: &[f64]) -> Option<Vec<f64>> {
        let known: Vec<DMatrix<f64>> = times.iter().map(|time| averages(&self.history, *time)).collect();
        let is_apart = |time: f64| times.iter().all(|other| (time / other).ln().abs() >= APART.ln());
        let [least, longest] = self.range;
        let steps = ((longest / least).ln() / SCAN.ln()).ceil().clamp(1.0, 200.0);
        let scanned = (0..=steps as usize).map(|step| least * (longest / least).powf(step as f64 / steps));
        let left = |time: f64| {
            let all: Vec<DMatrix<f64>> =
                known.iter().cloned().chain([averages(&self.history, time)]).collect();
            (self.left(&all), time)
        };
        let (least_left, first) =
            scanned.filter(|time| is_apart(*time)).map(left).min_by(|a, b| a.0.total_cmp(&b.0))?;
        if !least_left.is_finite() {
            return None;
        }
        let mut times: Vec<f64> = times.iter().copied().chain([first]).collect();
        let rounds = if times.len() == 1 { 1 } else { ROUNDS };
        for _ in 0..rounds {
            (0..times.len()).for_each(|index| self.find_anew(&mut times, index));
        }
        times.sort_by(f64::total_cmp);
        Some(times)
    }

    /// Finds one of the times anew beside the others, by the golden section between a step of the scan to either side.
    fn find_anew(&self, times: &mut [f64], index: usize) {
        let Some(time) = times.get(index).copied() else { return };
        let mut all: Vec<DMatrix<f64>> = times.iter().map(|time| averages(&self.history, *time)).collect();
        let mut left = |logarithm: f64| {
            if let Some(slot) = all.get_mut(index) {
                *slot = averages(&self.history, logarithm.exp());
            }
            self.left(&all)
        };
        let [least, longest] = self.range.map(f64::ln);
        let (mut low, mut high) = ((time.ln() - SCAN.ln()).max(least), (time.ln() + SCAN.ln()).min(longest));
        let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
        let (mut a, mut b) = (high - golden * (high - low), low + golden * (high - low));
        let (mut at_a, mut at_b) = (left(a), left(b));
        for _ in 0..NARROWED {
            if at_a <= at_b {
                (high, b, at_b) = (b, a, at_a);
                a = high - golden * (high - low);
                at_a = left(a);
            } else {
                (low, a, at_a) = (a, b, at_b);
                b = low + golden * (high - low);
                at_b = left(b);
            }
        }
        let found = if at_a <= at_b { a } else { b };
        if at_a.min(at_b).is_finite() {
            times[index] = found.exp();
        }
    }

    /// Shares for these times, and what they leave of parts that were left out of the fit, one after another.
    fn tried(&self, times: &[f64]) -> Result<Tried, CreepError> {
        let averages: Vec<DMatrix<f64>> = times.iter().map(|time| averages(&self.history, *time)).collect();
        let parts = self.parts.iter().max().map_or(0, |last| last + 1);
        // Each part has its own zeros.
        let of_parts: Vec<Sums> = (0..parts)
            .map(|part| {
                let rows: Vec<usize> = (0..self.parts.len()).filter(|row| self.parts[*row] == part).collect();
                self.sums(&averages, &rows)
            })
            .collect();
        let all = of_parts.iter().skip(1).fold(of_parts.first().cloned(), |all, part| Some(all?.with(part)));
        let all = all.ok_or(CreepError::TooCoarse)?;
        let mut squares = 0.0;
        for part in &of_parts {
            let found = all.without(part).shares().ok_or(CreepError::TooCoarse)?;
            let left = part.left_by(&found);
            squares += left.iter().zip(&self.spans).map(|(left, span)| left / (span * span)).sum::<f64>();
        }
        let found = self.sums(&averages, &self.all_rows()).shares().ok_or(CreepError::TooCoarse)?;
        let weight: f64 = self.weights.iter().map(|weight| weight * weight).sum();
        let count = weight * self.spans.iter().filter(|span| span.is_finite()).count() as f64;
        let fitted = self.static_part.ncols() + self.history.runs.len() + times.len();
        let freedom = self.groups.len().saturating_sub(fitted).max(1) as f64;
        let of_time = |time: usize| found.iter().map(move |found| found.shares[time]).collect();
        let deviation = |time: usize| {
            found.iter().map(move |found| (found.variances[time] * found.left / freedom).sqrt()).collect()
        };
        Ok(Tried {
            left_out: (squares / count).sqrt(),
            shares: (0..times.len()).map(of_time).collect(),
            deviations: (0..times.len()).map(deviation).collect(),
        })
    }
}

/// The loads in full scales; of a curved sensor with their products; and the temperature.
fn static_part(table: &LoadTable, curved: bool) -> DMatrix<f64> {
    let full = table.greatest_loads();
    let rows = table.samples();
    let loads: Vec<Vec<f64>> = full
        .iter()
        .enumerate()
        .map(|(axis, full)| (0..rows).map(|row| table.loads[(row, axis)] / full).collect())
        .collect();
    let mut columns = loads.clone();
    if curved {
        for (index, one) in loads.iter().enumerate() {
            let products = loads.iter().skip(index);
            columns.extend(products.map(|other| one.iter().zip(other).map(|(a, b)| a * b).collect()));
        }
    }
    if let Some(temperatures) = &table.temperatures {
        let first = temperatures.first().copied().unwrap_or_default();
        columns.push(temperatures.iter().map(|celsius| celsius - first).collect());
    }
    DMatrix::from_fn(rows, columns.len(), |row, column| columns[column][row])
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::{PARTS, Problem};
    use crate::Axis;
    use crate::file::SignalUnit;
    use crate::loads::LoadTable;

    /// Cycles are left out in parts, of which there are no more than ten however long the table: each cycle is in one.
    #[test]
    fn parts_are_few_and_of_whole_cycles() {
        for cycles in [3, 9, 10, 11, 25] {
            // Ten samples each, of which the first four are at rest.
            let load = |row: usize| if row % 10 < 4 { 0.0 } else { 1.0 + (row / 10) as f64 };
            let loads = DMatrix::from_fn(10 * cycles, 1, |row, _| load(row));
            let mut table = LoadTable::new(&[Axis::Fz], loads.clone(), loads, SignalUnit::Volt).unwrap();
            table.times = Some((0..10 * cycles).map(|row| row as f64).collect());
            let problem = Problem::of(&table, false).unwrap();
            let mut parts = problem.parts.clone();
            let together = |(part, cycle): (&usize, &usize)| {
                problem.history.cycles.iter().zip(&parts).all(|(other, of)| other != cycle || of == part)
            };
            assert!(parts.iter().zip(&problem.history.cycles).all(together));
            parts.sort_unstable();
            parts.dedup();
            assert_eq!(parts, (0..cycles.min(PARTS)).collect::<Vec<_>>(), "of {cycles} cycles");
        }
    }
}
