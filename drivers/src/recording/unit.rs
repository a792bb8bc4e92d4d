//! Units by their names in a header.

/// A unit of force.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ForceUnit {
    /// N.
    Newton,
    /// mN.
    Millinewton,
    /// kN.
    Kilonewton,
    /// lbf, 4.4482216152605 N exactly.
    PoundForce,
    /// ozf, a sixteenth of a pound-force.
    OunceForce,
    /// gf, 9.80665 mN exactly.
    GramForce,
    /// kgf, 9.80665 N exactly.
    KilogramForce,
}

/// A unit of torque.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum TorqueUnit {
    /// N·m.
    NewtonMetre,
    /// N·mm.
    NewtonMillimetre,
    /// mN·m, as large as N·mm.
    MillinewtonMetre,
    /// N·cm.
    NewtonCentimetre,
    /// kN·m.
    KilonewtonMetre,
    /// lbf·in.
    PoundForceInch,
    /// lbf·ft.
    PoundForceFoot,
    /// ozf·in.
    OunceForceInch,
    /// kgf·m.
    KilogramForceMetre,
    /// kgf·cm.
    KilogramForceCentimetre,
    /// gf·cm.
    GramForceCentimetre,
}

/// What the numbers of a signal are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum SignalUnit {
    /// Volts; mV and µV in a file are converted.
    Volts,
    /// Counts of a converter.
    Counts,
    /// The header does not say: the numbers are taken as they are.
    #[default]
    Unstated,
}

const POUND: f64 = 4.448_221_615_260_5;
const KILOGRAM: f64 = 9.806_65;
const INCH: f64 = 0.025_4;

impl ForceUnit {
    /// One of this unit in newtons.
    #[must_use]
    pub const fn in_newtons(self) -> f64 {
        match self {
            Self::Newton => 1.0,
            Self::Millinewton => 1e-3,
            Self::Kilonewton => 1e3,
            Self::PoundForce => POUND,
            Self::OunceForce => POUND / 16.0,
            Self::GramForce => KILOGRAM * 1e-3,
            Self::KilogramForce => KILOGRAM,
        }
    }

    /// The unit by its name, whatever its case: `N`, `lbf`, `gf` …
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Some(match plain(name).as_str() {
            "n" | "newton" | "newtons" => Self::Newton,
            "mn" => Self::Millinewton,
            "kn" => Self::Kilonewton,
            "lbf" | "lb" | "lbs" => Self::PoundForce,
            "ozf" | "oz" => Self::OunceForce,
            "gf" | "gramforce" => Self::GramForce,
            "kgf" | "kp" => Self::KilogramForce,
            _ => return None,
        })
    }
}

impl TorqueUnit {
    /// One of this unit in newton metres.
    #[must_use]
    pub const fn in_newton_metres(self) -> f64 {
        match self {
            Self::NewtonMetre => 1.0,
            Self::NewtonMillimetre | Self::MillinewtonMetre => 1e-3,
            Self::NewtonCentimetre => 1e-2,
            Self::KilonewtonMetre => 1e3,
            Self::PoundForceInch => POUND * INCH,
            Self::PoundForceFoot => POUND * INCH * 12.0,
            Self::OunceForceInch => POUND / 16.0 * INCH,
            Self::KilogramForceMetre => KILOGRAM,
            Self::KilogramForceCentimetre => KILOGRAM * 1e-2,
            Self::GramForceCentimetre => KILOGRAM * 1e-5,
        }
    }

    /// The unit by its name, whatever its case and whichever sign joins its parts: `Nm`, `N-mm`,
    /// `lbf-in`, `in-lb` …
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Some(match plain(name).as_str() {
            "nm" => Self::NewtonMetre,
            "nmm" => Self::NewtonMillimetre,
            "mnm" => Self::MillinewtonMetre,
            "ncm" => Self::NewtonCentimetre,
            "knm" => Self::KilonewtonMetre,
            "lbfin" | "lbin" | "inlb" | "inlbf" => Self::PoundForceInch,
            "lbfft" | "lbft" | "ftlb" | "ftlbf" => Self::PoundForceFoot,
            "ozfin" | "ozin" | "inoz" | "inozf" => Self::OunceForceInch,
            "kgfm" => Self::KilogramForceMetre,
            "kgfcm" => Self::KilogramForceCentimetre,
            "gfcm" => Self::GramForceCentimetre,
            _ => return None,
        })
    }
}

impl SignalUnit {
    /// The unit by its name, and what one of it is in volts or counts.
    pub(super) fn from_name(name: &str) -> Option<(Self, f64)> {
        Some(match plain(name).as_str() {
            "v" | "volt" | "volts" => (Self::Volts, 1.0),
            "mv" => (Self::Volts, 1e-3),
            "uv" | "µv" | "μv" => (Self::Volts, 1e-6),
            "count" | "counts" | "raw" | "lsb" | "adc" => (Self::Counts, 1.0),
            _ => return None,
        })
    }

    /// How a header says it, with what parts it from the name.
    pub(super) const fn suffix(self) -> &'static str {
        match self {
            Self::Volts => "_V",
            Self::Counts => "_counts",
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

/// Lower case, without the signs that join the parts of a unit.
fn plain(name: &str) -> String {
    name.chars()
        .filter(|c| !matches!(c, '-' | '·' | '*' | '.' | ' ' | '⋅'))
        .flat_map(char::to_lowercase)
        .collect()
}
