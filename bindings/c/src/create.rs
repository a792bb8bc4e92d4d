//! Fingertips of scenes.

use core::ffi::c_char;

use fingertip_scene::Scene;

use crate::border::{hand_out, place, text, told};
use crate::fault::ft_status;
use crate::message::ft_error;
use crate::tip::ft_tip;

/// Makes a fingertip of the text of a scene (book/src/reference/scene.md has its keys). Files that it names are looked for
/// in the working directory.
///
/// `error` may be NULL. It tells why there is no fingertip, and of one that was made, with FT_OK, what in the scene can
/// be and is hardly meant, such as a radius of 13 m; the message is empty if nothing is.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ft_tip_from_scene(
    scene: *const c_char,
    tip: *mut *mut ft_tip,
    error: *mut ft_error,
) -> ft_status {
    told(error, || {
        let place = place(tip, "tip")?;
        let scene = Scene::from_text(text(scene, "scene")?)?;
        hand_out(place, ft_tip::new(&scene));
        doubt(&scene, error);
        Ok(())
    })
}

/// Makes a fingertip of a scene in a file. Files that it names are looked for beside it. `calibration` is the path of
/// a calibration to take in the place of the scene's [sensor], or NULL. As to `error`, see ft_tip_from_scene.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ft_tip_from_file(
    scene: *const c_char,
    calibration: *const c_char,
    tip: *mut *mut ft_tip,
    error: *mut ft_error,
) -> ft_status {
    told(error, || {
        let place = place(tip, "tip")?;
        let mut scene =
            Scene::load(text(scene, "scene")?).map_err(|fault| crate::fault::Fault::File(Box::new(fault)))?;
        if !calibration.is_null() {
            scene = scene.calibrated_by(text(calibration, "calibration")?)?;
        }
        hand_out(place, ft_tip::new(&scene));
        doubt(&scene, error);
        Ok(())
    })
}

/// Says what is hardly meant.
pub(crate) fn doubt(scene: &Scene, error: *mut ft_error) {
    if !error.is_null() {
        let doubts = scene.doubts().join("; ");
        // SAFETY: the caller's structure, at any address.
        unsafe { error.write_unaligned(ft_error::of(ft_status::FT_OK, &doubts)) };
    }
}
