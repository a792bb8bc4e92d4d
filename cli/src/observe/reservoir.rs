//! A fair sample of a stream.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// Keeps a fixed number of items of a stream of unknown length, every item with the same
/// probability (Vitter's algorithm R). The same stream gives the same sample.
#[derive(Clone, Debug)]
pub(crate) struct Reservoir<Item> {
    kept: Vec<Item>,
    capacity: usize,
    seen: u64,
    random: Pcg64Mcg,
}

impl<Item> Reservoir<Item> {
    pub(crate) fn new(capacity: usize) -> Self {
        Self { kept: Vec::with_capacity(capacity), capacity, seen: 0, random: Pcg64Mcg::seed_from_u64(0) }
    }

    /// Offers the next item, which is made only if it is kept.
    #[inline]
    pub(crate) fn add(&mut self, item: impl FnOnce() -> Item) {
        self.seen += 1;
        if self.kept.len() < self.capacity {
            self.kept.push(item());
            return;
        }
        let place = self.random.random_range(0..self.seen);
        if let Ok(place) = usize::try_from(place)
            && let Some(slot) = self.kept.get_mut(place)
        {
            *slot = item();
        }
    }

    /// What was kept, in no order.
    pub(crate) fn kept(&self) -> &[Item] {
        &self.kept
    }

    /// How many items were offered.
    pub(crate) fn seen(&self) -> u64 {
        self.seen
    }
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_pcg::Pcg64Mcg;

    use super::Reservoir;

    #[test]
    fn keeps_all_of_few_and_a_fair_share_of_many() {
        let mut few = Reservoir::new(10);
        (0..7).for_each(|item| few.add(|| item));
        assert_eq!(few.kept(), [0, 1, 2, 3, 4, 5, 6]);

        let mut many = Reservoir::new(1000);
        (0..100_000).for_each(|item| many.add(|| item));
        assert_eq!((many.kept().len(), many.seen()), (1000, 100_000));
        // Each tenth of the stream holds 100 of the kept on average, with a deviation of 9.5.
        for tenth in 0..10 {
            let share = many.kept().iter().filter(|item| **item / 10_000 == tenth).count();
            assert!((50..150).contains(&share), "tenth {tenth}: {share}");
        }
    }

    #[test]
    fn every_item_of_a_short_stream_is_kept_equally_often() {
        const RUNS: u32 = 20_000;
        let mut kept = [0_u32; 5];
        let mut made = 0;
        for seed in 0..RUNS {
            let mut some =
                Reservoir { random: Pcg64Mcg::seed_from_u64(u64::from(seed)), ..Reservoir::new(2) };
            for item in 0..kept.len() {
                some.add(|| {
                    made += 1;
                    item
                });
            }
            some.kept().iter().for_each(|item| kept[*item] += 1);
            assert_eq!((some.kept().len(), some.seen()), (2, 5));
        }
        // Kept with the probability 2/5: a standard deviation is 0.0035.
        for (item, times) in kept.iter().enumerate() {
            let share = f64::from(*times) / f64::from(RUNS);
            assert!((share - 0.4).abs() < 0.0175, "item {item}: {share}");
        }
        // Item i (from 1) is made with the probability min(1, 2/i): 2 + 2/3 + 2/4 + 2/5 in all, ± 0.005.
        let each = f64::from(made) / f64::from(RUNS);
        assert!((each - (2.0 + 2.0 / 3.0 + 0.5 + 0.4)).abs() < 0.025, "{each}");
    }
}
