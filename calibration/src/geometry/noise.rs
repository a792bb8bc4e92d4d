//! What the wrenches of touches are wrong by.

use nalgebra::{Matrix3, Matrix6};

use super::GeometryError;

/// The covariance of the errors of one wrench, forces and torques, for all touches alike.
///
/// It counts in its shape: how large the errors are together is taken from what a fit leaves
/// ([`Fitted::noise_scale`](super::Fitted::noise_scale)). Forces that are taken as exact make radii too small
/// where they are not: the error of a force is error of what it is compared with.
///
/// ```
/// # use fingertip_calibration::geometry::ShapeTouch;
/// # use fingertip_calibration::nalgebra::Vector3;
/// # use fingertip_wrench::Wrench;
/// # // 2 N inward and 0.5 N aside, at forty places of an ellipsoid.
/// # let touched = |semi_axes: Vector3<f64>, centre: Vector3<f64>| -> Vec<ShapeTouch> {
/// #     let touch = |k: i32| {
/// #         let (around, up) = (2.4 * f64::from(k), f64::from(k - 15) / 25.0);
/// #         let normal = Vector3::new(around.cos(), around.sin(), up).normalize();
/// #         let squared = semi_axes.component_mul(&semi_axes).component_mul(&normal);
/// #         let point = centre + squared / squared.dot(&normal).sqrt();
/// #         let aside = normal.cross(&Vector3::new(0.3, f64::from(k).sin(), 0.8)).normalize() * 0.5;
/// #         ShapeTouch { wrench: Wrench::from_force_at(&point, aside - normal * 2.0), normal }
/// #     };
/// #     (0..40).map(touch).collect()
/// # };
/// use fingertip_calibration::geometry::{WrenchNoise, fit_sphere};
/// use fingertip_calibration::nalgebra::{Matrix6, Vector6};
///
/// // 10 mN on each force and 0.1 N·mm on each torque, and the same as a covariance.
/// let noise = WrenchNoise::new(0.01, 1e-4)?;
/// let covariance = Matrix6::from_diagonal(&Vector6::new(1e-4, 1e-4, 1e-4, 1e-8, 1e-8, 1e-8));
/// let touches = touched(Vector3::repeat(0.012), Vector3::zeros());
/// let one = fit_sphere(&touches, &noise)?.shape.radius();
/// let other = fit_sphere(&touches, &WrenchNoise::with_covariance(&covariance)?)?.shape.radius();
/// assert!((one - 0.012).abs() < 1e-6 && (one - other).abs() < 1e-9);
/// # Ok::<(), fingertip_calibration::geometry::GeometryError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrenchNoise {
    pub(super) forces: Matrix3<f64>,
    /// Covariance of forces (rows) with torques (columns).
    pub(super) mixed: Matrix3<f64>,
    pub(super) torques: Matrix3<f64>,
}

impl WrenchNoise {
    /// Forces without error, torques with equal ones on all axes: plain least squares of the torques.
    #[must_use]
    pub fn exact_forces() -> Self {
        Self { forces: Matrix3::zeros(), mixed: Matrix3::zeros(), torques: Matrix3::identity() }
    }

    /// Independent errors of these standard deviations on each axis of force \[N\] and torque \[N·m\].
    ///
    /// # Errors
    /// [`GeometryError::BadNoise`] unless the first is finite and not negative, the second finite and positive.
    pub fn new(force: f64, torque: f64) -> Result<Self, GeometryError> {
        if !(force >= 0.0 && torque > 0.0) {
            return Err(GeometryError::BadNoise);
        }
        let diagonal = [force, force, force, torque, torque, torque].map(|deviation| deviation * deviation);
        Self::with_covariance(&Matrix6::from_diagonal(&diagonal.into()))
    }

    /// Errors of this covariance, force before torque \[N², N²·m, N²·m²\], such as that of a calibration.
    ///
    /// # Errors
    /// [`GeometryError::BadNoise`] for a matrix that is not finite, not symmetric or not positive definite (forces
    /// may be exact: rows and columns of zeros).
    pub fn with_covariance(covariance: &Matrix6<f64>) -> Result<Self, GeometryError> {
        let deviations = covariance.diagonal().map(f64::sqrt);
        // In units of each axis' own deviation, so that newtons do not hide newton metres.
        let scaled = Matrix6::from_fn(|i, j| {
            let size = deviations[i] * deviations[j];
            if size > 0.0 { covariance[(i, j)] / size } else { covariance[(i, j)] }
        });
        let block = |i, j| covariance.fixed_view::<3, 3>(i, j).into_owned();
        let symmetric = (scaled - scaled.transpose()).amax() <= 1e-9;
        let finite = scaled.iter().chain(covariance.iter()).all(|x| x.is_finite());
        let rounding = 64.0 * f64::EPSILON;
        let torques = scaled.fixed_view::<3, 3>(3, 3).into_owned();
        let positive = finite
            && scaled.symmetric_eigenvalues().min() >= -rounding
            && torques.symmetric_eigenvalues().min() > rounding
            && deviations.fixed_rows::<3>(3).min() > 0.0;
        if !(symmetric && positive) {
            return Err(GeometryError::BadNoise);
        }
        Ok(Self { forces: block(0, 0), mixed: block(0, 3), torques: block(3, 3) })
    }

    /// The same with exact forces: where a search begins, since forces that are adjusted to a wrong shape lead
    /// astray.
    pub(super) fn without_forces(&self) -> Self {
        Self { forces: Matrix3::zeros(), mixed: Matrix3::zeros(), ..*self }
    }

    /// `true` if forces are exact.
    pub(super) fn forces_are_exact(&self) -> bool {
        self.forces.amax() == 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::WrenchNoise;
    use crate::geometry::GeometryError;
    use nalgebra::Matrix6;

    #[test]
    fn what_is_no_covariance_is_refused() {
        assert!(WrenchNoise::new(0.0, 1e-4).unwrap().forces_are_exact());
        let good = WrenchNoise::new(0.02, 1e-4).unwrap();
        assert!((good.forces[(1, 1)] - 4e-4).abs() < 1e-18 && (good.torques[(2, 2)] - 1e-8).abs() < 1e-22);
        for (force, torque) in
            [(-1.0, 1.0), (1.0, 0.0), (f64::NAN, 1.0), (1.0, f64::NAN), (f64::INFINITY, 1.0)]
        {
            assert_eq!(WrenchNoise::new(force, torque).unwrap_err(), GeometryError::BadNoise);
        }
        let mut skew = Matrix6::identity();
        skew[(0, 4)] = 0.5;
        let mut indefinite = Matrix6::identity();
        (indefinite[(0, 4)], indefinite[(4, 0)]) = (1.5, 1.5);
        let mut mute = Matrix6::identity();
        mute[(5, 5)] = 0.0;
        for bad in [skew, indefinite, mute, -Matrix6::identity(), Matrix6::repeat(f64::NAN)] {
            assert_eq!(WrenchNoise::with_covariance(&bad).unwrap_err(), GeometryError::BadNoise);
        }
        // However small the noise: two components that go together by more than all, or one way only.
        let quiet = Matrix6::from_diagonal_element(1e-10);
        for (there, back) in [(1.0 + 1e-6, 1.0 + 1e-6), (0.5, 0.5 + 1e-6)] {
            let mut bad = quiet;
            (bad[(0, 1)], bad[(1, 0)]) = (there * 1e-10, back * 1e-10);
            assert_eq!(WrenchNoise::with_covariance(&bad).unwrap_err(), GeometryError::BadNoise, "{there}");
        }
        let mut related = Matrix6::from_diagonal_element(1e-4);
        (related[(0, 4)], related[(4, 0)]) = (5e-5, 5e-5);
        assert_eq!(WrenchNoise::with_covariance(&related).unwrap().mixed[(0, 1)], 5e-5);
    }
}
