//! The load of a payload in motion, taken off with the readings of an inertial unit.

use nalgebra::{SVector, Vector3};

use crate::{BadInertialUnit, InertialReading, InertialUnit, Motion, Payload, Real, StateFilter, Wrench};

/// Takes the weight and the inertia of a [`Payload`] off the wrench, sample by sample, by what an accelerometer and a
/// gyroscope read.
///
/// No gyroscope tells the angular acceleration, and to difference what it reads is noisy. So the wrench, less all that needs
/// no angular acceleration, and the angular velocity go through one and the same [`StateFilter`], which tells the derivative
/// of what it gives; the rest of the load is linear in it. Nothing is approximated by that: filter and load change places.
/// What is left comes late by [`delay`](Self::delay). Formulas: `docs/theory/wrench.md#inertial-loads`.
///
/// ```
/// use fingertip_wrench::{InertialReading, InertialUnit, MovingPayload, Payload, Wrench};
/// use nalgebra::Vector3;
///
/// // 0.1 kg, 30 mm out along x, falls with its sensor: it weighs nothing, and neither does the accelerometer's mass.
/// let body = Payload::new(0.1, Vector3::new(0.03, 0.0, 0.0))?;
/// let mut moving = MovingPayload::new(body, InertialUnit::at_the_origin(), 0.002)?;
/// let falling = InertialReading { acceleration: Vector3::zeros(), angular_velocity: Vector3::zeros() };
/// let contact = moving.take_off(&Wrench::zero(), &falling, 1e-3);
/// assert_eq!(contact, Some(Wrench::zero()));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MovingPayload<T: Real> {
    body: Payload<T>,
    unit: InertialUnit<T>,
    gravity_at_zero: Vector3<T>,
    filter: StateFilter<T, 9>,
}

impl<T: Real> MovingPayload<T> {
    /// Of a body and an inertial unit, with the time constant of the filter \[s\].
    ///
    /// # Errors
    /// [`BadInertialUnit::TimeConstant`].
    pub fn new(body: Payload<T>, unit: InertialUnit<T>, time_constant: T) -> Result<Self, BadInertialUnit> {
        Ok(Self { body, unit, gravity_at_zero: Vector3::zeros(), filter: StateFilter::new(time_constant)? })
    }

    /// By how much what changes slowly comes late \[s\].
    #[inline]
    #[must_use]
    pub fn delay(&self) -> T {
        self.filter.delay()
    }

    /// The body.
    #[must_use]
    pub const fn body(&self) -> &Payload<T> {
        &self.body
    }

    /// The inertial unit.
    #[must_use]
    pub const fn unit(&self) -> &InertialUnit<T> {
        &self.unit
    }

    /// Gravity in the sensor frame at a reading of a sensor that rests \[m/s²\].
    #[inline]
    #[must_use]
    pub fn gravity(&self, reading: &InertialReading<T>) -> Vector3<T> {
        self.unit.motion(reading, &Vector3::zeros()).gravity
    }

    /// The zero of the wrench was taken with the body on, under this gravity in the sensor frame \[m/s²\]: what the body
    /// weighed then is in it already.
    pub fn zeroed_under(&mut self, gravity: Vector3<T>) {
        self.gravity_at_zero = gravity;
    }

    /// What is left of a measured wrench, `time_step` seconds after the one before. `None` if a number is not finite: the
    /// sample is then left out, and its time counts for the next.
    #[inline]
    pub fn take_off(
        &mut self,
        measured: &Wrench<T>,
        reading: &InertialReading<T>,
        time_step: T,
    ) -> Option<Wrench<T>> {
        let motion = self.unit.motion(reading, &Vector3::zeros());
        let gravity = motion.gravity - self.gravity_at_zero;
        let quiet = (*measured - self.body.load(&Motion { gravity, ..motion })).components();
        let turning = motion.angular_velocity;
        let input = SVector::<T, 9>::from_fn(|i, _| {
            let rows = if i < 6 { quiet.get(i) } else { turning.get(i - 6) };
            rows.copied().unwrap_or(T::zero())
        });
        let (value, derivative) = self.filter.follow(&input, time_step)?;
        let faster = derivative.fixed_rows::<3>(6).into_owned();
        let swing = Motion {
            gravity: faster.cross(&self.unit.position()),
            angular_velocity: Vector3::zeros(),
            angular_acceleration: faster,
        };
        let left = Wrench::from_components(&value.fixed_rows::<6>(0).into_owned()) - self.body.load(&swing);
        left.is_finite().then_some(left)
    }

    /// The next sample is the first, as after a pause.
    pub fn start_anew(&mut self) {
        self.filter.start_anew();
    }
}
