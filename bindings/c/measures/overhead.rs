//! What the border to C takes: samples through `ft_sense_wrench` beside the same samples through the pipeline.
//!
//! `cargo run --release -p fingertip-c --features measures --bin fingertip-c-overhead`. The function is called through a pointer that the compiler
//! does not see through, as C calls it. Both read what a hand needs of the touch. Rounds of both alternate, and the quickest
//! of each count.
#![allow(unsafe_code, reason = "calls of the interface for C")]

extern crate alloc;

use alloc::ffi::CString;
use core::hint::black_box;
use core::mem::MaybeUninit;
use core::ptr;
use std::time::Instant;

use fingertip::wrench::Wrench;
use fingertip_c::{ft_sense_wrench, ft_status, ft_tip, ft_tip_free, ft_tip_from_scene, ft_touch, ft_wrench};
use fingertip_scene::Scene;

const HEAD: &str = "version = 2\n[input]\nconvention = \"on_fingertip\"\n";
const ROUNDS: usize = 501;
const CALLS: u32 = 5_000;

/// Nanoseconds from a wrench until its touch is known: each sample begins with a number of the one before, as a controller
/// acts on what it was told.
fn nanoseconds(mut sense: impl FnMut(ft_wrench) -> f64) -> f64 {
    let mut known = 0.0;
    let start = Instant::now();
    for _ in 0..CALLS {
        // Zero times what is known, which the compiler may not leave out.
        let force = [0.3 + black_box(0.0) * known, -0.1, -2.0];
        known = sense(ft_wrench { force, torque: [0.004, 0.005, 1e-4] });
    }
    black_box(known);
    start.elapsed().as_secs_f64() * 1e9 / f64::from(CALLS)
}

/// What else runs only adds: the least is what it takes.
fn least(numbers: &[f64]) -> f64 {
    numbers.iter().copied().fold(f64::INFINITY, f64::min)
}

/// Nanoseconds of a sample in Rust, and by how many one from C takes longer.
fn measured(text: &str) -> Result<[f64; 2], Box<dyn core::error::Error>> {
    let mut pipeline = Scene::from_text(text)?.pipeline();
    let (mut tip, scene): (*mut ft_tip, _) = (ptr::null_mut(), CString::new(text)?);
    // SAFETY: a text, a variable, and no place for an error.
    let made = unsafe { ft_tip_from_scene(scene.as_ptr(), &raw mut tip, ptr::null_mut()) };
    if made != ft_status::FT_OK {
        return Err("the scene is refused".into());
    }
    let mut touch = MaybeUninit::<ft_touch>::uninit();
    let sense: unsafe extern "C" fn(_, _, _, _) -> _ = black_box(ft_sense_wrench);
    let (mut rust, mut from_c) = (Vec::new(), Vec::new());
    for _ in 0..ROUNDS {
        let plain = nanoseconds(|reported| {
            let wrench = Wrench::on_fingertip(reported.force.into(), reported.torque.into());
            let felt = pipeline.sense(wrench, black_box(1e-3));
            let (contact, force) = (felt.contact(), felt.force());
            let used = felt.margin().map_or(0.0, |margin| margin.utilisation);
            contact.map_or(0.0, |contact| contact.point.z) + force.map_or(0.0, |force| force.normal) + used
        });
        let called = nanoseconds(|reported| {
            // SAFETY: a handle of this thread, and structures of this function.
            let status = unsafe { sense(tip, &raw const reported, 1e-3, touch.as_mut_ptr()) };
            let written = (status == ft_status::FT_OK).then_some(&touch);
            // SAFETY: written where the status is that.
            let touch = written.map(|touch| unsafe { touch.assume_init_ref() });
            touch.map_or(f64::NAN, |touch| touch.point[2] + touch.normal_force + touch.utilisation)
        });
        rust.push(plain);
        from_c.push(called);
    }
    // SAFETY: the variable that holds it.
    unsafe { ft_tip_free(&raw mut tip) };
    Ok([least(&rust), least(&from_c) - least(&rust)])
}

fn main() -> Result<(), Box<dyn core::error::Error>> {
    let friction = "[friction]\nstatic_coefficient = 0.6\n[slip]\ndetector = \"threshold\"\nnoise_N = 0.01\n";
    println!("| scene | a sample in Rust [ns] | more from C [ns] |\n|---|---|---|");
    for (name, text) in [
        ("sphere", "[surface]\nshape = \"sphere\"\nradius_m = 0.013\n".to_owned()),
        ("sphere, friction, slip", format!("[surface]\nshape = \"sphere\"\nradius_m = 0.013\n{friction}")),
        (
            "ellipsoid, soft finger, friction, slip",
            format!(
                "[surface]\nshape = \"ellipsoid\"\nsemi_axes_m = [0.012, 0.012, 0.013]\n\
                 [contact]\nmodel = \"soft_finger\"\n{friction}"
            ),
        ),
    ] {
        let [rust, more] = measured(&format!("{HEAD}{text}"))?;
        println!("| {name} | {rust:.1} | {more:.1} |");
    }
    Ok(())
}
