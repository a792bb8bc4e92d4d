//! What stands before the contact: readings to wrenches on the fingertip.

use fingertip::wrench::{Motion, Real, Wrench};

use crate::carried::Carried;
use crate::input::Convention;
use crate::sensor::{GaugeReading, NoWrench, Sensor};

/// `[sensor]` and `[payload]` of a scene, and its convention.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Front<T: Real> {
    pub(crate) convention: Convention,
    pub(crate) sensor: Option<Sensor<T>>,
    /// Temperature of the sensor where no reading tells it \[°C\].
    pub(crate) celsius: Option<T>,
    pub(crate) carried: Option<Carried<T>>,
}

impl<T: Real> Front<T> {
    /// The wrench on the fingertip that a reading tells of.
    #[inline]
    pub(crate) fn wrench(
        &mut self,
        reading: &GaugeReading<'_, T>,
        motion: Option<&Motion<T>>,
        time_step: T,
    ) -> Result<Wrench<T>, NoWrench> {
        let measured = self.measured(reading, time_step)?;
        match &self.carried {
            Some(carried) => Ok(carried.take_off(&measured, motion.ok_or(NoWrench::NoMotion)?)),
            None => Ok(measured),
        }
    }

    /// That wrench, with the load of what the sensor carries.
    #[inline]
    pub(crate) fn measured(
        &mut self,
        reading: &GaugeReading<'_, T>,
        time_step: T,
    ) -> Result<Wrench<T>, NoWrench> {
        let sensor = self.sensor.as_mut().ok_or(NoWrench::NoSensor)?;
        let reading = GaugeReading { celsius: reading.celsius.or(self.celsius), ..*reading };
        let calibrated = sensor.wrench(&reading, time_step)?;
        Ok(self.convention.wrench(calibrated.force(), calibrated.torque()))
    }
}
