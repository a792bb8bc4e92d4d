//! The two least-squares problems behind a payload: forces give the weight, torques the centre of mass.

use nalgebra::{DMatrix, Vector3};

use super::error::{PayloadError, named};
use super::poses::{Pose, unit};
use crate::fit::{Fit, least_squares};

/// What the forces tell.
pub(super) struct Weight {
    pub(super) fit: Fit,
    /// Poses to forces, of the weight along `basis` and the bias.
    pub(super) design: DMatrix<f64>,
    pub(super) forces: DMatrix<f64>,
    /// The directions in which the weight may lie, as columns.
    pub(super) basis: DMatrix<f64>,
    /// Weight in the base frame \[N\].
    pub(super) load: Vector3<f64>,
    pub(super) length: f64,
    pub(super) bias: Vector3<f64>,
}

impl Weight {
    /// Along `down`, if that is known; the components of the force count as `weights` say.
    pub(super) fn of(
        poses: &[Pose],
        down: Option<Vector3<f64>>,
        weights: &Vector3<f64>,
    ) -> Result<Self, PayloadError> {
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
        let fit = least_squares(&design, &forces, Some(&weights.as_slice().repeat(poses.len())))
            .map_err(|error| named(error, &["weight"], unknowns))?;
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
    pub(super) fit: Fit,
    /// Poses to torques, of the centre along `span` and the bias.
    pub(super) arms: DMatrix<f64>,
    pub(super) torques: DMatrix<f64>,
    /// The directions in which the centre may lie, as columns.
    pub(super) span: DMatrix<f64>,
    /// In the sensor frame \[m\].
    pub(super) of_mass: Vector3<f64>,
    pub(super) bias: Vector3<f64>,
}

impl Centre {
    /// On `axis`, if that is known; the components of the torque count as `weights` say.
    pub(super) fn of(
        poses: &[Pose],
        axis: Option<Vector3<f64>>,
        weight: &Weight,
        weights: &Vector3<f64>,
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
        let fit = least_squares(&arms, &torques, Some(&weights.as_slice().repeat(poses.len())))
            .map_err(|error| named(error, &["centre of mass"], lengths))?;
        let of_mass = vector(&(&span * fit.coefficients.rows(0, lengths)));
        let bias = Vector3::from_fn(|i, _| fit.coefficients[(lengths + i, 0)]);
        Ok(Self { fit, arms, torques, span, of_mass, bias })
    }
}

/// The direction, or all three if none is known, as columns.
fn basis_of(direction: Option<Vector3<f64>>) -> DMatrix<f64> {
    direction.map_or_else(|| DMatrix::identity(3, 3), |one| DMatrix::from_column_slice(3, 1, one.as_slice()))
}

fn vector(matrix: &DMatrix<f64>) -> Vector3<f64> {
    Vector3::new(matrix[(0, 0)], matrix[(1, 0)], matrix[(2, 0)])
}
