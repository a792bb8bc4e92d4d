//! The format of scenes, from the registry of `fingertip-scene`.

use core::fmt::Write;

use fingertip_scene::VERSION;
use fingertip_scene::registry::{Entry, Key, Need, entries, keys, sections};

use super::{cell, sentence};

/// A heading for a section.
fn title(section: &str) -> String {
    if section.is_empty() { "Above all sections".to_owned() } else { format!("`[{section}]`") }
}

/// Where mdBook puts the heading of a choice.
fn anchor(section: &str, choice: &str) -> String {
    format!("{}-{choice}", section.replace('.', "-"))
}

fn table<'a>(list: impl Iterator<Item = &'a Key>) -> String {
    let mut text = String::from("| key | | meaning |\n|---|---|---|\n");
    for key in list {
        let need = if key.need == Need::Required { "required" } else { "" };
        let _ = writeln!(text, "| `{}` | {need} | {} |", key.name, cell(key.says));
    }
    text
}

/// All sections and the keys that they have whatever is chosen.
pub(super) fn page() -> String {
    let mut text = format!(
        "# Scene files\n\nA scene tells what a fingertip is: its shape, how it sits on the sensor, which sign the load \
         has, what to look for. It is a TOML file of the format's version {VERSION}. The unit is part of a key's name \
         (`radius_m`, `least_force_N`, `rotation_deg`). A key that is not listed here is an error, so that a slip of the \
         pen does not pass for a default.\n\n`fingertip scene init tip.toml` begins one, `fingertip scene check tip.toml` \
         says what it means and what in it is implausible, and `fingertip scene show tip.toml` draws it. Whole scenes: \
         [examples](../../../examples/scenes/README.md).\n\n| section | | for |\n|---|---|---|\n"
    );
    for section in sections().filter(|section| !section.name.is_empty()) {
        let need = if section.need == Need::Required { "required" } else { "" };
        let name = section.name;
        let _ = writeln!(
            text,
            "| [`[{name}]`](#section-{}) | {need} | {} |",
            name.replace('.', "-"),
            cell(section.says)
        );
    }
    for section in sections() {
        let name = section.name;
        let id =
            if name.is_empty() { "above".to_owned() } else { format!("section-{}", name.replace('.', "-")) };
        let _ = write!(text, "\n## {} {{#{id}}}\n\n", title(name));
        if !name.is_empty() {
            let _ = write!(text, "{}\n\n", sentence(section.says));
        }
        text.push_str(&table(keys().filter(|key| key.section == name && key.choice.is_empty())));
        let chosen: Vec<&Entry> = entries().filter(|entry| entry.section == name).collect();
        if let Some(first) = chosen.first() {
            let _ = write!(text, "\nThe choices of `{}`:\n\n| `{}` | |\n|---|---|\n", first.key, first.key);
            for entry in chosen {
                let place = anchor(name, entry.name);
                let _ =
                    writeln!(text, "| [`\"{}\"`](choices.md#{place}) | {} |", entry.name, cell(entry.says));
            }
        }
        if name == "surface" {
            let _ = write!(
                text,
                "\nOr the link of a robot, in place of `shape`:\n\n{}",
                table(keys().filter(|key| key.choice == "urdf"))
            );
        }
    }
    text.push_str(
        "\nPoints, normals and forces in the results are in the sensor frame. The map is drawn in the surface's frame: the \
         angle around a cylinder counts from the frame's z axis (from x, if the cylinder lies along z), positive by the \
         right-hand rule about the cylinder's axis.\n",
    );
    text
}

/// Every choice with its keys and lines to begin with.
pub(super) fn choices() -> String {
    let mut text = String::from(
        "# Choices of a scene\n\nEvery filter, shape, contact model, skin, friction limit and slip detector, with its keys \
         and with values to begin with. `fingertip scene choices` prints the same in short.\n",
    );
    let mut last = "";
    for entry in entries() {
        let Entry { section, name, says, .. } = entry;
        if *section != last {
            let _ = write!(
                text,
                "\n## `[{section}]`, `{}`\n\nSee [`[{section}]`](scene.md#section-{}).\n",
                entry.key,
                section.replace('.', "-")
            );
            last = section;
        }
        let place = anchor(section, name);
        let _ = write!(text, "\n### `\"{name}\"` {{#{place}}}\n\n{}\n\n", sentence(says));
        let mut own = keys().filter(|key| key.section == *section && key.choice == *name).peekable();
        if own.peek().is_some() {
            text.push_str(&table(own));
            text.push('\n');
        }
        let _ = write!(text, "```toml\n{}```\n", entry.text());
    }
    text
}
