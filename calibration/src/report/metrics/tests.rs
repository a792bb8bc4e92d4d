//! What the covariance of a fit makes one expect of lines of action.

use nalgebra::{DMatrix, Matrix6, SVector, Vector3};

use super::lines;
use crate::Axis;
use crate::file::SignalUnit;
use crate::loads::LoadTable;

/// A force along y whose line passes 10 mm above the origin, read without an error.
#[test]
fn an_error_of_the_force_moves_the_line_only_if_the_torque_does_not_go_along() {
    let (force, above) = (8.0, 0.01);
    let load = DMatrix::from_row_slice(1, 6, &[0.0, force, 0.0, -above * force, 0.0, 0.0]);
    let table = LoadTable::new(&Axis::ALL, load.clone(), load.clone(), SignalUnit::Wrench).unwrap();
    let expected = |covariance: Matrix6<f64>| {
        let covariance = DMatrix::from_fn(6, 6, |i, j| covariance[(i, j)]);
        lines(&table, &[10.0; 6], &load, |_| Some(covariance.clone())).unwrap().expected_mm.unwrap()
    };
    // Forces of a deviation of 0.1 N along each axis, at the same point: the line passes through it still.
    let at_the_point = (0..3).fold(Matrix6::zeros(), |sum, axis| {
        let off = Vector3::ith(axis, 0.1);
        let moment = Vector3::new(0.0, 0.0, above).cross(&off);
        let both = SVector::<f64, 6>::from_iterator(off.iter().chain(&moment).copied());
        sum + both * both.transpose()
    });
    assert!(expected(at_the_point) < 1e-6);
    // Of a force that alone is off along itself, the line is off by the same share of its distance: half of a normal
    // distribution is within 0.6745 deviations.
    let mut along = Matrix6::zeros();
    along[(1, 1)] = 0.1 * 0.1;
    let half = 0.6745 * 1e3 * above * 0.1 / force;
    assert!((expected(along) / half - 1.0).abs() < 0.02, "{} {half}", expected(along));
}
