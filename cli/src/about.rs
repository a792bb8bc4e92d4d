//! What bridges, and recordings that show the fingertip, are told once of a stream.

use fingertip_bridges::About;
#[cfg(any(feature = "ros2", test))]
use fingertip_bridges::{Parameter, Value};
use fingertip_scene::{Limit, Scene};
use nalgebra::Vector3;

use crate::recording_file::FRAME;

/// Of a stream of this name, and what its scene says.
pub(crate) fn about(source: &str, scene: Option<&Scene>) -> About {
    About {
        source: source.to_owned(),
        frame: FRAME.to_owned(),
        has_scene: scene.is_some(),
        watches_slip: scene.is_some_and(Scene::watches_for_slip),
        coefficient: scene.and_then(Scene::limit).map(Limit::coefficient),
        #[cfg(any(feature = "foxglove", feature = "ros2"))]
        surface: scene.map(crate::report::net).unwrap_or_default(),
        centre: scene.map_or_else(Vector3::zeros, |scene| scene.projection().centre()),
        axes: scene.map_or_else(
            || [Vector3::x(), Vector3::y(), Vector3::z()],
            |scene| scene.projection().directions(),
        ),
        #[cfg(not(any(feature = "foxglove", feature = "ros2")))]
        surface: fingertip_bridges::Net::default(),
        #[cfg(feature = "ros2")]
        parameters: scene.map(parameters).unwrap_or_default(),
        #[cfg(not(feature = "ros2"))]
        parameters: Vec::new(),
    }
}

/// Lists of more entries, meshes among them, are no parameters.
#[cfg(any(feature = "ros2", test))]
const MOST_ENTRIES: usize = 1000;

/// What a scene says, with its defaults, by the names of its sections and keys; a mesh that cannot be read any more
/// leaves none.
#[cfg(any(feature = "ros2", test))]
fn parameters(scene: &Scene) -> Vec<Parameter> {
    let mut all = Vec::new();
    let text = scene.to_json().unwrap_or_default();
    if let Ok(values) = serde_json::from_str(&text) {
        gather(String::new(), &values, &mut all);
    }
    all
}

/// Takes a table apart into its values, and a list that holds tables into its entries by their number.
#[cfg(any(feature = "ros2", test))]
fn gather(name: String, value: &serde_json::Value, all: &mut Vec<Parameter>) {
    use serde_json::Value as Json;

    let below = |key: &str| if name.is_empty() { key.to_owned() } else { format!("{name}.{key}") };
    let value = match value {
        Json::Null => return,
        Json::Object(entries) => {
            entries.iter().for_each(|(key, value)| gather(below(key), value, all));
            return;
        }
        Json::Array(list) if list.len() <= MOST_ENTRIES => {
            let numbers: Option<Vec<f64>> = list.iter().map(Json::as_f64).collect();
            let texts: Option<Vec<String>> =
                list.iter().map(|entry| entry.as_str().map(str::to_owned)).collect();
            match numbers.map(Value::Numbers).or(texts.map(Value::Texts)) {
                Some(value) => value,
                None => {
                    let entries = list.iter().enumerate();
                    entries.for_each(|(place, value)| gather(below(&place.to_string()), value, all));
                    return;
                }
            }
        }
        Json::Array(_) => return,
        Json::Bool(flag) => Value::Flag(*flag),
        Json::String(text) => Value::Text(text.clone()),
        Json::Number(number) => match number.as_i64() {
            Some(count) => Value::Count(count),
            None => Value::Number(number.as_f64().unwrap_or(f64::NAN)),
        },
    };
    all.push(Parameter { name, value });
}

#[cfg(test)]
mod tests {
    use fingertip_bridges::Value;
    use fingertip_scene::Scene;

    use super::{MOST_ENTRIES, gather, parameters};

    #[test]
    fn a_scene_is_parameters_with_its_defaults() {
        let scene = "version = 2\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"sphere\"\n\
                     radius_m = 0.013\n[pose]\ntranslation_m = [0.0, 0.0, 0.01]\n[friction]\n\
                     static_coefficient = 0.5\n";
        let all = parameters(&Scene::from_text(scene).unwrap());
        let of = |name: &str| all.iter().find(|one| one.name == name).map(|one| one.value.clone());
        assert_eq!(of("surface.radius_m"), Some(Value::Number(0.013)));
        assert_eq!(of("surface.shape"), Some(Value::Text("sphere".to_owned())));
        assert_eq!(of("friction.static_coefficient"), Some(Value::Number(0.5)));
        assert_eq!(of("pose.translation_m"), Some(Value::Numbers(vec![0.0, 0.0, 0.01])));
        assert_eq!(of("version"), Some(Value::Count(2)));
        // What the scene leaves to its default.
        assert!(of("contact.model").is_some(), "{all:?}");
    }

    /// Lists of numbers and of words stay lists, tables in a list are counted, and what says nothing is left out.
    #[test]
    fn every_kind_of_value_has_its_name() {
        let text = r#"{"a": {"flag": true, "none": null, "words": ["x", "y"], "mixed": [1, "x"]},
                       "b": [{"c": 1}, {"c": 2.5}], "empty": []}"#;
        let gathered = |value: &serde_json::Value| {
            let mut all = Vec::new();
            gather(String::new(), value, &mut all);
            all.into_iter().map(|one| (one.name, one.value)).collect::<Vec<_>>()
        };
        let expected = [
            ("a.flag", Value::Flag(true)),
            ("a.mixed.0", Value::Count(1)),
            ("a.mixed.1", Value::Text("x".to_owned())),
            ("a.words", Value::Texts(vec!["x".to_owned(), "y".to_owned()])),
            ("b.0.c", Value::Count(1)),
            ("b.1.c", Value::Number(2.5)),
            ("empty", Value::Numbers(Vec::new())),
        ];
        let mut found = gathered(&serde_json::from_str(text).unwrap());
        found.sort_by(|(a, _), (b, _)| a.cmp(b));
        assert_eq!(found, expected.map(|(name, value)| (name.to_owned(), value)));
        // A list is one up to its limit.
        let list = |entries: usize| gathered(&serde_json::json!({ "list": vec![0.5; entries] })).len();
        assert_eq!((list(MOST_ENTRIES), list(MOST_ENTRIES + 1)), (1, 0));
    }
}
