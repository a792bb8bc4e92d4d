//! Scenes that are wrong: each is refused in a sentence that names the key and the mend.

use fingertip_scene::{Convention, Scene};
use std::path::Path;

use crate::{BALL, HEAD, NOISE};

#[test]
fn faults_are_named() {
    let good = format!("{HEAD}{BALL}");
    assert_eq!(Scene::from_text(&good).unwrap().convention(), Convention::OnFingertip);
    let with = |rest: &str| format!("{good}{rest}");
    let cases = [
        (good.replace("version = 2", "version = 3"), "version 3"),
        (good.replace("version = 2\n", ""), "version = 2"),
        (with("[contact]\nmodel = \"auto\"\n"), "[uncertainty]"),
        (with("[contact]\nmodel = \"soft_finger\"\ngreatest_gap_m = 0.001\n"), "`greatest_gap_m`"),
        (
            with("[contact]\nmodel = \"soft_finger\"\ngreatest_friction_ratio = 1.0\n"),
            "`greatest_friction_ratio`",
        ),
        (with("[contact]\ngreatest_pitch_m = 0.01\n"), "`greatest_pitch_m`"),
        (with("[contact]\nskin_share = 0.5\n"), "`skin_share`"),
        (with("[contact]\npitch_deviations = 3.0\n"), "`pitch_deviations`"),
        (with("[contact.skin]\nlaw = \"linear\"\nstiffness_N_per_m = -1.0\nradius_m = 0.01\n"), "stiffness"),
        (with("[contact.skin]\nlaw = \"table\"\nforce_depth_patch_N_m_m = []\n"), "points"),
        (with("[contact.skin]\nlaw = \"linear\"\nstiffness_N_per_m = 10.0\n"), "missing field `radius_m`"),
        (
            with(
                "[contact]\nskin_share = 1.5\n[contact.skin]\nlaw = \"linear\"\nstiffness_N_per_m = 10.0\nradius_m = 0.01\n",
            ),
            "share",
        ),
        (
            with(
                "[friction]\nlimit = \"anisotropic\"\ngrain = [1.0, 0.0, 0.0]\ncoefficient_along = 0.4\ncoefficient_across = 0.5\n",
            ),
            "`grain`",
        ),
        (
            with("[friction]\nlimit = \"uncertain\"\nstatic_coefficient = 0.1\ndeviation = 0.1\n"),
            "probability",
        ),
        (
            with(
                "[friction]\nlimit = \"uncertain\"\nstatic_coefficient = 0.5\ndeviation = 0.1\nprobability = 0.7\n",
            ),
            "probability",
        ),
        (with("[friction]\nstatic_coeficient = 0.5\n"), "unknown field `static_coeficient`"),
        (with("[slip]\ndetector = \"threshold\"\nnoise_N = 0.01\n"), "[friction]"),
        (with("[estimate]\nnoise_N = 0.01\n"), "[slip]"),
        (
            with("[grip]\nleast_N = 0.2\ngreatest_N = 20.0\nrise_N_per_s = 100.0\nfall_N_per_s = 2.0\n"),
            "[friction]",
        ),
        (
            with(
                "[friction]\nstatic_coefficient = 0.5\n[grip]\nleast_N = 2.0\ngreatest_N = 1.0\nrise_N_per_s = 100.0\nfall_N_per_s = 2.0\n",
            ),
            "greatest grip force",
        ),
        (with(&format!("{NOISE}position_m = -0.1\n")), "standard deviations"),
        (with(&format!("{NOISE}probability = 1.0\n")), "probability"),
        (with("[uncertainty]\nforce_noise_N = 0.1\n"), "missing field `torque_noise_Nm`"),
        (
            good.replace("sample_rate_Hz = 1000.0\n", "")
                + "[slip]\ndetector = \"likelihood_ratio\"\nnoise_N = 0.01\n",
            "sample_rate_Hz",
        ),
        (
            good.replace("sample_rate_Hz = 1000.0\n", "")
                + "[slip]\ndetector = \"drop\"\nnoise_N = 0.01\nfalse_alarms_per_minute = 1.0\n",
            "sample_rate_Hz",
        ),
        (
            format!(
                "{HEAD}[surface]\nshape = \"disk\"\nradius_m = 0.01\n[friction]\nlimit = \"anisotropic\"\ngrain = [0.0, 0.0, 1.0]\ncoefficient_along = 0.4\ncoefficient_across = 0.5\n"
            ),
            "`grain`",
        ),
    ];
    for (text, expected) in cases {
        match Scene::from_text(&text) {
            Ok(_) => panic!("accepted, but should complain of {expected}:\n{text}"),
            Err(problem) => {
                let message = problem.to_string();
                assert!(
                    message.contains(expected) && !message.contains('\n'),
                    "{message} lacks {expected:?}"
                );
            }
        }
    }
}

#[test]
fn a_file_that_is_not_there_or_wrong_is_named_with_its_line() {
    let error = Scene::load("nowhere/tip.toml").unwrap_err().to_string();
    assert!(error.contains("nowhere/tip.toml"), "{error}");
    let text = format!("{HEAD}{BALL}radius_mm = 1.0\n");
    let fault = Scene::parse(&text, "tip", Path::new("")).unwrap_err();
    // That of the section.
    assert_eq!(fault.line, Some(5), "{}", fault.problem);
}

/// Version 1 stays readable, with Coulomb's friction that had no name.
#[test]
fn scenes_of_before_are_read() {
    let text = "version = 1\nname = \"old\"\n[input]\nconvention = \"reaction\"\nrest_s = 0.0\n[surface]\nshape = \"sphere\"\n\
                radius_m = 0.013\n[contact]\nmodel = \"point\"\nleast_force_N = 0.1\n[friction]\nstatic_coefficient = 0.5\n\
                [slip]\ndetector = \"threshold\"\nnoise_N = 0.01\n";
    let scene = Scene::from_text(text).unwrap();
    assert_eq!((scene.name(), scene.rest(), scene.least_force()), ("old", None, 0.1));
    assert_eq!(scene.limit().unwrap().coefficient(), 0.5);
}
