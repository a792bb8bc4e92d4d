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
