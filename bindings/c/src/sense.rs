//! A sample: readings or a wrench in, a touch out.

use fingertip_scene::NoWrench;

use crate::border::{on, place, read};
use crate::fault::ft_status;
use crate::load::{Reading, ft_motion, ft_reading, ft_reading_of, ft_wrench};
use crate::tip::ft_tip;
use crate::touch::ft_touch;

/// Takes a wrench as the sensor reports it, by the scene's convention, and the time since the one before in s; a time
/// that is not positive counts as none. Allocates nothing. A wrench that is not finite is FT_OK, and no contact.
///
/// A scene with a [payload] fails with FT_NO_MOTION: see ft_sense_wrench_moving.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ft_sense_wrench(
    tip: *mut ft_tip,
    wrench: *const ft_wrench,
    time_step: f64,
    touch: *mut ft_touch,
) -> ft_status {
    on(tip, |tip| {
        let (reported, place) = (ft_wrench::read(wrench)?, place(touch, "touch")?);
        if tip.pipeline.carried().is_some() {
            return Err(NoWrench::NoMotion.into());
        }
        let loaded = tip.loaded(&reported);
        ft_touch::put(tip.pipeline.sense(loaded, time_step), place);
        Ok(())
    })
}

/// As ft_sense_wrench, with how the sensor moves: the weight and the inertia of a [payload] are taken off. Of a scene
/// without one, the motion does not matter.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ft_sense_wrench_moving(
    tip: *mut ft_tip,
    wrench: *const ft_wrench,
    motion: *const ft_motion,
    time_step: f64,
    touch: *mut ft_touch,
) -> ft_status {
    on(tip, |tip| {
        let (reported, motion) = (ft_wrench::read(wrench)?, read(motion, "motion")?);
        let place = place(touch, "touch")?;
        let loaded = tip.loaded(&reported);
        ft_touch::put(tip.pipeline.sense_moving(loaded, &motion.motion(), time_step), place);
        Ok(())
    })
}

/// Takes the signals of the gauges, in the unit of the calibration, as many as ft_tip_gauges says. Allocates nothing.
///
/// A reading that fails with FT_SATURATED or FT_INCOMPLETE is left out; the time of the next one counts from the one
/// before.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ft_sense(
    tip: *mut ft_tip,
    gauges: *const f64,
    count: usize,
    time_step: f64,
    touch: *mut ft_touch,
) -> ft_status {
    let reading = ft_reading_of(gauges, count);
    // SAFETY: what the caller promised of `gauges` is what is promised of the reading.
    unsafe { ft_sense_reading(tip, &raw const reading, time_step, touch) }
}

/// As ft_sense, with what was measured beside the gauges: a dummy gauge, the temperature, the motion.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ft_sense_reading(
    tip: *mut ft_tip,
    reading: *const ft_reading,
    time_step: f64,
    touch: *mut ft_touch,
) -> ft_status {
    on(tip, |tip| {
        let (reading, place) = (read(reading, "reading")?, place(touch, "touch")?);
        let reading = Reading::of(&reading, tip.gauges()?)?;
        let felt = tip.pipeline.sense_reading(&reading.gauges(), reading.motion.as_ref(), time_step)?;
        ft_touch::put(felt, place);
        Ok(())
    })
}
