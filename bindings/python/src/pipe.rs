//! A pipeline in either precision.

use fingertip::wrench::{InertialReading, Motion, Wrench};
use fingertip_scene::{ArrayReading, Felt, FusedTouch, GaugeReading, NoWrench, Pipeline, Scene};
use nalgebra::{Vector3, Vector6};
use pyo3::prelude::*;

use crate::errors;
use crate::touch::PyTouch;
use crate::value;

/// A pipeline in either precision.
#[derive(Clone)]
pub(crate) enum Pipe {
    Double(Box<Pipeline<f64>>),
    Single(Box<Pipeline<f32>>),
}

/// What is known of a reading beside it.
#[derive(Clone, Copy, Default)]
pub(crate) struct Beside {
    pub(crate) motion: Option<Motion<f64>>,
    pub(crate) celsius: Option<f64>,
    pub(crate) dummy: Option<f64>,
}

/// Calls a method of whichever it is.
macro_rules! each {
    ($pipe:expr, $pipeline:ident => $call:expr) => {
        match $pipe {
            Pipe::Double($pipeline) => $call,
            Pipe::Single($pipeline) => $call,
        }
    };
}
pub(crate) use each;

/// What a pipeline in single precision says, in the numbers of Python. By way of bytes, since the library has no other:
/// a microsecond, which matters to nobody who wants speed, as those take columns.
fn widened(felt: &Felt<f32>) -> PyResult<Felt<f64>> {
    let bytes = rmp_serde::to_vec_named(felt).map_err(errors::bad)?;
    value::from_bytes(&bytes)
}

fn narrowed(motion: &Motion<f64>) -> Motion<f32> {
    let narrow = |vector: &Vector3<f64>| vector.map(|x| x as f32);
    Motion {
        gravity: narrow(&motion.gravity),
        angular_velocity: narrow(&motion.angular_velocity),
        angular_acceleration: narrow(&motion.angular_acceleration),
    }
}

fn narrow_unit(unit: &InertialReading<f64>) -> InertialReading<f32> {
    let narrow = |vector: &Vector3<f64>| vector.map(|x| x as f32);
    InertialReading {
        acceleration: narrow(&unit.acceleration),
        angular_velocity: narrow(&unit.angular_velocity),
    }
}

impl Pipe {
    pub(crate) fn of(scene: &Scene, single: bool) -> PyResult<Self> {
        Ok(if single {
            Self::Single(Box::new(scene.pipeline_in().map_err(errors::scene)?))
        } else {
            Self::Double(Box::new(scene.pipeline()))
        })
    }

    /// How many gauges the sensor has, if the scene has one.
    pub(crate) fn gauges(&self) -> Option<usize> {
        each!(self, pipeline => pipeline.sensor().map(|sensor| sensor.gauges()))
    }

    pub(crate) fn carries(&self) -> bool {
        each!(self, pipeline => pipeline.carried().is_some())
    }

    #[inline]
    pub(crate) fn sense(&mut self, wrench: Wrench<f64>, time_step: f64) -> PyResult<PyTouch> {
        match self {
            Self::Double(pipeline) => Ok(PyTouch::from(pipeline.sense(wrench, time_step))),
            Self::Single(pipeline) => {
                let wrench = Wrench::from_components(&wrench.components().map(|x| x as f32));
                widened(pipeline.sense(wrench, time_step as f32)).map(PyTouch::from)
            }
        }
    }

    /// A wrench as the sensor reports it, with the weight of what it carries.
    pub(crate) fn sense_moving(
        &mut self,
        wrench: Wrench<f64>,
        motion: &Motion<f64>,
        time_step: f64,
    ) -> PyResult<Felt<f64>> {
        match self {
            Self::Double(pipeline) => Ok(*pipeline.sense_moving(wrench, motion, time_step)),
            Self::Single(pipeline) => {
                let wrench = Wrench::from_components(&wrench.components().map(|x| x as f32));
                widened(pipeline.sense_moving(wrench, &narrowed(motion), time_step as f32))
            }
        }
    }

    /// A wrench as the sensor reports it, and what the inertial unit of the scene reads.
    pub(crate) fn sense_inertial(
        &mut self,
        wrench: Wrench<f64>,
        unit: &InertialReading<f64>,
        time_step: f64,
    ) -> PyResult<Felt<f64>> {
        match self {
            Self::Double(pipeline) => {
                pipeline.sense_inertial(wrench, unit, time_step).copied().map_err(errors::reading)
            }
            Self::Single(pipeline) => {
                let wrench = Wrench::from_components(&wrench.components().map(|x| x as f32));
                let felt = pipeline.sense_inertial(wrench, &narrow_unit(unit), time_step as f32);
                widened(felt.map_err(errors::reading)?)
            }
        }
    }

    /// The same of gauges.
    pub(crate) fn sense_reading_inertial(
        &mut self,
        gauges: &[f64],
        unit: &InertialReading<f64>,
        beside: &Beside,
        time_step: f64,
    ) -> PyResult<Felt<f64>> {
        let Beside { celsius, dummy, .. } = *beside;
        match self {
            Self::Double(pipeline) => {
                let reading = GaugeReading { gauges, dummy, celsius };
                let felt = pipeline.sense_reading_inertial(&reading, unit, time_step);
                felt.copied().map_err(errors::reading)
            }
            Self::Single(pipeline) => {
                let gauges: Vec<f32> = gauges.iter().map(|x| *x as f32).collect();
                let (dummy, celsius) = (dummy.map(|x| x as f32), celsius.map(|x| x as f32));
                let reading = GaugeReading { gauges: &gauges, dummy, celsius };
                let felt = pipeline.sense_reading_inertial(&reading, &narrow_unit(unit), time_step as f32);
                widened(felt.map_err(errors::reading)?)
            }
        }
    }

    pub(crate) fn sense_reading(
        &mut self,
        gauges: &[f64],
        beside: &Beside,
        time_step: f64,
    ) -> PyResult<Felt<f64>> {
        let Beside { motion, celsius, dummy } = *beside;
        match self {
            Self::Double(pipeline) => {
                let reading = GaugeReading { gauges, dummy, celsius };
                let felt = pipeline.sense_reading(&reading, motion.as_ref(), time_step);
                felt.copied().map_err(errors::reading)
            }
            Self::Single(pipeline) => {
                let gauges: Vec<f32> = gauges.iter().map(|x| *x as f32).collect();
                let (dummy, celsius) = (dummy.map(|x| x as f32), celsius.map(|x| x as f32));
                let reading = GaugeReading { gauges: &gauges, dummy, celsius };
                let motion = motion.as_ref().map(narrowed);
                match pipeline.sense_reading(&reading, motion.as_ref(), time_step as f32) {
                    Ok(felt) => widened(felt),
                    Err(why) => Err(errors::reading(why)),
                }
            }
        }
    }

    /// What the wrench of the last sample and an array tell together.
    pub(crate) fn fuse(&self, readings: &[ArrayReading<f64>]) -> PyResult<FusedTouch<f64>> {
        match self {
            Self::Double(pipeline) => pipeline.fuse(readings).map_err(errors::reading),
            Self::Single(pipeline) => {
                let narrowed = |reading: &ArrayReading<f64>| ArrayReading {
                    centroid: reading.centroid.map(|x| x as f32),
                    normal_force: reading.normal_force as f32,
                };
                let readings: Vec<ArrayReading<f32>> = readings.iter().map(narrowed).collect();
                let fused = pipeline.fuse(&readings).map_err(errors::reading)?;
                let bytes = rmp_serde::to_vec_named(&fused).map_err(errors::bad)?;
                value::from_bytes(&bytes)
            }
        }
    }

    /// Takes a reading of the rest.
    pub(crate) fn rest(&mut self, gauges: &[f64], beside: &Beside) -> Result<(), NoWrench> {
        let Beside { celsius, dummy, .. } = *beside;
        match self {
            Self::Double(pipeline) => pipeline.sensor_mut().map_or(Err(NoWrench::NoSensor), |sensor| {
                sensor.rest(&GaugeReading { gauges, dummy, celsius })
            }),
            Self::Single(pipeline) => {
                let gauges: Vec<f32> = gauges.iter().map(|x| *x as f32).collect();
                let (dummy, celsius) = (dummy.map(|x| x as f32), celsius.map(|x| x as f32));
                let reading = GaugeReading { gauges: &gauges, dummy, celsius };
                pipeline.sensor_mut().map_or(Err(NoWrench::NoSensor), |sensor| sensor.rest(&reading))
            }
        }
    }

    /// The zero of a sensor's rest: what may be wrong with it, and the noise of the wrench.
    pub(crate) fn end_rest(&mut self) -> PyResult<(Option<String>, Option<Vector6<f64>>)> {
        each!(self, pipeline => {
            let sensor = pipeline.sensor_mut().ok_or_else(|| errors::reading(NoWrench::NoSensor))?;
            sensor.end_rest().map_err(errors::reading)?;
            Ok((sensor.doubt().map(|doubt| doubt.to_string()), sensor.noise().map(|noise| noise.map(f64::from))))
        })
    }

    /// How the sensor lay in the rest.
    pub(crate) fn rest_carried(&mut self, gravity: &Vector3<f64>) {
        match self {
            Self::Double(pipeline) => {
                if let Some(carried) = pipeline.carried_mut() {
                    carried.rest(gravity);
                    carried.end_rest();
                }
            }
            Self::Single(pipeline) => {
                if let Some(carried) = pipeline.carried_mut() {
                    carried.rest(&gravity.map(|x| x as f32));
                    carried.end_rest();
                }
            }
        }
    }

    pub(crate) fn know_noise(&mut self, noise: &Vector6<f64>) -> PyResult<()> {
        match self {
            Self::Double(pipeline) => pipeline.know_noise(noise),
            Self::Single(pipeline) => pipeline.know_noise(&noise.map(|x| x as f32)),
        }
        .map_err(errors::scene)
    }
}
