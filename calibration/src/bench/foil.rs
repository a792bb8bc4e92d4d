//! The foil gauges that are glued.

use crate::design::DesignError;

/// Dimensions and resistance of a foil gauge, as its data sheet has them: the grid that feels the strain, on a carrier
/// that is glued. Along is the direction that it feels.
///
/// ```
/// use fingertip_calibration::bench::Foil;
/// let foil = Foil { grid: [0.6e-3, 1.0e-3], ..Foil::default() };
/// assert!(foil.validate().is_ok());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Foil {
    /// The grid, along and across \[m\].
    pub grid: [f64; 2],
    /// The carrier, along and across \[m\]; the grid lies in its middle.
    pub carrier: [f64; 2],
    /// Resistance \[Ω\].
    pub resistance: f64,
}

impl Default for Foil {
    /// A small gauge of 350 Ω: 1.5 mm × 1.2 mm on a carrier of 4 mm × 2.5 mm.
    fn default() -> Self {
        Self { grid: [1.5e-3, 1.2e-3], carrier: [4e-3, 2.5e-3], resistance: 350.0 }
    }
}

impl Foil {
    /// # Errors
    /// [`DesignError::OutOfRange`] unless all are positive and finite and the grid is not larger than its carrier.
    pub fn validate(&self) -> Result<(), DesignError> {
        let positive = |quantity, value: f64| {
            if value > 0.0 && value.is_finite() {
                Ok(())
            } else {
                Err(DesignError::OutOfRange { quantity, value, requirement: "positive and finite" })
            }
        };
        positive("resistance of a gauge", self.resistance)?;
        for (grid, carrier) in self.grid.into_iter().zip(self.carrier) {
            positive("size of a gauge's grid", grid)?;
            positive("size of a gauge's carrier", carrier)?;
            if grid > carrier {
                let requirement = "at most that of its carrier";
                return Err(DesignError::OutOfRange {
                    quantity: "size of a gauge's grid",
                    value: grid,
                    requirement,
                });
            }
        }
        Ok(())
    }
}
