//! What a thin-walled tube bears: yield and buckling.

use core::f64::consts::{FRAC_PI_2, PI};

use fingertip_wrench::gauge_layout::ThinWalledBeam;

use super::{DesignError, Material, NominalLoads};

/// Beyond this ratio of wall to radius the thin-wall formulas are off by more than about 5 %.
pub const THICKEST_WALL: f64 = 0.1;

/// How near a tube under load is to failing, and how.
///
/// All loads are taken at their nominal value at once, with the signs that are worst together.
///
/// ```
/// # use fingertip_calibration::design::{LoadedTube, Material, NominalLoads, TubeSpace, Wall};
/// # // The paper's six gauges for 10 N and 0.1 N·m, in the best places.
/// # let loads = NominalLoads::equal(10.0, 0.1)?;
/// # let tube = LoadedTube { material: Material::ALUMINIUM_7075_T6, radius: 5e-3, length: 20e-3, loads };
/// # let angles = (1_f64.to_radians(), 59_f64.to_radians());
/// # let space = TubeSpace::bicchi_dario((2e-3, 15e-3), angles, (2e-3, 40e-3), tube, Wall::Fixed(0.2e-3))?;
/// # let layout = space.layout(&[6.55e-3, 14.45_f64.to_radians(), 13.46e-3])?;
/// use fingertip_calibration::design::TubeStrength;
///
/// // An aluminium tube of 5 mm with a wall of 0.2 mm, 20 mm long, under 10 N and 0.1 N·m.
/// let strength: TubeStrength = tube.strength(0.2e-3)?;
/// assert!((strength.yield_ratio - strength.stress / 503e6).abs() < 1e-9);
/// // It holds; the loads may grow until the first ratio is 1.
/// assert!(strength.holds(1.0) && (strength.safety() * strength.worst_ratio() - 1.0).abs() < 1e-12);
/// # Ok::<(), fingertip_calibration::design::DesignError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TubeStrength {
    /// Greatest equivalent stress of von Mises \[Pa\].
    pub stress: f64,
    /// Load over the load at which that stress is the yield strength.
    pub yield_ratio: f64,
    /// Load over the load of local buckling of the wall, all loads growing alike.
    pub wall_buckling_ratio: f64,
    /// Axial force over the load at which the tube buckles as a column.
    pub column_buckling_ratio: f64,
    /// Wall thickness over radius; above [`THICKEST_WALL`] the formulas are not accurate.
    pub wall_ratio: f64,
}

/// How a tube fails.
///
/// ```
/// # use fingertip_calibration::design::{LoadedTube, Material, NominalLoads, TubeSpace, Wall};
/// # // The paper's six gauges for 10 N and 0.1 N·m, in the best places.
/// # let loads = NominalLoads::equal(10.0, 0.1)?;
/// # let tube = LoadedTube { material: Material::ALUMINIUM_7075_T6, radius: 5e-3, length: 20e-3, loads };
/// # let angles = (1_f64.to_radians(), 59_f64.to_radians());
/// # let space = TubeSpace::bicchi_dario((2e-3, 15e-3), angles, (2e-3, 40e-3), tube, Wall::Fixed(0.2e-3))?;
/// # let layout = space.layout(&[6.55e-3, 14.45_f64.to_radians(), 13.46e-3])?;
/// use fingertip_calibration::design::TubeFailure;
///
/// // A short wall of 0.2 mm yields before it buckles; foil of 5 µm crumples.
/// assert_eq!(tube.strength(0.2e-3)?.failure(), TubeFailure::Yield);
/// assert_eq!(tube.strength(5e-6)?.failure(), TubeFailure::WallBuckling);
/// # Ok::<(), fingertip_calibration::design::DesignError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TubeFailure {
    /// The equivalent stress of von Mises reaches the yield strength.
    Yield,
    /// The wall buckles.
    WallBuckling,
    /// The tube buckles as a column.
    ColumnBuckling,
}

impl TubeStrength {
    /// The largest of the three ratios: below 1 the tube holds.
    #[must_use]
    pub fn worst_ratio(&self) -> f64 {
        self.yield_ratio.max(self.wall_buckling_ratio).max(self.column_buckling_ratio)
    }

    /// The factor by which all loads may grow before the tube fails: each ratio is that of load over failing
    /// load, so that it is the reciprocal of the largest.
    #[must_use]
    pub fn safety(&self) -> f64 {
        self.worst_ratio().recip()
    }

    /// How it fails first.
    #[must_use]
    pub fn failure(&self) -> TubeFailure {
        let worst = self.worst_ratio();
        if self.yield_ratio >= worst {
            TubeFailure::Yield
        } else if self.wall_buckling_ratio >= worst {
            TubeFailure::WallBuckling
        } else {
            TubeFailure::ColumnBuckling
        }
    }

    /// `true` if the tube holds the loads times `safety` and its wall is thin.
    #[must_use]
    pub fn holds(&self, safety: f64) -> bool {
        self.worst_ratio() * safety <= 1.0 && self.wall_ratio <= THICKEST_WALL
    }
}

/// The part of the tube that is loaded, clamped at its far end.
///
/// ```
/// use fingertip_calibration::design::{LoadedTube, Material, NominalLoads};
///
/// // 5 mm of radius and 20 mm of length, for 10 N and 0.1 N·m on each axis at once.
/// let loads = NominalLoads::equal(10.0, 0.1)?;
/// let tube = LoadedTube { material: Material::ALUMINIUM_7075_T6, radius: 5e-3, length: 20e-3, loads };
/// // The thinnest wall that bears three times as much.
/// let metres = tube.least_thickness(3.0)?;
/// assert!((tube.strength(metres)?.safety() - 3.0).abs() < 1e-3 && metres < 0.5e-3);
/// # Ok::<(), fingertip_calibration::design::DesignError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadedTube {
    /// What it is made of.
    pub material: Material,
    /// Mean radius of the wall \[m\].
    pub radius: f64,
    /// Distance of the clamped end behind the origin of the loads \[m\].
    pub length: f64,
    /// The loads, about the origin.
    pub loads: NominalLoads,
}

impl LoadedTube {
    /// # Errors
    /// [`DesignError::OutOfRange`] for a quantity that is not positive and finite.
    pub fn validate(&self) -> Result<(), DesignError> {
        self.material.validate()?;
        self.loads.validate()?;
        DesignError::check_positive("radius", self.radius)?;
        DesignError::check_positive("loaded length", self.length)?;
        Ok(())
    }

    /// The beam with this wall thickness \[m\].
    #[must_use]
    pub const fn beam(&self, thickness: f64) -> ThinWalledBeam<f64> {
        ThinWalledBeam {
            radius: self.radius,
            thickness,
            youngs_modulus: self.material.youngs_modulus,
            poisson_ratio: self.material.poisson_ratio,
        }
    }

    /// Stress and buckling at a wall thickness \[m\].
    ///
    /// * *Yield*: von Mises' `√(σ² + 3τ²)` around the clamped section, where bending is greatest,
    ///   for the signs of the six loads that make it greatest.
    ///   With area `A = 2πRs`: axial `F1/A`, bending `2M/(RA)`, torsion `M4/(RA)`, transverse
    ///   shear `2V/A` at the neutral line (thin ring). Stress concentration is not in it.
    /// * *Wall buckling*: `σ_axial/σ_ca + σ_bend/σ_cb + (τ/τ_c)² ≤ 1`, solved for the factor λ of all
    ///   loads at which `aλ + bλ² = 1`, with
    ///   `σ_c = γ E s/(R√(3(1−μ²)))`, `γ = 1 − 0.901(1 − e^{−φ})` in compression and
    ///   `1 − 0.731(1 − e^{−φ})` in bending, `φ = √(R/s)/16`, and for shear
    ///   `τ_c = 0.67·0.85 Z^{3/4} π²D/(L²s)`, `Z = L²√(1−μ²)/(Rs)`, at least the value of `Z = 1`
    ///   (NASA SP-8007, "Buckling of thin-walled circular cylinders", 1968).
    /// * *Column*: `F1 ≤ π²EI/(4L²)`, `I = πR³s`: one end clamped, the other free (Euler).
    ///
    /// # Errors
    /// [`DesignError::OutOfRange`].
    pub fn strength(&self, thickness: f64) -> Result<TubeStrength, DesignError> {
        self.validate()?;
        DesignError::check_positive("wall thickness", thickness)?;
        Ok(self.strength_of(thickness))
    }

    fn strength_of(&self, thickness: f64) -> TubeStrength {
        let stress = self.stress(thickness);
        TubeStrength {
            stress,
            yield_ratio: stress / self.material.yield_strength,
            wall_buckling_ratio: self.wall_buckling_ratio(thickness),
            column_buckling_ratio: self.column_buckling_ratio(thickness),
            wall_ratio: thickness / self.radius,
        }
    }

    fn area(&self, thickness: f64) -> f64 {
        2.0 * PI * self.radius * thickness
    }

    /// Greatest bending moment about the two transverse axes, at the clamped end.
    fn moments(&self) -> (f64, f64) {
        let ([_, f2, f3], [_, m5, m6]) = (self.loads.force, self.loads.torque);
        (m5 + self.length * f3, m6 + self.length * f2)
    }

    fn stress(&self, thickness: f64) -> f64 {
        let Self { radius, length, loads, .. } = *self;
        let ([f1, f2, f3], [m4, m5, m6]) = (loads.force, loads.torque);
        // A transverse force bends and shears. At an angle from the second axis towards the third, forces of like
        // signs bend by their sum and shear by their difference, those of unlike signs the other way round; the
        // signs of the others are free, so that one quadrant stands for all.
        let steps = 256_u32;
        (0..=steps)
            .map(|step| {
                let (sin, cos) = (FRAC_PI_2 * f64::from(step) / f64::from(steps)).sin_cos();
                let equivalent = |sign: f64| {
                    let bending = m5 * sin + m6 * cos + length * (f3 * sin + sign * f2 * cos).abs();
                    let shear = m4 / radius + 2.0 * (f3 * cos - sign * f2 * sin).abs();
                    (f1 + 2.0 / radius * bending).hypot(3.0_f64.sqrt() * shear)
                };
                equivalent(1.0).max(equivalent(-1.0))
            })
            .fold(0.0, f64::max)
            / self.area(thickness)
    }

    fn wall_buckling_ratio(&self, thickness: f64) -> f64 {
        let Self { material, radius, length, loads } = *self;
        let ([f1, f2, f3], [m4, _, _]) = (loads.force, loads.torque);
        let (bend5, bend6) = self.moments();
        let area = self.area(thickness);
        let plane = 1.0 - material.poisson_ratio * material.poisson_ratio;
        let slenderness = (radius / thickness).sqrt() / 16.0;
        let classical = material.youngs_modulus * thickness / (radius * (3.0 * plane).sqrt());
        let imperfect = |loss: f64| 1.0 - loss * (1.0 - (-slenderness).exp());
        let (in_compression, in_bending) = (classical * imperfect(0.901), classical * imperfect(0.731));
        let curvature = (length * length * plane.sqrt() / (radius * thickness)).max(1.0);
        let plate = material.youngs_modulus * thickness.powi(3) / (12.0 * plane);
        let in_shear = 0.67 * 0.85 * curvature.powf(0.75) * PI * PI * plate / (length * length * thickness);
        let axial = f1 / area;
        let bending = 2.0 / radius * bend5.hypot(bend6) / area;
        let shear = (m4 / radius + 2.0 * f2.hypot(f3)) / area;
        // λ of aλ + (bλ)² = 1, or rather its reciprocal, which is finite without load.
        let linear = axial / in_compression + bending / in_bending;
        0.5 * (linear + linear.hypot(2.0 * shear / in_shear))
    }

    fn column_buckling_ratio(&self, thickness: f64) -> f64 {
        let inertia = PI * self.radius.powi(3) * thickness;
        let column = PI * PI * self.material.youngs_modulus * inertia / (4.0 * self.length * self.length);
        self.loads.force[0] / column
    }

    /// The thinnest wall \[m\] that holds the loads times `safety`: the thinner the wall, the
    /// larger the strain.
    ///
    /// # Errors
    /// [`DesignError::OutOfRange`], or [`DesignError::WallTooThick`] if that wall would not be thin
    /// ([`THICKEST_WALL`]).
    pub fn least_thickness(&self, safety: f64) -> Result<f64, DesignError> {
        self.validate()?;
        DesignError::check_positive("safety factor", safety)?;
        // Stress goes with 1/s exactly; buckling falls faster, and monotonically.
        let reference = self.radius * THICKEST_WALL;
        let strength = self.strength_of(reference);
        let by_yield = strength.yield_ratio * safety * reference;
        let by_column = strength.column_buckling_ratio * safety * reference;
        let mut upper = by_yield.max(by_column);
        if !(upper <= reference) {
            return Err(DesignError::WallTooThick { radius: self.radius, thickness: upper });
        }
        let buckles = |thickness: f64| self.wall_buckling_ratio(thickness) * safety > 1.0;
        if !buckles(upper) {
            return Ok(upper);
        }
        if buckles(reference) {
            return Err(DesignError::WallTooThick { radius: self.radius, thickness: reference });
        }
        let mut lower = upper;
        upper = reference;
        for _ in 0..60 {
            let middle = 0.5 * (lower + upper);
            if buckles(middle) {
                lower = middle;
            } else {
                upper = middle;
            }
        }
        Ok(upper)
    }
}

#[cfg(test)]
#[path = "tube_strength_tests.rs"]
mod tests;
