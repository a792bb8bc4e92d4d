//! What was found of a surface, as a scene: a new one, or in the place of what another says.

use std::path::{Path, PathBuf};

use toml_edit::{DocumentMut, Item, Table, Value};

use super::{FittedShape, GeometryArguments};
use crate::calibrate::files::{bad, text};
use crate::error::CliError;
use crate::output::Outputs;
use crate::scene;
use crate::standard::is_standard;

/// A scene as it is written, comments included.
pub(super) struct Known {
    path: PathBuf,
    document: DocumentMut,
}

impl Known {
    /// The outputs spare what it names.
    pub(super) fn read(path: &Path, outputs: &Outputs) -> Result<Self, CliError> {
        let text = text("scene", path)?;
        // What is no scene is said as every command says it.
        let scene = if is_standard(path) { scene::of_standard(&text) } else { scene::load(path) }?;
        outputs.spare(scene.files())?;
        let document = text.parse().map_err(|error| bad(path, &error))?;
        Ok(Self { path: path.to_owned(), document })
    }

    /// Whether wrenches are what the fingertip does to the world: a scene that says so is believed.
    pub(super) fn reaction(known: Option<&Self>, flag: bool) -> Result<bool, CliError> {
        let Some(known) = known else { return Ok(flag) };
        let said = known.document.get("input").and_then(|input| input.get("convention"));
        match said.and_then(Item::as_str) {
            Some("on_fingertip") if flag => {
                Err(bad(&known.path, &"its `convention` is \"on_fingertip\", against --reaction"))
            }
            Some(convention) => Ok(convention == "reaction"),
            None => Ok(flag),
        }
    }

    /// With these sections in the place of its own of the same names.
    fn with(mut self, sections: &DocumentMut) -> String {
        for (name, section) in sections.iter() {
            let Some(section) = section.as_table() else { continue };
            // The heading, its comment and its place stay.
            let table = self.document.entry(name).or_insert_with(|| Item::Table(Table::new()));
            // As `{ shape = ... }` in the line.
            if let Some(inline) = table.as_inline_table_mut() {
                *table = Item::Table(core::mem::take(inline).into_table());
            }
            let Some(table) = table.as_table_mut() else { continue };
            table.clear();
            for (key, value) in section {
                if let Some(value) = value.as_value() {
                    table.insert(key, Item::Value(plain(value)));
                }
            }
        }
        self.document.to_string()
    }
}

/// The value without what stood around it.
fn plain(value: &Value) -> Value {
    value.clone().decorated(" ", "")
}

/// A whole scene, with `found`, its sections as text.
pub(super) fn scene(
    arguments: &GeometryArguments,
    known: Option<Known>,
    reaction: bool,
    found: &str,
) -> Result<String, CliError> {
    let touches = &arguments.touches;
    match (arguments.shape, known) {
        (FittedShape::Pivot, _) => {
            Err(bad(touches, &"a pivot is no surface: there is no scene to write (-o)"))
        }
        (FittedShape::Pose, None) => {
            Err(bad(touches, &"a pose alone is no scene: name that of the surface (--scene)"))
        }
        (shape, Some(mut known)) => {
            if shape != FittedShape::Pose {
                // What is found is in the frame of the sensor, but for what it says itself.
                known.document.remove("pose");
            }
            let sections = found.parse().map_err(|error| bad(touches, &error))?;
            Ok(known.with(&sections))
        }
        (_, None) => {
            let convention = if reaction { "reaction" } else { "on_fingertip" };
            Ok(format!(
                "version = 1\n\n[input]\nconvention = \"{convention}\"\n# Where a recording has no time, as touches \
                 have none: the rate of the sensor.\nsample_rate_Hz = 1.0\n\n{found}"
            ))
        }
    }
}
