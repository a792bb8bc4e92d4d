//! How the normal force is spread over a circular contact patch.

use crate::BadParameter;

/// An axially symmetric pressure on a circular patch; `x` is the radius over that of the patch.
///
/// ```
/// use fingertip_friction::PressureDistribution;
///
/// // A patch that is pressed evenly holds more spin torque than one that is pressed in its middle.
/// assert!(PressureDistribution::Uniform.relative_arm() > PressureDistribution::Hertz.relative_arm());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(remote = "Self"))]
#[non_exhaustive]
pub enum PressureDistribution {
    /// Constant: a flat punch on a soft layer.
    Uniform,
    /// `∝ (1 − x²)^(1/2)`: two elastic bodies (Hertz).
    Hertz,
    /// `∝ (1 − x^k)^(1/k)`, with k from 1.5 (peaked) over 2 (Hertz) to flat as k grows
    /// (Xydas & Kao 1999).
    PowerLaw(f64),
    /// `∝ 1 − x²`: a sphere on a bed of springs, or on a thin bonded layer.
    Winkler,
}

impl PressureDistribution {
    /// The distribution, if its exponent is in range.
    ///
    /// # Errors
    /// [`BadParameter`] unless the exponent of a power law is between 1.5 and 100.
    pub fn checked(self) -> Result<Self, BadParameter> {
        match self {
            Self::PowerLaw(exponent) if !(1.5..=100.0).contains(&exponent) => Err(BadParameter {
                parameter: "exponent of the pressure",
                requirement: "between 1.5 and 100",
            }),
            good => Ok(good),
        }
    }

    /// Pressure at the relative radius `x`, over the mean pressure; 0 outside the patch.
    #[must_use]
    pub fn relative(&self, x: f64) -> f64 {
        if !(0.0..=1.0).contains(&x) {
            return 0.0;
        }
        match *self {
            Self::Uniform => 1.0,
            Self::Hertz => 1.5 * libm::sqrt((1.0 - x) * (1.0 + x)),
            Self::PowerLaw(k) => {
                k / (2.0 * beta(2.0 / k, 1.0 + 1.0 / k)) * libm::pow(1.0 - libm::pow(x, k), 1.0 / k)
            }
            Self::Winkler => 2.0 * (1.0 - x) * (1.0 + x),
        }
    }

    /// The greatest spin torque over the greatest tangential force and the patch radius, `e/a`:
    /// 2/3 uniform, 3π/16 Hertz, 8/15 Winkler, `B(3/k, 1+1/k)/B(2/k, 1+1/k)` for a power law
    /// (`docs/theory/friction.md#pressure-distributions`).
    #[must_use]
    pub fn relative_arm(&self) -> f64 {
        match *self {
            Self::Uniform => 2.0 / 3.0,
            Self::Hertz => 3.0 * core::f64::consts::PI / 16.0,
            Self::PowerLaw(k) => beta(3.0 / k, 1.0 + 1.0 / k) / beta(2.0 / k, 1.0 + 1.0 / k),
            Self::Winkler => 8.0 / 15.0,
        }
    }

    /// The exponent q of the [`PowerLimit`](crate::PowerLimit) nearest to the exact limit curve:
    /// 1.70 uniform, 1.725 Hertz, 1.74 Winkler; all of them lie on `1.70 + 0.3 (2/3 − e/a)`. The
    /// limit is then within 1 % of the exact one along every ray (`docs/theory/friction.md#power-limit`).
    #[must_use]
    pub fn limit_exponent(&self) -> f64 {
        1.70 + 0.3 * (2.0 / 3.0 - self.relative_arm())
    }
}

/// Euler's beta function for arguments above zero, through the logarithm of Γ.
fn beta(a: f64, b: f64) -> f64 {
    libm::exp(libm::lgamma(a) + libm::lgamma(b) - libm::lgamma(a + b))
}

/// The derived functions, but for the exponent that is checked on reading.
#[cfg(feature = "serde")]
impl serde::Serialize for PressureDistribution {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Self::serialize(self, serializer)
    }
}

#[cfg(feature = "serde")]
impl<'de> serde::Deserialize<'de> for PressureDistribution {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Self::deserialize(deserializer)?.checked().map_err(serde::de::Error::custom)
    }
}

#[cfg(test)]
mod tests {
    use super::PressureDistribution;

    #[test]
    fn arms_match_the_closed_forms() {
        // The values of `docs/theory/friction.md#pressure-distributions`, good to 1e-6 (its number of
        // digits).
        for (k, arm) in [(1.5, 0.558_221), (3.0, 0.620_245), (4.0, 0.635_410), (8.0, 0.655_785)] {
            assert!((PressureDistribution::PowerLaw(k).relative_arm() - arm).abs() < 1e-6);
        }
        let hertz = PressureDistribution::PowerLaw(2.0);
        assert!((hertz.relative_arm() - PressureDistribution::Hertz.relative_arm()).abs() < 1e-14);
        for x in [0.0, 0.3, 0.9, 1.0] {
            assert!((hertz.relative(x) - PressureDistribution::Hertz.relative(x)).abs() < 1e-14);
        }
        assert!((PressureDistribution::PowerLaw(100.0).relative_arm() - 2.0 / 3.0).abs() < 1e-3);
    }

    #[test]
    fn pressure_adds_up_to_the_normal_force() {
        // Mid-point rule in x², which removes the square root's edge to second order.
        let count = 200_000;
        for pressure in [
            PressureDistribution::Uniform,
            PressureDistribution::Hertz,
            PressureDistribution::PowerLaw(1.5),
            PressureDistribution::PowerLaw(4.0),
            PressureDistribution::Winkler,
        ] {
            let (mut force, mut torque) = (0.0, 0.0);
            for index in 0..count {
                let x = ((f64::from(index) + 0.5) / f64::from(count)).sqrt();
                force += pressure.relative(x) / f64::from(count);
                torque += pressure.relative(x) * x / f64::from(count);
            }
            assert!((force - 1.0).abs() < 1e-6, "{pressure:?} {force}");
            assert!((torque - pressure.relative_arm()).abs() < 1e-6, "{pressure:?} {torque}");
        }
    }

    #[test]
    fn bad_exponents_are_refused() {
        for bad in [f64::NAN, 0.0, 1.0, -2.0, f64::INFINITY] {
            assert!(PressureDistribution::PowerLaw(bad).checked().is_err());
        }
        assert_eq!(PressureDistribution::Hertz.relative(f64::NAN), 0.0);
        assert_eq!(PressureDistribution::Hertz.relative(1.5), 0.0);
    }
}
