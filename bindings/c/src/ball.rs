//! A fingertip without a file: a ball on a sensor.

use core::fmt::Write as _;
use core::ptr;

use fingertip_scene::{GAUGES, Scene};

use crate::border::{hand_out, place, read, told};
use crate::create::doubt;
use crate::fault::{Fault, finite, ft_status};
use crate::load::MOST_GAUGES;
use crate::message::ft_error;
use crate::tip::ft_tip;

/// A ball on a force/torque sensor, in numbers: what most fingertips are. Everything else takes a scene. The names are
/// those of the keys of a scene. ft_ball_defaults has values to begin with.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct ft_ball {
    /// Radius in m.
    pub radius_m: f64,
    /// Centre in the sensor frame, in m.
    pub centre_m: [f64; 3],
    /// 0 if the sensor reports the load on the fingertip, 1 if it reports the load on what the fingertip touches.
    pub reaction: u32,
    /// 0 for a point contact, 1 for a soft finger, which bears a spin torque.
    pub soft_finger: u32,
    /// Smaller forces are no contact, in N.
    pub least_force_n: f64,
    /// Friction coefficient; 0 for none.
    pub static_coefficient: f64,
    /// Of a soft finger with friction: its greatest spin torque over its greatest tangential force, in m.
    pub torque_arm_m: f64,
    /// Six rows of `gauges` numbers, one behind the other: Fx, Fy, Fz in N and Tx, Ty, Tz in N·m for a signal of 1. NULL
    /// for a sensor that reports wrenches.
    pub load_per_signal: *const f64,
    /// How many gauges there are, from 6 to 16; 0 for a sensor that reports wrenches.
    pub gauges: usize,
}

/// A ball of 10 mm around the origin of a sensor that reports the load on the fingertip: point contact, from 0.1 N on,
/// without friction.
#[unsafe(no_mangle)]
pub extern "C" fn ft_ball_defaults() -> ft_ball {
    ft_ball {
        radius_m: 0.01,
        centre_m: [0.0; 3],
        reaction: 0,
        soft_finger: 0,
        least_force_n: 0.1,
        static_coefficient: 0.0,
        torque_arm_m: 0.0,
        load_per_signal: ptr::null(),
        gauges: 0,
    }
}

/// Makes a fingertip of numbers. As to `error`, see ft_tip_from_scene.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ft_tip_from_ball(
    ball: *const ft_ball,
    tip: *mut *mut ft_tip,
    error: *mut ft_error,
) -> ft_status {
    told(error, || {
        let place = place(tip, "tip")?;
        let scene = Scene::from_text(&scene(&read(ball, "ball")?)?)?;
        hand_out(place, ft_tip::new(&scene));
        doubt(&scene, error);
        Ok(())
    })
}

/// As a scene, so that numbers are checked where those of files are.
fn scene(ball: &ft_ball) -> Result<String, Fault> {
    let flag = |name, value: u32| match value {
        0 | 1 => Ok(value == 1),
        _ => Err(Fault::Number { name, requirement: "0 or 1" }),
    };
    let soft = flag("soft_finger", ball.soft_finger)?;
    let convention = if flag("reaction", ball.reaction)? { "reaction" } else { "on_fingertip" };
    let mut text = format!("version = 2\nname = \"ball\"\n[input]\nconvention = \"{convention}\"\n");
    let [x, y, z] = ball.centre_m;
    for coordinate in ball.centre_m {
        finite("centre_m", coordinate)?;
    }
    // Writing to a string cannot fail.
    let _ = write!(
        text,
        "[surface]\nshape = \"sphere\"\nradius_m = {:?}\ncentre_m = [{x:?}, {y:?}, {z:?}]\n\
         [contact]\nmodel = \"{}\"\nleast_force_N = {:?}\n",
        finite("radius_m", ball.radius_m)?,
        if soft { "soft_finger" } else { "point" },
        finite("least_force_n", ball.least_force_n)?,
    );
    if finite("static_coefficient", ball.static_coefficient)? != 0.0 {
        let _ = write!(text, "[friction]\nstatic_coefficient = {:?}\n", ball.static_coefficient);
        if soft {
            let arm = finite("torque_arm_m", ball.torque_arm_m)?;
            let _ = write!(text, "limit = \"soft_finger\"\ntorque_arm_m = {arm:?}\n");
        }
    }
    sensor(ball, &mut text)?;
    Ok(text)
}

fn sensor(ball: &ft_ball, text: &mut String) -> Result<(), Fault> {
    if ball.load_per_signal.is_null() && ball.gauges == 0 {
        return Ok(());
    }
    if !GAUGES.contains(&ball.gauges) {
        return Err(Fault::Size { what: "gauges", found: ball.gauges, needed: *GAUGES.start() });
    }
    text.push_str("[sensor]\nsignal_unit = \"V\"\nload_per_signal_N_Nm = [\n");
    for row in 0..6 {
        // Within the six rows that the caller's memory has; NULL stays NULL and is refused.
        let row = ball.load_per_signal.wrapping_add(row * ball.gauges);
        let first = if ball.load_per_signal.is_null() { ptr::null() } else { row };
        let numbers: [f64; MOST_GAUGES] =
            crate::border::read_many(first, ball.gauges, "load_per_signal", 0.0)?;
        text.push('[');
        for number in numbers.iter().take(ball.gauges) {
            let _ = write!(text, "{:?}, ", finite("load_per_signal", *number)?);
        }
        text.push_str("],\n");
    }
    text.push_str("]\n");
    Ok(())
}
