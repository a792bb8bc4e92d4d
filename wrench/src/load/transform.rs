//! Rigid motion between two named frames.

use core::marker::PhantomData;
use core::ops::Mul;

use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};
use thiserror::Error;

use crate::stored;
use crate::{Frame, Real, Sensor};

/// Rotation and translation that take coordinates in frame `From` to coordinates in frame `To`.
///
/// Name values as `palm_from_tip`: then products read `palm_from_tip * tip_from_sensor`.
///
/// ```
/// use fingertip_wrench::{Frame, RigidTransform, Sensor, Wrench};
/// use nalgebra::Vector3;
///
/// #[derive(Clone, Copy, Debug, PartialEq)]
/// struct Palm;
/// impl Frame for Palm {
///     const NAME: &'static str = "palm";
/// }
///
/// // The sensor sits 0.1 m out along the palm's x axis, not turned.
/// let palm_from_sensor: RigidTransform<f64, Palm, Sensor> =
///     RigidTransform::translation(Vector3::new(0.1, 0.0, 0.0));
/// let in_sensor = Wrench::on_fingertip(Vector3::new(0.0, 0.0, -2.0), Vector3::zeros());
/// let in_palm = in_sensor.expressed_in(&palm_from_sensor);
/// assert!((in_palm.torque().y - 0.2).abs() < 1e-15);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidTransform<T: Real, To: Frame = Sensor, From: Frame = Sensor> {
    rotation: Matrix3<T>,
    origin: Vector3<T>,
    frames: PhantomData<(To, From)>,
}

/// Why a matrix and a vector are not a rigid motion.
///
/// ```
/// use fingertip_wrench::{RigidTransform, TransformError};
/// use nalgebra::{Matrix3, Vector3};
///
/// // A left-handed frame.
/// let mirror = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, -1.0));
/// let refused = RigidTransform::<f64>::from_matrix(mirror, Vector3::zeros()).unwrap_err();
/// assert_eq!(refused, TransformError::Reflection);
/// assert_eq!(refused.to_string(), "the rotation matrix is a reflection: its determinant is −1");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum TransformError {
    /// An entry is NaN or infinite.
    #[error("the transform has an entry that is not a finite number")]
    NotFinite,
    /// `RᵀR` differs from the identity by more than rounding can explain.
    #[error("the rotation matrix is not orthonormal")]
    NotOrthonormal,
    /// The matrix is a reflection.
    #[error("the rotation matrix is a reflection: its determinant is −1")]
    Reflection,
    /// The quaternion or axis has no direction.
    #[error("the rotation's axis or quaternion has zero length")]
    ZeroLength,
}

impl<T: Real, To: Frame, From: Frame> RigidTransform<T, To, From> {
    /// Frames that coincide.
    #[inline]
    #[must_use]
    pub fn identity() -> Self {
        Self::from_parts(Rotation3::identity(), Vector3::zeros())
    }

    /// Parallel frames; `origin` is the origin of `From` in coordinates of `To` \[m\].
    #[inline]
    #[must_use]
    pub fn translation(origin: Vector3<T>) -> Self {
        Self::from_parts(Rotation3::identity(), origin)
    }

    /// From a rotation and the origin of `From` in coordinates of `To` \[m\].
    #[inline]
    #[must_use]
    pub fn from_parts(rotation: Rotation3<T>, origin: Vector3<T>) -> Self {
        Self { rotation: rotation.into_inner(), origin, frames: PhantomData }
    }

    /// From a rotation matrix whose columns are the axes of `From` in coordinates of `To`, and the
    /// origin of `From` in coordinates of `To` \[m\].
    ///
    /// # Errors
    /// [`TransformError`] if an entry is not finite, or if the matrix is not a rotation: its
    /// columns may differ from orthonormal by `√ε` (matrices printed with few digits come from
    /// [`from_axis_angle`](Self::from_axis_angle) or a quaternion more safely). What is stored is the nearest
    /// rotation: one that is orthonormal but for rounding.
    pub fn from_matrix(rotation: Matrix3<T>, origin: Vector3<T>) -> Result<Self, TransformError> {
        if !rotation.iter().chain(origin.iter()).all(|x| x.is_number()) {
            return Err(TransformError::NotFinite);
        }
        let defect = rotation.transpose() * rotation - Matrix3::identity();
        if defect.amax() > T::EPSILON.root() {
            return Err(TransformError::NotOrthonormal);
        }
        if rotation.determinant() < T::zero() {
            return Err(TransformError::Reflection);
        }
        Ok(Self { rotation: orthonormal(rotation, defect.amax()), origin, frames: PhantomData })
    }

    /// From a rotation vector (axis times angle \[rad\]) and the origin of `From` in `To` \[m\].
    ///
    /// # Errors
    /// [`TransformError::NotFinite`] if an entry is NaN or infinite.
    pub fn from_axis_angle(axis_angle: Vector3<T>, origin: Vector3<T>) -> Result<Self, TransformError> {
        if !axis_angle.iter().chain(origin.iter()).all(|x| x.is_number()) {
            return Err(TransformError::NotFinite);
        }
        // The length by way of a vector near 1: its square would overflow for angles that do not.
        let scale = axis_angle.amax().normalising_factor();
        let scaled = axis_angle * scale;
        let length = scaled.norm_squared().root();
        let angle = length / scale;
        if !angle.is_number() {
            return Err(TransformError::NotFinite);
        }
        // Of no angle the axis is not asked.
        let axis = scaled / length;
        Ok(Self::from_parts(turned(&axis, angle), origin))
    }

    /// From a quaternion `(w, x, y, z)`, normalised here, and the origin of `From` in `To` \[m\].
    ///
    /// # Errors
    /// [`TransformError`] if an entry is not finite or the quaternion is zero.
    pub fn from_quaternion(wxyz: [T; 4], origin: Vector3<T>) -> Result<Self, TransformError> {
        if !wxyz.iter().chain(origin.iter()).all(|x| x.is_number()) {
            return Err(TransformError::NotFinite);
        }
        let [w, x, y, z] = wxyz;
        let largest = w.abs().max(x.abs()).max(y.abs()).max(z.abs());
        if largest <= T::zero() {
            return Err(TransformError::ZeroLength);
        }
        let k = largest.normalising_factor();
        let quaternion = UnitQuaternion::new_normalize(nalgebra::Quaternion::new(w * k, x * k, y * k, z * k));
        Ok(Self::from_parts(quaternion.to_rotation_matrix(), origin))
    }

    /// The rotation matrix: its columns are the axes of `From` in coordinates of `To`.
    #[inline]
    #[must_use]
    pub const fn rotation(&self) -> Matrix3<T> {
        self.rotation
    }

    /// The origin of `From` in coordinates of `To` \[m\].
    #[inline]
    #[must_use]
    pub const fn origin(&self) -> Vector3<T> {
        self.origin
    }

    /// A direction, force or torque, turned from `From` to `To`.
    #[inline]
    #[must_use]
    pub fn rotate(&self, direction: &Vector3<T>) -> Vector3<T> {
        self.rotation * direction
    }

    /// A point in coordinates of `From`, in coordinates of `To` \[m\].
    #[inline]
    #[must_use]
    pub fn transform_point(&self, point: &Vector3<T>) -> Vector3<T> {
        self.rotation * point + self.origin
    }

    /// The motion the other way.
    #[inline]
    #[must_use]
    pub fn inverse(&self) -> RigidTransform<T, From, To> {
        let rotation = self.rotation.transpose();
        RigidTransform { rotation, origin: -(rotation * self.origin), frames: PhantomData }
    }
}

impl<T: Real, A: Frame, B: Frame, C: Frame> Mul<RigidTransform<T, B, C>> for RigidTransform<T, A, B> {
    type Output = RigidTransform<T, A, C>;
    #[inline]
    fn mul(self, b_from_c: RigidTransform<T, B, C>) -> RigidTransform<T, A, C> {
        RigidTransform {
            rotation: self.rotation * b_from_c.rotation,
            origin: self.transform_point(&b_from_c.origin),
            frames: PhantomData,
        }
    }
}

/// The rotation about a unit vector by an angle \[rad\], `c·I + (1 − c)·a aᵀ + s·[a]×` (Rodrigues); of no angle the identity.
fn turned<T: Real>(axis: &Vector3<T>, angle: T) -> Rotation3<T> {
    if angle == T::zero() {
        return Rotation3::identity();
    }
    let (sine, cosine) = angle.sine_and_cosine();
    let mut matrix = axis * axis.transpose() * (T::one() - cosine) + (axis * sine).cross_matrix();
    // `a²(1 − c) + c` with one rounding of a number near 1 less.
    matrix.set_diagonal(&axis.map(|along| along * along + (T::one() - along * along) * cosine));
    Rotation3::from_matrix_unchecked(matrix)
}

/// The rotation nearest to a matrix whose defect `RᵀR − I` is at most `√ε`; one that is rounding is left as it is.
///
/// A step of Newton's method for the polar factor, `R (3 − RᵀR)/2` (Björck & Bowie 1971), squares the defect.
fn orthonormal<T: Real>(rotation: Matrix3<T>, defect: T) -> Matrix3<T> {
    if defect <= T::EPSILON * T::literal(4.0) {
        return rotation;
    }
    let mut nearest = rotation;
    for _ in 0..2 {
        let three = Matrix3::from_diagonal_element(T::literal(3.0));
        nearest = nearest * (three - nearest.transpose() * nearest) * T::literal(0.5);
    }
    nearest
}

stored! {
    RigidTransform<T, To, From>, [T: Real; To: Frame; From: Frame],
    |transform| { rotation: Matrix3<T> = transform.rotation, origin: Vector3<T> = transform.origin },
    Self::from_matrix(rotation, origin)
}
