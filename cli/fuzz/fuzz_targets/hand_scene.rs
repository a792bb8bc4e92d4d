//! Hand scenes, whose fingers have a scene of the examples.
#![no_main]

use std::path::Path;

use fingertip_cli::library::fingers;
use libfuzzer_sys::fuzz_target;
use toml::{Table, Value};

const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/hands/fuzz.toml");
const SCENE: &str = "../scenes/nano17_cylinder.toml";

/// Whether a text names a scene that is another: files of others are not what is tried here, and some have no end.
fn names_another(text: &str) -> bool {
    let Ok(table) = text.parse::<Table>() else {
        // The reader may get further, as past a number out of range.
        return text.replace(&format!("scene = \"{SCENE}\""), "").contains("scene");
    };
    let fingers = table.get("finger").and_then(Value::as_array).map_or(&[][..], Vec::as_slice);
    fingers.iter().filter_map(|finger| finger.get("scene")).any(|scene| scene.as_str() != Some(SCENE))
}

fuzz_target!(|text: &str| {
    if names_another(text) {
        return;
    }
    match fingers(text, Path::new(FILE)) {
        Ok(names) => {
            assert!((1..=8).contains(&names.len()));
            for (index, name) in names.iter().enumerate() {
                assert!(!name.is_empty() && !names[..index].contains(name), "{names:?}");
            }
        }
        Err(error) => assert!(error.to_string().contains("fuzz.toml"), "{error}"),
    }
});
