//! Thermal compensation from a thermometer.

use nalgebra::SVector;
use thiserror::Error;

use crate::{Compensation, Real};

/// One raw reading of `N` gauges and of the temperature of the sensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GaugesAndTemperature<T: Real, const N: usize> {
    /// The gauges.
    pub gauges: SVector<T, N>,
    /// Temperature of the sensor \[°C or K, as the coefficients\].
    pub temperature: T,
}

/// Polynomials in temperature for the zero and the sensitivity of each gauge:
///
/// `signal = (raw − Σₖ zero[k] ΔTᵏ) / (1 + Σₖ sensitivity[k] ΔTᵏ⁺¹)`, `ΔT = temperature − reference`,
///
/// with `TERMS` coefficients for each: `zero[0]` is the zero at the reference temperature (the tare),
/// and the sensitivity there is 1 by definition.
///
/// A polynomial is good where it was fitted: outside the range given, the coefficients of the nearest
/// end are used, and [`covers`](Self::covers) says so.
///
/// ```
/// use fingertip_wrench::{Compensation, GaugesAndTemperature, TemperatureCompensation};
/// use nalgebra::SVector;
///
/// // Zero at 20 °C, 2 mV and 20 µV/K² of drift; 0.1 %/K more sensitive when warm.
/// let zero = [SVector::repeat(0.5), SVector::repeat(2e-3), SVector::repeat(2e-5)];
/// let sensitivity = [SVector::repeat(1e-3), SVector::zeros(), SVector::zeros()];
/// let compensation = TemperatureCompensation::<f64, 6, 3>::new(20.0, (0.0, 60.0), zero, sensitivity)?;
/// let raw = GaugesAndTemperature { gauges: SVector::repeat(0.5 + 0.02 + 0.002 + 1.01), temperature: 30.0 };
/// assert!((compensation.compensate(&raw)[0] - 1.0).abs() < 1e-14);
/// # Ok::<(), fingertip_wrench::BadTemperatureModel>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TemperatureCompensation<T: Real, const N: usize, const TERMS: usize> {
    reference: T,
    range: (T, T),
    zero: [SVector<T, N>; TERMS],
    sensitivity: [SVector<T, N>; TERMS],
}

/// Why coefficients cannot be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum BadTemperatureModel {
    /// A coefficient is NaN or infinite.
    #[error("a temperature coefficient of gauge {gauge} is not a finite number")]
    NotFinite {
        /// Which gauge, counted from 0.
        gauge: usize,
    },
    /// The range is empty, not finite, or does not contain the reference.
    #[error("the temperature range must be finite and contain the reference temperature")]
    BadRange,
    /// The sensitivity may vanish within the range.
    #[error("the sensitivity of gauge {gauge} may change by 100 % within the temperature range")]
    SensitivityVanishes {
        /// Which gauge, counted from 0.
        gauge: usize,
    },
}

impl<T: Real, const N: usize, const TERMS: usize> TemperatureCompensation<T, N, TERMS> {
    /// From the reference temperature, the range of the fit and the coefficients.
    ///
    /// # Errors
    /// [`BadTemperatureModel`].
    pub fn new(
        reference: T,
        range: (T, T),
        zero: [SVector<T, N>; TERMS],
        sensitivity: [SVector<T, N>; TERMS],
    ) -> Result<Self, BadTemperatureModel> {
        let finite = range.0.is_number() && range.1.is_number() && reference.is_number();
        if !(finite && range.0 <= reference && reference <= range.1) {
            return Err(BadTemperatureModel::BadRange);
        }
        let farthest = (range.1 - reference).max(reference - range.0);
        for gauge in 0..N {
            let mut coefficients = zero.iter().chain(sensitivity.iter());
            if !coefficients.all(|term| term[gauge].is_number()) {
                return Err(BadTemperatureModel::NotFinite { gauge });
            }
            let most =
                sensitivity.iter().rev().fold(T::zero(), |sum, term| (sum + term[gauge].abs()) * farthest);
            if !(most < T::one()) {
                return Err(BadTemperatureModel::SensitivityVanishes { gauge });
            }
        }
        Ok(Self { reference, range, zero, sensitivity })
    }

    /// Whether the coefficients were fitted at this temperature.
    #[inline]
    #[must_use]
    pub fn covers(&self, temperature: T) -> bool {
        self.range.0 <= temperature && temperature <= self.range.1
    }
}

impl<T: Real, const N: usize, const TERMS: usize> Compensation<T, N>
    for TemperatureCompensation<T, N, TERMS>
{
    type Raw = GaugesAndTemperature<T, N>;

    /// A temperature that is NaN gives signals that are NaN, like a gauge that is.
    #[inline]
    fn compensate(&self, raw: &GaugesAndTemperature<T, N>) -> SVector<T, N> {
        let (least, greatest) = self.range;
        // Written so that NaN passes through.
        let held = if raw.temperature < least {
            least
        } else if raw.temperature > greatest {
            greatest
        } else {
            raw.temperature
        };
        let warmer = held - self.reference;
        let zero = self.zero.iter().rev().fold(SVector::zeros(), |sum, term| sum * warmer + term);
        let gained =
            self.sensitivity.iter().rev().fold(SVector::<T, N>::zeros(), |sum, term| (sum + term) * warmer);
        (raw.gauges - zero).component_div(&gained.add_scalar(T::one()))
    }
}
