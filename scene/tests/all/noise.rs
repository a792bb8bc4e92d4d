//! Thresholds and uncertainty that the rest tells.

use fingertip_scene::{Pipeline, Scene};
use nalgebra::Vector6;

use crate::{BALL, HEAD, pushes};

/// The noise of a rest.
const MEASURED: [f64; 6] = [0.01, 0.02, 0.015, 1e-4, 3e-4, 2e-4];

fn resting() -> String {
    format!("{HEAD}rest_s = 1.0\n{BALL}")
}

fn scene(text: &str) -> Scene {
    Scene::from_text(text).unwrap_or_else(|problem| panic!("{problem}\n{text}"))
}

fn same(known: &mut Pipeline<f64>, stated: &mut Pipeline<f64>) {
    let mut touched = 0;
    for push in pushes(12, 500) {
        let felt = *known.sense(push, 1e-3);
        assert_eq!(felt, *stated.sense(push, 1e-3));
        touched += usize::from(felt.contact().is_some());
    }
    assert!(touched > 200, "{touched}");
}

#[test]
fn a_scene_waits_for_the_noise_and_then_is_one_that_states_it() {
    let noise = Vector6::from(MEASURED);
    let stated = "[uncertainty]\nforce_noise_N = 0.02\ntorque_noise_Nm = 0.0003\n";
    for model in ["point", "soft_finger", "auto"] {
        for (asked, told, alike) in [
            // The noisiest component of the force decides.
            ("least_force_deviations = 5.0", "least_force_N = 0.1", ""),
            ("least_force_N = 0.2", "least_force_N = 0.2", "[uncertainty]\noffset_m = 1e-4\n"),
            ("least_force_deviations = 6.0", "least_force_N = 0.12", stated),
        ] {
            if model == "auto" && alike.is_empty() {
                continue;
            }
            let text = |least: &str, more: &str| {
                format!("{}[contact]\nmodel = \"{model}\"\n{least}\n{more}", resting())
            };
            let mut waiting = scene(&text(asked, alike)).pipeline();
            assert!(waiting.awaits_noise());
            for push in pushes(3, 50) {
                assert!(waiting.sense(push * 1e3, 1e-3).contact().is_none());
            }
            // All components alike where the other scene can state no more.
            let noise = if alike.contains("offset") {
                Vector6::from([0.02, 0.02, 0.02, 3e-4, 3e-4, 3e-4])
            } else {
                noise
            };
            waiting.know_noise(&noise).unwrap();
            assert!(!waiting.awaits_noise());
            let more = if alike.contains("offset") {
                format!("{stated}offset_m = 1e-4\n")
            } else {
                alike.to_owned()
            };
            same(&mut waiting, &mut scene(&text(told, &more)).pipeline());
            // Another rest, another noise.
            waiting.know_noise(&(noise * 1e3)).unwrap();
            let heavy = pushes(3, 1).next().unwrap();
            assert_eq!(waiting.sense(heavy, 1e-3).contact().is_none(), asked.contains("deviations"));
        }
    }
}

#[test]
fn each_component_has_its_own_noise() {
    let text = format!("{}[uncertainty]\n", resting());
    let mut pipeline = scene(&text).pipeline();
    pipeline.know_noise(&Vector6::from(MEASURED)).unwrap();
    let mut single = scene(&text).pipeline_in::<f32>().unwrap();
    single.know_noise(&Vector6::from(MEASURED).map(|x| x as f32)).unwrap();
    // Pressed on its top, the normal force is fz.
    let push = fingertip::wrench::Wrench::on_fingertip(-nalgebra::Vector3::z(), nalgebra::Vector3::zeros());
    let spread = pipeline.sense(push, 1e-3).spread.unwrap();
    assert!((spread.normal_force - 0.015).abs() < 1e-12, "{spread:?}");
    // Torques about x and y move the contact on the top under one newton: 95 % is 2.4477 deviations.
    let [long, short] = spread.ellipse.semi_axes;
    for (axis, torque) in [(long, 3e-4_f64), (short, 1e-4)] {
        assert!(axis > torque * 2.447, "{axis}");
    }
    let narrow = single.sense(
        fingertip::wrench::Wrench::on_fingertip(-nalgebra::Vector3::z(), nalgebra::Vector3::zeros()),
        1e-3,
    );
    assert!((f64::from(narrow.spread.unwrap().normal_force) - 0.015).abs() < 1e-7);
}

#[test]
fn what_cannot_be_is_refused() {
    let error = |text: &str| Scene::from_text(text).map(|_| ()).unwrap_err().to_string();
    let contact = "[contact]\nleast_force_deviations = 5.0\n";
    for (text, words) in [
        (format!("{HEAD}{BALL}{contact}"), "`rest_s`"),
        (format!("{HEAD}{BALL}[uncertainty]\n"), "`rest_s`"),
        (format!("{}{contact}least_force_N = 0.1\n", resting()), "`least_force_N` of [contact]"),
        (format!("{}[contact]\nleast_force_deviations = 0.0\n", resting()), "`least_force_deviations`"),
        (format!("{}[contact]\nleast_force_deviations = -1.0\n", resting()), "`least_force_deviations`"),
        (format!("{}[contact]\nleast_force_deviations = nan\n", resting()), "`least_force_deviations`"),
        (format!("{}[contact]\nleast_force_deviations = 2e6\n", resting()), "`least_force_deviations`"),
        (format!("{}[uncertainty]\nforce_noise_N = 0.1\n", resting()), "`torque_noise_Nm`"),
        (format!("{}[uncertainty]\ntorque_noise_Nm = 0.1\n", resting()), "`force_noise_N`"),
    ] {
        let said = error(&text);
        assert!(said.contains(words), "{said}\n{text}");
    }
    let mut waiting = scene(&format!("{}{contact}", resting())).pipeline();
    for bad in [-1.0, f64::NAN, f64::INFINITY] {
        let mut noise = Vector6::from(MEASURED);
        noise[4] = bad;
        assert!(waiting.know_noise(&noise).unwrap_err().to_string().contains("`rest_s`"));
        assert!(waiting.awaits_noise());
    }
    // None at all is one.
    waiting.know_noise(&Vector6::zeros()).unwrap();
    assert!(!waiting.awaits_noise());
    // A scene that states all has nothing to learn.
    let mut stated = scene(&resting()).pipeline();
    let before = stated.clone();
    stated.know_noise(&Vector6::from(MEASURED)).unwrap();
    assert_eq!(stated, before);
    let doubts = scene(&format!("{}[contact]\nleast_force_deviations = 2.0\n", resting())).doubts();
    assert!(doubts.iter().any(|doubt| doubt.contains("`least_force_deviations`")), "{doubts:?}");
    assert!(scene(&format!("{}{contact}", resting())).doubts().is_empty());
}
