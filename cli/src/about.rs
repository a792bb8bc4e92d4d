//! What bridges, and recordings that show the fingertip, are told once of a stream.

use fingertip_bridges::About;
#[cfg(feature = "ros2")]
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
#[cfg(feature = "ros2")]
const MOST_ENTRIES: usize = 1000;

/// What a scene says, with its defaults, by the names of its sections and keys; a mesh that cannot be read any more
/// leaves none.
#[cfg(feature = "ros2")]
fn parameters(scene: &Scene) -> Vec<Parameter> {
    let mut all = Vec::new();
    let text = scene.to_json().unwrap_or_default();
    if let Ok(values) = serde_json::from_str(&text) {
        gather(String::new(), &values, &mut all);
    }
    all
}

/// Takes a table apart into its values, and a list that holds tables into its entries by their number.
#[cfg(feature = "ros2")]
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

#[cfg(all(test, feature = "ros2"))]
mod tests {
    use fingertip_bridges::Value;
    use fingertip_scene::Scene;

    use super::parameters;

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
}
