//! The interface for C: it says what the pipeline says, bit for bit; what is wrong is told; structures are those of the
//! header.

// Helpers of tests are tests too.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
#![allow(
    unsafe_code,
    clippy::undocumented_unsafe_blocks,
    reason = "calls of the interface for C, as C makes them"
)]
#![allow(clippy::std_instead_of_alloc, reason = "tests have the standard library")]

mod columns;
mod faults;
mod fused;
mod grasps;
mod hands;
mod layout;
mod rests;
mod samples;

use core::ffi::CStr;
use core::mem::MaybeUninit;
use core::ptr;
use std::ffi::CString;

use fingertip_c::{ft_error, ft_status, ft_tip, ft_tip_free, ft_tip_from_scene, ft_touch, ft_wrench};
use fingertip_scene::Scene;
use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// The beginning of a scene, up to its surface.
pub(crate) const HEAD: &str =
    "version = 2\n[input]\nconvention = \"on_fingertip\"\nsample_rate_Hz = 1000.0\n";
/// A tip of 13 mm.
pub(crate) const BALL: &str = "[surface]\nshape = \"sphere\"\nradius_m = 0.013\n";

/// A handle that frees itself.
pub(crate) struct Tip(pub(crate) *mut ft_tip);

impl Tip {
    pub(crate) fn new(scene: &str) -> Self {
        let (mut tip, mut error) = (ptr::null_mut(), MaybeUninit::<ft_error>::uninit());
        let text = CString::new(scene).unwrap();
        let status = unsafe { ft_tip_from_scene(text.as_ptr(), &raw mut tip, error.as_mut_ptr()) };
        assert_eq!(status, ft_status::FT_OK, "{}", said(&unsafe { error.assume_init() }));
        Self(tip)
    }
}

impl Drop for Tip {
    fn drop(&mut self) {
        unsafe { ft_tip_free(&raw mut self.0) };
        assert!(self.0.is_null());
    }
}

/// The sentence of a failure.
pub(crate) fn said(error: &ft_error) -> String {
    unsafe { CStr::from_ptr(error.message.as_ptr()) }.to_str().unwrap().to_owned()
}

pub(crate) fn scene(text: &str) -> Scene {
    Scene::from_text(text).unwrap()
}

/// What a call writes, and its status.
pub(crate) fn written<V>(call: impl FnOnce(*mut V) -> ft_status) -> Result<V, ft_status> {
    let mut value = MaybeUninit::uninit();
    match call(value.as_mut_ptr()) {
        ft_status::FT_OK => Ok(unsafe { value.assume_init() }),
        status => Err(status),
    }
}

/// Pushes towards the middle, one in ten too light.
pub(crate) fn pushes(seed: u64, count: usize) -> Vec<ft_wrench> {
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    (0..count)
        .map(|k| {
            let mut vector = |size: f64| Vector3::from_fn(|_, _| random.random_range(-size..size));
            let (at, aside, spin) = (vector(0.006), vector(0.4), vector(1e-3));
            let strength = if k % 10 == 9 { 1e-4 } else { 1.0 };
            let force = (aside - Vector3::z()) * strength;
            ft_wrench { force: force.into(), torque: (at.cross(&force) + spin * strength).into() }
        })
        .collect()
}

/// All bits of a touch.
pub(crate) fn bits(touch: &ft_touch) -> Vec<u64> {
    let numbers = [touch.normal_force, touch.spin_torque, touch.gap, touch.margin, touch.utilisation];
    let vectors =
        [touch.wrench.force, touch.wrench.torque, touch.point, touch.normal, touch.tangential_force];
    let whole =
        [touch.resolution as u32, touch.slip as u32, touch.has_margin, touch.alternatives, touch.searched];
    let numbers = vectors.as_flattened().iter().chain(&numbers).map(|x| x.to_bits());
    whole.into_iter().map(u64::from).chain(numbers).collect()
}
