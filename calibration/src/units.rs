//! Units of force, torque, length and signal that files name, and their size in SI.

/// Standard gravity \[m/s²\]: what a gram-force or a pound-force is defined by.
pub const STANDARD_GRAVITY: f64 = 9.806_65;

/// One pound-force in newtons (exact: 0.45359237 kg times standard gravity).
pub const POUND_FORCE: f64 = 0.453_592_37 * STANDARD_GRAVITY;

/// One inch in metres (exact).
pub const INCH: f64 = 0.0254;

/// What a quantity is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Force; SI unit newton.
    Force,
    /// Torque; SI unit newton metre.
    Torque,
    /// Length; SI unit metre.
    Length,
}

/// The names of a unit, the first being ours, and its size in the SI unit.
struct Unit {
    names: &'static [&'static str],
    quantity: Quantity,
    size: f64,
}

const UNITS: [Unit; 20] = [
    Unit { names: &["N"], quantity: Quantity::Force, size: 1.0 },
    Unit { names: &["mN"], quantity: Quantity::Force, size: 1e-3 },
    Unit { names: &["kN"], quantity: Quantity::Force, size: 1e3 },
    Unit { names: &["gf"], quantity: Quantity::Force, size: 1e-3 * STANDARD_GRAVITY },
    Unit { names: &["kgf", "kp"], quantity: Quantity::Force, size: STANDARD_GRAVITY },
    Unit { names: &["lbf", "lb"], quantity: Quantity::Force, size: POUND_FORCE },
    Unit { names: &["klbf"], quantity: Quantity::Force, size: 1e3 * POUND_FORCE },
    Unit { names: &["Nm", "N-m", "N·m"], quantity: Quantity::Torque, size: 1.0 },
    Unit { names: &["Nmm", "N-mm", "mNm", "N·mm"], quantity: Quantity::Torque, size: 1e-3 },
    Unit { names: &["Ncm", "N-cm"], quantity: Quantity::Torque, size: 1e-2 },
    Unit { names: &["kNm", "kN-m"], quantity: Quantity::Torque, size: 1e3 },
    Unit { names: &["kgfm", "kg-m", "kgf-m"], quantity: Quantity::Torque, size: STANDARD_GRAVITY },
    Unit { names: &["kgfcm", "kg-cm", "kgf-cm"], quantity: Quantity::Torque, size: 1e-2 * STANDARD_GRAVITY },
    Unit { names: &["lbfin", "lbf-in", "in-lb"], quantity: Quantity::Torque, size: POUND_FORCE * INCH },
    Unit {
        names: &["lbfft", "lbf-ft", "ft-lb"],
        quantity: Quantity::Torque,
        size: POUND_FORCE * 12.0 * INCH,
    },
    Unit { names: &["m"], quantity: Quantity::Length, size: 1.0 },
    Unit { names: &["mm"], quantity: Quantity::Length, size: 1e-3 },
    Unit { names: &["cm"], quantity: Quantity::Length, size: 1e-2 },
    Unit { names: &["in", "inch"], quantity: Quantity::Length, size: INCH },
    Unit { names: &["ft"], quantity: Quantity::Length, size: 12.0 * INCH },
];

/// The size of a unit in SI (newton, newton metre, metre), or `None` if the name is not that of a
/// unit of the quantity. Upper and lower case are told apart (`mN` is not `MN`).
///
/// ```
/// use fingertip_calibration::units::{Quantity, si};
///
/// assert_eq!(si(Quantity::Torque, "N-mm"), Some(1e-3));
/// assert_eq!(si(Quantity::Force, "parsec"), None);
/// ```
#[must_use]
pub fn si(quantity: Quantity, name: &str) -> Option<f64> {
    UNITS.iter().find(|unit| unit.quantity == quantity && unit.names.contains(&name)).map(|unit| unit.size)
}

#[cfg(test)]
mod tests {
    use super::{Quantity, UNITS, si};

    #[test]
    fn sizes_agree_with_their_definitions() {
        let pound = si(Quantity::Force, "lbf").unwrap();
        assert!((pound - 4.448_221_615_260_5).abs() < 1e-15);
        let pound_inch = si(Quantity::Torque, "lbf-in").unwrap();
        assert!((pound_inch - 0.112_984_829_027_616_7).abs() < 1e-16);
        assert_eq!(si(Quantity::Torque, "N"), None);
    }

    #[test]
    fn no_name_stands_twice() {
        let mut names: Vec<_> =
            UNITS.iter().flat_map(|u| u.names.iter().map(move |n| (u.quantity as u8, *n))).collect();
        let count = names.len();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), count);
    }
}
