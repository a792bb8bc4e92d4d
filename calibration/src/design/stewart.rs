//! A platform on six legs.

use core::f64::consts::{FRAC_PI_3, PI};

use nalgebra::{Matrix6, Vector3, Vector6};

use super::{DesignError, DesignSpace, Material, NominalLoads, Parameter};

/// A Stewart platform as a sensor: six slender legs between a base and a platform that carries the
/// fingertip, each with gauges that measure its axial strain.
///
/// Assumptions: both plates are rigid; the joints (or flexures) carry axial force only, so a leg
/// bends not at all; deflections are small; all legs have the same section. Real flexure joints
/// stiffen the structure against bending, which lowers the strain: check with finite elements and
/// use [`LinearStructure`](super::LinearStructure).
///
/// The origin of the loads lies `height_of_origin` above the platform on the axis of symmetry, which
/// is the first axis as in the tube, pointing from base to platform. The legs meet the plates in
/// three pairs, 120° apart; a pair on the platform is turned by 60° from the pairs on the base.
///
/// ```
/// use fingertip_calibration::design::Stewart;
///
/// // Plates of 20 mm and 15 mm radius, 20 mm apart.
/// let platform = Stewart {
///     base_radius: 0.02,
///     platform_radius: 0.015,
///     height: 0.02,
///     base_half_angle: 10_f64.to_radians(),
///     platform_half_angle: 10_f64.to_radians(),
///     height_of_origin: 0.01,
/// };
/// // Under a pull along the axis all legs pull alike, together more than the load since they stand aslant.
/// let along = platform.tensions()?.column(0).into_owned();
/// assert!((along.max() - along.min()).abs() < 1e-9 && along.sum().abs() > 1.0);
/// # Ok::<(), fingertip_calibration::design::DesignError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stewart {
    /// Radius of the circle of the lower joints \[m\].
    pub base_radius: f64,
    /// Radius of the circle of the upper joints \[m\].
    pub platform_radius: f64,
    /// Distance of the two planes \[m\].
    pub height: f64,
    /// Half the angle between the two joints of a pair, on the base \[rad\].
    pub base_half_angle: f64,
    /// The same on the platform \[rad\].
    pub platform_half_angle: f64,
    /// How far the origin of the loads lies beyond the platform \[m\].
    pub height_of_origin: f64,
}

/// Strength of a platform under nominal loads, all at once and with the worst signs.
///
/// ```
/// use fingertip_calibration::design::{Material, NominalLoads, Stewart, StewartStrength};
///
/// # let platform = Stewart {
/// #     base_radius: 0.02,
/// #     platform_radius: 0.015,
/// #     height: 0.02,
/// #     base_half_angle: 10_f64.to_radians(),
/// #     platform_half_angle: 10_f64.to_radians(),
/// #     height_of_origin: 0.01,
/// # };
/// // Legs of 1 mm and of 2 mm under 10 N and 0.1 N·m: four times the area bears four times as much.
/// let loads = NominalLoads::equal(10.0, 0.1)?;
/// let thin: StewartStrength = platform.strength(&Material::STEEL_17_4_PH, 1e-3, &loads)?;
/// let thick = platform.strength(&Material::STEEL_17_4_PH, 2e-3, &loads)?;
/// assert!((thin.leg_force - thick.leg_force).abs() < 1e-9);
/// assert!((thin.yield_ratio / thick.yield_ratio - 4.0).abs() < 1e-9 && thick.yield_ratio < 1.0);
/// // Against buckling it is sixteen times.
/// assert!((thin.buckling_ratio / thick.buckling_ratio - 16.0).abs() < 1e-9);
/// # Ok::<(), fingertip_calibration::design::DesignError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StewartStrength {
    /// Greatest force in a leg \[N\].
    pub leg_force: f64,
    /// Greatest stress over yield strength.
    pub yield_ratio: f64,
    /// Greatest compression over Euler's load of a leg with hinged ends.
    pub buckling_ratio: f64,
}

impl Stewart {
    /// Lower and upper joint of each leg.
    fn legs(&self) -> [(Vector3<f64>, Vector3<f64>); 6] {
        let mut legs = [(Vector3::zeros(), Vector3::zeros()); 6];
        let top = -self.height_of_origin;
        for (i, leg) in legs.iter_mut().enumerate() {
            // Leg 2k goes from the one joint of base pair k up to platform pair k, leg 2k+1 from the
            // other joint to platform pair k−1: neighbours lean to opposite sides.
            let pair = (i / 2) as f64 * 2.0 * FRAC_PI_3;
            let side = if i % 2 == 0 { 1.0 } else { -1.0 };
            let below = pair + side * self.base_half_angle;
            let above = pair + side * (FRAC_PI_3 - self.platform_half_angle);
            let (sin, cos) = below.sin_cos();
            leg.0 = Vector3::new(top - self.height, self.base_radius * cos, self.base_radius * sin);
            let (sin, cos) = above.sin_cos();
            leg.1 = Vector3::new(top, self.platform_radius * cos, self.platform_radius * sin);
        }
        legs
    }

    /// # Errors
    /// [`DesignError::OutOfRange`] for a length that is not positive, or half angles not in [0°, 60°].
    pub fn validate(&self) -> Result<(), DesignError> {
        DesignError::check_positive("base radius", self.base_radius)?;
        DesignError::check_positive("platform radius", self.platform_radius)?;
        DesignError::check_positive("height", self.height)?;
        for value in [self.base_half_angle, self.platform_half_angle] {
            if !(0.0..=FRAC_PI_3).contains(&value) {
                let requirement = "between 0 and 60°";
                return Err(DesignError::OutOfRange { quantity: "half angle of a pair", value, requirement });
            }
        }
        if self.height_of_origin.is_finite() {
            Ok(())
        } else {
            let value = self.height_of_origin;
            Err(DesignError::OutOfRange { quantity: "height of the origin", value, requirement: "finite" })
        }
    }

    /// Tension of each leg per newton and newton metre on the platform: `G⁻¹`, where the column of `G`
    /// for a leg with direction `u` (base to platform) through `p` is `−(u, p × u)` … the pull of a
    /// leg in tension, which balances the load.
    ///
    /// # Errors
    /// [`DesignError`] for bad dimensions, or [`DesignError::Singular`] if the legs leave the platform
    /// a freedom.
    pub fn tensions(&self) -> Result<Matrix6<f64>, DesignError> {
        self.validate()?;
        let mut load_of = Matrix6::zeros();
        // Torques by a length of the structure, so that the test for singularity has no unit.
        let size = self.platform_radius;
        for (mut column, (below, above)) in load_of.column_iter_mut().zip(self.legs()) {
            let direction = (above - below).normalize();
            // A leg in tension pulls the platform down with −u; the load that it balances is +u.
            column.fixed_rows_mut::<3>(0).copy_from(&direction);
            column.fixed_rows_mut::<3>(3).copy_from(&(above.cross(&direction) / size));
        }
        let singular = DesignError::Singular { reason: "the legs leave the platform a freedom" };
        let condition =
            crate::linear::Singular::new(&nalgebra::DMatrix::from_column_slice(6, 6, load_of.as_slice()))
                .map_or(f64::INFINITY, |singular| singular.condition_number());
        if !(condition < 1e9) {
            return Err(singular);
        }
        let mut tensions = load_of.full_piv_lu().try_inverse().ok_or(singular)?;
        for mut column in tensions.column_iter_mut().skip(3) {
            column /= size;
        }
        Ok(tensions)
    }

    /// Strain of each leg of cross-section `area` \[m²\] per unit load.
    ///
    /// # Errors
    /// As [`tensions`](Self::tensions).
    pub fn strains(&self, material: &Material, area: f64) -> Result<[Vector6<f64>; 6], DesignError> {
        material.validate()?;
        DesignError::check_positive("section of a leg", area)?;
        let tensions = self.tensions()?;
        let stiffness = material.youngs_modulus * area;
        Ok(core::array::from_fn(|leg| tensions.row(leg).transpose() / stiffness))
    }

    /// Yield and buckling of round legs of this diameter \[m\].
    ///
    /// # Errors
    /// As [`tensions`](Self::tensions).
    pub fn strength(
        &self,
        material: &Material,
        diameter: f64,
        loads: &NominalLoads,
    ) -> Result<StewartStrength, DesignError> {
        material.validate()?;
        loads.validate()?;
        DesignError::check_positive("diameter of a leg", diameter)?;
        let tensions = self.tensions()?;
        let leg_force = (tensions.abs() * loads.components()).max();
        let area = PI * diameter * diameter / 4.0;
        let inertia = PI * diameter.powi(4) / 64.0;
        let length = self.legs().iter().map(|(below, above)| (above - below).norm()).fold(0.0, f64::max);
        let euler = PI * PI * material.youngs_modulus * inertia / (length * length);
        Ok(StewartStrength {
            leg_force,
            yield_ratio: leg_force / area / material.yield_strength,
            buckling_ratio: leg_force / euler,
        })
    }
}

/// Stewart platforms of a given size for the optimiser: base radius, platform radius, height and
/// both half angles are free.
///
/// ```
/// use fingertip_calibration::design::{Criterion, DesignSpace as _, Material, NominalLoads};
/// use fingertip_calibration::design::{Search, StewartSpace, search};
///
/// // Radii of 10 mm to 30 mm, heights of 10 mm to 40 mm, legs of 1 mm², the origin 10 mm above the platform.
/// let space = StewartSpace::new((0.01, 0.03), (0.01, 0.04), 0.01, Material::ALUMINIUM_7075_T6, 1e-6)?;
/// assert_eq!((space.parameters().len(), space.channels()), (5, 6));
/// let (loads, how) = (NominalLoads::equal(10.0, 0.1)?, Search { starts: 4, ..Search::default() });
/// let found = search(&space, &Criterion::ConditionNumber, &loads, &how, &|_| ())?;
/// let best = found.best().ok_or("none")?;
/// assert!(best.criterion < 6.0 && space.platform(&best.values)?.validate().is_ok());
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct StewartSpace {
    parameters: Vec<Parameter>,
    material: Material,
    area: f64,
    height_of_origin: f64,
}

impl StewartSpace {
    /// Radii and heights within these ranges \[m\], legs of cross-section `area` \[m²\].
    ///
    /// # Errors
    /// [`DesignError`] for an empty range, a bad material or a bad section.
    pub fn new(
        radius: (f64, f64),
        height: (f64, f64),
        height_of_origin: f64,
        material: Material,
        area: f64,
    ) -> Result<Self, DesignError> {
        material.validate()?;
        DesignError::check_positive("section of a leg", area)?;
        let parameters = vec![
            Parameter::length("base radius", radius.0, radius.1),
            Parameter::length("platform radius", radius.0, radius.1),
            Parameter::length("height", height.0, height.1),
            Parameter::angle("base half angle", 0.0, FRAC_PI_3),
            Parameter::angle("platform half angle", 0.0, FRAC_PI_3),
        ];
        let space = Self { parameters, material, area, height_of_origin };
        super::space::validate(&space)?;
        Ok(space)
    }

    /// The platform at these values.
    ///
    /// # Errors
    /// [`DesignError::WrongCount`].
    pub fn platform(&self, values: &[f64]) -> Result<Stewart, DesignError> {
        let [base_radius, platform_radius, height, base_half_angle, platform_half_angle] = *values else {
            return Err(DesignError::WrongCount { what: "parameters", found: values.len(), expected: 5 });
        };
        let height_of_origin = self.height_of_origin;
        Ok(Stewart {
            base_radius,
            platform_radius,
            height,
            base_half_angle,
            platform_half_angle,
            height_of_origin,
        })
    }
}

impl DesignSpace for StewartSpace {
    fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    fn channels(&self) -> usize {
        6
    }

    fn response(&self, values: &[f64], rows: &mut [Vector6<f64>]) -> Result<(), DesignError> {
        let strains = self.platform(values)?.strains(&self.material, self.area)?;
        for (row, strain) in rows.iter_mut().zip(strains) {
            *row = strain;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::{Stewart, StewartSpace};
    use crate::design::{Criterion, Material, NominalLoads, Search, search};
    use crate::testing::Largest as _;
    use nalgebra::Vector6;
    use proptest::prelude::*;

    const PLATFORM: Stewart = Stewart {
        base_radius: 20e-3,
        platform_radius: 12e-3,
        height: 15e-3,
        base_half_angle: 0.2,
        platform_half_angle: 0.15,
        height_of_origin: 8e-3,
    };

    #[test]
    fn pull_along_the_axis_is_shared_evenly() {
        let tensions = PLATFORM.tensions().unwrap();
        let (below, above) = PLATFORM.legs()[0];
        let leg = above - below;
        for tension in tensions.column(0).iter() {
            let expected = leg.norm() / (6.0 * leg.x);
            assert!((tension - expected).abs() < 1e-12, "{tension} {expected}");
        }
    }

    proptest! {
        #[test]
        fn legs_balance_any_load(
            radii in proptest::array::uniform2(5e-3..40e-3_f64), height in 5e-3..40e-3_f64,
            angles in proptest::array::uniform2(0.0..0.5_f64), origin in -10e-3..30e-3_f64,
            load in proptest::array::uniform6(-1.0..1.0_f64),
        ) {
            let platform = Stewart {
                base_radius: radii[0], platform_radius: radii[1], height,
                base_half_angle: angles[0], platform_half_angle: angles[1], height_of_origin: origin,
            };
            let Ok(tensions) = platform.tensions() else { return Ok(()) };
            let load = Vector6::from(load).component_mul(&Vector6::new(1.0, 1.0, 1.0, 0.01, 0.01, 0.01));
            let mut rest = load;
            for ((below, above), tension) in platform.legs().iter().zip((tensions * load).iter()) {
                let pull = (below - above).normalize() * *tension;
                let torque = above.cross(&pull);
                rest += Vector6::new(pull.x, pull.y, pull.z, torque.x, torque.y, torque.z);
            }
            let size = tensions.largest() * (1.0 + origin.abs() + radii[0]);
            prop_assert!(rest.largest() <= 1e-12 * size.max(1.0), "{rest}");
        }
    }

    #[test]
    fn parallel_legs_are_singular() {
        let stiff = Stewart {
            base_half_angle: 0.3,
            platform_half_angle: core::f64::consts::FRAC_PI_3 - 0.3,
            platform_radius: 20e-3,
            ..PLATFORM
        };
        assert!(stiff.tensions().is_err());
        assert!(Stewart { height: 0.0, ..PLATFORM }.tensions().is_err());
        assert!(Stewart { base_half_angle: 2.0, ..PLATFORM }.tensions().is_err());
        assert!(Stewart { height_of_origin: f64::NAN, ..PLATFORM }.tensions().is_err());
    }

    #[test]
    fn optimum_is_far_better_than_a_guess_and_scales_with_the_loads() {
        let loads = NominalLoads::equal(10.0, 0.1).unwrap();
        let space =
            StewartSpace::new((3e-3, 40e-3), (3e-3, 40e-3), 0.0, Material::STEEL_17_4_PH, 1e-6).unwrap();
        let how = Search { starts: 16, ..Search::default() };
        let found = search(&space, &Criterion::ConditionNumber, &loads, &how, &|_| ()).unwrap();
        let best = found.best().unwrap();
        assert!(best.criterion < 2.3, "{best:?}");
        let strength =
            space.platform(&best.values).unwrap().strength(&Material::STEEL_17_4_PH, 1.2e-3, &loads).unwrap();
        assert!(strength.yield_ratio > 0.0 && strength.buckling_ratio.is_finite());
    }
}
