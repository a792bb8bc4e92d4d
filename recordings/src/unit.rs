//! Units by their names in a header. Those of force and torque are [`fingertip_wrench::units`].

use fingertip_wrench::units::{ForceUnit, STANDARD_GRAVITY, TorqueUnit};

/// What the numbers of a signal are, in recordings, tables of loads and calibrations.
///
/// ```
/// use fingertip_recordings::SignalUnit;
///
/// assert_eq!(SignalUnit::from_name("mV"), Some((SignalUnit::Volt, 1e-3)));
/// assert_eq!(SignalUnit::from_name("mV/V"), Some((SignalUnit::MillivoltPerVolt, 1.0)));
/// assert_eq!(SignalUnit::from_name("furlong"), None);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum SignalUnit {
    /// Volts; mV and µV in a file are converted.
    #[cfg_attr(feature = "serde", serde(rename = "V"))]
    Volt,
    /// Millivolts per volt of bridge supply.
    #[cfg_attr(feature = "serde", serde(rename = "mV/V"))]
    MillivoltPerVolt,
    /// Counts of a converter.
    #[cfg_attr(feature = "serde", serde(rename = "count"))]
    Count,
    /// Strain, as a ratio.
    #[cfg_attr(feature = "serde", serde(rename = "strain"))]
    Strain,
    /// The readings are newtons and newton metres already, of a sensor that is to be mended.
    #[cfg_attr(feature = "serde", serde(rename = "N, N·m"))]
    Wrench,
    /// The header does not say: the numbers are taken as they are. No calibration is in it.
    #[default]
    #[cfg_attr(feature = "serde", serde(skip))]
    Unstated,
}

impl SignalUnit {
    /// The unit by its name in a header, whatever its case, and what one of it is in the unit that is given.
    #[must_use]
    pub fn from_name(name: &str) -> Option<(Self, f64)> {
        let of_wrench = || {
            let force = ForceUnit::from_name(name).map(ForceUnit::in_newtons);
            force.or_else(|| TorqueUnit::from_name(name).map(TorqueUnit::in_newton_metres))
        };
        Some(match plain(name).as_str() {
            "v" | "volt" | "volts" => (Self::Volt, 1.0),
            "mv" => (Self::Volt, 1e-3),
            "uv" | "µv" | "μv" => (Self::Volt, 1e-6),
            "mv/v" | "mvpv" | "mvv" => (Self::MillivoltPerVolt, 1.0),
            "count" | "counts" | "raw" | "lsb" | "adc" => (Self::Count, 1.0),
            "strain" => (Self::Strain, 1.0),
            _ => (Self::Wrench, of_wrench()?),
        })
    }

    /// Its name in a header and in a message; nothing for what is not stated.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Volt => "V",
            Self::MillivoltPerVolt => "mVpV",
            Self::Count => "counts",
            Self::Strain => "strain",
            Self::Wrench => "N",
            Self::Unstated => "",
        }
    }

    /// How a header says it, with what parts it from the name.
    pub(super) const fn suffix(self) -> &'static str {
        match self {
            Self::Volt => "_V",
            Self::MillivoltPerVolt => "_mVpV",
            Self::Count => "_counts",
            Self::Strain => "_strain",
            Self::Wrench => "_N",
            Self::Unstated => "",
        }
    }
}

/// One of a unit of time in seconds.
pub(super) fn seconds(name: &str) -> Option<f64> {
    Some(match plain(name).as_str() {
        "s" | "sec" | "second" | "seconds" => 1.0,
        "ms" => 1e-3,
        "us" | "µs" | "μs" => 1e-6,
        "ns" => 1e-9,
        "min" => 60.0,
        _ => return None,
    })
}

/// One of a unit of acceleration in m/s²: `m/s2`, `mm/s2`, `g` (of weight, 9.80665 m/s²).
#[must_use]
pub fn acceleration_unit(name: &str) -> Option<f64> {
    Some(match plain(name).replace('^', "").as_str() {
        "m/s2" | "m/s²" | "m/s/s" => 1.0,
        "mm/s2" | "mm/s²" => 1e-3,
        "g" => STANDARD_GRAVITY,
        "mg" => 1e-3 * STANDARD_GRAVITY,
        _ => return None,
    })
}

/// One of a unit of angular velocity in rad/s: `rad/s`, `deg/s`, `dps`.
#[must_use]
pub fn turning_unit(name: &str) -> Option<f64> {
    Some(match plain(name).as_str() {
        "rad/s" => 1.0,
        "mrad/s" => 1e-3,
        "deg/s" | "dps" | "°/s" => core::f64::consts::PI / 180.0,
        _ => return None,
    })
}

/// Lower case, without the signs that join the parts of a unit.
fn plain(name: &str) -> String {
    name.chars()
        .filter(|c| !matches!(c, '-' | '·' | '*' | '.' | ' ' | '⋅'))
        .flat_map(char::to_lowercase)
        .collect()
}
