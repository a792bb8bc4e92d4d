//! What a scene says, as parameters that other tools ask for.

/// A value.
///
/// ```
/// use fingertip_bridges::Value;
///
/// let centre = Value::Numbers(vec![0.0, 0.0, 0.02]);
/// assert!(matches!(centre, Value::Numbers(numbers) if numbers.len() == 3));
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Value {
    /// Yes or no.
    Flag(bool),
    /// A whole number.
    Count(i64),
    /// A number, in the unit that the name says.
    Number(f64),
    /// A text.
    Text(String),
    /// Numbers, in the unit that the name says.
    Numbers(Vec<f64>),
    /// Texts.
    Texts(Vec<String>),
}

/// A value by its name, sections and keys between dots.
///
/// ```
/// use fingertip_bridges::{About, Parameter, Value};
///
/// let radius = Parameter { name: "surface.radius_m".to_owned(), value: Value::Number(0.013) };
/// let about = About { parameters: vec![radius], ..About::default() };
/// # assert_eq!(about.parameters.len(), 1);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Such as `surface.radius_m`.
    pub name: String,
    /// Its value.
    pub value: Value,
}
