//! A touched point of an object.

use fingertip_wrench::{Frame, RigidTransform};
use nalgebra::{Matrix3, Vector3};

use super::ObjectError;

/// Where an object was touched, in the frame of the object.
///
/// The fingertip knows the place on itself, and its normal there; the pose of the fingertip takes both to the object. An
/// error of the place lies in the tangent plane, and turns the normal by what the fingertip bends.
///
/// ```
/// use fingertip_calibration::object::ObjectPoint;
/// use fingertip_wrench::{Frame, RigidTransform, Sensor};
/// use nalgebra::{Matrix3, Vector3};
///
/// #[derive(Clone, Copy, Debug, PartialEq)]
/// struct Object;
/// impl Frame for Object {
///     const NAME: &'static str = "object";
/// }
///
/// // A tip of 13 mm radius, whose sensor is 40 mm above the origin of the object, turned round to look down.
/// let down: RigidTransform<f64, Object, Sensor> =
///     RigidTransform::from_quaternion([0.0, 1.0, 0.0, 0.0], Vector3::new(0.0, 0.0, 0.04))?;
/// let (place, normal) = (Vector3::new(0.0, 0.0, 0.013), Vector3::z());
/// let uncertain = Matrix3::from_diagonal(&Vector3::new(1e-8, 1e-8, 0.0));
/// let bend = Matrix3::from_diagonal(&Vector3::new(77.0, 77.0, 0.0));
/// let touched = ObjectPoint::of_touch(&down, &place, &normal, &uncertain, &bend);
/// assert!((touched.point - Vector3::new(0.0, 0.0, 0.027)).norm() < 1e-15);
/// // The object is below, and faces up.
/// assert!((touched.normal - Vector3::z()).norm() < 1e-15);
/// # Ok::<(), fingertip_wrench::TransformError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObjectPoint {
    /// Where \[m\].
    pub point: Vector3<f64>,
    /// Outward normal of the object there; any length.
    pub normal: Vector3<f64>,
    /// Covariance of the place on the fingertip, in the tangent plane \[m²\].
    pub covariance: Matrix3<f64>,
    /// How the outward normal of the fingertip changes as the place on it does \[1/m\]: its shape operator.
    pub bend: Matrix3<f64>,
}

/// How far off the pose of the fingertip is, touch by touch.
///
/// ```
/// # use fingertip_calibration::object::{ObjectPoint, PoseNoise};
/// # use fingertip_calibration::nalgebra::{Matrix3, Vector3};
/// # // A touch of a sphere around the origin, from without (1) or within (−1), off by about 0.1 mm.
/// # let touched = |k: i32, radius: f64, side: f64| {
/// #     let (around, up) = (2.4 * f64::from(k), f64::from(k - 20) / 22.0);
/// #     let place = Vector3::new(around.cos(), around.sin(), 2.0 * up).normalize();
/// #     let error = Vector3::new((5.1 * f64::from(k)).sin(), (7.3 * f64::from(k)).cos(), (11.7 * f64::from(k)).sin());
/// #     ObjectPoint {
/// #         point: place * radius + error * 1e-4,
/// #         normal: place * side,
/// #         covariance: Matrix3::zeros(),
/// #         bend: Matrix3::zeros(),
/// #     }
/// # };
/// use fingertip_calibration::object::fit_sphere;
///
/// // Poses that were said to be exact to 0.01 mm, and are off by 0.1 mm: the fit finds that out.
/// let touches: Vec<ObjectPoint> = (0..40).map(|k| touched(k, 0.03, 1.0)).collect();
/// let said = fit_sphere(&touches, PoseNoise::new(1e-5, 1e-4)?)?.noise_scale;
/// let true_to_it = fit_sphere(&touches, PoseNoise::new(1e-4, 1e-3)?)?.noise_scale;
/// assert!(said > 5.0 * true_to_it);
/// # Ok::<(), fingertip_calibration::object::ObjectError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoseNoise {
    /// Standard deviation of the position along each axis \[m\].
    pub position: f64,
    /// Standard deviation of the orientation about each axis \[rad\].
    pub turn: f64,
}

impl PoseNoise {
    /// # Errors
    /// [`ObjectError::BadNoise`] unless both are finite and above zero.
    pub fn new(position: f64, turn: f64) -> Result<Self, ObjectError> {
        let good = |x: f64| x > 0.0 && x.is_finite();
        if good(position) && good(turn) { Ok(Self { position, turn }) } else { Err(ObjectError::BadNoise) }
    }
}

impl ObjectPoint {
    /// Of a contact in the frame of the sensor: its place \[m\], the outward normal of the fingertip there, the covariance of
    /// the place \[m²\], and the fingertip's shape operator \[1/m\]; `pose` takes that frame to the object's.
    pub fn of_touch<To: Frame, From: Frame>(
        pose: &RigidTransform<f64, To, From>,
        place: &Vector3<f64>,
        normal: &Vector3<f64>,
        covariance: &Matrix3<f64>,
        bend: &Matrix3<f64>,
    ) -> Self {
        let turn = pose.rotation();
        let turned = |m: &Matrix3<f64>| turn * m * turn.transpose();
        Self {
            point: turn * place + pose.origin(),
            normal: -(turn * normal),
            covariance: turned(covariance),
            bend: turned(bend),
        }
    }

    /// With a normal of unit length.
    pub(super) fn checked(&self, touch: usize) -> Result<Self, ObjectError> {
        let bad = |what| Err(ObjectError::BadPoint { touch, what });
        let numbers = self.point.iter().chain(&self.covariance).chain(&self.bend);
        if !numbers.into_iter().all(|x| x.is_finite()) {
            return bad("a number is not finite");
        }
        let length = self.normal.norm();
        if !(length > 0.0 && length.is_finite()) {
            return bad("the normal has no direction");
        }
        if !(self.covariance.diagonal().min() >= 0.0) {
            return bad("a variance is negative");
        }
        Ok(Self { normal: self.normal / length, ..*self })
    }
}
