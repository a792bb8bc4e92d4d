//! Mass, centre of mass and zero from the weight of what the sensor carries.

use fingertip_wrench::units::STANDARD_GRAVITY;
use nalgebra::{DMatrix, Matrix3, Vector3, Vector6};

use super::error::PayloadError;
use super::payload_parts::{Centre, Weight};
use super::payload_sureness::Sureness;
use super::poses::{Pose, turn, unit};
use crate::file::{FileError, PayloadFile, PayloadQuality, Verdict};
use crate::fit::least_squares;
use crate::linear::Singular;

/// How often the weights of the components are taken from what the fit before leaves.
const REWEIGHTED: usize = 3;

/// What is known of gravity and of the body.
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
/// use fingertip_calibration::gravity::{PayloadOptions, fit_payload};
///
/// // The base may stand crooked, and the centre of mass lies on the z axis of the sensor.
/// let options = PayloadOptions { down: None, centre_on: Some(Vector3::z()), ..PayloadOptions::default() };
/// let fit = fit_payload(&poses, &options)?;
/// assert!((fit.weight.norm() - 0.4 * 9.81).abs() < 1e-6 && (fit.centre_of_mass.z - 0.05).abs() < 1e-6);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PayloadOptions {
    /// Where gravity points, in the base frame; `None` if the base may stand crooked, which costs two
    /// more unknowns. The default is −z.
    pub down: Option<Vector3<f64>>,
    /// An axis of the sensor that the centre of mass is known to lie on; `None` if it may lie anywhere.
    pub centre_on: Option<Vector3<f64>>,
    /// Acceleration of gravity \[m/s²\], which turns a weight into a mass.
    pub gravity: f64,
}

impl Default for PayloadOptions {
    fn default() -> Self {
        Self { down: Some(-Vector3::z()), centre_on: None, gravity: STANDARD_GRAVITY }
    }
}

/// Degrees of freedom behind the deviations of a payload: an interval is a deviation times
/// [`student_factor`](crate::fit::student_factor) of its own.
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
/// use fingertip_calibration::fit::student_factor;
/// use fingertip_calibration::gravity::{PayloadFreedom, PayloadOptions, fit_payload};
///
/// // Readings that scatter by some millinewtons.
/// for (k, pose) in (0_i32..).zip(&mut poses) {
///     pose.wrench.z += 5e-3 * f64::from(7 * k * k + 1).sin();
/// }
/// let fit = fit_payload(&poses, &PayloadOptions::default())?;
/// let freedom: PayloadFreedom = fit.freedom;
/// // Eight poses tell less surely than very many, for which 1.96 deviations hold the truth in 95 of 100 cases.
/// let factor = student_factor(0.95, freedom.weight);
/// assert!(factor > 1.96 && factor < 5.0);
/// assert!((fit.weight.norm() - 0.4 * 9.81).abs() < factor * fit.weight_deviation);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PayloadFreedom {
    /// Of the weight.
    pub weight: f64,
    /// Of the force at rest, axis by axis.
    pub force_bias: Vector3<f64>,
    /// Of the centre of mass, axis by axis.
    pub centre: Vector3<f64>,
    /// Of the torque at rest, axis by axis.
    pub torque_bias: Vector3<f64>,
}

/// What the weight of a body told.
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
/// use fingertip_calibration::gravity::{PayloadFit, PayloadOptions, fit_payload};
///
/// // 0.4 kg, 50 mm above the sensor, which reads 0.2 N along x without load.
/// let fit: PayloadFit = fit_payload(&poses, &PayloadOptions::default())?;
/// assert!((fit.mass - 0.4).abs() < 1e-3 && (fit.centre_of_mass - Vector3::z() * 0.05).norm() < 1e-6);
/// assert!((fit.force_bias - Vector3::x() * 0.2).norm() < 1e-6);
/// // It says what the sensor would read in any pose.
/// assert!((fit.reading(&poses[3].base_from_sensor) - poses[3].wrench).norm() < 1e-6);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct PayloadFit {
    /// Weight in the base frame \[N\], as the load on the sensor.
    pub weight: Vector3<f64>,
    /// Mass \[kg\].
    pub mass: f64,
    /// Centre of mass in the sensor frame \[m\].
    pub centre_of_mass: Vector3<f64>,
    /// Force that the sensor reads without load \[N\], in its frame.
    pub force_bias: Vector3<f64>,
    /// Torque that the sensor reads without load \[N·m\], in its frame.
    pub torque_bias: Vector3<f64>,
    /// Angle between the fitted weight and the −z axis of the base \[rad\]; zero where the direction was given.
    pub tilt: f64,
    /// Standard deviation of the direction of the weight \[rad\], per turn (root mean square of the two); zero
    /// where it was given.
    pub direction_deviation: f64,
    /// RMS of what is left, per component, in the sensor frame \[N, N·m\].
    pub rms: [f64; 6],
    /// The same in the base frame.
    pub rms_in_base: [f64; 6],
    /// Standard deviation of the weight \[N\] (its length) and of the mass relative to it.
    pub weight_deviation: f64,
    /// Standard deviations of the centre of mass \[m\], of the errors of torques and of the weight alike;
    /// zero along directions that were given.
    pub centre_deviation: Vector3<f64>,
    /// Standard deviations of the force at rest \[N\].
    pub force_bias_deviation: Vector3<f64>,
    /// Standard deviations of the torque at rest \[N·m\].
    pub torque_bias_deviation: Vector3<f64>,
    /// Degrees of freedom behind the deviations.
    pub freedom: PayloadFreedom,
    /// Condition number of the poses for the forces: near 1 is good, above 30 say, poses are too alike.
    pub condition_number: f64,
    /// RMS of the force residual \[N\] if the readings are taken as given in the base frame instead: if
    /// it is much smaller, frames are mixed up.
    pub rms_if_in_base: f64,
    /// What to mind.
    pub warnings: Vec<String>,
}

/// Fits weight, centre of mass and zero to readings in several poses: `f = Rᵀ g + b_f`,
/// `m = c × Rᵀ g + b_m`, two linear least-squares problems (`docs/theory/calibration.md#gravity`). The second
/// has the weight of the first among its regressors: what is uncertain of it is carried over to the centre of
/// mass and the torque at rest, to first order. Each component of forces and of torques counts by the noise that it shows.
///
/// With gravity's direction given, two poses could do; four generic poses are the least in general, and
/// eight or more are advised.
///
/// # Errors
/// [`PayloadError`].
pub fn fit_payload(poses: &[Pose], options: &PayloadOptions) -> Result<PayloadFit, PayloadError> {
    let down = match options.down {
        Some(down) => Some(unit(&down).ok_or(PayloadError::NoDirection("direction of gravity"))?),
        None => None,
    };
    let axis = match options.centre_on {
        Some(axis) => Some(unit(&axis).ok_or(PayloadError::NoDirection("axis of the centre of mass"))?),
        None => None,
    };
    let (weight, centre, sure) = weighted(poses, down, axis, options.gravity)?;
    let direction = unit(&weight.load).unwrap_or_else(Vector3::zeros);
    let (weight_deviation, weight_freedom) = sure.along(&direction);
    let across =
        (0..3).map(|i| sure.along(&Vector3::ith(i, 1.0)).0.powi(2)).sum::<f64>() - weight_deviation.powi(2);
    let by_axis = |of: &dyn Fn(usize) -> (f64, f64)| {
        (Vector3::from_fn(|i, _| of(i).0), Vector3::from_fn(|i, _| of(i).1))
    };
    let (force_bias_deviation, of_force_bias) = by_axis(&|axis| sure.force_at_rest(axis));
    let (centre_deviation, of_centre) = by_axis(&|axis| sure.centre(axis));
    let (torque_bias_deviation, of_torque_bias) = by_axis(&|axis| sure.torque_at_rest(axis));
    let mut result = PayloadFit {
        weight: weight.load,
        mass: weight.length / options.gravity,
        centre_of_mass: centre.of_mass,
        force_bias: weight.bias,
        torque_bias: centre.bias,
        direction_deviation: if down.is_some() {
            0.0
        } else {
            (0.5 * across.max(0.0)).sqrt() / weight.length
        },
        tilt: if down.is_some() { 0.0 } else { weight.load.angle(&-Vector3::z()) },
        rms: [0.0; 6],
        rms_in_base: [0.0; 6],
        weight_deviation,
        centre_deviation,
        force_bias_deviation,
        torque_bias_deviation,
        freedom: PayloadFreedom {
            weight: weight_freedom,
            force_bias: of_force_bias,
            centre: of_centre,
            torque_bias: of_torque_bias,
        },
        condition_number: Singular::new(&weight.design).map_or(f64::INFINITY, |s| s.condition_number()),
        rms_if_in_base: f64::INFINITY,
        warnings: Vec::new(),
    };
    result.rate(poses, &weight.design);
    Ok(result)
}

/// The fits, in which at last every component counts by its noise (feasible generalised least squares).
fn weighted(
    poses: &[Pose],
    down: Option<Vector3<f64>>,
    axis: Option<Vector3<f64>>,
    gravity: f64,
) -> Result<(Weight, Centre, Sureness), PayloadError> {
    let force = |weights: &Vector6<f64>| Weight::of(poses, down, &weights.fixed_rows::<3>(0).into_owned());
    let torque = |weights: &Vector6<f64>, weight: &Weight| {
        Centre::of(poses, axis, weight, &weights.fixed_rows::<3>(3).into_owned())
    };
    let (mut weights, mut doubts) = (Vector6::from_element(1.0), Vec::new());
    let mut weight = force(&weights)?;
    weight.checked(down, gravity)?;
    let mut centre = torque(&weights, &weight)?;
    let mut sure = Sureness::of(poses, &weight, &centre, &weights, &doubts);
    for _ in 0..REWEIGHTED {
        (weights, doubts) = sure.weights();
        weight = force(&weights)?;
        centre = torque(&weights, &weight)?;
        sure = Sureness::of(poses, &weight, &centre, &weights, &doubts);
    }
    Ok((weight, centre, sure))
}

impl PayloadFit {
    /// What the sensor would read in a pose.
    #[must_use]
    pub fn reading(&self, base_from_sensor: &Matrix3<f64>) -> Vector6<f64> {
        let pull = base_from_sensor.transpose() * self.weight;
        let force = pull + self.force_bias;
        let torque = self.centre_of_mass.cross(&pull) + self.torque_bias;
        Vector6::new(force.x, force.y, force.z, torque.x, torque.y, torque.z)
    }

    /// As a payload file that says from how many poses it was fitted.
    ///
    /// # Errors
    /// [`FileError`] if a number is not finite or the mass is negative.
    pub fn to_file(&self, poses: usize) -> Result<PayloadFile, FileError> {
        let mut file = PayloadFile::new(self.mass, self.centre_of_mass, self.weight / self.mass)?;
        file.force_bias = self.force_bias.into();
        file.torque_bias = self.torque_bias.into();
        file.quality = PayloadQuality {
            poses: poses as u64,
            mass_deviation: self.mass * self.weight_deviation / self.weight.norm(),
            centre_deviation: self.centre_deviation.into(),
            rms: self.rms,
            warnings: self.warnings.clone(),
            verdict: self.verdict(),
        };
        file.provenance.method = "gravity in several poses".to_owned();
        file.validate()?;
        Ok(file)
    }

    /// Whether it can be trusted: bad if frames seem to be mixed, if the poses are too alike, or if a tenth of the weight is
    /// left or not known; suspect if there is anything else to mind.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        let weight = self.weight.norm();
        let left = self.force_squares().sqrt();
        let is_bad = self.frames_seem_mixed()
            || self.condition_number > 30.0
            || self.weight_deviation > 0.1 * weight
            || left > 0.1 * weight;
        if is_bad {
            Verdict::Bad
        } else if self.warnings.is_empty() {
            Verdict::Good
        } else {
            Verdict::Suspect
        }
    }

    /// Mean square of what is left of a force \[N²\].
    fn force_squares(&self) -> f64 {
        self.rms.iter().take(3).map(|rms| rms * rms).sum()
    }

    /// What is left of a component of the force, root mean square \[N\].
    fn force_rms(&self) -> f64 {
        (self.force_squares() / 3.0).sqrt()
    }

    /// Whether the readings fit much better as given in the base frame.
    fn frames_seem_mixed(&self) -> bool {
        self.rms_if_in_base * 3.0 < self.force_rms()
    }

    fn rate(&mut self, poses: &[Pose], design: &DMatrix<f64>) {
        let count = poses.len().max(1) as f64;
        for pose in poses {
            let left = pose.wrench - self.reading(&pose.base_from_sensor);
            let in_base = turn(&pose.base_from_sensor, &left);
            for i in 0..6 {
                self.rms[i] += left[i] * left[i] / count;
                self.rms_in_base[i] += in_base[i] * in_base[i] / count;
            }
        }
        self.rms = self.rms.map(f64::sqrt);
        self.rms_in_base = self.rms_in_base.map(f64::sqrt);
        let mut other = DMatrix::zeros(3 * poses.len(), 1);
        for (i, pose) in poses.iter().enumerate() {
            let turned = pose.base_from_sensor.transpose() * pose.wrench.fixed_rows::<3>(0);
            other.view_mut((3 * i, 0), (3, 1)).copy_from(&turned);
        }
        if let Ok(swapped) = least_squares(design, &other, None) {
            let left = &other - design * swapped.coefficients;
            self.rms_if_in_base = (left.norm_squared() / left.len().max(1) as f64).sqrt();
        }
        if self.frames_seem_mixed() {
            self.warnings.push(format!(
                "frames seem to be mixed: the readings fit to {:.3} N if they are in the base frame, to {:.3} N as it is",
                self.rms_if_in_base,
                self.force_rms()
            ));
        }
        if self.condition_number > 30.0 {
            self.warnings
                .push(format!("the poses are too alike: condition number {:.0}", self.condition_number));
        }
        if self.weight_deviation > 0.02 * self.weight.norm() {
            self.warnings.push("the weight is known to no better than 2 %".to_owned());
        }
    }
}

#[cfg(test)]
#[path = "payload_tests.rs"]
mod tests;
