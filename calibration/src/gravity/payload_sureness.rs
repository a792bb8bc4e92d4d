//! How sure a payload is.

use nalgebra::{DMatrix, DVector, Vector3, Vector6};

use super::payload_parts::{Centre, Weight};
use super::pose_noise::{Besides, Doubt, PoseNoise};
use super::poses::Pose;

/// How sure weight and centre are.
pub(super) struct Sureness {
    noise: PoseNoise,
    /// Parameters: of the weight, three of the force at rest, of the centre, three of the torque at rest.
    basis: DMatrix<f64>,
    span: DMatrix<f64>,
}

impl Sureness {
    /// Of fits in which the components of forces and torques counted as `weights` say, with these doubts.
    pub(super) fn of(
        poses: &[Pose],
        weight: &Weight,
        centre: &Centre,
        weights: &Vector6<f64>,
        doubts: &[Doubt],
    ) -> Self {
        let unknowns = weight.basis.ncols();
        // By how much the torques would change with the weight.
        let mut change = DMatrix::zeros(3 * poses.len(), unknowns);
        for (i, pose) in poses.iter().enumerate() {
            let turned = pose.base_from_sensor.transpose() * &weight.basis;
            change.view_mut((3 * i, 0), (3, unknowns)).copy_from(&(centre.of_mass.cross_matrix() * turned));
        }
        let forces = &weight.forces - &weight.design * &weight.fit.coefficients;
        let torques = &centre.torques - &centre.arms * &centre.fit.coefficients;
        let left: Vec<_> = (0..forces.len())
            .step_by(3)
            .map(|i| Vector6::from_fn(|a, _| if a < 3 { forces[i + a] } else { torques[i + a - 3] }))
            .collect();
        let of_kind = |first: usize| weights.fixed_rows::<3>(first).into_owned();
        let by_force = moves(&weight.design, &weight.fit.inverse_gram, &of_kind(0));
        let by_torque = moves(&centre.arms, &centre.fit.inverse_gram, &of_kind(3));
        // The fit of the torques takes the weight from the forces.
        let carried = |by_force: &DMatrix<f64>, by_torque: &DMatrix<f64>| {
            -by_force.columns(0, unknowns) * change.tr_mul(by_torque)
        };
        let slopes = joined(
            &weight.design,
            &DMatrix::zeros(change.nrows(), centre.arms.ncols()),
            &centre.arms,
            Some(&change),
        );
        let both = joined(&by_force, &carried(&by_force, &by_torque), &by_torque, None);
        let besides = doubts.iter().map(|doubt| {
            let along = |first: usize| doubt.direction.fixed_rows::<3>(first).into_owned();
            let of_force = moved(&weight.design, &by_force, &along(0));
            let of_torque = moved(&centre.arms, &by_torque, &along(3));
            let across = carried(&of_force, &by_torque) + carried(&by_force, &of_torque);
            Besides { changes: joined(&of_force, &across, &of_torque, None), variance: doubt.variance }
        });
        let noise = PoseNoise::new(&left, &slopes, &both, besides);
        Self { noise, basis: weight.basis.clone(), span: centre.span.clone() }
    }

    /// What each component should count, and what is not sure of that.
    pub(super) fn weights(&self) -> (Vector6<f64>, Vec<Doubt>) {
        self.noise.weights()
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

/// By how much each reading moves the parameters of a weighted fit, rows as in the design X: `W X (Xᵀ W X)⁻¹`.
fn moves(design: &DMatrix<f64>, inverse_gram: &DMatrix<f64>, weights: &Vector3<f64>) -> DMatrix<f64> {
    let mut moves = design * inverse_gram;
    moves.row_iter_mut().enumerate().for_each(|(row, mut by)| by *= weights[row % 3]);
    moves
}

/// The change of these moves P as the logarithms of the weights change along a direction: `P_u − P Xᵀ P_u`, where the rows
/// of `P_u` are those of P times the change of their component.
fn moved(design: &DMatrix<f64>, moves: &DMatrix<f64>, direction: &Vector3<f64>) -> DMatrix<f64> {
    let mut own = moves.clone();
    own.row_iter_mut().enumerate().for_each(|(row, mut by)| by *= direction[row % 3]);
    &own - moves * design.tr_mul(&own)
}

/// Six rows a pose, of three of forces and three of torques, each by the parameters of forces and of torques; `across` of
/// the forces by the parameters of torques, `change` of the torques by the first parameters.
fn joined(
    forces: &DMatrix<f64>,
    across: &DMatrix<f64>,
    torques: &DMatrix<f64>,
    change: Option<&DMatrix<f64>>,
) -> Vec<DMatrix<f64>> {
    let (of_force, of_torque) = (forces.ncols(), torques.ncols());
    (0..forces.nrows())
        .step_by(3)
        .map(|i| {
            let mut both = DMatrix::zeros(6, of_force + of_torque);
            both.view_mut((0, 0), (3, of_force)).copy_from(&forces.rows(i, 3));
            both.view_mut((0, of_force), (3, of_torque)).copy_from(&across.rows(i, 3));
            both.view_mut((3, of_force), (3, of_torque)).copy_from(&torques.rows(i, 3));
            if let Some(change) = change {
                both.view_mut((3, 0), (3, change.ncols())).copy_from(&change.rows(i, 3));
            }
            both
        })
        .collect()
}
