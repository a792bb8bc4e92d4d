//! The surface of a scene and its pose.

use std::path::{Path, PathBuf};

use fingertip::surfaces::{Cylinder, DynSurface, Mesh, Plane, Posed, Sphere};
use fingertip::wrench::RigidTransform;
use nalgebra::Vector3;
use serde::Deserialize;

use super::fault::SceneProblem;
use crate::shape::{Capped, Projection, Shape};

type Triple = [f64; 3];

const ORIGIN: Triple = [0.0; 3];
const fn origin() -> Triple {
    ORIGIN
}
const fn along_z() -> Triple {
    [0.0, 0.0, 1.0]
}

/// A surface in coordinates of its own frame, as a scene states it.
pub(super) trait Surface {
    /// The shape in the sensor frame, and its map, whose directions are those of the surface's own
    /// frame. Files are looked for in `folder`.
    fn place(
        &self,
        pose: &PoseSection,
        map: Option<&MapSection>,
        folder: &Path,
    ) -> Result<(Shape, Projection), SceneProblem>;
}

/// The shapes that have types and maps of their own here. All others are [`DynSurface`]s.
#[derive(Clone, Debug, Deserialize)]
#[serde(tag = "shape", rename_all = "snake_case", deny_unknown_fields)]
pub(super) enum SurfaceSection {
    Plane {
        #[serde(rename = "point_m", default = "origin")]
        point: Triple,
        #[serde(default = "along_z")]
        normal: Triple,
    },
    Sphere {
        #[serde(rename = "radius_m")]
        radius: f64,
        #[serde(rename = "centre_m", default = "origin")]
        centre: Triple,
        #[serde(default = "along_z")]
        pole: Triple,
        #[serde(rename = "active_half_angle_deg")]
        active_half_angle: Option<f64>,
    },
    Cylinder {
        #[serde(rename = "radius_m")]
        radius: f64,
        #[serde(rename = "centre_m", default = "origin")]
        centre: Triple,
        #[serde(default = "along_z")]
        axis: Triple,
        #[serde(rename = "half_length_m")]
        half_length: Option<f64>,
    },
}

/// How the surface's own frame lies in the sensor frame.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct PoseSection {
    #[serde(rename = "translation_m")]
    translation: Triple,
    /// Rotation vector: axis times angle.
    #[serde(rename = "rotation_deg")]
    rotation: Triple,
}

impl PoseSection {
    fn sensor_from_surface(&self) -> Result<RigidTransform<f64>, SceneProblem> {
        let rotation = Vector3::from(self.rotation).map(f64::to_radians);
        RigidTransform::from_axis_angle(rotation, Vector3::from(self.translation))
            .map_err(|_| SceneProblem::Pose)
    }
}

impl SurfaceSection {
    /// Whether this is a shape of [`SurfaceSection`].
    pub(super) fn knows(shape: &str) -> bool {
        matches!(shape, "plane" | "sphere" | "cylinder")
    }
}

impl Surface for SurfaceSection {
    fn place(
        &self,
        pose: &PoseSection,
        map: Option<&MapSection>,
        _: &Path,
    ) -> Result<(Shape, Projection), SceneProblem> {
        if map.is_some() {
            return Err(SceneProblem::NeedlessMap);
        }
        let pose = pose.sensor_from_surface()?;
        let point = |p: &Triple| pose.transform_point(&Vector3::from(*p));
        let direction = |d: &Triple| pose.rotate(&Vector3::from(*d));
        let frame = [Vector3::x(), Vector3::y(), Vector3::z()].map(|axis| pose.rotate(&axis));
        match self {
            Self::Plane { point: through, normal } => {
                let plane = Plane::new(point(through), direction(normal))?;
                let normal = unit("normal", direction(normal))?;
                let map = Projection::plane(plane.point(), normal, &frame);
                Ok((Shape::Plane(plane), map))
            }
            Self::Sphere { radius, centre, pole, active_half_angle } => {
                let sphere = Sphere::new(point(centre), *radius)?;
                let pole = unit("pole", direction(pole))?;
                let rim = active_half_angle.map(f64::to_radians);
                let capped = match rim {
                    None => Capped::whole(sphere, pole),
                    Some(angle) if angle > 0.0 && angle <= core::f64::consts::PI => {
                        Capped::within(sphere, pole, angle)
                    }
                    Some(_) => return Err(SceneProblem::HalfAngle),
                };
                let map = Projection::sphere(sphere.centre(), pole, rim, &frame);
                Ok((Shape::Sphere(capped), map))
            }
            Self::Cylinder { radius, centre, axis, half_length } => {
                let mut cylinder = Cylinder::new(point(centre), direction(axis), *radius)?;
                if let Some(half_length) = half_length {
                    cylinder = cylinder.with_half_length(*half_length)?;
                }
                let map =
                    Projection::cylinder(cylinder.centre(), cylinder.axis(), *radius, *half_length, &frame);
                Ok((Shape::Cylinder(cylinder), map))
            }
        }
    }
}

/// The middle of the map of a shape that has none of its own, in the surface's frame.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MapSection {
    #[serde(rename = "centre_m", default = "origin")]
    centre: Triple,
    #[serde(default = "along_z")]
    pole: Triple,
}

/// A triangle mesh in a file beside the scene.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MeshSection {
    #[serde(rename = "shape")]
    _shape: String,
    file: PathBuf,
    metres_per_unit: f64,
}

impl Surface for MeshSection {
    fn place(
        &self,
        pose: &PoseSection,
        map: Option<&MapSection>,
        folder: &Path,
    ) -> Result<(Shape, Projection), SceneProblem> {
        let path = folder.join(&self.file);
        let mesh = Mesh::from_file(&path, self.metres_per_unit)
            .map_err(|source| SceneProblem::Mesh { path, source })?;
        DynSurface::Mesh(mesh).place(pose, map, folder)
    }
}

impl Surface for DynSurface<f64> {
    fn place(
        &self,
        pose: &PoseSection,
        map: Option<&MapSection>,
        _: &Path,
    ) -> Result<(Shape, Projection), SceneProblem> {
        let placed = pose.sensor_from_surface()?;
        let MapSection { centre, pole } =
            map.copied().unwrap_or(MapSection { centre: ORIGIN, pole: along_z() });
        let centre = placed.transform_point(&Vector3::from(centre));
        if !centre.iter().all(|x| x.is_finite()) {
            return Err(SceneProblem::MapCentre);
        }
        let pole = unit("pole", placed.rotate(&Vector3::from(pole)))?;
        let frame = [Vector3::x(), Vector3::y(), Vector3::z()].map(|axis| placed.rotate(&axis));
        let map = Projection::sphere(centre, pole, None, &frame);
        Ok((Shape::Other(Box::new(Posed::new(self.clone(), placed))), map))
    }
}

fn unit(key: &'static str, direction: Vector3<f64>) -> Result<Vector3<f64>, SceneProblem> {
    direction
        .try_normalize(0.0)
        .filter(|unit| unit.iter().all(|x| x.is_finite()))
        .ok_or(SceneProblem::NoDirection { key })
}
