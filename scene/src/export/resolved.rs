//! A scene with all that it leaves out, and without the files that it names.

use fingertip::surfaces::{DynSurface, Mesh};
use fingertip::wrench::Real;
use serde::Serialize;
use serde::de::DeserializeOwned;
use toml::{Table, Value};

use super::ExportError;
use crate::carried::PayloadSection;
use crate::estimate::EstimateSection;
use crate::fault::{SceneProblem, VERSION};
use crate::filter::FilterSection;
use crate::formula::FormulaSection;
use crate::friction::FrictionSection;
use crate::fusion::FusionSection;
use crate::grip::GripSection;
use crate::input::InputSection;
use crate::model::{ContactSection, USUAL_DEVIATIONS};
use crate::scene::Scene;
use crate::sensor::SensorSection;
use crate::slip::SlipSection;
use crate::surface::{MapSection, PoseSection, ShapeSource};
use crate::tracking::TrackingSection;
use crate::uncertainty::UncertaintySection;

/// The scene in version 2 of the format. Numbers are those of the file, to the bit; those of a mesh in a file are rounded
/// to the precision in which it is read. A section that is not known here stands as it does in the file.
pub(super) fn resolve<T: Real>(scene: &Scene) -> Result<Table, ExportError> {
    let mut document = scene.document.clone();
    document.insert("version".to_owned(), Value::Integer(VERSION.into()));
    document.insert("name".to_owned(), Value::String(scene.name().to_owned()));
    document.insert("surface".to_owned(), Value::Table(surface::<T>(&scene.shape)?));
    for always in ["pose", "contact"] {
        document.entry(always).or_insert_with(|| Value::Table(Table::new()));
    }
    for (name, section) in &mut document {
        *section = match name.as_str() {
            "input" => filled::<InputSection>(section)?,
            "sensor" => filled::<SensorSection>(section)?,
            "payload" => filled::<PayloadSection>(section)?,
            "filter" => filled::<FilterSection>(section)?,
            "pose" => filled::<PoseSection>(section)?,
            "map" => filled::<MapSection>(section)?,
            "contact" => contact(section)?,
            "tracking" => filled::<TrackingSection>(section)?,
            "uncertainty" => filled::<UncertaintySection>(section)?,
            "fusion" => filled::<FusionSection>(section)?,
            "friction" => filled::<FrictionSection>(section)?,
            "slip" => filled::<SlipSection>(section)?,
            "estimate" => filled::<EstimateSection>(section)?,
            "grip" => filled::<GripSection>(section)?,
            _ => continue,
        };
    }
    Ok(document)
}

/// A section that was read before.
pub(super) fn read<S: DeserializeOwned>(section: &Value) -> Result<S, ExportError> {
    let unread = |error: toml::de::Error| SceneProblem::Key {
        key: String::new(),
        message: error.message().replace('\n', " "),
    };
    Ok(section.clone().try_into().map_err(unread)?)
}

fn written(section: &impl Serialize) -> Result<Value, ExportError> {
    Value::try_from(section).map_err(|error| ExportError::Missing { key: error.to_string() })
}

/// A section with its defaults.
fn filled<S: Serialize + DeserializeOwned>(section: &Value) -> Result<Value, ExportError> {
    written(&read::<S>(section)?)
}

fn contact(section: &Value) -> Result<Value, ExportError> {
    let mut filled = filled::<ContactSection>(section)?;
    if let Value::Table(keys) = &mut filled
        && keys.contains_key("greatest_pitch_m")
    {
        keys.entry("pitch_deviations").or_insert(Value::Float(USUAL_DEVIATIONS));
    }
    Ok(filled)
}

fn surface<T: Real>(source: &ShapeSource) -> Result<Table, ExportError> {
    let written = match source {
        ShapeSource::Here(Value::Table(table)) => return shape(table),
        ShapeSource::Here(_) => return Err(ExportError::Missing { key: "surface".to_owned() }),
        ShapeSource::Formula(section) => filled::<FormulaSection>(&written(section)?)?,
        ShapeSource::MeshFile { path, metres_per_unit } => {
            let (vertices, triangles) = Mesh::<T>::parts_from_file(path, T::literal(*metres_per_unit))
                .map_err(|source| SceneProblem::Mesh { path: path.clone(), source })?;
            let vertices: Vec<[f64; 3]> =
                vertices.iter().map(|v| [v.x, v.y, v.z].map(Real::to_f64)).collect();
            let (vertices, triangles) = once(&vertices, &triangles);
            let mut table = Table::new();
            table.insert("shape".to_owned(), Value::String("mesh".to_owned()));
            table.insert("vertices_m".to_owned(), written(&vertices)?);
            table.insert("triangles".to_owned(), written(&triangles)?);
            Value::Table(table)
        }
    };
    match written {
        Value::Table(table) => Ok(table),
        _ => Err(ExportError::Missing { key: "surface".to_owned() }),
    }
}

/// Vertices without repetition: a mesh merges those at the same place anyway.
fn once(vertices: &[[f64; 3]], triangles: &[[u32; 3]]) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let mut known = alloc::collections::BTreeMap::new();
    let mut kept = Vec::new();
    let renamed: Vec<u32> = vertices
        .iter()
        .map(|vertex| {
            *known.entry(vertex.map(f64::to_bits)).or_insert_with(|| {
                kept.push(*vertex);
                // As many as there were indices for, at most.
                u32::try_from(kept.len() - 1).unwrap_or(u32::MAX)
            })
        })
        .collect();
    let name = |index: u32| renamed.get(index as usize).copied().unwrap_or(u32::MAX);
    (kept, triangles.iter().map(|triangle| triangle.map(name)).collect())
}

/// A shape with its defaults. What is written of a shape is what was made of its numbers, as a direction of length 1; so
/// the numbers of the file stand over it.
fn shape(table: &Table) -> Result<Table, ExportError> {
    let built: DynSurface<f64> = read(&Value::Table(table.clone()))?;
    let Value::Table(mut filled) = written(&built)? else {
        return Err(ExportError::Missing { key: "surface".to_owned() });
    };
    for (key, value) in table {
        match (key.as_str(), value) {
            ("shape", _) => {}
            ("surface", Value::Table(inner)) => {
                filled.insert(key.clone(), Value::Table(shape(inner)?));
            }
            ("parts", Value::Array(parts)) => {
                let inner = |part: &Value| match part {
                    Value::Table(part) => shape(part).map(Value::Table),
                    _ => Err(ExportError::Missing { key: "parts".to_owned() }),
                };
                let parts = parts.iter().map(inner).collect::<Result<Vec<Value>, _>>()?;
                filled.insert(key.clone(), Value::Array(parts));
            }
            _ => {
                filled.insert(key.clone(), value.clone());
            }
        }
    }
    Ok(filled)
}
