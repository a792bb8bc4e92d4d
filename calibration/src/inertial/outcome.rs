//! What a motion told of what the sensor carries.

use fingertip_wrench::{InertialUnit, StateFilter};
use nalgebra::{DMatrix, Matrix3, Vector3, Vector6};

use super::body::Body;
use crate::file::{FileError, InertialUnitFile, PayloadFile, PayloadQuality, Verdict};

/// By how much the inertial readings come later than the wrench.
///
/// ```
/// # use fingertip_calibration::inertial::MovingSample;
/// # use fingertip_calibration::nalgebra::{Vector3, Vector6};
/// # use fingertip_wrench::InertialReading;
/// # // 0.4 kg in the sensor's origin, shaken for 4 s: the force is −m times what the accelerometer reads.
/// # let samples: Vec<MovingSample> = (0..4000).map(|k| {
/// #     let t = 1e-3 * f64::from(k);
/// #     let a = Vector3::new(3.0 * (9.0 * t).sin(), 2.0 * (7.0 * t).cos(), 9.8 + (5.0 * t).sin());
/// #     let reading = InertialReading { acceleration: a, angular_velocity: Vector3::zeros() };
/// #     let f = -0.4 * a;
/// #     MovingSample { time: t, wrench: Vector6::new(f.x, f.y, f.z, 0.0, 0.0, 0.0), reading }
/// # }).collect();
/// # let mut samples = samples;
/// use fingertip_calibration::inertial::{Delay, InertialOptions, fit_inertial};
///
/// // The readings of the accelerometer come 5 ms late.
/// for k in (5..samples.len()).rev() {
///     samples[k].reading = samples[k - 5].reading;
/// }
/// let options = InertialOptions { longest_delay: 0.02, ..InertialOptions::default() };
/// let delay: Delay = fit_inertial(&samples, &options)?.delay.ok_or("not found")?;
/// assert!((delay.seconds - 5e-3).abs() < 1e-3);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Delay {
    /// \[s\]; negative if the wrench comes later.
    pub seconds: f64,
    /// Standard deviation \[s\].
    pub deviation: f64,
}

/// What a motion told.
///
/// ```
/// # use fingertip_calibration::inertial::MovingSample;
/// # use fingertip_calibration::nalgebra::{Vector3, Vector6};
/// # use fingertip_wrench::InertialReading;
/// # // 0.4 kg in the sensor's origin, shaken for 4 s: the force is −m times what the accelerometer reads.
/// # let samples: Vec<MovingSample> = (0..4000).map(|k| {
/// #     let t = 1e-3 * f64::from(k);
/// #     let a = Vector3::new(3.0 * (9.0 * t).sin(), 2.0 * (7.0 * t).cos(), 9.8 + (5.0 * t).sin());
/// #     let reading = InertialReading { acceleration: a, angular_velocity: Vector3::zeros() };
/// #     let f = -0.4 * a;
/// #     MovingSample { time: t, wrench: Vector6::new(f.x, f.y, f.z, 0.0, 0.0, 0.0), reading }
/// # }).collect();
/// use fingertip_calibration::inertial::{InertialFit, InertialOptions, fit_inertial};
///
/// // 0.4 kg in the sensor's origin, shaken along each axis.
/// let fit: InertialFit = fit_inertial(&samples, &InertialOptions::default())?;
/// assert!((fit.body.mass - 0.4).abs() < 1e-4 && fit.body.centre.norm() < 1e-4);
/// assert!(fit.share_left() < 1e-2);
/// // It did not turn, and what this leaves open is named.
/// assert!(fit.undetermined.contains(&"inertia zz"));
/// # Ok::<(), fingertip_calibration::inertial::InertialError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct InertialFit {
    /// Mass, centre and inertia, as a body can have them.
    pub body: Body,
    /// Standard deviation of the mass \[kg\].
    pub mass_deviation: f64,
    /// Standard deviations of the centre of mass \[m\].
    pub centre_deviation: Vector3<f64>,
    /// Standard deviations of the entries of the inertia about the centre of mass \[kg·m²\].
    pub inertia_deviation: Matrix3<f64>,
    /// The least second moment as fitted, before it was brought to a body's: see
    /// [`Consistency`](super::Consistency) \[kg·m²\].
    pub least_moment: f64,
    /// Force that the sensor reads without load \[N\]; the accelerometer's error at rest is in it.
    pub force_bias: Vector3<f64>,
    /// Torque that the sensor reads without load \[N·m\].
    pub torque_bias: Vector3<f64>,
    /// Standard deviations of force and torque without load \[N, N·m\].
    pub bias_deviation: Vector6<f64>,
    /// The delay, if it was sought.
    pub delay: Option<Delay>,
    /// How the inertial unit sits on the sensor, and what its gyroscope reads at rest.
    pub unit: InertialUnit<f64>,
    /// Time constant of the filter behind which it was fitted \[s\].
    pub time_constant: f64,
    /// RMS of the wrench behind the filter, without its mean \[N, N·m\].
    pub load: Vector6<f64>,
    /// RMS of what is left of it \[N, N·m\].
    pub left: Vector6<f64>,
    /// Standard deviation of what is left at rest behind the same filter, the noise of the wrench and of the inertial unit
    /// \[N, N·m\], if a rest was told.
    pub noise: Option<Vector6<f64>>,
    /// Length of what the accelerometer read at rest \[m/s²\], if a rest was told.
    pub gravity_read: Option<f64>,
    /// What the motion told next to nothing of.
    pub undetermined: Vec<&'static str>,
    /// Covariance of mass, first moment (3), inertia about the origin (xx, xy, xz, yy, yz, zz), force and torque without load,
    /// and the delay, in SI.
    pub covariance: DMatrix<f64>,
    /// How many rows, one time constant apart, were fitted.
    pub rows: usize,
    /// What to mind.
    pub warnings: Vec<String>,
}

impl InertialFit {
    /// By how much the readings come late behind the filter \[s\].
    #[must_use]
    pub fn filter_delay(&self) -> f64 {
        StateFilter::<f64, 1>::new(self.time_constant).map_or(0.0, |filter| filter.delay())
    }

    /// What is left, in deviations of the noise at rest behind the same filter, at worst over the components; `None` without a
    /// rest.
    #[must_use]
    pub fn over_noise(&self) -> Option<f64> {
        let noise = self.noise?;
        let ratio = |(left, noise): (&f64, &f64)| left / noise.max(f64::MIN_POSITIVE);
        Some(self.left.iter().zip(noise.iter()).map(ratio).fold(0.0, f64::max))
    }

    /// Share of the force that is left.
    #[must_use]
    pub fn share_left(&self) -> f64 {
        let norm = |v: &Vector6<f64>| v.fixed_rows::<3>(0).norm();
        norm(&self.left) / norm(&self.load).max(f64::MIN_POSITIVE)
    }

    /// Whether it can be trusted: bad if a fifth of the force is left, or the mass is known to a tenth only; suspect if
    /// there is anything else to mind.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        if self.share_left() > 0.2 || self.mass_deviation > 0.1 * self.body.mass {
            Verdict::Bad
        } else if self.warnings.is_empty() {
            Verdict::Good
        } else {
            Verdict::Suspect
        }
    }

    /// As a payload file, with the inertial unit that takes it off under motion.
    ///
    /// # Errors
    /// [`FileError`] if a number is not finite.
    pub fn to_file(&self) -> Result<PayloadFile, FileError> {
        let down = Vector3::new(0.0, 0.0, -fingertip_wrench::units::STANDARD_GRAVITY);
        let mut file = PayloadFile::new(self.body.mass, self.body.centre, down)?;
        let rows = |matrix: &Matrix3<f64>| core::array::from_fn(|i| core::array::from_fn(|j| matrix[(i, j)]));
        file.inertia = rows(&self.body.inertia);
        file.force_bias = self.force_bias.into();
        file.torque_bias = self.torque_bias.into();
        file.inertial_unit = Some(InertialUnitFile {
            position: self.unit.position().into(),
            sensor_from_unit: rows(&self.unit.sensor_from_unit()),
            resting_rate: self.unit.resting_rate().into(),
            time_constant: self.time_constant,
            delay: self.delay.map_or(0.0, |delay| delay.seconds),
        });
        file.quality = PayloadQuality {
            poses: self.rows as u64,
            mass_deviation: self.mass_deviation,
            centre_deviation: self.centre_deviation.into(),
            rms: self.left.into(),
            warnings: self.warnings.clone(),
            verdict: self.verdict(),
        };
        file.provenance.method = "motion, by an inertial unit".to_owned();
        file.validate()?;
        Ok(file)
    }
}
