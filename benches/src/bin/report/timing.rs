//! Times by calibrated repetition.
//!
//! A batch is repeated until it takes some ten microseconds: long enough for the clock, short enough
//! to fall between the interruptions of a busy machine. Of many such batches the median is the time,
//! and the quartiles are its spread.

use core::time::Duration;
use std::time::Instant;

/// How much work the report puts into its figures.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Effort {
    /// `true` for the run of seconds that only shows that everything works.
    pub(crate) quick: bool,
}

impl Effort {
    /// One of two numbers.
    pub(crate) fn choose<T>(self, quick: T, full: T) -> T {
        if self.quick { quick } else { full }
    }

    fn batches(self) -> usize {
        self.choose(15, 201)
    }
}

/// What an item of a batch took \[ns\].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Timed {
    pub(crate) least: f64,
    pub(crate) lower_quartile: f64,
    pub(crate) median: f64,
    pub(crate) upper_quartile: f64,
}

const BATCH: Duration = Duration::from_micros(30);

fn run(repetitions: u32, batch: &mut impl FnMut()) -> Duration {
    let start = Instant::now();
    for _ in 0..repetitions {
        batch();
    }
    start.elapsed()
}

/// Times a batch of so many items.
pub(crate) fn time(effort: Effort, items: usize, mut batch: impl FnMut()) -> Timed {
    let mut repetitions = 1;
    while run(repetitions, &mut batch) < BATCH && repetitions < 1 << 20 {
        repetitions *= 2;
    }
    let mut samples: Vec<f64> = (0..effort.batches())
        .map(|_| run(repetitions, &mut batch).as_secs_f64() * 1e9 / f64::from(repetitions) / items as f64)
        .collect();
    samples.sort_by(f64::total_cmp);
    let at = |share: f64| quantile(&samples, share);
    Timed { least: at(0.0), lower_quartile: at(0.25), median: at(0.5), upper_quartile: at(0.75) }
}

/// The value below which a share of the sorted values lies; NaN of none.
pub(crate) fn quantile(sorted: &[f64], share: f64) -> f64 {
    let last = sorted.len().saturating_sub(1) as f64;
    sorted.get((last * share).round() as usize).copied().unwrap_or(f64::NAN)
}

/// The middle one; NaN of none.
pub(crate) fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    quantile(values, 0.5)
}
