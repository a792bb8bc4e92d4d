//! The weight and the inertia of what the sensor carries.

use nalgebra::{Matrix3, Vector3};
use thiserror::Error;

use crate::stored;
use crate::{Compensation, Motion, Real, Wrench};

/// A rigid body that hangs on the sensor all the time: the fingertip itself, a tool, a payload.
///
/// It loads the sensor by its weight, which turns with the hand, and by its inertia where the hand
/// accelerates. What is left of a wrench without this load is contact.
///
/// ```
/// use fingertip_wrench::{Frame, Motion, Payload, RigidTransform, Sensor, Wrench};
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
/// let gravity = world_from_sensor.inverse().rotate(&Vector3::new(0.0, 0.0, -9.80665));
/// let load = tip.load(&Motion::resting(gravity));
/// assert!((load.force().x + 0.020 * 9.80665).abs() < 1e-15);
///
/// let measured: Wrench<f64> = load + Wrench::on_fingertip(Vector3::new(0.0, 1.0, 0.0), Vector3::zeros());
/// let contact = measured - load;
/// assert!((contact.force().y - 1.0).abs() < 1e-15);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Payload<T: Real> {
    mass: T,
    centre_of_mass: Vector3<T>,
    inertia: Matrix3<T>,
}

/// Why numbers cannot be those of a body.
///
/// ```
/// use fingertip_wrench::{BadPayload, Payload};
/// use nalgebra::Vector3;
///
/// let refused = Payload::new(-0.02, Vector3::<f64>::zeros()).unwrap_err();
/// assert_eq!(refused, BadPayload::BadMass);
/// assert_eq!(refused.to_string(), "the mass of the payload is negative or not a finite number");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum BadPayload {
    /// The mass is negative, NaN or infinite.
    #[error("the mass of the payload is negative or not a finite number")]
    BadMass,
    /// A coordinate of the centre of mass is NaN or infinite.
    #[error("the centre of mass of the payload is not finite")]
    BadCentre,
    /// The inertia is no matrix of a body.
    #[error("the inertia of the payload is not finite, not symmetric, or negative about an axis")]
    BadInertia,
}

impl<T: Real> Payload<T> {
    /// From the mass \[kg\] and its centre in the sensor frame \[m\], as a point without inertia of its own
    /// about that centre.
    ///
    /// # Errors
    /// [`BadPayload`].
    pub fn new(mass: T, centre_of_mass: Vector3<T>) -> Result<Self, BadPayload> {
        if !(mass >= T::zero() && mass.is_number()) {
            Err(BadPayload::BadMass)
        } else if !centre_of_mass.iter().all(|x| x.is_number()) {
            Err(BadPayload::BadCentre)
        } else {
            Ok(Self { mass, centre_of_mass, inertia: Matrix3::zeros() })
        }
    }

    /// Nothing: a body without mass.
    #[must_use]
    pub fn none() -> Self {
        Self { mass: T::zero(), centre_of_mass: Vector3::zeros(), inertia: Matrix3::zeros() }
    }

    /// The same with its inertia about the centre of mass, along the axes of the sensor frame \[kg·m²\].
    ///
    /// # Errors
    /// [`BadPayload::BadInertia`] for a matrix that is not finite or not symmetric, or has a negative diagonal
    /// element.
    pub fn with_inertia(self, inertia: Matrix3<T>) -> Result<Self, BadPayload> {
        let finite = inertia.iter().all(|x| x.is_number());
        if finite && inertia == inertia.transpose() && inertia.diagonal().iter().all(|x| *x >= T::zero()) {
            Ok(Self { inertia, ..self })
        } else {
            Err(BadPayload::BadInertia)
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

    /// Inertia about the centre of mass, along the axes of the sensor frame \[kg·m²\].
    #[inline]
    #[must_use]
    pub const fn inertia(&self) -> Matrix3<T> {
        self.inertia
    }

    /// The load of the payload on a sensor at rest, given gravity in the sensor frame \[m/s²\]:
    /// `f = m g`, `m = c × f`.
    #[inline]
    #[must_use]
    pub fn weight(&self, gravity: &Vector3<T>) -> Wrench<T> {
        Wrench::from_force_at(&self.centre_of_mass, gravity * self.mass)
    }

    /// The load of the payload on a sensor in motion, by Newton and Euler (`docs/theory/wrench.md#payload`).
    ///
    /// A tare that was taken with the payload on has taken off its weight in that orientation. The rest is the
    /// load under the change of gravity since: subtract gravity at the tare, in the sensor frame then, from
    /// that of the motion.
    #[inline]
    #[must_use]
    pub fn load(&self, motion: &Motion<T>) -> Wrench<T> {
        let Motion { gravity, angular_velocity: turning, angular_acceleration } = motion;
        let centre = &self.centre_of_mass;
        let acceleration = angular_acceleration.cross(centre) + turning.cross(&turning.cross(centre));
        let inertial = self.inertia * angular_acceleration + turning.cross(&(self.inertia * turning));
        self.weight(&(gravity - acceleration)) - Wrench::on_fingertip(Vector3::zeros(), inertial)
    }
}

/// A measured wrench and the motion of the sensor become the wrench of the contact.
impl<T: Real> Compensation<Wrench<T>> for Payload<T> {
    type Raw = (Wrench<T>, Motion<T>);

    #[inline(always)]
    fn compensate(&self, (measured, motion): &(Wrench<T>, Motion<T>)) -> Wrench<T> {
        *measured - self.load(motion)
    }
}

stored! {
    Payload<T>, [T: Real],
    |payload| {
        mass: T = payload.mass,
        centre_of_mass: Vector3<T> = payload.centre_of_mass,
        #[serde(default = "Matrix3::zeros")] inertia: Matrix3<T> = payload.inertia,
    },
    Self::new(mass, centre_of_mass).and_then(|payload| payload.with_inertia(inertia))
}
