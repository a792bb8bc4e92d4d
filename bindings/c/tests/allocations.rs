//! Calls that take a sample allocate nothing.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
#![allow(unsafe_code, clippy::undocumented_unsafe_blocks, reason = "an allocator, and calls as C makes them")]
#![allow(
    clippy::std_instead_of_alloc,
    clippy::std_instead_of_core,
    reason = "tests have the standard library"
)]

use core::cell::Cell;
use core::mem::MaybeUninit;
use core::ptr;
use std::alloc::{GlobalAlloc, Layout, System};
use std::ffi::CString;

use fingertip_c::{
    ft_beside_last, ft_end_rest, ft_finger_from_touch, ft_finger_limits, ft_grasp_quality, ft_hand_command,
    ft_hand_create, ft_hand_free, ft_hand_least_grip, ft_hand_object, ft_hand_other, ft_hand_reach,
    ft_hand_set_joints, ft_hand_settings_defaults, ft_hand_weigh, ft_pose, ft_rest, ft_sense, ft_sense_all,
    ft_sense_wrench, ft_status, ft_tip, ft_tip_free, ft_tip_from_scene, ft_touch, ft_touch_columns,
    ft_uncertain_wrench, ft_wrench, ft_wrench_columns,
};

struct Counting;

std::thread_local! {
    /// Of this thread alone: that which runs the tests asks for memory when it likes.
    static CALLS: Cell<u64> = const { Cell::new(0) };
}

// SAFETY: the system's allocator, and a counter.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        CALLS.set(CALLS.get() + 1);
        // SAFETY: the caller's promise.
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: the caller's promise.
        unsafe { System.dealloc(memory, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

const HEAD: &str = "version = 2\n[input]\nconvention = \"on_fingertip\"\nsample_rate_Hz = 1000.0\n";
const RICH: &str = "[uncertainty]\nforce_noise_N = 0.01\ntorque_noise_Nm = 0.0001\n\
    [tracking]\nspeed_m_per_s = 0.05\nturns_within_s = 0.1\nleast_touch_N = 0.05\n\
    [friction]\nlimit = \"uncertain\"\nstatic_coefficient = 0.6\ndeviation = 0.05\n\
    [slip]\ndetector = \"likelihood_ratio\"\nnoise_N = 0.01\nfalse_alarms_per_minute = 1.0\n[estimate]\nnoise_N = 0.01\n\
    [grip]\nleast_N = 0.3\ngreatest_N = 15.0\nrise_N_per_s = 200.0\nfall_N_per_s = 2.0\n";
const SENSOR: &str = "[sensor]\nsignal_unit = \"V\"\nload_per_signal_N_Nm = [\n\
    [5.0, 0.0, 0.0, 0.0, 0.0, 0.0],\n[0.0, 5.0, 0.0, 0.0, 0.0, 0.0],\n[0.0, 0.0, 5.0, 0.0, 0.0, 0.0],\n\
    [0.0, 0.0, 0.0, 0.05, 0.0, 0.0],\n[0.0, 0.0, 0.0, 0.0, 0.05, 0.0],\n[0.0, 0.0, 0.0, 0.0, 0.0, 0.05],\n]\n\
    range = [-2.0, 2.0]\n";

/// How often memory was asked for while something ran.
fn counted(run: impl FnOnce()) -> u64 {
    let before = CALLS.get();
    run();
    CALLS.get() - before
}

#[test]
fn samples_and_their_failures_allocate_nothing() {
    assert_eq!(counted(|| drop(std::hint::black_box(Box::new(1_u8)))), 1, "the counter counts");
    let mut columns = vec![vec![-0.1; 1000]; 15];
    let mut slip = vec![0; 1000];
    let [fx, fy, fz, tx, ty, tz, x, y, z, n, sx, sy, sz, margin, used] = &mut columns[..] else {
        unreachable!()
    };
    let from = ft_wrench_columns {
        fx: fx.as_ptr(),
        fy: fy.as_ptr(),
        fz: fz.as_ptr(),
        tx: tx.as_ptr(),
        ty: ty.as_ptr(),
        tz: tz.as_ptr(),
    };
    let to = ft_touch_columns {
        point_x: x.as_mut_ptr(),
        point_y: y.as_mut_ptr(),
        point_z: z.as_mut_ptr(),
        normal_force: n.as_mut_ptr(),
        tangential_x: sx.as_mut_ptr(),
        tangential_y: sy.as_mut_ptr(),
        tangential_z: sz.as_mut_ptr(),
        margin: margin.as_mut_ptr(),
        utilisation: used.as_mut_ptr(),
        slip: slip.as_mut_ptr(),
    };
    for shape in [
        "\"sphere\"\nradius_m = 0.013",
        "\"ellipsoid\"\nsemi_axes_m = [0.008, 0.010, 0.015]",
        "\"torus\"\nring_radius_m = 0.007\ntube_radius_m = 0.006",
        "\"superquadric\"\nsemi_axes_m = [0.01, 0.01, 0.01]\nexponents = [0.7, 0.7]",
    ] {
        for model in ["point", "soft_finger"] {
            let text =
                format!("{HEAD}{SENSOR}[surface]\nshape = {shape}\n[contact]\nmodel = \"{model}\"\n{RICH}");
            let text = CString::new(text).unwrap();
            let mut tip: *mut ft_tip = ptr::null_mut();
            let status = unsafe { ft_tip_from_scene(text.as_ptr(), &raw mut tip, ptr::null_mut()) };
            assert_eq!(status, ft_status::FT_OK, "{shape}");
            let allocations = counted(|| samples(tip, &from, &to));
            assert_eq!(allocations, 0, "{shape}, {model}");
            unsafe { ft_tip_free(&raw mut tip) };
        }
    }
}

/// Every call of a sample, and the failures that a sample can have.
fn samples(tip: *mut ft_tip, from: &ft_wrench_columns, to: &ft_touch_columns) {
    let mut touch = MaybeUninit::<ft_touch>::uninit();
    let mut beside = MaybeUninit::uninit();
    let mut contacts = 0;
    for k in 0..400 {
        let aside = f64::from(k % 100) * 0.01;
        let wrench = ft_wrench { force: [aside, 0.0, -2.0], torque: [0.0, aside * 0.01 + 0.006 * 2.0, 1e-4] };
        assert_eq!(unsafe { ft_sense_wrench(tip, &wrench, 1e-3, touch.as_mut_ptr()) }, ft_status::FT_OK);
        contacts += u32::from(unsafe { touch.assume_init_ref() }.resolution as u32 == 0);
        assert_eq!(unsafe { ft_beside_last(tip, beside.as_mut_ptr()) }, ft_status::FT_OK);
        let mut gauges = [aside / 5.0, 0.0, -0.4, 0.0, aside * 0.2 + 0.24, 0.002];
        let mut sense = |gauges: &[f64]| unsafe {
            ft_sense(tip, gauges.as_ptr(), gauges.len(), 1e-3, touch.as_mut_ptr())
        };
        assert_eq!(sense(&gauges), ft_status::FT_OK);
        assert_eq!(sense(&gauges[1..]), ft_status::FT_WRONG_SIZE);
        gauges[0] = 3.0;
        assert_eq!(sense(&gauges), ft_status::FT_SATURATED);
        gauges[0] = f64::NAN;
        assert_eq!(sense(&gauges), ft_status::FT_INCOMPLETE);
    }
    assert!(contacts > 100, "{contacts}");
    assert_eq!(unsafe { ft_sense_all(tip, from, 1000, 1e-3, to) }, ft_status::FT_OK);
    let gauges = [0.001; 6];
    for _ in 0..50 {
        assert_eq!(unsafe { ft_rest(tip, gauges.as_ptr(), 6) }, ft_status::FT_OK);
    }
    assert_eq!(unsafe { ft_end_rest(tip) }, ft_status::FT_OK);
    commands(unsafe { touch.assume_init_ref() });
}

fn commands(touch: &ft_touch) {
    let settings = ft_hand_settings_defaults();
    let limit = ft_finger_limits { least_normal_force: 0.3, greatest_normal_force: 15.0, cost: 1.0 };
    let mut hand = ptr::null_mut();
    let made = counted(|| {
        let status =
            unsafe { ft_hand_create(&settings, [limit; 2].as_ptr(), 2, &raw mut hand, ptr::null_mut()) };
        assert_eq!(status, ft_status::FT_OK);
    });
    // The hand itself is not of a sample.
    CALLS.set(CALLS.get() - made);
    let touch = ft_touch { resolution: fingertip_c::ft_resolution::FT_CONTACT, ..*touch };
    for _ in 0..20 {
        let fingers = [1.0, -1.0].map(|side: f64| {
            let pose = ft_pose {
                rotation: [[0.0, 0.0, side], [0.0, 1.0, 0.0], [-side, 0.0, 0.0]],
                origin: [-0.03 * side, 0.0, 0.0],
            };
            let mut finger = MaybeUninit::uninit();
            let touch = ft_touch { point: [0.0, 0.0, 0.01], normal: [0.0, 0.0, 1.0], ..touch };
            let status = unsafe {
                ft_finger_from_touch(&touch, &pose, 0.6, 0.002, finger.as_mut_ptr(), ptr::null_mut())
            };
            assert_eq!(status, ft_status::FT_OK);
            unsafe { finger.assume_init() }
        });
        let (mut order, mut grip) = (MaybeUninit::uninit(), MaybeUninit::uninit());
        let load = ft_wrench { force: [0.0, 0.0, -1.0], torque: [0.0; 3] };
        let (fingers, load) = (fingers.as_ptr(), &raw const load);
        let status = unsafe { ft_hand_command(hand, fingers, 2, load, 1e-3, order.as_mut_ptr()) };
        assert_eq!(status, ft_status::FT_OK);
        let status = unsafe { ft_hand_least_grip(hand, fingers, 2, load, grip.as_mut_ptr()) };
        assert_eq!(status, ft_status::FT_OK);
        let status = unsafe { ft_hand_command(hand, fingers, 3, load, 1e-3, order.as_mut_ptr()) };
        assert_eq!(status, ft_status::FT_WRONG_SIZE);
        let hinge = [0.08, 0.0, 0.0, 0.0, 1.0, 0.0];
        let status = unsafe { ft_hand_set_joints(hand, 1, hinge.as_ptr(), [2.0].as_ptr(), 1) };
        assert_eq!(status, ft_status::FT_OK);
        let mut reach = MaybeUninit::uninit();
        let status = unsafe { ft_hand_reach(hand, fingers, 2, load, load, reach.as_mut_ptr()) };
        assert_eq!(status, ft_status::FT_OK);
        let mut felt = ft_uncertain_wrench { wrench: unsafe { *load }, covariance: [[0.0; 6]; 6] };
        (0..6).for_each(|i| felt.covariance[i][i] = 1e-6);
        let gravity = [0.0, 0.0, -9.81];
        assert_eq!(unsafe { ft_hand_weigh(hand, &felt, gravity.as_ptr()) }, ft_status::FT_OK);
        let (mut object, mut other) = (MaybeUninit::uninit(), MaybeUninit::uninit());
        assert_eq!(unsafe { ft_hand_object(hand, object.as_mut_ptr()) }, ft_status::FT_OK);
        let status = unsafe { ft_hand_other(hand, &felt, gravity.as_ptr(), 1e-3, other.as_mut_ptr()) };
        assert_eq!(status, ft_status::FT_OK);
        let mut quality = MaybeUninit::uninit();
        let status = unsafe { ft_grasp_quality(fingers, 2, 0.02, 0, quality.as_mut_ptr(), ptr::null_mut()) };
        assert_eq!(status, ft_status::FT_OK);
    }
    unsafe { ft_hand_free(&raw mut hand) };
}
