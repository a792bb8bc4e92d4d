//! `[surface]`, `[pose]` and `[map]`: the shape, how it sits on the sensor, and how it is drawn flat.

use std::path::PathBuf;

use fingertip::surfaces::{
    ActiveSurface, BadShape, CappedCylinder, Capsule, Cone, Cylinder, Disk, DynSurface, Frustum, Mesh, Plane,
    Posed, Sphere, SphericalCap,
};
use fingertip::wrench::{Real, RigidTransform};
use nalgebra::Vector3;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::fault::SceneProblem;
use crate::formula::FormulaSection;
use crate::named::Folder;
use crate::projection::Projection;
use crate::urdf::UrdfSection;

type Triple = [f64; 3];

const fn origin() -> Triple {
    [0.0; 3]
}
const fn along_z() -> Triple {
    [0.0, 0.0, 1.0]
}

/// How the surface's own frame lies in the sensor frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct PoseSection {
    #[serde(rename = "translation_m")]
    translation: Triple,
    /// Rotation vector: axis times angle.
    #[serde(rename = "rotation_deg")]
    rotation: Triple,
}

impl PoseSection {
    pub(crate) fn sensor_from_surface<T: Real>(&self) -> Result<RigidTransform<T>, SceneProblem> {
        let rotation = Vector3::from(self.rotation).map(|degrees| T::literal(degrees.to_radians()));
        RigidTransform::from_axis_angle(rotation, Vector3::from(self.translation).map(T::literal))
            .map_err(|_| SceneProblem::Pose)
    }
}

/// The middle of the map of a shape that has none of its own, in the surface's frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct MapSection {
    #[serde(rename = "centre_m", default = "origin")]
    centre: Triple,
    #[serde(default = "along_z")]
    pole: Triple,
}

/// A triangle mesh in a file beside the scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct MeshSection {
    #[serde(rename = "shape")]
    _shape: String,
    pub(crate) file: PathBuf,
    pub(crate) metres_per_unit: f64,
}

/// Where the shape of a scene stands: in the scene, or in a file of its own.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum ShapeSource {
    Here(toml::Value),
    MeshFile { path: PathBuf, metres_per_unit: f64 },
    Formula(Box<FormulaSection>),
}

impl ShapeSource {
    /// The shape in its own frame. In other precision than a double's it is read again, so that all numbers
    /// are rounded once.
    pub(crate) fn shape<T: Real + DeserializeOwned>(&self) -> Result<DynSurface<T>, SceneProblem> {
        match self {
            Self::Here(table) => table.clone().try_into().map_err(|error| SceneProblem::Key {
                key: String::new(),
                message: error.message().replace('\n', " "),
            }),
            Self::Formula(section) => Ok(section.build()?),
            Self::MeshFile { path, metres_per_unit } => Mesh::from_file(path, T::literal(*metres_per_unit))
                .map(DynSurface::Mesh)
                .map_err(|source| SceneProblem::Mesh { path: path.clone(), source }),
        }
    }
}

/// What the section `[surface]` may be: a shape, or the file of one.
pub(crate) trait SurfaceSection {
    /// Files are looked for in `folder`; `document` is the scene as it stands.
    fn source(self, folder: &Folder<'_>, document: &toml::Table) -> Result<ShapeSource, SceneProblem>;
}

impl SurfaceSection for DynSurface<f64> {
    fn source(self, _: &Folder<'_>, document: &toml::Table) -> Result<ShapeSource, SceneProblem> {
        // A scene without a surface is refused before.
        let here = document.get("surface").cloned().unwrap_or(toml::Value::Boolean(false));
        Ok(ShapeSource::Here(here))
    }
}

impl SurfaceSection for MeshSection {
    fn source(self, folder: &Folder<'_>, _: &toml::Table) -> Result<ShapeSource, SceneProblem> {
        Ok(ShapeSource::MeshFile { path: folder.file(&self.file), metres_per_unit: self.metres_per_unit })
    }
}

impl SurfaceSection for FormulaSection {
    fn source(self, _: &Folder<'_>, _: &toml::Table) -> Result<ShapeSource, SceneProblem> {
        Ok(ShapeSource::Formula(Box::new(self)))
    }
}

impl SurfaceSection for UrdfSection {
    fn source(self, folder: &Folder<'_>, _: &toml::Table) -> Result<ShapeSource, SceneProblem> {
        Ok(ShapeSource::Here(self.shape(folder)?))
    }
}

/// How a shape gets into the sensor frame.
pub(crate) enum Placing<T: Real> {
    /// It is there already.
    Here,
    /// A shape about an axis is put there itself, which costs nothing per sample: an origin and a direction by their keys.
    There { origin: (&'static str, Vector3<T>), direction: (&'static str, Vector3<T>) },
    /// Others are [`Posed`].
    Posed(RigidTransform<T>),
}

/// How a shape gets into the sensor frame: without a pose it is there already.
pub(crate) fn placing<T: Real>(
    surface: &DynSurface<T>,
    section: &PoseSection,
) -> Result<Placing<T>, SceneProblem> {
    let pose = section.sensor_from_surface()?;
    if *section == PoseSection::default() {
        return Ok(Placing::Here);
    }
    let (keys, origin, direction) = match surface {
        DynSurface::Plane(plane) => (["point_m", "normal"], plane.point(), plane.normal(&plane.point())),
        DynSurface::Disk(disk) => {
            (["centre_m", "normal"], disk.plane().point(), disk.plane().normal(&disk.plane().point()))
        }
        DynSurface::Sphere(cap) => (["centre_m", "pole"], cap.sphere().centre(), cap.pole()),
        DynSurface::Cylinder(cylinder) => (["centre_m", "axis"], cylinder.centre(), cylinder.axis()),
        DynSurface::CappedCylinder(cylinder) => (["centre_m", "axis"], cylinder.centre(), cylinder.axis()),
        DynSurface::Capsule(capsule) => (["centre_m", "axis"], capsule.centre(), capsule.axis()),
        DynSurface::Cone(cone) => (["apex_m", "axis"], cone.apex(), cone.axis()),
        DynSurface::Frustum(frustum) => (["base_centre_m", "axis"], frustum.base_centre(), frustum.axis()),
        _ => return Ok(Placing::Posed(pose)),
    };
    let [at, along] = keys;
    Ok(Placing::There {
        origin: (at, pose.transform_point(&origin)),
        direction: (along, pose.rotate(&direction)),
    })
}

/// The shape in the sensor frame.
pub(crate) fn placed<T: Real>(
    surface: DynSurface<T>,
    section: &PoseSection,
) -> Result<DynSurface<T>, SceneProblem> {
    Ok(match placing(&surface, section)? {
        Placing::Here => surface,
        Placing::There { origin: (_, origin), direction: (_, direction) } => {
            standing(surface, origin, direction)?
        }
        Placing::Posed(pose) => DynSurface::Posed(Box::new(Posed::new(surface, pose))),
    })
}

/// The same shape about another axis.
fn standing<T: Real>(
    surface: DynSurface<T>,
    at: Vector3<T>,
    along: Vector3<T>,
) -> Result<DynSurface<T>, BadShape> {
    Ok(match surface {
        DynSurface::Plane(_) => Plane::new(at, along)?.into(),
        DynSurface::Disk(disk) => Disk::new(at, along, disk.radius())?.into(),
        DynSurface::Sphere(cap) => {
            SphericalCap::new(Sphere::new(at, cap.sphere().radius())?, along, cap.least_cosine())?.into()
        }
        DynSurface::Cylinder(cylinder) => {
            let whole = Cylinder::new(at, along, cylinder.radius())?;
            cylinder.half_length().map_or(Ok(whole), |half| whole.with_half_length(half))?.into()
        }
        DynSurface::CappedCylinder(cylinder) => {
            CappedCylinder::new(at, along, cylinder.radius(), cylinder.half_length())?.into()
        }
        DynSurface::Capsule(capsule) => {
            Capsule::new(at, along, capsule.radius(), capsule.half_length())?.into()
        }
        DynSurface::Cone(cone) => {
            let whole = Cone::new(at, along, cone.half_angle())?;
            cone.depth().map_or(Ok(whole), |depth| whole.with_depth(depth))?.into()
        }
        DynSurface::Frustum(frustum) => {
            let [below, above] = [frustum.base_radius(), frustum.top_radius()];
            Frustum::new(at, along, below, above, frustum.height())?.into()
        }
        other => other,
    })
}

/// How a placed surface is drawn flat; the directions are those of the surface's own frame.
pub(crate) fn map_of(
    surface: &DynSurface<f64>,
    pose: &RigidTransform<f64>,
    map: Option<&MapSection>,
) -> Result<Projection, SceneProblem> {
    let frame = [Vector3::x(), Vector3::y(), Vector3::z()].map(|axis| pose.rotate(&axis));
    let own = match surface {
        DynSurface::Plane(plane) => Projection::plane(plane.point(), plane.normal(&plane.point()), &frame),
        DynSurface::Sphere(cap) => {
            let rim = (cap.least_cosine() > -1.0).then(|| cap.least_cosine().acos());
            Projection::sphere(cap.sphere().centre(), cap.pole(), rim, &frame)
        }
        DynSurface::Cylinder(cylinder) => Projection::cylinder(
            cylinder.centre(),
            cylinder.axis(),
            cylinder.radius(),
            cylinder.half_length(),
            &frame,
        ),
        _ => return seen_from(pose, map, &frame),
    };
    match map {
        None => Ok(own),
        Some(_) => Err(SceneProblem::NeedlessMap),
    }
}

/// Of a shape that has no map of its own: from a centre, by default that of the surface's frame.
fn seen_from(
    pose: &RigidTransform<f64>,
    map: Option<&MapSection>,
    frame: &[Vector3<f64>; 3],
) -> Result<Projection, SceneProblem> {
    let MapSection { centre, pole } =
        map.copied().unwrap_or(MapSection { centre: origin(), pole: along_z() });
    let centre = pose.transform_point(&Vector3::from(centre));
    if !centre.iter().all(|x| x.is_finite()) {
        return Err(SceneProblem::MapCentre);
    }
    let pole = pose
        .rotate(&Vector3::from(pole))
        .try_normalize(0.0)
        .filter(|unit| unit.iter().all(|x| x.is_finite()))
        .ok_or(SceneProblem::MapPole)?;
    Ok(Projection::sphere(centre, pole, None, frame))
}

/// The outward normal of a surface that is flat, in the frame it is in.
pub(crate) fn flat_normal(surface: &DynSurface<f64>) -> Option<Vector3<f64>> {
    // Everywhere the same.
    let anywhere = Vector3::zeros();
    match surface {
        DynSurface::Plane(plane) => Some(plane.normal(&anywhere)),
        DynSurface::Disk(disk) => Some(disk.normal(&anywhere)),
        DynSurface::Rectangle(rectangle) => Some(rectangle.normal(&anywhere)),
        DynSurface::Posed(posed) => Some(posed.sensor_from_shape().rotate(&flat_normal(posed.inner())?)),
        _ => None,
    }
}
