//! How a channel moves while it rests: steadily, or less and less.

use super::block::{Block, Cell};
use super::noise::Line;

/// How a channel moved over a rest.
///
/// ```
/// use fingertip_recordings::health::{Depth, HealthWatch, Kind, WatchedChannel};
///
/// let mut watch = HealthWatch::new(vec![WatchedChannel::new("v1", "V", Kind::Signal)], Depth::Brief);
/// for i in 0..20_000_u32 {
///     // Within 20 s the zero moves by 20 mV, under noise of 29 mV.
///     let noise = f64::from(i.wrapping_mul(2_654_435_769) >> 16) / 65_536.0 - 0.5;
///     watch.add(Some(f64::from(i) * 1e-3), &[0.1 * noise + f64::from(i) * 1e-6]);
/// }
/// let drift = watch.finish().channels[0].drift.unwrap();
/// assert!((drift.moved - 0.02).abs() < 4.0 * drift.error);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Drift {
    /// From the start to the end of the rest, by the straight line through it, in the unit of the channel.
    pub moved: f64,
    /// Standard error of that.
    pub error: f64,
    /// If it settles: the time constant \[s\], as of an exponential.
    pub settles_in: Option<f64>,
    /// If it settles: how far it still has to go.
    pub to_go: Option<f64>,
}

/// Shares of the rest that time constants are tried for.
const SHARES: [f64; 16] =
    [0.02, 0.03, 0.04, 0.05, 0.07, 0.1, 0.13, 0.16, 0.2, 0.25, 0.32, 0.4, 0.5, 0.63, 0.8, 1.0];
/// An exponential must leave less than this share of the squares that the straight line leaves.
const BETTER: f64 = 0.5;
/// Standard errors by which a drift is one.
const DEVIATIONS: f64 = 6.0;

impl Drift {
    /// Over blocks that last so many seconds in all; without times, in the unit of the samples.
    pub(super) fn of(blocks: &[Block], channel: usize, seconds: f64) -> Option<Self> {
        let cells = Cell::of_channel(blocks, channel);
        let line = Line::through(&cells)?;
        let count = cells.len() as f64;
        let (moved, error) = (line.slope * (count - 1.0), line.slope_error * (count - 1.0));
        let mut drift = Self { moved, error, settles_in: None, to_go: None };
        let settling = SHARES
            .into_iter()
            .filter_map(|share| Some((share, exponential(&cells, share)?)))
            .min_by(|(_, a), (_, b)| a.squares.total_cmp(&b.squares));
        if let Some((share, fit)) = settling
            && fit.squares < BETTER * line.squares
            && fit.amplitude.abs() > DEVIATIONS * fit.error
        {
            drift.settles_in = Some(share * seconds);
            drift.to_go = Some(-fit.amplitude * (-1.0 / share).exp());
            drift.moved = -fit.amplitude * (1.0 - (-1.0 / share).exp());
        }
        Some(drift)
    }

    /// Whether it is more than chance.
    pub(super) fn is_significant(&self) -> bool {
        self.settles_in.is_some() || self.moved.abs() > DEVIATIONS * self.error
    }
}

struct Exponential {
    amplitude: f64,
    error: f64,
    squares: f64,
}

/// The least squares of `a + b·exp(−t/τ)` through the means, with `τ` a share of the rest.
fn exponential(cells: &[&Cell], share: f64) -> Option<Exponential> {
    let count = cells.len() as f64;
    if cells.len() < 12 {
        return None;
    }
    let falls = |i: usize| (-(i as f64) / (count - 1.0) / share).exp();
    let mean_fall = (0..cells.len()).map(falls).sum::<f64>() / count;
    let mean = cells.iter().map(|cell| cell.mean).sum::<f64>() / count;
    let (mut both, mut alone) = (0.0, 0.0);
    for (i, cell) in cells.iter().enumerate() {
        let fall = falls(i) - mean_fall;
        both += fall * (cell.mean - mean);
        alone += fall * fall;
    }
    let amplitude = both / alone;
    let off = |(i, cell): (usize, &&Cell)| (cell.mean - mean - amplitude * (falls(i) - mean_fall)).powi(2);
    let squares: f64 = cells.iter().enumerate().map(off).sum();
    Some(Exponential { amplitude, error: (squares / (count - 2.0) / alone).sqrt(), squares })
}

#[cfg(test)]
mod tests {
    use super::super::trace::Trace;
    use super::Drift;
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    fn drift(seed: u64, moves: impl Fn(f64) -> f64) -> Drift {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(seed);
        let mut trace = Trace::new(1, Vec::new(), 2048);
        for i in 0..8192 {
            let noise: f64 = StandardNormal.sample(&mut random);
            trace.add(f64::from(i) * 1e-3, &[0.1 * noise + moves(f64::from(i) / 8192.0)]);
        }
        Drift::of(&trace.blocks, 0, 8.192).unwrap()
    }

    #[test]
    fn drift_and_settling_are_told_apart() {
        let steady = drift(1, |t| 0.3 * t);
        assert!(steady.is_significant() && steady.settles_in.is_none());
        assert!((steady.moved - 0.3).abs() < 5.0 * steady.error && steady.error < 0.01, "{steady:?}");
        let settling = drift(2, |t| 1.0 - (-t / 0.2).exp());
        let time = settling.settles_in.unwrap() / 8.192;
        assert!((0.16..=0.25).contains(&time), "{settling:?}");
        assert!((settling.moved - 1.0).abs() < 0.05 && settling.to_go.unwrap().abs() < 0.02, "{settling:?}");
        // A drift that only begins to settle still has a way to go.
        let begun = drift(3, |t| 3.0 * (1.0 - (-t / 0.8).exp()));
        assert!((0.5..1.3).contains(&begun.to_go.unwrap()), "{begun:?}");
        let none = (10..210).filter(|seed| drift(*seed, |_| 0.0).is_significant()).count();
        assert_eq!(none, 0);
    }
}
