//! How a sensor sits on its flange.

use fingertip_wrench::units::STANDARD_GRAVITY;
use nalgebra::{DMatrix, Matrix3, Vector3};

use super::error::{PayloadError, named};
use super::poses::{Pose, unit};
use crate::fit::{Fit, FitError, least_squares};
use crate::linear::Singular;

/// A sensor's orientation on its flange, and the weight it carries.
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
/// use fingertip_calibration::gravity::{Orientation, fit_orientation};
/// use fingertip_calibration::nalgebra::Rotation3;
///
/// // The poses are those of the flange, on which the sensor sits turned by 30° about z.
/// let mounted = Rotation3::from_axis_angle(&Vector3::z_axis(), 30.0_f64.to_radians());
/// let of_flange: Vec<Pose> = poses
///     .iter()
///     .map(|pose| Pose { base_from_sensor: pose.base_from_sensor * mounted.matrix(), ..*pose })
///     .collect();
/// let found: Orientation = fit_orientation(&of_flange, &-Vector3::z())?;
/// assert!((found.sensor_from_flange - mounted.matrix()).norm() < 1e-6 && (found.weight - 0.4 * 9.81).abs() < 1e-6);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orientation {
    /// Columns are the axes of the flange in the sensor frame.
    pub sensor_from_flange: Matrix3<f64>,
    /// Weight of what is carried \[N\].
    pub weight: f64,
    /// Force that the sensor reads without load \[N\].
    pub force_bias: Vector3<f64>,
    /// Standard deviations of the orientation, as turns about the axes of the sensor \[rad\].
    pub turn_deviation: Vector3<f64>,
    /// Standard deviation of the weight \[N\].
    pub weight_deviation: f64,
    /// Standard deviations of the force without load \[N\].
    pub bias_deviation: Vector3<f64>,
    /// Degrees of freedom behind the deviations of the turns, the weight and the force without load: an interval is a
    /// deviation times [`student_factor`](crate::fit::student_factor) of its own.
    pub freedom: [f64; 7],
    /// RMS of what the forces leave \[N\].
    pub rms: f64,
    /// By how much the free linear map differs from weight times a rotation, relative to it: large if
    /// the sensor's gains or axes are wrong.
    pub distortion: f64,
}

/// How the sensor sits on a flange whose poses are known: `f = S Rᵀ g + b` with the unknown rotation
/// `S` and weight, gravity along `down` of the base.
///
/// The linear map is fitted by least squares, then brought to the nearest multiple of a rotation
/// (Arun, Huang & Blostein 1987; Umeyama 1991, who has the sign of the determinant right).
///
/// # Errors
/// [`PayloadError`]; four generic poses are the least.
pub fn fit_orientation(poses: &[Pose], down: &Vector3<f64>) -> Result<Orientation, PayloadError> {
    let down = unit(down).ok_or(PayloadError::NoDirection("direction of gravity"))?;
    let mut design = DMatrix::from_element(poses.len(), 4, 1.0);
    let mut forces = DMatrix::zeros(poses.len(), 3);
    for (i, pose) in poses.iter().enumerate() {
        let along = pose.base_from_sensor.transpose() * down;
        for j in 0..3 {
            design[(i, j)] = along[j];
            forces[(i, j)] = pose.wrench[j];
        }
    }
    let fit = least_squares(&design, &forces, None).map_err(|error| named(error, &["gravity"], 3))?;
    let map = Matrix3::from_fn(|i, j| fit.coefficients[(j, i)]);
    let singular = Singular::new(&DMatrix::from_fn(3, 3, |i, j| map[(i, j)]))
        .ok_or(FitError::BadInput { what: "the poses" })?;
    let (u, v) =
        (Matrix3::from_fn(|i, j| singular.left[(i, j)]), Matrix3::from_fn(|i, j| singular.right[(i, j)]));
    let handed = (u * v.transpose()).determinant().signum();
    let weight = (singular.values[0] + singular.values[1] + handed * singular.values[2]) / 3.0;
    if handed < 0.0 {
        // A reflection is a rotation of the opposite sign: the readings are those of the reaction.
        return Err(PayloadError::NegativeMass { mass: -weight / STANDARD_GRAVITY });
    }
    let sensor_from_flange = u * v.transpose();
    let distortion = (map - sensor_from_flange * weight).norm() / map.norm().max(f64::MIN_POSITIVE);
    let mut bias = Vector3::zeros();
    let pull = |pose: &Pose| sensor_from_flange * (pose.base_from_sensor.transpose() * down) * weight;
    for pose in poses {
        bias += (pose.wrench.fixed_rows::<3>(0) - pull(pose)) / poses.len() as f64;
    }
    let squares: f64 =
        poses.iter().map(|pose| (pose.wrench.fixed_rows::<3>(0) - pull(pose) - bias).norm_squared()).sum();
    let rms = (squares / (3 * poses.len()).max(1) as f64).sqrt();
    let mut mean = Vector3::zeros();
    poses.iter().for_each(|pose| mean += pose.base_from_sensor.transpose() * down / poses.len() as f64);
    let spread = orientation_spread(&fit, &sensor_from_flange, weight, &mean, poses.len() as f64);
    let deviation = |i: usize| spread[i].0.max(0.0).sqrt();
    Ok(Orientation {
        sensor_from_flange,
        weight,
        force_bias: bias,
        turn_deviation: Vector3::from_fn(|i, _| deviation(i)),
        weight_deviation: deviation(3),
        bias_deviation: Vector3::from_fn(|i, _| deviation(4 + i)),
        freedom: spread.map(|(_, freedom)| freedom),
        rms,
        distortion,
    })
}

/// Variances of the turn (3), the weight and the force without load (3), and the degrees of freedom behind each. An error
/// E of the linear map turns the nearest rotation S by the skew part of `E Sᵀ / weight` and changes the weight by a third
/// of its trace, to first order; the error of the mean of the forces is independent of both.
///
/// With the covariance Σ of the forces, estimated with ν degrees of freedom, and slopes P by the map, a variance is
/// `tr(A Σ)`, `A = P G Pᵀ` (of the force without load with 1/n for its own component), with
/// `ν tr(A Σ)²/tr(A Σ A Σ)` degrees of freedom (Satterthwaite 1946).
fn orientation_spread(
    fit: &Fit,
    turn: &Matrix3<f64>,
    weight: f64,
    mean: &Vector3<f64>,
    poses: f64,
) -> [(f64, f64); 7] {
    // Of each quantity by the entries of the map.
    let mut slopes = [Matrix3::zeros(); 7];
    for i in 0..3 {
        for j in 0..3 {
            let mut error = Matrix3::zeros();
            error[(i, j)] = 1.0;
            let relative = error * turn.transpose();
            let skew = (relative - relative.transpose()) / (2.0 * weight);
            let angle = Vector3::new(skew[(2, 1)], skew[(0, 2)], skew[(1, 0)]);
            let heavier = relative.trace() / 3.0;
            let bias = -(turn * heavier + angle.cross_matrix() * turn * weight) * mean;
            let by = [angle.x, angle.y, angle.z, heavier, bias.x, bias.y, bias.z];
            slopes.iter_mut().zip(by).for_each(|(slope, by)| slope[(i, j)] = by);
        }
    }
    let gram = Matrix3::from_fn(|i, j| fit.inverse_gram[(i, j)]);
    let noise = Matrix3::from_fn(|i, j| fit.residual_covariance[(i, j)]);
    let mut place = 0;
    slopes.map(|slope| {
        let mut form = slope * gram * slope.transpose();
        if let Some(axis) = usize::checked_sub(place, 4) {
            form[(axis, axis)] += 1.0 / poses;
        }
        place += 1;
        let of_noise = form * noise;
        let (variance, squares) = (of_noise.trace(), (of_noise * of_noise).trace());
        let freedom = if squares > 0.0 { fit.freedom * variance * variance / squares } else { fit.freedom };
        (variance, freedom)
    })
}
