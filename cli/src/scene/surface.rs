//! The surface of a scene and its pose.

use std::path::{Path, PathBuf};

use fingertip::surfaces::{ActiveSurface, Cylinder, DynSurface, Mesh, Plane, Posed, Sphere, SphericalCap};
use fingertip::wrench::RigidTransform;
use nalgebra::Vector3;
use serde::Deserialize;

use super::fault::SceneProblem;
use crate::shape::{Projection, Shape};

type Triple = [f64; 3];

const ORIGIN: Triple = [0.0; 3];
const fn origin() -> Triple {
    ORIGIN
}
const fn along_z() -> Triple {
    [0.0, 0.0, 1.0]
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

/// The middle of the map of a shape that has none of its own, in the surface's frame.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MapSection {
    #[serde(rename = "centre_m", default = "origin")]
    centre: Triple,
    #[serde(default = "along_z")]
    pole: Triple,
}

/// What the section `[surface]` may be: a shape, or the file of one.
pub(super) trait SurfaceSection {
    /// The shape, in the surface's own frame. Files are looked for in `folder`.
    fn shape(self, folder: &Path) -> Result<DynSurface<f64>, SceneProblem>;
}

impl SurfaceSection for DynSurface<f64> {
    fn shape(self, _: &Path) -> Result<Self, SceneProblem> {
        Ok(self)
    }
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

impl SurfaceSection for MeshSection {
    fn shape(self, folder: &Path) -> Result<DynSurface<f64>, SceneProblem> {
        let path = folder.join(&self.file);
        let mesh = Mesh::from_file(&path, self.metres_per_unit)
            .map_err(|source| SceneProblem::Mesh { path, source })?;
        Ok(DynSurface::Mesh(mesh))
    }
}

/// The shape in the sensor frame, and its map, whose directions are those of the surface's own frame.
pub(super) fn place(
    surface: DynSurface<f64>,
    pose: &PoseSection,
    map: Option<&MapSection>,
) -> Result<(Shape, Projection), SceneProblem> {
    let pose = pose.sensor_from_surface()?;
    let frame = [Vector3::x(), Vector3::y(), Vector3::z()].map(|axis| pose.rotate(&axis));
    let placed = match surface {
        DynSurface::Plane(plane) => {
            let normal = pose.rotate(&plane.normal(&plane.point()));
            let plane = Plane::new(pose.transform_point(&plane.point()), normal)?;
            let map = Projection::plane(plane.point(), plane.normal(&plane.point()), &frame);
            (Shape::Plane(plane), map)
        }
        DynSurface::Sphere(cap) => {
            let centre = pose.transform_point(&cap.sphere().centre());
            let sphere = Sphere::new(centre, cap.sphere().radius())?;
            let least_cosine = cap.least_cosine();
            let cap = SphericalCap::new(sphere, pose.rotate(&cap.pole()), least_cosine)?;
            let rim = (least_cosine > -1.0).then(|| least_cosine.acos());
            (Shape::Sphere(cap), Projection::sphere(centre, cap.pole(), rim, &frame))
        }
        DynSurface::Cylinder(cylinder) => {
            let (centre, axis) = (pose.transform_point(&cylinder.centre()), pose.rotate(&cylinder.axis()));
            let (radius, half_length) = (cylinder.radius(), cylinder.half_length());
            let whole = Cylinder::new(centre, axis, radius)?;
            let cylinder = half_length.map_or(Ok(whole), |half| whole.with_half_length(half))?;
            let map = Projection::cylinder(centre, cylinder.axis(), radius, half_length, &frame);
            (Shape::Cylinder(cylinder), map)
        }
        other => return place_other(other, pose, map, &frame),
    };
    match map {
        None => Ok(placed),
        Some(_) => Err(SceneProblem::NeedlessMap),
    }
}

/// One that has no map of its own: seen from a centre, by default that of the surface's frame.
fn place_other(
    surface: DynSurface<f64>,
    pose: RigidTransform<f64>,
    map: Option<&MapSection>,
    frame: &[Vector3<f64>; 3],
) -> Result<(Shape, Projection), SceneProblem> {
    let MapSection { centre, pole } = map.copied().unwrap_or(MapSection { centre: ORIGIN, pole: along_z() });
    let centre = pose.transform_point(&Vector3::from(centre));
    if !centre.iter().all(|x| x.is_finite()) {
        return Err(SceneProblem::MapCentre);
    }
    let pole = pose
        .rotate(&Vector3::from(pole))
        .try_normalize(0.0)
        .filter(|unit| unit.iter().all(|x| x.is_finite()))
        .ok_or(SceneProblem::MapPole)?;
    let map = Projection::sphere(centre, pole, None, frame);
    Ok((Shape::Other(Box::new(Posed::new(surface, pose))), map))
}
