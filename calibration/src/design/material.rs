//! What a sensor's structure is made of.

use serde::{Deserialize, Serialize};

use super::DesignError;

/// Elastic constants and the stress that a material bears.
///
/// The constants given here are typical handbook values at room temperature, good for a first
/// design; those of the batch stand in its certificate.
///
/// ```
/// use fingertip_calibration::design::Material;
///
/// let aluminium = Material::from_name("aluminium-7075-t6").ok_or("unknown")?;
/// assert_eq!(aluminium, Material::ALUMINIUM_7075_T6);
/// // E/(2(1 + ν)): 71.7 GPa over 2.66.
/// assert!((aluminium.shear_modulus() - 26.95e9).abs() < 0.01e9);
/// # Ok::<(), &str>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Young's modulus E \[Pa\].
    #[serde(rename = "youngs_modulus_Pa")]
    pub youngs_modulus: f64,
    /// Poisson's ratio μ.
    pub poisson_ratio: f64,
    /// Stress at 0.2 % permanent strain \[Pa\].
    #[serde(rename = "yield_strength_Pa")]
    pub yield_strength: f64,
}

impl Material {
    /// Aluminium 7075-T6: the usual choice for small force sensors.
    pub const ALUMINIUM_7075_T6: Self = Self::new(71.7e9, 0.33, 503e6);
    /// Aluminium 6061-T6.
    pub const ALUMINIUM_6061_T6: Self = Self::new(68.9e9, 0.33, 276e6);
    /// Titanium Ti-6Al-4V, annealed.
    pub const TITANIUM_6AL_4V: Self = Self::new(113.8e9, 0.342, 880e6);
    /// Stainless steel 17-4 PH, condition H900: little hysteresis.
    pub const STEEL_17_4_PH: Self = Self::new(197e9, 0.272, 1170e6);

    /// From Young's modulus \[Pa\], Poisson's ratio and yield strength \[Pa\].
    #[must_use]
    pub const fn new(youngs_modulus: f64, poisson_ratio: f64, yield_strength: f64) -> Self {
        Self { youngs_modulus, poisson_ratio, yield_strength }
    }

    /// A material by the name that the command line and files use: `aluminium-7075-t6`,
    /// `aluminium-6061-t6`, `titanium-6al-4v`, `steel-17-4-ph`.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::NAMED.iter().find(|(known, _)| known.eq_ignore_ascii_case(name)).map(|(_, material)| *material)
    }

    /// All materials with a name.
    pub const NAMED: [(&'static str, Self); 4] = [
        ("aluminium-7075-t6", Self::ALUMINIUM_7075_T6),
        ("aluminium-6061-t6", Self::ALUMINIUM_6061_T6),
        ("titanium-6al-4v", Self::TITANIUM_6AL_4V),
        ("steel-17-4-ph", Self::STEEL_17_4_PH),
    ];

    /// Shear modulus `E/(2(1+μ))` \[Pa\] of an isotropic material.
    #[must_use]
    pub fn shear_modulus(&self) -> f64 {
        self.youngs_modulus / (2.0 * (1.0 + self.poisson_ratio))
    }

    /// # Errors
    /// [`DesignError::OutOfRange`] unless moduli are positive and finite and μ in (−1, 0.5].
    pub fn validate(&self) -> Result<(), DesignError> {
        DesignError::check_positive("Young's modulus", self.youngs_modulus)?;
        DesignError::check_positive("yield strength", self.yield_strength)?;
        if self.poisson_ratio > -1.0 && self.poisson_ratio <= 0.5 {
            Ok(())
        } else {
            Err(DesignError::OutOfRange {
                quantity: "Poisson's ratio",
                value: self.poisson_ratio,
                requirement: "above −1 and at most 0.5",
            })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Material;

    #[test]
    fn named_materials_are_valid_and_found() {
        for (name, material) in Material::NAMED {
            material.validate().unwrap();
            assert_eq!(Material::from_name(&name.to_uppercase()), Some(material));
            // Metals: G is 0.37 to 0.4 of E.
            let ratio = material.shear_modulus() / material.youngs_modulus;
            assert!((0.36..0.41).contains(&ratio));
        }
        assert_eq!(Material::from_name("cheese"), None);
    }

    #[test]
    fn refuses_what_no_material_is() {
        for bad in [
            Material::new(0.0, 0.3, 1e8),
            Material::new(f64::NAN, 0.3, 1e8),
            Material::new(1e9, 0.6, 1e8),
            Material::new(1e9, f64::NAN, 1e8),
            Material::new(1e9, 0.3, f64::INFINITY),
        ] {
            assert!(bad.validate().is_err());
        }
    }
}
