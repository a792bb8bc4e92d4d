//! Where a sensor rests, in the blocks of its trace.

use core::ops::Range;

use super::block::{Block, Cell};
use super::trace::Trace;

/// What is known of a channel before it is known where it rests.
#[derive(Clone, Copy, Debug)]
pub(super) struct Quiet {
    /// Variance of a reading in a quiet block.
    pub(super) variance: f64,
    /// The step of its converter; zero if none shows.
    pub(super) step: f64,
    /// Whether it has a say: a channel that never changes has none.
    pub(super) votes: bool,
}

/// Normal deviations within which blocks at rest stay: once in 10¹⁰ blocks.
const DEVIATIONS: f64 = 6.5;
/// The quartile of variances of the same noise is above its lowest fiftieth by less, degrees of freedom considered.
const MIXED: f64 = 5.0;
/// Variance over that of its changes, for noise that hangs together: a filter at a twentieth of the rate makes 4.
const SLOW: f64 = 9.0;
/// Fewer blocks are no rest.
const FEWEST: usize = 4;
/// Blocks to each side, whose means tell a slow motion.
const SIDE: usize = 4;

/// The variance that a quantile of estimates tells: the share below it, and as many normal deviations. χ² over its degrees
/// of freedom by Wilson & Hilferty's cube.
pub(super) fn variance_at(
    mut estimates: Vec<f64>,
    degrees: f64,
    (share, deviations): (f64, f64),
) -> Option<f64> {
    if estimates.is_empty() {
        return None;
    }
    let place = (share * (estimates.len() - 1) as f64) as usize;
    let quantile = *estimates.select_nth_unstable_by(place, f64::total_cmp).1;
    let ninth = 2.0 / (9.0 * degrees);
    Some(quantile / (1.0 - ninth + deviations * ninth.sqrt()).powi(3))
}

impl Quiet {
    /// By the lower quartile of the variances of blocks, or their lowest fiftieth where much of the recording moves:
    /// then the quartile is far above it.
    pub(super) fn of(trace: &Trace, channel: usize, step: Option<f64>) -> Self {
        let cells = || trace.blocks.iter().filter_map(|block| block.cells.get(channel));
        let moving = || cells().filter(|cell| cell.greatest > cell.least);
        let (step, degrees) = (step.unwrap_or(0.0), f64::from(trace.length() - 1));
        let variances: Vec<f64> = moving().filter_map(Cell::variance).collect();
        let changes: Vec<f64> = moving().filter_map(Cell::variance_of_changes).collect();
        let (Some(quartile), Some(lowest), Some(change)) = (
            variance_at(variances.clone(), degrees, (0.25, -0.674)),
            variance_at(variances, degrees, (0.02, -2.054)),
            variance_at(changes, degrees, (0.25, -0.674)),
        ) else {
            return Self { variance: 0.0, step, votes: false };
        };
        let variance = if quartile > MIXED * lowest { lowest } else { quartile };
        // What moves much more than its changes tell is a motion, not noise.
        Self { variance: variance.min(SLOW * change).max(step * step / 12.0), step, votes: true }
    }

    /// Whether its readings in a block spread like noise.
    fn is_noise(&self, cell: &Cell) -> bool {
        let Some(variance) = cell.variance() else { return false };
        let ninth = 2.0 / (9.0 * f64::from(cell.count.saturating_sub(1).max(1)));
        // Twice, since noise that hangs together scatters more.
        let most = 2.0 * (1.0 - ninth + DEVIATIONS * ninth.sqrt()).powi(3);
        variance <= most * self.variance + self.step * self.step
    }

    /// Whether two means, each of so many readings, differ by no more than noise makes them.
    fn is_same(&self, mean: f64, other: f64, readings: f64) -> bool {
        let deviation = self.variance.sqrt();
        let most = DEVIATIONS * deviation * (2.0 / readings).sqrt() + 0.5 * deviation + 0.5 * self.step;
        (mean - other).abs() <= most
    }
}

/// The stretches of blocks in which every channel rests, in their order.
pub(super) fn rests(trace: &Trace, quiet: &[Quiet]) -> Vec<Range<usize>> {
    let blocks = &trace.blocks;
    let readings = f64::from(trace.length());
    let cells = |block: usize| blocks.get(block).map(|block| block.cells.as_slice()).unwrap_or_default();
    let votes = || quiet.iter().enumerate().filter(|(_, quiet)| quiet.votes);
    let mean = |block: usize, channel: usize| cells(block).get(channel).map_or(f64::NAN, |cell| cell.mean);
    let calm = |block: usize| {
        votes().all(|(channel, quiet)| cells(block).get(channel).is_some_and(|cell| quiet.is_noise(cell)))
    };
    let follows = |block: usize, first: usize| {
        votes().all(|(channel, quiet)| {
            let near = quiet.is_same(mean(block, channel), mean(block - 1, channel), readings);
            // Means of several blocks tell what moves slowly.
            let slow = block + 1 < first + 2 * SIDE || {
                let side =
                    |end: usize| (end - SIDE..end).map(|k| mean(k, channel)).sum::<f64>() / SIDE as f64;
                quiet.is_same(side(block + 1), side(block + 1 - SIDE), SIDE as f64 * readings)
            };
            near && slow
        })
    };
    let mut rests = Vec::new();
    let mut first = None;
    for block in 0..blocks.len() {
        let goes_on = calm(block) && first.is_none_or(|first| follows(block, first));
        if !goes_on && let Some(first) = first.take() {
            rests.push(first..block);
        }
        if first.is_none() && calm(block) {
            first = Some(block);
        }
    }
    rests.extend(first.map(|first| first..blocks.len()));
    rests.retain(|rest| rest.len() >= FEWEST);
    rests
}

/// The samples of a stretch of blocks, and their times \[s\].
pub(super) fn samples(blocks: &[Block]) -> Option<(Range<u64>, Range<f64>)> {
    let (first, last) = (blocks.first()?, blocks.last()?);
    let end = last.start + u64::from(last.samples);
    let pace = if last.start > first.start {
        (last.time - first.time) / (last.start - first.start) as f64
    } else {
        0.0
    };
    Some((first.start..end, first.time..last.time + pace * f64::from(last.samples)))
}
