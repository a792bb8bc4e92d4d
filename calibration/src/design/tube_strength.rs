//! What a thin-walled tube bears: yield and buckling.

use core::f64::consts::{FRAC_PI_2, PI};

use fingertip_wrench::gauge_layout::ThinWalledBeam;

use super::{DesignError, Material, NominalLoads};

/// Beyond this ratio of wall to radius the thin-wall formulas are off by more than about 5 %.
pub const THICKEST_WALL: f64 = 0.1;

/// How near a tube under load is to failing, and how.
///
/// All loads are taken at their nominal value at once, with the signs that are worst together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TubeStrength {
    /// Greatest equivalent stress of von Mises \[Pa\].
    pub stress: f64,
    /// Greatest stress over yield strength.
    pub yield_ratio: f64,
    /// Load over the load of local buckling of the wall.
    pub wall_buckling_ratio: f64,
    /// Axial force over the load at which the tube buckles as a column.
    pub column_buckling_ratio: f64,
    /// Wall thickness over radius; above [`THICKEST_WALL`] the formulas are not accurate.
    pub wall_ratio: f64,
}

impl TubeStrength {
    /// The largest of the three ratios: below 1 the tube holds, its reciprocal is the safety.
    #[must_use]
    pub fn worst_ratio(&self) -> f64 {
        self.yield_ratio.max(self.wall_buckling_ratio).max(self.column_buckling_ratio)
    }

    /// `true` if the tube holds the loads times `safety` and its wall is thin.
    #[must_use]
    pub fn holds(&self, safety: f64) -> bool {
        self.worst_ratio() * safety <= 1.0 && self.wall_ratio <= THICKEST_WALL
    }
}

/// The part of the tube that is loaded, clamped at its far end.
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
    /// * *Yield*: von Mises' `√(σ² + 3τ²)` around the clamped section, where bending is greatest.
    ///   With area `A = 2πRs`: axial `F1/A`, bending `2M/(RA)`, torsion `M4/(RA)`, transverse
    ///   shear `2V/A` at the neutral line (thin ring). Stress concentration is not in it.
    /// * *Wall buckling*: `σ_axial/σ_ca + σ_bend/σ_cb + (τ/τ_c)² ≤ 1` with
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
        let ([f1, f2, f3], [m4, _, _]) = (self.loads.force, self.loads.torque);
        let (bend5, bend6) = self.moments();
        let (radius, area) = (self.radius, self.area(thickness));
        // Symmetric in every quadrant, for the signs of the loads are free.
        let steps = 256_u32;
        (0..=steps)
            .map(|step| {
                let (sin, cos) = (FRAC_PI_2 * f64::from(step) / f64::from(steps)).sin_cos();
                let normal = f1 + 2.0 / radius * (bend5 * sin + bend6 * cos);
                let shear = m4 / radius + 2.0 * (f2 * sin + f3 * cos);
                normal.hypot(3.0_f64.sqrt() * shear) / area
            })
            .fold(0.0, f64::max)
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
        axial / in_compression + bending / in_bending + (shear / in_shear).powi(2)
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
mod tests {
    use super::{LoadedTube, THICKEST_WALL};
    use crate::design::{Material, NominalLoads};
    use core::f64::consts::PI;
    use proptest::prelude::*;

    fn tube(force: [f64; 3], torque: [f64; 3]) -> LoadedTube {
        LoadedTube {
            material: Material::ALUMINIUM_7075_T6,
            radius: 5e-3,
            length: 12e-3,
            loads: NominalLoads { force, torque },
        }
    }

    /// So small that it does not count in a sum with ordinary loads.
    const NONE: f64 = 1e-30;

    #[test]
    fn single_loads_have_the_textbook_stress() {
        let (radius, wall, length) = (5e-3, 0.2e-3, 12e-3);
        let area = 2.0 * PI * radius * wall;
        let section_modulus = PI * radius * radius * wall;
        let cases = [
            (tube([100.0, NONE, NONE], [NONE; 3]), 100.0 / area),
            (tube([NONE; 3], [NONE, 1.0, NONE]), 1.0 / section_modulus),
            (tube([NONE; 3], [1.0, NONE, NONE]), 3.0_f64.sqrt() / (2.0 * section_modulus)),
            (tube([NONE, 100.0, NONE], [NONE; 3]), {
                let bending = 100.0 * length / section_modulus;
                let shear = 200.0 / area * 3.0_f64.sqrt();
                bending.max(shear)
            }),
        ];
        for (tube, stress) in cases {
            let found = tube.strength(wall).unwrap().stress;
            assert!((found - stress).abs() <= 1e-12 * stress, "{found} {stress}");
        }
    }

    proptest! {
        #[test]
        fn least_thickness_holds_and_less_does_not(
            force in 0.1..60.0_f64, torque in 1e-3..0.4_f64, safety in 1.0..4.0_f64, radius in 2e-3..20e-3_f64,
        ) {
            let mut tube = tube([force; 3], [torque; 3]);
            tube.radius = radius;
            match tube.least_thickness(safety) {
                Ok(wall) => {
                    prop_assert!(tube.strength(wall * 1.000_001).unwrap().holds(safety)
                        || wall / radius > 0.099_999);
                    prop_assert!(!tube.strength(wall * 0.999).unwrap().holds(safety));
                }
                Err(_) => prop_assert!(!tube.strength(radius * THICKEST_WALL).unwrap().holds(safety)),
            }
        }

        #[test]
        fn safety_grows_with_the_wall(wall in 1e-5..4e-4_f64, factor in 1.01..1.5_f64) {
            let tube = tube([30.0; 3], [0.3; 3]);
            let (thin, thick) = (tube.strength(wall).unwrap(), tube.strength(wall * factor).unwrap());
            prop_assert!(thick.stress < thin.stress);
            prop_assert!(thick.wall_buckling_ratio < thin.wall_buckling_ratio);
            prop_assert!(thick.column_buckling_ratio < thin.column_buckling_ratio);
        }
    }

    #[test]
    fn very_thin_walls_buckle_before_they_yield() {
        let mut tube = tube([0.02; 3], [0.2e-3; 3]);
        tube.radius = 20e-3;
        let wall = tube.least_thickness(2.0).unwrap();
        let strength = tube.strength(wall).unwrap();
        assert!(strength.wall_buckling_ratio > strength.yield_ratio);
        assert!((strength.wall_buckling_ratio * 2.0 - 1.0).abs() < 1e-9);
    }

    /// The formulas of the documentation, worked out apart from this code for one tube of 20 mm and 0.2 mm: the
    /// loads at which it buckles.
    #[test]
    fn single_loads_buckle_where_the_formulas_say() {
        let wall = 0.2e-3;
        let of = |force: [f64; 3], torque: [f64; 3], length: f64| {
            LoadedTube { radius: 20e-3, length, ..tube(force, torque) }.strength(wall).unwrap()
        };
        let near = |found: f64, expected: f64| {
            assert!((found / expected - 1.0).abs() < 1e-12, "{found} instead of {expected}");
        };
        let compression = of([6_406.391_629_609_737, NONE, NONE], [NONE; 3], 12e-3);
        near(compression.wall_buckling_ratio, 1.0);
        near(compression.column_buckling_ratio, 6_406.391_629_609_737 / 6_175_416.772_159_714);
        near(compression.wall_ratio, 0.01);
        let moment = 72.771_402_724_899_87;
        near(of([NONE; 3], [NONE, moment, NONE], 12e-3).wall_buckling_ratio, 1.0);
        near(of([NONE; 3], [NONE, 0.6 * moment, 0.8 * moment], 12e-3).wall_buckling_ratio, 1.0);
        // Z is 34 here, and 0.5 for the short one, which counts as 1. The share of shear is a square.
        near(of([NONE; 3], [74.066_459_694_494_2, NONE, NONE], 12e-3).wall_buckling_ratio, 1.0);
        near(of([NONE; 3], [2.0 * 336.784_633_990_464_6, NONE, NONE], 1.5e-3).wall_buckling_ratio, 4.0);
        // A transverse force F shears as a torque of 2RF does, and bends at the clamped end.
        let force = 100.0;
        let shear = force * 2.0 * 20e-3 / 336.784_633_990_464_6;
        let expected = shear * shear + force * 1.5e-3 / moment;
        near(of([NONE, force, NONE], [NONE; 3], 1.5e-3).wall_buckling_ratio, expected);
        near(of([NONE, 0.6 * force, 0.8 * force], [NONE; 3], 1.5e-3).wall_buckling_ratio, expected);
    }

    /// What just holds, and a little less.
    #[test]
    fn a_tube_holds_up_to_its_limits() {
        let good = tube([10.0; 3], [0.1; 3]).strength(0.2e-3).unwrap();
        let safety = 1.0 / good.worst_ratio();
        assert!(good.holds(0.999_999 * safety) && !good.holds(1.000_001 * safety));
        let of_ratios = |yields: f64, wall: f64, column: f64| super::TubeStrength {
            yield_ratio: yields,
            wall_buckling_ratio: wall,
            column_buckling_ratio: column,
            ..good
        };
        for strength in [of_ratios(0.5, 0.2, 0.1), of_ratios(0.1, 0.5, 0.2), of_ratios(0.2, 0.1, 0.5)] {
            assert_eq!(strength.worst_ratio(), 0.5);
            assert!(strength.holds(2.0) && !strength.holds(2.001));
            assert!(super::TubeStrength { wall_ratio: THICKEST_WALL, ..strength }.holds(2.0));
            assert!(!super::TubeStrength { wall_ratio: 1.01 * THICKEST_WALL, ..strength }.holds(1.0));
        }
    }

    #[test]
    fn refuses_bad_numbers() {
        let good = tube([30.0; 3], [0.3; 3]);
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(good.strength(bad).is_err());
            assert!(good.least_thickness(bad).is_err());
            assert!(LoadedTube { radius: bad, ..good }.strength(1e-4).is_err());
            assert!(LoadedTube { length: bad, ..good }.least_thickness(1.0).is_err());
        }
        assert!(tube([1e9; 3], [0.3; 3]).least_thickness(1.0).is_err());
    }
}
