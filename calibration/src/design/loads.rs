//! The loads that a sensor is designed for.

use nalgebra::Vector6;
use serde::{Deserialize, Serialize};

use super::DesignError;

/// Nominal loads: the greatest force and torque of each axis, which normalise the sensor matrix.
///
/// ```
/// use fingertip_calibration::design::NominalLoads;
///
/// // 10 N and 0.1 N·m on all axes, but 30 N along the first.
/// let mut loads = NominalLoads::equal(10.0, 0.1)?;
/// loads.force[0] = 30.0;
/// assert_eq!(loads.components().as_slice(), [30.0, 10.0, 10.0, 0.1, 0.1, 0.1]);
/// loads.torque[2] = 0.0;
/// assert!(loads.validate().is_err());
/// # Ok::<(), fingertip_calibration::design::DesignError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NominalLoads {
    /// Fx, Fy, Fz \[N\].
    #[serde(rename = "force_N")]
    pub force: [f64; 3],
    /// Tx, Ty, Tz about the origin of the sensor frame \[N·m\].
    #[serde(rename = "torque_Nm")]
    pub torque: [f64; 3],
}

impl NominalLoads {
    /// The same force on every axis and the same torque about every axis.
    ///
    /// # Errors
    /// [`DesignError::OutOfRange`] unless both are positive and finite.
    pub fn equal(force: f64, torque: f64) -> Result<Self, DesignError> {
        let loads = Self { force: [force; 3], torque: [torque; 3] };
        loads.validate()?;
        Ok(loads)
    }

    /// # Errors
    /// [`DesignError::OutOfRange`] unless all six are positive and finite.
    pub fn validate(&self) -> Result<(), DesignError> {
        for value in self.force {
            DesignError::check_positive("nominal force", value)?;
        }
        for value in self.torque {
            DesignError::check_positive("nominal torque", value)?;
        }
        Ok(())
    }

    /// Fx, Fy, Fz, Tx, Ty, Tz.
    #[must_use]
    pub fn components(&self) -> Vector6<f64> {
        let ([fx, fy, fz], [tx, ty, tz]) = (self.force, self.torque);
        Vector6::new(fx, fy, fz, tx, ty, tz)
    }
}
