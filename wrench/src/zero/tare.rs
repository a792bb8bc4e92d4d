//! The zero of the gauges.

use nalgebra::SVector;
use thiserror::Error;

use crate::{Compensation, Real};

/// The readings of the unloaded sensor, subtracted from every reading.
///
/// Nothing in this library tares by itself: collect samples of the unloaded sensor with a
/// [`RestTest`](crate::RestTest), or a bare [`TareAccumulator`], when *you* know that it is
/// unloaded.
///
/// ```
/// use fingertip_wrench::{Compensation, Tare};
/// use nalgebra::Vector6;
///
/// let tare = Tare::new(Vector6::repeat(0.25));
/// assert_eq!(tare.compensate(&Vector6::repeat(1.5)), Vector6::repeat(1.25));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>"))
)]
pub struct Tare<T: Real, const N: usize> {
    zero: SVector<T, N>,
}

impl<T: Real, const N: usize> Tare<T, N> {
    /// From known readings of the unloaded sensor.
    #[inline]
    #[must_use]
    pub const fn new(zero: SVector<T, N>) -> Self {
        Self { zero }
    }

    /// The readings of the unloaded sensor.
    #[inline]
    #[must_use]
    pub const fn zero(&self) -> &SVector<T, N> {
        &self.zero
    }
}

impl<T: Real, const N: usize> Compensation<SVector<T, N>> for Tare<T, N> {
    type Raw = SVector<T, N>;

    #[inline]
    fn compensate(&self, raw: &SVector<T, N>) -> SVector<T, N> {
        raw - self.zero
    }
}

/// Mean and variance of readings at rest, one sample at a time (Welford's recurrence, which does
/// not cancel).
///
/// ```
/// use fingertip_wrench::TareAccumulator;
/// use nalgebra::Vector6;
///
/// let mut rest = TareAccumulator::<f64, 6>::default();
/// for reading in [0.9, 1.0, 1.1] {
///     rest.add(&Vector6::repeat(reading));
/// }
/// assert!((rest.finish()?.zero()[0] - 1.0).abs() < 1e-15);
/// assert!((rest.noise()?[0] - 0.1).abs() < 1e-15); // √((0.1² + 0.1²)/2)
/// # Ok::<(), fingertip_wrench::TareError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TareAccumulator<T: Real, const N: usize> {
    samples: u32,
    mean: SVector<T, N>,
    squares: SVector<T, N>,
}

/// Why readings give no tare.
///
/// ```
/// use fingertip_wrench::{TareAccumulator, TareError};
/// use nalgebra::Vector6;
///
/// let mut rest = TareAccumulator::<f64, 6>::default();
/// rest.add(&Vector6::zeros());
/// let refused = rest.finish().unwrap_err();
/// assert_eq!(refused, TareError::TooFewSamples { samples: 1 });
/// assert_eq!(refused.to_string(), "a tare needs at least 2 samples at rest, not 1");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum TareError {
    /// Fewer than two samples: no mean with a known error.
    #[error("a tare needs at least 2 samples at rest, not {samples}")]
    TooFewSamples {
        /// How many finite samples there were.
        samples: u32,
    },
    /// Readings so large that their mean or spread cannot be represented.
    #[error("the readings of gauge {gauge} are too large for the scalar type")]
    OutOfRange {
        /// Which gauge, counted from 0.
        gauge: usize,
    },
}

impl<T: Real, const N: usize> Default for TareAccumulator<T, N> {
    fn default() -> Self {
        Self { samples: 0, mean: SVector::zeros(), squares: SVector::zeros() }
    }
}

impl<T: Real, const N: usize> TareAccumulator<T, N> {
    /// Takes one reading at rest; one that is not finite is left out, and `false` returned.
    pub fn add(&mut self, raw: &SVector<T, N>) -> bool {
        if !raw.iter().all(|x| x.is_number()) {
            return false;
        }
        self.samples = self.samples.saturating_add(1);
        let weight = T::one() / T::literal(f64::from(self.samples));
        let before = raw - self.mean;
        self.mean += before * weight;
        self.squares += before.component_mul(&(raw - self.mean));
        true
    }

    /// How many readings were taken.
    #[must_use]
    pub const fn samples(&self) -> u32 {
        self.samples
    }

    /// The mean of the readings so far; zero before the first.
    #[must_use]
    pub const fn mean(&self) -> &SVector<T, N> {
        &self.mean
    }

    /// Standard deviation of one reading of each gauge at rest.
    ///
    /// # Errors
    /// [`TareError`].
    pub fn noise(&self) -> Result<SVector<T, N>, TareError> {
        if self.samples < 2 {
            return Err(TareError::TooFewSamples { samples: self.samples });
        }
        let degrees = T::literal(f64::from(self.samples - 1));
        in_range(self.squares.map(|square| (square / degrees).root()))
    }

    /// The tare: the mean of the readings.
    ///
    /// # Errors
    /// [`TareError`].
    pub fn finish(&self) -> Result<Tare<T, N>, TareError> {
        if self.samples < 2 {
            return Err(TareError::TooFewSamples { samples: self.samples });
        }
        in_range(self.mean).map(Tare::new)
    }
}

fn in_range<T: Real, const N: usize>(values: SVector<T, N>) -> Result<SVector<T, N>, TareError> {
    match values.iter().position(|x| !x.is_number()) {
        Some(gauge) => Err(TareError::OutOfRange { gauge }),
        None => Ok(values),
    }
}
