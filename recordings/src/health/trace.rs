//! A recording in blocks of equal length, of which there are never more than a fixed number.

use core::ops::Range;

use fingertip_wrench::AllanVariance;

use super::block::{Block, OCTAVES, are_finite};
use super::pending::Pending;

/// The sum of products of the changes of two channels, from the reading before theirs on; what is not finite is left out.
fn product_of_changes(first: (f64, &[f64]), second: (f64, &[f64])) -> f64 {
    let ((mut before, readings), (mut other_before, others)) = (first, second);
    let mut sum = 0.0;
    for (reading, other) in readings.iter().zip(others) {
        let both = (reading - before) * (other - other_before);
        sum += if both.is_finite() { both } else { 0.0 };
        (before, other_before) = (*reading, *other);
    }
    sum
}

/// The blocks of a recording. When there are too many, neighbours are joined, and blocks are twice as long from then on.
#[derive(Clone, Debug)]
pub(super) struct Trace {
    pub(super) blocks: Vec<Block>,
    current: Block,
    /// Binary logarithm of the length of a block.
    octave: u32,
    /// Pairs of channels whose changes are multiplied.
    pairs: Vec<(usize, usize)>,
    last: Vec<f64>,
    /// Of each channel; without them, only single readings are compared.
    allan: Option<Vec<AllanVariance<f64>>>,
    samples: u64,
    /// So many blocks are kept at most.
    most: usize,
}

impl Trace {
    /// The shortest block: 2⁴ readings.
    const FIRST_OCTAVE: u32 = 4;
    /// Of so many channels, with so many blocks at most; their Allan variance is that of all octaves.
    pub(super) fn new(channels: usize, pairs: Vec<(usize, usize)>, most: usize) -> Self {
        let allan = Some(vec![AllanVariance::default(); channels]);
        Self { allan, ..Self::brief(channels, pairs, most) }
    }

    /// The same with the Allan variance of single readings alone, which costs a sum.
    pub(super) fn brief(channels: usize, pairs: Vec<(usize, usize)>, most: usize) -> Self {
        Self {
            most,
            blocks: Vec::new(),
            current: Block::new(0, 0.0, channels, pairs.len()),
            octave: Self::FIRST_OCTAVE,
            pairs,
            last: vec![f64::NAN; channels],
            allan: None,
            samples: 0,
        }
    }

    pub(super) fn pairs(&self) -> &[(usize, usize)] {
        &self.pairs
    }

    /// Readings of a whole block.
    pub(super) const fn length(&self) -> u32 {
        1 << self.octave
    }

    pub(super) const fn octave(&self) -> u32 {
        self.octave
    }

    /// Readings are missing here.
    pub(super) fn interrupt(&mut self) {
        self.last.fill(f64::NAN);
        self.allan.iter_mut().flatten().for_each(AllanVariance::interrupt);
    }

    /// Takes samples that follow each other; what is not finite is left out.
    pub(super) fn look(&mut self, samples: &Pending) {
        let mut times = samples.times();
        while let Some(first) = times.first() {
            let room = (self.length() - self.current.samples) as usize;
            let from = samples.times().len() - times.len();
            self.look_within(*first, samples, from..from + room.min(times.len()));
            times = times.get(room..).unwrap_or_default();
        }
    }

    /// Takes those of them in this range, all of one block; the first came at this time.
    fn look_within(&mut self, time: f64, samples: &Pending, range: Range<usize>) {
        let count = u32::try_from(range.len()).unwrap_or(u32::MAX);
        let readings = |channel: usize| samples.readings(channel).and_then(|all| all.get(range.clone()));
        let is_first = self.current.samples == 0;
        if is_first {
            (self.current.start, self.current.time) = (self.samples, time);
        }
        for (product, (i, j)) in self.current.products.iter_mut().zip(&self.pairs) {
            let of = |channel: usize| Some((*self.last.get(channel)?, readings(channel)?));
            if let (Some(first), Some(second)) = (of(*i), of(*j)) {
                *product += product_of_changes(first, second);
            }
        }
        for (channel, allan) in self.allan.iter_mut().flatten().enumerate() {
            readings(channel).unwrap_or_default().iter().for_each(|reading| allan.add(*reading));
        }
        let compares = self.allan.is_none();
        for (channel, (cell, last)) in self.current.cells.iter_mut().zip(&mut self.last).enumerate() {
            let Some(readings) = readings(channel) else { continue };
            let mut add = |at: u64, run: &[f64], last: f64| {
                if let Some(first) = run.first().filter(|_| last.is_finite()) {
                    // Differences of single readings are taken within a block.
                    cell.add_changes(at.saturating_sub(1), &[last, *first], compares && !is_first);
                }
                cell.add(run);
                cell.add_changes(at, run, compares);
            };
            if are_finite(readings) {
                add(self.samples, readings, *last);
            } else {
                let (mut at, mut last) = (self.samples, *last);
                for run in readings.split(|reading| !reading.is_finite()) {
                    add(at, run, last);
                    at += run.len() as u64 + 1;
                    last = f64::NAN;
                }
            }
            *last = readings.last().copied().unwrap_or(*last);
        }
        self.samples += u64::from(count);
        self.current.samples += count;
        if self.current.samples == self.length() {
            self.end_block();
        }
    }

    fn end_block(&mut self) {
        let fresh = Block::new(self.samples, 0.0, self.current.cells.len(), self.pairs.len());
        let mut block = core::mem::replace(&mut self.current, fresh);
        for (cell, allan) in block.cells.iter_mut().zip(self.allan.iter_mut().flatten()) {
            for octave in 0..OCTAVES {
                let pairs = allan.pairs(octave);
                let sum = allan.variance(octave).map_or(0.0, |variance| 2.0 * variance * f64::from(pairs));
                if let Some(place) = cell.allan.get_mut(octave) {
                    *place = (sum, pairs);
                }
            }
            *allan = AllanVariance::default();
        }
        self.blocks.push(block);
        if self.blocks.len() >= self.most {
            self.join();
        }
    }

    /// Joins neighbours.
    fn join(&mut self) {
        let octave = self.octave as usize;
        let mut joined: Vec<Block> = Vec::with_capacity(self.most);
        for (number, block) in self.blocks.drain(..).enumerate() {
            match joined.last_mut().filter(|_| number % 2 == 1) {
                Some(last) => last.join(&block, octave),
                None => joined.push(block),
            }
        }
        self.blocks = joined;
        self.octave += 1;
    }
}

#[cfg(test)]
impl Trace {
    /// Takes one sample.
    pub(super) fn add(&mut self, time: f64, readings: &[f64]) {
        let mut sample = Pending::new(readings.len());
        sample.push(time, readings);
        self.look(&sample);
    }
}

#[cfg(test)]
mod tests {
    use super::{Pending, Trace};
    use rand::{RngExt, SeedableRng};

    /// However many samples come together, what is kept of them is the same, but for the rounding of sums.
    #[test]
    fn together_is_as_one_by_one() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(5);
        let near = |a: f64, b: f64| (a - b).abs() <= 1e-9 * (a.abs() + b.abs());
        for depth in [Trace::new, Trace::brief] {
            let pairs = vec![(0, 0), (0, 1)];
            let (mut together, mut singly) = (depth(2, pairs.clone(), 64), depth(2, pairs, 64));
            let mut count = 0_u32;
            for piece in 0..400 {
                let length = random.random_range(1..=64_u32);
                let mut samples = Pending::new(2);
                for time in (count..count + length).map(f64::from) {
                    let mut reading = |odd: f64| {
                        if random.random_bool(odd) { f64::NAN } else { 1e3 + random.random::<f64>() }
                    };
                    let readings = [reading(0.0), reading(0.05)];
                    samples.push(time, &readings);
                    singly.add(time, &readings);
                }
                together.look(&samples);
                if piece % 50 == 49 {
                    together.interrupt();
                    singly.interrupt();
                }
                count += length;
            }
            assert!(together.blocks.len() == singly.blocks.len() && together.octave > 6);
            for (one, other) in together.blocks.iter().zip(&singly.blocks) {
                assert_eq!((one.start, one.time, one.samples), (other.start, other.time, other.samples));
                assert!(one.products.iter().zip(&other.products).all(|(a, b)| near(*a, *b)));
                for (one, other) in one.cells.iter().zip(&other.cells) {
                    assert_eq!(
                        (one.count, one.least, one.greatest),
                        (other.count, other.least, other.greatest)
                    );
                    assert_eq!(one.jump, other.jump);
                    assert!(
                        near(one.mean, other.mean) && near(one.squares, other.squares),
                        "{one:?} {other:?}"
                    );
                    for (a, b) in one.allan.iter().zip(&other.allan) {
                        assert!(near(a.0, b.0) && a.1 == b.1);
                    }
                }
            }
        }
    }

    /// A brief look knows of single readings what the whole one does, gaps and missing readings included.
    #[test]
    fn briefly_single_readings_are_compared_alike() {
        let (mut whole, mut brief) = (Trace::new(2, Vec::new(), 64), Trace::brief(2, Vec::new(), 64));
        for i in 0..5000_u32 {
            let reading = f64::from(i * 7919 % 101) * 0.37;
            let other = if i % 23 == 5 { f64::NAN } else { reading * reading };
            for trace in [&mut whole, &mut brief] {
                if i % 777 == 0 {
                    trace.interrupt();
                }
                trace.add(f64::from(i), &[reading, other]);
            }
        }
        assert_eq!(whole.blocks.len(), brief.blocks.len());
        for (whole, brief) in whole.blocks.iter().zip(&brief.blocks) {
            for (whole, brief) in whole.cells.iter().zip(&brief.cells) {
                assert_eq!((whole.mean, whole.squares, whole.jump), (brief.mean, brief.squares, brief.jump));
                assert_eq!(whole.allan[0].1, brief.allan[0].1);
                assert!((whole.allan[0].0 / brief.allan[0].0 - 1.0).abs() < 1e-12);
                // Blocks that were joined compare their means, at the octaves of their lengths.
                assert_eq!(brief.allan[1], (0.0, 0));
            }
        }
    }

    #[test]
    fn memory_is_bounded_and_nothing_is_lost() {
        let mut trace = Trace::new(2, vec![(0, 0), (0, 1)], 2048);
        let samples = 300_000_u32;
        for i in 0..samples {
            let reading = f64::from(i % 17);
            trace.add(f64::from(i), &[reading, -2.0 * reading]);
        }
        assert!(trace.blocks.len() < 2048 && trace.blocks.len() > 512);
        let held: u32 = trace.blocks.iter().map(|block| block.samples).sum();
        assert!(u64::from(held) + u64::from(trace.length()) > trace.samples);
        for (number, block) in trace.blocks.iter().enumerate() {
            assert_eq!(
                (block.samples, block.start),
                (trace.length(), number as u64 * u64::from(trace.length()))
            );
            assert_eq!(block.time, block.start as f64);
            assert!((block.products[1] + 2.0 * block.products[0]).abs() < 1e-9);
            assert_eq!((block.cells[0].least, block.cells[0].greatest), (0.0, 16.0));
        }
    }
}
