//! Everything that is said about one design.

use nalgebra::{DMatrix, Vector6};

use super::ContactWeight;
use crate::linear::{Singular, pseudo_inverse};

/// The figures of a normalised sensor matrix.
///
/// ```
/// # use fingertip_calibration::design::{LoadedTube, Material, NominalLoads, TubeSpace, Wall};
/// # // The paper's six gauges for 10 N and 0.1 N·m, in the best places.
/// # let loads = NominalLoads::equal(10.0, 0.1)?;
/// # let tube = LoadedTube { material: Material::ALUMINIUM_7075_T6, radius: 5e-3, length: 20e-3, loads };
/// # let angles = (1_f64.to_radians(), 59_f64.to_radians());
/// # let space = TubeSpace::bicchi_dario((2e-3, 15e-3), angles, (2e-3, 40e-3), tube, Wall::Fixed(0.2e-3))?;
/// # let layout = space.layout(&[6.55e-3, 14.45_f64.to_radians(), 13.46e-3])?;
/// use fingertip_calibration::design::Assessment;
///
/// // The paper's sensor at 1 V for each unit of strain: a condition number of 4.18.
/// let assessment = Assessment::new(&layout.normalised(1.0, &loads)?, None).ok_or("not finite")?;
/// assert!((assessment.condition_number - 4.183).abs() < 1e-2);
/// assert!(assessment.worst_sensitivity() > 0.0 && assessment.contact_error.is_none());
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Assessment {
    /// `N_c = σ_max/σ_min`, infinite if the sensor is blind to some load.
    pub condition_number: f64,
    /// The lower bound of `N_c` over all nominal loads is not beaten by equal column norms by more
    /// than √6 (van der Sluis 1969): `N_c` with every column scaled to the same norm.
    pub equilibrated_condition_number: f64,
    /// Singular values, largest first \[signal per nominal load\].
    pub singular_values: Vec<f64>,
    /// `log det CᵀC` (natural).
    pub log_determinant: f64,
    /// `√tr(CᵀC)⁻¹`: rms error of the wrench in nominal loads per unit noise of a channel.
    pub noise_gain: f64,
    /// Signal that a nominal load on each axis gives beyond what the other five could imitate:
    /// `1/√((CᵀC)⁻¹_jj)`.
    pub sensitivities: Vector6<f64>,
    /// Root mean square of the contact position error \[m per unit noise of a channel\], if asked.
    pub contact_error: Option<f64>,
}

impl Assessment {
    /// Of a normalised matrix (channels × 6), and a weight for wrenches in nominal loads
    /// ([`ContactWeight::normalised`]). `None` if the matrix has not six columns and at least six
    /// rows of finite entries.
    #[must_use]
    pub fn new(normalised: &DMatrix<f64>, weight: Option<&ContactWeight>) -> Option<Self> {
        if normalised.ncols() != 6 || normalised.nrows() < 6 {
            return None;
        }
        let singular = Singular::new(normalised)?;
        let norms: Vec<f64> = normalised.column_iter().map(|column| column.norm()).collect();
        let equilibrated_condition_number = if norms.iter().all(|norm| *norm > 0.0) {
            let scaled = DMatrix::from_fn(normalised.nrows(), 6, |i, j| normalised[(i, j)] / norms[j]);
            Singular::new(&scaled)?.condition_number()
        } else {
            f64::INFINITY
        };
        let inverse = pseudo_inverse(normalised);
        let rows: Option<Vector6<f64>> =
            inverse.as_ref().map(|inverse| Vector6::from_fn(|j, _| inverse.row(j).norm()));
        // C⁺C⁺ᵀ = (CᵀC)⁻¹.
        let covariance =
            inverse.map(|inverse| (&inverse * inverse.transpose()).fixed_view::<6, 6>(0, 0).into_owned());
        Some(Self {
            condition_number: singular.condition_number(),
            equilibrated_condition_number,
            log_determinant: 2.0 * singular.values.map(f64::ln).sum(),
            noise_gain: rows.map_or(f64::INFINITY, |rows| rows.norm()),
            sensitivities: rows.map_or_else(Vector6::zeros, |rows| rows.map(f64::recip)),
            contact_error: weight.map(|weight| {
                covariance.map_or(f64::INFINITY, |covariance| weight.position_error(&covariance))
            }),
            singular_values: singular.values.iter().copied().collect(),
        })
    }

    /// The least of [`sensitivities`](Self::sensitivities).
    #[must_use]
    pub fn worst_sensitivity(&self) -> f64 {
        self.sensitivities.min()
    }
}

#[cfg(test)]
mod tests {
    use super::Assessment;
    use nalgebra::DMatrix;

    #[test]
    fn diagonal_sensor_has_obvious_figures() {
        let matrix = DMatrix::from_diagonal(&nalgebra::DVector::from_vec(vec![2.0, 1.0, 1.0, 1.0, 1.0, 0.5]));
        let found = Assessment::new(&matrix, None).unwrap();
        assert_eq!(found.condition_number, 4.0);
        assert_eq!(found.equilibrated_condition_number, 1.0);
        assert!(found.log_determinant.abs() < 1e-15);
        assert!((found.noise_gain - (4.0 + 0.25 + 4.0_f64).sqrt()).abs() < 1e-14);
        assert_eq!(found.worst_sensitivity(), 0.5);
        assert_eq!(found.contact_error, None);
    }

    #[test]
    fn blind_sensor_is_said_to_be_blind() {
        let mut matrix = DMatrix::identity(6, 6);
        matrix[(5, 5)] = 0.0;
        let found = Assessment::new(&matrix, None).unwrap();
        assert_eq!(found.condition_number, f64::INFINITY);
        assert_eq!(found.noise_gain, f64::INFINITY);
        assert_eq!(found.worst_sensitivity(), 0.0);
        assert!(Assessment::new(&DMatrix::identity(5, 6), None).is_none());
        assert!(Assessment::new(&(matrix * f64::NAN), None).is_none());
    }
}
