//! Formulas of surfaces, as a scene has them.
#![no_main]

use std::path::Path;

use fingertip::wrench::Wrench;
use fingertip_scene::Scene;
use libfuzzer_sys::fuzz_target;
use nalgebra::Vector6;

fuzz_target!(|formula: &str| {
    if formula.len() > 200 || formula.contains(['\'', '\n', '\r']) {
        return;
    }
    let text = format!(
        "version = 2\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"formula\"\noutside = '{formula}'\n\
         parameters = {{ a = 0.01, b = 0.013 }}\nreach_m = 0.02\n"
    );
    let Ok(scene) = Scene::parse(&text, "scene", Path::new("")) else { return };
    let mut pipeline = scene.pipeline();
    let load = Vector6::new(0.1, 0.2, -2.0, 1e-3, -2e-3, 1e-3);
    let felt = pipeline.sense(Wrench::from_components(&load), 1e-3);
    if let Some(contact) = felt.touch.resolution.contact() {
        assert!(contact.point.iter().chain(contact.normal.iter()).all(|x| x.is_finite()), "{contact:?}");
    }
});
