//! Known loads on a sensor that carries something.

use super::{LoadError, LoadTable};
use crate::Axis;
use crate::file::PayloadFile;

impl LoadTable {
    /// The loads with the weight of what hangs on the sensor added, as it turns with the orientations:
    /// the loads that the sensor feels. Give the table as it was read, before any tare.
    ///
    /// With `tared`, what is added is the weight less its mean over the group's samples without load, for
    /// readings that [`tared_by_group`](Self::tared_by_group) took the zero off with the body on.
    ///
    /// # Errors
    /// [`LoadError::Empty`] without orientations, [`LoadError::NoZero`] as in taring,
    /// [`LoadError::NotFinite`] for a quaternion that is no orientation.
    pub fn carrying(&self, payload: &PayloadFile, tared: bool) -> Result<Self, LoadError> {
        let missing = LoadError::Empty { what: "orientations (columns qx, qy, qz, qw)" };
        let orientations = self.orientations.as_ref().ok_or(missing)?;
        let body =
            payload.payload::<f64>().map_err(|_| LoadError::Empty { what: "numbers in the payload" })?;
        let mut weights = Vec::with_capacity(self.samples());
        for (sample, orientation) in orientations.iter().enumerate() {
            let gravity = payload.gravity_at(*orientation).ok_or_else(|| LoadError::NotFinite {
                sample: self.names.get(sample).into_owned(),
                column: "qw".to_owned(),
            })?;
            weights.push(body.weight(&gravity).components());
        }
        let mut groups = self.groups.clone();
        groups.sort_unstable();
        groups.dedup();
        let mut loaded = self.clone();
        for group in groups {
            let of_group = || (0..self.samples()).filter(|i| self.groups[*i] == group);
            let unloaded: Vec<usize> =
                of_group().filter(|i| tared && self.loads.row(*i).amax() == 0.0).collect();
            if tared && unloaded.is_empty() {
                return Err(LoadError::NoZero { group });
            }
            for (j, axis) in self.axes.iter().enumerate() {
                let component = |i: usize| weights[i][Axis::index(*axis)];
                let zero = unloaded.iter().map(|i| component(*i)).sum::<f64>() / unloaded.len().max(1) as f64;
                of_group().for_each(|i| loaded.loads[(i, j)] += component(i) - zero);
            }
        }
        Ok(loaded)
    }
}

#[cfg(test)]
mod tests {
    use crate::file::PayloadFile;
    use crate::loads::{LoadError, LoadTable};
    use crate::testing::Largest as _;
    use nalgebra::Vector3;

    #[test]
    fn weight_is_added_as_it_turns() {
        let text = "fx_N,fz_N,ty_Nm,v1_V,qx,qy,qz,qw\n0,0,0,1,0,0,0,1\n0,1,0,1,0,0,0,1\n0,0,0,1,0,1,0,0\n1,0,0,1,1,0,0,0\n";
        let (table, ignored) = LoadTable::from_csv(text.as_bytes()).unwrap();
        assert!(ignored.is_empty());
        let payload =
            PayloadFile::new(0.1, Vector3::new(0.02, 0.0, 0.0), Vector3::new(0.0, 0.0, -10.0)).unwrap();
        let loads = table.carrying(&payload, false).unwrap().loads;
        // Upright, −1 N along z and (0.02, 0, 0) × (0, 0, −1) = 0.02 N·m about y; then upside down.
        let expected = [[0.0, -1.0, 0.02], [0.0, 0.0, 0.02], [0.0, 1.0, -0.02], [1.0, 1.0, -0.02]];
        for (i, row) in expected.iter().enumerate() {
            for (j, value) in row.iter().enumerate() {
                assert!((loads[(i, j)] - value).abs() < 1e-15, "{loads}");
            }
        }
        // Tared with the body on, in the mean of rows 1 and 3: zero.
        assert!((table.carrying(&payload, true).unwrap().loads - loads).largest() < 1e-15);
        // Loaded in the same pose twice: what the unloaded rows weigh is taken off, no more.
        let upright =
            LoadTable::from_csv(text.replace("1,0,0,1,1,0,0,0", "1,0,0,1,0,0,0,1").as_bytes()).unwrap().0;
        let tared = upright.carrying(&payload, true).unwrap().loads;
        assert!((tared - upright.carrying(&payload, false).unwrap().loads).largest() < 1e-15);
        // Each group is tared by its own unloaded rows: upright in the first, the mean of upright and on its side in
        // the second, where the weight is (-1, 0, 0) N and no torque about y.
        let text = "fx_N,fz_N,ty_Nm,v1_V,qx,qy,qz,qw,group\n0,0,0,1,0,0,0,1,1\n0,0,0,1,0,0,0,1,1\n0,1,0,1,0,1,0,0,1\n0,0,0,1,0,0,0,1,2\n0,0,0,1,0,-0.7071067811865476,0,0.7071067811865476,2\n2,0,0,1,0,0,0,1,2\n";
        let groups = LoadTable::from_csv(text.as_bytes()).unwrap().0;
        let tared = groups.carrying(&payload, true).unwrap().loads;
        let expected =
            [[0.0; 3], [0.0; 3], [0.0, 3.0, -0.04], [0.5, -0.5, 0.01], [-0.5, 0.5, -0.01], [2.5, -0.5, 0.01]];
        for (i, row) in expected.iter().enumerate() {
            for (j, value) in row.iter().enumerate() {
                assert!((tared[(i, j)] - value).abs() < 1e-15, "{tared}");
            }
        }
        let mut bare = table;
        bare.orientations = None;
        assert!(matches!(bare.carrying(&payload, false), Err(LoadError::Empty { .. })));
        let few = text.replace(",qw", ",q");
        assert!(LoadTable::from_csv(few.as_bytes()).unwrap_err().to_string().contains("qx, qy, qz"));
    }
}
