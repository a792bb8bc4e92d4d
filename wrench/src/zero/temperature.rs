//! Thermal compensation from a thermometer.

#[cfg(feature = "serde")]
use nalgebra::SMatrix;
use nalgebra::SVector;
use thiserror::Error;

use crate::stored;
use crate::{Compensation, Real};

/// One raw reading of `N` gauges and of the temperature of the sensor.
///
/// ```
/// use fingertip_wrench::{Compensation, GaugesAndTemperature, TemperatureCompensation};
/// use nalgebra::Vector6;
///
/// // Zeros of 0.5 V at 20 °C, which drift by 2 mV per kelvin.
/// let zero = [Vector6::repeat(0.5), Vector6::repeat(2e-3)];
/// let model = TemperatureCompensation::<f64, 6, 2>::new(20.0, (0.0, 60.0), zero, [Vector6::zeros(); 2])?;
/// let warm = GaugesAndTemperature { gauges: Vector6::repeat(0.52), temperature: 30.0 };
/// assert!(model.compensate(&warm).amax() < 1e-15); // all of it is drift
/// # Ok::<(), fingertip_wrench::BadTemperatureModel>(())
/// ```
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
///
/// ```
/// use fingertip_wrench::{BadTemperatureModel, TemperatureCompensation};
/// use nalgebra::Vector6;
///
/// // Fitted between 30 °C and 60 °C, yet said to have its zeros at 20 °C.
/// let none = [Vector6::zeros()];
/// let refused = TemperatureCompensation::<f64, 6, 1>::new(20.0, (30.0, 60.0), none, none).unwrap_err();
/// assert_eq!(refused, BadTemperatureModel::BadRange);
/// let told = "the temperature range must be finite and contain the reference temperature";
/// assert_eq!(refused.to_string(), told);
/// ```
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

impl<T: Real, const N: usize, const TERMS: usize> Compensation<SVector<T, N>>
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

stored! {
    TemperatureCompensation<T, N, TERMS>, [T: Real, const N: usize, const TERMS: usize],
    |model| {
        reference: T = model.reference,
        range: (T, T) = model.range,
        // One column a power.
        zero: SMatrix<T, N, TERMS> = SMatrix::from_columns(&model.zero),
        sensitivity: SMatrix<T, N, TERMS> = SMatrix::from_columns(&model.sensitivity),
     },
    {
        let columns = |matrix: SMatrix<T, N, TERMS>| core::array::from_fn(|k| matrix.column(k).into_owned());
        Self::new(reference, range, columns(zero), columns(sensitivity))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Readings made by the model give the signals back, over the whole range.
    fn inverts<T: Real>() {
        let literal = T::literal;
        let zero = [0.3, -2e-3, 5e-5].map(|c| SVector::<T, 2>::new(literal(c), literal(-3.0 * c)));
        let sensitivity = [1e-3, -4e-6, 1e-8].map(|c| SVector::<T, 2>::new(literal(c), literal(2.0 * c)));
        let reference = literal(20.0);
        let model =
            TemperatureCompensation::new(reference, (literal(-10.0), literal(70.0)), zero, sensitivity)
                .expect("a model");
        for degrees in -10..=70 {
            let temperature = literal(f64::from(degrees));
            let d = temperature - reference;
            let signals = SVector::<T, 2>::new(literal(0.7), literal(-1.1));
            let gauges = SVector::<T, 2>::from_fn(|i, _| {
                let drift = zero[0][i] + zero[1][i] * d + zero[2][i] * d * d;
                let gain = sensitivity[0][i] * d + sensitivity[1][i] * d * d + sensitivity[2][i] * d * d * d;
                signals[i] * (T::one() + gain) + drift
            });
            let found = model.compensate(&GaugesAndTemperature { gauges, temperature });
            assert!((found - signals).amax() < T::EPSILON * literal(32.0));
            assert!(model.covers(temperature));
        }
    }

    #[test]
    fn compensation_inverts_the_model() {
        inverts::<f32>();
        inverts::<f64>();
    }

    #[test]
    fn beyond_the_fit_the_ends_are_held() {
        let zero = [SVector::<f64, 1>::new(0.0), SVector::<f64, 1>::new(1.0)];
        let none = [SVector::zeros(); 2];
        let model = TemperatureCompensation::new(20.0, (10.0, 30.0), zero, none).expect("a model");
        let at =
            |temperature| model.compensate(&GaugesAndTemperature { gauges: SVector::zeros(), temperature }).x;
        assert_eq!((at(30.0), at(1e30), at(f64::INFINITY)), (-10.0, -10.0, -10.0));
        assert_eq!((at(10.0), at(-300.0)), (10.0, 10.0));
        assert!(!model.covers(30.5) && !model.covers(f64::NAN) && at(f64::NAN).is_nan());
    }

    #[test]
    fn unusable_models_are_refused() {
        let new = |reference, range, zero: f64, gain: f64| {
            TemperatureCompensation::<f64, 1, 1>::new(
                reference,
                range,
                [SVector::repeat(zero)],
                [SVector::repeat(gain)],
            )
            .err()
        };
        assert_eq!(new(20.0, (0.0, 50.0), 0.1, 0.01), None);
        assert_eq!(new(60.0, (0.0, 50.0), 0.1, 0.01), Some(BadTemperatureModel::BadRange));
        assert_eq!(new(20.0, (0.0, f64::NAN), 0.1, 0.01), Some(BadTemperatureModel::BadRange));
        assert_eq!(new(20.0, (0.0, 50.0), f64::NAN, 0.01), Some(BadTemperatureModel::NotFinite { gauge: 0 }));
        let vanishes = Some(BadTemperatureModel::SensitivityVanishes { gauge: 0 });
        assert_eq!(new(20.0, (0.0, 50.0), 0.1, -0.04), vanishes);
    }
}
