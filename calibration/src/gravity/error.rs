//! What can be wrong with poses.

use thiserror::Error;

use crate::fit::FitError;

/// Why poses do not tell the payload.
///
/// ```
/// # use fingertip_calibration::gravity::Pose;
/// # use fingertip_calibration::nalgebra::{Vector3, Vector6};
/// # // 0.4 kg, 50 mm above the sensor, in eight poses; the sensor reads 0.2 N along x without load.
/// # let mut poses = Vec::new();
/// # let turns = [[1, 0, 0, 0], [0, 1, 0, 0], [1, 0, 0, 1], [0, 1, 0, 1], [0, 0, 1, 1], [1, 1, 0, 1], [1, 0, 2, 1]];
/// # for xyzw in [[0, 0, 0, 1]].into_iter().chain(turns) {
/// #     let mut pose = Pose::from_quaternion(xyzw.map(f64::from), Vector6::zeros()).ok_or("no quaternion")?;
/// #     let weight = pose.base_from_sensor.transpose() * Vector3::new(0.0, 0.0, -0.4 * 9.81);
/// #     pose.wrench = fingertip_wrench::Wrench::<f64>::from_force_at(&(Vector3::z() * 0.05), weight).components();
/// #     pose.wrench.x += 0.2;
/// #     poses.push(pose);
/// # }
/// # let mut poses = poses;
/// use fingertip_calibration::gravity::{PayloadError, PayloadOptions, fit_payload};
///
/// // The readings are what the sensor does to the world: the weight points up.
/// poses.iter_mut().for_each(|pose| pose.wrench *= -1.0);
/// let error = fit_payload(&poses, &PayloadOptions::default()).unwrap_err();
/// assert!(matches!(error, PayloadError::NegativeMass { mass } if (mass + 0.4).abs() < 1e-3));
/// # Ok::<(), &str>(())
/// ```
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum PayloadError {
    /// The poses do not determine it, or a number is not finite.
    #[error(transparent)]
    Fit(#[from] FitError),
    /// A direction of the options is zero.
    #[error("the {0} has no direction")]
    NoDirection(&'static str),
    /// The fitted weight pulls upward: the readings have the opposite sign, or are in another frame.
    #[error(
        "the mass would be {mass:.4} kg: the readings are those of the reaction (opposite sign), or in another \
         frame than said"
    )]
    NegativeMass {
        /// The mass as fitted \[kg\].
        mass: f64,
    },
    /// No weight stands out of the errors, so that no centre of mass can be told.
    #[error("the weight of {weight:.3} N does not stand out of its error of {deviation:.3} N")]
    NoWeight {
        /// The weight as fitted \[N\].
        weight: f64,
        /// Its standard deviation \[N\].
        deviation: f64,
    },
}

/// Names the unknowns in an error.
pub(super) fn named(error: FitError, stems: &[&str], unknowns: usize) -> PayloadError {
    let FitError::Unobserved(mut unobserved) = error else { return error.into() };
    for stem in stems {
        if unknowns == 1 {
            unobserved.names.push((*stem).to_owned());
        } else {
            unobserved.names.extend(["x", "y", "z"].map(|axis| format!("{stem} {axis}")));
        }
    }
    unobserved.names.extend(["x", "y", "z"].map(|axis| format!("bias {axis}")));
    FitError::Unobserved(unobserved).into()
}
