//! Why touches tell no shape.

use fingertip_surfaces::BadShape;
use thiserror::Error;

use crate::fit::FitError;
use crate::linear::Unobserved;

/// Why touches tell no shape.
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
/// use fingertip_calibration::geometry::{GeometryError, WrenchNoise, fit_sphere};
///
/// // One touch leaves a sphere open, and a normal of zero is none.
/// let mut touches = touched(Vector3::repeat(0.01), Vector3::zeros());
/// assert!(fit_sphere(&touches[..1], &WrenchNoise::exact_forces()).is_err());
/// touches[7].normal = Vector3::zeros();
/// let error = fit_sphere(&touches, &WrenchNoise::exact_forces()).unwrap_err();
/// assert!(matches!(error, GeometryError::BadTouch { touch: 7, .. }), "{error}");
/// ```
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum GeometryError {
    /// Too few touches, or numbers that are none.
    #[error(transparent)]
    Fit(#[from] FitError),
    /// The touches do not determine a part of the shape.
    #[error("the touches do not determine {what}: {reason}; {motion}")]
    Undetermined {
        /// Which parameter or combination of parameters.
        what: String,
        /// Why not.
        reason: String,
        /// The motion that is missing.
        motion: &'static str,
    },
    /// What was fitted is no shape.
    #[error("the touches give no shape: {0}")]
    BadShape(#[from] BadShape),
    /// A normal or axis has no direction, or a number is not finite.
    #[error("touch {touch}: {what}")]
    BadTouch {
        /// Which touch, from 0.
        touch: usize,
        /// What is wrong.
        what: &'static str,
    },
    /// What is said of the errors of wrenches cannot be.
    #[error(
        "the noise of the wrenches is no covariance: it must be finite, symmetric and not negative, and every torque \
         needs some"
    )]
    BadNoise,
    /// The search for the shape did not come to rest.
    #[error("no convergence after {iterations} iterations")]
    NoConvergence {
        /// How many were made.
        iterations: usize,
    },
}

/// What to do about a parameter that does not show.
fn motion(name: &str) -> &'static str {
    if ["radius", "shape", "semi-axis"].iter().any(|size| name.contains(size)) {
        "press with friction: the forces must lean away from the normals to several sides"
    } else if name.contains("turn") || name.starts_with("axis ") && !name.contains("offset") {
        "touch it on more sides and further apart"
    } else if name.contains("tilt") {
        "hold it still at points that lie further apart, and turn the force more at each"
    } else {
        "press in directions that lie further apart"
    }
}

impl GeometryError {
    /// No touch shows these parameters.
    pub(super) fn unobserved(mut unobserved: Unobserved, names: &[&str]) -> Self {
        unobserved.names = names.iter().map(|name| (*name).to_owned()).collect();
        Self::of(&unobserved, "nothing in the torques depends on it")
    }

    /// The errors of the forces make up most of what shows of these.
    pub(super) fn hidden(hidden: &Unobserved) -> Self {
        Self::of(hidden, "the errors of the forces are most of what shows of it")
    }

    fn of(unobserved: &Unobserved, reason: &str) -> Self {
        let motion = motion(unobserved.leading().unwrap_or_default());
        Self::Undetermined { what: unobserved.described(), reason: reason.to_owned(), motion }
    }

    /// A size that came out below zero \[m\].
    pub(super) fn negative(name: &str, size: f64) -> Self {
        let reason = format!("the torques ask for {:.2} mm", 1e3 * size);
        let motion = "see that normals point out of the fingertip, and press with friction to several sides";
        Self::Undetermined { what: name.to_owned(), reason, motion }
    }

    /// An interval of 95 % that is as wide as what it is about is large.
    pub(super) fn check_width(name: &str, width: f64, size: f64) -> Result<(), Self> {
        if width < size {
            return Ok(());
        }
        let angle = name.contains("turn") || name.contains("tilt");
        let (width, unit) = if angle { (width.to_degrees(), "°") } else { (1e3 * width, " mm") };
        let reason = format!("they leave ± {width:.2}{unit} (95 %)");
        Err(Self::Undetermined { what: name.to_owned(), reason, motion: motion(name) })
    }
}

#[cfg(test)]
mod tests {
    use super::GeometryError;

    fn reason(refused: Result<(), GeometryError>) -> Option<String> {
        match refused.err()? {
            GeometryError::Undetermined { what, reason, .. } => Some(format!("{what}: {reason}")),
            other => Some(other.to_string()),
        }
    }

    /// Lengths are said in millimetres and angles in degrees.
    #[test]
    fn intervals_are_said_in_their_units() {
        let width = |name, width, size| reason(GeometryError::check_width(name, width, size));
        assert_eq!(width("radius", 0.0099, 0.01), None);
        assert_eq!(width("radius", 0.01, 0.01).unwrap(), "radius: they leave ± 10.00 mm (95 %)");
        assert_eq!(width("tilt about x", 0.2, 0.1).unwrap(), "tilt about x: they leave ± 11.46° (95 %)");
        assert_eq!(width("turn about z", 0.2, 0.1).unwrap(), "turn about z: they leave ± 11.46° (95 %)");
        assert_eq!(width("radius", f64::NAN, 0.01).unwrap(), "radius: they leave ± NaN mm (95 %)");
        let negative = reason(Err(GeometryError::negative("height", -0.0015)));
        assert_eq!(negative.unwrap(), "height: the torques ask for -1.50 mm");
    }
}
