//! Scenes. The examples are good to start from: `cargo fuzz run scene_file fuzz/corpus/scene_file ../examples/scenes`.
#![no_main]

use std::path::Path;

use fingertip::wrench::Wrench;
use fingertip_scene::Scene;
use libfuzzer_sys::fuzz_target;
use nalgebra::Vector6;

fuzz_target!(|text: &str| {
    // Files of others are not what is tried here, and some have no end.
    if text.contains("file") || text.len() > 4000 {
        return;
    }
    let Ok(scene) = Scene::parse(text, "scene", Path::new("/nowhere")) else { return };
    let _ = scene.doubts();
    let mut pipeline = scene.pipeline();
    let single = scene.pipeline_in::<f32>();
    for load in [
        [0.1, 0.2, -2.0, 1e-3, -2e-3, 1e-3],
        [0.0; 6],
        [1e300, -1e300, 1e-300, 0.0, 1e300, 1.0],
        [f64::NAN, 0.0, 0.0, 0.0, 0.0, 0.0],
        [0.0, f64::INFINITY, 0.0, 0.0, 0.0, 0.0],
    ] {
        let load = Vector6::from(load);
        for time_step in [1e-3, 0.0, f64::NAN] {
            let felt = pipeline.sense(Wrench::from_components(&load), time_step);
            if let Some(contact) = felt.touch.resolution.contact() {
                assert!(
                    contact.point.iter().chain(contact.normal.iter()).all(|x| x.is_finite()),
                    "{contact:?}"
                );
            }
        }
    }
    if let Ok(mut single) = single {
        let load = Vector6::new(0.1, 0.2, -2.0, 1e-3, -2e-3, 1e-3);
        let _ = single.sense(Wrench::from_components(&load), 1e-3);
    }
});
