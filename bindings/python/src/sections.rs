//! Sections of a scene that are given one by one.

use std::path::Path;

use fingertip_scene::{Scene, SceneError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use pythonize::depythonize;

use crate::errors;

/// The scene of a text.
pub(crate) fn scene(text: &str) -> PyResult<Scene> {
    Scene::parse(text, "scene", Path::new(""))
        .map_err(|fault| errors::scene(SceneError::Fault { path: "of a text".into(), fault }))
}

/// Sections as the text of a file.
pub(crate) fn document(sections: &Bound<'_, PyDict>) -> PyResult<String> {
    let mut table: toml::Table =
        depythonize(sections).map_err(|error| errors::scene(format!("the sections are no TOML: {error}")))?;
    table.entry("version").or_insert_with(|| i64::from(fingertip_scene::VERSION).into());
    let input = table.entry("input").or_insert_with(|| toml::Table::new().into());
    if let Some(input) = input.as_table_mut() {
        input.entry("convention").or_insert_with(|| "on_fingertip".into());
    }
    toml::to_string(&table).map_err(errors::scene)
}
