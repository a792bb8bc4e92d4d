//! What a scene says, in a line for each of its sections.

use toml::{Table, Value};

use crate::registry;

/// Longer values are cut.
const LONGEST: usize = 60;

/// A line for each section: what was chosen, what that is, and the other keys; `delay` is that of the filter \[s\],
/// `of_motion` that behind the inertial unit.
pub(crate) fn of(scene: &Table, delay: f64, of_motion: f64) -> Vec<String> {
    let order = [
        "input",
        "sensor",
        "payload",
        "inertial_unit",
        "filter",
        "surface",
        "pose",
        "contact",
        "uncertainty",
        "tracking",
        "fusion",
        "friction",
        "slip",
        "estimate",
        "grip",
    ];
    let mut lines = Vec::new();
    for section in order {
        let Some(Value::Table(table)) = scene.get(section) else { continue };
        let mut said = line(section, table);
        if section == "filter" {
            said += &format!("; what changes slowly comes {:.1} ms late", delay * 1e3);
        }
        if section == "inertial_unit" {
            said += &format!("; what changes slowly comes {:.1} ms late", of_motion * 1e3);
        }
        lines.push(said);
        if let Some(Value::Table(skin)) = table.get("skin") {
            lines.push(line("contact.skin", skin));
        }
    }
    lines
}

fn line(section: &str, table: &Table) -> String {
    let usual = ("friction", "limit", "coulomb");
    let chosen = registry::entries().find(|entry| {
        let name = table.get(entry.key).and_then(Value::as_str);
        entry.section == section
            && (name == Some(entry.name) || name.is_none() && usual == (section, entry.key, entry.name))
    });
    let others: Vec<String> = table
        .iter()
        .filter(|(key, value)| {
            chosen.is_none_or(|entry| *key != entry.key) && !(*key == "skin" && value.is_table())
        })
        .map(|(key, value)| format!("{key} = {}", short(value)))
        .collect();
    let said = chosen.map(|entry| format!("{}, {}", entry.name, entry.says));
    let parts: Vec<String> =
        said.into_iter().chain((!others.is_empty()).then(|| others.join(", "))).collect();
    format!("{section:<13}{}", parts.join("; "))
}

fn short(value: &Value) -> String {
    let whole = value.to_string();
    if whole.chars().count() <= LONGEST {
        return whole;
    }
    let start: String = whole.chars().take(LONGEST).collect();
    format!("{start} …")
}
