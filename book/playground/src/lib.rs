//! The library in a page: what a script of the page calls, and what it reads.
//!
//! A page sets what is played with by numbers ([`set_shape`], [`set`]), shows the place that is touched ([`aim`],
//! [`touch`]), and reads numbers back ([`value`], [`net`]). Lengths are in metres, forces in newtons, torques in newton
//! metres.
//!
//! The functions have their names in the WebAssembly module, which is what the attribute `unsafe(no_mangle)` is for: a
//! name that two functions had would be one function. Each name stands once. No pointer passes the border.

mod gauges;
mod play;
mod shape;

use std::cell::RefCell;

use nalgebra::Vector3;

use play::Play;

thread_local! {
    static PLAY: RefCell<Play> = RefCell::new(Play::default());
}

/// Chooses a shape by its place in the list of the page; 1 if there is none of this number.
#[unsafe(no_mangle)]
pub extern "C" fn set_shape(shape: u32) -> u32 {
    PLAY.with_borrow_mut(|play| u32::from(!play.set_shape(shape)))
}

/// Sets a number: the order is that of `play::Knobs`; 1 if there is none of this number.
#[unsafe(no_mangle)]
pub extern "C" fn set(knob: u32, value: f64) -> u32 {
    PLAY.with_borrow_mut(|play| u32::from(!play.knobs.set(knob, value)))
}

/// Puts the touch where a line of sight first meets the shape; 1 if it does not.
#[unsafe(no_mangle)]
pub extern "C" fn aim(x: f64, y: f64, z: f64, along_x: f64, along_y: f64, along_z: f64) -> u32 {
    let (from, along) = (Vector3::new(x, y, z), Vector3::new(along_x, along_y, along_z));
    PLAY.with_borrow_mut(|play| u32::from(!play.aim(&from, &along)))
}

/// Feels the touch. 0: a contact was found; otherwise the reason, as `play::number_of` numbers it.
#[unsafe(no_mangle)]
pub extern "C" fn touch() -> u32 {
    PLAY.with_borrow_mut(Play::touch)
}

/// A number of the last touch: the order is that of `play::Felt`. NaN where there is none.
#[unsafe(no_mangle)]
pub extern "C" fn value(place: u32) -> f64 {
    PLAY.with_borrow(|play| play.felt.get(place as usize).copied().unwrap_or(f64::NAN))
}

/// A coordinate of the net of the shape, by rings from its top to its foot; NaN beyond its end.
#[unsafe(no_mangle)]
pub extern "C" fn net(place: u32) -> f64 {
    PLAY.with_borrow(|play| play.net.get(place as usize).copied().unwrap_or(f64::NAN))
}

/// Condition number of gauges on a tube; NaN where they make no sensor.
///
/// `kind` is 0 for the layout of Bicchi & Dario 1987, 1 for three rosettes. `q` is the angle of the gauges \[rad\], `d`
/// how far the second ring is behind the first \[m\], `radius` the mean radius of the tube \[m\], `lever` nominal torque
/// over nominal force \[m\].
#[unsafe(no_mangle)]
pub extern "C" fn condition(kind: u32, q: f64, d: f64, radius: f64, lever: f64) -> f64 {
    gauges::condition(kind, q, d, radius, lever).unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests;
