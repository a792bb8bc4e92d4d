//! The noise of a channel at rest, and what averaging makes of it.

use fingertip_wrench::AllanVariance;

use super::block::{Block, Cell};

/// The Allan deviation of means over a time.
///
/// ```
/// use fingertip_recordings::health::{Depth, HealthWatch, Kind, WatchedChannel};
///
/// let mut watch = HealthWatch::new(vec![WatchedChannel::new("v1", "V", Kind::Signal)], Depth::Full);
/// let mut state = 1_u32;
/// for i in 0..20_000 {
///     state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
///     watch.add(Some(f64::from(i) * 1e-3), &[f64::from(state >> 16) / 65_536.0]);
/// }
/// let noise = watch.finish().channels[0].noise.clone().unwrap();
/// // White noise: the mean of four times as many readings is twice as good.
/// for point in noise.allan.iter().filter(|point| point.pairs > 1000) {
///     let expected = (1.0 / 12.0 / point.readings as f64).sqrt();
///     assert!((point.deviation / expected - 1.0).abs() < 0.1);
/// }
/// assert_eq!(noise.allan[0].readings, 1);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct AllanPoint {
    /// Over how many readings.
    pub readings: u64,
    /// In the unit of the channel.
    pub deviation: f64,
    /// How many differences it is the mean of: few are uncertain.
    pub pairs: u32,
}

/// The noise of a channel at rest, in its unit.
///
/// ```
/// use fingertip_recordings::health::{Depth, HealthWatch, Kind, WatchedChannel};
///
/// let mut watch = HealthWatch::new(vec![WatchedChannel::new("v1", "V", Kind::Signal)], Depth::Brief);
/// let mut state = 1_u32;
/// for i in 0..4000 {
///     state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
///     // Evenly between 1 V and 2 V, of which the standard deviation is 1 V/√12.
///     watch.add(Some(f64::from(i) * 1e-3), &[1.0 + f64::from(state >> 16) / 65_536.0]);
/// }
/// let noise = watch.finish().channels[0].noise.clone().unwrap();
/// assert!((noise.mean - 1.5).abs() < 0.02);
/// assert!((noise.deviation - 12.0_f64.sqrt().recip()).abs() < 0.01);
/// assert!((noise.independent / noise.deviation - 1.0).abs() < 0.05); // all of it is independent
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Noise {
    /// Standard deviation of a reading about the straight line through the rest.
    pub deviation: f64,
    /// The part of it that is independent from reading to reading: the Allan deviation of single readings.
    pub independent: f64,
    /// Mean of the readings.
    pub mean: f64,
    /// By the time of averaging; of a brief look, that of single readings and those above the length of a block.
    pub allan: Vec<AllanPoint>,
}

/// Fewer differences tell no Allan deviation.
const FEWEST: u32 = 3;

impl Noise {
    /// In some blocks, each of `2^octave` readings.
    pub(super) fn of(blocks: &[Block], channel: usize, octave: u32) -> Option<Self> {
        let cells = Cell::of_channel(blocks, channel);
        let line = Line::through(&cells)?;
        let readings: f64 = cells.iter().map(|cell| f64::from(cell.count)).sum();
        let mut squares = 0.0;
        for (number, cell) in cells.iter().enumerate() {
            let off = cell.mean - line.at(number as f64);
            squares += cell.squares + f64::from(cell.count) * off * off;
        }
        let mut allan = Vec::new();
        for place in 0..octave as usize {
            let of = |cell: &&Cell| cell.allan.get(place).copied().unwrap_or_default();
            let sum: f64 = cells.iter().map(|cell| of(cell).0).sum();
            let pairs = cells.iter().map(|cell| of(cell).1).fold(0_u32, u32::saturating_add);
            if pairs >= FEWEST {
                let deviation = (0.5 * sum / f64::from(pairs)).sqrt();
                allan.push(AllanPoint { readings: 1 << place, deviation, pairs });
            }
        }
        let mut means = AllanVariance::default();
        cells.iter().for_each(|cell| means.add(cell.mean));
        for place in 0..AllanVariance::<f64>::OCTAVES {
            if let Some(variance) = means.variance(place).filter(|_| means.pairs(place) >= FEWEST) {
                let readings = 1 << (octave as usize + place);
                allan.push(AllanPoint { readings, deviation: variance.sqrt(), pairs: means.pairs(place) });
            }
        }
        let independent = allan.first().map_or(0.0, |point| point.deviation);
        let deviation = (squares / (readings - 2.0).max(1.0)).max(0.0).sqrt();
        let mean = line.at((cells.len() as f64 - 1.0) / 2.0);
        // Readings that are all alike leave what their sums were rounded by.
        let deviation = if deviation > 16.0 * f64::EPSILON * mean.abs() { deviation } else { 0.0 };
        Some(Self { deviation, independent, mean, allan })
    }
}

/// The straight line through the means of cells, by their number.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    middle: f64,
    mean: f64,
    pub(super) slope: f64,
    /// Standard error of the slope, by the scatter of the means.
    pub(super) slope_error: f64,
    /// Sum of the squares of what is off the line.
    pub(super) squares: f64,
}

impl Line {
    /// `None` for fewer than three cells.
    pub(super) fn through(cells: &[&Cell]) -> Option<Self> {
        let count = cells.len() as f64;
        if cells.len() < 3 {
            return None;
        }
        let middle = (count - 1.0) / 2.0;
        let mean = cells.iter().map(|cell| cell.mean).sum::<f64>() / count;
        let times = count * (count * count - 1.0) / 12.0;
        let with_time: f64 =
            cells.iter().enumerate().map(|(i, cell)| (i as f64 - middle) * (cell.mean - mean)).sum();
        let mut line = Self { middle, mean, slope: with_time / times, slope_error: 0.0, squares: 0.0 };
        line.squares =
            cells.iter().enumerate().map(|(i, cell)| (cell.mean - line.at(i as f64)).powi(2)).sum();
        line.slope_error = (line.squares / (count - 2.0) / times).sqrt();
        Some(line)
    }

    pub(super) fn at(&self, number: f64) -> f64 {
        self.mean + self.slope * (number - self.middle)
    }
}

#[cfg(test)]
mod tests {
    use super::super::trace::Trace;
    use super::Noise;
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    #[test]
    fn white_noise_on_a_ramp_is_what_it_was_made_of() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(3);
        // 2¹⁷ readings, so that blocks are joined on the way.
        for (samples, ramp) in [(4096_u32, 1e-3), (1 << 17, 1e-5)] {
            let mut trace = Trace::new(1, Vec::new(), 2048);
            for i in 0..samples {
                let noise: f64 = StandardNormal.sample(&mut random);
                trace.add(f64::from(i), &[5.0 + 0.25 * noise + ramp * f64::from(i)]);
            }
            let noise = Noise::of(&trace.blocks, 0, trace.octave()).unwrap();
            assert!((noise.deviation / 0.25 - 1.0).abs() < 0.04, "{noise:?}");
            assert!((noise.independent / 0.25 - 1.0).abs() < 0.04, "{noise:?}");
            assert!((noise.mean - 5.0 - ramp * f64::from(samples) / 2.0).abs() < 0.05, "{noise:?}");
            // It falls with the root of the time, where the ramp does not show.
            for point in noise.allan.iter().filter(|point| ramp * (point.readings as f64).powf(1.5) < 0.02) {
                let expected = 0.25 / (point.readings as f64).sqrt();
                let scatter = 5.0 / f64::from(point.pairs).sqrt();
                assert!((point.deviation / expected - 1.0).abs() < scatter, "{point:?} for {expected}");
            }
            let octaves: Vec<u64> = noise.allan.iter().map(|point| point.readings).collect();
            assert!(octaves.windows(2).all(|pair| pair[1] == 2 * pair[0]), "{octaves:?}");
            assert!(octaves.first() == Some(&1) && octaves.len() > 9);
        }
    }
}
