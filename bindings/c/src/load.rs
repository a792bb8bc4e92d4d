//! What a sensor reports.

use core::ptr;

use fingertip::wrench::{Frame, Motion, Wrench};
use fingertip_scene::{GAUGES, GaugeReading};
use nalgebra::Vector3;

use crate::border::{read_many, read_numbers};
use crate::fault::Fault;

/// Most gauges of a sensor.
pub(crate) const MOST_GAUGES: usize = *GAUGES.end();

/// A force and a torque about the origin of the sensor frame.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ft_wrench {
    /// Newton.
    pub force: [f64; 3],
    /// Newton metre.
    pub torque: [f64; 3],
}

impl ft_wrench {
    /// One that the caller has just put together.
    #[inline(always)]
    pub(crate) fn read(pointer: *const Self) -> Result<Self, Fault> {
        let [fx, fy, fz, tx, ty, tz] = read_numbers(pointer.cast::<[f64; 6]>(), "wrench")?;
        Ok(Self { force: [fx, fy, fz], torque: [tx, ty, tz] })
    }

    /// In the frame that a call is about.
    #[inline(always)]
    pub(crate) fn wrench<F: Frame>(&self) -> Wrench<f64, F> {
        Wrench::on_fingertip(self.force.into(), self.torque.into())
    }

    #[inline(always)]
    pub(crate) fn of<F: Frame>(wrench: &Wrench<f64, F>) -> Self {
        Self { force: wrench.force().into(), torque: wrench.torque().into() }
    }

    #[inline(always)]
    pub(crate) fn is_finite(&self) -> bool {
        self.force.iter().chain(&self.torque).all(|x| x.is_finite())
    }
}

/// How the sensor moves, in the sensor frame.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ft_motion {
    /// Gravity less the acceleration of the sensor's origin, in m/s².
    pub gravity: [f64; 3],
    /// Radian per second.
    pub angular_velocity: [f64; 3],
    /// Radian per second squared.
    pub angular_acceleration: [f64; 3],
}

impl ft_motion {
    pub(crate) fn motion(&self) -> Motion<f64> {
        let [gravity, angular_velocity, angular_acceleration] =
            [self.gravity, self.angular_velocity, self.angular_acceleration].map(Vector3::from);
        Motion { gravity, angular_velocity, angular_acceleration }
    }
}

/// A reading of the gauges, and what was measured beside them. ft_reading_of makes one of gauges alone.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct ft_reading {
    /// The gauges, in the unit of the calibration.
    pub gauges: *const f64,
    /// How many there are.
    pub count: usize,
    /// A gauge that no load strains, which shows what drifts with all of them; NaN if there is none.
    pub dummy: f64,
    /// Temperature of the sensor in degrees Celsius; NaN if it is not known.
    pub celsius: f64,
    /// How the sensor moves, which a scene with a [payload] needs; NULL if it is not known.
    pub motion: *const ft_motion,
}

/// A reading of gauges alone.
#[unsafe(no_mangle)]
pub extern "C" fn ft_reading_of(gauges: *const f64, count: usize) -> ft_reading {
    ft_reading { gauges, count, dummy: f64::NAN, celsius: f64::NAN, motion: ptr::null() }
}

/// A reading on this side of the border.
pub(crate) struct Reading {
    gauges: [f64; MOST_GAUGES],
    count: usize,
    dummy: Option<f64>,
    celsius: Option<f64>,
    pub(crate) motion: Option<Motion<f64>>,
}

impl Reading {
    /// Copies what the caller's structure points to, if it is as many numbers as the sensor has gauges.
    #[inline(always)]
    pub(crate) fn of(reading: &ft_reading, needed: usize) -> Result<Self, Fault> {
        if reading.count != needed || needed > MOST_GAUGES {
            return Err(Fault::Size { what: "gauges", found: reading.count, needed });
        }
        let known = |number: f64| (!number.is_nan()).then_some(number);
        let motion = match reading.motion.is_null() {
            true => None,
            false => Some(crate::border::read(reading.motion, "motion")?.motion()),
        };
        Ok(Self {
            gauges: read_many(reading.gauges, needed, "gauges", 0.0)?,
            count: needed,
            dummy: known(reading.dummy),
            celsius: known(reading.celsius),
            motion,
        })
    }

    #[inline(always)]
    pub(crate) fn gauges(&self) -> GaugeReading<'_, f64> {
        GaugeReading {
            gauges: self.gauges.get(..self.count).unwrap_or_default(),
            dummy: self.dummy,
            celsius: self.celsius,
        }
    }
}
