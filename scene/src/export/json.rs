//! A resolved scene as JSON.

use serde_json::Value as Json;
use toml::Value;

/// The text, an object's entries and a list's lists on lines of their own.
pub(super) fn text(scene: Value) -> String {
    let mut text = String::new();
    write(&of(scene), 0, &mut text);
    text.push('\n');
    text
}

/// JSON has no infinity: it is a text.
fn of(value: Value) -> Json {
    match value {
        Value::String(text) => Json::String(text),
        Value::Integer(whole) => Json::from(whole),
        Value::Float(number) if number.is_finite() => Json::from(number),
        Value::Float(number) => Json::String(if number < 0.0 { "-inf" } else { "inf" }.to_owned()),
        Value::Boolean(is) => Json::Bool(is),
        Value::Datetime(time) => Json::String(time.to_string()),
        Value::Array(list) => list.into_iter().map(of).collect(),
        Value::Table(table) => table.into_iter().map(|(key, value)| (key, of(value))).collect(),
    }
}

fn write(value: &Json, depth: usize, text: &mut String) {
    let nested = |list: &[Json]| list.iter().any(|entry| entry.is_array() || entry.is_object());
    let line = |text: &mut String, before: &str, depth: usize| {
        text.push_str(before);
        text.push('\n');
        text.push_str(&"  ".repeat(depth));
    };
    match value {
        Json::Object(entries) if !entries.is_empty() => {
            for (index, (key, value)) in entries.iter().enumerate() {
                line(text, if index == 0 { "{" } else { "," }, depth + 1);
                text.push_str(&Json::from(key.as_str()).to_string());
                text.push_str(": ");
                write(value, depth + 1, text);
            }
            line(text, "", depth);
            text.push('}');
        }
        Json::Array(list) if nested(list) => {
            for (index, value) in list.iter().enumerate() {
                line(text, if index == 0 { "[" } else { "," }, depth + 1);
                write(value, depth + 1, text);
            }
            line(text, "", depth);
            text.push(']');
        }
        Json::Array(list) => {
            let list: Vec<String> = list.iter().map(Json::to_string).collect();
            text.push_str(&format!("[{}]", list.join(", ")));
        }
        other => text.push_str(&other.to_string()),
    }
}
