//! Mass, centre of mass and zero from the weight of what the sensor carries.

use fingertip_wrench::units::STANDARD_GRAVITY;
use nalgebra::{DMatrix, Matrix3, Vector3};

use super::error::{PayloadError, named};
use super::poses::{Pose, turn, unit};
use crate::file::{FileError, PayloadFile, PayloadQuality};
use crate::fit::{Fit, least_squares};
use crate::linear::Singular;

/// What is known of gravity and of the body.
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

/// What the weight of a body told.
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
/// mass and the torque at rest, to first order.
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
    let rows = 3 * poses.len();
    // Forces.
    let basis = down
        .map_or_else(|| DMatrix::identity(3, 3), |down| DMatrix::from_column_slice(3, 1, down.as_slice()));
    let unknowns = basis.ncols();
    let mut design = DMatrix::zeros(rows, unknowns + 3);
    let mut forces = DMatrix::zeros(rows, 1);
    for (i, pose) in poses.iter().enumerate() {
        let turned = pose.base_from_sensor.transpose() * &basis;
        design.view_mut((3 * i, 0), (3, unknowns)).copy_from(&turned);
        design.view_mut((3 * i, unknowns), (3, 3)).fill_with_identity();
        forces.view_mut((3 * i, 0), (3, 1)).copy_from(&pose.wrench.fixed_rows::<3>(0));
    }
    let fit = least_squares(&design, &forces, None).map_err(|error| named(error, &["weight"], unknowns))?;
    let weight = vector(&(&basis * fit.coefficients.rows(0, unknowns)));
    let length = weight.norm();
    let direction = unit(&weight).unwrap_or_else(Vector3::zeros);
    let parameter = basis.transpose() * direction;
    let variance = fit.residual_covariance[(0, 0)]
        * (parameter.transpose() * fit.inverse_gram.view((0, 0), (unknowns, unknowns)) * &parameter)[(0, 0)];
    let weight_deviation = variance.max(0.0).sqrt();
    let all = &basis * fit.inverse_gram.view((0, 0), (unknowns, unknowns)) * basis.transpose();
    let across = (all.trace() * fit.residual_covariance[(0, 0)] - variance).max(0.0);
    let direction_deviation = if down.is_some() { 0.0 } else { (0.5 * across).sqrt() / length };
    // Down is −z unless told otherwise.
    let upward = weight.dot(&down.unwrap_or_else(|| -Vector3::z())) < 0.0;
    if !(length > 3.0 * weight_deviation) {
        return Err(PayloadError::NoWeight { weight: length, deviation: weight_deviation });
    }
    if upward {
        return Err(PayloadError::NegativeMass { mass: -length / options.gravity });
    }
    let force_bias = Vector3::from_fn(|i, _| fit.coefficients[(unknowns + i, 0)]);
    let condition_number = Singular::new(&design).map_or(f64::INFINITY, |s| s.condition_number());
    // Torques.
    let span = axis
        .map_or_else(|| DMatrix::identity(3, 3), |axis| DMatrix::from_column_slice(3, 1, axis.as_slice()));
    let lengths = span.ncols();
    let mut arms = DMatrix::zeros(rows, lengths + 3);
    let mut torques = DMatrix::zeros(rows, 1);
    for (i, pose) in poses.iter().enumerate() {
        let pull = pose.base_from_sensor.transpose() * weight;
        arms.view_mut((3 * i, 0), (3, lengths)).copy_from(&(-pull.cross_matrix() * &span));
        arms.view_mut((3 * i, lengths), (3, 3)).fill_with_identity();
        torques.view_mut((3 * i, 0), (3, 1)).copy_from(&pose.wrench.fixed_rows::<3>(3));
    }
    let torque_fit =
        least_squares(&arms, &torques, None).map_err(|error| named(error, &["centre of mass"], lengths))?;
    let centre_of_mass = vector(&(&span * torque_fit.coefficients.rows(0, lengths)));
    let torque_bias = Vector3::from_fn(|i, _| torque_fit.coefficients[(lengths + i, 0)]);
    // By how much the torques would change with the weight, and what the fit makes of that.
    let mut change = DMatrix::zeros(rows, unknowns);
    for (i, pose) in poses.iter().enumerate() {
        let turned = pose.base_from_sensor.transpose() * &basis;
        change.view_mut((3 * i, 0), (3, unknowns)).copy_from(&(centre_of_mass.cross_matrix() * turned));
    }
    let carried = least_squares(&arms, &change, None)?;
    let weight_spread = fit.inverse_gram.view((0, 0), (unknowns, unknowns)) * fit.residual_covariance[(0, 0)];
    // Part of what the torques leave is of the weight, too.
    let of_weight = (&carried.residual_covariance * &weight_spread).trace();
    let torque_variance = (torque_fit.residual_covariance[(0, 0)] - of_weight).max(0.0);
    let torque_spread = &torque_fit.inverse_gram * torque_variance
        + &carried.coefficients * weight_spread * carried.coefficients.transpose();
    let spread: DMatrix<f64> = &span * torque_spread.view((0, 0), (lengths, lengths)) * span.transpose();
    let centre_deviation = Vector3::from_fn(|i, _| spread[(i, i)].max(0.0).sqrt());
    let force_bias_deviation = Vector3::from_fn(|i, _| {
        let i = unknowns + i;
        (fit.inverse_gram[(i, i)] * fit.residual_covariance[(0, 0)]).max(0.0).sqrt()
    });
    let torque_bias_deviation =
        Vector3::from_fn(|i, _| torque_spread[(lengths + i, lengths + i)].max(0.0).sqrt());
    let mut result = PayloadFit {
        weight,
        mass: length / options.gravity,
        centre_of_mass,
        force_bias,
        torque_bias,
        direction_deviation,
        tilt: if down.is_some() { 0.0 } else { weight.angle(&-Vector3::z()) },
        rms: [0.0; 6],
        rms_in_base: [0.0; 6],
        weight_deviation,
        centre_deviation,
        force_bias_deviation,
        torque_bias_deviation,
        condition_number,
        rms_if_in_base: f64::INFINITY,
        warnings: Vec::new(),
    };
    result.rate(poses, &design, &fit);
    Ok(result)
}

impl PayloadFit {
    /// What the sensor would read in a pose.
    #[must_use]
    pub fn reading(&self, base_from_sensor: &Matrix3<f64>) -> nalgebra::Vector6<f64> {
        let pull = base_from_sensor.transpose() * self.weight;
        let force = pull + self.force_bias;
        let torque = self.centre_of_mass.cross(&pull) + self.torque_bias;
        nalgebra::Vector6::new(force.x, force.y, force.z, torque.x, torque.y, torque.z)
    }

    /// As a payload file, of a fit to so many poses.
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
        };
        file.provenance.method = "gravity in several poses".to_owned();
        file.validate()?;
        Ok(file)
    }

    fn rate(&mut self, poses: &[Pose], design: &DMatrix<f64>, fit: &Fit) {
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
        let rms = fit.residual_covariance[(0, 0)].sqrt();
        if self.rms_if_in_base * 3.0 < rms {
            self.warnings.push(format!(
                "frames seem to be mixed: the readings fit to {:.3} N if they are in the base frame, to {rms:.3} N as it is",
                self.rms_if_in_base
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

fn vector(matrix: &DMatrix<f64>) -> Vector3<f64> {
    Vector3::new(matrix[(0, 0)], matrix[(1, 0)], matrix[(2, 0)])
}

#[cfg(test)]
mod tests {
    use super::{PayloadError, PayloadOptions, fit_payload};
    use crate::fit::testing::gaussian;
    use crate::gravity::{Pose, fit_orientation};
    use crate::testing::Largest as _;
    use nalgebra::{Rotation3, Vector3, Vector6};
    use proptest::prelude::*;
    use rand::SeedableRng as _;
    use rand_pcg::Pcg64Mcg;

    fn rotation(random: &mut Pcg64Mcg) -> Rotation3<f64> {
        let q =
            nalgebra::Quaternion::new(gaussian(random), gaussian(random), gaussian(random), gaussian(random));
        nalgebra::UnitQuaternion::from_quaternion(q).to_rotation_matrix()
    }

    fn vector(random: &mut Pcg64Mcg) -> Vector3<f64> {
        Vector3::from_fn(|_, _| gaussian(random))
    }

    fn poses(
        random: &mut Pcg64Mcg,
        count: usize,
        g: Vector3<f64>,
        c: Vector3<f64>,
        b: Vector6<f64>,
    ) -> Vec<Pose> {
        (0..count)
            .map(|_| {
                let turn = rotation(random).into_inner();
                let f = turn.transpose() * g;
                let m = c.cross(&f);
                Pose { base_from_sensor: turn, wrench: Vector6::new(f.x, f.y, f.z, m.x, m.y, m.z) + b }
            })
            .collect()
    }

    proptest! {
        #[test]
        fn exact_from_four_poses(seed in any::<u64>()) {
            let random = &mut Pcg64Mcg::seed_from_u64(seed);
            let (g, c) = (Vector3::new(0.1, -0.2, -3.0), vector(random) * 0.05);
            let bias = Vector6::from_fn(|_, _| gaussian(random));
            let poses = poses(random, 4, g, c, bias);
            let options = PayloadOptions { down: None, ..PayloadOptions::default() };
            if let Ok(fit) = fit_payload(&poses, &options) && fit.condition_number < 20.0 {
                prop_assert!((fit.weight - g).largest() < 1e-12);
                prop_assert!((fit.centre_of_mass - c).largest() < 1e-12);
                prop_assert!((fit.force_bias - bias.fixed_rows::<3>(0)).largest() < 1e-12);
                prop_assert!((fit.torque_bias - bias.fixed_rows::<3>(3)).largest() < 1e-12);
            }
        }

        #[test]
        fn orientation_is_found(seed in any::<u64>()) {
            let random = &mut Pcg64Mcg::seed_from_u64(seed);
            let mount = rotation(random).into_inner();
            let bias = vector(random);
            let poses: Vec<Pose> = (0..8)
                .map(|_| {
                    let turn = rotation(random).into_inner();
                    let f = mount * (turn.transpose() * Vector3::new(0.0, 0.0, -4.0)) + bias;
                    Pose { base_from_sensor: turn, wrench: Vector6::new(f.x, f.y, f.z, 0.0, 0.0, 0.0) }
                })
                .collect();
            let fit = fit_orientation(&poses, &-Vector3::z()).unwrap();
            prop_assert!((fit.sensor_from_flange - mount).largest() < 1e-10);
            prop_assert!((fit.weight - 4.0).abs() < 1e-10 && (fit.force_bias - bias).largest() < 1e-10);
            prop_assert!(fit.distortion < 1e-10);
        }
    }

    #[test]
    fn mass_is_weight_over_gravity() {
        let random = &mut Pcg64Mcg::seed_from_u64(21);
        let (g, c) = (Vector3::new(0.0, 3.0, -3.0), Vector3::new(0.01, -0.02, 0.03));
        let bias = Vector6::new(0.1, 0.2, 0.3, 0.01, 0.02, 0.03);
        let poses = poses(random, 10, g, c, bias);
        let options = PayloadOptions { down: None, gravity: 2.0, ..PayloadOptions::default() };
        let fit = fit_payload(&poses, &options).unwrap();
        let length = 18.0_f64.sqrt();
        assert!((fit.mass - length / 2.0).abs() < 1e-12);
        assert!((fit.tilt - core::f64::consts::FRAC_PI_4).abs() < 1e-12);
        assert!(fit.warnings.is_empty(), "{:?}", fit.warnings);
        let read = fit.reading(&poses[3].base_from_sensor);
        assert!((read - poses[3].wrench).largest() < 1e-12);
        let mut fit = fit;
        fit.weight_deviation = 0.3;
        fit.warnings = vec!["a".to_owned()];
        let file = fit.to_file(10).unwrap();
        assert_eq!((file.mass, file.quality.poses), (fit.mass, 10));
        assert!((Vector3::from(file.gravity) - g / fit.mass).largest() < 1e-12);
        assert!((file.quality.mass_deviation - fit.mass * 0.3 / length).abs() < 1e-12);
        assert!((Vector3::from(file.centre_of_mass) - c).largest() < 1e-12);
        assert!((Vector3::from(file.force_bias) - Vector3::new(0.1, 0.2, 0.3)).largest() < 1e-12);
        assert!((Vector3::from(file.torque_bias) - Vector3::new(0.01, 0.02, 0.03)).largest() < 1e-12);
        assert_eq!((file.quality.rms, file.quality.warnings), (fit.rms, fit.warnings.clone()));
    }

    /// Four readings, given in the base frame by mistake, may look like a weight. They fit exactly if they are
    /// taken for what they are.
    #[test]
    fn mixed_frames_are_recognised() {
        let (g, c) = (Vector3::new(0.0, 0.0, -3.0), Vector3::new(0.01, -0.02, 0.03));
        let options = PayloadOptions { down: None, ..PayloadOptions::default() };
        let mut fitted = 0;
        for seed in 0..400 {
            let random = &mut Pcg64Mcg::seed_from_u64(seed);
            let bias = vector(random);
            let bias = Vector6::new(bias.x, bias.y, bias.z, 0.0, 0.0, 0.0);
            let mixed: Vec<Pose> = poses(random, 4, g, c, bias)
                .iter()
                .map(|pose| {
                    let f = pose.base_from_sensor * pose.wrench.fixed_rows::<3>(0);
                    Pose { wrench: Vector6::new(f.x, f.y, f.z, 0.0, 0.0, 0.0), ..*pose }
                })
                .collect();
            let Ok(fit) = fit_payload(&mixed, &options) else { continue };
            fitted += 1;
            assert!(fit.rms_if_in_base < 1e-12, "{}", fit.rms_if_in_base);
            assert!(
                fit.warnings.iter().any(|warning| warning.contains("frames seem to be mixed")),
                "{fit:?}"
            );
        }
        assert!(fitted >= 5, "{fitted}");
    }

    #[test]
    fn what_is_badly_known_is_warned_of() {
        let random = &mut Pcg64Mcg::seed_from_u64(22);
        let (g, c) = (Vector3::new(0.0, 0.0, -3.0), Vector3::new(0.01, -0.02, 0.03));
        let good = poses(random, 12, g, c, Vector6::zeros());
        let noisy = |random: &mut Pcg64Mcg, poses: &[Pose], noise: f64| -> Vec<Pose> {
            let error = |random: &mut Pcg64Mcg| {
                Vector6::from_fn(|i, _| if i < 3 { noise * gaussian(random) } else { 0.0 })
            };
            poses.iter().map(|pose| Pose { wrench: pose.wrench + error(random), ..*pose }).collect()
        };
        let options = PayloadOptions::default();
        for (noise, warned) in [(0.05, false), (1.0, true)] {
            let fit = fit_payload(&noisy(random, &good, noise), &options).unwrap();
            // The statement itself decides, and noise over √(poses) is about what it must be.
            assert_eq!(fit.weight_deviation > 0.02 * fit.weight.norm(), warned);
            assert_eq!(fit.warnings.iter().any(|warning| warning.contains("no better than 2 %")), warned);
            assert!((fit.weight_deviation / (noise / 12.0_f64.sqrt()) - 1.0).abs() < 0.6, "{fit:?}");
        }
        // Turned by a few degrees only, the weight is hardly told from the force without load.
        for (spread, warned) in [(0.5, false), (0.01, true)] {
            let alike: Vec<Pose> = (0..12)
                .map(|_| {
                    let turn = Rotation3::from_scaled_axis(vector(random) * spread).into_inner();
                    let f = turn.transpose() * g;
                    let m = c.cross(&f);
                    Pose { base_from_sensor: turn, wrench: Vector6::new(f.x, f.y, f.z, m.x, m.y, m.z) }
                })
                .collect();
            let fit = fit_payload(&alike, &options).unwrap();
            assert_eq!(fit.condition_number > 30.0, warned, "{}", fit.condition_number);
            assert_eq!(fit.warnings.iter().any(|warning| warning.contains("too alike")), warned);
        }
    }

    #[test]
    fn mistakes_are_named() {
        let random = &mut Pcg64Mcg::seed_from_u64(1);
        let (g, c) = (Vector3::new(0.0, 0.0, -3.0), Vector3::new(0.01, 0.02, 0.03));
        let good = poses(random, 10, g, c, Vector6::zeros());
        let reaction: Vec<Pose> = good.iter().map(|pose| Pose { wrench: -pose.wrench, ..*pose }).collect();
        let error = fit_payload(&reaction, &PayloadOptions::default()).unwrap_err();
        assert!(matches!(error, PayloadError::NegativeMass { .. }), "{error}");
        assert!(matches!(fit_orientation(&reaction, &-Vector3::z()), Err(PayloadError::NegativeMass { .. })));
        let mixed: Vec<Pose> = good
            .iter()
            .map(|pose| {
                let f = pose.base_from_sensor * pose.wrench.fixed_rows::<3>(0)
                    + Vector3::new(0.0, 0.0, 1e-3 * gaussian(random));
                Pose { wrench: Vector6::new(f.x, f.y, f.z, 0.0, 0.0, 0.0), ..*pose }
            })
            .collect();
        match fit_payload(&mixed, &PayloadOptions::default()) {
            Ok(fit) => assert!(fit.warnings.iter().any(|warning| warning.contains("frames")), "{fit:?}"),
            Err(error) => assert!(matches!(error, PayloadError::NoWeight { .. }), "{error}"),
        }
        // All poses alike: the weight cannot be told from the bias.
        let same = vec![good[0]; 6];
        let error = fit_payload(&same, &PayloadOptions::default()).unwrap_err();
        assert!(error.to_string().contains("weight"), "{error}");
        let options = PayloadOptions { down: Some(Vector3::zeros()), ..PayloadOptions::default() };
        assert_eq!(
            fit_payload(&good, &options).unwrap_err(),
            PayloadError::NoDirection("direction of gravity")
        );
    }
}
