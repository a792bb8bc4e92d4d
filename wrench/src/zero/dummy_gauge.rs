//! Thermal compensation by a gauge that sees the temperature and no load.

use nalgebra::SVector;

use crate::{Compensation, Real, Tare, TareAccumulator, TareError};

/// One raw reading of `N` gauges and of the dummy gauge beside them.
///
/// ```
/// use fingertip_wrench::{DummyGaugeAccumulator, GaugesAndDummy};
/// use nalgebra::Vector6;
///
/// // Six gauges and the seventh, as they come from the converter.
/// let [dummy, gauges @ ..] = [0.3, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1];
/// let reading = GaugesAndDummy { gauges: Vector6::from(gauges), dummy };
/// assert!(DummyGaugeAccumulator::default().add(&reading));
/// // One that is not finite is left out.
/// assert!(!DummyGaugeAccumulator::default().add(&GaugesAndDummy { dummy: f64::NAN, ..reading }));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GaugesAndDummy<T: Real, const N: usize> {
    /// The gauges that carry load.
    pub gauges: SVector<T, N>,
    /// The gauge that does not.
    pub dummy: T,
}

/// Tare and thermal compensation: `signal_i = raw_i − zero_i − (dummy − dummy_zero)`.
///
/// The dummy gauge is glued to the same material where no load goes through it, so that what it
/// reads since the tare is what the temperature did to all (the paper's seventh gauge). It adds its
/// own noise to every gauge, in common.
///
/// ```
/// use fingertip_wrench::{Compensation, DummyGauge, GaugesAndDummy, Tare};
/// use nalgebra::Vector6;
///
/// // At rest the gauges read 0.1 V, the dummy 0.3 V.
/// let zero = DummyGauge::new(Tare::new(Vector6::repeat(0.1)), 0.3);
/// // It gets warm, which adds 0.05 V to all; 1 V is load.
/// let raw = GaugesAndDummy { gauges: Vector6::repeat(1.15), dummy: 0.35 };
/// assert!((zero.compensate(&raw) - Vector6::repeat(1.0_f64)).amax() < 1e-15);
/// # Ok::<(), fingertip_wrench::TareError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>"))
)]
pub struct DummyGauge<T: Real, const N: usize> {
    tare: Tare<T, N>,
    dummy_zero: T,
    ratios: SVector<T, N>,
}

impl<T: Real, const N: usize> DummyGauge<T, N> {
    /// From known readings of the unloaded sensor.
    #[inline]
    #[must_use]
    pub fn new(tare: Tare<T, N>, dummy_zero: T) -> Self {
        Self { tare, dummy_zero, ratios: SVector::repeat(T::one()) }
    }

    /// The same for gauges that feel the temperature more or less than the dummy does:
    /// `signal_i = raw_i − zero_i − ratio_i (dummy − dummy_zero)`. A soak without load gives the
    /// ratios, by regression of each gauge on the dummy.
    #[inline]
    #[must_use]
    pub fn with_ratios(self, ratios: SVector<T, N>) -> Self {
        Self { ratios, ..self }
    }
}

impl<T: Real, const N: usize> Compensation<SVector<T, N>> for DummyGauge<T, N> {
    type Raw = GaugesAndDummy<T, N>;

    #[inline]
    fn compensate(&self, raw: &GaugesAndDummy<T, N>) -> SVector<T, N> {
        self.tare.compensate(&raw.gauges) + self.ratios * (self.dummy_zero - raw.dummy)
    }
}

/// Collects readings at rest of the gauges and the dummy gauge.
///
/// ```
/// use fingertip_wrench::{Compensation, DummyGaugeAccumulator, GaugesAndDummy};
/// use nalgebra::Vector6;
///
/// let mut rest = DummyGaugeAccumulator::default();
/// rest.add(&GaugesAndDummy { gauges: Vector6::repeat(0.09), dummy: 0.31 });
/// rest.add(&GaugesAndDummy { gauges: Vector6::repeat(0.11), dummy: 0.29 });
/// let zero = rest.finish()?; // 0.1 V, and 0.3 V of the dummy
/// let warmer = GaugesAndDummy { gauges: Vector6::repeat(0.15), dummy: 0.35 };
/// assert!(zero.compensate(&warmer).amax() < 1e-15_f64);
/// # Ok::<(), fingertip_wrench::TareError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DummyGaugeAccumulator<T: Real, const N: usize> {
    gauges: TareAccumulator<T, N>,
    dummy: TareAccumulator<T, 1>,
}

impl<T: Real, const N: usize> Default for DummyGaugeAccumulator<T, N> {
    fn default() -> Self {
        Self { gauges: TareAccumulator::default(), dummy: TareAccumulator::default() }
    }
}

impl<T: Real, const N: usize> DummyGaugeAccumulator<T, N> {
    /// Takes one reading at rest; one that is not finite is left out, and `false` returned.
    pub fn add(&mut self, raw: &GaugesAndDummy<T, N>) -> bool {
        raw.dummy.is_number()
            && self.gauges.add(&raw.gauges)
            && self.dummy.add(&SVector::<T, 1>::new(raw.dummy))
    }

    /// The compensation: the means of the readings as zero.
    ///
    /// # Errors
    /// [`TareError::TooFewSamples`].
    pub fn finish(&self) -> Result<DummyGauge<T, N>, TareError> {
        Ok(DummyGauge::new(self.gauges.finish()?, self.dummy.finish()?.zero().x))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn what_all_gauges_share_vanishes<T: Real>() {
        let literal = T::literal;
        let reading = |common: f64| GaugesAndDummy {
            gauges: SVector::<T, 3>::new(
                literal(1.0 + common),
                literal(-2.0 + common),
                literal(0.5 + common),
            ),
            dummy: literal(0.25 + common),
        };
        let mut rest = DummyGaugeAccumulator::default();
        for common in [-0.5, 0.5] {
            assert!(rest.add(&reading(common)));
        }
        assert!(!rest.add(&GaugesAndDummy { dummy: literal(f64::NAN), ..reading(0.0) }));
        let compensation = rest.finish().unwrap();
        assert!(compensation.compensate(&reading(3.0)).iter().all(|signal| signal.is_zero()));
        let mut loaded = reading(3.0);
        loaded.gauges.y += literal(0.125);
        assert_eq!(
            compensation.compensate(&loaded),
            SVector::<T, 3>::new(T::zero(), literal(0.125), T::zero())
        );
    }

    #[test]
    fn each_gauge_may_feel_the_temperature_in_its_own_ratio() {
        let ratios = SVector::<f64, 2>::new(2.0, 0.5);
        let compensation = DummyGauge::new(Tare::new(SVector::zeros()), 1.0).with_ratios(ratios);
        let raw = GaugesAndDummy { gauges: SVector::<f64, 2>::new(6.0, 2.0), dummy: 4.0 };
        assert_eq!(compensation.compensate(&raw), SVector::<f64, 2>::new(0.0, 0.5));
    }

    #[test]
    fn what_all_gauges_share_vanishes_for_both_precisions() {
        what_all_gauges_share_vanishes::<f32>();
        what_all_gauges_share_vanishes::<f64>();
    }
}
