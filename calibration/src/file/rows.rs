//! Matrices as lists of rows.

use nalgebra::DMatrix;
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

pub(crate) fn serialize<S: Serializer>(matrix: &DMatrix<f64>, serializer: S) -> Result<S::Ok, S::Error> {
    let rows: Vec<Vec<f64>> = matrix.row_iter().map(|row| row.iter().copied().collect()).collect();
    rows.serialize(serializer)
}

pub(crate) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<DMatrix<f64>, D::Error> {
    let rows = Vec::<Vec<f64>>::deserialize(deserializer)?;
    let columns = rows.first().map_or(0, Vec::len);
    if let Some(bad) = rows.iter().position(|row| row.len() != columns) {
        return Err(D::Error::custom(format!(
            "row {bad} of the matrix has {} entries, row 0 has {columns}",
            rows[bad].len()
        )));
    }
    Ok(DMatrix::from_fn(rows.len(), columns, |i, j| rows[i][j]))
}

/// The same for a matrix that may be absent.
pub(super) mod optional {
    use nalgebra::DMatrix;
    use serde::{Deserializer, Serializer};

    pub(in super::super) fn serialize<S: Serializer>(
        matrix: &Option<DMatrix<f64>>,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        match matrix {
            Some(matrix) => super::serialize(matrix, serializer),
            None => serializer.serialize_none(),
        }
    }

    pub(in super::super) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Option<DMatrix<f64>>, D::Error> {
        super::deserialize(deserializer).map(Some)
    }
}
