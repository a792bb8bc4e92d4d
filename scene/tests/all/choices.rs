//! The registry, walked.

use fingertip_scene::Scene;
use fingertip_scene::registry::{Entry, entries};

use crate::{BALL, HEAD, NOISE, pushes};

/// A whole scene with this choice and what it needs beside it.
pub(crate) fn scene_with(entry: &Entry) -> String {
    let text = entry.text();
    match entry.section {
        "surface" => format!("{HEAD}{text}"),
        "contact" => format!("{HEAD}{BALL}{text}{NOISE}"),
        "contact.skin" => format!("{HEAD}{BALL}{text}"),
        "filter" => format!("{HEAD}{text}{BALL}"),
        "friction" if entry.name == "anisotropic" => {
            format!("{HEAD}[surface]\nshape = \"plane\"\npoint_m = [0.0, 0.0, 0.013]\n{text}")
        }
        "friction" => format!("{HEAD}{BALL}{text}"),
        "slip" => format!("{HEAD}{BALL}[friction]\nstatic_coefficient = 0.5\n{text}"),
        other => panic!("a new section: {other}"),
    }
}

/// Every choice makes a pipeline that runs, in both precisions.
#[test]
fn every_choice_runs() {
    for entry in entries() {
        let text = scene_with(entry);
        let scene = Scene::from_text(&text).unwrap_or_else(|problem| panic!("{problem}\n{text}"));
        let (mut double, mut single) = (scene.pipeline(), scene.pipeline_in::<f32>().unwrap());
        let (mut touched, mut agreed) = (0, 0);
        for push in pushes(17, 200) {
            let felt = double.sense(push, 1e-3);
            let narrow = fingertip::wrench::Wrench::on_fingertip(
                push.force().map(|x| x as f32),
                push.torque().map(|x| x as f32),
            );
            let felt_in_single = single.sense(narrow, 1e-3);
            let Some(contact) = felt.contact() else { continue };
            touched += 1;
            assert!(contact.point.iter().chain(contact.normal.iter()).all(|x| x.is_finite()), "{text}");
            if let Some(other) = felt_in_single.contact() {
                agreed += usize::from((contact.point - other.point.map(f64::from)).norm() < 1e-4);
            }
            match entry.section {
                "friction" => assert!(felt.margin().unwrap().newtons.is_finite()),
                "slip" => assert!(felt.touch.slip.is_some()),
                _ => {}
            }
        }
        println!("{} {}: {touched} touched, {agreed} agreed", entry.section, entry.name);
        assert!(touched > 20, "{touched} touches\n{text}");
        // Edges, and two contacts that are as good, may be told differently.
        assert!(agreed * 10 > touched * 8, "{agreed} of {touched}\n{text}");
    }
}

/// The parser names all choices when it meets one that it does not know: the registry has each of them.
#[test]
fn the_registry_has_all_that_the_parser_knows() {
    let mut sections: Vec<(&str, &str)> = entries().map(|entry| (entry.section, entry.key)).collect();
    sections.dedup();
    assert_eq!(sections.len(), 6);
    for (section, key) in sections {
        let surface = if section == "surface" { "" } else { BALL };
        let text = format!("{HEAD}{surface}[{section}]\n{key} = \"nonsense\"\n");
        let message = Scene::from_text(&text).unwrap_err().to_string();
        let (_, list) = message.split_once("expected ").unwrap_or_else(|| panic!("{message}"));
        // (Another name of the sphere is one of them.)
        let mut known: Vec<&str> =
            list.split('`').skip(1).step_by(2).filter(|name| *name != "spherical_cap").collect();
        // A formula is read by itself.
        known.extend((section == "surface").then_some("formula"));
        let mut entered: Vec<&str> =
            entries().filter(|entry| entry.section == section).map(|entry| entry.name).collect();
        known.sort_unstable();
        entered.sort_unstable();
        assert_eq!(entered, known, "[{section}]");
    }
}
