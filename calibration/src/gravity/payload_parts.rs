//! The two least-squares problems behind a payload: forces give the weight, torques the centre of mass.

use nalgebra::{DMatrix, DVector, Vector3, Vector6};

use super::error::{PayloadError, named};
use super::pose_noise::PoseNoise;
use super::poses::{Pose, unit};
use crate::fit::{Fit, least_squares};

/// What the forces tell.
pub(super) struct Weight {
    pub(super) fit: Fit,
    /// Poses to forces, of the weight along `basis` and the bias.
    pub(super) design: DMatrix<f64>,
    forces: DMatrix<f64>,
    /// The directions in which the weight may lie, as columns.
    basis: DMatrix<f64>,
    /// Weight in the base frame \[N\].
    pub(super) load: Vector3<f64>,
    pub(super) length: f64,
    pub(super) bias: Vector3<f64>,
}

impl Weight {
    /// Along `down`, if that is known.
    pub(super) fn of(poses: &[Pose], down: Option<Vector3<f64>>) -> Result<Self, PayloadError> {
        let rows = 3 * poses.len();
        let basis = basis_of(down);
        let unknowns = basis.ncols();
        let mut design = DMatrix::zeros(rows, unknowns + 3);
        let mut forces = DMatrix::zeros(rows, 1);
        for (i, pose) in poses.iter().enumerate() {
            let turned = pose.base_from_sensor.transpose() * &basis;
            design.view_mut((3 * i, 0), (3, unknowns)).copy_from(&turned);
            design.view_mut((3 * i, unknowns), (3, 3)).fill_with_identity();
            forces.view_mut((3 * i, 0), (3, 1)).copy_from(&pose.wrench.fixed_rows::<3>(0));
        }
        let fit =
            least_squares(&design, &forces, None).map_err(|error| named(error, &["weight"], unknowns))?;
        let load = vector(&(&basis * fit.coefficients.rows(0, unknowns)));
        let length = load.norm();
        let bias = Vector3::from_fn(|i, _| fit.coefficients[(unknowns + i, 0)]);
        Ok(Self { fit, design, forces, basis, load, length, bias })
    }

    /// A weight that shows, and pulls down: along −z unless told otherwise.
    pub(super) fn checked(&self, down: Option<Vector3<f64>>, gravity: f64) -> Result<(), PayloadError> {
        let length = self.length;
        // As if all components were as noisy: what the torques say is not known yet.
        let direction = unit(&self.load).unwrap_or_else(Vector3::zeros);
        let parameter = self.basis.tr_mul(&direction);
        let unknowns = parameter.len();
        let spread = self.fit.inverse_gram.view((0, 0), (unknowns, unknowns));
        let variance = self.fit.residual_covariance[(0, 0)] * parameter.dot(&(spread * &parameter));
        let deviation = variance.max(0.0).sqrt();
        if !(length > 3.0 * deviation) {
            return Err(PayloadError::NoWeight { weight: length, deviation });
        }
        if self.load.dot(&down.unwrap_or_else(|| -Vector3::z())) < 0.0 {
            return Err(PayloadError::NegativeMass { mass: -length / gravity });
        }
        Ok(())
    }
}

/// What the torques tell, once the weight is known.
pub(super) struct Centre {
    fit: Fit,
    /// Poses to torques, of the centre along `span` and the bias.
    arms: DMatrix<f64>,
    torques: DMatrix<f64>,
    /// The directions in which the centre may lie, as columns.
    span: DMatrix<f64>,
    /// In the sensor frame \[m\].
    pub(super) of_mass: Vector3<f64>,
    pub(super) bias: Vector3<f64>,
}

impl Centre {
    /// On `axis`, if that is known.
    pub(super) fn of(
        poses: &[Pose],
        axis: Option<Vector3<f64>>,
        weight: &Weight,
    ) -> Result<Self, PayloadError> {
        let rows = 3 * poses.len();
        let span = basis_of(axis);
        let lengths = span.ncols();
        let mut arms = DMatrix::zeros(rows, lengths + 3);
        let mut torques = DMatrix::zeros(rows, 1);
        for (i, pose) in poses.iter().enumerate() {
            let pull = pose.base_from_sensor.transpose() * weight.load;
            arms.view_mut((3 * i, 0), (3, lengths)).copy_from(&(-pull.cross_matrix() * &span));
            arms.view_mut((3 * i, lengths), (3, 3)).fill_with_identity();
            torques.view_mut((3 * i, 0), (3, 1)).copy_from(&pose.wrench.fixed_rows::<3>(3));
        }
        let fit = least_squares(&arms, &torques, None)
            .map_err(|error| named(error, &["centre of mass"], lengths))?;
        let of_mass = vector(&(&span * fit.coefficients.rows(0, lengths)));
        let bias = Vector3::from_fn(|i, _| fit.coefficients[(lengths + i, 0)]);
        Ok(Self { fit, arms, torques, span, of_mass, bias })
    }
}

/// How sure weight and centre are.
pub(super) struct Sureness {
    noise: PoseNoise,
    /// Parameters: of the weight, three of the force at rest, of the centre, three of the torque at rest.
    basis: DMatrix<f64>,
    span: DMatrix<f64>,
}

impl Sureness {
    pub(super) fn of(poses: &[Pose], weight: &Weight, centre: &Centre) -> Result<Self, PayloadError> {
        let (unknowns, lengths) = (weight.basis.ncols(), centre.span.ncols());
        let (of_force, of_torque) = (unknowns + 3, lengths + 3);
        // By how much the torques would change with the weight, and what the fit makes of that.
        let mut change = DMatrix::zeros(3 * poses.len(), unknowns);
        for (i, pose) in poses.iter().enumerate() {
            let turned = pose.base_from_sensor.transpose() * &weight.basis;
            change.view_mut((3 * i, 0), (3, unknowns)).copy_from(&(centre.of_mass.cross_matrix() * turned));
        }
        let carried = least_squares(&centre.arms, &change, None)?.coefficients;
        let by_force = &weight.design * &weight.fit.inverse_gram;
        let by_torque = &centre.arms * &centre.fit.inverse_gram;
        let by_weight = by_force.columns(0, unknowns) * carried.transpose();
        let forces = &weight.forces - &weight.design * &weight.fit.coefficients;
        let torques = &centre.torques - &centre.arms * &centre.fit.coefficients;
        let (mut left, mut slopes, mut moves) = (Vec::new(), Vec::new(), Vec::new());
        for i in (0..3 * poses.len()).step_by(3) {
            left.push(Vector6::from_fn(|a, _| if a < 3 { forces[i + a] } else { torques[i + a - 3] }));
            let mut slope = DMatrix::zeros(6, of_force + of_torque);
            slope.view_mut((0, 0), (3, of_force)).copy_from(&weight.design.rows(i, 3));
            slope.view_mut((3, 0), (3, unknowns)).copy_from(&change.rows(i, 3));
            slope.view_mut((3, of_force), (3, of_torque)).copy_from(&centre.arms.rows(i, 3));
            slopes.push(slope);
            let mut by = DMatrix::zeros(6, of_force + of_torque);
            by.view_mut((0, 0), (3, of_force)).copy_from(&by_force.rows(i, 3));
            by.view_mut((0, of_force), (3, of_torque)).copy_from(&-by_weight.rows(i, 3));
            by.view_mut((3, of_force), (3, of_torque)).copy_from(&by_torque.rows(i, 3));
            moves.push(by);
        }
        let noise = PoseNoise::new(&left, &slopes, &moves);
        Ok(Self { noise, basis: weight.basis.clone(), span: centre.span.clone() })
    }

    /// Of parameters beginning at `first`, combined by `by`.
    fn combined(&self, first: usize, by: &[f64]) -> (f64, f64) {
        let count = self.basis.ncols() + self.span.ncols() + 6;
        let mut combination = DVector::zeros(count);
        combination.rows_mut(first, by.len()).copy_from_slice(by);
        self.noise.of(&combination)
    }

    /// Of the weight along a direction of the base: deviation \[N\] and freedom, as all below.
    pub(super) fn along(&self, direction: &Vector3<f64>) -> (f64, f64) {
        self.combined(0, self.basis.tr_mul(direction).as_slice())
    }

    /// Of a component of the force at rest \[N\].
    pub(super) fn force_at_rest(&self, axis: usize) -> (f64, f64) {
        self.combined(self.basis.ncols() + axis, &[1.0])
    }

    /// Of a component of the centre of mass \[m\].
    pub(super) fn centre(&self, axis: usize) -> (f64, f64) {
        let along: Vec<f64> = self.span.row(axis).iter().copied().collect();
        self.combined(self.basis.ncols() + 3, &along)
    }

    /// Of a component of the torque at rest \[N·m\].
    pub(super) fn torque_at_rest(&self, axis: usize) -> (f64, f64) {
        self.combined(self.basis.ncols() + self.span.ncols() + 3 + axis, &[1.0])
    }
}

/// The direction, or all three if none is known, as columns.
fn basis_of(direction: Option<Vector3<f64>>) -> DMatrix<f64> {
    direction.map_or_else(|| DMatrix::identity(3, 3), |one| DMatrix::from_column_slice(3, 1, one.as_slice()))
}

fn vector(matrix: &DMatrix<f64>) -> Vector3<f64> {
    Vector3::new(matrix[(0, 0)], matrix[(1, 0)], matrix[(2, 0)])
}
