//! A fitted shape, and how sure it is.

use nalgebra::DMatrix;

use super::GeometryError;
use super::torques::Step;
use crate::fit::student_factor;

/// A fitted shape, and how sure it is.
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
/// use fingertip_calibration::geometry::{Fitted, WrenchNoise, fit_sphere};
/// use fingertip_surfaces::Sphere;
///
/// // A sphere of 12 mm; the torques scatter by about 0.05 N·mm under 2 N.
/// let mut touches = touched(Vector3::repeat(0.012), Vector3::new(0.0, 0.0, 0.03));
/// for (k, touch) in touches.iter_mut().enumerate() {
///     let error = Vector3::new((5.0 * k as f64).sin(), (7.0 * k as f64).cos(), (11.0 * k as f64).sin()) * 7e-5;
///     touch.wrench = Wrench::on_fingertip(touch.wrench.force(), touch.wrench.torque() + error);
/// }
/// let fitted: Fitted<Sphere<f64>> = fit_sphere(&touches, &WrenchNoise::exact_forces())?;
/// // The radius comes first; what is left is said as torque.
/// assert!((fitted.shape.radius() - 0.012).abs() < fitted.half_widths(0.999)[0]);
/// assert!(fitted.rms > 3e-5 && fitted.rms < 1e-4 && fitted.unobserved.is_empty());
/// # Ok::<(), fingertip_calibration::geometry::GeometryError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Fitted<S> {
    /// The shape.
    pub shape: S,
    /// Standard deviation of each parameter \[m\], in the order that the function tells.
    pub deviations: Vec<f64>,
    /// Degrees of freedom behind them.
    pub freedom: f64,
    /// RMS of the torque that is left, per component \[N·m\].
    pub rms: f64,
    /// What is left over what the stated noise would leave (root mean squares); near 1 where both shape and
    /// noise are as stated.
    pub noise_scale: f64,
    /// What the touches cannot tell of the shape, in words; empty if they tell everything.
    pub unobserved: Vec<String>,
}

impl<S> Fitted<S> {
    /// Half the width of the interval around each parameter that holds the true one with this probability:
    /// [`deviations`](Self::deviations) times the quantile of Student's distribution
    /// (`docs/theory/calibration.md#intervals`). NaN for a probability that is not between 0 and 1.
    #[must_use]
    pub fn half_widths(&self, probability: f64) -> Vec<f64> {
        let factor = student_factor(probability, self.freedom);
        self.deviations.iter().map(|deviation| deviation * factor).collect()
    }

    pub(super) fn of(shape: S, step: &Step, deviations: Vec<f64>) -> Self {
        Self {
            shape,
            deviations,
            freedom: step.freedom,
            rms: step.rms,
            noise_scale: step.variance().sqrt(),
            unobserved: Vec::new(),
        }
    }
}

/// Refuses what the touches leave open: each interval of 95 % must be narrower than the size beside its name.
pub(super) fn check_widths(
    step: &Step,
    deviations: &[f64],
    names: &[&str],
    sizes: &[f64],
) -> Result<(), GeometryError> {
    let factor = student_factor(0.95, step.freedom);
    for ((name, size), deviation) in names.iter().zip(sizes).zip(deviations) {
        GeometryError::check_width(name, factor * deviation, *size)?;
    }
    Ok(())
}

pub(super) fn roots(covariance: &DMatrix<f64>) -> Vec<f64> {
    covariance.diagonal().iter().map(|variance| variance.max(0.0).sqrt()).collect()
}
