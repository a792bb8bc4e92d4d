//! Noise that channels have in common.

use super::block::Block;

/// Two channels whose noise is not independent.
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
