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

    /// Takes finite readings that follow each other, but not what they change by.
    pub(super) fn add(&mut self, readings: &[f64]) {
        let Some(first) = readings.first() else { return };
        let [least, greatest] = extremes(readings);
        self.least = if least < self.least { least } else { self.least };
        self.greatest = if greatest > self.greatest { greatest } else { self.greatest };
        let count = readings.len() as f64;
        let mean = first + sum(readings, |reading| reading - first) / count;
        let squares = sum(readings, |reading| (reading - mean) * (reading - mean));
        self.merge(u32::try_from(readings.len()).unwrap_or(u32::MAX), mean, squares);
    }

    /// Takes the changes between finite readings that follow each other, of which the first has this number; for the Allan
    /// variance of single readings, too, if they are `compared`.
    pub(super) fn add_changes(&mut self, at: u64, readings: &[f64], compared: bool) {
        let (largest, squares) = changes(readings);
        // Seldom, once many are known.
        if largest > self.jump.second {
            let pairs = readings.iter().zip(readings.iter().skip(1));
            (at + 1..).zip(pairs).for_each(|(at, (before, reading))| self.jump.add(at, reading - before));
        }
        if let Some((sum, pairs)) = self.allan.first_mut().filter(|_| compared) {
            *sum += squares;
            *pairs += u32::try_from(readings.len().saturating_sub(1)).unwrap_or(u32::MAX);
        }
    }

    /// Takes so many readings, by their mean and the sum of squares off it (Chan, Golub & LeVeque 1979).
    fn merge(&mut self, count: u32, mean: f64, squares: f64) {
        let (n, m) = (f64::from(self.count), f64::from(count));
        let change = mean - self.mean;
        self.squares += squares + change * change * (n * m / (n + m));
        self.mean += change * (m / (n + m));
        self.count += count;
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
        self.merge(next.count, next.mean, next.squares);
        self.least = self.least.min(next.least);
        self.greatest = self.greatest.max(next.greatest);
        self.jump.join(&next.jump);
    }
}

// In fours, of which none waits for another.

/// The sum of what is made of each reading.
#[inline(always)]
fn sum(readings: &[f64], of: impl Fn(f64) -> f64) -> f64 {
    let (fours, rest) = readings.as_chunks::<4>();
    let mut sums = [0.0; 4];
    for four in fours {
        for (sum, reading) in sums.iter_mut().zip(four) {
            *sum += of(*reading);
        }
    }
    let rest: f64 = rest.iter().map(|reading| of(*reading)).sum();
    sums.iter().sum::<f64>() + rest
}

/// Whether all of them are.
pub(super) fn are_finite(readings: &[f64]) -> bool {
    sum(readings, |reading| reading * 0.0) == 0.0
}

/// The least and the greatest of finite readings.
fn extremes(readings: &[f64]) -> [f64; 2] {
    let (fours, rest) = readings.as_chunks::<4>();
    let (mut least, mut greatest) = ([f64::INFINITY; 4], [f64::NEG_INFINITY; 4]);
    for four in fours {
        for ((least, greatest), reading) in least.iter_mut().zip(&mut greatest).zip(four) {
            *least = if *reading < *least { *reading } else { *least };
            *greatest = if *reading > *greatest { *reading } else { *greatest };
        }
    }
    let of_all =
        |some: [f64; 4], pick: fn(f64, f64) -> f64| some.iter().chain(rest).copied().fold(some[0], pick);
    [of_all(least, f64::min), of_all(greatest, f64::max)]
}

/// The largest change from a reading to the next, without its sign, and the sum of the squares of all.
fn changes(readings: &[f64]) -> (f64, f64) {
    let Some((_, next)) = readings.split_first() else { return (0.0, 0.0) };
    let ((fours, _), (next_fours, rest)) = (readings.as_chunks::<4>(), next.as_chunks::<4>());
    let (mut largest, mut squares) = ([0.0_f64; 4], [0.0; 4]);
    for (four, next) in fours.iter().zip(next_fours) {
        for (((largest, squares), before), reading) in
            largest.iter_mut().zip(&mut squares).zip(four).zip(next)
        {
            let change = reading - before;
            *largest = if change.abs() > *largest { change.abs() } else { *largest };
            *squares += change * change;
        }
    }
    let before = readings.iter().rev().skip(1);
    let of_rest = || rest.iter().rev().zip(before.clone()).map(|(reading, before)| reading - before);
    let largest = largest.into_iter().chain(of_rest().map(f64::abs)).fold(0.0, f64::max);
    (largest, squares.iter().sum::<f64>() + of_rest().map(|change| change * change).sum::<f64>())
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
            cell.add(readings);
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
