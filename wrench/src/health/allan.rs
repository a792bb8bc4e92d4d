//! Noise by the time over which readings are averaged.

use crate::Real;

/// The Allan variance of a channel, for averages over 1, 2, 4 … readings, in fixed memory.
///
/// `σ²(n) = ½ ⟨(ȳ₍ₖ₊₁₎ − ȳₖ)²⟩`, where `ȳₖ` are the means of stretches of `n` readings that follow each other without
/// overlap (Allan 1966; IEEE 1139). Of independent noise it falls as `1/n`; where it stays level or grows, averaging
/// longer no longer helps: the channel drifts. Stretches of `2n` readings are made of those of `n`, so that a reading
/// costs two additions on average. See `docs/theory/wrench.md#the-health-of-a-channel`.
///
/// ```
/// use fingertip_wrench::AllanVariance;
///
/// let mut allan = AllanVariance::<f64>::default();
/// for i in 0..8 {
///     allan.add(f64::from(i));
/// }
/// // A ramp of one a reading: its means differ by as much as they are long.
/// assert_eq!(allan.variance(0), Some(0.5));
/// assert_eq!(allan.variance(1), Some(2.0));
/// assert_eq!(allan.variance(2), Some(8.0));
/// assert_eq!(allan.variance(3), None);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AllanVariance<T: Real> {
    /// Σ (ȳ₍ₖ₊₁₎ − ȳₖ)² of each octave.
    sums: [T; OCTAVES],
    pairs: [u32; OCTAVES],
    /// The mean of the stretch before, of each octave.
    before: [Option<T>; OCTAVES],
    /// The first half of the stretch that is being filled.
    half: [Option<T>; OCTAVES],
}

/// Stretches of up to 2¹⁵ readings.
const OCTAVES: usize = 16;

impl<T: Real> Default for AllanVariance<T> {
    fn default() -> Self {
        Self {
            sums: [T::zero(); OCTAVES],
            pairs: [0; OCTAVES],
            before: [None; OCTAVES],
            half: [None; OCTAVES],
        }
    }
}

impl<T: Real> AllanVariance<T> {
    /// How many octaves there are: stretches of 1 to `2^(OCTAVES − 1)` readings.
    pub const OCTAVES: usize = OCTAVES;

    /// Takes the next reading. One that is not finite counts as a gap.
    pub fn add(&mut self, reading: T) {
        if !reading.is_number() {
            return self.interrupt();
        }
        let mut mean = reading;
        for octave in 0..OCTAVES {
            if let Some(before) = self.before[octave].replace(mean) {
                let change = mean - before;
                self.sums[octave] += change * change;
                self.pairs[octave] = self.pairs[octave].saturating_add(1);
            }
            let Some(half) = self.half[octave].take() else {
                self.half[octave] = Some(mean);
                return;
            };
            // Halved before they are added, so that no sum leaves the range.
            mean = half * T::literal(0.5) + mean * T::literal(0.5);
        }
    }

    /// Readings are missing here: no difference is taken across.
    pub fn interrupt(&mut self) {
        self.before = [None; OCTAVES];
        self.half = [None; OCTAVES];
    }

    /// The Allan variance of means over `2^octave` readings; `None` before two of them are there, and beyond the
    /// last octave.
    #[must_use]
    pub fn variance(&self, octave: usize) -> Option<T> {
        let pairs = *self.pairs.get(octave)?;
        let sum = *self.sums.get(octave)?;
        (pairs > 0).then(|| sum * T::literal(0.5) / T::literal(f64::from(pairs)))
    }

    /// How many differences an octave's variance is the mean of.
    #[must_use]
    pub fn pairs(&self, octave: usize) -> u32 {
        self.pairs.get(octave).copied().unwrap_or_default()
    }
}
