//! What is kept of some readings that follow each other.

use fingertip_wrench::AllanVariance;

/// Octaves of the Allan variance within a block.
pub(super) const OCTAVES: usize = AllanVariance::<f64>::OCTAVES;

/// The largest changes from a reading to the next.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Jump {
    /// The number of the reading behind it, of all readings.
    pub(super) at: u64,
    pub(super) size: f64,
    /// The size of the second largest, without sign.
    pub(super) second: f64,
}

impl Jump {
    pub(super) fn add(&mut self, at: u64, size: f64) {
        let (this, largest) = (size.abs(), self.size.abs());
        let smaller = if this > largest { largest } else { this };
        self.second = if smaller > self.second { smaller } else { self.second };
        (self.at, self.size) = if this > largest { (at, size) } else { (self.at, self.size) };
    }

    fn join(&mut self, other: &Self) {
        let second = self.second.max(other.second);
        let (large, small) =
            if other.size.abs() > self.size.abs() { (*other, *self) } else { (*self, *other) };
        *self = Self { second: second.max(small.size.abs()), ..large };
    }
}

/// One channel in one block.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    pub(super) count: u32,
    pub(super) mean: f64,
    /// Of what is off the mean.
    pub(super) squares: f64,
    pub(super) least: f64,
    pub(super) greatest: f64,
    /// Sums of squared changes between means of 2ⁿ readings, and how many.
    pub(super) allan: [(f64, u32); OCTAVES],
    pub(super) jump: Jump,
}

impl Default for Cell {
    fn default() -> Self {
        Self {
            count: 0,
            mean: 0.0,
            squares: 0.0,
            least: f64::INFINITY,
            greatest: f64::NEG_INFINITY,
            allan: [(0.0, 0); OCTAVES],
            jump: Jump::default(),
        }
    }
}

impl Cell {
    /// Those of one channel, block by block, that hold readings.
    pub(super) fn of_channel(blocks: &[Block], channel: usize) -> Vec<&Self> {
        let cells = blocks.iter().filter_map(|block| block.cells.get(channel));
        cells.filter(|cell| cell.count > 0).collect()
    }

    pub(super) fn add(&mut self, reading: f64) {
        self.count += 1;
        // Welford 1962.
        let off = reading - self.mean;
        self.mean += off / f64::from(self.count);
        self.squares += off * (reading - self.mean);
        self.least = if reading < self.least { reading } else { self.least };
        self.greatest = if reading > self.greatest { reading } else { self.greatest };
    }

    /// Takes a change from reading to reading for the Allan variance of single readings.
    pub(super) fn add_change(&mut self, change: f64) {
        if let Some((sum, pairs)) = self.allan.first_mut() {
            *sum += change * change;
            *pairs += 1;
        }
    }

    /// Variance of a reading about the mean; `None` for fewer than two.
    pub(super) fn variance(&self) -> Option<f64> {
        (self.count > 1).then(|| (self.squares / f64::from(self.count - 1)).max(0.0))
    }

    /// Variance of a reading as its changes tell it.
    pub(super) fn variance_of_changes(&self) -> Option<f64> {
        let (sum, pairs) = *self.allan.first()?;
        (pairs > 0).then(|| 0.5 * sum / f64::from(pairs))
    }

    /// Appends what follows; `octave` is that of the length of both.
    fn join(&mut self, next: &Self, octave: usize) {
        if next.count == 0 {
            return;
        }
        let change = next.mean - self.mean;
        if let Some((sum, pairs)) = self.allan.get_mut(octave).filter(|_| self.count == next.count) {
            *sum += change * change;
            *pairs += 1;
        }
        for ((sum, pairs), (more, more_pairs)) in self.allan.iter_mut().zip(&next.allan) {
            *sum += more;
            *pairs += more_pairs;
        }
        // Chan, Golub & LeVeque 1979.
        let (n, m) = (f64::from(self.count), f64::from(next.count));
        self.squares += next.squares + change * change * (n * m / (n + m));
        self.mean += change * (m / (n + m));
        self.count += next.count;
        self.least = self.least.min(next.least);
        self.greatest = self.greatest.max(next.greatest);
        self.jump.join(&next.jump);
    }
}

/// Readings of all channels that follow each other.
#[derive(Clone, Debug)]
pub(super) struct Block {
    /// The number of its first sample.
    pub(super) start: u64,
    /// Its time \[s\].
    pub(super) time: f64,
    pub(super) samples: u32,
    pub(super) cells: Vec<Cell>,
    /// Sums of products of changes, in the order of the pairs that are watched.
    pub(super) products: Vec<f64>,
}

impl Block {
    pub(super) fn new(start: u64, time: f64, channels: usize, pairs: usize) -> Self {
        Self { start, time, samples: 0, cells: vec![Cell::default(); channels], products: vec![0.0; pairs] }
    }

    /// Appends what follows; `octave` is that of the length of both.
    pub(super) fn join(&mut self, next: &Self, octave: usize) {
        self.samples += next.samples;
        for (cell, next) in self.cells.iter_mut().zip(&next.cells) {
            cell.join(next, octave);
        }
        for (sum, more) in self.products.iter_mut().zip(&next.products) {
            *sum += more;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Cell, Jump};

    #[test]
    fn joined_cells_are_as_one() {
        let readings: Vec<f64> = (0..64).map(|i| 1e6 + f64::from(i * 7919 % 101)).collect();
        let of = |readings: &[f64]| {
            let mut cell = Cell::default();
            readings.iter().for_each(|reading| cell.add(*reading));
            cell
        };
        let (mut joined, whole) = (of(&readings[..32]), of(&readings));
        joined.join(&of(&readings[32..]), 5);
        assert_eq!((joined.count, joined.least, joined.greatest), (64, whole.least, whole.greatest));
        assert!((joined.mean - whole.mean).abs() < 1e-6);
        assert!((joined.squares / whole.squares - 1.0).abs() < 1e-9);
        let halves = of(&readings[32..]).mean - of(&readings[..32]).mean;
        assert!((joined.allan[5].0 - halves * halves).abs() < 1e-6 && joined.allan[5].1 == 1);
        let mut empty = Cell::default();
        empty.join(&whole, 6);
        assert_eq!((empty.count, empty.mean), (64, whole.mean));
        joined.join(&Cell::default(), 6);
        assert_eq!((joined.count, joined.allan[6].1), (64, 0));
        assert_eq!(Cell::default().variance(), None);
    }

    #[test]
    fn the_two_largest_jumps_are_kept() {
        let mut jump = Jump::default();
        for (at, size) in [(1, 0.5), (2, -3.0), (3, 1.0), (4, 2.0)] {
            jump.add(at, size);
        }
        assert_eq!(jump, Jump { at: 2, size: -3.0, second: 2.0 });
        jump.join(&Jump { at: 9, size: 4.0, second: 2.5 });
        assert_eq!(jump, Jump { at: 9, size: 4.0, second: 3.0 });
        jump.join(&Jump { at: 11, size: 1.0, second: 0.0 });
        assert_eq!((jump.at, jump.second), (9, 3.0));
    }
}
