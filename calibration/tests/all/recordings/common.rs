//! The recordings of others that tests use where they are present.

use std::path::PathBuf;

use fingertip_calibration::nalgebra::DMatrix;

/// A CSV file as its header and rows of text.
pub(crate) fn csv(path: &PathBuf) -> (Vec<String>, Vec<Vec<String>>) {
    let text = std::fs::read_to_string(path).unwrap();
    let mut lines = text.lines().map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
    (lines.next().unwrap(), lines.collect())
}

/// Column `name` of a table as numbers.
pub(crate) fn column(table: &(Vec<String>, Vec<Vec<String>>), name: &str) -> Vec<f64> {
    let index =
        table.0.iter().position(|column| column == name).unwrap_or_else(|| panic!("no column {name}"));
    table
        .1
        .iter()
        .map(|row| row[index].parse().unwrap_or_else(|_| panic!("{name}: {:?}", row[index])))
        .collect()
}

/// Columns side by side.
pub(crate) fn columns(table: &(Vec<String>, Vec<Vec<String>>), names: &[&str]) -> DMatrix<f64> {
    let columns: Vec<f64> = names.iter().flat_map(|name| column(table, name)).collect();
    DMatrix::from_vec(table.1.len(), names.len(), columns)
}
