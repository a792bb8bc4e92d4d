//! The noise of a channel while nothing moves, found among readings of which some move.

use crate::Real;

/// A running quantile of the noise of short blocks, among those that look like noise.
///
/// The noise of a block is its root mean square change from reading to reading over √2, which slow motion hardly
/// enlarges. A block that moves further than noise of that size would, but for its largest change, is left out, and so is one that does not move
/// at all. The quantile follows by steps of a share of itself (Robbins & Monro 1951), which become smaller.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct QuietNoise<T: Real> {
    readings: u32,
    squares: T,
    /// The largest of the squares: of a jump it is all.
    largest: T,
    least: T,
    greatest: T,
    last: T,
    /// The quantile of the variance.
    variance: T,
    blocks: u32,
}

impl<T: Real> QuietNoise<T> {
    /// Readings a block.
    const BLOCK: u32 = 32;
    /// Blocks before the quantile is believed.
    const FEWEST: u32 = 8;
    /// The range of 32 independent normal readings is 4.1 ± 0.7 deviations; of noise that hangs together, more of
    /// what its changes tell. A ramp has 44.
    const WIDEST: f64 = 12.0;
    /// Which quantile: some blocks hold what is no noise.
    const SHARE: f64 = 0.25;

    pub(super) fn new() -> Self {
        let zero = T::zero();
        Self {
            readings: 0,
            squares: zero,
            largest: zero,
            least: zero,
            greatest: zero,
            last: zero,
            variance: zero,
            blocks: 0,
        }
    }

    /// Takes a finite reading; changes within `hold` are none.
    pub(super) fn add(&mut self, reading: T, hold: T) {
        self.add_all(&[reading], hold);
    }

    /// Takes readings with which a block does not end before the last of them: so many are [`left`](Self::left).
    pub(super) fn add_all(&mut self, readings: &[T], hold: T) {
        let Some((first, others)) = readings.split_first() else { return };
        let begins = self.readings == 0;
        if begins {
            (self.squares, self.largest) = (T::zero(), T::zero());
            (self.least, self.greatest, self.last) = (*first, *first, *first);
        }
        for reading in if begins { others } else { readings } {
            self.compare(*reading);
        }
        self.readings += u32::try_from(readings.len()).unwrap_or(Self::BLOCK);
        if self.readings >= Self::BLOCK {
            self.readings = 0;
            self.end_block(hold);
        }
    }

    /// How many readings are left until a block ends.
    pub(super) const fn left(&self) -> usize {
        (Self::BLOCK - self.readings) as usize
    }

    /// With the reading before, in the same block.
    #[inline(always)]
    fn compare(&mut self, reading: T) {
        let change = reading - self.last;
        let square = change * change;
        self.squares += square;
        // Of finite readings. What is chosen by a value and not by a jump, which noise makes at random, costs least.
        self.largest = if square > self.largest { square } else { self.largest };
        self.least = if reading < self.least { reading } else { self.least };
        self.greatest = if reading > self.greatest { reading } else { self.greatest };
        self.last = reading;
    }

    /// A block that was begun is forgotten.
    pub(super) fn interrupt(&mut self) {
        self.readings = 0;
    }

    fn end_block(&mut self, hold: T) {
        let changes = T::literal(f64::from(2 * (Self::BLOCK - 1)));
        let (variance, without_jump) = (self.squares / changes, (self.squares - self.largest) / changes);
        let range = self.greatest - self.least;
        let looks_like_noise =
            range > hold && range * range <= without_jump * T::literal(Self::WIDEST * Self::WIDEST);
        if !looks_like_noise {
            return;
        }
        self.blocks = self.blocks.saturating_add(1);
        if self.blocks <= Self::FEWEST / 2 {
            self.variance = if self.blocks == 1 { variance } else { self.variance.min(variance) };
            return;
        }
        let pace = (2.0 / f64::from(self.blocks)).max(0.02);
        let share = if variance < self.variance { Self::SHARE - 1.0 } else { Self::SHARE };
        self.variance *= T::literal(1.0 + pace * share);
    }

    /// The variance of a reading at rest; `None` until enough quiet blocks are known.
    pub(super) fn variance(&self) -> Option<T> {
        (self.blocks >= Self::FEWEST).then_some(self.variance)
    }
}

#[cfg(test)]
mod tests {
    use super::QuietNoise;

    /// A block that goes to and fro between 0 and this, which it begins with: its variance is half of the square.
    fn block(width: f64) -> [f64; 32] {
        core::array::from_fn(|k| if k % 2 == 0 { width } else { 0.0 })
    }

    fn after(blocks: impl IntoIterator<Item = [f64; 32]>) -> Option<f64> {
        let mut noise = QuietNoise::new();
        blocks.into_iter().for_each(|block| noise.add_all(&block, 0.0));
        noise.variance()
    }

    #[test]
    fn eight_blocks_tell_the_noise_wherever_they_begin() {
        for width in [2.0, -2.0] {
            assert_eq!(after([block(width); 7]), None);
            let variance = after([block(width); 8]).unwrap();
            assert!((1.0..=2.0).contains(&variance), "{variance}");
        }
    }

    #[test]
    fn a_jump_is_no_noise() {
        let jump = core::array::from_fn(|k| block(2.0)[k] + if k < 16 { 0.0 } else { 100.0 });
        assert_eq!(after([jump; 20]), None);
    }

    /// A block that is noisier takes the quantile up by a quarter of the pace, which is 2 over the number of blocks, and a
    /// fiftieth in the end.
    #[test]
    fn the_quantile_follows_quickly_at_first_and_never_stops() {
        let after = |quiet, noisy| {
            let blocks =
                core::iter::repeat_n(block(2.0), quiet).chain(core::iter::repeat_n(block(20.0), noisy));
            after(blocks).unwrap()
        };
        let paces =
            |first: u32, last: u32| (first..=last).map(|k| 1.0 + 0.25 * (2.0 / f64::from(k)).max(0.02));
        for (noisy, last) in [(36, 40), (200, 204)] {
            let expected = 2.0 * paces(5, last).product::<f64>();
            assert!((after(4, noisy) - expected).abs() < 1e-9 * expected, "{} {expected}", after(4, noisy));
        }
    }
}
