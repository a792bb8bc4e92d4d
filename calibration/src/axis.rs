//! The six components of a wrench, by name.

use core::fmt;

use fingertip_wrench::units::{ForceUnit, TorqueUnit};
use serde::{Deserialize, Serialize};

/// One component of a wrench.
///
/// ```
/// use fingertip_calibration::Axis;
///
/// let axis = Axis::from_name("Mz").ok_or("unknown")?;
/// assert_eq!((axis, axis.name(), axis.unit(), axis.index()), (Axis::Tz, "tz", "N·m", 5));
/// assert_eq!(Axis::Tz.unit_size("Nmm"), Some(1e-3));
/// assert_eq!(Axis::ALL.iter().filter(|axis| axis.is_torque()).count(), 3);
/// # Ok::<(), &str>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Axis {
    /// Force along x \[N\].
    Fx,
    /// Force along y \[N\].
    Fy,
    /// Force along z \[N\].
    Fz,
    /// Torque about x \[N·m\].
    Tx,
    /// Torque about y \[N·m\].
    Ty,
    /// Torque about z \[N·m\].
    Tz,
}

impl Axis {
    /// Fx, Fy, Fz, Tx, Ty, Tz.
    pub const ALL: [Self; 6] = [Self::Fx, Self::Fy, Self::Fz, Self::Tx, Self::Ty, Self::Tz];
    /// Fx, Fy, Fz: what a load cell of three components measures.
    pub const FORCES: [Self; 3] = [Self::Fx, Self::Fy, Self::Fz];

    /// Position in the order Fx, Fy, Fz, Tx, Ty, Tz.
    #[must_use]
    pub const fn index(self) -> usize {
        self as usize
    }

    /// `true` for Tx, Ty, Tz.
    #[must_use]
    pub const fn is_torque(self) -> bool {
        self.index() >= 3
    }

    /// `"N"` or `"N·m"`.
    #[must_use]
    pub const fn unit(self) -> &'static str {
        if self.is_torque() { "N·m" } else { "N" }
    }

    /// The size in SI of the unit called so, if it is one of this axis: see [`crate::units`].
    #[must_use]
    pub fn unit_size(self, name: &str) -> Option<f64> {
        if self.is_torque() {
            TorqueUnit::from_name(name).map(TorqueUnit::in_newton_metres)
        } else {
            ForceUnit::from_name(name).map(ForceUnit::in_newtons)
        }
    }

    /// The name as it stands in files and headers: `"fx"` … `"tz"`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Fx => "fx",
            Self::Fy => "fy",
            Self::Fz => "fz",
            Self::Tx => "tx",
            Self::Ty => "ty",
            Self::Tz => "tz",
        }
    }

    /// The axis called so, in any case; `mx`, `my`, `mz` are read as torques too.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        match name.to_ascii_lowercase().as_str() {
            "fx" => Some(Self::Fx),
            "fy" => Some(Self::Fy),
            "fz" => Some(Self::Fz),
            "tx" | "mx" => Some(Self::Tx),
            "ty" | "my" => Some(Self::Ty),
            "tz" | "mz" => Some(Self::Tz),
            _ => None,
        }
    }
}

impl fmt::Display for Axis {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(match self {
            Self::Fx => "Fx",
            Self::Fy => "Fy",
            Self::Fz => "Fz",
            Self::Tx => "Tx",
            Self::Ty => "Ty",
            Self::Tz => "Tz",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::Axis;

    #[test]
    fn names_round_trip() {
        for (index, axis) in Axis::ALL.into_iter().enumerate() {
            assert_eq!(axis.index(), index);
            assert_eq!(Axis::from_name(axis.name()), Some(axis));
            assert_eq!(Axis::from_name(&axis.to_string()), Some(axis));
        }
        assert_eq!(Axis::from_name("mz"), Some(Axis::Tz));
        assert_eq!(Axis::from_name("q"), None);
    }
}
