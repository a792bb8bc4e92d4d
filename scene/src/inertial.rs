//! `[inertial_unit]`: an accelerometer and a gyroscope on the sensor, by whose readings the payload is taken off in motion.

use fingertip::wrench::{
    DelayLine, InertialReading, InertialUnit, MovingPayload, Payload, Real, RigidTransform, Sensor, Wrench,
};
use fingertip_calibration::file::InertialUnitFile;
use nalgebra::{Vector3, Vector6};
use serde::{Deserialize, Serialize};

use crate::fault::SceneProblem;

/// Samples that a delay reaches back.
const REMEMBERED: usize = 256;
/// What is stated nowhere \[s\].
const TIME_CONSTANT: f64 = 0.01;

/// `[inertial_unit]` of a scene: what is left out is taken from the payload's file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct InertialSection {
    #[serde(rename = "position_m", skip_serializing_if = "Option::is_none")]
    position: Option<[f64; 3]>,
    /// Rotation vector: axis times angle.
    #[serde(rename = "rotation_deg", skip_serializing_if = "Option::is_none")]
    rotation: Option<[f64; 3]>,
    #[serde(rename = "resting_rate_rad_per_s", skip_serializing_if = "Option::is_none")]
    resting_rate: Option<[f64; 3]>,
    #[serde(rename = "time_constant_s", skip_serializing_if = "Option::is_none")]
    time_constant: Option<f64>,
    #[serde(rename = "delay_s", skip_serializing_if = "Option::is_none")]
    delay: Option<f64>,
}

const fn range(key: &'static str, requirement: &'static str) -> SceneProblem {
    SceneProblem::Range { key, section: "inertial_unit", requirement }
}

impl InertialSection {
    /// The unit for a body, with what the body's file says of it.
    pub(crate) fn build<T: Real>(
        &self,
        of_file: Option<&InertialUnitFile>,
        body: Payload<T>,
        sample_rate: Option<f64>,
    ) -> Result<Moving<T>, SceneProblem> {
        let finite = "three finite numbers";
        let of_position = of_file.map(|file| file.position);
        let position = Vector3::from(self.position.or(of_position).unwrap_or_default()).map(T::literal);
        let unit = match (self.rotation, of_file) {
            (None, Some(file)) => {
                file.unit::<T>().map_err(|_| range("file", "a payload whose unit is one"))?.sensor_from_unit()
            }
            (rotation, _) => {
                let turn = Vector3::from(rotation.unwrap_or_default()).map(|x| T::literal(x.to_radians()));
                let turned = RigidTransform::<T, Sensor, Sensor>::from_axis_angle(turn, Vector3::zeros());
                turned.map_err(|_| range("rotation_deg", finite))?.rotation()
            }
        };
        let of_rest = of_file.map(|file| file.resting_rate);
        let resting = Vector3::from(self.resting_rate.or(of_rest).unwrap_or_default()).map(T::literal);
        let unit = InertialUnit::new(unit, position)
            .map_err(|_| range("position_m", finite))?
            .with_resting_rate(resting)
            .map_err(|_| range("resting_rate_rad_per_s", finite))?;
        let of_filter = of_file.map(|file| file.time_constant);
        let time_constant = T::literal(self.time_constant.or(of_filter).unwrap_or(TIME_CONSTANT));
        let payload = MovingPayload::new(body, unit, time_constant)
            .map_err(|_| range("time_constant_s", "a positive number of seconds"))?;
        let delay = self.delay.or(of_file.map(|file| file.delay)).unwrap_or_default();
        let line = if delay == 0.0 {
            None
        } else {
            let line = DelayLine::new(T::literal(delay.abs()))
                .map_err(|_| range("delay_s", "a finite number of seconds"))?;
            if sample_rate.is_some_and(|rate| !line.reaches(T::literal(rate))) {
                return Err(range("delay_s", "no more than 254 samples at `sample_rate_Hz`"));
            }
            Some(Box::new(line))
        };
        Ok(Moving { payload, line, delay: T::literal(delay) })
    }
}

/// Takes a payload off by the readings of an inertial unit, which come later or sooner than the wrench.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Moving<T: Real> {
    payload: MovingPayload<T>,
    /// For what comes sooner: the wrench, or the readings.
    line: Option<Box<DelayLine<T, 6, REMEMBERED>>>,
    /// So much later than the wrench the readings come \[s\].
    delay: T,
}

impl<T: Real> Moving<T> {
    /// By how much what is left comes later than the wrench, where it changes slowly \[s\].
    pub(crate) fn delay(&self) -> T {
        self.payload.delay() + self.delay.max(T::zero())
    }

    pub(crate) fn gravity(&self, reading: &InertialReading<T>) -> Vector3<T> {
        self.payload.gravity(reading)
    }

    pub(crate) fn zeroed_under(&mut self, gravity: Vector3<T>) {
        self.payload.zeroed_under(gravity);
    }

    pub(crate) fn take_off(
        &mut self,
        measured: &Wrench<T>,
        reading: &InertialReading<T>,
        time_step: T,
    ) -> Option<Wrench<T>> {
        let Some(line) = &mut self.line else { return self.payload.take_off(measured, reading, time_step) };
        if self.delay > T::zero() {
            let earlier = Wrench::from_components(&line.follow(&measured.components(), time_step));
            return self.payload.take_off(&earlier, reading, time_step);
        }
        let (a, w) = (&reading.acceleration, &reading.angular_velocity);
        let earlier = line.follow(&Vector6::new(a.x, a.y, a.z, w.x, w.y, w.z), time_step);
        let reading = InertialReading {
            acceleration: earlier.fixed_rows::<3>(0).into_owned(),
            angular_velocity: earlier.fixed_rows::<3>(3).into_owned(),
        };
        self.payload.take_off(measured, &reading, time_step)
    }

    pub(crate) fn start_anew(&mut self) {
        self.payload.start_anew();
        if let Some(line) = &mut self.line {
            line.start_anew();
        }
    }
}
