//! The registry's keys beside those that the parser knows, and beside those that it wants.

use alloc::collections::BTreeSet;
use std::path::Path;

use fingertip_scene::Scene;
use fingertip_scene::registry::{Key, Need, entries, keys, sections};

use crate::choices::scene_with;
use crate::{BALL, HEAD};

const NONSENSE: &str = "nonsense_key";

/// The words in back quotes behind "expected": the keys that the parser would have taken.
fn expected(text: &str) -> BTreeSet<String> {
    let message = Scene::from_text(text).unwrap_err().to_string();
    assert!(message.contains(NONSENSE), "{message}\n{text}");
    let (_, list) = message.split_once("expected").unwrap_or_else(|| panic!("{message}\n{text}"));
    list.split('`').skip(1).step_by(2).map(str::to_owned).collect()
}

/// The names of the registry for a section and a choice of it.
fn registered(section: &str, choice: &str) -> BTreeSet<String> {
    keys()
        .filter(|key| key.section == section && key.choice == choice)
        .map(|key| key.name.to_owned())
        .collect()
}

#[test]
fn the_keys_of_every_choice_are_those_of_the_parser() {
    for entry in entries() {
        // The keys of [contact] are those of the whole section, whatever the model.
        let choice = if entry.section == "contact" { "" } else { entry.name };
        let whole = scene_with(entry);
        let line = format!("{}\n", entry.text().lines().nth(1).unwrap());
        let mut known = expected(&whole.replace(&line, &format!("{line}{NONSENSE} = 1\n")));
        if entry.section == "surface" {
            known.remove("shape");
        }
        let mut listed = registered(entry.section, choice);
        if entry.name == "mesh" {
            // With `file` it is read as another section.
            assert!(listed.remove("file") && listed.remove("metres_per_unit"));
            let text = format!("{HEAD}[surface]\nshape = \"mesh\"\nfile = \"a.stl\"\n{NONSENSE} = 1\n");
            assert!(expected(&text).is_superset(&["file".to_owned(), "metres_per_unit".to_owned()].into()));
        }
        assert_eq!(listed, known, "[{}] {}", entry.section, entry.name);
    }
}

#[test]
fn the_keys_of_every_section_are_those_of_the_parser() {
    for section in sections() {
        // Told by their choices, above; and a section whose keys are open, `v1` and so on.
        if ["filter", "surface", "contact.skin", "friction", "slip", "input.columns"].contains(&section.name)
        {
            continue;
        }
        let text = match section.name {
            "" => format!("{NONSENSE} = 1\n{HEAD}{BALL}"),
            "input" => format!("{HEAD}{NONSENSE} = 1\n{BALL}"),
            other => format!("{HEAD}{BALL}[{other}]\n{NONSENSE} = 1\n"),
        };
        let mut known = expected(&text);
        if section.name.is_empty() {
            // The sections themselves.
            let above: BTreeSet<String> = sections()
                .map(|section| section.name)
                .filter(|name| !name.contains('.'))
                .map(str::to_owned)
                .collect();
            known = known.difference(&above).cloned().collect();
            assert!(sections().count() > 15);
        }
        assert_eq!(registered(section.name, ""), known, "[{}]", section.name);
    }
    let link = format!("{HEAD}[surface]\nurdf = \"a.urdf\"\nlink = \"tip\"\n{NONSENSE} = 1\n");
    assert_eq!(registered("surface", "urdf"), expected(&link));
    let columns = format!("{HEAD}[input.columns]\n{NONSENSE} = \"a\"\n{BALL}");
    let message = Scene::from_text(&columns).unwrap_err().to_string();
    for name in registered("input.columns", "") {
        assert!(message.contains(&name), "{name}: {message}");
    }
}

/// Every section of the registry can stand in a file, and every section that can is in it.
#[test]
fn the_sections_are_those_of_the_parser() {
    let text = format!("{NONSENSE} = 1\n{HEAD}{BALL}");
    let listed: BTreeSet<String> = sections()
        .map(|section| section.name)
        .filter(|name| !name.is_empty() && !name.contains('.'))
        .map(str::to_owned)
        .chain(["version".to_owned(), "name".to_owned()])
        .collect();
    assert_eq!(listed, expected(&text));
    for key in keys() {
        assert!(sections().any(|section| section.name == key.section), "[{}]", key.section);
        assert!(!key.says.is_empty() && !key.says.ends_with('.'), "{}", key.name);
    }
}

/// What the parser says of a scene without one of its keys.
fn without(document: &toml::Table, section: &str, key: &str, folder: &Path) -> Option<String> {
    let mut rest = document.clone();
    let table = section
        .split('.')
        .filter(|part| !part.is_empty())
        .try_fold(&mut rest, |table, part| table.get_mut(part)?.as_table_mut())?;
    table.remove(key)?;
    let text = toml::to_string(&rest).unwrap();
    Some(
        Scene::parse(&text, "scene", folder)
            .err()
            .map_or_else(String::new, |fault| fault.problem.to_string()),
    )
}

/// Whether the parser misses the key just where the registry calls it required; `None` where the scene has it not.
fn agrees(document: &toml::Table, key: &Key, folder: &Path) -> Option<Result<(), String>> {
    let message = without(document, key.section, key.name, folder)?;
    let missed = message.contains("missing field") || message.contains("state its version");
    let told = format!("[{}] {} {} is called {:?}: {message}", key.section, key.choice, key.name, key.need);
    Some(if missed == (key.need == Need::Required) { Ok(()) } else { Err(told) })
}

#[test]
fn what_is_required_is_missed() {
    let (mut compared, mut wrong) = (BTreeSet::new(), Vec::new());
    let mut compare = |document: &toml::Table, key: &Key, folder: &Path| {
        if let Some(agreed) = agrees(document, key, folder) {
            compared.insert((key.section, key.choice, key.name));
            wrong.extend(agreed.err());
        }
    };
    for entry in entries() {
        let document: toml::Table = scene_with(entry).parse().unwrap();
        for key in keys().filter(|key| key.section == entry.section && key.choice == entry.name) {
            compare(&document, key, Path::new(""));
        }
    }
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/scenes");
    for file in std::fs::read_dir(&folder).unwrap() {
        let path = file.unwrap().path();
        if path.extension().is_none_or(|ending| ending != "toml") {
            continue;
        }
        let document: toml::Table = std::fs::read_to_string(&path).unwrap().parse().unwrap();
        let is_link = document["surface"].get("urdf").is_some();
        for key in keys().filter(|key| key.choice.is_empty() || (is_link && key.choice == "urdf")) {
            compare(&document, key, &folder);
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let required: BTreeSet<_> = keys()
        .filter(|key| key.need == Need::Required)
        .map(|key| (key.section, key.choice, key.name))
        .filter(|(section, _, name)| (*section, *name) != ("filter", "kind") && *section != "contact.skin")
        .collect();
    let never: Vec<_> = required.difference(&compared).collect();
    assert!(never.is_empty(), "required keys that no scene here has: {never:?}");
}
