//! A recording in blocks of equal length, of which there are never more than a fixed number.

use fingertip_wrench::AllanVariance;

use super::block::{Block, OCTAVES};

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

    /// Takes a sample; what is not finite is left out.
    pub(super) fn add(&mut self, time: f64, readings: &[f64]) {
        if self.current.samples == 0 {
            (self.current.start, self.current.time) = (self.samples, time);
        }
        for (product, (i, j)) in self.current.products.iter_mut().zip(&self.pairs) {
            let change = |k: usize| Some(readings.get(k)? - self.last.get(k)?);
            if let (Some(a), Some(b)) = (change(*i), change(*j)) {
                let both = a * b;
                *product += if both.is_finite() { both } else { 0.0 };
            }
        }
        for (allan, reading) in self.allan.iter_mut().flatten().zip(readings) {
            allan.add(*reading);
        }
        // Differences of single readings are taken within a block.
        let compares = self.allan.is_none() && self.current.samples > 0;
        for ((cell, last), reading) in self.current.cells.iter_mut().zip(&mut self.last).zip(readings) {
            if reading.is_finite() {
                cell.add(*reading);
                if last.is_finite() {
                    let change = *reading - *last;
                    cell.jump.add(self.samples, change);
                    if compares {
                        cell.add_change(change);
                    }
                }
            }
            *last = *reading;
        }
        self.samples += 1;
        self.current.samples += 1;
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
mod tests {
    use super::Trace;

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
