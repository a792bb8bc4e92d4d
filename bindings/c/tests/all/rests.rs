//! The zero: taken, set, read back, doubted.

use core::mem::MaybeUninit;

use fingertip::wrench::Wrench;
use fingertip_c::{
    ft_end_rest, ft_error, ft_motion, ft_reading_of, ft_resolution, ft_rest, ft_rest_doubt, ft_rest_wrench,
    ft_rest_wrench_moving, ft_sense, ft_sense_wrench, ft_sense_wrench_moving, ft_set_zero,
    ft_set_zero_wrench, ft_status, ft_touch, ft_wrench, ft_zero_wrench,
};
use nalgebra::Vector3;

use crate::{BALL, HEAD, Tip, pushes, said, scene, written};

const SENSOR: &str = "[sensor]\nsignal_unit = \"V\"\nload_per_signal_N_Nm = [\n\
    [5.0, 0.0, 0.0, 0.0, 0.0, 0.0],\n[0.0, 5.0, 0.0, 0.0, 0.0, 0.0],\n[0.0, 0.0, 5.0, 0.0, 0.0, 0.0],\n\
    [0.0, 0.0, 0.0, 0.05, 0.0, 0.0],\n[0.0, 0.0, 0.0, 0.0, 0.05, 0.0],\n[0.0, 0.0, 0.0, 0.0, 0.0, 0.05],\n]\n";

const BIAS: ft_wrench = ft_wrench { force: [0.5, -1.0, 2.0], torque: [0.01, 0.02, -0.03] };

fn sum(a: &ft_wrench, b: &ft_wrench) -> ft_wrench {
    let add = |a: [f64; 3], b: [f64; 3]| [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
    ft_wrench { force: add(a.force, b.force), torque: add(a.torque, b.torque) }
}

#[test]
fn the_zero_of_wrenches_is_the_mean_of_the_rest() {
    for convention in ["on_fingertip", "reaction"] {
        let text = format!("{}{BALL}", HEAD.replace("on_fingertip", convention));
        let (tip, fresh) = (Tip::new(&text), Tip::new(&text));
        assert_eq!(unsafe { ft_end_rest(tip.0) }, ft_status::FT_NO_REST);
        for k in 0..100 {
            let wobble = if k % 2 == 0 { 0.25 } else { -0.25 };
            let noise = ft_wrench { force: [wobble, 0.0, -wobble], torque: [0.0; 3] };
            assert_eq!(unsafe { ft_rest_wrench(tip.0, &sum(&BIAS, &noise)) }, ft_status::FT_OK);
        }
        assert_eq!(unsafe { ft_end_rest(tip.0) }, ft_status::FT_OK);
        let zero: ft_wrench = written(|to| unsafe { ft_zero_wrench(tip.0, to) }).unwrap();
        for (found, expected) in
            zero.force.iter().chain(&zero.torque).zip(BIAS.force.iter().chain(&BIAS.torque))
        {
            assert!((found - expected).abs() < 1e-12);
        }
        for wrench in pushes(2, 50) {
            let plain: ft_touch =
                written(|to| unsafe { ft_sense_wrench(fresh.0, &wrench, 1e-3, to) }).unwrap();
            let biased = sum(&wrench, &BIAS);
            let tared: ft_touch = written(|to| unsafe { ft_sense_wrench(tip.0, &biased, 1e-3, to) }).unwrap();
            assert_eq!(plain.resolution, tared.resolution);
            let off = Vector3::from(plain.point) - Vector3::from(tared.point);
            assert!(off.norm() < 1e-12, "{off}");
        }
        // What was read back and is set again gives the same bits.
        assert_eq!(unsafe { ft_set_zero_wrench(fresh.0, &zero) }, ft_status::FT_OK);
        let biased = sum(&pushes(4, 1)[0], &BIAS);
        let [one, other] = [&tip, &fresh].map(|tip| {
            written::<ft_touch>(|to| unsafe { ft_sense_wrench(tip.0, &biased, 0.0, to) }).unwrap().point
        });
        assert_eq!(one, other);
    }
}

#[test]
fn the_zero_of_gauges_is_the_mean_of_the_rest_or_the_one_that_is_set() {
    let tip = Tip::new(&format!("{HEAD}{SENSOR}{BALL}"));
    let press = [0.0, 0.0, -0.2, 0.0, 0.0, 0.0];
    let force = |tip: &Tip, signals: &[f64; 6]| -> [f64; 3] {
        let touch: ft_touch =
            written(|to| unsafe { ft_sense(tip.0, signals.as_ptr(), 6, 1e-3, to) }).unwrap();
        touch.wrench.force
    };
    assert_eq!(force(&tip, &press)[2], -1.0);
    assert_eq!(unsafe { ft_end_rest(tip.0) }, ft_status::FT_NO_REST);
    for _ in 0..40 {
        assert_eq!(unsafe { ft_rest(tip.0, press.as_ptr(), 6) }, ft_status::FT_OK);
    }
    assert_eq!(force(&tip, &press)[2], -1.0);
    assert_eq!(unsafe { ft_end_rest(tip.0) }, ft_status::FT_OK);
    assert_eq!(force(&tip, &press)[2], 0.0);
    // One that was stored; what a rest has taken so far is dropped.
    let zero = [0.0, 0.0, 0.2, 0.0, 0.0, 0.0];
    assert_eq!(unsafe { ft_rest(tip.0, press.as_ptr(), 6) }, ft_status::FT_OK);
    assert_eq!(unsafe { ft_set_zero(tip.0, &ft_reading_of(zero.as_ptr(), 6)) }, ft_status::FT_OK);
    assert_eq!(force(&tip, &press)[2], -2.0);
    assert_eq!(unsafe { ft_end_rest(tip.0) }, ft_status::FT_NO_REST);
    // One that is none leaves the zero.
    let none = [f64::NAN; 6];
    assert_eq!(unsafe { ft_set_zero(tip.0, &ft_reading_of(none.as_ptr(), 6)) }, ft_status::FT_INCOMPLETE);
    assert_eq!(unsafe { ft_rest(tip.0, none.as_ptr(), 6) }, ft_status::FT_INCOMPLETE);
    assert_eq!(force(&tip, &press)[2], -2.0);
}

#[test]
fn a_scene_that_waits_for_the_noise_gets_it_from_the_rest() {
    let head = HEAD.replace("sample_rate_Hz", "rest_s = 1.0\nsample_rate_Hz");
    let text = format!("{head}{BALL}[contact]\nleast_force_deviations = 5.0\n");
    assert!(scene(&text).awaits_noise());
    let tip = Tip::new(&text);
    let push = ft_wrench { force: [0.0, 0.0, -0.2], torque: [0.0; 3] };
    let felt =
        || written::<ft_touch>(|to| unsafe { ft_sense_wrench(tip.0, &push, 1e-3, to) }).unwrap().resolution;
    assert_eq!(felt(), ft_resolution::FT_BELOW_THRESHOLD);
    for k in 0..200 {
        let noise = if k % 2 == 0 { 0.01 } else { -0.01 };
        let wrench = ft_wrench { force: [noise; 3], torque: [noise * 1e-3; 3] };
        assert_eq!(unsafe { ft_rest_wrench(tip.0, &wrench) }, ft_status::FT_OK);
    }
    assert_eq!(unsafe { ft_end_rest(tip.0) }, ft_status::FT_OK);
    assert_eq!(felt(), ft_resolution::FT_CONTACT);
}

#[test]
fn a_rest_that_moves_is_doubted() {
    let doubt = |tip: &Tip| {
        let mut error = MaybeUninit::<ft_error>::uninit();
        let status = unsafe { ft_rest_doubt(tip.0, error.as_mut_ptr()) };
        (status, said(&unsafe { error.assume_init() }))
    };
    let tip = Tip::new(&format!("{HEAD}{BALL}"));
    assert_eq!(doubt(&tip), (ft_status::FT_OK, String::new()));
    for k in 0..400 {
        let wrench = ft_wrench { force: [0.0, f64::from(k), 0.0], torque: [0.0; 3] };
        assert_eq!(unsafe { ft_rest_wrench(tip.0, &wrench) }, ft_status::FT_OK);
    }
    assert_eq!(unsafe { ft_end_rest(tip.0) }, ft_status::FT_OK);
    let (status, said) = doubt(&tip);
    assert_eq!(status, ft_status::FT_DOUBTFUL);
    assert!(said.starts_with("Fy moved by "), "{said}");

    let gauged = Tip::new(&format!("{HEAD}{SENSOR}{BALL}"));
    for k in 0..400 {
        let signals = [0.0, 0.0, f64::from(k) * 1e-3, 0.0, 0.0, 0.0];
        assert_eq!(unsafe { ft_rest(gauged.0, signals.as_ptr(), 6) }, ft_status::FT_OK);
    }
    assert_eq!(unsafe { ft_end_rest(gauged.0) }, ft_status::FT_OK);
    let (status, said) = doubt(&gauged);
    assert_eq!(status, ft_status::FT_DOUBTFUL);
    assert!(said.starts_with("gauge 3 moved by "), "{said}");
}

/// A zero taken with a body on holds its weight: only what has changed since then is taken off.
#[test]
fn a_rest_with_a_payload_remembers_how_it_hung() {
    let text = format!("{HEAD}[payload]\nmass_kg = 0.5\n{BALL}");
    let tip = Tip::new(&text);
    let motion =
        |gravity: [f64; 3]| ft_motion { gravity, angular_velocity: [0.0; 3], angular_acceleration: [0.0; 3] };
    let (down, aside) = ([0.0, 0.0, -10.0], [10.0, 0.0, 0.0]);
    let hanging = ft_wrench { force: [0.0, 0.0, -5.0], torque: [0.0; 3] };
    assert_eq!(unsafe { ft_rest_wrench(tip.0, &hanging) }, ft_status::FT_NO_MOTION);
    for _ in 0..10 {
        assert_eq!(unsafe { ft_rest_wrench_moving(tip.0, &hanging, &motion(down)) }, ft_status::FT_OK);
    }
    assert_eq!(unsafe { ft_end_rest(tip.0) }, ft_status::FT_OK);
    let turned = ft_wrench { force: [5.0, 0.0, 0.0], torque: [0.0; 3] };
    for (wrench, gravity) in [(hanging, down), (turned, aside)] {
        let touch: ft_touch =
            written(|to| unsafe { ft_sense_wrench_moving(tip.0, &wrench, &motion(gravity), 1e-3, to) })
                .unwrap();
        let left: Wrench<f64> = Wrench::on_fingertip(touch.wrench.force.into(), touch.wrench.torque.into());
        assert!(left.components().norm() < 1e-9, "{left:?}");
    }
}
