//! Which frames the readings of poses are in, and which way their orientations go.

use core::fmt;

use super::poses::Pose;
use super::{PayloadOptions, fit_payload};

/// How readings and orientations can be meant.
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
/// use fingertip_calibration::gravity::{Frames, PayloadOptions, try_frames};
///
/// // Somebody gives the quaternions the other way round; the weight fits only if they are taken so.
/// let turned: Vec<Pose> = poses
///     .iter()
///     .map(|pose| Pose { base_from_sensor: pose.base_from_sensor.transpose(), ..*pose })
///     .collect();
/// let best = try_frames(&turned, &PayloadOptions::default())[0].frames;
/// assert_eq!(best, Frames { wrench_in_base: false, inverse: true });
/// # Ok::<(), &str>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Frames {
    /// The readings are in the axes of the base, not of the sensor.
    pub wrench_in_base: bool,
    /// The quaternions turn from the base to the sensor, not from the sensor to the base.
    pub inverse: bool,
}

/// What a fit leaves if the frames are so.
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
/// use fingertip_calibration::gravity::{FrameTrial, PayloadOptions, try_frames};
///
/// // Of the ways to take the frames the best leaves nothing of the weight, 4 N; the next leaves much.
/// let trials: Vec<FrameTrial> = try_frames(&poses, &PayloadOptions::default());
/// assert!(trials[0].rms < 1e-6 && !trials[0].frames.inverse);
/// assert!(trials.get(1).is_none_or(|next| next.rms > 0.5));
/// # Ok::<(), &str>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameTrial {
    /// How they are taken.
    pub frames: Frames,
    /// RMS of the force that is left \[N\], of its length.
    pub rms: f64,
}

impl fmt::Display for Frames {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let axes = if self.wrench_in_base { "the base" } else { "the sensor" };
        write!(f, "readings in the axes of {axes}")?;
        if self.inverse {
            write!(f, " and quaternions from the base to the sensor")?;
        }
        Ok(())
    }
}

/// Fits the weight in every way that the frames can be meant, the best first. What has no answer, such as a weight that
/// points up, is left out.
#[must_use]
pub fn try_frames(poses: &[Pose], options: &PayloadOptions) -> Vec<FrameTrial> {
    let mut trials = Vec::new();
    for (wrench_in_base, inverse) in [(false, false), (true, false), (false, true), (true, true)] {
        let frames = Frames { wrench_in_base, inverse };
        let taken: Vec<Pose> = poses.iter().map(|pose| frames.pose(pose)).collect();
        if let Ok(fit) = fit_payload(&taken, options) {
            let rms = fit.rms.iter().take(3).map(|rms| rms * rms).sum::<f64>().sqrt();
            trials.push(FrameTrial { frames, rms });
        }
    }
    trials.sort_by(|a, b| a.rms.total_cmp(&b.rms));
    trials
}

impl Frames {
    /// A pose as recorded, with its frames taken so.
    fn pose(self, recorded: &Pose) -> Pose {
        let mut pose = *recorded;
        if self.inverse {
            pose.base_from_sensor.transpose_mut();
        }
        if self.wrench_in_base { pose.with_wrench_in_base(&pose.wrench) } else { pose }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Rotation3, Vector3, Vector6};

    use super::{Frames, Pose, try_frames};
    use crate::gravity::PayloadOptions;
    use crate::gravity::poses::turn;

    #[test]
    fn the_frames_that_were_meant_leave_least() {
        for (wrench_in_base, inverse) in [(false, false), (true, false), (false, true), (true, true)] {
            let poses: Vec<Pose> = (0..9)
                .map(|i| {
                    let i = f64::from(i);
                    let turned = Rotation3::from_euler_angles(0.7 * i, 0.4 * i + 0.3, 1.1 * i).into_inner();
                    let pull =
                        turned.transpose() * Vector3::new(0.0, 0.0, -3.0) + Vector3::new(1.0, -2.0, 0.5);
                    let noise = 0.01 * Vector3::new((5.0 * i).sin(), (7.0 * i).cos(), (11.0 * i).sin());
                    let torque = Vector3::new(0.01, 0.0, 0.03).cross(&pull);
                    let force = pull + noise;
                    let wrench = Vector6::new(force.x, force.y, force.z, torque.x, torque.y, torque.z);
                    let wrench = if wrench_in_base { turn(&turned, &wrench) } else { wrench };
                    Pose { base_from_sensor: if inverse { turned.transpose() } else { turned }, wrench }
                })
                .collect();
            let trials = try_frames(&poses, &PayloadOptions::default());
            assert_eq!(trials[0].frames, Frames { wrench_in_base, inverse }, "{trials:?}");
            // Other ways leave much, or have no answer.
            assert!(trials[0].rms < 0.02 && trials.iter().skip(1).all(|trial| trial.rms > 0.1), "{trials:?}");
        }
    }
}
