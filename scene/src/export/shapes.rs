//! Shapes as types.

use fingertip::surfaces::DynSurface;
use fingertip::wrench::{Real, RigidTransform};
use nalgebra::Vector3;
use serde::de::DeserializeOwned;
use toml::{Table, Value};

use super::ExportError;
use super::template::{Row, Typed, Writer, row};
use crate::surface::{Placing, PoseSection, ShapeSource, placing};

/// Shapes by their names in a file; what holds others is [`Writer::shape`]'s.
const SHAPES: &[Row] = &[
    row("plane", "surfaces::Plane<{T}>", "surfaces::Plane::new({point_m:v}, {normal:v})?"),
    row("disk", "surfaces::Disk<{T}>", "surfaces::Disk::new({centre_m:v}, {normal:v}, {radius_m})?"),
    row(
        "rectangle",
        "surfaces::Rectangle<{T}>",
        "surfaces::Rectangle::new({centre_m:v}, {first_half_edge_m:v}, {second_half_edge_m:v})?",
    ),
    row("whole sphere", "surfaces::Sphere<{T}>", "surfaces::Sphere::new({centre_m:v}, {radius_m})?"),
    row(
        "sphere",
        "surfaces::SphericalCap<{T}>",
        "surfaces::SphericalCap::new(surfaces::Sphere::new({centre_m:v}, {radius_m})?, {pole:v}, {least_cosine})?",
    ),
    row("ellipsoid", "surfaces::Ellipsoid<{T}>", "surfaces::Ellipsoid::new({semi_axes_m:v})?"),
    row(
        "cylinder",
        "surfaces::Cylinder<{T}>",
        "surfaces::Cylinder::new({centre_m:v}, {axis:v}, {radius_m})?{?.with_half_length({half_length_m})??}",
    ),
    row(
        "capped_cylinder",
        "surfaces::CappedCylinder<{T}>",
        "surfaces::CappedCylinder::new({centre_m:v}, {axis:v}, {radius_m}, {half_length_m})?",
    ),
    row(
        "elliptic_cylinder",
        "surfaces::EllipticCylinder<{T}>",
        "surfaces::EllipticCylinder::new({semi_axes_m:a}, surfaces::CylinderEnds::{?{ends_m:w}?}\
         {?Open({ends_m.open})?}{?Capped({ends_m.capped})?})?",
    ),
    row(
        "capsule",
        "surfaces::Capsule<{T}>",
        "surfaces::Capsule::new({centre_m:v}, {axis:v}, {radius_m}, {half_length_m})?",
    ),
    row(
        "cone",
        "surfaces::Cone<{T}>",
        "surfaces::Cone::new({apex_m:v}, {axis:v}, {half_angle})?{?.with_depth({depth_m})??}",
    ),
    row(
        "frustum",
        "surfaces::Frustum<{T}>",
        "surfaces::Frustum::new({base_centre_m:v}, {axis:v}, {base_radius_m}, {top_radius_m}, {height_m})?",
    ),
    row("torus", "surfaces::Torus<{T}>", "surfaces::Torus::new({ring_radius_m}, {tube_radius_m})?"),
    row(
        "superquadric",
        "surfaces::Superquadric<{T}>",
        "surfaces::Superquadric::new({semi_axes_m:v}, {exponents:a})?",
    ),
    row(
        "rounded_box",
        "surfaces::RoundedBox<{T}>",
        "surfaces::RoundedBox::new({half_extents_m:v}, {rounding_m})?",
    ),
    row(
        "paraboloid",
        "surfaces::Paraboloid<{T}>",
        "surfaces::Paraboloid::new({radii_m:a})?{?.with_depth({depth_m})??}",
    ),
    row(
        "revolution",
        "surfaces::Revolution<{T}, [surfaces::Knot<{T}>; {profile_m:n}]>",
        "surfaces::Revolution::from_profile({profile_m:a})?",
    ),
    row(
        "heightfield",
        "surfaces::Heightfield<{T}>",
        "surfaces::Heightfield::new({corner_m:a}, {spacing_m:a}, {columns:i}, {heights_m:s}.to_vec())?",
    ),
    row("mesh", "surfaces::Mesh<{T}>", "surfaces::Mesh::new(&{vertices_m:p}, &{triangles:s})?"),
];

/// What an export needs a heap for.
pub(super) const ON_THE_HEAP: [&str; 2] = ["surfaces::Heightfield", "surfaces::Mesh"];

fn key<'a>(table: &'a Table, key: &str) -> Result<&'a Value, ExportError> {
    table.get(key).ok_or_else(|| ExportError::Missing { key: key.to_owned() })
}

fn inner(table: &Table) -> Result<&Table, ExportError> {
    key(table, "surface")?.as_table().ok_or_else(|| ExportError::Missing { key: "surface".to_owned() })
}

fn listed<T: Real>(vector: &Vector3<T>) -> Value {
    Value::Array(vector.iter().map(|x| Value::Float(x.to_f64())).collect())
}

impl<T: Real + DeserializeOwned> Writer<T> {
    /// The surface of a resolved scene, in the sensor frame.
    pub(super) fn placed(&mut self, surface: &Table, pose: &PoseSection) -> Result<Typed, ExportError> {
        if key(surface, "shape")?.as_str() == Some("formula") {
            let shape = self.formula(surface)?;
            let transform = pose.sensor_from_surface::<T>()?;
            let moved = *pose != PoseSection::default();
            return Ok(if moved { Self::posed(&shape, &transform) } else { shape });
        }
        let mut surface = surface.clone();
        let shape: DynSurface<T> = built(&surface)?;
        let moved = match placing(&shape, pose)? {
            Placing::Here => vec![],
            Placing::There { origin, direction } => vec![origin, direction],
            Placing::Posed(pose) => {
                let shape = self.shape(&surface)?;
                return Ok(Self::posed(&shape, &pose));
            }
        };
        surface.extend(moved.iter().map(|(key, vector)| ((*key).to_owned(), listed(vector))));
        self.shape(&surface)
    }

    /// A shape in its own frame.
    fn shape(&mut self, surface: &Table) -> Result<Typed, ExportError> {
        let mut name = key(surface, "shape")?.as_str().unwrap_or_default();
        let mut keys = surface.clone();
        let mut derive = |key: &str, number: T| keys.insert(key.to_owned(), Value::Float(number.to_f64()));
        match name {
            "compound" => {
                let parts = key(surface, "parts")?.as_array().map(Vec::as_slice).unwrap_or_default();
                return self.union(parts);
            }
            "trimmed" => {
                let Typed { of, make } = self.shape(inner(surface)?)?;
                let region =
                    self.fill("surfaces::HalfSpace::new({region.point_m:v}, {region.inward:v})?", surface)?;
                return Ok(Typed {
                    of: format!("surfaces::Trimmed<{of}, surfaces::HalfSpace<{}>>", Self::scalar()),
                    make: format!("surfaces::Trimmed::new({make}, {region})"),
                });
            }
            "posed" => {
                let shape = self.shape(inner(surface)?)?;
                let DynSurface::Posed(posed) = built::<T>(surface)? else {
                    return Err(ExportError::Missing { key: "surface".to_owned() });
                };
                return Ok(Self::posed(&shape, posed.sensor_from_shape()));
            }
            // Angles as what is made of them, so that no other machine's sine makes another shape.
            "sphere" => {
                if let DynSurface::Sphere(cap) = built::<T>(surface)? {
                    derive("least_cosine", cap.least_cosine());
                    name = if cap.least_cosine() > -T::one() { name } else { "whole sphere" };
                }
            }
            "cone" => {
                if let DynSurface::Cone(cone) = built::<T>(surface)? {
                    derive("half_angle", cone.half_angle());
                }
            }
            _ => {}
        }
        self.choice(SHAPES, "surface", name, &keys)
    }

    /// As [`DynSurface::union`] puts them together.
    fn union(&mut self, parts: &[Value]) -> Result<Typed, ExportError> {
        let part = |part: &Value| part.as_table().cloned();
        if let [only] = parts {
            let missing = || ExportError::Missing { key: "parts".to_owned() };
            return self.shape(&part(only).ok_or_else(missing)?);
        }
        if parts.is_empty() {
            return Err(ExportError::Missing { key: "parts".to_owned() });
        }
        let (first, second) = parts.split_at(parts.len() / 2);
        let (first, second) = (self.union(first)?, self.union(second)?);
        Ok(Typed {
            of: format!("surfaces::Compound<{}, {}>", first.of, second.of),
            make: format!("surfaces::Compound::new({}, {})", first.make, second.make),
        })
    }

    fn posed(shape: &Typed, pose: &RigidTransform<T>) -> Typed {
        let numbers = |numbers: &mut dyn Iterator<Item = T>| {
            let numbers: Vec<String> = numbers.map(|number| Self::literal(number.to_f64())).collect();
            numbers.join(", ")
        };
        let rotation = numbers(&mut pose.rotation().transpose().iter().copied());
        let origin = numbers(&mut pose.origin().iter().copied());
        Typed {
            of: format!("surfaces::Posed<{}, {}>", Self::scalar(), shape.of),
            make: format!(
                "surfaces::Posed::new({}, wrench::RigidTransform::from_matrix(nalgebra::Matrix3::new({rotation}), \
                 nalgebra::Vector3::new({origin}))?)",
                shape.make
            ),
        }
    }
}

/// A shape in a precision.
fn built<T: Real + DeserializeOwned>(surface: &Table) -> Result<DynSurface<T>, ExportError> {
    Ok(ShapeSource::Here(Value::Table(surface.clone())).shape()?)
}
