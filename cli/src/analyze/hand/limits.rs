//! What the fingers of a hand scene can give.

use fingertip::hand::{BadLimit, FingerLimits};
use fingertip_recordings::{NumberColumn, Row};
use nalgebra::Vector6;

use crate::opened::Rows;

/// Most joints of a finger.
const JOINTS: usize = 6;
/// Half-spaces that limit a finger: of its least and its greatest normal force, and two of each joint.
pub(super) const ROWS: usize = 2 + 2 * JOINTS;

/// The keys of `[[finger]]` that say what it can give.
pub(super) struct LimitKeys {
    pub(super) least_normal: Option<f64>,
    pub(super) greatest_normal: Option<f64>,
    pub(super) cost: Option<f64>,
    pub(super) torques: Vec<f64>,
    pub(super) jacobian: Option<Vec<[f64; 6]>>,
    pub(super) jacobian_columns: Option<String>,
}

/// What a finger can give, of which joints may turn.
pub(super) struct Limits {
    /// All of it where the Jacobian is fixed, else the normal forces and the cost.
    fixed: FingerLimits<f64, ROWS>,
    torques: Vec<f64>,
    /// The prefix of the columns of the Jacobian, where it is in columns.
    columns: Option<String>,
}

impl LimitKeys {
    /// What is wrong is said with the key.
    pub(super) fn check(self) -> Result<Limits, String> {
        let Self { least_normal, greatest_normal, cost, torques, jacobian, jacobian_columns } = self;
        let told = |key: &'static str| move |error: BadLimit| format!("`{key}`: {error}");
        let mut limits = FingerLimits::none();
        if let Some(newtons) = greatest_normal {
            limits = limits.with_greatest_normal(newtons).map_err(told("greatest_normal_N"))?;
        }
        if let Some(newtons) = least_normal {
            limits = limits.with_least_normal(newtons).map_err(told("least_normal_N"))?;
        }
        if let Some(cost) = cost {
            limits = limits.with_cost(cost).map_err(told("cost"))?;
        }
        if torques.len() > JOINTS {
            return Err(format!(
                "`greatest_torques_Nm` has {} numbers; a finger has {JOINTS} joints at most",
                torques.len()
            ));
        }
        let columns = match (jacobian, jacobian_columns) {
            (Some(_), Some(_)) => {
                return Err(
                    "its Jacobian is either fixed or in columns; leave `jacobian` or `jacobian_columns` out"
                        .to_owned(),
                );
            }
            (Some(columns), None) => {
                if columns.len() != torques.len() {
                    return Err(format!(
                        "`jacobian` has {} columns, and `greatest_torques_Nm` {} numbers; give one of each for every joint",
                        columns.len(),
                        torques.len()
                    ));
                }
                limits = jointed(limits, &columns, &torques).map_err(told("jacobian"))?;
                None
            }
            (None, columns) => {
                if columns.is_some() == torques.is_empty() {
                    return Err(
                        "`greatest_torques_Nm` and a Jacobian (`jacobian`, `jacobian_columns`) go together"
                            .to_owned(),
                    );
                }
                // The torques are checked here, the Jacobian as it comes.
                jointed(limits, &vec![[0.0; 6]; torques.len()], &torques)
                    .map_err(told("greatest_torques_Nm"))?;
                columns
            }
        };
        Ok(Limits { fixed: limits, torques, columns })
    }
}

fn jointed(
    limits: FingerLimits<f64, ROWS>,
    columns: &[[f64; 6]],
    torques: &[f64],
) -> Result<FingerLimits<f64, ROWS>, BadLimit> {
    let mut joints = columns.iter().zip(torques);
    joints.try_fold(limits, |limits, (column, torque)| limits.with_joint(&Vector6::from(*column), *torque))
}

/// What a column of a Jacobian is told by, behind the prefix of its columns and the number of the joint.
const PARTS: [&str; 6] = ["vx", "vy", "vz", "wx", "wy", "wz"];

/// The columns of a Jacobian in a recording.
pub(super) struct JacobianColumns(Vec<[NumberColumn; 6]>);

impl Limits {
    /// The names of the columns of the Jacobian; none where it is fixed.
    pub(super) fn names(&self) -> Vec<String> {
        let Some(prefix) = &self.columns else { return Vec::new() };
        let joints = 1..=self.torques.len();
        joints.flat_map(|joint| PARTS.map(|part| format!("{prefix}_{joint}_{part}"))).collect()
    }

    /// Its columns in a recording; `None` if one is not there.
    pub(super) fn columns(&self, reader: &mut Rows) -> Option<JacobianColumns> {
        let names = self.names();
        let of_joint = |names: &[String]| {
            let columns: Option<Vec<_>> = names.iter().map(|name| reader.watch(name)).collect();
            columns?.try_into().ok()
        };
        names.chunks(PARTS.len()).map(of_joint).collect::<Option<Vec<_>>>().map(JacobianColumns)
    }

    /// The limits in a row; `None` if a number of the Jacobian is missing or none.
    pub(super) fn at(&self, columns: &JacobianColumns, row: &Row<'_>) -> Option<FingerLimits<f64, ROWS>> {
        let mut limits = self.fixed;
        for (joint, torque) in columns.0.iter().zip(&self.torques) {
            let mut column = [0.0; 6];
            for (number, place) in column.iter_mut().zip(joint) {
                *number = row.number(place)?;
            }
            limits = limits.with_joint(&Vector6::from(column), *torque).ok()?;
        }
        Some(limits)
    }
}
