//! Zeros that jump from one sample to the next.

use super::block::Cell;
use super::rest::Quiet;
use super::trace::Trace;

/// What a step of the zero looks like.
///
/// ```
/// use fingertip_recordings::health::{Depth, HealthWatch, Kind, StepKind, WatchedChannel};
///
/// // What jumps after 5 s of readings of two gauges that rest at 1 V.
/// let jump = |after: [f64; 2]| {
///     let channels = ["v1", "v2"].map(|name| WatchedChannel::new(name, "V", Kind::Signal)).to_vec();
///     let mut watch = HealthWatch::new(channels, Depth::Brief);
///     let mut state = 1_u32;
///     let mut noise = || {
///         state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
///         f64::from(state >> 16) / 65_536e3
///     };
///     for i in 0..10_000_u32 {
///         let level = if i < 5000 { [1.0, 1.0] } else { after };
///         watch.add(Some(f64::from(i) * 1e-3), &level.map(|level| level + noise()));
///     }
///     watch.finish().steps[0].kind
/// };
/// assert_eq!(jump([1.0, 1.5]), StepKind::One);
/// assert_eq!(jump([1.2, 1.5]), StepKind::Several);
/// assert_eq!(jump([0.0, 0.0]), StepKind::Tare);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "snake_case"))]
pub enum StepKind {
    /// Every channel reads zero behind it: the sensor was tared.
    Tare,
    /// One channel of several jumped.
    One,
    /// Several channels jumped at the same sample.
    Several,
}

/// A level that changed from one sample to the next, at rest before and behind.
///
/// ```
/// use fingertip_recordings::health::{Depth, HealthWatch, Kind, WatchedChannel};
///
/// let mut watch = HealthWatch::new(vec![WatchedChannel::new("v1", "V", Kind::Signal)], Depth::Brief);
/// let mut state = 1_u32;
/// for i in 0..10_000_u32 {
///     state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
///     let zero = if i < 5000 { 1.0 } else { 1.5 };
///     watch.add(Some(f64::from(i) * 1e-3), &[zero + f64::from(state >> 16) / 65_536e3]);
/// }
/// let step = &watch.finish().steps[0];
/// assert_eq!((step.sample, step.time), (5000, 5.0));
/// let (channel, by) = step.channels[0];
/// assert!(channel == 0 && (by - 0.5).abs() < 1e-3);
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct ZeroStep {
    /// The number of the first sample behind it.
    pub sample: u64,
    /// Its time \[s\].
    pub time: f64,
    /// Numbers of the channels, and by how much each jumped.
    pub channels: Vec<(usize, f64)>,
    /// What it looks like.
    pub kind: StepKind,
}

/// Blocks to each side whose means are compared.
const SIDE: usize = 3;
/// Deviations of one reading that a step must exceed.
const DEVIATIONS: f64 = 8.0;
/// And the other changes near by, so many times.
const OUTSTANDING: f64 = 2.5;
/// A channel that changes so many deviations at the sample at which another jumps has jumped with it: noise does so
/// once in 10⁵ steps.
const ALONGSIDE: f64 = 6.0;
/// Most steps that are listed.
const MOST: usize = 50;

/// Steps of the channels of one sensor, by their numbers.
pub(super) fn find(trace: &Trace, quiet: &[Quiet], channels: &[usize]) -> Vec<ZeroStep> {
    let mut steps: Vec<ZeroStep> = Vec::new();
    for block in SIDE..trace.blocks.len().saturating_sub(SIDE) {
        for &channel in channels {
            let Some((at, size)) = step_in(trace, quiet, block, channel) else { continue };
            // Channels of one sample may be a sample apart in time.
            match steps.iter_mut().find(|step| step.sample.abs_diff(at) <= 1) {
                Some(step) => step.channels.push((channel, size)),
                None => steps.push(ZeroStep {
                    sample: at,
                    time: time_of(trace, block, at),
                    channels: vec![(channel, size)],
                    kind: StepKind::Several,
                }),
            }
        }
    }
    for step in &mut steps {
        step.kind = kind(trace, quiet, channels, step);
    }
    steps.truncate(MOST);
    steps
}

fn time_of(trace: &Trace, block: usize, at: u64) -> f64 {
    let (Some(this), Some(next)) = (trace.blocks.get(block), trace.blocks.get(block + 1)) else {
        return f64::NAN;
    };
    let pace = (next.time - this.time) / f64::from(this.samples.max(1));
    this.time + pace * (at - this.start) as f64
}

fn cell(trace: &Trace, block: usize, channel: usize) -> Option<&Cell> {
    trace.blocks.get(block)?.cells.get(channel)
}

/// Means and extremes over some blocks.
fn side(trace: &Trace, blocks: core::ops::Range<usize>, channel: usize) -> Option<(f64, f64)> {
    let means: Vec<f64> = blocks.filter_map(|block| Some(cell(trace, block, channel)?.mean)).collect();
    let mean = means.iter().sum::<f64>() / means.len() as f64;
    let range = means.iter().map(|x| (x - mean).abs()).fold(0.0, f64::max);
    (means.len() == SIDE).then_some((mean, range))
}

/// A step of one channel in a block.
fn step_in(trace: &Trace, quiet: &[Quiet], block: usize, channel: usize) -> Option<(u64, f64)> {
    let jump = cell(trace, block, channel)?.jump;
    let quiet = quiet.get(channel).filter(|quiet| quiet.votes)?;
    let deviation = quiet.variance.sqrt();
    let size = jump.size.abs();
    if !(size > DEVIATIONS * deviation + 3.0 * quiet.step) {
        return None;
    }
    let near = (block - SIDE..=block + SIDE).filter(|other| *other != block);
    let others = near.filter_map(|other| Some(cell(trace, other, channel)?.jump.size.abs()));
    let largest = others.fold(jump.second, f64::max);
    if !(size > OUTSTANDING * largest) {
        return None;
    }
    // The levels to both sides hold still and differ by the jump.
    let (before, wander_before) = side(trace, block - SIDE..block, channel)?;
    let (behind, wander_behind) = side(trace, block + 1..block + 1 + SIDE, channel)?;
    let still = wander_before.max(wander_behind) < 0.15 * size + deviation;
    let kept = (behind - before - jump.size).abs() < 0.25 * size + 2.0 * deviation;
    (still && kept).then_some((jump.at, behind - before))
}

fn kind(trace: &Trace, quiet: &[Quiet], channels: &[usize], step: &ZeroStep) -> StepKind {
    let block = trace.blocks.partition_point(|block| block.start <= step.sample).saturating_sub(1);
    let zeroed = channels.iter().all(|&channel| {
        let size =
            step.channels.iter().find(|(other, _)| *other == channel).map_or(0.0, |(_, size)| size.abs());
        let behind = side(trace, block + 1..block + 1 + SIDE, channel);
        let Some(quiet) = quiet.get(channel) else { return false };
        behind.is_some_and(|(mean, _)| mean.abs() <= 3.0 * quiet.variance.sqrt() + quiet.step + 0.02 * size)
    });
    // A load that changes suddenly changes most channels, some by too little for a step.
    let jumps_along = |channel: &usize| {
        let (Some(cell), Some(quiet)) = (cell(trace, block, *channel), quiet.get(*channel)) else {
            return false;
        };
        cell.jump.at.abs_diff(step.sample) <= 1
            && cell.jump.size.abs() > ALONGSIDE * quiet.variance.sqrt() + quiet.step
    };
    let jumped = channels.iter().filter(|channel| jumps_along(channel)).count();
    match (zeroed, step.channels.len().max(jumped)) {
        (true, _) if step.channels.len() * 2 > channels.len() => StepKind::Tare,
        (_, 1) if channels.len() > 1 => StepKind::One,
        _ => StepKind::Several,
    }
}
