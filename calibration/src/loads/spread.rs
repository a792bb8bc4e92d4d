//! Some of many samples, spread over all.

use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64Mcg;

/// So many places of a list, one in each of as many stretches of equal length, all places being equally likely. At no even
/// distance, since loads may repeat themselves; the same in every run.
pub(crate) fn spread(samples: usize, asked: usize) -> Vec<usize> {
    let mut random = Pcg64Mcg::seed_from_u64(1);
    let length = samples as f64 / asked as f64;
    (0..asked)
        .map(|number| {
            let within: f64 = random.random_range(0.0..1.0);
            (((number as f64 + within) * length) as usize).min(samples - 1)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::spread;

    #[test]
    fn one_place_lies_in_each_stretch() {
        for (samples, asked) in [(1000, 10), (997, 100), (50, 50), (100_000, 7)] {
            let places = spread(samples, asked);
            let length = samples as f64 / asked as f64;
            assert_eq!(places.len(), asked);
            for (number, place) in places.iter().enumerate() {
                let (begin, end) = (number as f64 * length, (number + 1) as f64 * length);
                assert!((begin.floor()..end).contains(&(*place as f64)), "{number} of {asked}: {place}");
            }
            assert_eq!(places, spread(samples, asked));
        }
        // Anywhere in them.
        let within: Vec<usize> = spread(100_000, 100).iter().map(|place| place % 1000).collect();
        assert!(within.iter().any(|x| *x < 100) && within.iter().any(|x| *x > 900), "{within:?}");
    }
}
