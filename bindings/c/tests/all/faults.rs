//! What is wrong is told: a status, and a sentence that names it.

use core::ffi::CStr;
use core::mem::MaybeUninit;
use core::ptr;
use std::ffi::CString;
use std::io::Write as _;

use fingertip_c::{
    FT_ABI_VERSION, ft_abi_version, ft_ball, ft_ball_defaults, ft_error, ft_resolution_text, ft_sense,
    ft_sense_wrench, ft_status, ft_status_text, ft_tip, ft_tip_free, ft_tip_from_ball, ft_tip_from_file,
    ft_tip_from_scene, ft_tip_gauges, ft_tip_message, ft_touch, ft_version, ft_wrench,
};
use fingertip_calibration::file::{CalibrationFile, SignalUnit};
use fingertip_calibration::nalgebra::DMatrix;

use crate::{BALL, HEAD, Tip, said, written};

/// A call that makes a tip: its status and its sentence.
fn made(call: impl FnOnce(*mut *mut ft_tip, *mut ft_error) -> ft_status) -> (ft_status, String) {
    let (mut tip, mut error) = (ptr::null_mut(), MaybeUninit::<ft_error>::uninit());
    let status = call(&raw mut tip, error.as_mut_ptr());
    assert_eq!(status == ft_status::FT_OK, !tip.is_null());
    unsafe { ft_tip_free(&raw mut tip) };
    let error = unsafe { error.assume_init() };
    assert_eq!(error.status, status);
    (status, said(&error))
}

fn of_scene(text: &str) -> (ft_status, String) {
    let text = CString::new(text).unwrap();
    made(|tip, error| unsafe { ft_tip_from_scene(text.as_ptr(), tip, error) })
}

#[test]
fn a_bad_scene_is_told_with_its_key() {
    let (status, said) = of_scene(&format!("{HEAD}[surface]\nshape = \"sphere\"\nradius_m = -1.0\n"));
    assert_eq!(status, ft_status::FT_BAD_SCENE);
    assert!(said.contains("radius"), "{said}");
    assert_eq!(of_scene("nonsense").0, ft_status::FT_BAD_SCENE);
    // What can be and is hardly meant, of one that was made.
    let (status, said) = of_scene(&format!("{HEAD}[surface]\nshape = \"sphere\"\nradius_m = 13.0\n"));
    assert_eq!(status, ft_status::FT_OK);
    assert!(said.contains("radius_m"), "{said}");
    assert_eq!(of_scene(&format!("{HEAD}{BALL}")), (ft_status::FT_OK, String::new()));
    // Without a place for the sentence.
    let mut tip = ptr::null_mut();
    let status = unsafe { ft_tip_from_scene(c"nonsense".as_ptr(), &raw mut tip, ptr::null_mut()) };
    assert!(status == ft_status::FT_BAD_SCENE && tip.is_null());
}

#[test]
fn files_are_read_beside_the_scene_and_named_where_they_cannot() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| CString::new(folder.path().join(name).to_str().unwrap()).unwrap();
    let write = |name: &str, text: &str| {
        let mut file = std::fs::File::create(folder.path().join(name)).unwrap();
        file.write_all(text.as_bytes()).unwrap();
    };
    let load = |scene: &CString, calibration: Option<&CString>| {
        let calibration = calibration.map_or(ptr::null(), |path| path.as_ptr());
        made(|tip, error| unsafe { ft_tip_from_file(scene.as_ptr(), calibration, tip, error) })
    };
    write("ball.toml", &format!("{HEAD}{BALL}"));
    assert_eq!(load(&path("ball.toml"), None), (ft_status::FT_OK, String::new()));
    let (status, said) = load(&path("none.toml"), None);
    assert_eq!(status, ft_status::FT_UNREADABLE);
    assert!(said.contains("none.toml"), "{said}");
    write("bad.toml", &format!("{HEAD}[surface]\nshape = \"spere\"\n"));
    let (status, said) = load(&path("bad.toml"), None);
    assert_eq!(status, ft_status::FT_BAD_SCENE);
    assert!(said.contains("bad.toml, line ") && said.contains("spere"), "{said}");
    let (status, said) = load(&path("ball.toml"), Some(&path("none.cal")));
    assert_eq!(status, ft_status::FT_BAD_SCENE);
    assert!(said.contains("none.cal"), "{said}");

    let garbled = CString::new(b"\xff\xfe".to_vec()).unwrap();
    let (status, said) = load(&garbled, None);
    assert_eq!((status, said.as_str()), (ft_status::FT_NOT_TEXT, "`scene` is not UTF-8 text"));
}

/// With a calibration in the place of the scene's sensor, readings are sensed by that.
#[test]
fn a_calibration_takes_the_place_of_the_sensor() {
    let folder = tempfile::tempdir().unwrap();
    let mut matrix = DMatrix::from_diagonal_element(7, 6, 2.0);
    matrix.fill_row(6, 0.1);
    let nominal = vec![10.0, 10.0, 10.0, 0.1, 0.1, 0.1];
    let file = CalibrationFile::new(matrix, nominal, vec![0.0; 7], SignalUnit::Volt).unwrap();
    let path = folder.path().join("tip.toml");
    file.write(&path).unwrap();
    std::fs::write(folder.path().join("ball.toml"), format!("{HEAD}{BALL}")).unwrap();
    let [scene, calibration] = ["ball.toml", "tip.toml"]
        .map(|name| CString::new(folder.path().join(name).to_str().unwrap()).unwrap());
    let mut tip = ptr::null_mut();
    let status =
        unsafe { ft_tip_from_file(scene.as_ptr(), calibration.as_ptr(), &raw mut tip, ptr::null_mut()) };
    assert_eq!(status, ft_status::FT_OK);
    let tip = Tip(tip);
    assert_eq!(unsafe { ft_tip_gauges(tip.0) }, 7);
    // −1 N along z reads −0.2 V on the third gauge, and a tenth of a volt for each nominal load on the last.
    let signals = [0.0, 0.0, -0.2, 0.0, 0.0, 0.0, -0.01];
    let touch: ft_touch = written(|to| unsafe { ft_sense(tip.0, signals.as_ptr(), 7, 1e-3, to) }).unwrap();
    assert!((touch.wrench.force[2] + 1.0).abs() < 1e-9, "{touch:?}");
}

#[test]
fn a_ball_of_numbers_is_the_scene_of_them() {
    let of = |ball: &ft_ball| made(|tip, error| unsafe { ft_tip_from_ball(ball, tip, error) });
    let good = ft_ball_defaults();
    assert_eq!(of(&good), (ft_status::FT_OK, String::new()));
    let matrix: Vec<f64> = (0..36).map(|k| if k % 7 == 0 { 2.0 } else { 0.0 }).collect();
    let ball = ft_ball {
        radius_m: 0.013,
        centre_m: [0.001, 0.0, 0.02],
        reaction: 1,
        soft_finger: 1,
        least_force_n: 0.2,
        static_coefficient: 0.7,
        torque_arm_m: 0.003,
        load_per_signal: matrix.as_ptr(),
        gauges: 6,
    };
    let mut tip = ptr::null_mut();
    assert_eq!(unsafe { ft_tip_from_ball(&ball, &raw mut tip, ptr::null_mut()) }, ft_status::FT_OK);
    let tip = Tip(tip);
    let rows: Vec<String> = matrix.chunks(6).map(|row| format!("{row:?}")).collect();
    let same = Tip::new(&format!(
        "version = 2\n[input]\nconvention = \"reaction\"\n[sensor]\nsignal_unit = \"V\"\nload_per_signal_N_Nm = [{}]\n\
         [surface]\nshape = \"sphere\"\nradius_m = 0.013\ncentre_m = [0.001, 0.0, 0.02]\n\
         [contact]\nmodel = \"soft_finger\"\nleast_force_N = 0.2\n\
         [friction]\nlimit = \"soft_finger\"\nstatic_coefficient = 0.7\ntorque_arm_m = 0.003\n",
        rows.join(", ")
    ));
    for signals in [[-0.1, 0.05, 0.5, 0.001, 0.004, 0.0001], [0.0, 0.0, 0.09, 0.0, 0.0, 0.0]] {
        let [one, other] = [&tip, &same].map(|tip| {
            written::<ft_touch>(|to| unsafe { ft_sense(tip.0, signals.as_ptr(), 6, 1e-3, to) }).unwrap()
        });
        assert_eq!(one, other);
    }
    let refused = |ball: ft_ball, expected: ft_status, says: &str| {
        let (status, said) = of(&ball);
        assert_eq!(status, expected, "{said}");
        assert!(said.contains(says), "{said}");
    };
    refused(ft_ball { radius_m: f64::NAN, ..good }, ft_status::FT_BAD_NUMBER, "`radius_m` must be finite");
    refused(ft_ball { radius_m: 0.0, ..good }, ft_status::FT_BAD_SCENE, "radius");
    refused(ft_ball { soft_finger: 2, ..good }, ft_status::FT_BAD_NUMBER, "`soft_finger` must be 0 or 1");
    refused(ft_ball { static_coefficient: -0.5, ..good }, ft_status::FT_BAD_SCENE, "friction coefficient");
    refused(ft_ball { gauges: 5, ..ball }, ft_status::FT_WRONG_SIZE, "5 gauges were given");
    refused(ft_ball { load_per_signal: ptr::null(), ..ball }, ft_status::FT_NULL, "`load_per_signal`");
}

#[test]
fn null_is_told_and_the_outputs_stay() {
    let tip = Tip::new(&format!("{HEAD}{BALL}"));
    let wrench = ft_wrench { force: [0.0, 0.0, -1.0], torque: [0.0; 3] };
    let message = || unsafe { CStr::from_ptr(ft_tip_message(tip.0)) }.to_str().unwrap().to_owned();
    assert_eq!(message(), "");
    let mut touch: ft_touch = written(|to| unsafe { ft_sense_wrench(tip.0, &wrench, 1e-3, to) }).unwrap();
    let before = touch;
    let sense = |tip, wrench, touch| unsafe { ft_sense_wrench(tip, wrench, 1e-3, touch) };
    assert_eq!(sense(ptr::null_mut(), &raw const wrench, &raw mut touch), ft_status::FT_NULL);
    assert_eq!(sense(tip.0, ptr::null(), &raw mut touch), ft_status::FT_NULL);
    assert_eq!(message(), "`wrench` is NULL, and must not be");
    assert_eq!(sense(tip.0, &raw const wrench, ptr::null_mut()), ft_status::FT_NULL);
    assert_eq!(message(), "`touch` is NULL, and must not be");
    assert_eq!(touch, before);
    let gauges = [0.0; 6];
    let none = written::<ft_touch>(|to| unsafe { ft_sense(tip.0, gauges.as_ptr(), 6, 1e-3, to) });
    assert_eq!(none.unwrap_err(), ft_status::FT_NO_SENSOR);
    assert!(message().contains("[sensor]"));
    // What frees and asks takes NULL.
    unsafe { ft_tip_free(ptr::null_mut()) };
    assert_eq!(unsafe { ft_tip_gauges(ptr::null()) }, 0);
    assert!(!unsafe { CStr::from_ptr(ft_tip_message(ptr::null())) }.is_empty());
}

#[test]
fn every_status_and_resolution_has_a_text_of_its_own() {
    for (text, last) in [(ft_status_text as extern "C" fn(u32) -> *const i8, 15), (ft_resolution_text, 11)] {
        let says = |number| unsafe { CStr::from_ptr(text(number)) }.to_str().unwrap().to_owned();
        let mut all: Vec<String> = (0..=last + 1).map(says).collect();
        assert_eq!(says(last + 1), says(u32::MAX));
        all.sort();
        all.dedup();
        assert_eq!(all.len(), last as usize + 2);
    }
    assert_eq!(ft_abi_version(), FT_ABI_VERSION);
    let version = unsafe { CStr::from_ptr(ft_version()) };
    assert_eq!(version.to_str().unwrap(), env!("CARGO_PKG_VERSION"));
    // The shared library is named for the version of its ABI.
    let build = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/build.rs")).unwrap();
    assert!(build.contains(&format!("const ABI_VERSION: u32 = {FT_ABI_VERSION};")));
}
