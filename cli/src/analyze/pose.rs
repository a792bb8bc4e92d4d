//! Where a sensor is at each row.

use fingertip::wrench::{Frame, RigidTransform};
use fingertip_recordings::{NumberColumn, Row};
use nalgebra::Vector3;

use crate::opened::Rows;

/// What a pose is told by, behind the prefix of its columns.
const PARTS: [&str; 7] = ["x_m", "y_m", "z_m", "qw", "qx", "qy", "qz"];

/// The columns that tell where a sensor is.
pub(super) struct PoseColumns([NumberColumn; 7]);

impl PoseColumns {
    pub(super) fn names(prefix: &str) -> [String; 7] {
        PARTS.map(|part| format!("{prefix}_{part}"))
    }

    /// `None` if one is not there.
    pub(super) fn of(prefix: &str, reader: &mut Rows) -> Option<Self> {
        let columns = Self::names(prefix).map(|name| reader.watch(&name));
        let [Some(x), Some(y), Some(z), Some(qw), Some(qx), Some(qy), Some(qz)] = columns else {
            return None;
        };
        Some(Self([x, y, z, qw, qx, qy, qz]))
    }

    /// The pose in a row; `None` if a number is missing or the quaternion is none.
    pub(super) fn read<To: Frame, From: Frame>(
        &self,
        row: &Row<'_>,
    ) -> Option<RigidTransform<f64, To, From>> {
        let mut numbers = [0.0; 7];
        for (number, column) in numbers.iter_mut().zip(&self.0) {
            *number = row.number(column)?;
        }
        let [x, y, z, wxyz @ ..] = numbers;
        RigidTransform::from_quaternion(wxyz, Vector3::new(x, y, z)).ok()
    }
}
