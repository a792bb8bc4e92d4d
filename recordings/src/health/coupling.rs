//! Noise that channels have in common.

use super::block::Block;

/// Two channels whose noise is not independent.
///
/// ```
/// use fingertip_recordings::health::{Depth, HealthWatch, Kind, WatchedChannel};
///
/// let channels = ["v1", "v2", "v3"].map(|name| WatchedChannel::new(name, "V", Kind::Signal)).to_vec();
/// let mut watch = HealthWatch::new(channels, Depth::Full);
/// let mut state = 1_u32;
/// let mut noise = || {
///     state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
///     f64::from(state >> 16) / 65_536.0 - 0.5
/// };
/// for i in 0..20_000 {
///     let (first, second, third) = (noise(), noise(), noise());
///     watch.add(Some(f64::from(i) * 1e-3), &[first, second, first + third]); // the third hears the first
/// }
/// let coupling = watch.finish().couplings[0];
/// assert_eq!((coupling.first, coupling.second), (0, 2));
/// assert!((coupling.correlation - 0.5_f64.sqrt()).abs() < 0.02);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Coupling {
    /// The number of the first channel.
    pub first: usize,
    /// The number of the second.
    pub second: usize,
    /// Correlation of their changes from reading to reading, at rest.
    pub correlation: f64,
}

/// Standard errors by which a correlation is one.
const DEVIATIONS: f64 = 7.0;
/// Less does no harm.
const LEAST: f64 = 0.08;

/// The pairs of channels that are correlated in these blocks, strongest first.
pub(super) fn of(blocks: &[Block], pairs: &[(usize, usize)]) -> Vec<Coupling> {
    let sum = |place: usize| blocks.iter().filter_map(|block| block.products.get(place)).sum::<f64>();
    let sums: Vec<f64> = (0..pairs.len()).map(sum).collect();
    let samples: f64 = blocks.iter().map(|block| f64::from(block.samples)).sum();
    let alone = |channel: usize| {
        let place = pairs.iter().position(|pair| *pair == (channel, channel))?;
        sums.get(place).copied().filter(|sum| *sum > 0.0)
    };
    // Changes of white noise overlap: a correlation scatters by √(1.5/n).
    let least = (DEVIATIONS * (1.5 / samples.max(1.0)).sqrt()).max(LEAST);
    let mut found = Vec::new();
    for (&(first, second), both) in pairs.iter().zip(&sums).filter(|((i, j), _)| i != j) {
        if let (Some(a), Some(b)) = (alone(first), alone(second)) {
            let correlation = both / (a * b).sqrt();
            if correlation.abs() > least {
                found.push(Coupling { first, second, correlation });
            }
        }
    }
    found.sort_by(|a, b| b.correlation.abs().total_cmp(&a.correlation.abs()));
    found
}
