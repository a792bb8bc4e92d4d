//! What an optimiser may change.

use nalgebra::Vector6;

use super::DesignError;

/// What a parameter is measured in.
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
