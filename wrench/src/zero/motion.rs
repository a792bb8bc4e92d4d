//! How the sensor moves, as far as that loads what it carries.

use nalgebra::Vector3;

use crate::Real;

/// Gravity and motion of the sensor at one sample, in its own frame: what the weight and the inertia of a
/// [`Payload`](crate::Payload) depend on.
///
/// ```
/// use fingertip_wrench::Motion;
/// use nalgebra::Vector3;
///
/// // An accelerometer at the origin of a resting sensor that points up reads +9.8 m/s² along z.
/// let resting = Motion::from_inertial_unit(Vector3::new(0.0, 0.0, 9.8), Vector3::zeros(), Vector3::zeros());
/// assert_eq!(resting, Motion::resting(Vector3::new(0.0, 0.0, -9.8)));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion<T: Real> {
    /// Gravity less the acceleration of the sensor's origin \[m/s²\].
    pub gravity: Vector3<T>,
    /// Angular velocity \[rad/s\].
    pub angular_velocity: Vector3<T>,
    /// Angular acceleration \[rad/s²\].
    pub angular_acceleration: Vector3<T>,
}

impl<T: Real> Motion<T> {
    /// Of a sensor at rest, or one that moves slowly: gravity in the sensor frame \[m/s²\].
    #[inline]
    #[must_use]
    pub fn resting(gravity: Vector3<T>) -> Self {
        Self { gravity, angular_velocity: Vector3::zeros(), angular_acceleration: Vector3::zeros() }
    }

    /// From an accelerometer at the origin of the sensor frame \[m/s²\], which reads acceleration less
    /// gravity, and a gyroscope \[rad/s\] and its derivative \[rad/s²\].
    #[inline]
    #[must_use]
    pub fn from_inertial_unit(
        acceleration: Vector3<T>,
        angular_velocity: Vector3<T>,
        angular_acceleration: Vector3<T>,
    ) -> Self {
        Self { gravity: -acceleration, angular_velocity, angular_acceleration }
    }
}
