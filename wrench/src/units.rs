//! Units of force, torque and length, by the names that files give them.
//!
//! Everything in this library is SI; other units exist only in files and on wires, and are converted
//! where these are read.
//!
//! ```
//! use fingertip_wrench::units::{ForceUnit, TorqueUnit};
//!
//! assert_eq!(TorqueUnit::from_name("N-mm").map(TorqueUnit::in_newton_metres), Some(1e-3));
//! assert_eq!(ForceUnit::from_name("lbf"), Some(ForceUnit::PoundForce));
//! assert_eq!(ForceUnit::from_name("parsec"), None);
//! ```

/// Standard gravity \[m/s²\], by which a gram-force and a pound-force are defined.
pub const STANDARD_GRAVITY: f64 = 9.806_65;

/// One pound-force in newtons: 0.45359237 kg times standard gravity, exactly.
pub const POUND_FORCE: f64 = 4.448_221_615_260_5;

/// One inch in metres, exactly.
pub const INCH: f64 = 0.025_4;

/// One foot in metres, exactly.
pub const FOOT: f64 = 0.304_8;

/// A unit of force.
///
/// ```
/// use fingertip_wrench::units::ForceUnit;
///
/// // 2 lbf, as a sensor of American make reports it.
/// let unit = ForceUnit::from_name("lbf").unwrap();
/// assert_eq!(2.0 * unit.in_newtons(), 8.896_443_230_521);
/// assert_eq!(ForceUnit::GramForce.in_newtons(), 9.806_65e-3);
/// ```
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
    /// klbf, a thousand pound-force.
    KilopoundForce,
    /// ozf, a sixteenth of a pound-force.
    OunceForce,
    /// gf, 9.80665 mN exactly.
    GramForce,
    /// kgf, 9.80665 N exactly.
    KilogramForce,
}

/// A unit of torque.
///
/// ```
/// use fingertip_wrench::units::TorqueUnit;
///
/// assert_eq!(TorqueUnit::from_name("in-lb"), Some(TorqueUnit::PoundForceInch));
/// assert_eq!(TorqueUnit::from_name("mN·m").map(TorqueUnit::in_newton_metres), Some(1e-3));
/// // A foot has twelve inches.
/// let (inch, foot) = (TorqueUnit::PoundForceInch, TorqueUnit::PoundForceFoot);
/// assert!((foot.in_newton_metres() / inch.in_newton_metres() - 12.0).abs() < 1e-14);
/// ```
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

/// A unit of length.
///
/// ```
/// use fingertip_wrench::units::LengthUnit;
///
/// let unit = LengthUnit::from_name("mm").unwrap();
/// assert_eq!(12.5 * unit.in_metres(), 0.0125);
/// assert_eq!(LengthUnit::from_name("inch"), Some(LengthUnit::Inch));
/// assert_eq!(LengthUnit::from_name("furlong"), None);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum LengthUnit {
    /// m.
    Metre,
    /// cm.
    Centimetre,
    /// mm.
    Millimetre,
    /// in, 25.4 mm exactly.
    Inch,
    /// ft, 12 in.
    Foot,
}

/// Names, in lower case and without what joins their parts.
const FORCES: [(&str, ForceUnit); 15] = [
    ("n", ForceUnit::Newton),
    ("newton", ForceUnit::Newton),
    ("newtons", ForceUnit::Newton),
    ("mn", ForceUnit::Millinewton),
    ("kn", ForceUnit::Kilonewton),
    ("lbf", ForceUnit::PoundForce),
    ("lb", ForceUnit::PoundForce),
    ("lbs", ForceUnit::PoundForce),
    ("klbf", ForceUnit::KilopoundForce),
    ("ozf", ForceUnit::OunceForce),
    ("oz", ForceUnit::OunceForce),
    ("gf", ForceUnit::GramForce),
    ("gramforce", ForceUnit::GramForce),
    ("kgf", ForceUnit::KilogramForce),
    ("kp", ForceUnit::KilogramForce),
];

const TORQUES: [(&str, TorqueUnit); 23] = [
    ("nm", TorqueUnit::NewtonMetre),
    ("nmm", TorqueUnit::NewtonMillimetre),
    ("mnm", TorqueUnit::MillinewtonMetre),
    ("ncm", TorqueUnit::NewtonCentimetre),
    ("knm", TorqueUnit::KilonewtonMetre),
    ("lbfin", TorqueUnit::PoundForceInch),
    ("lbin", TorqueUnit::PoundForceInch),
    ("inlb", TorqueUnit::PoundForceInch),
    ("inlbf", TorqueUnit::PoundForceInch),
    ("lbfft", TorqueUnit::PoundForceFoot),
    ("lbft", TorqueUnit::PoundForceFoot),
    ("ftlb", TorqueUnit::PoundForceFoot),
    ("ftlbf", TorqueUnit::PoundForceFoot),
    ("ozfin", TorqueUnit::OunceForceInch),
    ("ozin", TorqueUnit::OunceForceInch),
    ("inoz", TorqueUnit::OunceForceInch),
    ("inozf", TorqueUnit::OunceForceInch),
    ("kgfm", TorqueUnit::KilogramForceMetre),
    ("kgm", TorqueUnit::KilogramForceMetre),
    ("kgfcm", TorqueUnit::KilogramForceCentimetre),
    ("kgcm", TorqueUnit::KilogramForceCentimetre),
    ("gfcm", TorqueUnit::GramForceCentimetre),
    ("gcm", TorqueUnit::GramForceCentimetre),
];

const LENGTHS: [(&str, LengthUnit); 6] = [
    ("m", LengthUnit::Metre),
    ("cm", LengthUnit::Centimetre),
    ("mm", LengthUnit::Millimetre),
    ("in", LengthUnit::Inch),
    ("inch", LengthUnit::Inch),
    ("ft", LengthUnit::Foot),
];

/// The unit of that name, whatever its case and whichever sign joins its parts. A leading capital `M`
/// is mega, which nobody measures fingertips in: it is not taken for milli.
fn find<U: Copy>(names: &[(&str, U)], name: &str) -> Option<U> {
    let joins = |c: &char| !matches!(c, '-' | '·' | '⋅' | '*' | '.' | ' ');
    let plain = || name.chars().filter(joins).flat_map(char::to_lowercase);
    let mega = name.starts_with('M') && name.chars().any(char::is_lowercase) || name == "MN";
    if mega { None } else { names.iter().find(|(known, _)| plain().eq(known.chars())).map(|(_, unit)| *unit) }
}

impl ForceUnit {
    /// One of this unit in newtons.
    #[must_use]
    pub const fn in_newtons(self) -> f64 {
        match self {
            Self::Newton => 1.0,
            Self::Millinewton => 1e-3,
            Self::Kilonewton => 1e3,
            Self::PoundForce => POUND_FORCE,
            Self::KilopoundForce => POUND_FORCE * 1e3,
            Self::OunceForce => POUND_FORCE / 16.0,
            Self::GramForce => STANDARD_GRAVITY * 1e-3,
            Self::KilogramForce => STANDARD_GRAVITY,
        }
    }

    /// The unit by its name, whatever its case: `N`, `lbf`, `gf` …; `None` if it is not known.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        find(&FORCES, name)
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
            Self::PoundForceInch => POUND_FORCE * INCH,
            Self::PoundForceFoot => POUND_FORCE * FOOT,
            Self::OunceForceInch => POUND_FORCE / 16.0 * INCH,
            Self::KilogramForceMetre => STANDARD_GRAVITY,
            Self::KilogramForceCentimetre => STANDARD_GRAVITY * 1e-2,
            Self::GramForceCentimetre => STANDARD_GRAVITY * 1e-5,
        }
    }

    /// The unit by its name, whatever its case and whichever sign joins its parts: `Nm`, `N-mm`,
    /// `lbf-in`, `in-lb` …; `None` if it is not known.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        find(&TORQUES, name)
    }
}

impl LengthUnit {
    /// One of this unit in metres.
    #[must_use]
    pub const fn in_metres(self) -> f64 {
        match self {
            Self::Metre => 1.0,
            Self::Centimetre => 1e-2,
            Self::Millimetre => 1e-3,
            Self::Inch => INCH,
            Self::Foot => FOOT,
        }
    }

    /// The unit by its name, whatever its case: `m`, `mm`, `in` …; `None` if it is not known.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        find(&LENGTHS, name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_agree_with_their_definitions() {
        assert!((POUND_FORCE - 0.453_592_37 * STANDARD_GRAVITY).abs() < 1e-15);
        let inch = TorqueUnit::PoundForceInch.in_newton_metres();
        assert!((inch - 0.112_984_829_027_616_7).abs() < 1e-16);
        let foot = TorqueUnit::from_name("lbf-ft").map(TorqueUnit::in_newton_metres);
        assert!((foot.unwrap_or(0.0) / inch - 12.0).abs() < 1e-14);
        assert_eq!(LengthUnit::Foot.in_metres(), 0.304_8);
    }

    /// From the definitions of the pound (0.45359237 kg), the inch (25.4 mm) and standard gravity.
    #[test]
    fn every_unit_has_its_size() {
        for (name, newtons) in [
            ("N", 1.0),
            ("mN", 0.001),
            ("kN", 1000.0),
            ("lbf", 4.448_221_615_260_5),
            ("klbf", 4_448.221_615_260_5),
            ("ozf", 0.278_013_850_953_781_3),
            ("gf", 0.009_806_65),
            ("kgf", 9.806_65),
        ] {
            let found = ForceUnit::from_name(name).map(ForceUnit::in_newtons).unwrap_or(0.0);
            assert!((found / newtons - 1.0).abs() < 4.0 * f64::EPSILON, "{name}: {found}");
        }
        for (name, newton_metres) in [
            ("Nm", 1.0),
            ("Nmm", 0.001),
            ("mNm", 0.001),
            ("Ncm", 0.01),
            ("kNm", 1000.0),
            ("lbf-in", 0.112_984_829_027_616_7),
            ("lbf-ft", 1.355_817_948_331_400_4),
            ("ozf-in", 0.007_061_551_814_226_044),
            ("kgf-m", 9.806_65),
            ("kgf-cm", 0.098_066_5),
            ("gf-cm", 0.000_098_066_5),
        ] {
            let found = TorqueUnit::from_name(name).map(TorqueUnit::in_newton_metres).unwrap_or(0.0);
            assert!((found / newton_metres - 1.0).abs() < 4.0 * f64::EPSILON, "{name}: {found}");
        }
        for (name, metres) in [("m", 1.0), ("cm", 0.01), ("mm", 0.001), ("in", 0.0254), ("ft", 0.3048)] {
            let found = LengthUnit::from_name(name).map(LengthUnit::in_metres).unwrap_or(0.0);
            assert!((found / metres - 1.0).abs() < 4.0 * f64::EPSILON, "{name}: {found}");
        }
    }

    #[test]
    fn no_name_stands_twice_and_each_is_found() {
        for (i, (name, unit)) in FORCES.iter().enumerate() {
            assert_eq!(ForceUnit::from_name(name), Some(*unit));
            assert!(FORCES[..i].iter().all(|(other, _)| other != name));
        }
        for (i, (name, unit)) in TORQUES.iter().enumerate() {
            assert_eq!(TorqueUnit::from_name(name), Some(*unit));
            assert!(TORQUES[..i].iter().all(|(other, _)| other != name));
        }
    }

    #[test]
    fn case_and_joins_do_not_matter_but_mega_is_not_milli() {
        for name in ["N-mm", "N·mm", "n.mm", "NMM", "N mm"] {
            assert_eq!(TorqueUnit::from_name(name), Some(TorqueUnit::NewtonMillimetre), "{name}");
        }
        assert_eq!(ForceUnit::from_name("mN"), Some(ForceUnit::Millinewton));
        assert_eq!((ForceUnit::from_name("MN"), TorqueUnit::from_name("MNm")), (None, None));
        assert_eq!(TorqueUnit::from_name("mNm"), Some(TorqueUnit::MillinewtonMetre));
        assert_eq!(TorqueUnit::from_name("MNM"), Some(TorqueUnit::MillinewtonMetre));
        assert_eq!(LengthUnit::from_name("MM"), Some(LengthUnit::Millimetre));
        assert_eq!((ForceUnit::from_name(""), ForceUnit::from_name("Nm")), (None, None));
    }
}
