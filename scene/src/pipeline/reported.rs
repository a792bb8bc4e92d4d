//! The ways into a pipeline for what a sensor reports: readings of gauges, and wrenches with the load of what it carries.

use fingertip::wrench::{InertialReading, Motion, Real, Wrench};

use super::{PAUSE, Pipeline};
use crate::felt::Felt;
use crate::sensor::{GaugeReading, NoWrench};

impl<T: Real> Pipeline<T> {
    /// Takes a wrench as the sensor reports it, that of what it carries included, and how the sensor moves: of a
    /// scene without `[payload]`, the motion does not matter. The rest is as in [`sense`](Self::sense).
    #[inline]
    pub fn sense_moving(&mut self, measured: Wrench<T>, motion: &Motion<T>, time_step: T) -> &Felt<T> {
        let wrench = match &self.front.carried {
            Some(carried) => carried.take_off(&measured, motion),
            None => measured,
        };
        self.sense(wrench, time_step)
    }

    /// Takes a wrench as the sensor reports it, that of what it carries included, and what the `[inertial_unit]` of the
    /// scene reads at the same time: weight and inertia of the `[payload]` are taken off, and what is left comes late by
    /// [`Carried::delay`](crate::Carried::delay). The rest is as in [`sense`](Self::sense).
    ///
    /// ```
    /// use fingertip::wrench::{InertialReading, Wrench};
    /// use fingertip_scene::Scene;
    /// use nalgebra::Vector3;
    ///
    /// let scene = Scene::from_text(
    ///     r#"
    ///     version = 2
    ///     [input]
    ///     convention = "on_fingertip"
    ///     [payload]
    ///     mass_kg = 0.1
    ///     [inertial_unit]
    ///     time_constant_s = 0.002
    ///     [surface]
    ///     shape = "sphere"
    ///     radius_m = 0.013
    ///     [contact]
    ///     least_force_N = 0.01
    ///     "#,
    /// )?;
    /// let mut pipeline = scene.pipeline();
    /// // At rest, upright: all the force is weight, and nothing touches.
    /// let unit = InertialReading { acceleration: Vector3::new(0.0, 0.0, 9.8), angular_velocity: Vector3::zeros() };
    /// let weight = Wrench::on_fingertip(Vector3::new(0.0, 0.0, -0.98), Vector3::zeros());
    /// assert!(pipeline.sense_inertial(weight, &unit, 1e-3)?.contact().is_none());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`NoWrench::NoMotion`] for a scene without `[inertial_unit]`, [`NoWrench::Incomplete`] for a number that is not finite;
    /// the sample then is left out, and the time of the next one should count from the one before.
    #[inline]
    pub fn sense_inertial(
        &mut self,
        measured: Wrench<T>,
        reading: &InertialReading<T>,
        time_step: T,
    ) -> Result<&Felt<T>, NoWrench> {
        let carried = self.front.carried.as_mut().filter(|carried| carried.has_inertial_unit());
        let carried = carried.ok_or(NoWrench::NoMotion)?;
        if time_step > T::literal(PAUSE) {
            carried.start_anew();
        }
        let left = carried.take_off_moving(&measured, reading, time_step).ok_or(NoWrench::Incomplete)?;
        Ok(self.sense(left, time_step))
    }

    /// Takes a reading of the gauges, which `[sensor]` turns into a wrench of the scene's convention; `motion` is
    /// needed for the weight of a `[payload]`. The rest is as in [`sense`](Self::sense).
    ///
    /// ```
    /// use fingertip_scene::{GaugeReading, Scene};
    ///
    /// let scene = Scene::from_text(
    ///     r#"
    ///     version = 2
    ///     [input]
    ///     convention = "on_fingertip"
    ///     [sensor]
    ///     signal_unit = "V"
    ///     load_per_signal_N_Nm = [
    ///         [5.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    ///         [0.0, 5.0, 0.0, 0.0, 0.0, 0.0],
    ///         [0.0, 0.0, 5.0, 0.0, 0.0, 0.0],
    ///         [0.0, 0.0, 0.0, 0.05, 0.0, 0.0],
    ///         [0.0, 0.0, 0.0, 0.0, 0.05, 0.0],
    ///         [0.0, 0.0, 0.0, 0.0, 0.0, 0.05],
    ///     ]
    ///     [surface]
    ///     shape = "sphere"
    ///     radius_m = 0.013
    ///     "#,
    /// )?;
    /// let mut pipeline = scene.pipeline();
    /// let felt = pipeline.sense_reading(&GaugeReading::of(&[0.0, 0.0, -0.2, 0.0, 0.0, 0.0]), None, 1e-3)?;
    /// assert!((felt.contact().unwrap().point.z - 0.013).abs() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`NoWrench`]; the sample then is left out, and the time of the next one should count from the one before.
    #[inline]
    pub fn sense_reading(
        &mut self,
        reading: &GaugeReading<'_, T>,
        motion: Option<&Motion<T>>,
        time_step: T,
    ) -> Result<&Felt<T>, NoWrench> {
        let wrench = self.front.wrench(reading, motion, time_step)?;
        Ok(self.sense(wrench, time_step))
    }

    /// Takes a reading of the gauges, and what the `[inertial_unit]` reads at the same time: as
    /// [`sense_inertial`](Self::sense_inertial) with the wrench that `[sensor]` makes of it.
    ///
    /// # Errors
    /// [`NoWrench`], as both.
    #[inline]
    pub fn sense_reading_inertial(
        &mut self,
        reading: &GaugeReading<'_, T>,
        unit: &InertialReading<T>,
        time_step: T,
    ) -> Result<&Felt<T>, NoWrench> {
        let measured = self.front.measured(reading, time_step)?;
        self.sense_inertial(measured, unit, time_step)
    }
}
