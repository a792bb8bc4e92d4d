//! Rust from a template and the keys of a section.
//!
//! A template is Rust with places for keys: `{radius_m}` is the number under that key, `{axis:v}` the vector, and so on
//! ([`Writer::place`]); `{T}` is the scalar. A key of a table in a table is `{region.inward:v}`. What stands between `{?`
//! and `?}` is left out where one of its keys is.

use core::marker::PhantomData;

use fingertip::wrench::Real;
use toml::{Table, Value};

use super::ExportError;

/// The type of something, and what makes it.
#[derive(Clone, Debug)]
pub(super) struct Typed {
    pub(super) of: String,
    pub(super) make: String,
}

/// One choice: its name in a file, its type, and its constructor.
pub(super) struct Row {
    pub(super) name: &'static str,
    of: &'static str,
    make: &'static str,
}

/// A row of a table of choices.
pub(super) const fn row(name: &'static str, of: &'static str, make: &'static str) -> Row {
    Row { name, of, make }
}

/// Writes Rust in a precision.
pub(super) struct Writer<T> {
    /// Long lists, which stand beside the constructor.
    pub(super) statics: Vec<String>,
    scalar: PhantomData<T>,
}

impl<T: Real> Writer<T> {
    pub(super) const fn new() -> Self {
        Self { statics: Vec::new(), scalar: PhantomData }
    }

    /// `f64` or `f32`.
    pub(super) fn scalar() -> &'static str {
        core::any::type_name::<T>()
    }

    /// The choice of this name among rows, with the keys of its section.
    pub(super) fn choice(
        &mut self,
        rows: &[Row],
        section: &str,
        name: &str,
        keys: &Table,
    ) -> Result<Typed, ExportError> {
        let row = rows
            .iter()
            .find(|row| row.name == name)
            .ok_or_else(|| ExportError::NoType { what: format!("\"{name}\" of [{section}]") })?;
        Ok(Typed { of: self.fill(row.of, keys)?, make: self.fill(row.make, keys)? })
    }

    /// A template, filled in.
    pub(super) fn fill(&mut self, template: &str, keys: &Table) -> Result<String, ExportError> {
        let mut text = String::new();
        let mut rest = template;
        while let Some((before, after)) = rest.split_once('{') {
            text.push_str(before);
            if let Some((optional, after)) =
                after.strip_prefix('?').and_then(|optional| optional.split_once("?}"))
            {
                match self.fill(optional, keys) {
                    Ok(filled) => text.push_str(&filled),
                    Err(ExportError::Missing { .. }) => {}
                    Err(other) => return Err(other),
                }
                rest = after;
            } else if let Some((place, after)) = after.split_once('}') {
                text.push_str(&self.place(place, keys)?);
                rest = after;
            } else {
                rest = after;
            }
        }
        text.push_str(rest);
        Ok(text)
    }

    /// What stands for a key, by the letter behind it: none for a number, `d` one in double precision, `i` a whole one,
    /// `v` a vector, `a` an array, `n` the length of one, `s` and `p` the name of a static list of numbers or of points,
    /// `w` a word as a variant; `y` and `x` stand for nothing, where the key is true or not.
    fn place(&mut self, place: &str, keys: &Table) -> Result<String, ExportError> {
        if place == "T" {
            return Ok(Self::scalar().to_owned());
        }
        let (path, kind) = place.split_once(':').unwrap_or((place, ""));
        let missing = || ExportError::Missing { key: path.to_owned() };
        let mut parts = path.split('.');
        let first = parts.next().and_then(|key| keys.get(key)).ok_or_else(missing)?;
        let value = parts.try_fold(first, |value, key| value.get(key)).ok_or_else(missing)?;
        let list = || value.as_array().ok_or_else(missing);
        let text = match kind {
            "d" => number(value).map(|number| format!("{number:?}")),
            "i" => value.as_integer().map(|whole| whole.to_string()),
            "v" => Self::vector(value),
            "a" => Self::array(value),
            "n" => Some(list()?.len().to_string()),
            "s" => Some(self.list(path, list()?, &Self::kind_of(value), Self::array)?),
            "p" => {
                let kind = format!("nalgebra::Vector3<{}>", Self::scalar());
                Some(self.list(path, list()?, &kind, Self::vector)?)
            }
            "w" => value.as_str().map(variant),
            "y" | "x" => value.as_bool().filter(|is| *is == (kind == "y")).map(|_| String::new()),
            _ => number(value).map(Self::literal),
        };
        text.ok_or_else(missing)
    }

    /// A number that reads back as it is, to the bit.
    pub(super) fn literal(number: f64) -> String {
        let value = T::literal(number);
        if value.is_number() {
            format!("{value:?}")
        } else {
            let sign = if number < 0.0 { "NEG_" } else { "" };
            format!("{}::{sign}INFINITY", Self::scalar())
        }
    }

    fn vector(value: &Value) -> Option<String> {
        let numbers = value.as_array()?.iter().map(number).collect::<Option<Vec<f64>>>()?;
        let bits: Vec<u64> = numbers.iter().map(|number| number.to_bits()).collect();
        let named =
            [("zeros", [0.0; 3]), ("x", [1.0, 0.0, 0.0]), ("y", [0.0, 1.0, 0.0]), ("z", [0.0, 0.0, 1.0])];
        let name = named.iter().find(|(_, known)| known.map(f64::to_bits).as_slice() == bits);
        Some(match name {
            Some((name, _)) => format!("nalgebra::Vector3::{name}()"),
            None => {
                let numbers: Vec<String> = numbers.into_iter().map(Self::literal).collect();
                format!("nalgebra::Vector3::new({})", numbers.join(", "))
            }
        })
    }

    fn array(value: &Value) -> Option<String> {
        match value {
            Value::Array(list) => {
                let list = list.iter().map(Self::array).collect::<Option<Vec<String>>>()?;
                Some(format!("[{}]", list.join(", ")))
            }
            // Indices.
            Value::Integer(whole) => Some(whole.to_string()),
            other => number(other).map(Self::literal),
        }
    }

    /// Of the entries of a list: indices in threes, or numbers.
    fn kind_of(list: &Value) -> String {
        match list.get(0) {
            Some(Value::Array(_)) => "[u32; 3]".to_owned(),
            _ => Self::scalar().to_owned(),
        }
    }

    /// Puts a list beside the constructor; its name.
    fn list(
        &mut self,
        path: &str,
        list: &[Value],
        kind: &str,
        entry: impl Fn(&Value) -> Option<String>,
    ) -> Result<String, ExportError> {
        let missing = || ExportError::Missing { key: path.to_owned() };
        let entries = list.iter().map(entry).collect::<Option<Vec<String>>>().ok_or_else(missing)?;
        let name = format!("{}_{}", path.to_uppercase(), self.statics.len());
        let text: String = entries.iter().map(|entry| format!("    {entry},\n")).collect();
        self.statics.push(format!("static {name}: [{kind}; {}] = [\n{text}];\n", entries.len()));
        Ok(name)
    }
}

/// A number of a file, which may be written without a point.
pub(super) fn number(value: &Value) -> Option<f64> {
    #[allow(clippy::cast_precision_loss, reason = "as the reader of scenes takes it")]
    value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64))
}

/// A word as the name of a variant.
fn variant(word: &str) -> String {
    let mut letters = word.chars();
    letters
        .next()
        .map_or_else(String::new, |first| first.to_uppercase().collect::<String>() + letters.as_str())
}
