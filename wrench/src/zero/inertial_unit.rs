//! An accelerometer and a gyroscope that ride on the sensor.

use nalgebra::{Matrix3, Vector3};
use thiserror::Error;

use crate::stored;
use crate::{Motion, Real};

/// One reading of an inertial unit, along its own axes.
///
/// ```
/// use fingertip_wrench::{InertialReading, InertialUnit};
/// use nalgebra::{Matrix3, Vector3};
///
/// // A unit 5 cm along x, on a sensor that turns about z with 2 rad/s, far from any weight.
/// let unit = InertialUnit::new(Matrix3::identity(), Vector3::new(0.05, 0.0, 0.0))?;
/// let turning = Vector3::new(0.0, 0.0, 2.0);
/// // It feels ω²r = 0.2 m/s² towards the axis, and the origin of the sensor nothing.
/// let reading = InertialReading { acceleration: Vector3::new(-0.2, 0.0, 0.0), angular_velocity: turning };
/// let motion = unit.motion(&reading, &Vector3::zeros());
/// assert!(motion.gravity.amax() < 1e-15_f64);
/// assert_eq!(motion.angular_velocity, turning);
/// # Ok::<(), fingertip_wrench::BadInertialUnit>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InertialReading<T: Real> {
    /// What the accelerometer reads, acceleration less gravity \[m/s²\]: a unit at rest reads 9.8 upwards.
    pub acceleration: Vector3<T>,
    /// What the gyroscope reads \[rad/s\].
    pub angular_velocity: Vector3<T>,
}

/// How an inertial unit sits on the sensor, and what it reads when nothing moves.
///
/// ```
/// use fingertip_wrench::{InertialReading, InertialUnit, Motion};
/// use nalgebra::{Matrix3, Vector3};
///
/// // 20 mm behind the sensor's origin, along its axes.
/// let unit = InertialUnit::new(Matrix3::identity(), Vector3::new(0.0, 0.0, -0.02))?;
/// let spinning = InertialReading {
///     acceleration: Vector3::new(0.0, 0.0, 9.8),
///     angular_velocity: Vector3::new(10.0, 0.0, 0.0),
/// };
/// // The unit turns about the sensor's x axis: at the origin, 2 m/s² less point towards that axis.
/// let motion = unit.motion(&spinning, &Vector3::zeros());
/// assert!((motion.gravity - Vector3::new(0.0, 0.0, -7.8)).norm() < 1e-12);
/// # Ok::<(), fingertip_wrench::BadInertialUnit>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InertialUnit<T: Real> {
    sensor_from_unit: Matrix3<T>,
    position: Vector3<T>,
    resting_rate: Vector3<T>,
}

/// Why numbers cannot be those of an inertial unit.
///
/// ```
/// use fingertip_wrench::{BadInertialUnit, InertialUnit};
/// use nalgebra::{Matrix3, Vector3};
///
/// let refused = InertialUnit::new(Matrix3::identity() * 2.0, Vector3::<f64>::zeros()).unwrap_err();
/// assert_eq!(refused, BadInertialUnit::Rotation);
/// let told = "the axes of the inertial unit are no rotation: orthonormal, determinant 1";
/// assert_eq!(refused.to_string(), told);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum BadInertialUnit {
    /// The rotation is none.
    #[error("the axes of the inertial unit are no rotation: orthonormal, determinant 1")]
    Rotation,
    /// A coordinate of its position is NaN or infinite.
    #[error("the position of the inertial unit is not finite")]
    Position,
    /// What the gyroscope reads at rest is NaN or infinite.
    #[error("what the gyroscope reads at rest is not finite")]
    RestingRate,
    /// The time constant of a filter is not positive.
    #[error("the time constant of the filter is not a positive, finite number of seconds")]
    TimeConstant,
    /// A delay is negative or not finite.
    #[error("a delay is negative or not a finite number of seconds")]
    Delay,
}

impl<T: Real> InertialUnit<T> {
    /// From its axes, which are the columns of the rotation, and the place of its accelerometer \[m\], in the sensor frame.
    ///
    /// # Errors
    /// [`BadInertialUnit`]. A rotation may be off by `64 ε^(1/2)`, as numbers with half the digits are.
    pub fn new(sensor_from_unit: Matrix3<T>, position: Vector3<T>) -> Result<Self, BadInertialUnit> {
        let slack = (sensor_from_unit * sensor_from_unit.transpose() - Matrix3::identity()).norm();
        let turns = slack < T::EPSILON.root() * T::literal(64.0);
        if !(turns && sensor_from_unit.determinant() > T::zero()) {
            return Err(BadInertialUnit::Rotation);
        }
        if !position.iter().all(|x| x.is_number()) {
            return Err(BadInertialUnit::Position);
        }
        Ok(Self { sensor_from_unit, position, resting_rate: Vector3::zeros() })
    }

    /// Its axes are those of the sensor, and it sits in its origin.
    #[must_use]
    pub fn at_the_origin() -> Self {
        Self {
            sensor_from_unit: Matrix3::identity(),
            position: Vector3::zeros(),
            resting_rate: Vector3::zeros(),
        }
    }

    /// The same with what its gyroscope reads at rest, along the unit's axes \[rad/s\]. The accelerometer's error at rest is
    /// not asked for: along the sensor's axes it is constant, and is taken off with the sensor's own.
    ///
    /// # Errors
    /// [`BadInertialUnit::RestingRate`].
    pub fn with_resting_rate(self, resting_rate: Vector3<T>) -> Result<Self, BadInertialUnit> {
        if resting_rate.iter().all(|x| x.is_number()) {
            Ok(Self { resting_rate, ..self })
        } else {
            Err(BadInertialUnit::RestingRate)
        }
    }

    /// Columns are the axes of the unit in the sensor frame.
    #[must_use]
    pub const fn sensor_from_unit(&self) -> Matrix3<T> {
        self.sensor_from_unit
    }

    /// Where the accelerometer sits, in the sensor frame \[m\].
    #[must_use]
    pub const fn position(&self) -> Vector3<T> {
        self.position
    }

    /// What the gyroscope reads at rest, along the unit's axes \[rad/s\].
    #[must_use]
    pub const fn resting_rate(&self) -> Vector3<T> {
        self.resting_rate
    }

    /// How the sensor's origin moves, in the sensor frame: an accelerometer at `r` reads `a* + α × r + ω × (ω × r)`, with
    /// `a*` what one at the origin reads (`docs/theory/wrench.md#inertial-loads`). The angular acceleration is given in the
    /// sensor frame \[rad/s²\]. What is not finite comes out so.
    #[inline]
    #[must_use]
    pub fn motion(&self, reading: &InertialReading<T>, angular_acceleration: &Vector3<T>) -> Motion<T> {
        let angular_velocity = self.turning(reading);
        let swing = angular_velocity.cross(&angular_velocity.cross(&self.position));
        let lever = angular_acceleration.cross(&self.position);
        let acceleration = self.sensor_from_unit * reading.acceleration - lever - swing;
        Motion::from_inertial_unit(acceleration, angular_velocity, *angular_acceleration)
    }

    /// The angular velocity in the sensor frame \[rad/s\].
    #[inline]
    #[must_use]
    pub fn turning(&self, reading: &InertialReading<T>) -> Vector3<T> {
        self.sensor_from_unit * (reading.angular_velocity - self.resting_rate)
    }
}

stored! {
    InertialUnit<T>, [T: Real],
    |unit| {
        sensor_from_unit: Matrix3<T> = unit.sensor_from_unit,
        position: Vector3<T> = unit.position,
        #[serde(default = "Vector3::zeros")] resting_rate: Vector3<T> = unit.resting_rate,
    },
    Self::new(sensor_from_unit, position).and_then(|unit| unit.with_resting_rate(resting_rate))
}
