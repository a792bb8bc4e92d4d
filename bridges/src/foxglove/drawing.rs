//! The fingertip as a scene of Foxglove: the surface, and the contact with its force on it. Lengths in metres.

use core::time::Duration as Stamp;

use foxglove::messages::line_primitive::Type;
use foxglove::messages::scene_entity_deletion::Type as Deleted;
use foxglove::messages::{
    ArrowPrimitive, Color, Duration, LinePrimitive, Point3, Pose, Quaternion, SceneEntity,
    SceneEntityDeletion, SceneUpdate, SpherePrimitive, Timestamp, TriangleListPrimitive, Vector3,
};
use nalgebra::{UnitQuaternion, Vector3 as Vector};

use crate::drawn::{Colour, FORCE, NEWTON, SURFACE, colour, rim, ring};
use crate::{About, Pressed, Sample};

/// Corners of a ring.
const CORNERS: u32 = 32;

fn painted([r, g, b, a]: Colour) -> Color {
    Color { r, g, b, a }
}

fn point(at: &Vector<f64>) -> Point3 {
    Point3 { x: at.x, y: at.y, z: at.z }
}

/// At a place, with the first axis along a direction.
fn pose(at: &Vector<f64>, along: &Vector<f64>) -> Pose {
    let turn = UnitQuaternion::rotation_between(&Vector::x(), along)
        .unwrap_or_else(|| UnitQuaternion::from_axis_angle(&Vector::z_axis(), core::f64::consts::PI));
    Pose {
        position: Some(Vector3 { x: at.x, y: at.y, z: at.z }),
        orientation: Some(Quaternion { x: turn.i, y: turn.j, z: turn.k, w: turn.w }),
    }
}

/// A time since 1970, as it is sent: a moment before 1970 or after 2105 is none.
fn timestamp(stamp: Stamp) -> Timestamp {
    Timestamp::new(u32::try_from(stamp.as_secs()).unwrap_or(u32::MAX), stamp.subsec_nanos())
}

fn entity(id: &str, about: &About, stamp: Stamp) -> SceneEntity {
    SceneEntity {
        timestamp: Some(timestamp(stamp)),
        frame_id: about.frame.clone(),
        id: id.to_owned(),
        lifetime: Some(Duration::new(0, 0)),
        frame_locked: true,
        ..SceneEntity::default()
    }
}

/// The surface at a time since 1970; nothing where it cannot be drawn.
pub(super) fn surface(about: &About, stamp: Stamp) -> SceneUpdate {
    let points: Vec<Point3> = about.surface.triangles().flatten().map(|corner| point(&corner)).collect();
    if points.is_empty() {
        return SceneUpdate::default();
    }
    let pose = Some(pose(&Vector::zeros(), &Vector::x()));
    let triangles = TriangleListPrimitive {
        pose,
        points,
        color: Some(painted(SURFACE)),
        ..TriangleListPrimitive::default()
    };
    SceneUpdate {
        deletions: Vec::new(),
        entities: vec![SceneEntity { triangles: vec![triangles], ..entity("surface", about, stamp) }],
    }
}

/// The contact of a sample, or that there is none.
pub(super) fn contact(sample: &Sample, about: &About) -> SceneUpdate {
    let Some(contact) = sample.contact() else {
        let deletion = SceneEntityDeletion {
            timestamp: Some(timestamp(sample.stamp)),
            r#type: Deleted::MatchingId.into(),
            id: "contact".to_owned(),
        };
        return SceneUpdate { deletions: vec![deletion], entities: Vec::new() };
    };
    let colour = painted(colour(sample));
    let length = NEWTON * contact.force.norm();
    let head = (0.3 * length).min(0.003);
    let arrow = contact.force.try_normalize(0.0).map(|along| ArrowPrimitive {
        pose: Some(pose(&(contact.point - along * length), &along)),
        shaft_length: length - head,
        shaft_diameter: 0.25 * head,
        head_length: head,
        head_diameter: 0.6 * head,
        color: Some(painted(FORCE)),
    });
    let ball = SpherePrimitive {
        pose: Some(pose(&contact.point, &Vector::x())),
        size: Some(Vector3 { x: 1e-3, y: 1e-3, z: 1e-3 }),
        color: Some(colour),
    };
    let rings = [ellipse(contact), about.coefficient.map(|coefficient| cone(contact, coefficient))];
    let lines = rings.into_iter().flatten().map(|(kind, points)| LinePrimitive {
        r#type: kind.into(),
        pose: Some(pose(&Vector::zeros(), &Vector::x())),
        thickness: 1.5,
        scale_invariant: true,
        points: points.iter().map(point).collect(),
        color: Some(colour),
        ..LinePrimitive::default()
    });
    let entity = SceneEntity {
        arrows: arrow.into_iter().collect(),
        spheres: vec![ball],
        lines: lines.collect(),
        ..entity("contact", about, sample.stamp)
    };
    SceneUpdate { deletions: Vec::new(), entities: vec![entity] }
}

type Lines = (Type, Vec<Vector<f64>>);

/// Where the contact lies with 95 %.
fn ellipse(contact: &Pressed) -> Option<Lines> {
    let ellipse = contact.ellipse?;
    let ([a, b], [along, across]) = (ellipse.semi_axes, ellipse.directions);
    Some((Type::LineLoop, ring(&contact.point, &(along * a), &(across * b), CORNERS)))
}

/// The limit of friction: its rim at the height of the normal force, and lines to the contact.
fn cone(contact: &Pressed, coefficient: f64) -> Lines {
    let rim = rim(contact, coefficient, CORNERS);
    let next = rim.iter().cycle().skip(1);
    let around = rim.iter().zip(next).flat_map(|(one, other)| [*one, *other]);
    let down = rim.iter().step_by(8).flat_map(|corner| [*corner, contact.point]);
    (Type::LineList, around.chain(down).collect())
}
