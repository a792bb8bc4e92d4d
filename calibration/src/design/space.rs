//! What an optimiser may change.

use nalgebra::Vector6;

use super::DesignError;

/// What a parameter is measured in.
///
/// ```
/// use fingertip_calibration::design::{Parameter, ParameterUnit};
///
/// let angle = Parameter::angle("Q", 0.0, 1.0);
/// assert_eq!(angle.unit, ParameterUnit::Radian);
/// // What is kept in radians and metres is printed in degrees and millimetres.
/// assert_eq!(angle.display_unit(), "°");
/// assert!((Parameter::length("R", 1e-3, 9e-3).display(5e-3) - 5.0).abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ParameterUnit {
    /// A length \[m\].
    Metre,
    /// An angle \[rad\].
    Radian,
    /// A ratio.
    Ratio,
}

/// One quantity that the optimiser may change.
///
/// ```
/// use fingertip_calibration::design::Parameter;
///
/// // A radius of 2 mm to 15 mm: what is beyond is brought back.
/// let radius = Parameter::length("R", 2e-3, 15e-3);
/// assert_eq!(radius.admissible(0.02), 15e-3);
/// assert!((radius.span() - 13e-3).abs() < 1e-15);
/// // An angle around the tube begins anew.
/// let around = Parameter::periodic_angle("theta", core::f64::consts::TAU);
/// assert!((around.admissible(7.0) - (7.0 - core::f64::consts::TAU)).abs() < 1e-12);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Its name, for tables and plots.
    pub name: String,
    /// Its unit.
    pub unit: ParameterUnit,
    /// Its least value.
    pub lower: f64,
    /// Its greatest value.
    pub upper: f64,
    /// How well it can be made: the step over which sensitivities are taken.
    pub tolerance: f64,
    /// `true` for an angle whose bounds are the same place.
    pub periodic: bool,
}

impl Parameter {
    /// A length \[m\], made to 0.05 mm.
    #[must_use]
    pub fn length(name: &str, lower: f64, upper: f64) -> Self {
        let unit = ParameterUnit::Metre;
        Self { name: name.to_owned(), unit, lower, upper, tolerance: 0.05e-3, periodic: false }
    }

    /// An angle \[rad\], made to 0.5°.
    #[must_use]
    pub fn angle(name: &str, lower: f64, upper: f64) -> Self {
        let (unit, tolerance) = (ParameterUnit::Radian, 0.5_f64.to_radians());
        Self { name: name.to_owned(), unit, lower, upper, tolerance, periodic: false }
    }

    /// An angle \[rad\] with a period, made to 0.5°; it starts from 0.
    #[must_use]
    pub fn periodic_angle(name: &str, period: f64) -> Self {
        Self { periodic: true, ..Self::angle(name, 0.0, period) }
    }

    /// Greatest minus least value.
    #[must_use]
    pub fn span(&self) -> f64 {
        self.upper - self.lower
    }

    /// # Errors
    /// [`DesignError::BadParameter`] unless the range is finite and not empty, and the tolerance
    /// positive.
    pub fn validate(&self) -> Result<(), DesignError> {
        let range = self.lower < self.upper && self.lower.is_finite() && self.upper.is_finite();
        if range && self.tolerance > 0.0 && self.tolerance.is_finite() {
            Ok(())
        } else {
            let (name, lower, upper) = (self.name.clone(), self.lower, self.upper);
            Err(DesignError::BadParameter { name, lower, upper })
        }
    }

    /// The value within the range: clamped, or brought back by periods. NaN gives the lower bound.
    #[must_use]
    pub fn admissible(&self, value: f64) -> f64 {
        if !value.is_finite() {
            self.lower
        } else if self.periodic {
            self.lower + (value - self.lower).rem_euclid(self.span())
        } else {
            value.clamp(self.lower, self.upper)
        }
    }

    /// The value as it is printed: millimetres, degrees, or the ratio.
    #[must_use]
    pub fn display(&self, value: f64) -> f64 {
        match self.unit {
            ParameterUnit::Metre => value * 1e3,
            ParameterUnit::Radian => value.to_degrees(),
            ParameterUnit::Ratio => value,
        }
    }

    /// The unit of [`display`](Self::display): `"mm"`, `"°"` or nothing.
    #[must_use]
    pub const fn display_unit(&self) -> &'static str {
        match self.unit {
            ParameterUnit::Metre => "mm",
            ParameterUnit::Radian => "°",
            ParameterUnit::Ratio => "",
        }
    }
}

/// A family of sensors with continuous parameters.
///
/// Implementors give the response as a function of the parameters, smooth within their bounds.
/// Symmetries and other constraints belong into the function: parameters that are not free are no
/// parameters.
///
/// ```
/// use fingertip_calibration::design::{Criterion, DesignError, DesignSpace, NominalLoads, Parameter, Search, search};
/// use fingertip_calibration::nalgebra::{Matrix6, Vector6};
///
/// /// Six gauges, one for each axis, of which the first has an arm that can be chosen \[m\].
/// struct Arm([Parameter; 1]);
///
/// impl DesignSpace for Arm {
///     fn parameters(&self) -> &[Parameter] {
///         &self.0
///     }
///
///     fn channels(&self) -> usize {
///         6
///     }
///
///     fn response(&self, values: &[f64], rows: &mut [Vector6<f64>]) -> Result<(), DesignError> {
///         for (i, row) in rows.iter_mut().enumerate() {
///             *row = Matrix6::identity().column(i) * if i == 0 { 100.0 * values[0] } else { 1.0 };
///         }
///         Ok(())
///     }
/// }
///
/// // It shall give as much as the others: 10 mm.
/// let space = Arm([Parameter::length("arm", 2e-3, 30e-3)]);
/// let (loads, how) = (NominalLoads::equal(1.0, 1.0)?, Search { starts: 4, ..Search::default() });
/// let found = search(&space, &Criterion::ConditionNumber, &loads, &how, &|_| ())?;
/// assert!((found.best().ok_or("none")?.values[0] - 0.01).abs() < 1e-5);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is no family of gauge layouts",
    note = "implement `DesignSpace`: `parameters`, `channels` and `response`"
)]
pub trait DesignSpace: Sync {
    /// The parameters and their bounds.
    fn parameters(&self) -> &[Parameter];

    /// How many signals a sensor of this family has: six or more.
    fn channels(&self) -> usize;

    /// Writes the signal (strain) of each channel per newton and newton metre. Both slices have the
    /// lengths that the two other methods say; values lie within the bounds.
    ///
    /// # Errors
    /// [`DesignError`] where no such sensor can be built; the optimiser then stays away.
    fn response(&self, values: &[f64], rows: &mut [Vector6<f64>]) -> Result<(), DesignError>;
}

/// Checks a space before it is used.
pub(super) fn validate(space: &dyn DesignSpace) -> Result<(), DesignError> {
    for parameter in space.parameters() {
        parameter.validate()?;
    }
    if space.channels() < 6 {
        return Err(DesignError::WrongCount { what: "channels", found: space.channels(), expected: 6 });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::Parameter;

    #[test]
    fn admissible_values_are_within_the_bounds() {
        let length = Parameter::length("d", 1.0, 2.0);
        let angle = Parameter::periodic_angle("theta", 3.0);
        for value in [-1e300, -4.0, 0.0, 1.5, 2.0, 7.5, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for parameter in [&length, &angle] {
                let value = parameter.admissible(value);
                assert!((parameter.lower..=parameter.upper).contains(&value), "{value}");
            }
        }
        assert_eq!(length.admissible(1.5), 1.5);
        assert!((angle.admissible(7.5) - 1.5).abs() < 1e-15);
        let from_one = Parameter { lower: 1.0, upper: 4.0, ..angle };
        for (value, expected) in [(0.5, 3.5), (1.0, 1.0), (3.9, 3.9), (4.5, 1.5), (-2.25, 3.75)] {
            assert!((from_one.admissible(value) - expected).abs() < 1e-15, "{value}");
        }
        assert!(Parameter::length("d", 2.0, 2.0).validate().is_err());
        assert!(Parameter::angle("q", 0.0, f64::NAN).validate().is_err());
    }
}
