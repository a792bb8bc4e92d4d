//! The columns of an accelerometer and a gyroscope.

use super::{Layout, UsedColumn};
use crate::column_name::{ColumnMeaning, ColumnName};
use crate::columns::of_sensor;
use crate::error::HeaderProblem;

impl Layout {
    /// The six columns of the inertial unit of a sensor, or of one without a name.
    pub(in super::super) fn find_inertial(&self, sensor: &str) -> Result<[UsedColumn; 6], HeaderProblem> {
        let parsed: Vec<ColumnName> = self.columns.iter().map(|name| ColumnName::parse(name)).collect();
        let is_inertial = |m: ColumnMeaning| {
            matches!(m, ColumnMeaning::Acceleration(..) | ColumnMeaning::AngularVelocity(..))
        };
        let has_own = parsed.iter().any(|name| is_inertial(name.meaning) && name.sensor == sensor);
        let owner = if has_own { sensor } else { "" };
        let mut found: [Option<UsedColumn>; 6] = [None; 6];
        for (column, name) in parsed.iter().enumerate().filter(|(_, name)| name.sensor == owner) {
            let (place, unit, example) = match name.meaning {
                ColumnMeaning::Acceleration(axis, unit) => (axis, unit, "m_per_s2"),
                ColumnMeaning::AngularVelocity(axis, unit) => (axis + 3, unit, "rad_per_s"),
                _ => continue,
            };
            let Some(scale) = unit else {
                let example = format!("{}_{example}", self.name(column));
                return Err(HeaderProblem::MissingUnit { column: self.name(column), example });
            };
            let Some(slot) = found.get_mut(place) else { continue };
            if let Some(first) = slot.replace(UsedColumn { column, scale, optional: false }) {
                return Err(self.duplicate(first.column, column));
            }
        }
        if let [Some(ax), Some(ay), Some(az), Some(wx), Some(wy), Some(wz)] = found {
            return Ok([ax, ay, az, wx, wy, wz]);
        }
        let names = ["ax", "ay", "az", "wx", "wy", "wz"].into_iter().zip(&found);
        let missing: Vec<&str> =
            names.filter_map(|(name, column)| column.is_none().then_some(name)).collect();
        Err(HeaderProblem::MissingInertial { sensor: of_sensor(owner), missing: missing.join(", ") })
    }
}
