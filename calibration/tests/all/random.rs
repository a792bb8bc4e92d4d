//! Random sensors, loads and noise.

use fingertip_calibration::nalgebra::{DMatrix, Matrix3, Quaternion, UnitQuaternion, Vector3};
use rand_distr::{Distribution as _, StandardNormal};
use rand_pcg::Pcg64Mcg;

pub(crate) fn gaussian(random: &mut Pcg64Mcg) -> f64 {
    StandardNormal.sample(random)
}

pub(crate) fn gaussians(random: &mut Pcg64Mcg, rows: usize, columns: usize) -> DMatrix<f64> {
    DMatrix::from_fn(rows, columns, |_, _| gaussian(random))
}

pub(crate) fn vector(random: &mut Pcg64Mcg) -> Vector3<f64> {
    Vector3::from_fn(|_, _| gaussian(random))
}

/// Well-conditioned coefficients: twice the identity with some cross-talk.
pub(crate) fn sensor(random: &mut Pcg64Mcg, regressors: usize, responses: usize) -> DMatrix<f64> {
    DMatrix::from_fn(regressors, responses, |i, j| {
        (if i == j { 2.0 } else { 0.0 }) + 0.2 * gaussian(random).clamp(-2.0, 2.0)
    })
}

/// Any turn as likely as any other.
pub(crate) fn turn(random: &mut Pcg64Mcg) -> Matrix3<f64> {
    let q = Quaternion::new(gaussian(random), gaussian(random), gaussian(random), gaussian(random));
    UnitQuaternion::from_quaternion(q).to_rotation_matrix().into_inner()
}
