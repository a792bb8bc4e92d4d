//! Units by their names in a header. Those of force and torque are [`fingertip_wrench::units`].

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
