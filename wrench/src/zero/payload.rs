//! The weight of what the sensor carries.

use nalgebra::Vector3;
use thiserror::Error;

use crate::stored;
use crate::{Frame, Real, RigidTransform, Wrench};

/// A rigid body that hangs on the sensor all the time: the fingertip itself, a tool, a payload.
///
/// Its weight is a load on the fingertip side that turns with the hand; what is left of a wrench once
/// it is subtracted is contact.
///
/// ```
/// use fingertip_wrench::{Frame, Payload, RigidTransform, Sensor, Wrench};
/// use nalgebra::Vector3;
///
/// #[derive(Clone, Copy, Debug, PartialEq)]
/// struct World;
/// impl Frame for World {
///     const NAME: &'static str = "world";
/// }
///
/// // 20 g, 15 mm along the sensor's x axis; the finger points up.
/// let tip = Payload::new(0.020, Vector3::new(0.015, 0.0, 0.0))?;
/// let upright = Vector3::new(0.0, -core::f64::consts::FRAC_PI_2, 0.0);
/// let world_from_sensor = RigidTransform::<f64, World, Sensor>::from_axis_angle(upright, Vector3::zeros())?;
/// let gravity = Vector3::new(0.0, 0.0, -9.80665);
/// let weight = tip.weight(&world_from_sensor.inverse().rotate(&gravity));
/// assert!((weight.force().x + 0.020 * 9.80665).abs() < 1e-15);
///
/// let measured: Wrench<f64> = weight + Wrench::on_fingertip(Vector3::new(0.0, 1.0, 0.0), Vector3::zeros());
/// let contact = tip.without_weight(&measured, &world_from_sensor.inverse(), &gravity);
/// assert!((contact.force().y - 1.0).abs() < 1e-15);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Payload<T: Real> {
    mass: T,
    centre_of_mass: Vector3<T>,
}

/// Why a mass cannot be one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum BadPayload {
    /// The mass is negative, NaN or infinite.
    #[error("the mass of the payload is negative or not a finite number")]
    BadMass,
    /// A coordinate of the centre of mass is NaN or infinite.
    #[error("the centre of mass of the payload is not finite")]
    BadCentre,
}

impl<T: Real> Payload<T> {
    /// From the mass \[kg\] and its centre in the sensor frame \[m\].
    ///
    /// # Errors
    /// [`BadPayload`].
    pub fn new(mass: T, centre_of_mass: Vector3<T>) -> Result<Self, BadPayload> {
        if !(mass >= T::zero() && mass.is_number()) {
            Err(BadPayload::BadMass)
        } else if !centre_of_mass.iter().all(|x| x.is_number()) {
            Err(BadPayload::BadCentre)
        } else {
            Ok(Self { mass, centre_of_mass })
        }
    }

    /// Mass \[kg\].
    #[inline]
    #[must_use]
    pub const fn mass(&self) -> T {
        self.mass
    }

    /// Centre of mass in the sensor frame \[m\].
    #[inline]
    #[must_use]
    pub const fn centre_of_mass(&self) -> Vector3<T> {
        self.centre_of_mass
    }

    /// The load of the payload on the sensor, given gravity in the sensor frame \[m/s²\]:
    /// `f = m g`, `m = c × f`.
    ///
    /// For a hand that accelerates, give gravity less the acceleration of the centre of mass: what
    /// an accelerometer there reads, negated. The torque of angular acceleration is not included.
    #[inline]
    #[must_use]
    pub fn weight(&self, gravity_in_sensor: &Vector3<T>) -> Wrench<T> {
        Wrench::from_force_at(&self.centre_of_mass, gravity_in_sensor * self.mass)
    }

    /// A measured wrench less the payload's weight, given the orientation of the sensor and gravity
    /// in frame `World` \[m/s²\]. Only the rotation of the transform is used.
    ///
    /// The wrench must not have been tared with the payload on in another orientation: a tare takes
    /// the weight off with it, as it was then. [`weight_change`](Self::weight_change) is for that.
    #[inline]
    #[must_use]
    pub fn without_weight<World: Frame>(
        &self,
        measured: &Wrench<T>,
        sensor_from_world: &RigidTransform<T, crate::Sensor, World>,
        gravity: &Vector3<T>,
    ) -> Wrench<T> {
        *measured - self.weight(&sensor_from_world.rotate(gravity))
    }

    /// By how much the weight differs from what it was at the tare, given gravity in the sensor
    /// frame now and then \[m/s²\]: what to subtract from a wrench that was tared with the payload
    /// on.
    #[inline]
    #[must_use]
    pub fn weight_change(&self, gravity_now: &Vector3<T>, gravity_at_tare: &Vector3<T>) -> Wrench<T> {
        self.weight(&(gravity_now - gravity_at_tare))
    }
}

stored! {
    Payload<T>, [T: Real],
    |payload| { mass: T = payload.mass, centre_of_mass: Vector3<T> = payload.centre_of_mass },
    Self::new(mass, centre_of_mass)
}
