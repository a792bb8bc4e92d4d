//! The load cycles of a table, and the signals in them.

use nalgebra::DMatrix;

use super::CreepError;
use crate::loads::LoadTable;

/// Below this share of the greatest load of each axis there is none.
const NO_LOAD: f64 = 0.01;

/// A table as it went by.
pub(super) struct History {
    /// The samples of each group, in their order.
    pub(super) runs: Vec<Vec<usize>>,
    /// Time of each sample \[s\].
    pub(super) times: Vec<f64>,
    /// Readings less the zero of their group, samples × gauges.
    pub(super) signals: DMatrix<f64>,
    /// The load cycle of each sample, counted through all groups.
    pub(super) cycles: Vec<usize>,
    /// How many there are.
    pub(super) count: usize,
}

impl History {
    pub(super) fn of(table: &LoadTable) -> Result<Self, CreepError> {
        let times = table.times.clone().ok_or(CreepError::NoTimes)?;
        let full = table.greatest_loads();
        let is_loaded =
            |row: usize| (0..full.len()).any(|axis| table.loads[(row, axis)].abs() > NO_LOAD * full[axis]);
        let mut groups: Vec<usize> = table.groups.clone();
        groups.sort_unstable();
        groups.dedup();
        let (mut runs, mut signals, mut cycles) =
            (Vec::new(), table.signals.clone(), vec![0; table.samples()]);
        let mut count = 0;
        for group in groups {
            let run: Vec<usize> = (0..table.samples()).filter(|row| table.groups[*row] == group).collect();
            if let Some([_, later]) = run.array_windows().find(|[a, b]| times[*b] < times[*a]) {
                return Err(CreepError::TimeGoesBack { sample: table.names.get(*later).into_owned() });
            }
            let resting: Vec<usize> = run.iter().copied().take_while(|row| !is_loaded(*row)).collect();
            if let (true, Some(first)) = (resting.is_empty(), run.first()) {
                return Err(CreepError::BeginsLoaded { sample: table.names.get(*first).into_owned() });
            }
            let zero = table.signals.select_rows(&resting).row_mean();
            let mut was_loaded = false;
            let first_cycle = count;
            for row in &run {
                let mut signal = signals.row_mut(*row);
                signal -= &zero;
                let loaded = is_loaded(*row);
                // A rest belongs to the load before it, the first one to the first load.
                count += usize::from(loaded && !was_loaded);
                was_loaded = loaded;
                cycles[*row] = count.saturating_sub(1).max(first_cycle);
            }
            runs.push(run);
        }
        Ok(Self { runs, times, signals, cycles, count })
    }

    /// The middle time from sample to sample, and the longest from begin to end of a group \[s\]; `None` without either.
    pub(super) fn scales(&self) -> Option<[f64; 2]> {
        let mut steps: Vec<f64> = self
            .runs
            .iter()
            .flat_map(|run| run.array_windows().map(|[a, b]| self.times[*b] - self.times[*a]))
            .filter(|step| *step > 0.0)
            .collect();
        let middle = steps.len() / 2;
        let (_, step, _) =
            (!steps.is_empty()).then(|| steps.select_nth_unstable_by(middle, f64::total_cmp))?;
        let step = *step;
        let span = |run: &Vec<usize>| Some(self.times[*run.last()?] - self.times[*run.first()?]);
        let longest = self.runs.iter().filter_map(span).fold(0.0, f64::max);
        Some([step, longest])
    }
}
