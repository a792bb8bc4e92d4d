//! Quantiles of a stream, in fixed memory.

/// Sub-buckets in every octave: 2⁷.
const PRECISION_BITS: u32 = 7;
/// Octaves below and above 1 that are told apart: 2⁻⁴⁰ to 2⁴⁰, in newtons from below a piconewton
/// to above a teranewton.
const OCTAVES: u64 = 40;
const SHIFT: u32 = 52 - PRECISION_BITS;
const LOWEST: u64 = (1023 - OCTAVES) << PRECISION_BITS;
const BUCKETS: usize = (2 * OCTAVES as usize) << PRECISION_BITS;

/// Counts of positive numbers in buckets of constant relative width, as in an HDR histogram: the
/// exponent and the first seven bits of the mantissa are the index, so that adding costs a shift.
///
/// A quantile is the middle of the bucket that holds the number of that rank: its relative error
/// is at most 2⁻⁸ = 0.4 %. Least and greatest number are exact. Memory: 82 kB, however long the
/// stream. Zero and numbers below 2⁻⁴⁰ count as zero, those above 2⁴⁰ as 2⁴⁰.
#[derive(Clone, Debug)]
pub(crate) struct Quantiles {
    buckets: Vec<u64>,
    zeros: u64,
    count: u64,
    least: f64,
    greatest: f64,
}

impl Default for Quantiles {
    fn default() -> Self {
        Self {
            buckets: vec![0; BUCKETS],
            zeros: 0,
            count: 0,
            least: f64::INFINITY,
            greatest: f64::NEG_INFINITY,
        }
    }
}

impl Quantiles {
    /// Takes a number that is not negative; NaN and negative ones are left out.
    #[inline]
    pub(crate) fn add(&mut self, value: f64) {
        if !(value >= 0.0) {
            return;
        }
        self.count += 1;
        self.least = self.least.min(value);
        self.greatest = self.greatest.max(value);
        // Positive numbers are ordered as their bits are.
        let index = (value.to_bits() >> SHIFT).checked_sub(LOWEST);
        match index.and_then(|index| usize::try_from(index).ok()) {
            None => self.zeros += 1,
            Some(index) => {
                if let Some(bucket) = self.buckets.get_mut(index.min(BUCKETS - 1)) {
                    *bucket += 1;
                }
            }
        }
    }

    /// How many numbers were taken.
    pub(crate) fn count(&self) -> u64 {
        self.count
    }

    /// The greatest number, exact; `None` before the first.
    pub(crate) fn greatest(&self) -> Option<f64> {
        (self.count > 0).then_some(self.greatest)
    }

    /// The number below which a share of the stream lies, `share` in [0, 1]; `None` before the
    /// first.
    pub(crate) fn quantile(&self, share: f64) -> Option<f64> {
        let last = self.count.checked_sub(1)?;
        let rank = (share.clamp(0.0, 1.0) * last as f64).round() as u64;
        if rank == 0 {
            return Some(self.least);
        }
        if rank >= last {
            return Some(self.greatest);
        }
        let mut seen = self.zeros;
        if rank < seen {
            return Some(self.least);
        }
        for (index, bucket) in self.buckets.iter().enumerate() {
            seen += bucket;
            if rank < seen {
                let low = f64::from_bits((LOWEST + index as u64) << SHIFT);
                let high = f64::from_bits((LOWEST + index as u64 + 1) << SHIFT);
                return Some((0.5 * (low + high)).clamp(self.least, self.greatest));
            }
        }
        Some(self.greatest)
    }
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};

    use super::Quantiles;

    #[test]
    fn stays_within_its_error_over_twenty_decades() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(3);
        for decades in [0.1, 3.0, 20.0] {
            let mut sketch = Quantiles::default();
            let mut all: Vec<f64> =
                (0..20_000).map(|_| 10.0_f64.powf(decades * (random.random::<f64>() - 0.5))).collect();
            all.iter().for_each(|value| sketch.add(*value));
            all.sort_by(f64::total_cmp);
            for share in [0.0, 0.001, 0.05, 0.25, 0.5, 0.75, 0.95, 0.999, 1.0] {
                let exact = all[(share * (all.len() - 1) as f64).round() as usize];
                let estimate = sketch.quantile(share).unwrap();
                assert!(
                    (estimate - exact).abs() <= exact / 256.0,
                    "{decades} decades, share {share}: {estimate} against {exact}"
                );
            }
        }
    }

    #[test]
    fn takes_zeros_and_refuses_what_is_no_magnitude() {
        let mut sketch = Quantiles::default();
        assert_eq!(sketch.quantile(0.5), None);
        for value in [f64::NAN, -1.0, f64::NEG_INFINITY] {
            sketch.add(value);
        }
        assert_eq!(sketch.count(), 0);
        for value in [0.0, 5e-324, 1e-200, 3.0] {
            sketch.add(value);
        }
        assert_eq!(sketch.count(), 4);
        assert_eq!(sketch.quantile(0.0), Some(0.0));
        assert_eq!(sketch.quantile(0.4), Some(0.0));
        assert_eq!(sketch.quantile(1.0), Some(3.0));
        sketch.add(f64::INFINITY);
        assert_eq!(sketch.greatest(), Some(f64::INFINITY));
    }

    /// 2⁻⁴⁰ and 2⁴⁰, between which numbers are told apart.
    const TOLD_APART: (f64, f64) = (1.0 / (1_u64 << 40) as f64, (1_u64 << 40) as f64);

    #[test]
    fn every_rank_of_a_short_stream_is_that_of_the_sorted_numbers() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(4);
        for length in 1..60_usize {
            let mut sketch = Quantiles::default();
            // Repeated numbers, zeros, and numbers beyond what is told apart at either end.
            let mut all: Vec<f64> = (0..length)
                .map(|_| match random.random_range(0..6) {
                    0 => 0.0,
                    1 => TOLD_APART.0 * random.random::<f64>(),
                    2 => TOLD_APART.1 * (1.0 + random.random::<f64>()),
                    3 => 2.5,
                    _ => 2.0_f64.powi(random.random_range(-40..40)),
                })
                .collect();
            all.iter().for_each(|value| sketch.add(*value));
            all.sort_by(f64::total_cmp);
            let (least, greatest) = (all[0], all[length - 1]);
            for (rank, exact) in all.iter().enumerate() {
                let share = if length > 1 { rank as f64 / (length - 1) as f64 } else { 0.0 };
                let found = sketch.quantile(share).unwrap();
                assert!((least..=greatest).contains(&found), "{found} of {all:?}");
                if rank == 0 || rank == length - 1 {
                    assert_eq!(found, *exact);
                } else if *exact < TOLD_APART.0 {
                    assert!(found < TOLD_APART.0, "rank {rank}: {found} for {exact}");
                } else {
                    let exact = exact.min(TOLD_APART.1);
                    assert!((found - exact).abs() <= exact / 256.0, "rank {rank}: {found} for {exact}");
                }
            }
            // Shares beyond the ends are the ends.
            assert_eq!((sketch.quantile(-1.0), sketch.quantile(2.0)), (Some(least), Some(greatest)));
        }
    }

    #[test]
    fn the_middle_of_a_bucket_is_given_and_shares_round_to_the_nearest_rank() {
        // The bucket from 1 has the width 2⁻⁷.
        let mut sketch = Quantiles::default();
        [0.5, 1.0, 1.0, 2.0].iter().for_each(|value| sketch.add(*value));
        assert_eq!(sketch.quantile(0.5), Some(1.0 + 0.5 / 128.0));
        // Of four numbers, ranks 0 to 3: a share of 0.17 is next to rank 1, of 0.16 to rank 0.
        assert_eq!(sketch.quantile(0.17), Some(1.0 + 0.5 / 128.0));
        assert_eq!(sketch.quantile(0.16), Some(0.5));
        assert_eq!(sketch.greatest(), Some(2.0));
        assert_eq!(Quantiles::default().greatest(), None);
    }
}
