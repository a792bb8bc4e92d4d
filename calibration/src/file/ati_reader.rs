//! Reads ATI's calibration files.

use roxmltree::{Document, Node};

use super::ati::{FINITE_IN_SI, length};
use super::{AtiAxis, AtiCalibration, AtiError};
use crate::Axis;

/// The most elements of a file: one of six axes has some twenty.
const MOST: usize = 1000;

/// Whether an element begins at this `<`.
fn is_element(xml: &str, at: usize) -> bool {
    let next = xml.as_bytes().get(at + 1);
    !next.is_some_and(|byte| matches!(byte, b'/' | b'!' | b'?'))
}

impl AtiCalibration {
    /// Reads the text of a `.cal` file.
    ///
    /// # Errors
    /// [`AtiError`], naming element and attribute.
    pub fn from_xml(xml: &str) -> Result<Self, AtiError> {
        // The parser calls itself for each level, and a stack ends.
        let elements = xml.match_indices('<').filter(|(at, _)| is_element(xml, *at)).take(MOST + 1).count();
        if elements > MOST {
            return Err(AtiError::TooMany { most: MOST });
        }
        // Some tools write a byte order mark, which roxmltree does not expect.
        let document = Document::parse(xml.trim_start_matches('\u{feff}'))?;
        let sensor = document.root_element();
        if !sensor.has_tag_name("FTSensor") {
            return Err(AtiError::MissingElement { element: "FTSensor".to_owned() });
        }
        let calibration = child(sensor, "Calibration")?;
        let gauges = match sensor.attribute("NumGages") {
            Some(text) => text
                .trim()
                .parse::<usize>()
                .map_err(|_| bad(sensor, "NumGages", text, "must be a whole number"))?,
            None => 6,
        };
        let transform = calibration.children().find(|node| node.has_tag_name("BasicTransform"));
        let shift = |name: &str| match transform {
            Some(node) if node.has_attribute(name) => number(node, name),
            _ => Ok(0.0),
        };
        let known = ["PartNumber", "CalDate", "ForceUnits", "TorqueUnits", "DistUnits"];
        let text = |node: Node<'_, '_>, name: &str| node.attribute(name).unwrap_or_default().to_owned();
        let force_unit = unit(calibration, "ForceUnits", |name| Axis::Fx.unit_size(name))?;
        let torque_unit = unit(calibration, "TorqueUnits", |name| Axis::Tx.unit_size(name))?;
        let sizes = Axis::ALL.map(|axis| {
            axis.unit_size(if axis.is_torque() { &torque_unit } else { &force_unit }).unwrap_or(f64::NAN)
        });
        let result = Self {
            serial: text(sensor, "Serial"),
            body_style: text(sensor, "BodyStyle"),
            family: text(sensor, "Family"),
            file_version: text(sensor, "CalFileVersion"),
            part_number: text(calibration, "PartNumber"),
            date: text(calibration, "CalDate"),
            force_unit,
            torque_unit,
            distance_unit: unit(calibration, "DistUnits", length)?,
            other: calibration
                .attributes()
                // Two of different namespaces may have the same name.
                .filter(|attribute| attribute.namespace().is_none() && !known.contains(&attribute.name()))
                .map(|attribute| (attribute.name().to_owned(), attribute.value().to_owned()))
                .collect(),
            axes: rows(calibration, "Axis", gauges, &sizes)?,
            translation: [shift("Dx")?, shift("Dy")?, shift("Dz")?],
            rotation: [shift("Rx")?, shift("Ry")?, shift("Rz")?],
            user_axes: match calibration.children().any(|node| node.has_tag_name("UserAxis")) {
                true => Some(rows(calibration, "UserAxis", gauges, &sizes)?),
                false => None,
            },
        };
        match result.transformed_axes() {
            Ok(_) | Err(AtiError::Turned) => Ok(result),
            Err(error) => Err(error),
        }
    }
}

fn child<'a, 'input>(node: Node<'a, 'input>, name: &str) -> Result<Node<'a, 'input>, AtiError> {
    node.children()
        .find(|child| child.has_tag_name(name))
        .ok_or_else(|| AtiError::MissingElement { element: name.to_owned() })
}

fn bad(node: Node<'_, '_>, attribute: &str, found: &str, requirement: &'static str) -> AtiError {
    AtiError::BadAttribute {
        element: label(node),
        attribute: attribute.to_owned(),
        found: found.to_owned(),
        requirement,
    }
}

/// `Axis Fx`.
fn label(node: Node<'_, '_>) -> String {
    let tag = node.tag_name().name();
    node.attribute("Name").map_or_else(|| tag.to_owned(), |name| format!("{tag} {name}"))
}

fn attribute<'a>(node: Node<'a, '_>, name: &str) -> Result<&'a str, AtiError> {
    node.attribute(name)
        .ok_or_else(|| AtiError::MissingAttribute { element: label(node), attribute: name.to_owned() })
}

fn number(node: Node<'_, '_>, name: &str) -> Result<f64, AtiError> {
    let text = attribute(node, name)?;
    let number: f64 = text.trim().parse().map_err(|_| bad(node, name, text, "must be a number"))?;
    if number.is_finite() { Ok(number) } else { Err(bad(node, name, text, "must be finite")) }
}

fn unit(node: Node<'_, '_>, name: &str, size: impl Fn(&str) -> Option<f64>) -> Result<String, AtiError> {
    let text = attribute(node, name)?.trim();
    match size(text) {
        Some(_) => Ok(text.to_owned()),
        None => Err(bad(node, name, text, "must be a unit that is known")),
    }
}

/// The six rows of elements called `tag`, whose units have these sizes in SI.
fn rows(
    calibration: Node<'_, '_>,
    tag: &str,
    gauges: usize,
    sizes: &[f64; 6],
) -> Result<[AtiAxis; 6], AtiError> {
    let row = |axis: Axis| -> Result<AtiAxis, AtiError> {
        let node = calibration
            .children()
            .find(|node| {
                node.has_tag_name(tag) && node.attribute("Name").and_then(Axis::from_name) == Some(axis)
            })
            .ok_or_else(|| AtiError::MissingElement { element: format!("{tag} {axis}") })?;
        let text = attribute(node, "values")?;
        let values: Vec<f64> = text
            .split_whitespace()
            .map(|word| word.parse::<f64>().ok().filter(|x| x.is_finite()))
            .collect::<Option<_>>()
            .ok_or_else(|| bad(node, "values", text, "must be finite numbers"))?;
        if values.len() != gauges {
            return Err(bad(node, "values", text, "must have one number per gauge"));
        }
        let max = number(node, "max")?;
        let scale = if node.has_attribute("scale") { number(node, "scale")? } else { 1.0 };
        for (name, value) in [("max", max), ("scale", scale)] {
            if !(value > 0.0) {
                return Err(bad(node, name, &value.to_string(), "must be positive"));
            }
        }
        let size = sizes[axis.index()];
        if !(max * size > 0.0 && (max * size).is_finite()) {
            return Err(bad(node, "max", &max.to_string(), "must be positive and finite in N or N·m"));
        }
        if let Some(value) = values.iter().find(|value| !(**value / scale * size).is_finite()) {
            return Err(bad(node, "values", &value.to_string(), FINITE_IN_SI));
        }
        Ok(AtiAxis { values, max, scale })
    };
    let [fx, fy, fz, tx, ty, tz] = Axis::ALL;
    Ok([row(fx)?, row(fy)?, row(fz)?, row(tx)?, row(ty)?, row(tz)?])
}
