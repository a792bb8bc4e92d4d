//! What the stages of a scene say, against what they are made of.

use fingertip::contact::{ContactCovariance, ContactJacobian, WrenchNoise};
use fingertip::friction::{ForceNoise, SlipVerdict, UncertainCoulomb};
use fingertip::surfaces::{SmoothSurface, Sphere};
use fingertip::wrench::Wrench;
use fingertip_scene::{Felt, MapKind, Scene};
use nalgebra::{Vector3, Vector6};

use crate::{BALL, HEAD, NOISE, pushes};

fn scene(rest: &str) -> Scene {
    let text = format!("{HEAD}{BALL}{rest}");
    Scene::from_text(&text).unwrap_or_else(|problem| panic!("{problem}\n{text}"))
}

#[test]
fn the_ellipse_is_that_of_the_covariance() {
    let sphere = Sphere::centred(0.013).unwrap();
    let noise = WrenchNoise::new(Vector6::new(0.01, 0.01, 0.01, 1e-4, 1e-4, 1e-4), 0.0).unwrap();
    for (model, soft) in [("point", false), ("soft_finger", true)] {
        let mut pipeline =
            scene(&format!("[contact]\nmodel = \"{model}\"\nleast_force_N = 0.1\n{NOISE}")).pipeline();
        let mut seen = 0;
        for push in pushes(5, 300) {
            let felt = *pipeline.sense(push, 1e-3);
            let Some(contact) = felt.contact() else {
                assert!(felt.spread.is_none());
                assert!(pipeline.place_covariance().is_none());
                continue;
            };
            let jacobian = if soft {
                ContactJacobian::of_soft_finger_on(contact, &sphere)
            } else {
                ContactJacobian::of_point_contact(contact, &push, &sphere.shape_operator(&contact.point))
            };
            let covariance = ContactCovariance::new(&jacobian.unwrap(), &noise.covariance(&push));
            let spread = felt.spread.unwrap();
            // (Directions of a circle are any.)
            let expected = covariance.ellipse(0.95).unwrap();
            for (axis, expected) in spread.ellipse.semi_axes.iter().zip(expected.semi_axes) {
                assert!((axis / expected - 1.0).abs() < 1e-9);
            }
            let ([a, b], m) = (covariance.tangents(), covariance.position());
            let place = a * a.transpose() * m.m11
                + (a * b.transpose() + b * a.transpose()) * m.m12
                + b * b.transpose() * m.m22;
            let found = pipeline.place_covariance().unwrap();
            assert!((found - place).norm() < 1e-9 * place.norm(), "{found} {place}");
            let deviation = covariance.normal_force_variance().sqrt();
            assert!((spread.normal_force / deviation - 1.0).abs() < 1e-15);
            seen += 1;
        }
        assert!(seen > 200);
    }
}

/// With a track the place is as sure as the track: a contact that rests is known better and better.
#[test]
fn the_place_of_a_track_is_that_of_all_samples() {
    let tracking = "[tracking]\nspeed_m_per_s = 0.001\nturns_within_s = 0.1\nleast_touch_N = 0.1\n";
    let mut pipeline = scene(&format!("{NOISE}{tracking}")).pipeline();
    let push = Wrench::from_force_at(&Vector3::new(0.0, 0.0, 0.013), Vector3::new(0.0, 0.0, -0.5));
    let widths: Vec<f64> = (0..100)
        .map(|_| {
            pipeline.sense(push, 1e-3);
            let found = pipeline.place_covariance().unwrap();
            let m = pipeline.felt().tracked.as_ref().unwrap().position_covariance;
            assert!((found.trace() - m.trace()).abs() < 1e-9 * m.trace());
            assert!((found * Vector3::z()).norm() < 1e-3 * found.norm(), "{found}");
            found.trace().sqrt()
        })
        .collect();
    assert!(widths[99] < 0.5 * widths[0], "{widths:?}");
    // Pressed askew, it is told along the tangents of the track, with what both have in common.
    let mut together = 0.0_f64;
    for push in pushes(12, 200) {
        let felt = *pipeline.sense(push, 1e-3);
        let (Some(found), Some(tracked)) = (pipeline.place_covariance(), felt.tracked) else { continue };
        let [a, b] = tracked.tangents;
        let told = [a.dot(&(found * a)), a.dot(&(found * b)), b.dot(&(found * a)), b.dot(&(found * b))];
        let m = tracked.position_covariance;
        for (told, wanted) in told.into_iter().zip([m.m11, m.m12, m.m21, m.m22]) {
            assert!((told - wanted).abs() < 1e-9 * m.trace(), "{found} for {m}");
        }
        together = together.max(m.m12.abs() / m.trace());
    }
    assert!(together > 0.005, "{together}");
    pipeline.reset();
    for _ in 0..100 {
        pipeline.sense(push, 1e-3);
    }
    // Without a contact the track goes on, less and less sure.
    pipeline.sense(Wrench::on_fingertip(Vector3::zeros(), Vector3::zeros()), 1e-3);
    assert!(pipeline.place_covariance().unwrap().trace().sqrt() > widths[99]);
    pipeline.reset();
    pipeline.sense(Wrench::on_fingertip(Vector3::zeros(), Vector3::zeros()), 1e-3);
    assert!(pipeline.place_covariance().is_none());
}

/// How soon a blow must be over stands in the scene: what takes longer is a press.
#[test]
fn the_scene_says_how_long_a_blow_may_be() {
    let impact = |rest: &str| {
        let tracking = "[tracking]\nspeed_m_per_s = 0.01\nturns_within_s = 0.1\nleast_touch_N = 0.1\n";
        let mut pipeline = scene(&format!("{NOISE}{tracking}{rest}")).pipeline();
        // It rises at once and falls to 1/e of its peak within 0.1 s.
        let force = |k: i32| if k < 20 { 0.0 } else { 3.0 * (f64::from(20 - k) / 100.0).exp() };
        let told = (0..500).filter_map(|k| {
            let push = Wrench::from_force_at(&(Vector3::z() * 0.013), Vector3::z() * -force(k));
            pipeline.sense(push, 1e-3).happened.and_then(|happened| happened.impact)
        });
        told.map(|impact| impact.peak).collect::<Vec<f64>>()
    };
    assert_eq!(impact(""), [0.0; 0]);
    assert_eq!(impact("longest_impact_s = 0.05\n"), [0.0; 0]);
    assert_eq!(impact("longest_impact_s = 0.2\n"), [3.0]);
}

/// What is uncertain of the shape's place adds to the ellipse; through a skin there is one, too.
#[test]
fn an_uncertain_place_and_a_skin_widen_the_ellipse() {
    let push = Wrench::from_force_at(&Vector3::new(0.0, 0.004, 0.0123), Vector3::new(0.1, 0.0, -1.0));
    let axis = |rest: &str| scene(rest).pipeline().sense(push, 1e-3).spread.unwrap().ellipse.semi_axes[0];
    let exact = axis(NOISE);
    let placed = axis(&format!("{NOISE}position_m = 0.001\n"));
    // The line of action stays: a shift along the normal moves the contact by its slant.
    assert!(placed > 1.5 * exact && placed < exact + 3.0 * 0.001, "{exact} {placed}");
    for model in ["point", "soft_finger"] {
        let skin = format!(
            "[contact]\nmodel = \"{model}\"\n[contact.skin]\nlaw = \"linear\"\nstiffness_N_per_m = 4000.0\nradius_m = 0.013\n{NOISE}"
        );
        assert!(axis(&skin) > 0.0);
    }
}

#[test]
fn an_uncertain_friction_tells_its_probability() {
    let mut pipeline = scene(
        "[friction]\nlimit = \"uncertain\"\nstatic_coefficient = 0.5\ndeviation = 0.05\nnoise_N = 0.01\nprobability = 0.05\n",
    )
    .pipeline();
    let model = UncertainCoulomb::new(0.5, 0.05, Some(ForceNoise::isotropic(0.01).unwrap())).unwrap();
    for push in pushes(6, 200) {
        let felt = pipeline.sense(push, 1e-3);
        let expected = felt.force().map(|force| model.slip_probability(force));
        assert_eq!(felt.slip_probability, expected);
        if let Some(force) = felt.force() {
            let cautious = model.quantile(0.05);
            let used = force.tangential_magnitude() / (cautious * force.normal);
            assert!((felt.margin().unwrap().utilisation / used - 1.0).abs() < 1e-12);
        }
    }
}

/// A load that grows until it slips at a ratio of 0.6, and slides at 0.4: both are learnt, and the grip follows.
#[test]
fn friction_is_learnt_and_the_grip_follows() {
    let mut pipeline = scene(
        "[friction]\nstatic_coefficient = 0.5\n[slip]\ndetector = \"drop\"\nnoise_N = 0.002\n\
         [estimate]\nnoise_N = 0.002\n\
         [grip]\nleast_N = 0.2\ngreatest_N = 20.0\nrise_N_per_s = 100.0\nfall_N_per_s = 2.0\n",
    )
    .pipeline();
    let top = Vector3::new(0.0, 0.0, 0.013);
    let (mut slipped, mut command) = (0, 0.0_f64);
    let mut last = None;
    for k in 0..900 {
        let ratio = if k < 600 { 0.001 * f64::from(k) } else { 0.4 };
        let felt = pipeline.sense(Wrench::from_force_at(&top, Vector3::new(2.0 * ratio, 0.0, -2.0)), 1e-3);
        slipped += usize::from(felt.touch.slip == Some(SlipVerdict::Slipping));
        let next = felt.grip_force.unwrap();
        assert!((next - command).abs() <= 0.1 + 1e-12 || k == 0, "{next} after {command}");
        command = next;
        last = felt.friction;
    }
    let learnt = last.unwrap();
    let at_rest = learnt.at_rest.unwrap().coefficient;
    assert!(slipped > 0 && (at_rest - 0.6).abs() < 0.01, "{slipped} {learnt:?}");
    let sliding = learnt.sliding.unwrap().coefficient;
    assert!((sliding - 0.4).abs() < 0.02, "{learnt:?}");
    // 0.8 N sideways at 0.5 with a safety of 1.5.
    assert!(command >= 2.0 * 0.4 / 0.5 * 1.5 - 1e-9, "{command}");
    pipeline.reset();
    let fresh = pipeline.sense(Wrench::from_force_at(&top, Vector3::new(0.0, 0.0, -2.0)), 1e-3);
    assert_eq!(fresh.friction.unwrap().at_rest, None);
}

/// After a pause the detector and the last contact are forgotten.
#[test]
fn a_pause_starts_anew() {
    let ring = format!("{HEAD}[surface]\nshape = \"torus\"\nring_radius_m = 0.03\ntube_radius_m = 0.01\n");
    let scene = Scene::from_text(&ring).unwrap();
    let left = Wrench::from_force_at(&Vector3::new(0.0, 0.0, 0.012), Vector3::new(-1.0, 0.0, -0.7));
    let twice = Wrench::from_force_at(&Vector3::zeros(), -Vector3::x());
    for (pause, expected) in [(0.01, -0.02), (0.5, -0.02), (0.51, 0.04)] {
        let mut pipeline = scene.pipeline();
        assert!(pipeline.sense(left, 0.0).contact().unwrap().point.x < -0.02);
        let found = pipeline.sense(twice, pause).contact().unwrap().point.x;
        assert!((found - expected).abs() < 1e-9, "{found} after {pause} s");
    }
}

/// What a pipeline says can be written and read back, for programs in other languages.
#[test]
fn what_is_felt_is_data() {
    let mut pipeline = scene(&format!(
        "[contact]\nmodel = \"soft_finger\"\nleast_force_N = 0.1\n{NOISE}[friction]\nstatic_coefficient = 0.5\n\
         [slip]\ndetector = \"drop\"\nnoise_N = 0.01\n"
    ))
    .pipeline();
    let mut kinds = [0; 2];
    for push in pushes(9, 60) {
        let felt = *pipeline.sense(push, 1e-3);
        let text = serde_json::to_string(&felt).unwrap();
        assert_eq!(serde_json::from_str::<Felt<f64>>(&text).unwrap(), felt, "{text}");
        let contact = felt.contact().is_some();
        assert!(text.contains(if contact { "\"contact\":{" } else { "\"below_threshold\":{" }), "{text}");
        kinds[usize::from(contact)] += 1;
    }
    assert!(kinds.iter().all(|&count| count > 3), "{kinds:?}");
    assert_eq!(SlipVerdict::Slipping as u8, 3);
}

/// After a reset all is as at the start: the same samples are told the same.
#[test]
fn a_reset_forgets_everything() {
    let ring = "[surface]\nshape = \"torus\"\nring_radius_m = 0.007\ntube_radius_m = 0.004\n";
    let rest = format!(
        "{NOISE}[tracking]\nspeed_m_per_s = 0.01\nturns_within_s = 0.1\nleast_touch_N = 0.1\n\
         [friction]\nstatic_coefficient = 0.3\n[slip]\ndetector = \"drop\"\nnoise_N = 0.002\n\
         [estimate]\nnoise_N = 0.002\n\
         [grip]\nleast_N = 0.2\ngreatest_N = 20.0\nrise_N_per_s = 100.0\nfall_N_per_s = 2.0\n"
    );
    for surface in [BALL, ring] {
        let mut pipeline = Scene::from_text(&format!("{HEAD}{surface}{rest}")).unwrap().pipeline();
        let mut told =
            || -> Vec<Felt<f64>> { pushes(31, 200).map(|push| *pipeline.sense(push, 1e-3)).collect() };
        let first = told();
        // It ends in the middle of what it has learnt.
        assert_ne!(told(), first);
        pipeline.reset();
        let again: Vec<Felt<f64>> = pushes(31, 200).map(|push| *pipeline.sense(push, 1e-3)).collect();
        assert_eq!(again, first);
        assert!(first.iter().any(|felt| felt.touch.slip == Some(SlipVerdict::Slipping)));
    }
}

/// How a sphere is drawn: all of it, or up to its rim.
#[test]
fn a_sphere_is_drawn_up_to_its_rim() {
    assert_eq!(scene("").projection().kind(), MapKind::Polar { rim: None });
    let part = Scene::from_text(&format!("{HEAD}{BALL}active_half_angle_deg = 60.0\n")).unwrap();
    let MapKind::Polar { rim: Some(rim) } = part.projection().kind() else { panic!() };
    assert!((rim.to_degrees() - 60.0).abs() < 1e-9);
}

/// Each stage beside those of every scene speaks by itself.
#[test]
fn each_stage_speaks_alone() {
    let push = Wrench::from_force_at(&Vector3::new(0.0, 0.0, 0.013), Vector3::new(0.2, 0.0, -2.0));
    let told = |rest: &str| {
        let felt = *scene(rest).pipeline().sense(push, 1e-3);
        // Not without its section.
        assert_eq!(felt.tracked.is_some(), rest.contains("[tracking]"));
        assert_eq!(felt.happened.is_some(), rest.contains("least_touch_N"));
        [
            felt.spread.is_some(),
            felt.slip_probability.is_some(),
            felt.friction.is_some(),
            felt.grip_force.is_some(),
        ]
    };
    assert_eq!(told(""), [false; 4]);
    assert_eq!(told(NOISE), [true, false, false, false]);
    let tracking = format!("{NOISE}[tracking]\nspeed_m_per_s = 0.01\nturns_within_s = 0.1\n");
    assert_eq!(told(&tracking), [true, false, false, false]);
    assert_eq!(told(&format!("{tracking}least_touch_N = 0.1\n")), [true, false, false, false]);
    let uncertain = "[friction]\nlimit = \"uncertain\"\nstatic_coefficient = 0.5\ndeviation = 0.05\n";
    assert_eq!(told(uncertain), [false, true, false, false]);
    let slip = "[slip]\ndetector = \"drop\"\nnoise_N = 0.01\n[estimate]\nnoise_N = 0.01\n";
    assert_eq!(told(slip), [false, false, true, false]);
    let grip = "[friction]\nstatic_coefficient = 0.5\n[grip]\nleast_N = 0.2\ngreatest_N = 20.0\nrise_N_per_s = 100.0\nfall_N_per_s = 2.0\n";
    assert_eq!(told(grip), [false, false, false, true]);
}

/// A pause forgets what the detector has seen: a ratio that is another one behind it is no slip.
#[test]
fn a_pause_is_no_slip() {
    let top = Vector3::new(0.0, 0.0, 0.013);
    let at = |ratio: f64| Wrench::from_force_at(&top, Vector3::new(2.0 * ratio, 0.0, -2.0));
    for (pause, slips) in [(1e-3, true), (0.6, false)] {
        let mut pipeline = scene("[slip]\ndetector = \"drop\"\nnoise_N = 0.002\n").pipeline();
        for k in 0..200 {
            let _ = pipeline.sense(at(0.3 + 0.001 * f64::from(k)), 1e-3);
        }
        let slipped = (0..20).any(|k| {
            let step = if k == 0 { pause } else { 1e-3 };
            pipeline.sense(at(0.2), step).touch.slip == Some(SlipVerdict::Slipping)
        });
        assert_eq!(slipped, slips, "{pause}");
    }
}
