//! A fingertip behind a handle.

use core::ffi::c_char;

use fingertip::wrench::Wrench;
use fingertip_scene::{Convention, Pipeline, RestWatch, Scene};
use nalgebra::{Vector3, Vector6};

use crate::border::{self, Keeps, on};
use crate::fault::{Fault, ft_status};
use crate::load::ft_wrench;
use crate::message::ft_error;

/// A fingertip: a scene that runs. Made by ft_tip_from_scene and its like, freed by ft_tip_free.
#[derive(Debug)]
pub struct ft_tip {
    pub(crate) pipeline: Pipeline<f64>,
    convention: Convention,
    /// What a sensor that reports wrenches reads without load, in its own sign.
    zero: Vector6<f64>,
    has_zero: bool,
    /// A rest of reported wrenches.
    pub(crate) resting: Option<RestWatch<f64, 6>>,
    /// The last rest of them, for what may be doubted of it.
    pub(crate) rested: Option<RestWatch<f64, 6>>,
    error: ft_error,
}

impl Keeps for ft_tip {
    fn kept(&mut self) -> &mut ft_error {
        &mut self.error
    }
}

impl ft_tip {
    pub(crate) fn new(scene: &Scene) -> Self {
        Self {
            pipeline: scene.pipeline(),
            convention: scene.convention(),
            zero: Vector6::zeros(),
            has_zero: false,
            resting: None,
            rested: None,
            error: ft_error::none(),
        }
    }

    /// The load on the fingertip of a wrench as the sensor reports it.
    #[inline(always)]
    pub(crate) fn loaded(&self, reported: &ft_wrench) -> Wrench<f64> {
        let (mut force, mut torque) = (Vector3::from(reported.force), Vector3::from(reported.torque));
        if self.has_zero {
            force -= self.zero.fixed_rows::<3>(0);
            torque -= self.zero.fixed_rows::<3>(3);
        }
        self.convention.wrench(force, torque)
    }

    pub(crate) const fn zero(&self) -> &Vector6<f64> {
        &self.zero
    }

    pub(crate) fn set_zero(&mut self, zero: &Vector6<f64>) {
        self.zero = *zero;
        self.has_zero = true;
    }

    /// The gauges that a reading must have.
    #[inline(always)]
    pub(crate) fn gauges(&self) -> Result<usize, Fault> {
        let sensor = self.pipeline.sensor().ok_or(fingertip_scene::NoWrench::NoSensor)?;
        Ok(sensor.gauges())
    }
}

/// Frees a fingertip and sets the variable that held it to NULL: to do so twice does no harm. NULL is left.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ft_tip_free(tip: *mut *mut ft_tip) {
    border::free(tip);
}

/// Why the last call of this fingertip failed that did: a sentence that stays until the next failure, empty before the
/// first. NULL has the sentence of FT_NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ft_tip_message(tip: *const ft_tip) -> *const c_char {
    if tip.is_null() {
        return crate::ft_status_text(1);
    }
    // SAFETY: a handle that nobody else uses now. No reference to the whole is made, since the caller reads the text while
    // it may call again.
    unsafe { (&raw const (*tip).error.message).cast() }
}

/// How many gauges a reading has: 0 for a scene without [sensor], which takes wrenches, and for NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ft_tip_gauges(tip: *const ft_tip) -> usize {
    // SAFETY: NULL, or a handle that nobody changes now.
    let tip = unsafe { tip.as_ref() };
    tip.and_then(|tip| tip.pipeline.sensor()).map_or(0, fingertip_scene::Sensor::gauges)
}

/// Forgets all samples and what was learnt of the friction: the next sample is the first. The zero stays.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ft_tip_reset(tip: *mut ft_tip) -> ft_status {
    on(tip, |tip| {
        tip.pipeline.reset();
        Ok(())
    })
}

/// Forgets the last contact and what the slip detector saw, as after a gap in the samples; what was learnt of the
/// friction stays. A time step of more than half a second does so by itself.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ft_tip_start_anew(tip: *mut ft_tip) -> ft_status {
    on(tip, |tip| {
        tip.pipeline.start_anew();
        Ok(())
    })
}
