//! The zero of the sensor.

use fingertip::wrench::{Sensor, TareError, Wrench};
use fingertip_scene::NoWrench;
use nalgebra::{Vector3, Vector6};

use crate::border::{on, place, read};
use crate::fault::{Fault, ft_status};
use crate::load::{Reading, ft_motion, ft_reading, ft_reading_of, ft_wrench};
use crate::message::ft_error;
use crate::tip::ft_tip;

/// The names of the channels of a sensor that reports wrenches.
const AXES: [&str; 6] = ["Fx", "Fy", "Fz", "Tx", "Ty", "Tz"];

impl ft_tip {
    fn rest_reading(&mut self, reading: &Reading) -> Result<(), Fault> {
        if self.pipeline.carried().is_some() && reading.motion.is_none() {
            return Err(NoWrench::NoMotion.into());
        }
        let sensor = self.pipeline.sensor_mut().ok_or(NoWrench::NoSensor)?;
        sensor.rest(&reading.gauges())?;
        if let (Some(carried), Some(motion)) = (self.pipeline.carried_mut(), &reading.motion) {
            carried.rest(&motion.gravity);
        }
        Ok(())
    }

    fn rest_wrench(&mut self, reported: &ft_wrench, motion: Option<&ft_motion>) -> Result<(), Fault> {
        if self.pipeline.carried().is_some() && motion.is_none() {
            return Err(NoWrench::NoMotion.into());
        }
        let wrench = components(reported);
        let load = Wrench::from_components(&wrench);
        if !self.resting.get_or_insert_default().add(&wrench, &wrench, &load) {
            return Err(NoWrench::Incomplete.into());
        }
        if let (Some(carried), Some(motion)) = (self.pipeline.carried_mut(), motion) {
            carried.rest(&Vector3::from(motion.gravity));
        }
        Ok(())
    }

    /// The zero of the rest that was taken, and its noise, where the scene waits for that.
    fn end_rest(&mut self) -> Result<(), Fault> {
        let noise = match self.resting.take() {
            Some(watch) => {
                self.set_zero(watch.tare()?.zero());
                self.rested.insert(watch).noise()
            }
            None => {
                let too_few = TareError::TooFewSamples { samples: 0 };
                let sensor = self.pipeline.sensor_mut().ok_or(too_few)?;
                sensor.end_rest()?;
                self.rested = None;
                sensor.noise()
            }
        };
        if let Some(carried) = self.pipeline.carried_mut() {
            carried.end_rest();
        }
        if let (true, Some(noise)) = (self.pipeline.awaits_noise(), noise) {
            self.pipeline.know_noise(&noise)?;
        }
        self.pipeline.start_anew();
        Ok(())
    }
}

fn components(reported: &ft_wrench) -> Vector6<f64> {
    reported.wrench::<Sensor>().components()
}

/// Takes the signals of the gauges while nothing touches: ft_end_rest makes their mean the zero.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ft_rest(tip: *mut ft_tip, gauges: *const f64, count: usize) -> ft_status {
    let reading = ft_reading_of(gauges, count);
    // SAFETY: what the caller promised of `gauges` is what is promised of the reading.
    unsafe { ft_rest_reading(tip, &raw const reading) }
}

/// As ft_rest, with what was measured beside the gauges. If the first reading of a rest has a dummy gauge, all later
/// ones need it, and what it shows to drift is taken off. A scene with a [payload] needs the motion.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ft_rest_reading(tip: *mut ft_tip, reading: *const ft_reading) -> ft_status {
    on(tip, |tip| {
        let reading = Reading::of(&read(reading, "reading")?, tip.gauges()?)?;
        tip.rest_reading(&reading)
    })
}

/// Takes a wrench as the sensor reports it while nothing touches: ft_end_rest makes their mean the zero.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ft_rest_wrench(tip: *mut ft_tip, wrench: *const ft_wrench) -> ft_status {
    on(tip, |tip| tip.rest_wrench(&read(wrench, "wrench")?, None))
}

/// As ft_rest_wrench, with how the sensor moves, which a scene with a [payload] needs.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ft_rest_wrench_moving(
    tip: *mut ft_tip,
    wrench: *const ft_wrench,
    motion: *const ft_motion,
) -> ft_status {
    on(tip, |tip| {
        let motion = read(motion, "motion")?;
        tip.rest_wrench(&read(wrench, "wrench")?, Some(&motion))
    })
}

/// The mean of the rest is the zero from now on, and its noise is known to a scene that asks for it. The next sample is
/// the first. Fails with FT_NO_REST, and leaves the zero, if there were fewer than two readings. See ft_rest_doubt.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ft_end_rest(tip: *mut ft_tip) -> ft_status {
    on(tip, ft_tip::end_rest)
}

/// Why the last rest may have been none: FT_DOUBTFUL and a sentence, or FT_OK. Allocates.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ft_rest_doubt(tip: *mut ft_tip, doubt: *mut ft_error) -> ft_status {
    let mut found = ft_status::FT_OK;
    let ended = on(tip, |tip| {
        let place = place(doubt, "doubt")?;
        let name = |axis: usize| (*AXES.get(axis).unwrap_or(&"?")).to_owned();
        let seen = match &tip.rested {
            Some(watch) => watch.doubt(name),
            None => tip.pipeline.sensor().and_then(fingertip_scene::Sensor::doubt),
        };
        place.put(match seen {
            Some(seen) => {
                found = ft_status::FT_DOUBTFUL;
                ft_error::of(found, &seen)
            }
            None => ft_error::none(),
        });
        Ok(())
    });
    if ended == ft_status::FT_OK { found } else { ended }
}

/// A reading that stands for no load, such as one that was stored. What a rest has taken so far is dropped.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ft_set_zero(tip: *mut ft_tip, reading: *const ft_reading) -> ft_status {
    on(tip, |tip| {
        let reading = Reading::of(&read(reading, "reading")?, tip.gauges()?)?;
        // On a copy: a reading that is none leaves the zero, and a rest that goes on is dropped.
        let mut sensor = tip.pipeline.sensor().cloned().ok_or(NoWrench::NoSensor)?;
        let _ = sensor.end_rest();
        sensor.rest(&reading.gauges())?;
        sensor.rest(&reading.gauges())?;
        sensor.end_rest()?;
        if let Some(kept) = tip.pipeline.sensor_mut() {
            *kept = sensor;
        }
        tip.resting = None;
        tip.pipeline.start_anew();
        Ok(())
    })
}

/// A wrench, as the sensor reports it, that stands for no load. What a rest has taken so far is dropped.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ft_set_zero_wrench(tip: *mut ft_tip, wrench: *const ft_wrench) -> ft_status {
    on(tip, |tip| {
        let zero = read(wrench, "wrench")?;
        if !zero.is_finite() {
            return Err(Fault::Number { name: "wrench", requirement: "finite" });
        }
        tip.set_zero(&components(&zero));
        tip.resting = None;
        tip.pipeline.start_anew();
        Ok(())
    })
}

/// The wrench that stands for no load, as the sensor reports it: that of the last rest of wrenches, or the one that was
/// set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ft_zero_wrench(tip: *mut ft_tip, wrench: *mut ft_wrench) -> ft_status {
    on(tip, |tip| {
        place(wrench, "wrench")?.put(ft_wrench::of(&Wrench::<f64>::from_components(tip.zero())));
        Ok(())
    })
}
