//! Scenes that are wrong: each is refused in a sentence that names the key and the mend.

use fingertip_scene::{Convention, Scene};
use std::path::Path;

use crate::front::Folder;
use crate::{BALL, HEAD, NOISE};

#[test]
fn faults_are_named() {
    let good = format!("{HEAD}{BALL}");
    assert_eq!(Scene::from_text(&good).unwrap().convention(), Convention::OnFingertip);
    let with = |rest: &str| format!("{good}{rest}");
    let noise = "[uncertainty]\nforce_noise_N = 0.01\ntorque_noise_Nm = 0.0001\n";
    let tracked = |keys: &str| with(&format!("{noise}[tracking]\n{keys}"));
    let flaw = |text: &str, other: &str| good.replace(text, other);
    let cases = [
        (flaw("convention = \"on_fingertip\"\n", ""), "missing field `convention`"),
        (flaw("on_fingertip", "object"), "expected `on_fingertip` or `reaction`"),
        (flaw("convention", "convection"), "key `input.convection`: unknown field `convection`"),
        (with("radius_mm = 13.0\n"), "key `surface.radius_mm`: unknown field `radius_mm`"),
        (flaw("[surface]", "[input.columns]\nforce_x = \"F\"\n[surface]"), "`force_x` of [input.columns]"),
        (flaw("[surface]", "[input.columns]\nv0 = \"F\"\n[surface]"), "`v0` of [input.columns]"),
        (flaw("[surface]", "[input.columns]\ntime = \"-T\"\n[surface]"), "[input.columns]"),
        (flaw("[surface]", "[input.units]\ntorque = \"furlong\"\n[surface]"), "`torque` of [input.units]"),
        (with("[contacts]\n"), "unknown field `contacts`"),
        (flaw("sphere", "cube"), "unknown variant `cube`"),
        (flaw("radius_m = 0.013\n", ""), "missing field `radius_m`"),
        (flaw("0.013", "-0.013"), "radius of a sphere"),
        (flaw("0.013", "nan"), "radius of a sphere"),
        (flaw("0.013", "\"13 mm\""), "key `surface.radius_m`: invalid type: string"),
        (with("pole = [0.0, 1.0]\n"), "key `surface.pole`: invalid length 2"),
        (flaw("[input]", "[input]\nsensor = 1"), "key `input.sensor`: invalid type: integer"),
        (format!("name = 3\n{good}"), "key `name`: invalid type: integer"),
        (with("[contact]\nleast_force_N = -1.0\n"), "least force"),
        (with("[friction]\nstatic_coefficient = 0.0\n"), "friction coefficient"),
        (with("[slip]\ndetector = \"drop\"\nnoise_N = 0.0\n"), "noise"),
        (flaw("[input]", "[input]\nrest_s = -1"), "rest_s"),
        (flaw("sample_rate_Hz = 1000.0", "sample_rate_Hz = -5.0"), "sample_rate_Hz"),
        (flaw("sample_rate_Hz = 1000.0", "sample_rate_Hz = 0.0"), "sample_rate_Hz"),
        (with(&format!("{NOISE}probability = 0.0\n")), "probability"),
        (
            with(
                "[friction]\nlimit = \"uncertain\"\nstatic_coefficient = 0.5\ndeviation = 0.1\nprobability = 0.0\n",
            ),
            "probability",
        ),
        (
            with(
                "[friction]\nlimit = \"uncertain\"\nstatic_coefficient = 0.5\ndeviation = 0.1\nprobability = 0.5\n",
            ),
            "probability",
        ),
        (with("active_half_angle_deg = 190.0\n"), "active_half_angle_deg"),
        (with("pole = [0.0, 0.0, 0.0]\n"), "pole"),
        (with("[pose]\nrotation_deg = [0.0, inf, 0.0]\n"), "rotation_deg"),
        (with("[map]\n"), "[map]"),
        (
            flaw(
                BALL,
                "[surface]\nshape = \"torus\"\nring_radius_m = 0.02\ntube_radius_m = 0.01\n[map]\ncentre_m = [inf, 0.0, 0.0]\n",
            ),
            "`centre_m` of [map]",
        ),
        (
            flaw(
                BALL,
                "[surface]\nshape = \"torus\"\nring_radius_m = 0.02\ntube_radius_m = 0.01\n[map]\npole = [0.0, 0.0, inf]\n",
            ),
            "`pole` of [map]",
        ),
        (
            flaw(BALL, "[surface]\nshape = \"mesh\"\nfile = \"nowhere.stl\"\nmetres_per_unit = 0.001\n"),
            "mesh nowhere.stl",
        ),
        (good.replace("version = 2", "version = 3"), "version 3"),
        (good.replace("version = 2\n", ""), "version = 2"),
        (with("[contact]\nmodel = \"auto\"\n"), "[uncertainty]"),
        (with("[contact]\nmodel = \"soft_finger\"\ngreatest_gap_m = 0.001\n"), "`greatest_gap_m`"),
        (with("[contact]\nmodel = \"soft_finger\"\ntorque_arm_m = 0.003\n"), "`greatest_friction_ratio`"),
        (with("[contact]\ngreatest_pitch_m = 0.01\n"), "`greatest_pitch_m`"),
        (with("[contact]\nspin_noise_Nm = 1e-4\n"), "`spin_noise_Nm`"),
        (with("[contact]\nmodel = \"soft_finger\"\nspin_noise_Nm = -1e-4\n"), "torque noise"),
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
        (
            with("[friction]\nstatic_coeficient = 0.5\n"),
            "key `friction.static_coeficient`: unknown field `static_coeficient`",
        ),
        (with("[slip]\ndetector = \"threshold\"\nnoise_N = 0.01\n"), "[friction]"),
        (
            with("[slip]\ndetector = \"drop\"\nnoise_N = 0.01\n[estimate]\nnoise_N = 0.01\nslide_s = 0.0\n"),
            "slide_s",
        ),
        (
            with("[slip]\ndetector = \"drop\"\nnoise_N = 0.01\n[estimate]\nnoise_N = 0.01\nslide_s = inf\n"),
            "slide_s",
        ),
        (with("[estimate]\nnoise_N = 0.01\n"), "[slip]"),
        (with("[tracking]\nspeed_m_per_s = 0.01\nturns_within_s = 0.1\n"), "[uncertainty]"),
        (tracked("speed_m_per_s = -0.01\nturns_within_s = 0.1\n"), "`speed_m_per_s` of [tracking]"),
        (tracked("speed_m_per_s = 0.01\nturns_within_s = 0.0\n"), "`turns_within_s` of [tracking]"),
        (tracked("speed_m_per_s = 1e-200\nturns_within_s = 1e-200\n"), "a length"),
        (tracked("speed_m_per_s = 0.01\nturns_within_s = 0.1\ndoubted_share = 1.0\n"), "`doubted_share`"),
        (tracked("speed_m_per_s = 0.01\nturns_within_s = 0.1\nleast_touch_N = 0.0\n"), "`least_touch_N`"),
        (
            tracked(
                "speed_m_per_s = 0.01\nturns_within_s = 0.1\nleast_touch_N = 0.1\nsamples_per_false_event = 1.0\n",
            ),
            "`samples_per_false_event`",
        ),
        (
            tracked(
                "speed_m_per_s = 0.01\nturns_within_s = 0.1\nleast_touch_N = 0.1\nlongest_impact_s = 0.0\n",
            ),
            "`longest_impact_s`",
        ),
        (tracked("turns_within_s = 0.1\n"), "speed_m_per_s"),
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
        (with("[uncertainty]\nforce_noise_N = 0.1\n"), "`torque_noise_Nm` beside `force_noise_N`"),
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

#[test]
fn what_is_hardly_meant_is_doubted() {
    let doubts = |text: &str| Scene::from_text(text).unwrap_or_else(|problem| panic!("{problem}")).doubts();
    let good = format!("{HEAD}{BALL}[contact]\nleast_force_N = 0.1\n{NOISE}");
    assert_eq!(doubts(&good), [""; 0]);
    for (text, expected) in [
        (
            good.replace("0.013", "13.0"),
            "`radius_m` of [surface] is 13 m, longer than any fingertip; of millimetres it is 0.013",
        ),
        (good.replace("0.013", "1e300"), "`radius_m` of [surface] is 1e300 m, longer"),
        (
            good.replace("0.013", "1e-9"),
            "[surface] reaches 1e-9 m from its middle, smaller than any fingertip",
        ),
        (good.replace("0.013", "5e-5"), "[surface] reaches 5e-5 m from its middle, smaller"),
        (format!("{good}[pose]\ntranslation_m = [0.0, 30.0, 0.0]\n"), "`translation_m` of [pose] is 30 m"),
        (
            format!("{good}[friction]\nstatic_coefficient = 20.0\n"),
            "`static_coefficient` of [friction] is 20",
        ),
        (
            good.replace("least_force_N = 0.1", "least_force_N = 0.02"),
            "less than three times the `force_noise_N`",
        ),
        (
            format!("{HEAD}rest_s = 1.0\n{BALL}[contact]\nleast_force_deviations = 2.9\n"),
            "`least_force_deviations` of [contact] is 2.9, less than three",
        ),
        (format!("{good}[slip]\ndetector = \"drop\"\nnoise_N = 0.0001\n"), "both are of one sensor"),
        (
            format!("{good}[slip]\ndetector = \"drop\"\nnoise_N = 0.01\n").replace("1000.0", "53.0"),
            "`sample_rate_Hz` of [input] is 53",
        ),
        (
            format!(
                "{HEAD}[surface]\nshape = \"compound\"\nparts = [{{ shape = \"sphere\", radius_m = 8.0 }}, {{ shape = \"sphere\", radius_m = 0.01 }}]\n"
            ),
            "`radius_m` of [surface] is 8 m",
        ),
        (
            format!(
                "{HEAD}[surface]\nshape = \"formula\"\noutside = \"x^2 + y^2 + z^2 - 0.0001\"\nreach_m = 20.0\n"
            ),
            "`reach_m` of [surface] is 20 m",
        ),
    ] {
        let found = doubts(&text);
        assert!(found.len() == 1 && found[0].contains(expected), "{found:?} lacks {expected}");
    }
}

/// The file of a mesh says no unit: by a wrong one it reaches too far, or nowhere, and how far is told in few digits.
#[test]
fn a_mesh_in_another_unit_is_doubted() {
    let folder = Folder::new("mesh-doubts");
    let corner = "v 0 0 0\nv 30 0 0\nv 0 30 0\nv 0 0 30\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    std::fs::write(folder.path().join("tip.obj"), corner).unwrap();
    // The middle of its box is 15 from every side.
    for (unit, reach) in [("1.0", "25.98"), ("1e-7", "3e-6 m")] {
        let text =
            format!("{HEAD}[surface]\nshape = \"mesh\"\nfile = \"tip.obj\"\nmetres_per_unit = {unit}\n");
        let found = Scene::parse(&text, "scene", folder.path()).unwrap().doubts();
        let wanted = format!("by which the mesh reaches {reach}");
        assert!(found.len() == 1 && found[0].contains(&wanted), "{found:?} lacks {wanted}");
    }
}

/// Three times as much noise may be of one sensor still, and half a metre of a hand.
#[test]
fn what_may_be_is_not_doubted() {
    for text in [
        format!(
            "{HEAD}{BALL}[contact]\nleast_force_N = 5.0\n{NOISE}[slip]\ndetector = \"drop\"\nnoise_N = 0.03\n"
        ),
        format!("{HEAD}rest_s = 1.0\n{BALL}[contact]\nleast_force_deviations = 3.0\n"),
        format!("{HEAD}{BALL}[pose]\ntranslation_m = [0.5, 0.0, -0.5]\n"),
        format!("{HEAD}{BALL}[slip]\ndetector = \"drop\"\nnoise_N = 0.01\n[contact]\nleast_force_N = 0.1\n")
            .replace("1000.0", "200.0"),
        format!("{HEAD}{BALL}[friction]\nstatic_coefficient = 2.5\n"),
        format!("{HEAD}{BALL}[friction]\nstatic_coefficient = 0.05\n"),
    ] {
        assert_eq!(Scene::from_text(&text).unwrap().doubts(), [""; 0], "{text}");
    }
}

#[test]
fn a_scene_says_what_it_means() {
    let text = format!(
        "{HEAD}[surface]\nshape = \"heightfield\"\ncorner_m = [-0.01, -0.01]\nspacing_m = [0.02, 0.02]\ncolumns = 2\n\
         heights_m = [0.010000001, 0.010000002, 0.010000003, 0.010000004, 0.010000005, 0.010000006]\n\
         [contact]\nleast_force_N = 0.1\n[contact.skin]\nlaw = \"linear\"\nstiffness_N_per_m = 8000.0\nradius_m = 0.013\n\
         [friction]\nstatic_coefficient = 0.5\n"
    );
    let meaning = Scene::from_text(&text).unwrap().meaning();
    assert_eq!(
        meaning,
        [
            "input        convention = \"on_fingertip\", sample_rate_Hz = 1000.0",
            "surface      heightfield, heights over a grid; columns = 2, corner_m = [-0.01, -0.01], heights_m = \
             [0.010000001, 0.010000002, 0.010000003, 0.010000004, 0.01000 …, spacing_m = [0.02, 0.02]",
            "contact      least_force_N = 0.1",
            "contact.skin linear, depth in proportion to the force; radius_m = 0.013, stiffness_N_per_m = 8000.0",
            "friction     coulomb, one coefficient in all directions; static_coefficient = 0.5",
        ]
    );
}

/// Columns keep their names, take their units and turn their signs.
#[test]
fn columns_are_taken_for_what_the_scene_says() {
    let text = format!(
        "{HEAD}[input.columns]\ntime = \"T\"\nfx = \"-F 1\"\nty = \"M\"\nv2 = \"b\"\ndummy = \"d\"\ntemperature_C = \"temp\"\n\
         [input.units]\ntime = \"us\"\nforce = \"kN\"\ntorque = \"Nmm\"\nsignal = \"mV\"\n{BALL}"
    );
    let scene = Scene::from_text(&text).unwrap_or_else(|problem| panic!("{problem}"));
    let found: Vec<(&str, &str, bool)> = scene
        .renamed_columns()
        .iter()
        .map(|column| (column.from.as_str(), column.to.as_str(), column.negative))
        .collect();
    assert_eq!(
        found,
        [
            ("d", "dummy (mV)", false),
            ("F 1", "fx (kN)", true),
            ("temp", "temperature_C", false),
            ("T", "t (us)", false),
            ("M", "ty (Nmm)", false),
            ("b", "v2 (mV)", false),
        ]
    );
}
