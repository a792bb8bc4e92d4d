//! A hub on four spokes.

use core::f64::consts::FRAC_PI_2;

use nalgebra::{Matrix6, Rotation3, Vector3, Vector6};

use super::{Bridge, DesignError, DesignSpace, Material, Parameter};

/// A Maltese cross: a rigid hub that carries the fingertip, on four spokes of rectangular section
/// that run to a rigid rim, with gauges along the spokes on their four faces.
///
/// Assumptions: hub and rim are rigid; spokes are straight Euler-Bernoulli beams of one section with
/// shear deformation left out (length more than about five times the height); warping is free;
/// gauges are points on the middle of a face, along the spoke. Where the spokes meet the rim through
/// thin membranes ("floating beams"), the membrane is a spring along the spoke in series with it.
/// Fillets, and the strain that they concentrate, are not in it: check with finite elements and use
/// [`LinearStructure`](super::LinearStructure).
///
/// The first axis is the axis of the cross, towards the fingertip; spokes lie along +Y, +Z, −Y, −Z. The
/// loads act on the hub, about an origin `height_of_origin` beyond the mid-plane of the spokes.
///
/// ```
/// use fingertip_calibration::design::{MalteseCross, Material};
///
/// // Spokes of 2 mm × 2 mm and 12 mm, gauges 1 mm from a hub of 8 mm.
/// let cross = MalteseCross {
///     hub_radius: 8e-3,
///     length: 12e-3,
///     width: 2e-3,
///     height: 2e-3,
///     membrane_compliance: 0.0,
///     height_of_origin: 0.02,
///     gauge_distance: 1e-3,
/// };
/// let strains = cross.strains(&Material::ALUMINIUM_7075_T6)?;
/// // A push along the axis bends all spokes alike, and the two faces of a spoke oppositely.
/// let (near, far, next) = (strains[0][0], strains[1][0], strains[4][0]);
/// assert!(near != 0.0 && (near + far).abs() < 1e-9 * near.abs() && (near - next).abs() < 1e-9 * near.abs());
/// # Ok::<(), fingertip_calibration::design::DesignError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MalteseCross {
    /// Distance from the axis to where the spokes begin \[m\].
    pub hub_radius: f64,
    /// Free length of a spoke \[m\].
    pub length: f64,
    /// Width of a spoke, in the plane of the cross \[m\].
    pub width: f64,
    /// Height of a spoke, along the axis \[m\].
    pub height: f64,
    /// Give of the rim along a spoke \[m/N\]: 0 for a clamped spoke.
    pub membrane_compliance: f64,
    /// How far the origin of the loads lies beyond the cross \[m\].
    pub height_of_origin: f64,
    /// Distance of the gauges from the hub's end of the spoke \[m\].
    pub gauge_distance: f64,
}

/// Faces of a spoke, in the order of the gauges.
const FACES: usize = 4;

impl MalteseCross {
    /// # Errors
    /// [`DesignError::OutOfRange`] for a length that is not positive, a negative compliance, or a
    /// gauge that is not on the spoke.
    pub fn validate(&self) -> Result<(), DesignError> {
        DesignError::check_positive("hub radius", self.hub_radius)?;
        DesignError::check_positive("length of a spoke", self.length)?;
        DesignError::check_positive("width of a spoke", self.width)?;
        DesignError::check_positive("height of a spoke", self.height)?;
        DesignError::check_not_negative("compliance of the rim", self.membrane_compliance)?;
        DesignError::check_not_negative("distance of the gauges", self.gauge_distance)?;
        let value = self.gauge_distance;
        if value > self.length {
            let requirement = "at most the length of the spoke";
            return Err(DesignError::OutOfRange { quantity: "distance of the gauges", value, requirement });
        }
        let value = self.height_of_origin;
        if value.is_finite() {
            Ok(())
        } else {
            Err(DesignError::OutOfRange { quantity: "height of the origin", value, requirement: "finite" })
        }
    }

    /// Displacement of the hub's end of a spoke (three translations, three rotations) by unit loads
    /// there, the rim held, in the spoke's frame: x along the spoke, outward; y across in the plane;
    /// z along the axis of the cross.
    fn compliance(&self, material: &Material) -> Matrix6<f64> {
        let Self { length: l, width: b, height: h, .. } = *self;
        let e = material.youngs_modulus;
        let bending_z = e * b * h.powi(3) / 12.0; // deflection along z, moment about y
        let bending_y = e * h * b.powi(3) / 12.0; // deflection along y, moment about z
        // Torsion of a rectangle (Roark, within 4 %).
        let (long, short) = if b > h { (b, h) } else { (h, b) };
        let ratio = short / long;
        let torsion = long * short.powi(3) * (1.0 / 3.0 - 0.21 * ratio * (1.0 - ratio.powi(4) / 12.0));
        let mut c = Matrix6::zeros();
        c[(0, 0)] = l / (e * b * h) + self.membrane_compliance;
        c[(1, 1)] = l.powi(3) / (3.0 * bending_y);
        c[(2, 2)] = l.powi(3) / (3.0 * bending_z);
        c[(3, 3)] = l / (material.shear_modulus() * torsion);
        c[(4, 4)] = l / bending_z;
        c[(5, 5)] = l / bending_y;
        // The free end lies at −l from the clamped one. A force +y turns it about −z, +z about +y.
        c[(1, 5)] = -l * l / (2.0 * bending_y);
        c[(5, 1)] = c[(1, 5)];
        c[(2, 4)] = l * l / (2.0 * bending_z);
        c[(4, 2)] = c[(2, 4)];
        c
    }

    /// From displacements and rotations of the hub about the origin to those of a spoke's end in its
    /// frame; the transpose takes loads back.
    fn to_spoke(self, spoke: usize) -> Matrix6<f64> {
        let turn = Rotation3::from_axis_angle(&Vector3::x_axis(), FRAC_PI_2 * spoke as f64);
        // The spoke's axes in the sensor frame: outward +Y, across −… so that x × y = z is the axis.
        let (outward, axis) = (turn * Vector3::y(), Vector3::x());
        let across = axis.cross(&outward);
        let frame =
            nalgebra::Matrix3::from_rows(&[outward.transpose(), across.transpose(), axis.transpose()]);
        let end = outward * self.hub_radius - axis * self.height_of_origin;
        let mut map = Matrix6::zeros();
        map.fixed_view_mut::<3, 3>(0, 0).copy_from(&frame);
        map.fixed_view_mut::<3, 3>(0, 3).copy_from(&(-frame * end.cross_matrix()));
        map.fixed_view_mut::<3, 3>(3, 3).copy_from(&frame);
        map
    }

    /// Strain of the 16 gauges per newton and newton metre: of each spoke, the faces towards the
    /// fingertip, away from it, and the two sides (in the sense of a turn about the first axis).
    ///
    /// # Errors
    /// [`DesignError`] for bad dimensions or material, or [`DesignError::Singular`] for a cross whose
    /// stiffness leaves the range of numbers.
    pub fn strains(&self, material: &Material) -> Result<[Vector6<f64>; 16], DesignError> {
        self.validate()?;
        material.validate()?;
        let singular = DesignError::Singular { reason: "the spokes have no finite stiffness" };
        let stiffness = self.compliance(material).cholesky().ok_or_else(|| singular.clone())?.inverse();
        let mut whole = Matrix6::zeros();
        for spoke in 0..4 {
            let map = self.to_spoke(spoke);
            whole += map.transpose() * stiffness * map;
        }
        let give = whole.cholesky().ok_or(singular)?.inverse();
        let e = material.youngs_modulus;
        let (b, h, at) = (self.width, self.height, self.gauge_distance);
        let mut strains = [Vector6::zeros(); 16];
        for spoke in 0..4 {
            // Row i: load i on the spoke's end, in its frame, per unit load on the hub.
            let end = stiffness * self.to_spoke(spoke) * give;
            let load = |i: usize| end.row(i).transpose();
            // The spoke holds the hub's end with these loads; at the gauge, `at` further out, the
            // part nearer to the hub is in balance with the moments about y and z.
            let moment_y = load(4) + load(2) * at;
            let moment_z = load(5) - load(1) * at;
            let axial = -load(0) / (e * b * h);
            let bending_z = moment_y * 6.0 / (e * b * h * h);
            let bending_y = moment_z * 6.0 / (e * h * b * b);
            let faces = [axial - bending_z, axial + bending_z, axial + bending_y, axial - bending_y];
            for (slot, face) in strains[FACES * spoke..].iter_mut().zip(faces) {
                *slot = face;
            }
        }
        Ok(strains)
    }

    /// Full and half bridges that give one channel per spoke and bending direction: eight half
    /// bridges, opposite faces of a spoke in neighbouring arms. Temperature and axial strain cancel.
    #[must_use]
    pub fn half_bridges() -> Vec<Bridge> {
        (0..4)
            .flat_map(|spoke| {
                let first = FACES * spoke;
                [Bridge::half(first, first + 1), Bridge::half(first + 2, first + 3)]
            })
            .collect()
    }
}

/// Maltese crosses for the optimiser: length, width, height and place of the gauges are free, wired in
/// [`MalteseCross::half_bridges`].
///
/// ```
/// use fingertip_calibration::design::{DesignSpace as _, MalteseCross, MalteseCrossSpace, Material};
///
/// let fixed = MalteseCross {
///     hub_radius: 8e-3,
///     length: 12e-3,
///     width: 2e-3,
///     height: 2e-3,
///     membrane_compliance: 0.0,
///     height_of_origin: 0.02,
///     gauge_distance: 1e-3,
/// };
/// // Spokes of 8 mm to 20 mm with sections from 1 mm to 3 mm.
/// let space = MalteseCrossSpace::new((8e-3, 20e-3), (1e-3, 3e-3), fixed, Material::ALUMINIUM_7075_T6)?;
/// assert_eq!((space.parameters().len(), space.channels()), (4, 8));
/// let middle: Vec<f64> = space.parameters().iter().map(|p| 0.5 * (p.lower + p.upper)).collect();
/// let cross = space.cross(&middle)?;
/// assert!((cross.length - 14e-3).abs() < 1e-12 && cross.hub_radius == 8e-3);
/// # Ok::<(), fingertip_calibration::design::DesignError>(())
/// ```
#[derive(Clone, Debug)]
pub struct MalteseCrossSpace {
    parameters: Vec<Parameter>,
    fixed: MalteseCross,
    material: Material,
    bridges: Vec<Bridge>,
}

impl MalteseCrossSpace {
    /// Spokes within these ranges \[m\]; what is not free is taken from `fixed`. Gauges may lie from
    /// the hub to the middle of the spoke.
    ///
    /// # Errors
    /// [`DesignError`] for an empty range or a bad material.
    pub fn new(
        length: (f64, f64),
        section: (f64, f64),
        fixed: MalteseCross,
        material: Material,
    ) -> Result<Self, DesignError> {
        material.validate()?;
        let parameters = vec![
            Parameter::length("length", length.0, length.1),
            Parameter::length("width", section.0, section.1),
            Parameter::length("height", section.0, section.1),
            Parameter {
                unit: super::ParameterUnit::Ratio,
                tolerance: 0.01,
                ..Parameter::length("gauge distance / length", 0.0, 0.5)
            },
        ];
        let space = Self { parameters, fixed, material, bridges: MalteseCross::half_bridges() };
        super::space::validate(&space)?;
        Ok(space)
    }

    /// The cross at these values.
    ///
    /// # Errors
    /// [`DesignError::WrongCount`].
    pub fn cross(&self, values: &[f64]) -> Result<MalteseCross, DesignError> {
        let [length, width, height, place] = *values else {
            return Err(DesignError::WrongCount { what: "parameters", found: values.len(), expected: 4 });
        };
        Ok(MalteseCross { length, width, height, gauge_distance: place * length, ..self.fixed })
    }
}

impl DesignSpace for MalteseCrossSpace {
    fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    fn channels(&self) -> usize {
        self.bridges.len()
    }

    fn response(&self, values: &[f64], rows: &mut [Vector6<f64>]) -> Result<(), DesignError> {
        let gauges = self.cross(values)?.strains(&self.material)?;
        for (row, bridge) in rows.iter_mut().zip(&self.bridges) {
            *row = bridge.response(&gauges)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::{MalteseCross, MalteseCrossSpace};
    use crate::design::{Criterion, DesignSpace, Material, NominalLoads, Search, search};

    const METAL: Material = Material::ALUMINIUM_7075_T6;
    const CROSS: MalteseCross = MalteseCross {
        hub_radius: 5e-3,
        length: 12e-3,
        width: 2e-3,
        height: 1.5e-3,
        membrane_compliance: 0.0,
        height_of_origin: 0.0,
        gauge_distance: 2e-3,
    };

    fn near(found: f64, expected: f64) {
        assert!((found - expected).abs() <= 1e-9 * expected.abs(), "{found} {expected}");
    }

    #[test]
    fn push_along_the_axis_bends_four_guided_beams() {
        // A guided beam carries F/4 with the moment (F/4)(L/2 − x) at x from the hub. Pulled towards
        // the fingertip, a beam clamped at both ends is stretched on that face in its middle.
        let strains = CROSS.strains(&METAL).unwrap();
        let moment = 0.25 * (CROSS.length / 2.0 - CROSS.gauge_distance);
        let strain = moment * 6.0 / (METAL.youngs_modulus * CROSS.width * CROSS.height.powi(2));
        for spoke in 0..4 {
            near(strains[4 * spoke][0], strain);
            near(strains[4 * spoke + 1][0], -strain);
            assert!(strains[4 * spoke + 2][0].abs() < 1e-9 * strain);
        }
    }

    #[test]
    fn push_across_stretches_two_spokes_and_bends_two() {
        let strains = CROSS.strains(&METAL).unwrap();
        let (e, l, b, h) = (METAL.youngs_modulus, CROSS.length, CROSS.width, CROSS.height);
        let along = e * b * h / l;
        let across = 12.0 * e * h * b.powi(3) / 12.0 / l.powi(3);
        let total = 2.0 * along + 2.0 * across;
        // Fy: the spoke along +Y is pressed, that along −Y stretched.
        near(strains[0][1], -along / total / (e * b * h));
        near(strains[8][1], along / total / (e * b * h));
        let moment = across / total * (l / 2.0 - CROSS.gauge_distance);
        // On the spoke along +Z, the side in the sense of a turn about X is that towards −Y: pressed.
        near(strains[6][1], -moment * 6.0 / (e * h * b * b));
        near(strains[6][1], -strains[7][1]);
    }

    #[test]
    fn twist_about_the_axis_bends_all_spokes_alike() {
        let strains = CROSS.strains(&METAL).unwrap();
        let (e, l, b, h, r) =
            (METAL.youngs_modulus, CROSS.length, CROSS.width, CROSS.height, CROSS.hub_radius);
        let stiff = e * h * b.powi(3) / 12.0;
        // A clamped beam whose end moves by r·φ and turns by φ: force V and moment M at its end.
        let force = 12.0 * stiff / l.powi(3) * r + 6.0 * stiff / (l * l);
        let end_moment = 4.0 * stiff / l + 6.0 * stiff / (l * l) * r;
        let torque = 4.0 * (force * r + end_moment);
        let moment = (end_moment - force * CROSS.gauge_distance) / torque;
        for spoke in 0..4 {
            near(strains[4 * spoke + 2][3].abs(), moment.abs() * 6.0 / (e * h * b * b));
            near(strains[4 * spoke + 2][3], strains[2][3]);
        }
    }

    #[test]
    fn moving_the_origin_moves_torques_only() {
        let moved = MalteseCross { height_of_origin: 9e-3, ..CROSS };
        let (here, there) = (CROSS.strains(&METAL).unwrap(), moved.strains(&METAL).unwrap());
        for (a, b) in here.iter().zip(&there) {
            // A force Fy at the origin 9 mm out has the torque +9 mm·Fy about Z at the cross.
            near(b[1] + 1e-6, a[1] + 9e-3 * a[5] + 1e-6);
            near(b[2] + 1e-6, a[2] - 9e-3 * a[4] + 1e-6);
            near(b[4] + 1e-6, a[4] + 1e-6);
        }
    }

    #[test]
    fn membrane_takes_the_axial_stiffness_away() {
        let floating = MalteseCross { membrane_compliance: 1.0, ..CROSS };
        let (clamped, floating) = (CROSS.strains(&METAL).unwrap(), floating.strains(&METAL).unwrap());
        assert!(floating[6][1].abs() > 5.0 * clamped[6][1].abs());
        assert!(floating[0][1].abs() < 1e-3 * clamped[0][1].abs());
    }

    #[test]
    fn optimiser_finds_a_well_conditioned_cross() {
        let fixed = MalteseCross { membrane_compliance: 1e-4, ..CROSS };
        let space = MalteseCrossSpace::new((6e-3, 20e-3), (0.8e-3, 4e-3), fixed, METAL).unwrap();
        let loads = NominalLoads::equal(10.0, 0.1).unwrap();
        let how = Search { starts: 12, ..Search::default() };
        let found = search(&space, &Criterion::ConditionNumber, &loads, &how, &|_| ()).unwrap();
        assert!(found.best().unwrap().criterion < 3.0, "{:?}", found.best());
        assert_eq!(space.channels(), 8);
        assert!(space.bridges.iter().all(crate::design::Bridge::compensates_temperature));
    }

    #[test]
    fn refuses_bad_dimensions() {
        for bad in [f64::NAN, -1.0, f64::INFINITY] {
            assert!(MalteseCross { length: bad, ..CROSS }.strains(&METAL).is_err());
            assert!(MalteseCross { membrane_compliance: bad, ..CROSS }.strains(&METAL).is_err());
        }
        assert!(MalteseCross { gauge_distance: 13e-3, ..CROSS }.strains(&METAL).is_err());
        assert!(MalteseCross { height_of_origin: f64::NAN, ..CROSS }.strains(&METAL).is_err());
    }
}
