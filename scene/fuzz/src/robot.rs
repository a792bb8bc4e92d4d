//! A scene whose surface is the link `tip` of a robot, with the file under test beside it.

use std::cell::RefCell;
use std::fs;
use std::path::PathBuf;

use fingertip::wrench::Wrench;
use fingertip_scene::Scene;
use nalgebra::Vector6;

const SCENE: &str = "version = 2\n[input]\nconvention = \"on_fingertip\"\n[surface]\nurdf = \"robot.urdf\"\n\
                     link = \"tip\"\n";
const ROBOT: &str = "<robot name='r'><link name='tip'><collision><geometry><mesh filename='mesh.dae'/></geometry>\
                     </collision></link></robot>";

thread_local! {
    static FOLDER: RefCell<Option<PathBuf>> = const { RefCell::new(None) };
}

/// The folder of this process, with a description of a robot in it. `.ci/fuzz` names a place in memory for it, and cleans
/// up.
fn folder() -> PathBuf {
    FOLDER.with_borrow_mut(|known| {
        let make = || {
            let folder = std::env::temp_dir().join(format!("fingertip-fuzz-{}", std::process::id()));
            fs::create_dir_all(&folder).unwrap();
            fs::write(folder.join("robot.urdf"), ROBOT).unwrap();
            folder
        };
        known.get_or_insert_with(make).clone()
    })
}

/// Reads a scene that comes upon this file. What is accepted feels touch in finite numbers.
pub(crate) fn check(name: &str, contents: &[u8]) {
    let folder = folder();
    fs::write(folder.join(name), contents).unwrap();
    let Ok(scene) = Scene::parse(SCENE, "scene", &folder) else { return };
    let mut pipeline = scene.pipeline();
    let load = Vector6::new(0.1, 0.2, -2.0, 1e-3, -2e-3, 1e-3);
    let felt = pipeline.sense(Wrench::from_components(&load), 1e-3);
    if let Some(contact) = felt.touch.resolution.contact() {
        assert!(contact.point.iter().chain(contact.normal.iter()).all(|x| x.is_finite()), "{contact:?}");
    }
}
